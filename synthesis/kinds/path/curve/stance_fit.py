"""Fits with a required stance and all other constraints, by the method of multipliers.

Similarity of shapes does not show how evenly a point moves, so that many fits are tried, not only the nearest. The rows
are those of :mod:`synthesis.kinds.path.residuals.stance`. The stance is constrained a little more tightly than required
at a finite number of places, because it may be wider between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from synthesis.fit.chart import FOURBAR, POINT, UNKNOWNS
from synthesis.fit.chart import LENGTHS as LENGTHS_AT
from synthesis.fit.constraints import CHANGE_POINT, EQUATION_COUNT, FAMILY_INDEX, SIGN_INDEX
from synthesis.fit.constraints import COSINE as LEAST_ANGLE
from synthesis.kinds.path.curve.fits import (
    Fit,
    build_cognate_fits,
    build_fit,
    get_thinning,
    interpolate_all_angles,
    select_distinct_fits,
)
from synthesis.kinds.path.points.fit import Candidate, PointTask
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import MIN_GRASHOF, count_setting_margins
from synthesis.kinds.path.residuals.curve_constraints import tighten_to_usable
from synthesis.kinds.path.residuals.curve_descent import LinkageLimits
from synthesis.kinds.path.residuals.stance import (
    COSINE,
    CYCLE,
    FIRST,
    FLATNESS,
    JAM_CYCLE,
    LAST,
    LENGTH_MARGIN_COUNT,
    LONGEST,
    MARGIN_COUNT,
    OFF_MEAN,
    PIVOT_LIMITS,
    PIVOT_MARGIN_COUNT,
    RATIO,
    SIMPLE_FAMILY,
    SIMPLE_SIGN,
    SIMPLE_SIZE,
    SINE,
    STANCE_SIZE,
    TRANSMISSION_COSINE,
    compute_fourbar_stance_rows,
    compute_simple_stance_rows,
)
from synthesis.kinds.path.task.target_curve import TargetCurve
from synthesis.numerics.augmented_lagrangian import descend_constrained
from synthesis.numerics.portions import run_in_portions
from synthesis.numerics.status import Status
from synthesis.results.practicality import MAX_LINK_RATIO, MIN_USABLE_ANGLE

TIGHTENING_SHARE = 0.97
"""Share of the required flatness, and of the permitted speed deviation, that serves as the aim."""

MAX_ROUNDS, MAX_STEPS, INITIAL_WEIGHT = 8, 80, 30.0
"""Maximum number of descents with multipliers, of steps of each, and the initial weight."""

MAX_VIOLATION = 1e-3
"""Maximum violation of a constraint at the end, in its own unit; the driven linkage is verified later."""

MAX_CONSTRAINED, MAX_KEPT = 60, 12
"""Maximum number of fits that are refitted under the stance, and of the nearest successful ones that are driven."""


def convert_to_fit(candidate: Candidate, task: PointTask, target: TargetCurve) -> Fit:
    """Convert a fit to a target's own points into a fit to all its fitted points, in its unit, with its error."""
    family, sign, n = int(candidate.setting[FAMILY_INDEX]), float(candidate.setting[SIGN_INDEX]), len(target.points)
    scale = task.size / target.size
    x = candidate.x[: UNKNOWNS[FOURBAR]].copy()
    theta = candidate.state[:n] + x[2]
    place = scale * complex(x[0], x[1]) + (task.origin - target.centre) / target.size
    x[0], x[1] = place.real, place.imag
    # Lengths are logarithms in the chart: a change of unit is an addition.
    x[LENGTHS_AT : LENGTHS_AT + 4] += math.log(scale)
    x[POINT : POINT + 2] *= scale
    if len(target.fitted) > n:
        places, angles = target.places, theta
        if target.closed:
            turn = math.copysign(2.0 * math.pi, theta[-1] - theta[0])
            places, angles = np.append(places, 1.0), np.append(theta, theta[0] + turn)
        shares = np.linspace(0.0, 1.0, len(target.fitted) - n, endpoint=not target.closed)
        theta = np.concatenate([theta, np.interp(shares, places, angles)])
    return build_fit(target, family, x, sign, theta)


class StanceFit(NamedTuple):
    """A fit within its stance: unknowns (m,), crank angles at the points (n,), and half its sum of squares."""

    x: Real
    theta: Real
    cost: float


def pack_stance(problem: PathProblem, size: float, first: int, last: int, cycle: float) -> Real:
    """Pack a stance from the row ``first`` to the row ``last`` for the residuals, in a unit of ``size`` length units.

    ``cycle`` is the input's cycle, radians, which is needed if the stance continues past the last row.
    """
    stance = problem.stance
    assert stance is not None
    way = problem.points[stance.points[1]].point - problem.points[stance.points[0]].point
    out = np.full(STANCE_SIZE, math.inf)
    out[FIRST], out[LAST], out[CYCLE] = first, last, cycle if first > last else 0.0
    out[COSINE], out[SINE] = way.real / abs(way), way.imag / abs(way)
    if stance.flatness is not None:
        out[FLATNESS] = TIGHTENING_SHARE * stance.flatness / size
    if stance.off_mean is not None:
        out[OFF_MEAN] = TIGHTENING_SHARE * stance.off_mean
    return out


def pack_no_stance(points: int) -> Real:
    """Return the packed stance of a problem without a stance, which constrains nothing."""
    out = np.full(STANCE_SIZE, math.inf)
    out[FIRST], out[LAST], out[CYCLE], out[COSINE], out[SINE] = 0, points - 1, 0.0, 1.0, 0.0
    return out


def pack_target_stance(problem: PathProblem, target: TargetCurve, fitted: int) -> tuple[Integers, Real]:
    """Return the indices of the points to fit among a target's first ``fitted`` ones, and the packed stance.

    The stance is in the target's unit and refers to the rows of these points. Its first and last point are always among
    them.
    """
    assert problem.stance is not None
    # The last point of a closed curve may repeat its first; a target drops it, so that its index wraps around.
    first, last = (index % len(target.points) for index in problem.stance.points)
    part = np.union1d(np.arange(fitted)[get_thinning(target)], [first, last])
    rows = np.searchsorted(part, [first, last])
    return part, pack_stance(problem, target.size, int(rows[0]), int(rows[1]), 2.0 * math.pi)


def find_stance_fits(
    problem: PathProblem, target: TargetCurve, fits: Sequence[Fit], families: list[int], setting: Real
) -> list[Fit]:
    """Refit fourbars near a target, and their cognates, under the stance; return distinct ones, nearest first.

    Parameters
    ----------
    problem : PathProblem
        With a stance.
    target : TargetCurve
        The curve to draw.
    fits : sequence of Fit
        Starts.
    families : list of int
        Families to which an answer may belong.
    setting : float
        The other constraints, of :func:`synthesis.kinds.path.residuals.curve_constraints.pack_curve_setting`.
    """
    variants = [one for fit in fits for one in (fit, *build_cognate_fits(fit, families))]
    begun = select_distinct_fits(sorted(variants, key=lambda fit: fit.error), MAX_CONSTRAINED)
    part, spec = pack_target_stance(problem, target, len(target.fitted))
    demands = [setting]
    # Without a required angle a usable one is tried as well, as in curve matching.
    if not math.isfinite(setting[LEAST_ANGLE]) and problem.rank_by != "accuracy":
        demands.append(tighten_to_usable(setting, MIN_USABLE_ANGLE, MAX_LINK_RATIO))
    tasks = [(fit, one) for fit in begun for one in demands]
    ended: list[Fit | None] = [None] * len(tasks)

    def process_portion(some: slice) -> None:
        for k in range(*some.indices(len(tasks))):
            fit, one = tasks[k]
            end = _fit_fourbar(fit, target.fitted[part], target.weights[part], fit.theta[part], spec, one)
            if end is not None:
                ended[k] = build_fit(
                    target, fit.family, end.x, fit.sign, interpolate_all_angles(target, end.theta, part)
                )

    run_in_portions(process_portion, len(tasks), 1)
    arrived = [fit for fit in ended if fit is not None and math.isfinite(fit.error)]
    return select_distinct_fits(sorted(arrived, key=lambda fit: fit.error), len(demands) * MAX_KEPT)


def _fit_fourbar(fit: Fit, points: Complex, weights: Real, theta: Real, spec: Real, setting: Real) -> StanceFit | None:
    demanded = setting.copy()
    # Constrained fits run to change points, at which the crank would not turn through.
    demanded[FAMILY_INDEX], demanded[SIGN_INDEX], demanded[CHANGE_POINT] = fit.family, fit.sign, MIN_GRASHOF
    n, x, limits = len(points), np.array(fit.x), count_setting_margins(demanded) + MARGIN_COUNT
    state = np.zeros(3 * n + limits)
    state[:n] = theta - x[2]
    cost = _fit_constrained(
        compute_fourbar_stance_rows, x, points, weights, np.concatenate([spec, demanded]), state, limits, EQUATION_COUNT
    )
    return None if cost is None else StanceFit(x, state[:n] + x[2], cost)


def fit_simple_stance(
    family: int,
    x: Real,
    sign: float,
    theta: Real,
    points: Complex,
    spec: Real,
    linkage_limits: LinkageLimits,
    cosine: float,
) -> StanceFit | None:
    """Refit a slider-crank or geared fivebar under the stance; return None if that fails.

    Parameters
    ----------
    family, x, sign, theta, points
        As for :func:`synthesis.kinds.path.residuals.curve_descent.descend`, of one start.
    spec : float
        Stance from :func:`pack_stance`.
    linkage_limits : LinkageLimits
        Gear ratio and limits.
    cosine : float
        Cosine of the minimum transmission angle of a slider-crank whose crank turns through.
    """
    setting = np.empty(SIMPLE_SIZE)
    setting[:STANCE_SIZE] = spec
    setting[SIMPLE_FAMILY], setting[SIMPLE_SIGN], setting[RATIO] = family, sign, linkage_limits.ratio
    setting[LONGEST], setting[JAM_CYCLE] = linkage_limits.longest, linkage_limits.cycle
    setting[TRANSMISSION_COSINE] = cosine
    setting[PIVOT_LIMITS] = linkage_limits.within.ravel()
    n, x, limits = len(points), np.array(x), MARGIN_COUNT + LENGTH_MARGIN_COUNT + PIVOT_MARGIN_COUNT
    state = np.zeros(n + limits)
    state[:n] = theta
    cost = _fit_constrained(
        compute_simple_stance_rows, x, points, np.ones(n), setting, state, limits, PIVOT_MARGIN_COUNT
    )
    return None if cost is None else StanceFit(x, state[:n].copy(), cost)


def _fit_constrained(
    rows: Any, x: Real, points: Complex, weights: Real, setting: Real, state: Real, limits: int, equations: int
) -> float | None:
    """Enforce all constraints, changing the unknowns in place.

    Returns half the sum of squares, or None if a violation exceeds :data:`MAX_VIOLATION`.
    """
    placed = np.stack([points.real, points.imag, np.zeros(len(points)), np.sqrt(weights)], axis=1)
    ended = np.empty(1)
    most = 2 * len(points) + limits
    status = descend_constrained(
        rows, x, placed, setting, state, most, limits, equations, INITIAL_WEIGHT, MAX_ROUNDS, MAX_STEPS, ended
    )
    margins = state[len(state) - limits :]
    # The last margins are equations, violated on both sides.
    zero = np.abs(margins[-equations:])
    off = max(-float(margins[:-equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
    return float(ended[0]) if status != Status.IMPOSSIBLE and off <= MAX_VIOLATION and math.isfinite(ended[0]) else None
