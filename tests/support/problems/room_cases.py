"""Code that several tests share: room cases."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

Room = dict[str, Any]
Corners = list[list[float]]


def rectangle(x: float, y: float, width: float, height: float) -> Corners:
    """Corners from the lower left one, counter-clockwise."""
    return [[x, y], [x + width, y], [x + width, y + height], [x, y + height]]


def star(x: float, y: float, size: float, points: int) -> Corners:
    """A concave polygon of twice as many corners as it has points."""
    return [
        [
            x + size * (1.0, 0.4)[k % 2] * math.cos(math.pi * k / points),
            y + size * (1.0, 0.4)[k % 2] * math.sin(math.pi * k / points),
        ]
        for k in range(2 * points)
    ]


def comb(x: float, y: float, size: float, teeth: int) -> Corners:
    """A concave polygon with narrow gaps, in which a pivot could be lost."""
    pitch = size / teeth
    top: Corners = []
    for k in range(teeth):
        left = x + k * pitch
        top += [[left, y], [left, y + size], [left + 0.9 * pitch, y + size], [left + 0.9 * pitch, y]]
    return [*top, [x + size, y - 0.1 * size], [x, y - 0.1 * size]]


def obstacles(*zones: Any, **more: Any) -> Room:
    """A room with these in the way: corners of polygons, or (x, y, radius) of circles."""
    return {"obstacles": [zone(one) for one in zones], **more}


def zone(one: Any) -> dict[str, Any]:
    """Corners of a polygon, or (x, y, radius) of a circle, as a statement has it."""
    return {"circle": {"center": list(one[:2]), "radius": one[2]}} if isinstance(one, tuple) else {"polygon": one}


def pivots(*zones: Any, sides: tuple[str, ...] = ("input", "output"), of: str = "fixed_pivots") -> Room:
    """A room with these zones for the pivots of both sides."""
    return {of: {side: [zone(one) for one in zones] if len(zones) != 1 else zone(zones[0]) for side in sides}}


REFUSED: dict[str, Callable[[float], tuple[Room, str]]] = {
    "a bow": lambda s: (obstacles([[0, 0], [s, s], [s, 0], [0, s]]), "obstacles/0/polygon"),
    "a spike": lambda s: (obstacles([[0, 0], [s, 0], [2 * s, 0], [s, 0], [s, s]]), "obstacles/0/polygon"),
    "a point": lambda s: (obstacles([[s, s]] * 4), "obstacles/0/polygon"),
    "a line": lambda s: (pivots([[0, 0], [s, s], [2 * s, 2 * s]]), "fixed_pivots/input/polygon"),
    "a needle": lambda s: (pivots([[0, 0], [s, 0], [s, 1e-12 * s]]), "fixed_pivots/input/polygon"),
    "two corners": lambda s: (obstacles([[0, 0], [s, s]]), "obstacles/0/polygon"),
    "no corners": lambda s: (obstacles([]), "obstacles/0/polygon"),
    "6000 corners": lambda s: (obstacles(star(0, 0, s, 3000)), "obstacles/0/polygon"),
    "a circle of radius 0": lambda s: (obstacles((s, s, 0.0)), "obstacles/0/circle/radius"),
    "a circle of radius -1": lambda s: (pivots((s, s, -1.0)), "fixed_pivots/input/circle/radius"),
    "nothing of a zone": lambda s: ({"obstacles": [{}]}, "obstacles/0"),
    "two shapes at once": lambda s: (
        {"obstacles": [{**zone((0, 0, s)), **zone(rectangle(0, 0, s, s))}]},
        "obstacles/0",
    ),
    "a box of no height": lambda s: ({"box": [[0, 0], [s, 0]]}, "box"),
    "a box inside out": lambda s: ({"box": [[s, s], [0, 0]]}, "box"),
    "51 obstacles": lambda s: (obstacles(*[(k * s, 9 * s, 0.1 * s) for k in range(51)]), "obstacles"),
    "100 zones": lambda s: (pivots(*[(k * s, 9 * s, 0.1 * s) for k in range(100)]), "fixed_pivots/input"),
    "no zones": lambda s: ({"fixed_pivots": {"input": []}}, "fixed_pivots/input"),
    "a number beyond all": lambda s: (obstacles((0, 0, 1e10)), "obstacles/0/circle/radius"),
    "less than no clearance": lambda s: ({"clearance": -s}, "clearance"),
    "less than no width": lambda s: ({"link_width": -s}, "link_width"),
    "another motion": lambda s: ({"over": "always"}, "over"),
    "a body that meets itself": lambda s: (
        {"body": {"outline": [[0, 0], [s, s], [s, 0], [0, s]]}},
        "body",
    ),
}
"""Rooms that no linkage problem may have, by the size of the problem; each with the place of its fault."""

ANSWERED: dict[str, Callable[[float], Room]] = {
    "nothing": lambda s: {},
    "no obstacles": lambda s: {"obstacles": [], "clearance": s, "link_width": s},
    "everything in the way": lambda s: obstacles(rectangle(-1e3 * s, -1e3 * s, 2e3 * s, 2e3 * s)),
    "a wall through the middle": lambda s: obstacles(rectangle(-99 * s, 0.1 * s, 198 * s, 1e-3 * s)),
    "a huge circle in the way": lambda s: obstacles((0.0, 0.0, 1e9)),
    "a huge circle far away": lambda s: obstacles((1e9, 1e9, 1e8)),
    "a tiny circle": lambda s: obstacles((0.0, 9 * s, 1e-9)),
    "a tiny polygon": lambda s: obstacles(rectangle(0.0, 9 * s, 1e-9, 1e-9)),
    "a tiny circle far away": lambda s: obstacles((1e9, -1e9, 1e-9)),
    "tiny zones": lambda s: pivots((0.0, -s, 1e-9)),
    "tiny zones for all pivots": lambda s: {
        **pivots((0.0, -s, 1e-9)),
        **pivots((s, -s, 1e-9), of="moving_pivots"),
    },
    "zones of the world": lambda s: pivots(rectangle(-1e9, -1e9, 2e9, 2e9)),
    "zones far away": lambda s: pivots((9e8, 9e8, 1.0)),
    "concave zones that touch": lambda s: pivots(
        [[-s, -s], [0, -s], [0, 0], [-0.9 * s, 0], [-s, s]], [[0, -s], [s, -s], [s, s], [0.9 * s, 0], [0, 0]]
    ),
    "20 zones": lambda s: pivots(*[((k - 10) * 0.3 * s, -s, 0.2 * s) for k in range(20)]),
    "a comb of a zone": lambda s: pivots(comb(-2 * s, -2 * s, 4 * s, 100)),
    "zones of 1000 corners": lambda s: pivots(star(0.0, 0.0, 3 * s, 500)),
    "zones on one side of the other": lambda s: {
        "fixed_pivots": {"input": zone((0.0, 0.0, 2 * s)), "output": zone((0.0, 0.0, 1e-3 * s))}
    },
    "stars in the way": lambda s: obstacles(
        *[star((k % 3 - 1) * 3 * s, (k // 3) * 3 * s, 0.3 * s, 50) for k in range(6)]
    ),
    "50 circles in the way": lambda s: obstacles(
        *[((k % 10 - 5) * s, (k // 10 - 2) * s, 0.05 * s) for k in range(50)], link_width=0.01 * s
    ),
    "6000 corners in the way": lambda s: obstacles(
        *[star((k % 3 - 1) * 3 * s, (k // 3) * 3 * s, 0.3 * s, 490) for k in range(6)]
    ),
    "6000 corners beside the cycle": lambda s: obstacles(
        *[comb((k % 3 - 1) * 4 * s, (k // 3) * 9 * s - 6 * s, 1.5 * s, 240) for k in range(6)], over="cycle",
    ),
    "zones of 3000 corners": lambda s: pivots(*[star(x, y, 3 * s, 499) for x, y in ((0.0, 0.0), (s, 0.0), (0.0, s))]),
    "a tiny box": lambda s: {"box": [[0, 0], [1e-9, 1e-9]]},
    "a box far away": lambda s: {"box": [[9e8, 9e8], [1e9, 1e9]]},
    "a box of the world": lambda s: {"box": [[-1e9, -1e9], [1e9, 1e9]]},
    "a clearance larger than the box": lambda s: {
        **obstacles((30 * s, 30 * s, s)),
        "box": [[-9 * s, -9 * s], [9 * s, 9 * s]],
        "clearance": 1e3 * s,
    },
    "links wider than the box": lambda s: {"box": [[-9 * s, -9 * s], [9 * s, 9 * s]], "link_width": 1e3 * s},
    "all widths and clearances": lambda s: {
        **obstacles((20 * s, 20 * s, s)), "link_width": 1e9, "clearance": 1e9, "over": "cycle",
    },
    "over the cycle, beside a comb": lambda s: obstacles(comb(2 * s, 2 * s, 3 * s, 100), over="cycle", clearance=1e-9),
    "over the cycle, in a box": lambda s: {
        "box": [[-6 * s, -6 * s], [6 * s, 6 * s]], "over": "cycle", "link_width": 1e-9,
    },
}  # fmt: skip
"""Rooms that a statement may have, and that leave most linkages no place; of as many corners as a request holds."""


def size_of(problem: dict[str, Any]) -> float:
    """About how large the motion is that a problem states."""
    numbers = [abs(number) for name in ("positions", "points", "start") for number in _numbers(problem.get(name))]
    stated = [problem[name] for name in ("stroke", "length", "wheelbase") if isinstance(problem.get(name), float | int)]
    return max([*numbers, *stated], default=1.0) or 1.0


def _numbers(value: Any) -> list[float]:
    if isinstance(value, dict):
        return [number for name, inner in value.items() if name != "angle" for number in _numbers(inner)]
    if isinstance(value, list):
        return [number for inner in value for number in _numbers(inner)]
    return [float(value)] if isinstance(value, int | float) and not isinstance(value, bool) else []
