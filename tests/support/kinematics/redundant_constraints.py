"""Code that several tests share: redundant constraints."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.mechanism import GearPair, Mechanism

CRANK = np.exp(0.7j)
LINKS = {
    "ground": ("O2", "O4", "O6"),
    "input": ("O2", "A"),
    "coupler": ("A", "B", "C"),
    "rocker": ("O4", "B"),
    "third": ("O6", "C"),
}


def parallelogram(third_pivot: complex, length: float = 1.0, crank: complex = CRANK) -> Mechanism:
    """Three cranks that turn a coupler in parallel."""
    pivots = {"O2": 0j, "O4": 3.0 + 0j, "O6": third_pivot}
    pins = {"A": crank, "B": 3.0 + crank, "C": third_pivot + length * crank}
    return Mechanism({**pivots, **pins}, LINKS, "input")


def geared(ratio: float) -> Mechanism:
    """Three coaxial links and gears between every two of them, 1 : −2 : 1."""
    links = {"ground": ("O",), "input": ("O", "P"), "second": ("O", "Q"), "last": ("O", "R")}
    gears = (GearPair("input", "second", -2.0), GearPair("second", "last", -0.5), GearPair("input", "last", ratio))
    return Mechanism({"O": 0j, "P": 1.0, "Q": 1j, "R": -1.0}, links, "input", gears=gears)
