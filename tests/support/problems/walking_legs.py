"""Code that several tests share: walking legs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from kinematics.arrays import Complex
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism

STEPS = 96
"""Crank angles at equal steps at which the foot is told."""


def klann() -> Mechanism:
    """Crank O A, connecting arm A C D, lower rocker B₀ C, leg D E P, upper rocker A₀ E; P is the foot."""
    joints = {
        "O": 1.599 + 0.750j, "B0": 1.009 + 0.574j, "A0": 1.366 + 1.366j,
        "A": 1.331 + 0.750j, "C": 0.741 + 0.750j, "D": 0.232 + 0.866j, "E": 0.866 + 1.500j, "P": 0j,
    }  # fmt: skip
    links = {
        "ground": ("O", "B0", "A0"), "crank": ("O", "A"), "arm": ("A", "C", "D"), "lower": ("B0", "C"),
        "leg": ("D", "E", "P"), "upper": ("A0", "E"),
    }  # fmt: skip
    return Mechanism({name: np.asarray(place) for name, place in joints.items()}, links, "crank")


def jansen() -> Mechanism:
    """The upper triangle b d e turns about the fixed pivot Q, the lower one g h i carries the foot P."""
    a, b, c, d, e, f, g, h, i, j, k, low, m = (
        38.0,
        41.5,
        39.3,
        40.1,
        55.8,
        39.4,
        36.7,
        65.7,
        49.0,
        50.0,
        61.9,
        7.8,
        15.0,
    )
    crank, pivot = a + low * 1j, 0j
    pin = crank + m
    upper = _corner(pivot, pin, b, j)
    far = _corner(pivot, upper, d, e)
    lower = _corner(pin, pivot, k, c)
    knee = _corner(lower, far, g, f)
    foot = _corner(lower, knee, i, h)
    joints = {"O": crank, "Q": pivot, "A": pin, "B": upper, "D": far, "C": lower, "E": knee, "P": foot}
    links = {
        "ground": ("O", "Q"), "crank": ("O", "A"), "j": ("A", "B"), "upper": ("Q", "B", "D"), "k": ("A", "C"),
        "c": ("Q", "C"), "f": ("D", "E"), "lower": ("C", "E", "P"),
    }  # fmt: skip
    return Mechanism({name: np.asarray(place) for name, place in joints.items()}, links, "crank")


def _corner(one: complex, other: complex, first: float, second: float) -> complex:
    """The corner of a triangle to the left of the way from one corner to the other, from its distances to them."""
    base = abs(other - one)
    along = (first**2 - second**2 + base**2) / (2.0 * base)
    return one + (along + 1j * np.sqrt(first**2 - along**2)) * (other - one) / base


LEGS: dict[str, Callable[[], Mechanism]] = {"Klann's foot": klann, "Jansen's foot": jansen}
"""Legs by the names of what they draw."""


def foot(name: str) -> Complex:
    """Places of a foot at equal steps of the crank, shape (96,)."""
    mechanism = LEGS[name]()
    turned = float(mechanism.reference_input) + np.linspace(0.0, 2.0 * np.pi, STEPS, endpoint=False)
    return np.asarray(drive(mechanism, turned, order=0).joints["P"][0])
