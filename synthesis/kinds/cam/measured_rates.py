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
from numpy.typing import NDArray

from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.reproduction import reported
from synthesis.kinds.cam.segments import Move
from synthesis.model.answer import Check
from synthesis.model.dimension import Dimension

Real = NDArray[np.float64]
Measure = Callable[[Real], tuple[Real, Real]]
"""Function for s and v of the follower on the finished profile, at cam angles in radians."""

GRID = 320
"""Equal steps of a segment at which its displacement is measured."""

STRIDE = {"acceleration": 4, "jerk": 8}
"""Steps between the angles of a difference: windows of a fortieth and of 3/40 of the segment. A deviation of 1e-7 of
the lift moves a jerk by 2e-4 of the least that any motion has, an acceleration by 6e-4."""

ORDERS = {"velocity": 1, "acceleration": 2, "jerk": 3}

PEAK_SLACK = 2e-3
"""Relative slack of the limits on the motion: twice the effect of displacement deviations on the differences."""

CONDITION_SLACK = {1: 1e-3, 2: 1e-2}
"""Deviation of a measured velocity or acceleration from a condition, as a share of the segment's peak."""

FINE, NEAR = 2.0, 2
"""Step of a difference at a condition on the acceleration, in grid steps, and the number of half steps around it that
are used: the given value must lie among the means there and the extrapolations from both sides, because an acceleration
may have a kink at its condition."""

FINEST = 0.25
"""Least share of those steps, if a limit on jerk bounds how fast an acceleration may change. Without that limit it may
be reached for an instant, which no cam shows."""

HIDDEN = 0.2
"""Share of the slack of a condition that the profile's deviation may add to a difference: the steps are as small as
that allows."""

ONE_SIDED = (2.0, -5.0, 4.0, -1.0)
"""Second derivative at the first of four equally spaced values, exact for a cubic; adds at most 12 deviations."""


@dataclass(frozen=True)
class _Open:
    """An automatic or optimal segment, with its cam angles and the measurements on its grid."""

    index: int
    segment: Move
    start: float
    span: float
    heights: tuple[float, float]
    s: Real
    v: Real

    def means(self, name: str) -> Real:
        """Return windowed means of the acceleration or the jerk."""
        order, stride = ORDERS[name], STRIDE[name]
        s, h = self.s, stride * self.span / GRID
        count = len(s) - order * stride
        # Binomial weights: the n-th difference of displacements ``stride`` grid steps apart.
        total = sum(
            (-1) ** (order - k) * math.comb(order, k) * s[k * stride : k * stride + count] for k in range(order + 1)
        )
        return np.asarray(total / h**order)

    def peak(self, name: str) -> float:
        """Return the greatest magnitude of a derivative."""
        return float(np.abs(self.v if name == "velocity" else self.means(name)).max())


def rate_checks(problem: CamProblem, measure: Measure, lift: float, reproduced: float, off: float) -> list[Check]:
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
    parts = list(_open_segments(problem, measure))
    if not parts:
        return []
    checks = []
    for name in ORDERS:
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
    missed = max(_displacement_deviation(problem, measure, part) for part in parts) / lift
    checks.append(Check(name="meets_positions", passed=missed <= reproduced, value=reported(missed), limit=reproduced))
    for order, name in ((1, "meets_velocities"), (2, "meets_accelerations")):
        worst = [_rate_deviation(problem, measure, part, order, off * lift) for part in parts]
        stated = [value for value in worst if value is not None]
        if stated:
            # Differences of accelerations are less accurate than velocities.
            slack = CONDITION_SLACK[order]
            checks.append(Check(name=name, passed=max(stated) <= slack, value=reported(max(stated)), limit=slack))
    return checks


def _open_segments(problem: CamProblem, measure: Measure) -> Iterator[_Open]:
    """Measure automatic and optimal segments, each on its own grid."""
    start = 0.0
    for index, (segment, heights) in enumerate(zip(problem.segments, problem.program.heights(), strict=True)):
        span = math.radians(segment.angle)
        if isinstance(segment, Move) and segment.follows_criterion:
            s, v = measure(start + span * np.arange(GRID + 1) / GRID)
            yield _Open(index, segment, start, span, heights, s, v)
        start += span


def _displacement_deviation(problem: CamProblem, measure: Measure, part: _Open) -> float:
    """Return the greatest deviation of the measured displacement from ends, conditions and bands."""
    unit = problem.displacement_unit
    stated = [(0.0, part.heights[0]), (part.span, part.heights[1])]
    stated += [(t, x) for t, order, x in problem.program.polynomial_conditions(part.segment) if order == 0]
    at, value = (np.array(column) for column in zip(*stated, strict=True))
    off = float(np.abs(measure(part.start + at)[0] - value).max())
    grid = part.span * np.arange(GRID + 1) / GRID
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


def _rate_deviation(problem: CamProblem, measure: Measure, part: _Open, order: int, off: float) -> float | None:
    """Return the deviation of a rate from its conditions, as a share of the segment's peak; None without a condition.

    ``off`` is the deviation of the displacement from the program.
    """
    stated = [(t, x) for t, of, x in problem.program.polynomial_conditions(part.segment) if of == order]
    if not stated:
        return None
    at, value = (np.array(column) for column in zip(*stated, strict=True))
    if order == 1:
        return float(np.abs(measure(part.start + at)[1] - value).max()) / part.peak("velocity")
    peak = part.peak("acceleration")
    step = FINE * part.span / GRID
    if problem.limits.jerk is not None:
        # The smallest step at which the profile's deviation hides at most HIDDEN of the slack, within its two
        # bounds.
        shown = math.sqrt(sum(map(abs, ONE_SIDED)) * off / (HIDDEN * CONDITION_SLACK[2] * peak))
        step = min(max(shown, FINEST / FINE * step), step)
    # Half steps around the condition, whole ones to either side.
    reach = 2 * (len(ONE_SIDED) - 1)
    s = {k: measure(part.start + at + 0.5 * k * step)[0] for k in range(-reach, reach + 1)}
    means = [s[k - 2] - 2.0 * s[k] + s[k + 2] for k in range(-NEAR, NEAR + 1)]
    for side in (-2, 2):
        means.append(np.sum([weight * s[side * k] for k, weight in enumerate(ONE_SIDED)], axis=0))
    measured = np.array(means) / step**2
    # No deviation if the value lies between the least and the greatest of the means and extrapolations.
    missed = np.maximum(np.maximum(measured.min(axis=0) - value, value - measured.max(axis=0)), 0.0)
    return float(missed.max()) / peak
