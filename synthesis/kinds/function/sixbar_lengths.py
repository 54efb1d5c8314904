"""Lengths of sixbar function generators, the distances between pins of a link, whose ratio is limited; compiled.

Each is a distance in the frame of a link, so that it follows from a row's numbers
(:mod:`~synthesis.kinds.function.sixbar_kernels`) alone. A Watt II is two fourbars, each with a ground of 1: the size of
the second beside the first is free, and what of its ternary links lies between both is chosen with it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.compiling import njit
from synthesis.kinds.function.sixbar_kernels import STEPHENSON_3, WATT_2, A, B, C

Real = NDArray[np.float64]

LENGTHS = 10
"""Lengths of a type at most."""


@njit(cache=True, nogil=True, error_model="numpy")
def _distance(at: Real, place: int, from_column: int, logs: Real, slopes: Real, n: int) -> int:
    """The distance of a point from its frame's origin, or from the end of its frame's link, as the n-th; n + 1.

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
def log_lengths(kind: int, at: Real, logs: Real, slopes: Real) -> int:
    """Logarithms of all lengths of a sixbar, and their derivatives by its steps.

    Parameters
    ----------
    kind : int
    at : float, shape (NUMBERS,)
        The sixbar's row.
    logs, slopes : float, shapes (LENGTHS,), (LENGTHS, NUMBERS)
        Filled: from the first on. Steps are of logarithms where :data:`sixbar_kernels.LOGARITHMIC` says so.

    Returns
    -------
    int
        How many they are; of a Watt II those of the second fourbar are the last half.
    """
    logs[:], slopes[:] = 0.0, 0.0
    n = 0
    for column in (-1, A, B, C):
        if column >= 0:
            logs[n], slopes[n, column] = math.log(at[column]), 1.0
        n += 1
    bars = (7, 8, 9) if kind == WATT_2 else ((11, 12, -1) if kind == STEPHENSON_3 else (9, 10, -1))
    if kind == WATT_2:
        n += 1
    for column in bars:
        if column >= 0:
            logs[n], slopes[n, column] = math.log(at[column]), 1.0
            n += 1
    if kind == WATT_2:
        return n
    if kind == STEPHENSON_3:
        # C on the coupler from A and from B, O6 from O2 and from O4.
        for place, other in ((7, B), (9, -1)):
            n = _distance(at, place, -2, logs, slopes, n)
            n = _distance(at, place, other, logs, slopes, n)
        return n
    # C on the input from O2 and from A, E on the link B D from B and from D.
    for place, other in ((7, A), (11, 9)):
        n = _distance(at, place, -2, logs, slopes, n)
        n = _distance(at, place, other, logs, slopes, n)
    return n
