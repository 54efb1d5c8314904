"""Closed curves by sixbars and by fourbars: feet of walking machines, curves of the literature, and twenty shapes.

The feet are those of Klann's and of Jansen's leg with their published dimensions, driven by the analysis core. The
eight curves named gcp are those of the file named by ``MECHSYNTH_CURVES``, if there is one; the shapes are those of
:mod:`tests.support.problems.closed_shapes`. Errors are root mean squares of the distances of points from the curve and
of the curve from the polyline through the points, both ways alike, in percent of the diagonal of the box about the
points, or of the step's length for feet; measured here, on the whole turn of the design as the analysis core drives it.
"""

from __future__ import annotations

import json
import math
import os
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.support.problems.closed_shapes import SHAPES, outline
from tests.support.problems.walking_legs import LEGS, foot
from tests.support.sixbars.spread import each

TASKS = 30
TURN = np.linspace(0.0, 2.0 * np.pi, 2881)
SOUND, SHARE, ENOUGH = 15.0, 0.4, 0.05
"""Least transmission angle of what counts; share of the fourbar's error, and percent, of which either is enough."""


def targets() -> dict[str, tuple[Complex, float]]:
    """Points and the length that errors are a share of, by name."""
    listed = {name: (points := foot(name), float(np.ptp(points.real))) for name in LEGS}
    stored = os.environ.get("MECHSYNTH_CURVES")
    if stored:
        curves = json.loads(Path(stored).read_text())["curves"]
        listed |= {
            name: _sized(np.array([complex(*point) for point in curve["points"]]))
            for name, curve in curves.items()
            if name.startswith("gcp_")
        }
    return listed | {name: _sized(outline(name)) for name in SHAPES}


def _sized(points: Complex) -> tuple[Complex, float]:
    return points, math.hypot(float(np.ptp(points.real)), float(np.ptp(points.imag)))


def off(places: Complex, points: Complex) -> NDArray[np.float64]:
    """Distances of places from the closed polyline through points."""
    sides, gaps = np.roll(points, -1) - points, places[:, None] - points
    share = np.clip((gaps * sides.conj()).real / np.maximum(np.abs(sides) ** 2, 1e-300), 0.0, 1.0)
    return np.asarray(np.abs(gaps - share * sides).min(axis=1))


def both_ways(mechanism: Mechanism, points: Complex) -> float:
    """The root mean square of the distances both ways over a turn of a mechanism."""
    motion = drive(mechanism, float(mechanism.reference_input) + TURN, order=0)
    curve = motion.joints["P"][0]
    steps, back = np.abs(np.diff(curve)), off(0.5 * (curve[1:] + curve[:-1]), points)
    forth = off(points, curve[:-1])
    return math.sqrt(0.5 * (float(np.mean(forth**2)) + float((back**2 * steps).sum() / steps.sum())))


def solved(points: Complex, **more: Any) -> tuple[Any, float, float]:
    problem = {
        "kind": "path",
        "method": "curve_match",
        "closed": True,
        "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
        "max_designs": 12,
        **more,
    }
    wall, processor = time.perf_counter(), time.process_time()
    result = solve(parse_problem(problem))
    return result, time.process_time() - processor, time.perf_counter() - wall


def least(result: Any, points: Complex, angle: float = 0.0) -> Any:
    """The error and the design of the nearest that transmits with an angle; infinity where there is none."""
    passed = [d for d in result.designs if d.verification.passed and d.metrics.min_transmission_angle >= angle]
    errors = [(both_ways(rebuild_mechanism(design.mechanism), points), design) for design in passed]
    return min(errors, key=lambda one: one[0], default=(math.inf, None))


def tried(name: str, points: Complex, length: float, seed: int) -> tuple[bool, str]:
    """Whether a curve is drawn well enough, and its row."""
    fourbars, _, _ = solved(points, seed=seed)
    sixbars, processor, wall = solved(points, seed=seed, mechanisms=["watt_1", "stephenson_1", "stephenson_3"])
    simple, plain = least(fourbars, points)
    error, best = least(sixbars, points, SOUND)
    simple, error = 100.0 * simple / length, 100.0 * error / length
    angles = [0.0 if one is None else one.metrics.min_transmission_angle for one in (plain, best)]
    kind, link = ("none", "") if best is None else (best.mechanism.type, best.point_link)
    row = (
        f"{name:<20}{simple:>10.3f}{angles[0]:>6.0f}°{error:>10.3f}{angles[1]:>6.0f}°{error / simple:>8.2f}  "
        f"{kind:<14}{link:<8}{processor:>6.1f}{wall:>7.1f}"
    )
    return error <= max(SHARE * simple, ENOUGH), row


def table(tasks: int, seed: int) -> None:
    print(
        f"{'curve':<20}{'fourbar %':>10}{'at':>7}{'sixbar %':>10}{'at':>7}{'share':>8}  "
        f"{'type':<14}{'P on':<8}{'CPU s':>6}{'wall s':>7}"
    )
    met = 0
    listed = [(name, *target, seed) for name, target in targets().items()][:tasks]
    for enough, row in each(tried, listed):
        met += enough
        print(row, flush=True)
    print(f"{met} of {len(listed)}: at most {SHARE:g} of the best fourbar's error, or {ENOUGH:g} %")
