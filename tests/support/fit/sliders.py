"""Two to four exact positions of random slider-cranks that carry a body, in a room."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.fit.linkage import GREATEST_RANGE, LEAST_ANGLE, LEAST_RANGE, SIZE
from tests.support.fit.motion import LEAST_TURN, STEP, carried, outline
from tests.support.fit.room import SweptLinkage, room_around, zones_around
from tests.support.fit.task import Statement, Task, generator

GROUPS = 2, 3, 4
"""Positions. Five have a slider by chance only."""


class PlantedSliderCrank(NamedTuple):
    """A slider-crank and the range of its input that is used.

    Attributes
    ----------
    o2 : complex
        Fixed pivot, mm.
    links : (float, float)
        Input and coupler, mm.
    offset, direction : float
        Distance of O2 from the line of the slide, mm, to its left; and where the line points, radians.
    ahead : int
        Whether B is ahead of A along the line, 1, or behind it, −1.
    point : complex
        P from A, as a share of the way from A to B.
    begin, end : float
        Input angles, radians; the second may be the smaller.
    """

    o2: complex
    links: tuple[float, float]
    offset: float
    direction: float
    ahead: int
    point: complex
    begin: float
    end: float

    def joints(self, inputs: Real) -> dict[str, Complex]:
        """The joints at input angles (n,), each of shape (n,); NaN where the linkage does not close."""
        crank, coupler = self.links
        along = np.exp(1j * self.direction)
        a = self.o2 + crank * np.exp(1j * np.asarray(inputs))
        away = ((a - self.o2) * np.conj(along)).imag + self.offset
        with np.errstate(invalid="ignore"):
            b = a + along * (self.ahead * np.sqrt(coupler**2 - away**2) - 1j * away)
        return {"O2": self.o2 * np.ones(len(a)), "A": a, "B": b, "P": a + self.point * (b - a)}

    def transmission(self, inputs: Real) -> Real:
        """Angles of the coupler with the normal of the line, degrees between 0 and 90."""
        at = self.joints(inputs)
        return np.asarray(
            np.degrees(np.arccos(np.abs(((at["B"] - at["A"]) / self.links[1] * np.exp(-1j * self.direction)).imag)))
        )

    def spread(self, step: float) -> Real:
        """Input angles from the first to the last, no more than ``step`` degrees apart."""
        return np.linspace(self.begin, self.end, math.ceil(abs(math.degrees(self.end - self.begin)) / step) + 1)


def planted_slider_crank(rng: np.random.Generator) -> PlantedSliderCrank:
    """A slider-crank anywhere, in any direction."""
    while True:
        unit = rng.uniform(*SIZE)
        crank, coupler, offset = unit * rng.uniform([0.3, 0.5, -0.4], [1.0, 1.5, 0.4])
        begin = rng.uniform(-math.pi, math.pi)
        turned = math.radians(rng.uniform(LEAST_RANGE, GREATEST_RANGE)) * rng.choice([-1.0, 1.0])
        planted = PlantedSliderCrank(
            complex(*rng.uniform(-300.0, 300.0, 2)),
            (float(crank), float(coupler)),
            float(offset),
            float(rng.uniform(-math.pi, math.pi)),
            int(rng.choice([-1, 1])),
            complex(rng.uniform(-0.4, 1.4), rng.uniform(-0.8, 0.8)),
            begin,
            begin + turned,
        )
        inputs = planted.spread(1.0)
        if not np.all(planted.transmission(inputs) >= LEAST_ANGLE):
            continue
        at = planted.joints(inputs)
        if np.ptp(np.unwrap(np.angle(at["B"] - at["A"]))) >= math.radians(LEAST_TURN):
            return planted


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements, one group after the other."""
    for number in range(count):
        positions = GROUPS[number % len(GROUPS)]
        yield Task(number, f"{positions} positions, slider-crank", statement(generator(seed, number), positions))


def statement(rng: np.random.Generator, count: int) -> Statement:
    """One task."""
    planted = planted_slider_crank(rng)
    gaps = rng.uniform(0.6, 1.4, count - 1)
    shares = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
    listed = carried(planted.joints(planted.begin + (planted.end - planted.begin) * shares))
    swept = planted.joints(planted.spread(STEP))
    bars = {
        "input": np.stack([swept["O2"], swept["A"]], axis=1),
        "coupler": np.stack([swept["A"], swept["B"]], axis=1),
    }
    body = swept["A"][:, None] + outline(rng, planted.point) * (swept["B"] - swept["A"])[:, None]
    room = room_around(rng, SweptLinkage(bars, body, round(float(rng.uniform(4.0, 16.0)), 3)))
    extent = float(np.ptp(body.real) + np.ptp(body.imag))
    room["body"] = {"outline": [[z.real, z.imag] for z in body[0]]}
    room["fixed_pivots"] = {"input": zones_around(rng, planted.o2, extent)}
    if rng.random() < 0.7:
        room["moving_pivots"] = {
            "input": zones_around(rng, complex(swept["A"][0]), extent),
            "output": zones_around(rng, complex(swept["B"][0]), extent),
        }
    return {"kind": "motion", "positions": listed, "output_side": {"dyad": "PR"}, "space": room}
