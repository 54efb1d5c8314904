"""Lead fits to their required stance under all other constraints.

Similar shapes say nothing about how evenly a point moves, so that many fits are tried, the nearest and others: the rows
are those of :mod:`synthesis.kinds.path.stance_rows`, the method is that of multipliers. The stance is constrained a
little more tightly than required at a finite number of places, because it may be wider between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.fit.chart import FOURBAR, POINT, UNKNOWNS
from synthesis.fit.chart import LENGTHS as LENGTHS_AT
from synthesis.fit.demands import CHANGE_POINT, EQUATIONS, FAMILY, SIGN
from synthesis.fit.demands import COSINE as LEAST_ANGLE
from synthesis.kinds.path.curve_fits import Fit, at_all_points, cognate_fits, fit_of, that_differ, thinning
from synthesis.kinds.path.curve_limits import usable
from synthesis.kinds.path.curve_target import Target
from synthesis.kinds.path.limits import MIN_GRASHOF, limits_of
from synthesis.kinds.path.nearness import MOST_UNEVEN, USABLE
from synthesis.kinds.path.point_fit import Candidate, PointTask
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.stance_rows import (
    COSINE,
    CYCLE,
    FIRST,
    FLATNESS,
    JAM_CYCLE,
    LAST,
    LEAST_COSINE,
    LENGTHS,
    LONGEST,
    MARGINS,
    OFF_MEAN,
    PIVOTS,
    RATIO,
    SIMPLE,
    SIMPLE_FAMILY,
    SIMPLE_SIGN,
    SINE,
    STANCE,
    WITHIN,
    fourbar_stance_rows,
    simple_stance_rows,
)
from synthesis.numerics.augmented_lagrangian import hold
from synthesis.numerics.portions import in_portions
from synthesis.numerics.status import Status

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Whole = NDArray[np.int64]

NARROWER = 0.97
"""Share of the required flatness, and of the permitted speed deviation, that serves as the aim."""

ROUNDS, STEPS, WEIGHT = 8, 80, 30.0
"""Maximum number of descents with multipliers, of steps of each, and the initial weight."""

MISSED = 1e-3
"""Maximum violation of a constraint at the end, in its own unit: the driven linkage is verified anyway."""

MOST_HELD, MOST_KEPT = 60, 12
"""Maximum number of fits that are led to the stance, and of successful ones, the nearest, that are driven."""


def as_fit(candidate: Candidate, task: PointTask, target: Target) -> Fit:
    """Convert a fit to a target's own points into one to all fitted points of it, in its unit; with its error."""
    family, sign, n = int(candidate.setting[FAMILY]), float(candidate.setting[SIGN]), len(target.points)
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
    return fit_of(target, family, x, sign, theta)


class Stanced(NamedTuple):
    """A fit within its stance: unknowns (m,), crank angles at the points (n,), and half its sum of squares."""

    x: Real
    theta: Real
    cost: float


def stance_spec(problem: PathProblem, size: float, first: int, last: int, cycle: float) -> Real:
    """Pack a stance for the rows, in a unit of ``size`` length units, from the row ``first`` to the row ``last``.

    ``cycle`` is the input's, radians: the stance uses it if it continues past the last row.
    """
    stance = problem.stance
    assert stance is not None
    way = problem.points[stance.points[1]].point - problem.points[stance.points[0]].point
    out = np.full(STANCE, math.inf)
    out[FIRST], out[LAST], out[CYCLE] = first, last, cycle if first > last else 0.0
    out[COSINE], out[SINE] = way.real / abs(way), way.imag / abs(way)
    if stance.flatness is not None:
        out[FLATNESS] = NARROWER * stance.flatness / size
    if stance.off_mean is not None:
        out[OFF_MEAN] = NARROWER * stance.off_mean
    return out


def no_stance(points: int) -> Real:
    """Return the same for a problem without a stance."""
    out = np.full(STANCE, math.inf)
    out[FIRST], out[LAST], out[CYCLE], out[COSINE], out[SINE] = 0, points - 1, 0.0, 1.0, 0.0
    return out


def stance_of_target(problem: PathProblem, target: Target, fitted: int) -> tuple[Whole, Real]:
    """Return the points to fit among a target's first ``fitted`` ones, and the stance by their rows, in the target's
    unit.

    The first and last point of the stance are always among them.
    """
    assert problem.stance is not None
    # The last point of a closed curve may repeat its first; a target drops it, so that its index wraps around.
    first, last = (index % len(target.points) for index in problem.stance.points)
    part = np.union1d(np.arange(fitted)[thinning(target)], [first, last])
    rows = np.searchsorted(part, [first, last])
    return part, stance_spec(problem, target.size, int(rows[0]), int(rows[1]), 2.0 * math.pi)


def fits_in_stance(
    problem: PathProblem, target: Target, fits: Sequence[Fit], families: list[int], setting: Real
) -> list[Fit]:
    """Lead fourbars near a target, and their cognates, to the stance; distinct ones, nearest first.

    Parameters
    ----------
    problem : PathProblem
        With a stance.
    target : Target
        The curve to draw.
    fits : sequence of Fit
        Starts.
    families : list of int
        Families to which an answer may belong.
    setting : float
        The other constraints, of :func:`synthesis.kinds.path.curve_limits.curve_setting`.
    """
    variants = [one for fit in fits for one in (fit, *cognate_fits(fit, families))]
    begun = that_differ(sorted(variants, key=lambda fit: fit.error), MOST_HELD)
    part, spec = stance_of_target(problem, target, len(target.fitted))
    demands = [setting]
    # Without a required angle a usable one is tried as well, as in curve matching.
    if not math.isfinite(setting[LEAST_ANGLE]) and problem.rank_by != "accuracy":
        demands.append(usable(setting, USABLE, MOST_UNEVEN))
    tasks = [(fit, one) for fit in begun for one in demands]
    ended: list[Fit | None] = [None] * len(tasks)

    def work(some: slice) -> None:
        for k in range(*some.indices(len(tasks))):
            fit, one = tasks[k]
            end = _fourbar(fit, target.fitted[part], target.weights[part], fit.theta[part], spec, one)
            if end is not None:
                ended[k] = fit_of(target, fit.family, end.x, fit.sign, at_all_points(target, end.theta, part))

    in_portions(work, len(tasks), 1)
    arrived = [fit for fit in ended if fit is not None and math.isfinite(fit.error)]
    return that_differ(sorted(arrived, key=lambda fit: fit.error), len(demands) * MOST_KEPT)


def _fourbar(fit: Fit, points: Complex, weights: Real, theta: Real, spec: Real, setting: Real) -> Stanced | None:
    demanded = setting.copy()
    # Constrained fits run to change points, at which the crank would not turn through.
    demanded[FAMILY], demanded[SIGN], demanded[CHANGE_POINT] = fit.family, fit.sign, MIN_GRASHOF
    n, x, limits = len(points), np.array(fit.x), limits_of(demanded) + MARGINS
    state = np.zeros(3 * n + limits)
    state[:n] = theta - x[2]
    cost = _held(fourbar_stance_rows, x, points, weights, np.concatenate([spec, demanded]), state, limits, EQUATIONS)
    return None if cost is None else Stanced(x, state[:n] + x[2], cost)


def simple_in_stance(
    family: int, x: Real, sign: float, theta: Real, points: Complex, spec: Real, *, ratio: float, longest: float,
    cycle: float, within: Real, cosine: float,
) -> Stanced | None:  # fmt: skip
    """Lead a slider-crank or geared fivebar to the stance; None if that fails.

    Parameters
    ----------
    family, x, sign, theta, points
        As for :func:`synthesis.kinds.path.curve_descent.descend`, of one start.
    spec : float
        Stance from :func:`stance_spec`.
    ratio, longest, cycle, within
        As for :func:`synthesis.kinds.path.curve_descent.descend`.
    cosine : float
        Cosine of the minimum transmission angle of a slider-crank whose crank turns through.
    """
    setting = np.empty(SIMPLE)
    setting[:STANCE] = spec
    setting[SIMPLE_FAMILY], setting[SIMPLE_SIGN], setting[RATIO] = family, sign, ratio
    setting[LONGEST], setting[JAM_CYCLE], setting[LEAST_COSINE] = longest, cycle, cosine
    setting[WITHIN:] = within.ravel()
    n, x, limits = len(points), np.array(x), MARGINS + LENGTHS + PIVOTS
    state = np.zeros(n + limits)
    state[:n] = theta
    cost = _held(simple_stance_rows, x, points, np.ones(n), setting, state, limits, PIVOTS)
    return None if cost is None else Stanced(x, state[:n].copy(), cost)


def _held(
    rows: Any, x: Real, points: Complex, weights: Real, setting: Real, state: Real, limits: int, equations: int
) -> float | None:
    """Enforce all constraints in place; return half the sum of squares, or None if a violation exceeds
    :data:`MISSED`."""
    placed = np.stack([points.real, points.imag, np.zeros(len(points)), np.sqrt(weights)], axis=1)
    ended = np.empty(1)
    most = 2 * len(points) + limits
    status = hold(rows, x, placed, setting, state, most, limits, equations, WEIGHT, ROUNDS, STEPS, ended)
    margins = state[len(state) - limits :]
    # The last margins are equations, violated on both sides.
    zero = np.abs(margins[-equations:])
    off = max(-float(margins[:-equations].min()), float(zero[np.isfinite(zero)].max(initial=0.0)))
    return float(ended[0]) if status != Status.IMPOSSIBLE and off <= MISSED and math.isfinite(ended[0]) else None
