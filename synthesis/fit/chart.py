"""Charts of linkages: unknowns x for which a family's property holds at all x, without bounds or penalties.

A linkage is a row of unknowns x, scaled to the task. The first two are the coordinates of O2, the last two those of P
in the coupler's frame (origin at A, real axis towards the coupler's other pin).

=============== ======================================= ============================================================
family          unknowns                                 lengths
=============== ======================================= ============================================================
double-crank    O2, γ, u₁…u₄, P                          S = e^{u₁}, sₖ = e^{uₖ₊₁}; d = S is shortest, the others, in
                                                         the order d, a, b, c, are S + (s₂ + s₃)/2, S + (s₁ + s₂)/2
                                                         and S + (s₁ + s₃)/2
crank-rocker    the same                                 the same with a shortest
double-rocker   the same                                 the same with b shortest
fourbar         the same                                 d, a, b, c = e^{uₖ}: any
slider-crank    O2, σ, u₁…u₃, P                          a = e^{u₁}, b = a + e^{u₂}, offset c = e^{u₂} tanh u₃:
                                                         a + \\|c\\| < b, the crank rotates fully
slider-rocker   the same                                 a = e^{u₁}, b = e^{u₂}, c = u₃: any
geared fivebar  O2, O5, u₁…u₄, Φ, P                      input, coupler 1, coupler 2, output = e^{uₖ}
=============== ======================================= ============================================================

γ is the direction of the ground line, σ of the slide. With S shortest and L longest, one of the sₖ is P + Q − L − S for
the remaining two links P and Q: the fourbar satisfies Grashof's condition for all positive s, and no descent can leave
its class.
"""

from __future__ import annotations

import math

from kinematics.arrays import Real
from kinematics.compiling import KernelOptions, njit

OPTIONS: KernelOptions = {"cache": True, "nogil": True, "error_model": "numpy"}
"""Compiler options of the fits' kernels: division by zero raises no exception, since results are checked for NaN."""

DOUBLE_CRANK, CRANK_ROCKER, DOUBLE_ROCKER, FOURBAR, SLIDER_CRANK, SLIDER_ROCKER, GEARED_FIVEBAR = range(7)
"""Families of linkages. A number below :data:`FOURBAR` is also that of the shortest link, in the order d, a, b, c."""

UNKNOWNS = {
    DOUBLE_CRANK: 9,
    CRANK_ROCKER: 9,
    DOUBLE_ROCKER: 9,
    FOURBAR: 9,
    SLIDER_CRANK: 8,
    SLIDER_ROCKER: 8,
    GEARED_FIVEBAR: 11,
}
"""Number of unknowns of a linkage of each family."""

LENGTHS, POINT = 3, 7
"""Indices of the first length number and of P's coordinates in the x of a fourbar."""

MIN_LOG, MAX_LOG = -16.0, 16.0
"""Limits of the logarithms of lengths in task sizes: far beyond any useful linkage, but harmless for rounding."""


@njit(**OPTIONS)
def compute_lengths(family: int, x: Real, lengths: Real, slopes: Real) -> None:
    """Compute a linkage's lengths, and their derivatives by the unknowns u as a square matrix.

    Fourbars: d, a, b, c. Slider-cranks: a, b, offset. Geared fivebars: input, coupler 1, coupler 2, output.
    """
    slopes[:] = 0.0
    if family < FOURBAR:
        shortest = math.exp(x[3])
        # s₁, s₂ and s₃ are differences of links; exponentials keep them positive, and with them the class.
        half_1, half_2, half_3 = 0.5 * math.exp(x[4]), 0.5 * math.exp(x[5]), 0.5 * math.exp(x[6])
        (first, second), third = _list_other_links(family), 3
        slopes[:, 0] = shortest
        slopes[second, 1] = slopes[third, 1] = half_1
        slopes[first, 2] = slopes[second, 2] = half_2
        slopes[first, 3] = slopes[third, 3] = half_3
        lengths[family] = shortest
        lengths[first] = shortest + half_2 + half_3
        lengths[second] = shortest + half_1 + half_2
        lengths[third] = shortest + half_1 + half_3
    elif family == FOURBAR:
        for k in range(4):
            lengths[k] = slopes[k, k] = math.exp(x[3 + k])
    elif family == SLIDER_CRANK:
        # tanh keeps |c| below the excess b − a, so the crank rotates fully for every u₃.
        crank, rest, t = math.exp(x[3]), math.exp(x[4]), math.tanh(x[5])
        lengths[0], lengths[1], lengths[2] = crank, crank + rest, rest * t
        slopes[0, 0] = slopes[1, 0] = crank
        slopes[1, 1] = rest
        slopes[2, 1] = rest * t
        slopes[2, 2] = rest * (1.0 - t * t)
    elif family == SLIDER_ROCKER:
        lengths[0] = slopes[0, 0] = math.exp(x[3])
        lengths[1] = slopes[1, 1] = math.exp(x[4])
        # The offset of a slider-rocker is free, of either sign, and so not exponential.
        lengths[2] = x[5]
        slopes[2, 2] = 1.0
    else:
        for k in range(4):
            lengths[k] = slopes[k, k] = math.exp(x[4 + k])


@njit(**OPTIONS)
def _list_other_links(shortest: int) -> tuple[int, int]:
    """Return the first two of the links d, a, b (0 to 2) that are not the shortest; c is always the third."""
    return 1 if shortest == 0 else 0, 1 if shortest > 1 else 2


@njit(**OPTIONS)
def write_unknowns(lengths: Real, family: int, edge: float, x: Real) -> bool:
    """Write the unknowns u of a fourbar's lengths into x; return False if the linkage is not of the given family.

    ``edge`` is the minimum s, as a share of the sum of all lengths. A linkage nearer to a change point than that, or
    beyond it, is moved to the minimum. With an ``edge`` of 0, linkages outside the family are refused.
    """
    if family == FOURBAR:
        for k in range(4):
            x[LENGTHS + k] = math.log(lengths[k])
        return True
    (first, second), third = _list_other_links(family), 3
    shortest = lengths[family]
    one, two, three = lengths[first] - shortest, lengths[second] - shortest, lengths[third] - shortest
    # Invert the chart: each s is a sum of two excesses over the shortest link minus the third.
    least = edge * lengths.sum()
    s1, s2, s3 = max(two + three - one, least), max(one + two - three, least), max(one + three - two, least)
    # Also false for NaN.
    if not (s1 > 0.0 and s2 > 0.0 and s3 > 0.0):
        return False
    x[LENGTHS], x[LENGTHS + 1] = math.log(shortest), math.log(s1)
    x[LENGTHS + 2], x[LENGTHS + 3] = math.log(s2), math.log(s3)
    return True
