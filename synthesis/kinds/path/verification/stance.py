"""Measurement of a finished linkage in its stance by dense driving: the band of P's heights, and the speed of P.

P is followed between the inputs at which it passes the stance's first point and its last. Heights of P are measured
across the line through these two required points; maximum minus minimum is the flatness. The speed of P along the line,
its displacement per radian of the input, is compared with the mean over the stance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.refined_extremes import GRID_SIZE, find_minimum_near
from kinematics.message import compose
from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.answer import Check
from synthesis.model.dimension import LENGTH
from synthesis.verification.checks import check_maximum

DIFFERENCE_STEP = 1e-4
"""Half of the angle, radians, over which P's displacement is differenced for its speed; the relative error is the angle
squared, some 1e-8 of the speed."""


def measure_stance(
    problem: PathProblem, place: Callable[[Real], Complex], used: tuple[float, float], inputs: Real
) -> dict[str, float]:
    """Measure a stance: flatness (length units), maximum deviation of speed (share of its mean), rotation (degrees).

    Quantities that are undefined, because P has no position or does not advance along the line, are left out; empty
    without a stance.

    Parameters
    ----------
    problem : PathProblem
        The problem.
    place : callable
        Place of P at inputs (n,), radians, shape (n,); NaN where it has no position.
    used : tuple of float
        The first and the last input that is used: a whole cycle for a closed path.
    inputs : float, shape (points,)
        Radians, in one run, at which P passes the points.
    """
    stance = problem.stance
    if stance is None:
        return {}
    first, last = stance.points
    start, end = float(inputs[first]), float(inputs[last])
    if stance.wraps_around:
        # The stance continues past the last point into the next cycle.
        end += math.copysign(used[1] - used[0], float(inputs[-1] - inputs[0]))
    way = problem.points[last].point - problem.points[first].point
    along = np.conj(way / abs(way))
    at = np.linspace(start, end, GRID_SIZE)

    def evaluate_height(closer: Real) -> Real:
        return np.asarray((place(closer) * along).imag)

    def evaluate_speed(closer: Real) -> Real:
        return np.asarray(
            ((place(closer + DIFFERENCE_STEP) - place(closer - DIFFERENCE_STEP)) * along).real / (2.0 * DIFFERENCE_STEP)
        )

    heights = evaluate_height(at)
    found: dict[str, float] = {"rotation": math.degrees(abs(end - start))}
    # Without a motion, or across a toggle, only the rotation is defined.
    if start == end or not np.isfinite(heights).all():
        return found
    _, lowest = find_minimum_near(evaluate_height, at, heights)
    _, highest = find_minimum_near(lambda closer: -evaluate_height(closer), at, -heights)
    found["flatness"] = -highest - lowest
    # The mean speed over the stance follows from its ends alone.
    ends = place(np.array([start, end]))
    mean = float(((ends[1] - ends[0]) * along).real) / (end - start)
    speeds = evaluate_speed(at)
    if mean == 0.0 or not np.isfinite(speeds).all():
        return found
    _, slowest = find_minimum_near(lambda closer: evaluate_speed(closer) / mean, at, speeds / mean)
    _, fastest = find_minimum_near(lambda closer: -evaluate_speed(closer) / mean, at, -speeds / mean)
    found["speed_deviation"] = max(1.0 - slowest, -fastest - 1.0)
    return found


def check_stance(problem: PathProblem, found: Mapping[str, float]) -> list[Check]:
    """Check a stance against its limits; a quantity that was not measured fails."""
    stance = problem.stance
    if stance is None:
        return []
    checks = []
    if stance.flatness is not None:
        flat = found.get("flatness")
        checks.append(
            Check(name="stance_flatness", passed=False)
            if flat is None
            else check_maximum("stance_flatness", flat, stance.flatness, LENGTH)
        )
    if stance.off_mean is not None:
        uneven = found.get("speed_deviation")
        checks.append(
            Check(name="stance_speed", passed=False)
            if uneven is None
            else check_maximum("stance_speed", uneven, stance.off_mean)
        )
    return checks


def describe_stance(designs: Sequence[PathDesign], problem: PathProblem) -> str:
    """Describe in a sentence the best stance among the designs that satisfy all constraints.

    Empty without a stance, without such designs, and if not all designs will be listed.
    """
    passed = [design.metrics for design in designs if design.verification.passed]
    flatness = [metrics.stance_flatness for metrics in passed if metrics.stance_flatness is not None]
    uneven = [metrics.stance_speed_deviation for metrics in passed if metrics.stance_speed_deviation is not None]
    if problem.stance is None or problem.is_listed_later or not flatness:
        return ""
    band, unit = f"{min(flatness):.3g}", problem.length_unit
    if not uneven:
        return compose("path-flattest-stance", flatness=band, unit=unit)
    return compose(
        "path-flattest-and-most-even-stance", flatness=band, unit=unit, deviation=f"{100.0 * min(uneven):.3g}"
    )
