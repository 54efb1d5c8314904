"""Least squares of a traced curve through points, with the crank angles free: one compiled Levenberg-Marquardt descent.

The unknowns are the linkage's m numbers x and the crank angle θᵢ at each of n points tᵢ; the residuals are the vectors
z(x, θᵢ) − tᵢ. Each θᵢ enters its own residual alone, so that Levenberg and Marquardt's equations

    [ A   C ] [δx]     [g]          A = Σ Re(z̄ₓ z̦ₓ),  cᵢ = Re(z̄_θ zₓ),  aᵢ = |z_θ|²
    [ Cᵀ  D ] [δθ] = − [h],         g = Σ Re(z̄ₓ rᵢ),   hᵢ = Re(z̄_θ rᵢ),   D = diag aᵢ

are solved by elimination of the angles (Schur's complement, m × m). The cost of a step is linear in n, and no inner
search for the nearest point is needed: this is the structure of orthogonal distance regression (Boggs, Byrd & Schnabel
1987, doi:10.1137/0908085). Points may be weighted. A step is refused where the linkage does not close at some point.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit
from synthesis.fit.chart import FOURBAR, GEARED_FIVEBAR, MAX_LOG, MIN_LOG, OPTIONS, compute_lengths
from synthesis.fit.coupler_curve import compute_second_angle, compute_unit_vector, place_linkage, place_with_slopes
from synthesis.numerics.cholesky import solve_positive
from synthesis.numerics.portions import run_in_portions

INITIAL_DAMPING, DAMPING_DECREASE, DAMPING_INCREASE = 1e-2, 0.2, 5.0
"""Marquardt's damping: the initial value, and its factors after an accepted and after a refused step."""

MIN_DAMPING, MAX_DAMPING = 1e-12, 1e10
"""Minimum damping, and the value above which the descent has stalled."""

MIN_CURVATURE, MIN_TURN_CURVATURE = 1e-14, 1e-12
"""Numbers added to the diagonal of A and, multiplied by the point's weight, to that of D, so that an unknown without
influence stays in place. Both diagonals are sums of squared distances in task units."""

MAX_TURN_STEP, MAX_LOG_STEP = 0.4, 1.0
"""Maximum change of a crank angle (radians) and of a logarithm in one step: beyond it the linear model fails."""

COST_TOLERANCE = 1e-12
"""The descent has converged when the relative decrease of the cost is below this in two consecutive steps."""

ZERO_COST = 1e-28
"""Cost, in squared task sizes, that consists of rounding alone."""

LENGTH_WEIGHT = 4.0
"""Weight of the relative excess of a length over the longest permitted one. It only guides the search, because answers
are verified."""

UNLIMITED_PIVOTS = np.array([[-np.inf, np.inf]] * 4)
"""Bounds of fixed pivots, shape (4, 2), for problems that do not constrain them."""

UNLIMITED_LENGTH = 1e300
"""Longest link for problems without a limit; finite, because the excess is a difference of ratios to it."""

PORTION_SIZE = 5
"""Number of starts that a thread takes at a time: some milliseconds of work."""

CYCLE_SAMPLE_COUNT, MIN_TRANSMISSION_SINE = 48, 0.05
"""Number of crank positions per cycle at which a geared fivebar must not jam, and the minimum sine of its transmission
angle at them, which includes a margin so that it does not jam between them either."""


class LinkageLimits(NamedTuple):
    """Gear ratio and limits of the linkages of a family.

    Attributes
    ----------
    ratio : float
        Gear ratio, for geared fivebars.
    longest : float
        Longest link; the excess of longer ones adds to the cost by :data:`LENGTH_WEIGHT`.
    cycle : float
        For geared fivebars: the crank's full cycle, over which it must not jam; 0 if it need not turn through.
    within : float, shape (4, 2), optional
        Minimum and maximum x and y of O2, then of the other fixed pivot. The distance from these bounds is a residual
        like that of a point, so that a cost of zero means that they hold. Slider-cranks do not use the last two rows.
    """

    ratio: float = 0.0
    longest: float = math.inf
    cycle: float = 0.0
    within: Real = UNLIMITED_PIVOTS


NO_LIMITS = LinkageLimits()


class Descent(NamedTuple):
    """Ends of descents: unknowns (n, m), crank angles (n, points), and sums of squared distances (n,)."""

    x: Real
    theta: Real
    cost: Real


@njit(**OPTIONS)
def _compute_length_excess(lengths: Real, m: int, x: Real, longest: float) -> float:
    """Return the squared relative excess of links and coupler arm over the longest allowed length."""
    total = 0.0
    for k in range(len(lengths)):
        over = abs(lengths[k]) / longest - 1.0
        if over > 0.0:
            total += over * over
    over = math.hypot(x[m - 2], x[m - 1]) / longest - 1.0
    if over > 0.0:
        total += over * over
    return total


@njit(**OPTIONS)
def _compute_transmission_sine(x: Real, lengths: Real, sign: float, ratio: float, theta: float) -> float:
    """Return the sine of the angle between the couplers of a geared fivebar, at least 0; 0 where it does not close."""
    closes, _, along = place_linkage(GEARED_FIVEBAR, x, lengths, sign, ratio, theta)
    if not closes:
        return 0.0
    pin = complex(x[0], x[1]) + lengths[0] * compute_unit_vector(theta) + lengths[1] * along
    other = complex(x[2], x[3]) + lengths[3] * compute_unit_vector(
        compute_second_angle(GEARED_FIVEBAR, x, ratio, theta)
    )
    sine: float = abs((along.conjugate() * (pin - other)).imag) / lengths[2]
    return sine


@njit(**OPTIONS)
def is_jamming(x: Real, lengths: Real, sign: float, ratio: float, cycle: float) -> bool:
    """Return whether a geared fivebar jams, or nearly jams, anywhere in a cycle of its crank, radians."""
    for k in range(CYCLE_SAMPLE_COUNT):
        if _compute_transmission_sine(x, lengths, sign, ratio, cycle * k / CYCLE_SAMPLE_COUNT) < MIN_TRANSMISSION_SINE:
            return True
    return False


@njit(**OPTIONS)
def _compute_cost(
    family: int,
    x: Real,
    lengths: Real,
    sign: float,
    ratio: float,
    theta: Real,
    points: Complex,
    weights: Real,
    cycle: float,
) -> float:
    """Return the weighted sum of squared distances at the crank angles; infinite if the linkage does not close."""
    total = 0.0
    if family == GEARED_FIVEBAR and cycle > 0.0 and is_jamming(x, lengths, sign, ratio, cycle):
        return math.inf
    for i in range(len(points)):
        closes, z, _ = place_linkage(family, x, lengths, sign, ratio, theta[i])
        if not closes:
            return math.inf
        r = z - points[i]
        total += weights[i] * (r.real * r.real + r.imag * r.imag)
    return total


@njit(**OPTIONS)
def measure_pivot_violations(
    family: int, x: Real, lengths: Real, chart: Real, within: Real, off: Real, slopes: Real
) -> float:
    """Return the sum of squared distances of the fixed pivots from their limits.

    ``off`` (4,) receives the signed distance of each coordinate, ``slopes`` (4, m) its derivatives by the unknowns.
    """
    off[:] = 0.0
    slopes[:] = 0.0
    places = np.empty(4)
    places[0], places[1] = x[0], x[1]
    known = 2
    if family <= FOURBAR:
        cosine, sine = math.cos(x[2]), math.sin(x[2])
        places[2], places[3] = x[0] + lengths[0] * cosine, x[1] + lengths[0] * sine
        # O4 = O2 + ground · (cos, sin): it moves with O2, with the ground's direction, and with all lengths of the
        # chart.
        slopes[2, 2], slopes[3, 2] = -lengths[0] * sine, lengths[0] * cosine
        for k in range(4):
            slopes[2, 3 + k], slopes[3, 3 + k] = chart[0, k] * cosine, chart[0, k] * sine
        slopes[2, 0], slopes[3, 1] = 1.0, 1.0
        known = 4
    elif family == GEARED_FIVEBAR:
        places[2], places[3] = x[2], x[3]
        slopes[2, 2], slopes[3, 3] = 1.0, 1.0
        known = 4
    slopes[0, 0], slopes[1, 1] = 1.0, 1.0
    total = 0.0
    # A slider has one fixed pivot, so that only the first two coordinates are known.
    for k in range(known):
        off[k] = min(0.0, places[k] - within[k, 0]) + max(0.0, places[k] - within[k, 1])
        total += off[k] * off[k]
    return total


@njit(**OPTIONS)
def _get_first_log_index(family: int) -> int:
    """Return the index of the first unknown that represents a length."""
    return 4 if family == GEARED_FIVEBAR else 3


@njit(**OPTIONS)
def count_links(family: int) -> int:
    """Return the number of unknowns that represent lengths."""
    return 4 if family <= FOURBAR or family == GEARED_FIVEBAR else 3


@njit(**OPTIONS)
def _build_normal_equations(
    family: int, x: Real, lengths: Real, chart: Real, sign: float, ratio: float, theta: Real, points: Complex,
    weights: Real, slopes: Complex, a: Real, g: Real, c: Real, d: Real, h: Real,
) -> None:  # fmt: skip
    """Compute A (its lower triangle), g, and the blocks C, D, h of the crank angles, for the points alone."""
    m, n = len(x), len(points)
    a[:] = 0.0
    g[:] = 0.0
    for i in range(n):
        _, z = place_with_slopes(family, x, lengths, chart, sign, ratio, theta[i], slopes)
        r, w, along = z - points[i], weights[i], slopes[m]
        d[i] = w * (along.real * along.real + along.imag * along.imag)
        h[i] = w * (along.real * r.real + along.imag * r.imag)
        for j in range(m):
            s = slopes[j]
            g[j] += w * (s.real * r.real + s.imag * r.imag)
            c[i, j] = w * (along.real * s.real + along.imag * s.imag)
            for k in range(j + 1):
                a[j, k] += w * (s.real * slopes[k].real + s.imag * slopes[k].imag)


@njit(**OPTIONS)
def _add_guides(
    family: int, x: Real, lengths: Real, chart: Real, longest: float, off: Real, off_slopes: Real, a: Real, g: Real
) -> None:
    """Add to A and g the residuals of fixed pivots outside their limits, and of lengths beyond the longest."""
    m, logs, count = len(x), _get_first_log_index(family), count_links(family)
    guide = LENGTH_WEIGHT * LENGTH_WEIGHT
    for i in range(4):
        if off[i] != 0.0:
            for j in range(m):
                g[j] += off_slopes[i, j] * off[i]
                for k in range(j + 1):
                    a[j, k] += off_slopes[i, j] * off_slopes[i, k]
    for k in range(count):
        over = abs(lengths[k]) / longest - 1.0
        if over > 0.0:
            for j in range(count):
                # A chart may give a negative length; the excess is that of its absolute value.
                s = chart[k, j] * (1.0 if lengths[k] > 0.0 else -1.0) / longest
                g[logs + j] += guide * over * s
                for i in range(j + 1):
                    a[logs + j, logs + i] += guide * s * chart[k, i] * (1.0 if lengths[k] > 0.0 else -1.0) / longest
    arm = math.hypot(x[m - 2], x[m - 1])
    if arm > longest:
        for j in range(2):
            s = x[m - 2 + j] / (arm * longest)
            g[m - 2 + j] += guide * (arm / longest - 1.0) * s
            for i in range(j + 1):
                a[m - 2 + j, m - 2 + i] += guide * s * x[m - 2 + i] / (arm * longest)


@njit(**OPTIONS)
def _solve_by_elimination(
    a: Real, g: Real, c: Real, d: Real, h: Real, weights: Real, damping: float, work: Real, step: Real
) -> bool:
    """Compute the damped step δx into ``step`` by the Schur complement of the crank angles.

    Returns False if the matrix is singular.
    """
    m, n = len(g), len(h)
    work[:] = a
    for j in range(m):
        # Marquardt's scaling by the diagonal makes the step independent of the units of the unknowns.
        work[j, j] = a[j, j] * (1.0 + damping) + MIN_CURVATURE
        step[j] = -g[j]
    for i in range(n):
        # D is diagonal: each crank angle is eliminated by its own scalar equation.
        inverse = 1.0 / (d[i] * (1.0 + damping) + MIN_TURN_CURVATURE * weights[i])
        for j in range(m):
            cij = c[i, j] * inverse
            step[j] += cij * h[i]
            for k in range(j + 1):
                work[j, k] -= cij * c[i, k]
    solved: bool = solve_positive(work, step)
    return solved


@njit(**OPTIONS)
def _apply_step(
    family: int, x: Real, theta: Real, c: Real, d: Real, h: Real, weights: Real, damping: float, step: Real,
    x_new: Real, theta_new: Real,
) -> None:  # fmt: skip
    """Apply the step, limited to :data:`MAX_LOG_STEP` and :data:`MAX_TURN_STEP`, to linkage and crank angles.

    The linkage's step is shortened as a whole, so that it keeps its direction; angles are limited one by one.
    """
    m, n, logs, count = len(x), len(theta), _get_first_log_index(family), count_links(family)
    shrink = 1.0
    for j in range(logs, logs + count):
        shrink = min(shrink, MAX_LOG_STEP / max(MAX_LOG_STEP, abs(step[j])))
    for j in range(m):
        x_new[j] = x[j] + shrink * step[j]
    for j in range(logs, logs + count):
        x_new[j] = min(max(x_new[j], MIN_LOG), MAX_LOG)
    for i in range(n):
        turn = -h[i]
        for j in range(m):
            turn -= c[i, j] * step[j]
        # Back substitution of the eliminated angles, with the linkage's step as it was shortened.
        turn *= shrink / (d[i] * (1.0 + damping) + MIN_TURN_CURVATURE * weights[i])
        theta_new[i] = theta[i] + min(max(turn, -MAX_TURN_STEP), MAX_TURN_STEP)


@njit(**OPTIONS)
def _descend(
    family: int, x: Real, sign: float, ratio: float, theta: Real, points: Complex, weights: Real, longest: float,
    cycle: float, within: Real, iterations: int,
) -> float:  # fmt: skip
    """Descend in place; return the sum of squared distances, infinite if the start does not close."""
    m, n = len(x), len(points)
    count = count_links(family)
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    slopes = np.empty(m + 1, np.complex128)
    a, g = np.empty((m, m)), np.empty(m)
    c, d, h = np.empty((n, m)), np.empty(n), np.empty(n)
    work, step = np.empty((m, m)), np.empty(m)
    x_new, theta_new = np.empty(m), np.empty(n)
    compute_lengths(family, x, lengths, chart)
    # Starts that do not close cannot be improved by Newton-like steps and are given up at once.
    distance: float = _compute_cost(family, x, lengths, sign, ratio, theta, points, weights, cycle)
    if not distance < math.inf:
        return math.inf
    guide = LENGTH_WEIGHT * LENGTH_WEIGHT
    off, off_slopes = np.zeros(4), np.zeros((4, m))
    # Pivot limits are part of the reported distance, the length penalty only of the cost that guides the descent.
    distance += measure_pivot_violations(family, x, lengths, chart, within, off, off_slopes)
    cost = distance + guide * _compute_length_excess(lengths[:count], m, x, longest)
    damping, idle = INITIAL_DAMPING, 0
    for _ in range(iterations):
        compute_lengths(family, x, lengths, chart)
        _build_normal_equations(family, x, lengths, chart, sign, ratio, theta, points, weights, slopes, a, g, c, d, h)
        measure_pivot_violations(family, x, lengths, chart, within, off, off_slopes)
        _add_guides(family, x, lengths, chart, longest, off, off_slopes, a, g)
        accepted = False
        while damping < MAX_DAMPING:
            # More damping makes the matrix positive definite and shortens a refused step.
            if not _solve_by_elimination(a, g, c, d, h, weights, damping, work, step):
                damping *= DAMPING_INCREASE
                continue
            _apply_step(family, x, theta, c, d, h, weights, damping, step, x_new, theta_new)
            compute_lengths(family, x_new, lengths, chart)
            distance_new = _compute_cost(family, x_new, lengths, sign, ratio, theta_new, points, weights, cycle)
            distance_new += measure_pivot_violations(family, x_new, lengths, chart, within, off, off_slopes)
            cost_new = distance_new + guide * _compute_length_excess(lengths[:count], m, x_new, longest)
            if cost_new < cost:
                accepted = True
                break
            damping *= DAMPING_INCREASE
        if not accepted:
            break
        gain = cost - cost_new
        x[:] = x_new
        theta[:] = theta_new
        cost, distance = cost_new, distance_new
        # Decrease damping by less than refused steps increase it: near a toggle the linear model fails again at once.
        damping = max(damping * DAMPING_DECREASE, MIN_DAMPING)
        idle = idle + 1 if gain <= COST_TOLERANCE * cost else 0
        # One idle step may be a short one after heavy damping; two in a row mean convergence.
        if idle >= 2 or cost <= ZERO_COST:
            break
    return distance


@njit(**OPTIONS)
def _descend_all(
    family: int,
    x: Real,
    sign: Real,
    ratio: float,
    theta: Real,
    points: Complex,
    weights: Real,
    longest: float,
    cycle: float,
    within: Real,
    iterations: int,
    cost: Real,
) -> None:
    for k in range(len(x)):
        cost[k] = _descend(family, x[k], sign[k], ratio, theta[k], points, weights, longest, cycle, within, iterations)


def descend(
    family: int,
    x: Real,
    sign: Real,
    theta: Real,
    points: Complex,
    limits: LinkageLimits = NO_LIMITS,
    *,
    weights: Real | None = None,
    iterations: int = 60,
) -> Descent:
    """Minimize the sum of squared distances of the points from the curve, from every start.

    Parameters
    ----------
    family : int
        A family of :mod:`synthesis.fit.chart`.
    x, sign, theta : float, shapes (n, m), (n,), (n, points)
        Starts: unknowns, assembly signs, crank angles at the points, radians.
    points : complex, shape (points,)
        In task sizes.
    limits : LinkageLimits
        Gear ratio and limits of the linkages, in task sizes.
    weights : float, shape (points,), optional
        Weights of the squared distances.
    iterations : int
        Maximum number of accepted steps.
    """
    x, theta = np.array(x, np.float64), np.array(theta, np.float64)
    w = np.ones(len(points)) if weights is None else np.ascontiguousarray(weights, np.float64)
    cost = np.empty(len(x))
    signs, targets = np.ascontiguousarray(sign, np.float64), np.ascontiguousarray(points, np.complex128)
    inside = np.ascontiguousarray(limits.within, np.float64)
    longest = limits.longest if math.isfinite(limits.longest) else UNLIMITED_LENGTH

    def process_portion(some: slice) -> None:
        _descend_all(
            family,
            x[some],
            signs[some],
            limits.ratio,
            theta[some],
            targets,
            w,
            longest,
            limits.cycle,
            inside,
            iterations,
            cost[some],
        )

    run_in_portions(process_portion, len(x), PORTION_SIZE)
    return Descent(x, theta, cost)
