"""Compiled lengths of sixbar function generators: the distances between pins of a link, whose ratio is limited.

Each is a distance in the frame of a link and follows from a row's numbers alone
(:mod:`~synthesis.kinds.function.sixbar.kernels`). A Watt II consists of two fourbars, each with ground 1: the size of
the second relative to the first is free, and determines the remaining lengths of its ternary links.
"""

from __future__ import annotations

import math

from kinematics.arrays import Real
from kinematics.compiling import njit
from synthesis.kinds.function.sixbar.kernels import STEPHENSON_3, WATT_2, A, B, C

MAX_LENGTHS = 10
"""Maximum number of lengths of a type."""


@njit(cache=True, nogil=True, error_model="numpy")
def _append_distance(at: Real, place: int, from_column: int, logs: Real, slopes: Real, n: int) -> int:
    """Write a point's distance from its frame's origin, or from the end of the frame's link, as entry n; return n + 1.

    ``place``: column of the point's coordinates; ``from_column``: −2 for the origin, −1 for (1, 0), or the column of
    the link's length.
    """
    x, y = at[place], at[place + 1]
    if from_column > -2:
        x -= at[from_column] if from_column >= 0 else 1.0
    square = x * x + y * y
    logs[n] = 0.5 * math.log(square)
    slopes[n, place], slopes[n, place + 1] = x / square, y / square
    if from_column >= 0:
        slopes[n, from_column] = -x / square * at[from_column]
    return n + 1


@njit(cache=True, nogil=True, error_model="numpy")
def compute_log_lengths(kind: int, at: Real, logs: Real, slopes: Real) -> int:
    """Compute the logarithms of all lengths of a sixbar, and their derivatives by its steps.

    Parameters
    ----------
    kind : int
    at : float, shape (ROW_SIZE,)
        The sixbar's row.
    logs, slopes : float, shapes (MAX_LENGTHS,), (MAX_LENGTHS, ROW_SIZE)
        Output. Steps are of logarithms for the numbers in
        :data:`~synthesis.kinds.function.sixbar.kernels.IS_LOGARITHMIC`.

    Returns
    -------
    int
        Number of lengths; for a Watt II the second half belongs to the second fourbar.
    """
    logs[:], slopes[:] = 0.0, 0.0
    n = 0
    # Column −1 is the ground, of length 1 and logarithm 0.
    for column in (-1, A, B, C):
        if column >= 0:
            logs[n], slopes[n, column] = math.log(at[column]), 1.0
        n += 1
    bars = (7, 8, 9) if kind == WATT_2 else ((11, 12, -1) if kind == STEPHENSON_3 else (9, 10, -1))
    # The second fourbar has a ground of its own, also of length 1.
    if kind == WATT_2:
        n += 1
    for column in bars:
        if column >= 0:
            logs[n], slopes[n, column] = math.log(at[column]), 1.0
            n += 1
    if kind == WATT_2:
        return n
    if kind == STEPHENSON_3:
        # C on the coupler to A and B; O6 to O2 and O4.
        for place, other in ((7, B), (9, -1)):
            n = _append_distance(at, place, -2, logs, slopes, n)
            n = _append_distance(at, place, other, logs, slopes, n)
        return n
    # C on the input to O2 and A; E on the link B D to B and D.
    for place, other in ((7, A), (11, 9)):
        n = _append_distance(at, place, -2, logs, slopes, n)
        n = _append_distance(at, place, other, logs, slopes, n)
    return n
