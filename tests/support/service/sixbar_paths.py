"""Code that several tests share: sixbar paths."""

from __future__ import annotations

from typing import Any

import numpy as np

TURN = np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)
EIGHT = 40.0 * np.sin(TURN) + 25.0j * np.sin(2.0 * TURN) + 10.0 + 5.0j


def listed(points) -> list[dict[str, float]]:
    return [{"x": float(z.real), "y": float(z.imag)} for z in points]


TASK: dict[str, Any] = {
    "kind": "path",
    "method": "curve_match",
    "closed": True,
    "points": listed(EIGHT),
    "mechanisms": ["stephenson_3"],
    "constraints": {"grashof": "crank_rocker"},
    "max_designs": 2,
}
