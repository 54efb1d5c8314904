"""Ordinary tasks of all linkage kinds without any limit: is the first answer one that somebody would build?

Answered where the first design has a least transmission angle of 30°, a link ratio of at most 10 and no link longer
than five sizes of the task; or where the summary says why it has not, and no other design of the answer that is as near
to the task, or half as near, has all of it, or angle and ratio where the first has not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from synthesis.results.pareto import measure_error
from tests.support.demands.planted import crank_rocker, curve, listed
from tests.support.demands.task import Task

FAR = 2.0
"""A design with so many times the error of another is no better answer, however well it runs."""

TRANSMISSION, RATIO, REACH = 30.0, 10.0, 5.0
"""What practice asks of the transmission angle, degrees, of the longest link over the shortest, and of the longest link
over the task's size."""

WIDTH = 0.02
"""Width of the links, as a share of the longest, below which a design cannot be built."""

Statement = dict[str, Any]


def tasks(count: int, seed: int) -> Iterator[Task]:
    """The statements, the kinds in turn."""
    rng = np.random.default_rng(seed)
    for n in range(count):
        name, stated = KINDS[n % len(KINDS)]
        yield Task(stated(rng), _buildable, f"{name} {n}")


def _buildable(result: Any) -> bool:
    if not result.designs:
        return True
    if _sound(result.designs[0]):
        return True
    first, error = result.designs[0], FAR * measure_error(result.designs[0])
    told = (
        (first.metrics.min_transmission_angle >= TRANSMISSION or f"{TRANSMISSION:.0f}°" in result.summary)
        and (first.metrics.link_ratio <= RATIO or "ratio" in result.summary)
        and (not _even(first) or "task's size" in result.summary)
    )
    # What nobody can build is listed last, however well it runs.
    rivals = [design for design in result.designs if _can_be_built(design) >= _can_be_built(first)]
    near = [design for design in rivals if measure_error(design) <= error and _comparable(first, design)]
    return told and not any(map(_sound, near)) and (_even(first) or not any(map(_even, near)))


def _can_be_built(design: Any) -> bool:
    width = getattr(design.metrics, "relative_link_width", None)
    return width is None or width >= WIDTH


def _comparable(first: Any, design: Any) -> bool:
    """Linkages of a vehicle come before gears with slides, and tie rods inside the wheels before others, anyway."""
    if not hasattr(design.metrics, "steering_error"):
        return True
    return design.mechanism.type == first.mechanism.type and (design.metrics.tie_rod_clearance or 0.0) >= 0.0


def _even(design: Any) -> bool:
    return bool(design.metrics.min_transmission_angle >= TRANSMISSION and design.metrics.link_ratio <= RATIO)


def _sound(design: Any) -> bool:
    reach = getattr(design.metrics, "reach", None)
    return _even(design) and (reach is None or reach <= REACH)


def _motion(positions: int) -> Callable[[np.random.Generator], Statement]:
    def stated(rng: np.random.Generator) -> Statement:
        way = np.cumsum(rng.uniform(15.0, 45.0, positions) * np.exp(1j * np.cumsum(rng.normal(0.0, 0.35, positions))))
        angles = np.cumsum(rng.uniform(5.0, 35.0, positions) * rng.choice([-1.0, 1.0]))
        poses = [{**place, "angle": float(angle)} for place, angle in zip(listed(way), angles, strict=True)]
        return {"kind": "motion", "positions": poses}

    return stated


def _path(points: int) -> Callable[[np.random.Generator], Statement]:
    def stated(rng: np.random.Generator) -> Statement:
        way = np.cumsum(rng.uniform(15.0, 45.0, points) * np.exp(1j * np.cumsum(rng.normal(0.0, 0.35, points))))
        return {"kind": "path", "points": listed(way)}

    return stated


def _closed_curve(rng: np.random.Generator) -> Statement:
    turns = np.linspace(0.0, math.tau, 40, endpoint=False)
    wide, high, lean = rng.uniform(30.0, 80.0), rng.uniform(15.0, 50.0), rng.uniform(-0.3, 0.3)
    oval = wide * np.cos(turns) + 1j * high * np.sin(turns) * (1.0 + lean * np.cos(turns))
    return {"kind": "path", "points": listed(oval * np.exp(1j * rng.uniform(0.0, math.tau))), "closed": True}


def _planted_curve(rng: np.random.Generator) -> Statement:
    return {
        "kind": "path",
        "points": listed(curve(crank_rocker(rng, 25.0), np.linspace(0.0, math.tau, 30, endpoint=False))),
        "closed": True,
        "method": "curve_match",
    }


FUNCTIONS = {"sine": [0.0, 90.0], "exponential": [0.0, 1.0], "logarithm": [1.0, 2.0], "tangent": [0.0, 45.0]}
"""Classic functions with the ranges that they are generated over."""


def _function(rng: np.random.Generator) -> Statement:
    name = list(FUNCTIONS)[int(rng.integers(len(FUNCTIONS)))]
    return {
        "kind": "function",
        "function": {"name": name, "x": FUNCTIONS[name]},
        "input_range": float(rng.integers(5, 13) * 10),
        "output_range": float(rng.integers(4, 11) * 10),
    }


def _pairs(rng: np.random.Generator) -> Statement:
    inputs = np.cumsum(rng.uniform(15.0, 30.0, 3))
    outputs = np.cumsum(rng.uniform(10.0, 30.0, 3))
    pairs = [{"input": float(x), "output": float(y)} for x, y in zip(inputs, outputs, strict=True)]
    return {"kind": "function", "pairs": pairs}


def _quick_return(rng: np.random.Generator) -> Statement:
    output = {"swing": float(rng.integers(3, 8) * 10)} if rng.random() < 0.5 else {"stroke": 100.0}
    return {"kind": "quick_return", "time_ratio": round(float(rng.uniform(1.0, 1.6)), 2), **output, "mechanism": "auto"}


def _straight_line(rng: np.random.Generator) -> Statement:
    return {
        "kind": "straight_line",
        "length": 100.0,
        "crank_range": float(rng.integers(6, 16) * 10),
        "mechanism": "auto",
    }


def _dwell(rng: np.random.Generator) -> Statement:
    output = {"type": "rocker", "swing": float(rng.integers(3, 9) * 10)}
    return {"kind": "dwell", "dwell_angle": float(rng.integers(3, 8) * 10), "output": output, "mechanism": "pseudo_arc"}


def _steering(rng: np.random.Generator) -> Statement:
    return {
        "kind": "steering",
        "wheelbase": float(rng.uniform(2200.0, 3200.0)),
        "pivot_distance": float(rng.uniform(1100.0, 1500.0)),
        "lock": float(rng.uniform(25.0, 42.0)),
    }


def _parallel_motion(rng: np.random.Generator) -> Statement:
    planted = crank_rocker(rng, 30.0)
    o2, o4 = (complex(pivot) for pivot in (planted.input_pivot, planted.output_pivot))
    point = complex(planted.coupler_point)
    return {
        "kind": "parallel_motion",
        "linkage": {
            "fixed_pivots": {"input": [o2.real, o2.imag], "output": [o4.real, o4.imag]},
            "links": {name: float(getattr(planted, name)) for name in ("input", "coupler", "output")},
            "coupler_point": {"distance": abs(point), "angle": math.degrees(math.atan2(point.imag, point.real))},
            "assembly": "open",
        },
    }


KINDS: list[tuple[str, Callable[[np.random.Generator], Statement]]] = [
    ("two positions", _motion(2)),
    ("three positions", _motion(3)),
    ("four positions", _motion(4)),
    ("five positions", _motion(5)),
    ("seven positions", _motion(7)),
    ("four points", _path(4)),
    ("five points", _path(5)),
    ("ten points", _path(10)),
    ("closed curve", _closed_curve),
    ("planted curve", _planted_curve),
    ("function", _function),
    ("pairs", _pairs),
    ("quick return", _quick_return),
    ("straight line", _straight_line),
    ("dwell", _dwell),
    ("steering", _steering),
    ("parallel motion", _parallel_motion),
]
"""What is asked in turn, by name."""
