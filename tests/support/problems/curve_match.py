"""Code that several tests share: curve match."""

from __future__ import annotations

import json
import math
import re
from typing import Any

import numpy as np

from kinematics.arrays import Complex
from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.registry import parse_problem
from tests.cases import HERE

STROKES = ("wu3_partial", "recover_c-shape", "recover_sharp")
"""Curves that a crank does not draw in one turn: they are listed from crank angle 0, with a gap where the crank turns
back, and begin behind that gap here."""


def curve_cases() -> list[dict[str, Any]]:
    """The rows of the file, with their points as ``curve``."""
    read = json.loads((HERE / "curves.json").read_text(encoding="utf-8"))
    cases: list[dict[str, Any]] = read["cases"]
    for case in cases:
        given = np.array(read["curves"][case["id"]]["points"]) @ np.array([1.0, 1.0j])
        case["closed"] = case["id"] not in STROKES
        if not case["closed"]:
            given = np.roll(given, -1 - int(np.abs(np.diff(np.append(given, given[0]))).argmax()))
        case["curve"] = given[np.append(True, np.abs(np.diff(given)) > 0.0)]
    return cases


def matched(curve: Complex, closed: bool, **more: Any) -> PathResult:
    """The answer for a curve."""
    points = [{"x": float(z.real), "y": float(z.imag)} for z in curve]
    problem = parse_problem({"kind": "path", "method": "curve_match", "closed": closed, "points": points, **more})
    found = solve(problem, lambda share, message: None)
    assert isinstance(found, PathResult)
    return found


def published_rms(case: dict[str, Any]) -> float:
    """The error of the published linkage: distances from its curve, in 20000 crank positions, either assembly."""
    least = math.inf
    for published in case.get("published", []):
        d, a, b, c, px, py, turned, x, y = published["dims"][:9]
        pin = a * np.exp(1j * (np.linspace(0.0, 2.0 * np.pi, 20001) + turned))
        base = d * np.exp(1j * turned) - pin
        f = np.abs(base)
        along = (b * b - c * c + f * f) / (2.0 * f)
        for sign in (1.0, -1.0):
            with np.errstate(invalid="ignore"):
                unit = base / f * (along + 1j * sign * np.sqrt(b * b - along * along)) / b
            curve = x + 1j * y + pin + unit * complex(px, py)
            curve = curve[np.isfinite(curve)]
            if len(curve):
                off = [float(np.abs(curve - z).min()) for z in case["curve"]]
                least = min(least, math.sqrt(float(np.mean(np.square(off)))))
    return least


def reference_rms(case: dict[str, Any]) -> float:
    """The best that others computed, printed as a sum of squares; exact for curves of a known linkage."""
    source = case.get("reference", {}).get("source", "")
    if "linkage" in case["inputs"]:
        return 0.0
    found = re.search(r"\['([0-9.e-]+)'", source)
    return math.sqrt(float(found.group(1)) / len(case["curve"])) if found else math.nan


def noisy(rng: np.random.Generator, noise: float) -> tuple[Complex, float]:
    """64 samples at equal crank steps of a random crank-rocker's curve, with noise; and its standard deviation."""
    while True:
        a = 1.0
        b, c, d = rng.uniform(1.2, 4.0, 3)
        if max(b, c, d) + a < sum((b, c, d)) - max(b, c, d):
            break
    p = b * complex(rng.uniform(-0.5, 1.5), rng.uniform(-1.0, 1.0))
    pin = a * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
    base = d - pin
    f = np.abs(base)
    along = (b * b - c * c + f * f) / (2.0 * f)
    curve = pin + p * base / f * (along + 1j * np.sqrt(b * b - along * along)) / b
    size = math.hypot(float(np.ptp(curve.real)), float(np.ptp(curve.imag)))
    sigma = noise * size
    # Noise in every direction, of this root mean square distance.
    return curve + sigma * math.sqrt(0.5) * (rng.normal(size=64) + 1j * rng.normal(size=64)), sigma
