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
from synthesis.kinds.function.sixbar_kernels import LOGARITHMIC, NUMBERS, WATT_2, K, L, follow
from synthesis.kinds.function.sixbar_lengths import LENGTHS, log_lengths
from synthesis.numerics.levenberg import ROWS

Real = NDArray[np.float64]

KIND, ASSEMBLY, SIGN_K, SIGN_L, COSINE, RATIO, STRICT, FREE = range(8)
"""Where a setting holds its numbers: the type, the assembly, the signs of both scales, the greatest cosine of a
transmission angle, the logarithm of the greatest link ratio, how much limits weigh, and from FREE on which numbers are
open."""

SETTING = FREE + NUMBERS

WIDEST, INSIDE = 1e3, 1e-6
"""Link ratio that is kept where no limit is given, and what is kept of the logarithm of a given one."""


@njit(cache=True, nogil=True, error_model="numpy")
def unlogged(kind: int, x: Real, setting: Real, state: Real, at: Real) -> None:
    """The numbers of a row from the unknowns."""
    for n in range(NUMBERS):
        at[n] = math.exp(x[n]) if LOGARITHMIC[kind, n] else x[n]
    at[K] *= setting[SIGN_K]
    at[L] *= setting[SIGN_L]
    at[NUMBERS - 1] = state[0]


@njit(cache=True, nogil=True, error_model="numpy")
def _ratio_row(logs: Real, slopes: Real, begin: int, end: int, most: float, weight: float, row: Real) -> float:
    """What the longest and the shortest of some lengths are beyond a ratio, weighed, with its derivatives."""
    low, high = begin, begin
    for j in range(begin, end):
        if logs[j] < logs[low]:
            low = j
        if logs[j] > logs[high]:
            high = j
    row[:] = 0.0
    over = logs[high] - logs[low] - most
    if not over > 0.0:
        return 0.0
    for n in range(NUMBERS):
        row[n] = weight * (slopes[high, n] - slopes[low, n])
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
    logs, by_step = np.empty(LENGTHS), np.empty((LENGTHS, NUMBERS))
    listed = log_lengths(kind, at, logs, by_step)
    # The size of a Watt II's second fourbar beside the first is free.
    group = listed // 2 if kind == WATT_2 else listed
    for begin in range(0, listed, group):
        residuals[count] = _ratio_row(logs, by_step, begin, begin + group, setting[RATIO], strict, jacobian[count])
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
