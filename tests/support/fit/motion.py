"""Two to five positions of random fourbars that carry a body, met exactly or within tolerances, in a room.

Seven positions are added with tolerances: more than a linkage can take exactly.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from kinematics.arrays import Complex
from tests.support.fit.linkage import LEAST_ANGLE, PlantedFourbar, planted_fourbar
from tests.support.fit.room import SweptLinkage, room_around, zones_around
from tests.support.fit.task import Statement, Task, generator

GROUPS = ((2, False), (3, False), (4, False), (5, False), (2, True), (3, True), (4, True), (5, True), (7, True))
"""Positions, and whether all but the first have tolerances."""

STEP = 0.25
"""Degrees of the input from one position that is drawn around to the next."""

USED = 0.8
"""Share of a tolerance by which the planted linkage misses a position at most."""

LEAST_TURN = 15.0
"""Degrees that the planted body turns at least."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements, one group after the other."""
    for number in range(count):
        positions, tolerated = GROUPS[number % len(GROUPS)]
        group = f"{positions} positions, {'within tolerances' if tolerated else 'exact'}"
        yield Task(number, group, statement(generator(seed, number), positions, tolerated))


def statement(rng: np.random.Generator, count: int, tolerated: bool) -> Statement:
    """One task."""
    planted, listed = _planted(rng, count, tolerated)
    swept = planted.joints(planted.spread(STEP))
    corners = outline(rng, planted.point)
    width = round(float(rng.uniform(4.0, 16.0)), 3)
    bars = {
        "input": np.stack([swept["O2"], swept["A"]], axis=1),
        "coupler": np.stack([swept["A"], swept["B"]], axis=1),
        "output": np.stack([swept["O4"], swept["B"]], axis=1),
    }
    body = swept["A"][:, None] + corners * (swept["B"] - swept["A"])[:, None]
    room = room_around(rng, SweptLinkage(bars, body, width))
    extent = float(np.ptp(body.real) + np.ptp(body.imag))
    room["body"] = {"outline": [[z.real, z.imag] for z in body[0]]}
    room["fixed_pivots"] = {
        "input": zones_around(rng, planted.o2, extent),
        "output": zones_around(rng, planted.o4, extent),
    }
    if rng.random() < 0.7:
        room["moving_pivots"] = {
            "input": _on_body(zones_around(rng, complex(swept["A"][0]), extent)),
            "output": _on_body(zones_around(rng, complex(swept["B"][0]), extent)),
        }
    stated: Statement = {"kind": "motion", "positions": listed, "space": room}
    if rng.random() < 0.5:
        least = float(planted.transmission(planted.spread(STEP)).min())
        stated["constraints"] = {"min_transmission_angle": least - 2.0}
    return stated


def _planted(rng: np.random.Generator, count: int, tolerated: bool) -> tuple[PlantedFourbar, list[dict[str, Any]]]:
    """A fourbar, and the positions that it carries a body through.

    With tolerances its range ends where the body is nearest to the last position.
    """
    while True:
        planted = planted_fourbar(rng, least_turn=LEAST_TURN)
        gaps = rng.uniform(0.6, 1.4, count - 1)
        shares = np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
        inputs = planted.begin + (planted.end - planted.begin) * shares
        inputs[-1] = planted.end
        listed = carried(planted.joints(inputs))
        if not tolerated:
            return planted, listed
        _missed(rng, listed)
        met = [_nearest(planted, position, listed[0]["angle"]) for position in listed[1:]]
        way = np.abs(np.array([planted.begin, *met]) - planted.begin)
        planted = planted._replace(end=met[-1])
        sound = planted.transmission(planted.spread(1.0)) >= LEAST_ANGLE
        if np.all(np.diff(way) > 0.0) and (met[-1] > planted.begin) == (inputs[-1] > planted.begin) and sound.all():
            return planted, listed


def _nearest(planted: PlantedFourbar, position: dict[str, Any], first: float) -> float:
    """The input within half a turn where the greatest share of a tolerance is least; ``first`` is the first angle."""
    inputs = planted.begin + np.linspace(-math.pi, math.pi, 36_001)
    at, stood = planted.joints(inputs), planted.joints(np.array([planted.begin]))
    turned = np.angle((at["B"] - at["A"]) / (stood["B"] - stood["A"]))
    off = np.degrees(turned) + first - position["angle"]
    allowed = position["tolerance"]
    shares = [
        np.abs(at["P"].real - position["x"]) / allowed["x"],
        np.abs(at["P"].imag - position["y"]) / allowed["y"],
        np.abs(off - 360.0 * np.round(off / 360.0)) / allowed["angle"],
    ]
    return float(inputs[np.nanargmin(np.max(shares, axis=0))])


def _on_body(zones: Statement | list[Statement]) -> Any:
    """The same zones, of the body."""
    return [_on_body(zone) for zone in zones] if isinstance(zones, list) else {**zones, "frame": "body"}


def outline(rng: np.random.Generator, point: complex) -> Complex:
    """Corners of a bar, a wedge or an angle on the coupler about a point, all as shares of the way from A to B."""
    length, height = rng.uniform(0.5, 1.3), rng.uniform(0.1, 0.35)
    shape = [
        np.array([0.0, length, length + 1j * height, 1j * height]),
        np.array([0.0, length, 0.5 * length + 1j * height]),
        np.array([0.0, length, length + 0.4j * height, 0.3 * length + 0.4j * height, 0.3 * length + 1.6j * height,
                  1.6j * height]),
    ][int(rng.integers(3))]  # fmt: skip
    turned = shape * np.exp(1j * rng.uniform(-math.pi, math.pi))
    return np.asarray(point + turned - turned.mean() * rng.uniform(0.0, 1.0))


def carried(at: Mapping[str, Complex]) -> list[dict[str, Any]]:
    """Positions of the body by the joints of the linkage that carries it."""
    angles = np.degrees(np.unwrap(np.angle(at["B"] - at["A"])))
    return [
        {"x": float(p.real), "y": float(p.imag), "angle": float(angle)}
        for p, angle in zip(at["P"], angles - angles[0], strict=True)
    ]


def _missed(rng: np.random.Generator, listed: list[dict[str, Any]]) -> None:
    """Give all positions but the first tolerances, and move them within these."""
    extent = max(abs(complex(p["x"], p["y"]) - complex(listed[0]["x"], listed[0]["y"])) for p in listed)
    for position in listed[1:]:
        across, turn = extent * rng.uniform(0.02, 0.08), rng.uniform(2.0, 8.0)
        position["tolerance"] = {"x": across, "y": across, "angle": turn}
        for name, allowed in position["tolerance"].items():
            position[name] += allowed * rng.uniform(-USED, USED)
