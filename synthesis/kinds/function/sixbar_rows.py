"""Sixbar function generators as a problem of least squares under limits, for Levenberg and Marquardt's method.

The unknowns are a row's numbers (:mod:`~synthesis.kinds.function.sixbar_kernels`), lengths and scales by their
logarithms. Residuals are the structural errors, and what is lacking of the limits: of transmission angles by their
cosines at each place, of the link ratio by logarithms.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.kinds.function.sixbar_kernels import (
    LOGARITHMIC,
    NUMBERS,
    STEPHENSON_3,
    WATT_2,
    A,
    B,
    C,
    K,
    L,
    follow,
)
from synthesis.numerics.levenberg import ROWS

Real = NDArray[np.float64]

KIND, ASSEMBLY, SIGN_K, SIGN_L, COSINE, RATIO, STRICT, FREE = range(8)
"""Where a setting holds its numbers: the type, the assembly, the signs of both scales, the greatest cosine of a
transmission angle, the logarithm of the greatest link ratio, how much limits weigh, and from FREE on which numbers are
open."""

SETTING = FREE + NUMBERS

WIDEST, INSIDE = 1e3, 1e-6
"""Link ratio that is kept where no limit is given, and what is kept of the logarithm of a given one."""

LISTED = 8
"""Lengths of a type that its link ratio is steered by, at most."""


@njit(cache=True, nogil=True, error_model="numpy")
def unlogged(kind: int, x: Real, setting: Real, state: Real, at: Real) -> None:
    """The numbers of a row from the unknowns."""
    for n in range(NUMBERS):
        at[n] = math.exp(x[n]) if LOGARITHMIC[kind, n] else x[n]
    at[K] *= setting[SIGN_K]
    at[L] *= setting[SIGN_L]
    at[NUMBERS - 1] = state[0]


@njit(cache=True, nogil=True, error_model="numpy")
def _groups(kind: int, columns: NDArray[np.int64]) -> int:
    """Columns of the lengths whose ratios are limited, −1 for a ground of length 1; how many there are.

    Watt II has two fourbars, the size of the second beside the first being free: they stand one after the other.
    """
    columns[0], columns[1], columns[2], columns[3] = -1, A, B, C
    if kind == WATT_2:
        columns[4], columns[5], columns[6], columns[7] = -1, 7, 8, 9
        return 8
    columns[4], columns[5] = (11, 12) if kind == STEPHENSON_3 else (9, 10)
    return 6


@njit(cache=True, nogil=True, error_model="numpy")
def _ratio_row(
    at: Real, columns: NDArray[np.int64], begin: int, end: int, most: float, weight: float, row: Real
) -> float:
    """What the longest and the shortest of some lengths are beyond a ratio, weighed, with its derivatives."""
    low, high = begin, begin
    logs = np.empty(LISTED)
    for j in range(begin, end):
        logs[j] = 0.0 if columns[j] < 0 else math.log(at[columns[j]])
        if logs[j] < logs[low]:
            low = j
        if logs[j] > logs[high]:
            high = j
    row[:] = 0.0
    over = logs[high] - logs[low] - most
    if not over > 0.0:
        return 0.0
    if columns[high] >= 0:
        row[columns[high]] = weight
    if columns[low] >= 0:
        row[columns[low]] = -weight
    return float(weight * over)


@njit(ROWS, cache=True, nogil=True, error_model="numpy")
def rows(x: Real, points: Real, setting: Real, _multipliers: Real, state: Real, residuals: Real, jacobian: Real) -> int:
    """Errors and what is lacking; the rows of ``points`` (4, m) are the inputs, the outputs, and the weights of the
    errors and of the limits there. ``state`` is Stephenson II's τ."""
    kind, assembly = int(setting[KIND]), int(setting[ASSEMBLY])
    inputs, outputs, weights, limited = points
    m = inputs.size
    at = np.empty(NUMBERS)
    unlogged(kind, x, setting, state, at)
    errors, slopes = np.empty(m), np.zeros((m, NUMBERS))
    cosines, by_cosine = np.zeros((m, 2)), np.zeros((m, 2, NUMBERS))
    felt, strict, free = setting[COSINE], setting[STRICT], setting[FREE:]
    tau = follow(kind, assembly, at, inputs, outputs, felt, errors, slopes, cosines, by_cosine)
    if not math.isfinite(tau):
        return -1
    state[0] = tau
    count = 0
    for j in range(m):
        residuals[count] = weights[j] * errors[j]
        jacobian[count] = weights[j] * slopes[j] * free
        count += 1
        for d in range(2):
            over = abs(cosines[j, d]) - felt
            residuals[count] = limited[j] * strict * max(over, 0.0)
            jacobian[count] = 0.0
            if over > 0.0:
                jacobian[count] = math.copysign(limited[j] * strict, cosines[j, d]) * by_cosine[j, d] * free
            count += 1
    columns = np.empty(LISTED, np.int64)
    listed = _groups(kind, columns)
    step = 4 if kind == WATT_2 else listed
    for begin in range(0, listed, step):
        residuals[count] = _ratio_row(at, columns, begin, begin + step, setting[RATIO], strict, jacobian[count])
        jacobian[count] *= free
        count += 1
    return count


def most_rows(places: int) -> int:
    """Rows of so many places at most."""
    return 3 * places + 2


@njit(cache=True, nogil=True, error_model="numpy")
def weigh(kind: int, assemblies: NDArray[np.int64], at: Real, points: Real, cosine: float, costs: Real) -> None:
    """Of many sixbars half the sum of squares of errors and of what transmission lacks; infinite where one fails.

    ``points`` as for :func:`rows`.
    """
    inputs, outputs, weights, limited = points
    m = inputs.size
    errors, slopes = np.empty(m), np.zeros((m, NUMBERS))
    cosines, by_cosine = np.zeros((m, 2)), np.zeros((m, 2, NUMBERS))
    for i in range(len(at)):
        costs[i] = math.inf
        tau = follow(kind, assemblies[i], at[i], inputs, outputs, 2.0, errors, slopes, cosines, by_cosine)
        if not math.isfinite(tau):
            continue
        cost = 0.0
        for j in range(m):
            cost += 0.5 * (weights[j] * errors[j]) ** 2
            for d in range(2):
                cost += 0.5 * (limited[j] * max(abs(cosines[j, d]) - cosine, 0.0)) ** 2
        costs[i] = cost
