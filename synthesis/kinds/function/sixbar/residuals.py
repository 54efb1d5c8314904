"""Sixbar function generators as a constrained least-squares problem for the Levenberg-Marquardt method.

The unknowns are a row's numbers (:mod:`~synthesis.kinds.function.sixbar.kernels`), with logarithms of lengths and
scales. Residuals are the structural errors and the constraint violations: cosines of transmission angles at each input,
and the logarithm of the link ratio.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.kinds.function.sixbar.kernels import IS_LOGARITHMIC, ROW_SIZE, WATT_2, K, L, follow
from synthesis.kinds.function.sixbar.link_lengths import MAX_LENGTHS, compute_log_lengths
from synthesis.numerics.array_layout import ArrayLayout
from synthesis.numerics.levenberg import ROWS

SETTING = ArrayLayout(kind=1, assembly=1, sign_k=1, sign_l=1, cosine=1, ratio=1, strict=1, free=ROW_SIZE)
"""Setting of a sixbar and its limits."""

KIND, ASSEMBLY = SETTING.index("kind"), SETTING.index("assembly")
"""Type and assembly."""

SIGN_K, SIGN_L = SETTING.index("sign_k"), SETTING.index("sign_l")
"""Signs of both scales."""

COSINE = SETTING.index("cosine")
"""Maximum cosine of a transmission angle."""

RATIO = SETTING.index("ratio")
"""Logarithm of the maximum link ratio."""

STRICT = SETTING.index("strict")
"""Weight of the limits."""

FREE = SETTING.slice("free")
"""Mask of the numbers that are free."""

DEFAULT_MAX_RATIO, RATIO_MARGIN = 1e3, 1e-6
"""Default maximum link ratio, and margin in the logarithm of the limit."""


@njit(cache=True, nogil=True, error_model="numpy")
def decode_unknowns(kind: int, x: Real, setting: Real, state: Real, at: Real) -> None:
    """Decode the unknowns to the numbers of a row."""
    for n in range(ROW_SIZE):
        at[n] = math.exp(x[n]) if IS_LOGARITHMIC[kind, n] else x[n]
    at[K] *= setting[SIGN_K]
    at[L] *= setting[SIGN_L]
    at[ROW_SIZE - 1] = state[0]


@njit(cache=True, nogil=True, error_model="numpy")
def _compute_ratio_row(logs: Real, slopes: Real, begin: int, end: int, most: float, weight: float, row: Real) -> float:
    """Return the weighted excess of the ratio of some lengths over its limit, and write its derivatives."""
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
    for n in range(ROW_SIZE):
        row[n] = weight * (slopes[high, n] - slopes[low, n])
    return float(weight * over)


@njit(ROWS, cache=True, nogil=True, error_model="numpy")
def evaluate_rows(
    x: Real, points: Real, setting: Real, _multipliers: Real, state: Real, residuals: Real, jacobian: Real
) -> int:
    """Evaluate errors and constraint violations with their Jacobian; return the number of rows, −1 on failure.

    The rows of ``points`` (4, m) are inputs, outputs, weights of the errors, and weights of the limits. ``state`` is
    Stephenson II's τ.
    """
    kind, assembly = int(setting[KIND]), int(setting[ASSEMBLY])
    inputs, outputs, weights, limited = points
    m = inputs.size
    at = np.empty(ROW_SIZE)
    decode_unknowns(kind, x, setting, state, at)
    errors, slopes = np.empty(m), np.zeros((m, ROW_SIZE))
    cosines, by_cosine = np.zeros((m, 2)), np.zeros((m, 2, ROW_SIZE))
    felt, strict, free = setting[COSINE], setting[STRICT], setting[FREE]
    tau = follow(kind, assembly, at, inputs, outputs, felt, errors, slopes, cosines, by_cosine)
    # Not assembled at some input: the step is refused.
    if not math.isfinite(tau):
        return -1
    state[0] = tau
    count = 0
    for j in range(m):
        residuals[count] = weights[j] * errors[j]
        jacobian[count] = weights[j] * slopes[j] * free
        count += 1
        for d in range(2):
            # Always a row, even without a violation: the valley method needs the same rows at every point.
            over = abs(cosines[j, d]) - felt
            residuals[count] = limited[j] * strict * max(over, 0.0)
            jacobian[count] = 0.0
            if over > 0.0:
                jacobian[count] = math.copysign(limited[j] * strict, cosines[j, d]) * by_cosine[j, d] * free
            count += 1
    logs, by_step = np.empty(MAX_LENGTHS), np.empty((MAX_LENGTHS, ROW_SIZE))
    listed = compute_log_lengths(kind, at, logs, by_step)
    # Limit the ratio within each fourbar of a Watt II, because their relative size is free.
    group = listed // 2 if kind == WATT_2 else listed
    for begin in range(0, listed, group):
        residuals[count] = _compute_ratio_row(
            logs, by_step, begin, begin + group, setting[RATIO], strict, jacobian[count]
        )
        jacobian[count] *= free
        count += 1
    return count


def count_max_rows(places: int) -> int:
    """Return the maximum number of rows for a number of inputs."""
    return 3 * places + 2


@njit(cache=True, nogil=True, error_model="numpy")
def evaluate_costs(
    kind: int, assemblies: NDArray[np.int64], at: Real, points: Real, cosine: float, costs: Real
) -> None:
    """Write half the sum of squares of errors and transmission violations of many sixbars; infinite on failure.

    ``points`` as for :func:`evaluate_rows`.
    """
    inputs, outputs, weights, limited = points
    m = inputs.size
    errors, slopes = np.empty(m), np.zeros((m, ROW_SIZE))
    cosines, by_cosine = np.zeros((m, 2)), np.zeros((m, 2, ROW_SIZE))
    for i in range(len(at)):
        costs[i] = math.inf
        # A cosine threshold above 1 switches the expensive derivatives off.
        tau = follow(kind, assemblies[i], at[i], inputs, outputs, 2.0, errors, slopes, cosines, by_cosine)
        if not math.isfinite(tau):
            continue
        cost = 0.0
        for j in range(m):
            cost += 0.5 * (weights[j] * errors[j]) ** 2
            for d in range(2):
                cost += 0.5 * (limited[j] * max(abs(cosines[j, d]) - cosine, 0.0)) ** 2
        costs[i] = cost
