"""Measure a finished linkage in its stance by dense driving: the band in which P stays, and the evenness of its speed.

P is followed between the inputs at which it passes the stance's first point and its last. Heights of P are measured
across the line through these two required points; maximum minus minimum is the flatness. The speed of P along the line,
its displacement per radian of the input, is compared with the mean over the stance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.design import PathDesign
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.answer import Check
from synthesis.model.dimension import LENGTH
from synthesis.proof.checks import at_most
from synthesis.proof.closer import GRID, least_near

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

APART = 1e-4
"""Half of the angle, radians, over which P's displacement is differenced for its speed; the relative error is the angle
squared, some 1e-8 of the speed."""


def stance_of(
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
    if stance.around:
        # The stance continues past the last point into the next cycle.
        end += math.copysign(used[1] - used[0], float(inputs[-1] - inputs[0]))
    way = problem.points[last].point - problem.points[first].point
    along = np.conj(way / abs(way))
    at = np.linspace(start, end, GRID)

    def height(closer: Real) -> Real:
        return np.asarray((place(closer) * along).imag)

    def speed(closer: Real) -> Real:
        return np.asarray(((place(closer + APART) - place(closer - APART)) * along).real / (2.0 * APART))

    heights = height(at)
    found: dict[str, float] = {"rotation": math.degrees(abs(end - start))}
    # Without a motion, or across a toggle, only the rotation is defined.
    if start == end or not np.isfinite(heights).all():
        return found
    _, lowest = least_near(height, at, heights)
    _, highest = least_near(lambda closer: -height(closer), at, -heights)
    found["flatness"] = -highest - lowest
    # The mean speed over the stance follows from its ends alone.
    ends = place(np.array([start, end]))
    mean = float(((ends[1] - ends[0]) * along).real) / (end - start)
    speeds = speed(at)
    if mean == 0.0 or not np.isfinite(speeds).all():
        return found
    _, slowest = least_near(lambda closer: speed(closer) / mean, at, speeds / mean)
    _, fastest = least_near(lambda closer: -speed(closer) / mean, at, -speeds / mean)
    found["speed_deviation"] = max(1.0 - slowest, -fastest - 1.0)
    return found


def stance_checks(problem: PathProblem, found: Mapping[str, float]) -> list[Check]:
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
            else at_most("stance_flatness", flat, stance.flatness, LENGTH)
        )
    if stance.off_mean is not None:
        uneven = found.get("speed_deviation")
        checks.append(
            Check(name="stance_speed", passed=False)
            if uneven is None
            else at_most("stance_speed", uneven, stance.off_mean)
        )
    return checks


def told_of_stance(designs: Sequence[PathDesign], problem: PathProblem) -> str:
    """Describe in a sentence the best stance among the designs that satisfy all constraints.

    Empty without a stance, without such designs, and if not all designs will be listed.
    """
    passed = [design.metrics for design in designs if design.verification.passed]
    flatness = [metrics.stance_flatness for metrics in passed if metrics.stance_flatness is not None]
    uneven = [metrics.stance_speed_deviation for metrics in passed if metrics.stance_speed_deviation is not None]
    if problem.stance is None or problem.listed_later or not flatness:
        return ""
    text = f" The flattest stance lies within a band of {min(flatness):.3g} {problem.length_unit}"
    return text + (f"; the most even speed stays within {100.0 * min(uneven):.3g} % of its mean." if uneven else ".")
