"""Minimax fitting of the narrowest band, by sequential linear programming with a trust region.

A shape x gives values e(x) at samples of a motion. The method finds the x for which the band from their minimum to
their maximum is narrowest, while other values h(x) stay in a band of given width and others, g(x), are not negative:

    minimize t  subject to  |e_i(x) − m| ≤ t,  |h_j(x) − n| ≤ w,  g_k(x) ≥ 0,  low ≤ x ≤ high.

Each step replaces e, h, g by their tangents and bounds the step (Madsen, "An algorithm for minimax solution of
overdetermined systems of non-linear equations", J. Inst. Math. Appl. 16 (1975) 321, doi:10.1093/imamat/16.3.321). For
smooth motions one value per unknown touches the edges of the band (Chebyshev). The steps are then Newton
steps and converge quadratically. Constraints are elastic, so that a start need not satisfy them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.numerics.linear_program import solve_linear_program

VIOLATION_PENALTIES = (10.0, 1000.0)
"""Penalties per unit of violation, in units of the values e. The first one lets steps pass through violations. The
second one is for shapes that then still violate a constraint. It exceeds the multipliers of useful designs:
straightness to 1e-4 costs about 50 times as much in the evenness of the velocity."""

VIOLATION_TOLERANCE = 1e-6
"""Violation up to which a constraint counts as satisfied."""

DIFFERENCE_STEP = 1e-5
"""Relative step of the central differences. Their error, about 1e-10, only slows the last steps."""

FIRST_TRUST_RADIUS, MAX_TRUST_RADIUS, MIN_TRUST_RADIUS = 0.1, 0.5, 1e-10
"""Trust radius as a share of 1 + |x|: initial, maximum, and the minimum at which the descent ends."""

CONVERGENCE_TOLERANCE = 1e-6
"""Relative gain below which the band counts as narrowest."""

MIN_BAND = 1e-15
"""Half width of a band below which it is pure rounding."""

MAX_STEPS = 40
"""Maximum number of accepted steps, each of one or several linear programs; ten to twenty are usual."""


class ShapeValues(NamedTuple):
    """Values of m shapes, on the first axis; NaN for a shape that is no linkage.

    Attributes
    ----------
    banded : float, shape (m, k)
        Values whose band is minimized.
    limited : float, shape (m, j)
        Values that have to stay in a band of given half width; j may be 0.
    positive : float, shape (m, q)
        Values that must not be negative; q may be 0.
    """

    banded: Real
    limited: Real
    positive: Real


class NarrowestBand(NamedTuple):
    """Shape, half the width of its band, and its largest violation of a constraint."""

    shape: Real
    half_width: float
    violation: float


def find_narrowest_band(
    values: Callable[[Real], ShapeValues],
    start: Real,
    low: Real,
    high: Real,
    *,
    half_limit: float = np.inf,
    arrived: float = CONVERGENCE_TOLERANCE,
) -> NarrowestBand | None:
    """Descend from one start to a shape with a locally narrowest band.

    Parameters
    ----------
    values : callable
        Computes the values of shapes (m, n).
    start, low, high : float, shape (n,)
        Starting point and bounds.
    half_limit : float
        Half the width of the band in which ``limited`` has to stay.
    arrived : float
        Relative gain of a step below which the descent ends.

    Returns
    -------
    NarrowestBand or None
        None if the start is no linkage.
    """
    narrowest: NarrowestBand | None = None
    for penalty in VIOLATION_PENALTIES:
        narrowest = _descend_with_penalty(values, start, low, high, half_limit, arrived, penalty)
        if narrowest is None or narrowest.violation <= VIOLATION_TOLERANCE:
            break
        # Continue from the shape found so far with the higher penalty.
        start = narrowest.shape
    return narrowest


def _descend_with_penalty(
    values: Callable[[Real], ShapeValues],
    start: Real,
    low: Real,
    high: Real,
    half_limit: float,
    arrived: float,
    penalty: float,
) -> NarrowestBand | None:
    """Descend with one penalty of violations."""
    x = np.clip(start, low, high)
    here = values(x[None])
    merit, half_width, violation = _compute_merit(here, half_limit, penalty)
    if not np.isfinite(merit):
        return None
    trust = FIRST_TRUST_RADIUS
    for _ in range(MAX_STEPS):
        tangents = _compute_tangents(values, x)
        if tangents is None:
            break
        while trust > MIN_TRUST_RADIUS:
            reach = trust * (1.0 + np.abs(x))
            # The trust region and the bounds of the shape together are a box, as a linear program needs.
            bounds = np.maximum(low - x, -reach), np.minimum(high - x, reach)
            step, predicted = _solve_step(here, tangents, *bounds, half_limit, penalty)
            if step is None:
                return NarrowestBand(x, half_width, violation)
            tried = values((x + step)[None])
            tried_merit = _compute_merit(tried, half_limit, penalty)
            gain, hoped = merit - tried_merit[0], merit - predicted
            # A tenth of the predicted gain is enough to accept a step; otherwise the trust region shrinks.
            if np.isfinite(tried_merit[0]) and gain > 0.1 * hoped and hoped > 0.0:
                break
            # Shrink relative to the step actually taken; 0 if even the prediction promises no gain, which ends the
            # loop.
            trust = 0.25 * float(np.max(np.abs(step) / (1.0 + np.abs(x)))) if hoped > arrived * merit else 0.0
        else:
            break
        # Enlarge the trust region only if the tangents predicted the gain well.
        trust = min(MAX_TRUST_RADIUS, 2.0 * trust) if gain > 0.75 * hoped else trust
        x, here = x + step, tried
        merit, half_width, violation = tried_merit
        if gain <= arrived * merit:
            break
    return NarrowestBand(x, half_width, violation)


def compute_merits(values: ShapeValues, half_limit: float = np.inf, penalty: float = VIOLATION_PENALTIES[0]) -> Real:
    """Return half width, largest violation and merit of m shapes, shape (3, m); infinite if a shape is no linkage.

    The merit is the half width plus the penalty times the violation.
    """
    half_width = 0.5 * np.ptp(values.banded, axis=1)
    # The initial 0 makes an empty set of constraints satisfied.
    violation = np.maximum(0.0, -values.positive.min(axis=1, initial=0.0))
    if values.limited.size and np.isfinite(half_limit):
        violation = np.maximum(violation, 0.5 * np.ptp(values.limited, axis=1) - half_limit)
    measures = np.stack([half_width, violation, half_width + penalty * violation])
    return np.where(np.isfinite(measures).all(axis=0), measures, np.inf)


def _compute_merit(values: ShapeValues, half_limit: float, penalty: float) -> tuple[float, float, float]:
    half_width, violation, merit = compute_merits(values, half_limit, penalty)[:, 0].tolist()
    return merit, half_width, violation


def _compute_tangents(values: Callable[[Real], ShapeValues], x: Real) -> ShapeValues | None:
    """Differentiate the values by each coordinate: shapes (n, k), (n, j), (n, q); None if a neighbour is no linkage."""
    h = DIFFERENCE_STEP * (1.0 + np.abs(x))
    around = values(np.concatenate([x + np.diag(h), x - np.diag(h)]))
    n = len(x)
    derivatives = ShapeValues(*((part[:n] - part[n:]) / (2.0 * h[:, None]) for part in around))
    return derivatives if all(np.isfinite(part).all() for part in derivatives) else None


def _solve_step(
    here: ShapeValues, tangents: ShapeValues, low: Real, high: Real, half_limit: float, penalty: float
) -> tuple[Real | None, float]:
    """Return the best step within bounds by the tangents, and the merit that they predict there.

    Unknowns of the linear program: the step, the middles m and n of both bands, the half width t, the violation.
    """
    limited = bool(np.isfinite(half_limit)) and here.limited.size > 0
    n, k, q = len(low), here.banded.shape[1], here.positive.shape[1]
    j = here.limited.shape[1] if limited else 0
    # Scale steps by their bounds, and values by the present band around its middle: differences of 1e-9 between values
    # near 100 then survive the tolerances of the linear program.
    unit = max(0.5 * float(np.ptp(here.banded)), MIN_BAND)
    reach = np.maximum(high - low, MIN_BAND)
    matrix = np.zeros((2 * k + 2 * j + q, n + 4))
    limit = np.empty(len(matrix))
    banded = (here.banded[0] - _center_band(here.banded)) / unit
    slopes = tangents.banded.T * (reach / unit)
    for rows, sign in ((slice(0, k), 1.0), (slice(k, 2 * k), -1.0)):
        matrix[rows, :n], matrix[rows, n], matrix[rows, n + 2] = sign * slopes, -sign, -1.0
        limit[rows] = -sign * banded
    if limited:
        centred = (here.limited[0] - _center_band(here.limited)) / unit
        slopes = tangents.limited.T * (reach / unit)
        for rows, sign in ((slice(2 * k, 2 * k + j), 1.0), (slice(2 * k + j, 2 * k + 2 * j), -1.0)):
            matrix[rows, :n], matrix[rows, n + 1], matrix[rows, n + 3] = sign * slopes, -sign, -1.0
            limit[rows] = half_limit / unit - sign * centred
    matrix[2 * k + 2 * j :, :n] = -tangents.positive.T * (reach / unit)
    matrix[2 * k + 2 * j :, n + 3] = -1.0
    limit[2 * k + 2 * j :] = here.positive[0] / unit
    cost = np.zeros(n + 4)
    cost[n + 2], cost[n + 3] = 1.0, penalty
    floors = np.array([*(low / reach), -np.inf, -np.inf, 0.0, 0.0])
    ceilings = np.array([*(high / reach), np.inf, np.inf, np.inf, np.inf])
    # Drop rows that no step within the bounds can violate; they only cost time.
    slack = limit - np.where(matrix[:, :n] > 0.0, matrix[:, :n] * ceilings[:n], matrix[:, :n] * floors[:n]).sum(axis=1)
    needed = (matrix[:, n : n + 2] != 0.0).any(axis=1) | ~(slack >= 0.0)
    done = solve_linear_program(cost, matrix[needed], limit[needed], floors, ceilings)
    if done is None:
        return None, np.inf
    return done.at[:n] * reach, done.value * unit


def _center_band(values: Real) -> float:
    return 0.5 * float(values.min() + values.max())
