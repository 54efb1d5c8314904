"""Points on the ways of random fourbars in a room: a few met exactly, more within tolerances, and whole curves.

The points of a crank's way are free in time or at their crank angles; a closed curve is drawn by a crank that turns
through, an open stroke by any link.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from tests.support.fit.linkage import LINKS, PlantedFourbar, planted_fourbar
from tests.support.fit.room import SweptLinkage, room_around, zones_around
from tests.support.fit.task import Statement, Task, generator


class _Group(NamedTuple):
    """Tasks that count together: how many points, whether at crank angles, whether a whole curve and whether closed."""

    name: str
    points: int
    timed: bool = False
    matched: bool = False
    closed: bool = False


GROUPS = (
    _Group("5 points, exact", 5),
    _Group("6 points, exact", 6),
    _Group("8 points, exact", 8),
    _Group("9 points, exact", 9),
    _Group("12 points, within tolerances", 12),
    _Group("5 timed points, exact", 5, timed=True),
    _Group("8 timed points, within tolerances", 8, timed=True),
    _Group("open stroke", 16, matched=True),
    _Group("closed curve", 24, matched=True, closed=True),
)

STEP = 0.25
"""Degrees of the input from one position that is drawn around to the next."""

MOST_EXACT, MOST_TIMED = 9, 5
"""Points that are met exactly, at most, and those at crank angles; more have tolerances."""

TOLERANCE = 0.01
"""Of a point, as a share of the extent of all."""

LEAST_WAY, LEAST_STEP = 0.25, 0.02
"""Length of P's way, and distance of two neighbouring points, at least, as shares of the linkage's size."""

TURNING_ANGLE = 20.0
"""Degrees of transmission angle that a crank-rocker which is planted has at least in its whole turn."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements, one group after the other."""
    for number in range(count):
        group = GROUPS[number % len(GROUPS)]
        yield Task(number, group.name, statement(generator(seed, number), group))


def statement(rng: np.random.Generator, group: _Group) -> Statement:
    """One task."""
    planted, inputs = _planted(rng, group)
    swept = planted.joints(planted.spread(STEP))
    width = round(float(rng.uniform(4.0, 16.0)), 3)
    bars = {name: np.stack([swept[joint] for joint in joints], axis=1) for name, joints in LINKS.items()}
    room = room_around(rng, SweptLinkage(bars, None, width))
    extent = sum(planted.links) / 3.0
    room["fixed_pivots"] = {
        "input": zones_around(rng, planted.o2, extent),
        "output": zones_around(rng, planted.o4, extent),
    }
    if rng.random() < 0.3:
        room["moving_pivots"] = {"input": zones_around(rng, complex(swept["A"][0]), extent)}
    points = planted.joints(inputs)["P"]
    stated: Statement = {"kind": "path", "points": listed(points), "space": room}
    if group.closed:
        stated["closed"] = True
    if group.matched:
        stated["method"] = "curve_match"
    if group.timed:
        stated["timing"] = "prescribed"
        for point, angle in zip(stated["points"], np.degrees(inputs - inputs[0]), strict=True):
            point["crank_angle"] = float(angle)
    if len(points) > (MOST_TIMED if group.timed else MOST_EXACT):
        for point in stated["points"]:
            point["tolerance"] = TOLERANCE * float(np.hypot(np.ptp(points.real), np.ptp(points.imag)))
    if rng.random() < 0.5:
        least = float(planted.transmission(planted.spread(STEP)).min())
        stated["constraints"] = {"min_transmission_angle": least - 2.0}
    return stated


def _planted(rng: np.random.Generator, group: _Group) -> tuple[PlantedFourbar, Real]:
    """A fourbar, and the inputs at which its P stands at the points."""
    while True:
        planted = _turning(rng) if group.closed else planted_fourbar(rng)
        gaps = rng.uniform(0.6, 1.4, group.points if group.closed else group.points - 1)
        shares = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])[: group.points]
        inputs = planted.begin + (planted.end - planted.begin) * shares
        places = planted.joints(planted.spread(STEP))["P"]
        size = sum(planted.links) / 3.0
        steps = np.abs(np.diff(planted.joints(inputs)["P"]))
        if np.abs(np.diff(places)).sum() >= LEAST_WAY * size and steps.min() >= LEAST_STEP * size:
            return planted, inputs


def _turning(rng: np.random.Generator) -> PlantedFourbar:
    """A fourbar whose crank turns through, over a whole turn."""
    while True:
        planted = planted_fourbar(rng)
        whole = planted._replace(end=planted.begin + math.copysign(math.tau, planted.end - planted.begin))
        if np.all(whole.transmission(whole.spread(1.0)) >= TURNING_ANGLE):
            return whole


def listed(points: Complex) -> list[dict[str, Any]]:
    """Points as a statement has them."""
    return [{"x": float(z.real), "y": float(z.imag)} for z in points]
