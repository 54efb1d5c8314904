"""What a finished linkage does in its stance: the band in which P stays, and how evenly it goes, by dense driving.

P is followed between the inputs at which it passes the stance's first point and its last. Across the line through
these two wanted points the places of P have a height; the difference of the greatest and the least is the flatness.
Along the line P has a speed, its way by a radian of the input; it is compared with the whole way over the whole turn.
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
"""Half of the turn, radians, over which P's way is differenced for its speed: the error is that turn's square, some
1e-8 of the speed."""


def stance_of(
    problem: PathProblem, place: Callable[[Real], Complex], used: tuple[float, float], inputs: Real
) -> dict[str, float]:
    """Flatness (length units), greatest deviation of the speed (a share of its mean), rotation (degrees) of a stance.

    What P does not do, as it has no position there or no way along the line, is left out; empty without a stance.

    Parameters
    ----------
    problem : PathProblem
        What was asked.
    place : callable
        Where P is at inputs (n,), radians, shape (n,); NaN where it is nowhere.
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
    if start == end or not np.isfinite(heights).all():
        return found
    _, lowest = least_near(height, at, heights)
    _, highest = least_near(lambda closer: -height(closer), at, -heights)
    found["flatness"] = -highest - lowest
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
    """Whether a stance is as it is stated; what was not measured is not kept."""
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
    """What the best designs that keep all demands do in their stance, in a sentence.

    Empty without a stance, without such designs, and where not all designs will be listed.
    """
    passed = [design.metrics for design in designs if design.verification.passed]
    flatness = [metrics.stance_flatness for metrics in passed if metrics.stance_flatness is not None]
    uneven = [metrics.stance_speed_deviation for metrics in passed if metrics.stance_speed_deviation is not None]
    if problem.stance is None or problem.listed_later or not flatness:
        return ""
    text = f" In the stance P keeps within a band of down to {min(flatness):.3g} {problem.length_unit}"
    return text + (f", and its speed within {100.0 * min(uneven):.3g} % of its mean." if uneven else ".")
