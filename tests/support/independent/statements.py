"""What is asked for the comparison: ordinary tasks of all linkage kinds, every type of linkage, and every demand.

A family yields statements without end; families that take long are asked less often than others.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import count
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from tests.support.demands import closed_curves, function_constraints, motion_constraints, path_constraints, positions
from tests.support.demands.ordinary import KINDS as ORDINARY
from tests.support.demands.planted import box, crank_rocker, curve, extent, listed

Statement = dict[str, Any]
Draw = Callable[[np.random.Generator], Statement]


class Family(NamedTuple):
    """Statements of one sort.

    Attributes
    ----------
    name : str
    stated : callable
        One more statement.
    every : int
        In which rounds the family is asked: in each, or in every so many.
    """

    name: str
    stated: Draw
    every: int = 1


def families() -> list[Family]:
    """All families; each call begins those that are drawn in rows anew."""
    ordinary = [Family(name, draw, SLOW.get(name, 1)) for name, draw in ORDINARY]
    rows = [Family(f"{module.__name__.rpartition('.')[2]}", _row(module), every) for module, every in ROWS]
    return [*ordinary, *(Family(name, draw, SLOW.get(name, 1)) for name, draw in MORE), *rows]


SLOW = {"four points": 3, "five points": 3, "ten points": 3, "geared fivebar": 3, "closed curve": 2}
"""Families that take many seconds."""

ROWS: list[tuple[ModuleType, int]] = [
    (positions, 1),
    (motion_constraints, 1),
    (path_constraints, 2),
    (function_constraints, 1),
    (closed_curves, 2),
]
"""Planted problems with demands."""


def _row(module: ModuleType) -> Draw:
    numbers = count(1)
    drawn: list[Iterator[Any]] = []

    def stated(rng: np.random.Generator) -> Statement:
        if not drawn:
            drawn.append(module.tasks(10_000, int(rng.integers(2**31)) + next(numbers)))
        return dict(next(drawn[0]).statement)

    return stated


def _way(rng: np.random.Generator, number: int) -> Any:
    return np.cumsum(rng.uniform(15.0, 45.0, number) * np.exp(1j * np.cumsum(rng.normal(0.0, 0.35, number))))


def _poses(rng: np.random.Generator, number: int) -> list[dict[str, Any]]:
    angles = np.cumsum(rng.uniform(5.0, 35.0, number) * rng.choice([-1.0, 1.0]))
    return [{**place, "angle": float(angle)} for place, angle in zip(listed(_way(rng, number)), angles, strict=True)]


def _carried(number: int, **demands: Any) -> Draw:
    return lambda rng: {"kind": "motion", "positions": _poses(rng, number), **demands}


def _sides(rng: np.random.Generator) -> Statement:
    """Three positions with pivots, a line of the ground, or rotations and coupler vectors that are given."""
    poses = _poses(rng, 3)
    first = complex(poses[0]["x"], poses[0]["y"])

    def near() -> list[float]:
        place = first + complex(*rng.uniform(-80.0, 80.0, 2))
        return [place.real, place.imag]

    demands: Statement = [
        {"input_side": {"fixed_pivot": near()}, "output_side": {"fixed_pivot": near()}},
        {"input_side": {"moving_pivot": near()}, "output_side": {"moving_pivot": near()}},
        {"ground_line": {"point": near(), "angle": float(rng.uniform(0.0, 180.0))}},
        {"input_side": {"rotations": [float(rng.uniform(10.0, 40.0)), float(rng.uniform(50.0, 90.0))]}},
        {"input_side": {"coupler_vector": {"length": 30.0, "angle": float(rng.uniform(0.0, 360.0))}}},
        {"output_side": {"link_angle": float(rng.uniform(0.0, 360.0))}},
    ][int(rng.integers(6))]
    return {"kind": "motion", "positions": poses, **demands}


def _room(rng: np.random.Generator) -> Statement:
    """Three positions with a zone for each pivot, a box, and a post and a beam beside the way."""
    poses = _poses(rng, 3)
    z = np.array([complex(pose["x"], pose["y"]) for pose in poses])
    size = float(np.abs(z[:, None] - z).max())
    middle, along = complex(z.mean()), complex(z[-1] - z[0]) / abs(z[-1] - z[0])

    def spot(reach: float) -> list[float]:
        place = middle + reach * size * along * 1j + 0.3 * size * complex(*rng.uniform(-1.0, 1.0, 2))
        return [place.real, place.imag]

    zone = {"circle": {"center": spot(-0.6), "radius": 0.8 * size}}
    at = complex(*spot(2.0))
    beam = [at + 0.3 * size * along * corner for corner in (-1 - 0.2j, 1 - 0.2j, 1 + 0.2j, -1 + 0.2j)]
    low, high = middle - 3.0 * size * (1 + 1j), middle + 3.0 * size * (1 + 1j)
    return {
        "kind": "motion",
        "positions": poses,
        "space": {
            "fixed_pivots": {"input": zone, "output": [zone, {"circle": {"center": spot(-1.0), "radius": size}}]},
            "box": [[low.real, low.imag], [high.real, high.imag]],
            "obstacles": [
                {"circle": {"center": spot(1.4), "radius": 0.1 * size}},
                {"polygon": [[corner.real, corner.imag] for corner in beam]},
            ],
            "link_width": 0.05 * size,
        },
    }


def _tolerated_fit(rng: np.random.Generator) -> Statement:
    poses: list[dict[str, Any]] = _poses(rng, 6)
    for pose in poses[1:-1]:
        pose["tolerance"] = {"x": 6.0, "y": 6.0, "angle": 6.0} if rng.random() < 0.5 else 8.0
    return {"kind": "motion", "positions": poses}


def _timed(rng: np.random.Generator) -> Statement:
    planted = crank_rocker(rng, 25.0)
    absolute = rng.random() < 0.5
    number = 4 if absolute else 5
    turns = np.cumsum(rng.uniform(0.3, 1.0, number))
    points = listed(curve(planted, turns))
    for point, turn in zip(points, turns, strict=True):
        point["crank_angle"] = math.degrees(float(turn))
    return {
        "kind": "path",
        "timing": "prescribed",
        "crank_phase": "absolute" if absolute else "free",
        "points": points,
    }


def _tolerated_path(rng: np.random.Generator) -> Statement:
    closed = bool(rng.random() < 0.5)
    planted = crank_rocker(rng, 30.0)
    begin = rng.uniform(0.0, math.tau)
    turns = begin + np.linspace(0.0, math.tau if closed else rng.uniform(1.5, 4.0), 16, endpoint=not closed)
    exact = curve(planted, turns)
    size = extent(exact)
    points: list[dict[str, Any]] = listed(exact + 0.005 * size * (rng.normal(size=16) + 1j * rng.normal(size=16)))
    for point in points:
        point["tolerance"] = float(0.04 * size * rng.uniform(0.7, 1.5))
    return {"kind": "path", "method": "least_squares", "closed": closed, "points": points}


def _legged(rng: np.random.Generator) -> Statement:
    """The stance of a planted linkage, where its curve is flattest, held to what it does there and 5 % more."""
    planted = crank_rocker(rng, 30.0)
    turns = np.linspace(0.0, math.tau, 20, endpoint=False)
    dense = np.linspace(0.0, 0.25 * math.tau, 2000)

    def walked(first: int) -> tuple[float, float, float]:
        steps = curve(planted, turns[first] + dense)
        along = (steps - steps[0]) / (steps[-1] - steps[0])
        speeds = np.gradient(along.real, dense) * dense[-1]
        way = abs(steps[-1] - steps[0])
        return float(np.ptp(along.imag)), float(np.abs(speeds - 1.0).max()), way

    first = min(range(20), key=lambda k: walked(k)[0])
    flat, uneven, way = walked(first)
    stance = {"points": [first, (first + 5) % 20], "flatness": 1.05 * flat * way}
    return {
        "kind": "path",
        "method": str(rng.choice(["curve_match", "least_squares"])),
        "closed": True,
        "points": listed(curve(planted, turns)),
        "stance": stance | {"speed": "constant", "speed_tolerance": 1.05 * uneven},
    }


def _given_pivots(rng: np.random.Generator) -> Statement:
    planted = crank_rocker(rng, 25.0)
    pivots = {
        name: [float(np.real(z)), float(np.imag(z))]
        for name, z in (("input", planted.input_pivot), ("output", planted.output_pivot))
    }
    points = listed(curve(planted, rng.uniform(0.0, 3.0) + np.cumsum(rng.uniform(0.3, 0.9, 5))))
    return {"kind": "path", "points": points, "fixed_pivots": pivots}


def _open_curve(rng: np.random.Generator) -> Statement:
    planted = crank_rocker(rng, 25.0)
    points = curve(planted, rng.uniform(0.0, 6.0) + np.linspace(0.0, rng.uniform(1.0, 3.0), 20))
    return {"kind": "path", "points": listed(points), "method": "curve_match"}


def _placed_curve(rng: np.random.Generator) -> Statement:
    planted = crank_rocker(rng, 25.0)
    points = curve(planted, np.linspace(0.0, math.tau, 32, endpoint=False))
    o2, o4 = complex(planted.input_pivot) + 200.0, complex(planted.output_pivot) + 200.0
    return {
        "kind": "path",
        "points": listed(points),
        "closed": True,
        "method": "curve_match",
        "placement_free": ["position", "rotation"],
        "constraints": {"fixed_pivot_region": box([o2, o4], 40.0)},
    }


def _other_path(mechanism: str) -> Draw:
    def stated(rng: np.random.Generator) -> Statement:
        return {"kind": "path", "mechanism": mechanism, "points": listed(_way(rng, 5))}

    return stated


FUNCTIONS: list[Statement] = [
    {"name": "power", "exponent": 1.5, "x": [1.0, 4.0]},
    {"name": "reciprocal", "x": [1.0, 2.0]},
    {"name": "logarithm", "x": [1.0, 10.0]},
    {"name": "cosine", "x": [10.0, 80.0]},
    {"name": "sine", "x": [0.0, 60.0]},
    {"name": "exponential", "base": 2.0, "x": [0.0, 1.0]},
]


def _function(rng: np.random.Generator) -> Statement:
    """Functions by precision points, least squares and minimax, with fourbars and slider-cranks."""
    stated: Statement = {
        "kind": "function",
        "function": FUNCTIONS[int(rng.integers(len(FUNCTIONS)))],
        "input_range": float(rng.integers(5, 11) * 10),
        "output_range": float(rng.integers(4, 9) * 10),
    }
    if rng.random() < 0.4:
        stated["mechanism"] = "slider_crank"
    aim = rng.random()
    if aim < 0.5:
        stated["precision_points"] = int(rng.integers(3, 5))
    elif aim < 0.75:
        stated["criterion"] = "least_squares"
    if rng.random() < 0.3 and "mechanism" not in stated:
        stated["zeros"] = {"input": float(rng.uniform(20.0, 80.0)), "output": float(rng.uniform(20.0, 80.0))}
    return stated


def _dwell(**demands: Any) -> Draw:
    def stated(rng: np.random.Generator) -> Statement:
        angle = float(round(rng.uniform(25.0, 55.0), 2))
        return {"kind": "dwell", "dwell_angle": angle, "constraints": {"max_link_ratio": 20.0}, **demands}

    return stated


def _placed_dwells(rng: np.random.Generator) -> Statement:
    """Two unequal dwells of a slider, or one within the stroke, or a long one of a rocker."""
    angles = [float(round(one, 1)) for one in rng.uniform(25.0, 55.0, 2)]
    sorts: list[Statement] = [
        {"dwells": [{"angle": angles[0], "at": "low"}, {"angle": angles[1], "at": "high"}]},
        {"dwells": [{"angle": angles[0], "at": float(round(rng.uniform(0.2, 0.8), 2))}]},
    ]
    sort = int(rng.integers(3))
    if sort < 2:
        return {"kind": "dwell", "output": {"type": "slider", "stroke": 50.0}, **sorts[sort], "max_designs": 4}
    return {
        "kind": "dwell",
        "dwells": [{"angle": angles[0], "at": "high"}],
        "mechanism": "watt_2",
        "output": {"type": "rocker", "swing": 40.0},
    }


def _slider_dwell(rng: np.random.Generator) -> Statement:
    stroke = float(rng.uniform(30.0, 80.0))
    return {
        "kind": "dwell",
        "dwell_angle": float(rng.integers(3, 6) * 10),
        "output": {"type": "slider", "stroke": stroke},
    }


def _body_on_rocker(rng: np.random.Generator) -> Statement:
    first, second = _poses(rng, 2)
    second["angle"] = first["angle"] + float(rng.uniform(25.0, 70.0)) * float(rng.choice([-1.0, 1.0]))
    ratio = round(float(rng.uniform(1.0, 1.3)), 2)
    return {"kind": "quick_return", "time_ratio": ratio, "positions": [first, second]}


def _quick_return(rng: np.random.Generator) -> Statement:
    stated = {"kind": "quick_return", "time_ratio": round(float(rng.uniform(1.05, 1.5)), 3)}
    if rng.random() < 0.5:
        return {**stated, "swing": float(rng.uniform(30.0, 60.0)), "constraints": {"min_transmission_angle": 20.0}}
    constraints = {"max_link_ratio": 30.0, "link_length": {"min": 0.5, "max": 2000.0}}
    return {**stated, "stroke": float(rng.uniform(50.0, 150.0)), "constraints": constraints}


def _line(rng: np.random.Generator) -> Statement:
    return {
        "kind": "straight_line",
        "length": float(rng.uniform(40.0, 120.0)),
        "direction": float(rng.uniform(-180.0, 180.0)),
        "start": [float(x) for x in rng.uniform(-50.0, 50.0, 2)],
        "optimize": str(rng.choice(["straightness", "velocity"])),
        "rotation": str(rng.choice(["any", "ccw", "cw"])),
        "max_velocity_variation": 95.0,
        **({"max_deviation": 5.0} if rng.random() < 0.5 else {}),
    }


def _steering(rng: np.random.Generator) -> Statement:
    distance = float(rng.uniform(1100.0, 1500.0))
    return {
        "kind": "steering",
        "wheelbase": float(rng.uniform(2200.0, 3200.0)),
        "pivot_distance": distance,
        "track": distance + float(rng.uniform(0.0, 300.0)),
        "lock": float(rng.uniform(25.0, 42.0)),
        "max_steering_error": 4.0,
        "wheel_width": 1.0,
        "constraints": {"max_link_ratio": 12.0, "min_transmission_angle": 5.0},
    }


def _parallel_path(rng: np.random.Generator) -> Statement:
    return {"kind": "parallel_motion", "path": _given_pivots(rng)}


MORE: list[tuple[str, Draw]] = [
    ("room", _room),
    ("output slides in the body", _carried(3, output_side={"dyad": "RP"})),
    (
        "output slides",
        lambda rng: _carried(3, output_side={"dyad": "PR", "slide_angle": float(rng.uniform(0, 90))})(rng),
    ),
    ("input slides", _carried(3, input_side={"dyad": "PR"})),
    ("input is driven", _carried(3, driver_dyad={"link": "input"})),
    ("output is driven", _carried(3, driver_dyad={"link": "output"})),
    ("coupler is driven", _carried(2, driver_dyad={"link": "coupler"})),
    ("sides", _sides),
    ("tolerated fit", _tolerated_fit),
    ("timed path", _timed),
    ("tolerated path", _tolerated_path),
    ("path with a stance", _legged),
    ("given pivots", _given_pivots),
    ("open curve", _open_curve),
    ("placed curve", _placed_curve),
    ("slider-crank along a path", _other_path("slider_crank")),
    ("geared fivebar", _other_path("geared_fivebar")),
    ("functions", _function),
    ("slider that dwells", _slider_dwell),
    ("dwells at their places", _placed_dwells),
    ("two dwells", _dwell(count=2, output={"type": "rocker", "swing": 40.0})),
    ("triad that dwells", _dwell(output={"type": "rocker", "swing": 45.0}, mechanism="stephenson_2", max_designs=4)),
    ("slot that dwells", _dwell(output={"type": "rocker", "swing": 40.0}, mechanism="straight_slot")),
    ("body on a rocker", _body_on_rocker),
    ("demands of quick return", _quick_return),
    ("demands of a line", _line),
    ("demands of steering", _steering),
    ("parallel motion along a path", _parallel_path),
]
"""Types and demands that ordinary tasks do not have, by name."""
