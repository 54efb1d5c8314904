"""Random fourbars to plant, placed by the intersection of two circles."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real

SIZE = 100.0, 350.0
"""Millimetres between which the unit of length of a linkage lies."""

LEAST_ANGLE = 30.0
"""Degrees of transmission angle that a planted linkage has at least where it is used."""

LEAST_RANGE, GREATEST_RANGE = 50.0, 150.0
"""Degrees that its input turns."""

LINKS = {"input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
"""The joints of the moving links."""


class PlantedFourbar(NamedTuple):
    """A fourbar and the range of its input that is used.

    Attributes
    ----------
    o2, o4 : complex
        Fixed pivots, mm.
    links : (float, float, float)
        Input, coupler and output, mm.
    point : complex
        P from A, as a share of the way from A to B.
    assembly : int
        Side of the line from A to O4 on which B lies: 1 to the left, −1 to the right.
    begin, end : float
        Input angles, radians; the second may be the smaller.
    """

    o2: complex
    o4: complex
    links: tuple[float, float, float]
    point: complex
    assembly: int
    begin: float
    end: float

    def joints(self, inputs: Real) -> dict[str, Complex]:
        """All joints at input angles (n,), each of shape (n,); NaN where the linkage does not close."""
        crank, coupler, output = self.links
        a = self.o2 + crank * np.exp(1j * np.asarray(inputs))
        line = self.o4 - a
        distance = np.abs(line)
        along = (distance**2 + coupler**2 - output**2) / (2.0 * distance)
        with np.errstate(invalid="ignore"):
            height = np.sqrt(coupler**2 - along**2)
        b = a + line / distance * (along + 1j * self.assembly * height)
        fixed = np.ones(len(a))
        return {"O2": self.o2 * fixed, "O4": self.o4 * fixed, "A": a, "B": b, "P": a + self.point * (b - a)}

    def transmission(self, inputs: Real) -> Real:
        """Transmission angles at input angles, degrees between 0 and 90; NaN where it does not close."""
        at = self.joints(inputs)
        return np.asarray(np.degrees(acute(at["B"] - at["A"], at["B"] - at["O4"])))

    def spread(self, step: float) -> Real:
        """Input angles from the first to the last, no more than ``step`` degrees apart."""
        count = math.ceil(abs(math.degrees(self.end - self.begin)) / step)
        return np.linspace(self.begin, self.end, count + 1)


def acute(first: Complex, second: Complex) -> Real:
    """Acute angles between directions, radians."""
    across = np.conj(first) * second
    return np.asarray(np.arctan2(np.abs(across.imag), np.abs(across.real)))


def planted_fourbar(rng: np.random.Generator, *, least_turn: float = 0.0) -> PlantedFourbar:
    """A fourbar of any class, anywhere, in any direction.

    Parameters
    ----------
    rng : numpy.random.Generator
    least_turn : float
        Degrees that the coupler turns over the range, at least.
    """
    while True:
        unit = rng.uniform(*SIZE)
        ground, crank, coupler, output = unit * rng.uniform([0.5, 0.3, 0.4, 0.4], [1.3, 1.0, 1.3, 1.3])
        o2 = complex(*rng.uniform(-300.0, 300.0, 2))
        o4 = o2 + ground * np.exp(1j * rng.uniform(-math.pi, math.pi))
        point = complex(rng.uniform(-0.4, 1.4), rng.uniform(-0.8, 0.8))
        begin = rng.uniform(-math.pi, math.pi)
        turned = math.radians(rng.uniform(LEAST_RANGE, GREATEST_RANGE)) * rng.choice([-1.0, 1.0])
        fourbar = PlantedFourbar(
            o2, complex(o4), (crank, coupler, output), point, int(rng.choice([-1, 1])), begin, begin + turned
        )
        inputs = fourbar.spread(1.0)
        angle = fourbar.transmission(inputs)
        if not np.all(angle >= LEAST_ANGLE):
            continue
        at = fourbar.joints(inputs)
        way = np.unwrap(np.angle(at["B"] - at["A"]))
        if np.ptp(way) >= math.radians(least_turn):
            return fourbar
