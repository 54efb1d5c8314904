"""Pairs of random fourbars in a room: a few met exactly, more fitted; on given pivots, and wherever a linkage fits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from tests.support.fit.linkage import LINKS, PlantedFourbar, planted_fourbar
from tests.support.fit.room import SweptLinkage, room_around, zones_around
from tests.support.fit.task import Statement, Task, always, generator


class _Group(NamedTuple):
    """Tasks that count together: how many pairs, and whether the fixed pivots are given."""

    pairs: int
    given: bool


GROUPS = (
    _Group(3, False), _Group(4, False), _Group(5, False), _Group(6, False), _Group(12, False),
    _Group(3, True), _Group(5, True), _Group(12, True),
)  # fmt: skip

STEP = 0.25
"""Degrees of the input from one position that is drawn around to the next."""

MOST_EXACT = 7
"""Pairs that are met exactly, at most."""

NEAR = 0.5
"""Degrees by which an answer to more pairs misses one at most; the planted linkage misses none."""

MOVED = 15.0
"""Degrees through which an output turns at least."""


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements, one group after the other."""
    for number in range(count):
        group = GROUPS[number % len(GROUPS)]
        exact = group.pairs <= MOST_EXACT
        name = f"{group.pairs} pairs, {'exact' if exact else 'fitted'}, {'pivots given' if group.given else 'anywhere'}"
        good: Callable[[Any], bool] = always if exact else _near
        yield Task(number, name, statement(generator(seed, number), group), good)


def _near(design: Any) -> bool:
    return bool(design.metrics.max_structural_error <= NEAR)


def statement(rng: np.random.Generator, group: _Group) -> Statement:
    """One task."""
    planted, pairs = _planted(rng, group.pairs)
    swept = planted.joints(planted.spread(STEP))
    width = round(float(rng.uniform(4.0, 16.0)), 3)
    bars = {
        name: np.stack([swept[joint] for joint in joints if joint != "P"], axis=1) for name, joints in LINKS.items()
    }
    room = room_around(rng, SweptLinkage(bars, None, width))
    extent = sum(planted.links) / 3.0
    stated: Statement = {"kind": "function", "pairs": pairs, "zeros": None, "space": room}
    if group.given:
        stated["fixed_pivots"] = {
            "input": [planted.o2.real, planted.o2.imag],
            "output": [planted.o4.real, planted.o4.imag],
        }
    else:
        room["fixed_pivots"] = {
            "input": zones_around(rng, planted.o2, extent),
            "output": zones_around(rng, planted.o4, extent),
        }
    if rng.random() < 0.3:
        room["moving_pivots"] = {"input": zones_around(rng, complex(swept["A"][0]), extent)}
    if rng.random() < 0.5:
        least = float(planted.transmission(planted.spread(STEP)).min())
        stated["constraints"] = {"min_transmission_angle": least - 2.0}
    return stated


def _planted(rng: np.random.Generator, count: int) -> tuple[PlantedFourbar, list[dict[str, float]]]:
    """A fourbar, and pairs of what its input and its output have turned, with dials that stand anywhere."""
    while True:
        planted = planted_fourbar(rng)
        gaps = rng.uniform(0.6, 1.4, count - 1)
        inputs = planted.begin + (planted.end - planted.begin) * np.concatenate([[0.0], np.cumsum(gaps) / gaps.sum()])
        at = planted.joints(inputs)
        whole = planted.joints(planted.spread(1.0))
        turned = np.degrees(np.unwrap(np.angle(whole["B"] - whole["O4"])))
        if np.ptp(turned) < MOVED:
            continue
        outputs = np.degrees(np.unwrap(np.angle(at["B"] - at["O4"])))
        dials = rng.uniform(-180.0, 180.0, 2)
        return planted, [
            {"input": float(x), "output": float(y)}
            for x, y in zip(np.degrees(inputs - inputs[0]) + dials[0], outputs - outputs[0] + dials[1], strict=True)
        ]
