"""Polynomial system of Watt II sixbars that meet nine pairs of input and output.

A Watt II consists of two fourbars in series. Sizes and directions of their grounds do not affect the output, so both
are 1. At the first pair the crank is a and the rocker c, as vectors from their pivots; in the second fourbar the input
link, which is rigidly connected to that rocker, is d and the output e. From the first pair to the j-th the input turns
by 1 + sⱼ, the output by 1 + rⱼ and the link between them by 1 + t. The couplers keep their lengths if

    α₁ t + β₁ t̄ + f = 0,    α₁ = c (1 − ā (1 + s̄)),     β₁ = c̄ (1 − a (1 + s)),    f = −s a (1 + c̄) − s̄ ā (1 + c),
    α₂ t + β₂ t̄ + g = 0,    α₂ = −d (1 + ē (1 + r̄)),    β₂ = −d̄ (1 + e (1 + r)),    g = r e (1 − d̄) + r̄ ē (1 − d),

with isotropic coordinates: a vector and its conjugate are two unknowns, s̄ = −s/(1 + s). Both are linear in t and t̄,
and t + t̄ + t t̄ = 0 leaves one equation for each pair except the first:

    T T̄ + X (T + T̄) = 0,    T = g β₁ − f β₂,    T̄ = f α₂ − g α₁,    X = α₁ β₂ − α₂ β₁.

These are eight equations in eight unknowns, so nine pairs leave finitely many Watt II sixbars: :data:`SOLUTION_COUNT`
for generic rotations, counted by monodromy (``tools/watt_start.py``). Eight pairs leave one freedom.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex
from kinematics.compiling import njit
from synthesis.numerics.continuation import SYSTEM, CompiledSystem
from synthesis.numerics.double_double import add, compute_reciprocal, multiply
from synthesis.numerics.elimination import reduce

Pair = tuple[complex, complex]
"""A complex number in double-double precision, as (high, low)."""

PAIR_COUNT = 9

SOLUTION_COUNT = 26_370
"""Number of solutions for generic rotations, all nonsingular."""

UNKNOWN_COUNT, PARAMETER_COUNT, SCRATCH_SIZE = 8, 16, 88
"""Numbers of unknowns a, ā, c, c̄, d, d̄, e, ē, of parameters s₁…s₈, r₁…r₈, and of entries of the work array."""

EXPLICIT_PARAMETER_COUNT = 32
"""Number of parameters if the conjugates are given explicitly: s₁…s₈, s̄₁…s̄₈, r₁…r₈, r̄₁…r̄₈."""

SCALE_GROUPS = np.array([0, 0, 1, 1, 2, 2, 3, 3], np.int64)
"""Scaling group of each unknown: a vector and its conjugate share one scale."""

MIN_SEPARATION = 1e-9
"""Minimum difference of c from −d in a counted solution, as a share of |c|."""

MAX_ENTRY = 1e150
"""Maximum magnitude of a matrix entry, to avoid overflow in the elimination."""


@njit(cache=True, nogil=True)
def _fill_row(y: Complex, turns: Complex, moves: Complex, row: Complex) -> None:
    """Write a pair's row: derivatives by the unknowns, minus its equation, and minus its derivative along the path.

    ``turns``: s, s̄, r, r̄; ``moves``: their rates along the path.
    """
    a, a_bar, c, c_bar = y[0], y[1], y[2], y[3]
    d, d_bar, e, e_bar = y[4], y[5], y[6], y[7]
    s, s_bar, r, r_bar = turns[0], turns[1], turns[2], turns[3]
    ds, ds_bar, dr, dr_bar = moves[0], moves[1], moves[2], moves[3]
    u, v, w, z = 1.0 + s, 1.0 + s_bar, 1.0 + r, 1.0 + r_bar
    alpha_1, beta_1 = c * (1.0 - a_bar * v), c_bar * (1.0 - a * u)
    alpha_2, beta_2 = -d * (1.0 + e_bar * z), -d_bar * (1.0 + e * w)
    f = -s * a * (1.0 + c_bar) - s_bar * a_bar * (1.0 + c)
    g = r * e * (1.0 - d_bar) + r_bar * e_bar * (1.0 - d)
    t, t_bar = g * beta_1 - f * beta_2, f * alpha_2 - g * alpha_1
    x = alpha_1 * beta_2 - alpha_2 * beta_1
    # Derivatives of the equation by its intermediate quantities; the chain rule follows below.
    by_t, by_t_bar, by_x = t_bar + x, t + x, t + t_bar
    by_alpha_1, by_beta_1 = by_x * beta_2 - by_t_bar * g, by_t * g - by_x * alpha_2
    by_alpha_2, by_beta_2 = by_t_bar * f - by_x * beta_1, by_x * alpha_1 - by_t * f
    by_f, by_g = by_t_bar * alpha_2 - by_t * beta_2, by_t * beta_1 - by_t_bar * alpha_1
    row[0] = -by_beta_1 * c_bar * u - by_f * s * (1.0 + c_bar)
    row[1] = -by_alpha_1 * c * v - by_f * s_bar * (1.0 + c)
    row[2] = by_alpha_1 * (1.0 - a_bar * v) - by_f * s_bar * a_bar
    row[3] = by_beta_1 * (1.0 - a * u) - by_f * s * a
    row[4] = -by_alpha_2 * (1.0 + e_bar * z) - by_g * r_bar * e_bar
    row[5] = -by_beta_2 * (1.0 + e * w) - by_g * r * e
    row[6] = -by_beta_2 * d_bar * w + by_g * r * (1.0 - d_bar)
    row[7] = -by_alpha_2 * d * z + by_g * r_bar * (1.0 - d)
    # Columns 8 and 9 are the right sides of Newton's step and of the tangent.
    row[8] = -(t * t_bar + x * (t + t_bar))
    row[9] = (
        by_alpha_1 * c * a_bar * ds_bar
        + by_beta_1 * c_bar * a * ds
        + by_f * (ds * a * (1.0 + c_bar) + ds_bar * a_bar * (1.0 + c))
        + by_alpha_2 * d * e_bar * dr_bar
        + by_beta_2 * d_bar * e * dr
        - by_g * (dr * e * (1.0 - d_bar) + dr_bar * e_bar * (1.0 - d))
    )


@njit(cache=True, nogil=True)
def _solve_steps(matrix: Complex, newton: Complex, tangent: Complex) -> int:
    """Solve for the Newton and tangent steps from rows scaled by their largest derivative; return 0 if singular."""
    # Scaled rows make the pivots comparable.
    for row in matrix:
        largest = 0.0
        for k in range(8):
            largest = max(largest, abs(row[k].real), abs(row[k].imag))
        if not 0.0 < largest < MAX_ENTRY:
            return 0
        row /= largest
    if not reduce(matrix):
        return 0
    newton[:], tangent[:] = matrix[:, 8], matrix[:, 9]
    return 1


@njit(cache=True, nogil=True)
def _expand_turns(p: Complex, dp: Complex, j: int, turns: Complex, moves: Complex) -> None:
    """Write s, s̄, r, r̄ of a pair, and their rates."""
    for k, at in ((0, j), (2, 8 + j)):
        # s̄ = −s/(1 + s) and its derivative.
        back = 1.0 / (1.0 + p[at])
        turns[k], turns[k + 1] = p[at], -p[at] * back
        moves[k], moves[k + 1] = dp[at], -dp[at] * back * back


@njit(SYSTEM, cache=True, nogil=True)
def nine_pair_system(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Evaluate the system in the form required by the continuation."""
    matrix, turns, moves = work[:80].reshape((8, 10)), work[80:84], work[84:88]
    for j in range(8):
        _expand_turns(p, dp, j, turns, moves)
        _fill_row(y, turns, moves, matrix[j])
    return _solve_steps(matrix, newton, tangent)


@njit(cache=True, nogil=True)
def _add(one: Pair, other: Pair) -> Pair:
    return add(one[0], one[1], other[0], other[1])


@njit(cache=True, nogil=True)
def _subtract(one: Pair, other: Pair) -> Pair:
    return add(one[0], one[1], -other[0], -other[1])


@njit(cache=True, nogil=True)
def _multiply(one: Pair, other: Pair) -> Pair:
    return multiply(one[0], one[1], other[0], other[1])


@njit(cache=True, nogil=True)
def _invert(one: Pair) -> Pair:
    return compute_reciprocal(one[0], one[1])


@njit(cache=True, nogil=True)
def _evaluate_equation(y: Complex, low: Complex, s: Pair, s_bar: Pair, r: Pair, r_bar: Pair) -> complex:
    """Evaluate T T̄ + X (T + T̄) of a pair in double-double precision."""
    one = (1.0 + 0j, 0j)
    a, a_bar, c, c_bar = (y[0], low[0]), (y[1], low[1]), (y[2], low[2]), (y[3], low[3])
    d, d_bar, e, e_bar = (y[4], low[4]), (y[5], low[5]), (y[6], low[6]), (y[7], low[7])
    alpha_1 = _multiply(c, _subtract(one, _multiply(a_bar, _add(one, s_bar))))
    beta_1 = _multiply(c_bar, _subtract(one, _multiply(a, _add(one, s))))
    # α₂, β₂ and f are computed with opposite sign, which cancels in the result.
    alpha_2 = _multiply(d, _add(one, _multiply(e_bar, _add(one, r_bar))))
    beta_2 = _multiply(d_bar, _add(one, _multiply(e, _add(one, r))))
    f = _add(_multiply(_multiply(s, a), _add(one, c_bar)), _multiply(_multiply(s_bar, a_bar), _add(one, c)))
    g = _add(_multiply(_multiply(r, e), _subtract(one, d_bar)), _multiply(_multiply(r_bar, e_bar), _subtract(one, d)))
    t = _subtract(_multiply(g, beta_1), _multiply(f, beta_2))
    t_bar = _subtract(_multiply(f, alpha_2), _multiply(g, alpha_1))
    x = _subtract(_multiply(alpha_2, beta_1), _multiply(alpha_1, beta_2))
    gap = _add(_multiply(t, t_bar), _multiply(x, _add(t, t_bar)))
    return gap[0]


@njit(SYSTEM, cache=True, nogil=True)
def nine_pair_system_extended(
    y: Complex, low: Complex, p: Complex, p_low: Complex, dp: Complex, newton: Complex, tangent: Complex, work: Complex
) -> int:
    """Evaluate the system with its equations in double-double precision.

    Newton's method converges to the accuracy of its equations; the matrix may be less accurate. At end points all
    :data:`EXPLICIT_PARAMETER_COUNT` parameters may be given: the conjugates of real rotations are then exact, so real
    solutions are found as such.
    """
    matrix, turns, moves = work[:80].reshape((8, 10)), work[80:84], work[84:88]
    one = (1.0 + 0j, 0j)
    for j in range(8):
        if p.size == EXPLICIT_PARAMETER_COUNT:
            turns[:], moves[:] = p[j:EXPLICIT_PARAMETER_COUNT:8], dp[j:EXPLICIT_PARAMETER_COUNT:8]
            s, s_bar, r, r_bar = (turns[0], 0j), (turns[1], 0j), (turns[2], 0j), (turns[3], 0j)
        else:
            _expand_turns(p, dp, j, turns, moves)
            # The parameters' low parts matter near almost singular solutions.
            s, r = (p[j], p_low[j]), (p[8 + j], p_low[8 + j])
            s_bar = _multiply((-s[0], -s[1]), _invert(_add(one, s)))
            r_bar = _multiply((-r[0], -r[1]), _invert(_add(one, r)))
        _fill_row(y, turns, moves, matrix[j])
        # Only the right side needs the high precision: the matrix just directs the step.
        matrix[j, 8] = -_evaluate_equation(y, low, s, s_bar, r, r_bar)
    return _solve_steps(matrix, newton, tangent)


def is_linkage(y: Complex) -> NDArray[np.bool_]:
    """Return a mask of the solutions that are counted: shape (...), for y of shape (..., 8).

    If d = −c, joints B and C and pivots O2 and O6 coincide, and the system has whole curves of degenerate solutions, at
    which failed paths may end.
    """
    c, d = y[..., 2:4], y[..., 4:6]
    return np.asarray((np.abs(c + d) > MIN_SEPARATION * np.abs(c)).any(axis=-1))


def compute_residuals(y: Complex, p: Complex) -> NDArray[np.float64]:
    """Return the largest |T T̄ + X (T + T̄)| of each solution relative to its terms: (..., 8) gives shape (...)."""
    a, a_bar, c, c_bar, d, d_bar, e, e_bar = np.moveaxis(y, -1, 0)[..., None]
    s, r = p[:8], p[8:]
    v, z = 1.0 / (1.0 + s), 1.0 / (1.0 + r)
    s_bar, r_bar = -s * v, -r * z
    alpha_1, beta_1 = c * (1.0 - a_bar * v), c_bar * (1.0 - a * (1.0 + s))
    alpha_2, beta_2 = -d * (1.0 + e_bar * z), -d_bar * (1.0 + e * (1.0 + r))
    f = -s * a * (1.0 + c_bar) - s_bar * a_bar * (1.0 + c)
    g = r * e * (1.0 - d_bar) + r_bar * e_bar * (1.0 - d)
    t, t_bar, x = g * beta_1 - f * beta_2, f * alpha_2 - g * alpha_1, alpha_1 * beta_2 - alpha_2 * beta_1
    # Relative to the terms' magnitudes, so that the residual measures cancellation.
    terms = np.abs(t * t_bar) + np.abs(x * t) + np.abs(x * t_bar)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((np.abs(t * t_bar + x * (t + t_bar)) / terms).max(axis=-1))


NINE_PAIR_SYSTEM = CompiledSystem(nine_pair_system, SCALE_GROUPS, SCRATCH_SIZE)
"""The equations for the tracker, and below in twice the precision."""

PRECISE_NINE_PAIR_SYSTEM = NINE_PAIR_SYSTEM._replace(evaluate=nine_pair_system_extended)
