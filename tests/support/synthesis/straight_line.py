"""Code that several tests share: straight line."""

from __future__ import annotations

import numpy as np


def norton_path(ground: float, coupler: float, span: float, steps: int = 20001) -> np.ndarray:
    """P of Hoeken's linkage with a crank of 1 over a range about 180°; A P is the diameter of a circle through O4."""
    pin = np.exp(1j * np.radians(180.0 + span * np.linspace(-0.5, 0.5, steps))) - ground
    point = 1j * pin * np.sqrt(4.0 * coupler**2 / np.abs(pin) ** 2 - 1.0)
    return point * np.sign(point[-1].real - point[0].real)
