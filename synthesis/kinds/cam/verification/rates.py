"""Velocity, acceleration, jerk and given conditions, measured on the finished profile.

The contact search gives the displacement s at any cam angle, and the direction of the profile at the contact gives
the velocity without differences. Acceleration and jerk are n-th differences over n + 1 angles a step h apart,

    δⁿs/hⁿ = ∫ B(u) s⁽ⁿ⁾(θ + u) du,    B a B-spline of width n h, ∫ B = 1

(Schumaker, *Spline Functions*, §4.3): a mean of the derivative itself, which never exceeds its peak for any motion.
A deviation ε of the displacement adds at most 2ⁿ ε/hⁿ. So a limit that is broken over more than a window's
width is detected; a narrower spike is not, and no instrument on the finished cam would detect it either.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.statement.segments import Move
from synthesis.kinds.cam.verification.reproduction import limit_reported
from synthesis.model.answer import Check
from synthesis.model.dimension import Dimension

Measure = Callable[[Real], tuple[Real, Real]]
"""Function for s and v of the follower on the finished profile, at cam angles in radians."""

GRID_STEP_COUNT = 320
"""Equal steps of a segment at which its displacement is measured."""

DIFFERENCE_STRIDES = {"acceleration": 4, "jerk": 8}
"""Steps between the angles of a difference: windows of 1/40 and of 3/40 of the segment. A deviation of 1e-7 of the lift
changes a jerk by 2e-4, and an acceleration by 6e-4, of the minimum peak of any motion."""

DERIVATIVE_ORDERS = {"velocity": 1, "acceleration": 2, "jerk": 3}

PEAK_SLACK = 2e-3
"""Relative slack of the limits on the motion: twice the effect of displacement deviations on the differences."""

CONDITION_SLACK = {1: 1e-3, 2: 1e-2}
"""Permitted deviation of a measured velocity (1) or acceleration (2) from a condition, as a share of the segment's
peak."""

CONDITION_STEP, CONDITION_REACH = 2.0, 2
"""Step of a difference at a condition on the acceleration, in grid steps, and the number of half steps used around it.
The requested value must lie among the means there and the extrapolations from both sides, because an acceleration may
have a kink at its condition."""

MIN_STEP_SHARE = 0.25
"""Minimum share of these steps if a limit on the jerk bounds the change of the acceleration. Without this limit, the
acceleration may be attained only for an instant, which cannot be observed on a cam."""

HIDDEN_DEVIATION_SHARE = 0.2
"""Maximum contribution of the profile's deviation to a difference, as a share of a condition's slack. The steps are as
small as this permits."""

ONE_SIDED_WEIGHTS = (2.0, -5.0, 4.0, -1.0)
"""Weights of the second derivative at the first of four equally spaced values, exact for a cubic. Deviations of the
values are amplified by at most 12."""


@dataclass(frozen=True)
class _OpenSegment:
    """An automatic or optimal segment, with its cam angles and the measurements on its grid."""

    index: int
    segment: Move
    start: float
    span: float
    heights: tuple[float, float]
    s: Real
    v: Real

    def compute_means(self, name: str) -> Real:
        """Return windowed means of the acceleration or the jerk."""
        order, stride = DERIVATIVE_ORDERS[name], DIFFERENCE_STRIDES[name]
        s, h = self.s, stride * self.span / GRID_STEP_COUNT
        count = len(s) - order * stride
        # Binomial weights: the n-th difference of displacements ``stride`` grid steps apart.
        total = sum(
            (-1) ** (order - k) * math.comb(order, k) * s[k * stride : k * stride + count] for k in range(order + 1)
        )
        return np.asarray(total / h**order)

    def peak(self, name: str) -> float:
        """Return the maximum magnitude of a derivative."""
        return float(np.abs(self.v if name == "velocity" else self.compute_means(name)).max())


def check_rates(problem: CamProblem, measure: Measure, lift: float, reproduced: float, off: float) -> list[Check]:
    """Check limits, positions, conditions and bands of the automatic and optimal segments.

    Parameters
    ----------
    problem : CamProblem
        The request.
    measure : callable
        The follower on the finished profile.
    lift : float
        The program's travel, in radians for an arm.
    reproduced : float
        Share of the lift by which a displacement may be off.
    off : float
        Share of the lift by which the displacement is off the program somewhere.
    """
    parts = list(_measure_segments(problem, measure))
    if not parts:
        return []
    checks = []
    for name in DERIVATIVE_ORDERS:
        limit = getattr(problem.limits, name)
        if limit is not None:
            peak = max(part.peak(name) for part in parts)
            checks.append(
                Check(
                    name=f"peak_{name}",
                    passed=peak <= limit * (1.0 + PEAK_SLACK),
                    value=peak,
                    limit=limit,
                    dimension=Dimension(name),
                )
            )
    missed = max(_measure_displacement_deviation(problem, measure, part) for part in parts) / lift
    checks.append(
        Check(name="meets_positions", passed=missed <= reproduced, value=limit_reported(missed), limit=reproduced)
    )
    for order, name in ((1, "meets_velocities"), (2, "meets_accelerations")):
        worst = [_measure_rate_deviation(problem, measure, part, order, off * lift) for part in parts]
        stated = [value for value in worst if value is not None]
        if stated:
            # Differences of accelerations are less accurate than velocities.
            slack = CONDITION_SLACK[order]
            checks.append(Check(name=name, passed=max(stated) <= slack, value=limit_reported(max(stated)), limit=slack))
    return checks


def _measure_segments(problem: CamProblem, measure: Measure) -> Iterator[_OpenSegment]:
    """Measure automatic and optimal segments, each on its own grid."""
    start = 0.0
    for index, (segment, heights) in enumerate(zip(problem.segments, problem.program.heights(), strict=True)):
        span = math.radians(segment.angle)
        if isinstance(segment, Move) and segment.follows_criterion:
            s, v = measure(start + span * np.arange(GRID_STEP_COUNT + 1) / GRID_STEP_COUNT)
            yield _OpenSegment(index, segment, start, span, heights, s, v)
        start += span


def _measure_displacement_deviation(problem: CamProblem, measure: Measure, part: _OpenSegment) -> float:
    """Return the maximum deviation of the measured displacement from ends, conditions and bands."""
    unit = problem.displacement_unit
    stated = [(0.0, part.heights[0]), (part.span, part.heights[1])]
    stated += [(t, x) for t, order, x in problem.program.convert_conditions(part.segment) if order == 0]
    at, value = (np.array(column) for column in zip(*stated, strict=True))
    off = float(np.abs(measure(part.start + at)[0] - value).max())
    grid = part.span * np.arange(GRID_STEP_COUNT + 1) / GRID_STEP_COUNT
    for band in part.segment.bands:
        ends = np.radians([band.start, band.end])
        inside = part.s[(grid >= ends[0]) & (grid <= ends[1])]
        # Band ends seldom fall on the grid, so that they are measured as well.
        within = np.concatenate([inside, measure(part.start + ends)[0]])
        if band.upper is not None:
            off = max(off, float(within.max()) - band.upper * unit)
        if band.lower is not None:
            off = max(off, band.lower * unit - float(within.min()))
    return off


def _measure_rate_deviation(
    problem: CamProblem, measure: Measure, part: _OpenSegment, order: int, off: float
) -> float | None:
    """Return the deviation of a rate from its conditions, as a share of the segment's peak; None without a condition.

    ``off`` is the deviation of the displacement from the program.
    """
    stated = [(t, x) for t, of, x in problem.program.convert_conditions(part.segment) if of == order]
    if not stated:
        return None
    at, value = (np.array(column) for column in zip(*stated, strict=True))
    if order == 1:
        return float(np.abs(measure(part.start + at)[1] - value).max()) / part.peak("velocity")
    peak = part.peak("acceleration")
    step = CONDITION_STEP * part.span / GRID_STEP_COUNT
    if problem.limits.jerk is not None:
        # Take the smallest step at which the profile's deviation is at most HIDDEN_DEVIATION_SHARE of the slack, within
        # its two bounds.
        shown = math.sqrt(sum(map(abs, ONE_SIDED_WEIGHTS)) * off / (HIDDEN_DEVIATION_SHARE * CONDITION_SLACK[2] * peak))
        step = min(max(shown, MIN_STEP_SHARE / CONDITION_STEP * step), step)
    # Use half steps around the condition, and whole steps to either side.
    reach = 2 * (len(ONE_SIDED_WEIGHTS) - 1)
    s = {k: measure(part.start + at + 0.5 * k * step)[0] for k in range(-reach, reach + 1)}
    means = [s[k - 2] - 2.0 * s[k] + s[k + 2] for k in range(-CONDITION_REACH, CONDITION_REACH + 1)]
    for side in (-2, 2):
        means.append(np.sum([weight * s[side * k] for k, weight in enumerate(ONE_SIDED_WEIGHTS)], axis=0))
    measured = np.array(means) / step**2
    # The deviation is zero if the value lies between the minimum and the maximum of the means and extrapolations.
    missed = np.maximum(np.maximum(measured.min(axis=0) - value, value - measured.max(axis=0)), 0.0)
    return float(missed.max()) / peak
