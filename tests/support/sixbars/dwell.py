"""Dwells: tasks that random sixbars do, found again; and how still an output is over dwells of up to 300°.

Planted: random sixbars of every type are driven, and those that rest at both ends of their way within a hundredth of
it, for longer than any smooth motion does, state their own dwells, way, transmission angle, link ratio and class.
"""

from __future__ import annotations

import math
import statistics
import time
from functools import partial
from typing import Any

import numpy as np

from synthesis.dispatch import solve
from synthesis.kinds.dwell.motion.outputs import (
    CYCLE_SAMPLE_COUNT,
    Carrier,
    Kind,
    compute_output,
    compute_pin_distances,
    locate_points,
)
from synthesis.kinds.dwell.problem import DwellProblem, Turning
from synthesis.kinds.dwell.refine import stephenson_2
from synthesis.kinds.dwell.solver import solve_dwell
from synthesis.kinds.dwell.starts import stephenson_2_starts
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.model.linkage.type_choice import UNCLASSED_SIXBAR
from synthesis.registry import parse_problem

TASKS = 10
"""Of each type."""

TYPES: list[tuple[str, Carrier, Kind, Turning]] = [
    ("pseudo_arc", "coupler", "rocker", "crank_rocker"),
    ("pseudo_arc", "coupler", "slider", "crank_rocker"),
    ("pseudo_arc", "coupler", "slider", "double_crank"),
    ("straight_slot", "coupler", "slot", "crank_rocker"),
    ("watt_2", "rocker", "rocker", "crank_rocker"),
    ("watt_2", "rocker", "slider", "crank_rocker"),
    ("watt_2", "rocker", "slider", "double_crank"),
]

STEPS = 720
DRAWN = 4000
NEAR = 0.01
"""Share of the way that a rest moves."""

LEAST, SUM = 26.0, 66.0
"""Degrees of each rest, and of both: any output has some 23° within a hundredth of its way at an end."""

SOUND, RATIO = 20.0, 10.0
"""Least transmission angle, degrees, and greatest link ratio of a planted sixbar."""

REACH, LEASTS = (60, 120, 180, 240, 300), (15.0, 25.0)
"""Lengths of a single dwell, and least transmission angles, degrees."""

LONG, FLAT, WIDE_RATIO = 300, (1.0, 3.0, 6.0, 10.0, 15.0), 30.0
"""The longest dwell, and what it costs: least transmission angles, degrees, with the greatest link ratio there."""

SHAPES: list[dict[str, Any]] = [{"type": "rocker", "swing": 50.0}, {"type": "slider", "stroke": 50.0}]


def drawn(kind: Kind, carrier: Carrier, turning: Turning, rng: np.random.Generator) -> np.ndarray:
    """Random shapes of a type, most of which are no sixbars that turn."""
    b, c = np.exp(rng.uniform(math.log(0.5), math.log(4.0), (2, DRAWN)))
    d = np.exp(rng.uniform(*((math.log(1.1), math.log(4.0)) if turning == "crank_rocker" else (-1.9, -0.1)), DRAWN))
    p = np.maximum(b, c) * rng.uniform(-1.5, 1.5, (2, DRAWN))
    size = np.exp(rng.uniform(math.log(0.5), math.log(5.0), (3, DRAWN)))
    at = rng.uniform(-5.0, 5.0, (2, DRAWN))
    angle = rng.uniform(0.0, math.tau, DRAWN)
    numbers = {"rocker": [size[0], *at, size[1]], "slider": [size[0], at[0], angle], "slot": list(at)}[kind]
    return np.stack([b, c, d, *p, *numbers], axis=1)


def planted(
    name: str, carrier: Carrier, kind: Kind, turning: Turning, tasks: int, rng: np.random.Generator
) -> list[dict[str, Any]]:
    """Statements of what random sixbars of a type do."""
    turn = np.linspace(0.0, math.tau, STEPS, endpoint=False)
    found: list[dict[str, Any]] = []
    while len(found) < tasks:
        shapes = drawn(kind, carrier, turning, rng)
        b, c, d = shapes[:, :3].T
        longest = np.maximum(np.maximum(b, c), np.maximum(d, 1.0))
        shortest = np.minimum(np.minimum(b, c), np.minimum(d, 1.0))
        first = 1.0 if turning == "crank_rocker" else d
        grashof = (shortest == first) & (2.0 * (shortest + longest) < 0.99 * (1.0 + b + c + d))
        cosine = np.max([np.abs((b * b + c * c - (d + k) ** 2) / (2.0 * b * c)) for k in (-1.0, 1.0)], axis=0)
        shapes = shapes[grashof & (cosine < math.cos(math.radians(SOUND)))]
        sign = int(rng.choice([-1, 1]))
        out, sine = compute_output(kind, sign, shapes, locate_points(shapes, turn, carrier))
        least = sine.min(axis=1)
        kept = np.isfinite(out).all(axis=1) & (least > math.sin(math.radians(SOUND)))
        for shape, course, transmission in zip(shapes[kept], out[kept], least[kept], strict=True):
            b, c, d = shape[:3]
            cosines = [(b * b + c * c - (d + k) ** 2) / (2.0 * b * c) for k in (-1.0, 1.0)]
            angle = min(math.asin(transmission), *(math.acos(abs(cosine)) for cosine in cosines))
            lengths = [1.0, *(float(length[0]) for length in compute_pin_distances(shape[None], kind, carrier))]
            statement = _task(name, kind, turning, max(lengths) / min(lengths), course, math.degrees(angle))
            if statement is not None:
                found.append(statement)
    return found[:tasks]


def planted_triads(tasks: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    """Statements of what random Stephenson II sixbars do."""
    found: list[dict[str, Any]] = []
    nowhere = np.empty((stephenson_2_starts.DRAW_COUNT, 0))
    while len(found) < tasks:
        shapes = stephenson_2_starts.draw_general(rng, stephenson_2_starts.DRAW_COUNT, 1)
        pins = stephenson_2.compute_pin_distances(shapes)
        ratios = pins.max(axis=1) / pins.min(axis=1)
        least = stephenson_2.drive_shapes(shapes, nowhere, CYCLE_SAMPLE_COUNT).sines.min(axis=(1, 2))
        kept = (least > math.sin(math.radians(SOUND))) & (ratios <= RATIO)
        driven = stephenson_2.drive_shapes(shapes[kept], nowhere[kept], STEPS)
        for ratio, course, sines in zip(ratios[kept], driven.course, driven.sines, strict=True):
            statement = _task(
                UNCLASSED_SIXBAR, "triad", None, float(ratio), course, math.degrees(math.asin(sines.min()))
            )
            if statement is not None:
                found.append(statement)
    return found[:tasks]


def _task(
    name: str, kind: Kind, turning: Turning | None, ratio: float, out: np.ndarray, angle: float
) -> dict[str, Any] | None:
    low, way = out.min(), np.ptp(out)
    widths = [
        _width(out - low <= NEAR * way, int(out.argmin())),
        _width(out - low >= (1.0 - NEAR) * way, int(out.argmax())),
    ]
    swings = kind != "slider"
    if ratio > RATIO or min(widths) < LEAST or sum(widths) < SUM or (swings and not 0.1 < way < 2.9):
        return None
    return {
        "kind": "dwell",
        "mechanism": name,
        "dwells": [
            {"angle": math.floor(width - 1.0), "at": at} for width, at in zip(widths, ("low", "high"), strict=True)
        ],
        "output": {"type": "rocker", "swing": math.degrees(way)} if swings else {"type": "slider", "stroke": 50.0},
        "constraints": {
            "min_transmission_angle": max(1.0, math.floor(angle) - 1.0) if kind != "slot" else 15.0,
            "max_link_ratio": math.ceil(10.0 * ratio) / 10.0,
            "grashof": turning or "any",
        },
        "max_designs": 3,
    }


def _width(inside: np.ndarray, at: int) -> float:
    """Degrees of the run of places around one of them that are inside."""
    from_here = np.roll(inside, -at)
    if from_here.all():
        return 360.0
    after = int(np.argmin(from_here))
    before = int(np.argmin(from_here[::-1]))
    return 360.0 / STEPS * (after + before - 1)


def _stillest(wide: float, shape: dict[str, Any], least: float, mechanism: str = "auto", **limits: float) -> str:
    """The least movement that is found, in percent of the way, whether or not it is within the tolerance."""
    asked = parse_problem(
        {
            "kind": "dwell",
            "dwells": [{"angle": wide, "at": "low"}],
            "output": shape,
            "mechanism": mechanism,
            "tolerance": 0.01,
            "include_failed": True,
            "max_designs": 50,
            "constraints": {"min_transmission_angle": least, **limits},
        }
    )
    assert isinstance(asked, DwellProblem)
    found = [
        design
        for design in solve_dwell(asked, lambda *_: None).designs
        if all(check.passed or check.name == "dwell_1" for check in design.verification.checks)
    ]
    return f"{2.0 * min(design.metrics.jitter for design in found):14.2g}" if found else f"{'–':>14}"


def table(tasks: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    print("Planted: two dwells that a random sixbar has, under its own transmission angle, link ratio and class")
    print(f"{'type':>28} {'found':>7} {'angles':>18} {'s CPU':>6}")
    rows = [
        (f"{name} {kind}, {turning}", partial(planted, name, carrier, kind, turning))
        for name, carrier, kind, turning in TYPES
    ]
    for words, statements_of in [*rows, ("stephenson_2 rocker", planted_triads)]:
        statements = statements_of(tasks, rng)
        times, sound = [], 0
        for statement in statements:
            begun = time.process_time()
            problem: Any = parse_problem(statement)
            result: Any = solve(problem)
            times.append(time.process_time() - begun)
            again = [verify_dwell(problem, design.mechanism) for design in result.designs]
            sound += bool(again) and all(design is not None and design.verification.passed for design in again)
        angles = [sum(dwell["angle"] for dwell in statement["dwells"]) for statement in statements]
        print(
            f"{words:>28} {sound:>3}/{len(statements)} {f'{min(angles)} to {max(angles)}':>18} "
            f"{statistics.median(times):6.1f}"
        )
    columns = [f"{shape['type']} {least:g}°" for shape in SHAPES for least in LEASTS]
    columns += [f"triad {least:g}°" for least in LEASTS]
    print("\nA single dwell at an end of a stroke or of a swing of 50°: least movement in percent of the way")
    print(f"{'dwell':>6} " + " ".join(f"{column:>14}" for column in columns))
    for wide in REACH:
        found = [_stillest(wide, shape, least) for shape in SHAPES for least in LEASTS]
        found += [_stillest(wide, SHAPES[0], least, UNCLASSED_SIXBAR) for least in LEASTS]
        print(f"{wide:5d}° " + " ".join(found))
    print(f"\nOne of {LONG}° by the least transmission angle, with link ratios up to {WIDE_RATIO:g}")
    searched = [*((shape, "auto") for shape in SHAPES), (SHAPES[0], UNCLASSED_SIXBAR)]
    print(f"{'angle':>6} " + " ".join(f"{name:>14}" for name in ("rocker", "slider", "triad")))
    for least in FLAT:
        found = [_stillest(LONG, shape, least, name, max_link_ratio=WIDE_RATIO) for shape, name in searched]
        print(f"{least:5g}° " + " ".join(found))
