"""Watt II sixbars through nine of many pairs, each a start of a search for those that follow all of them.

Pairs that some sixbar meets exactly are met by one of all sixbars through nine of them
(:mod:`synthesis.kinds.function.nine_pairs`), which no search by descents is sure to find.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function.nine_pair_system import PAIRS
from synthesis.kinds.function.nine_pairs import all_watts
from synthesis.kinds.function.sixbar_descents import Found
from synthesis.kinds.function.sixbar_followers import followed
from synthesis.kinds.function.sixbar_kernels import NUMBERS, START, WATT_2, ZERO, A, B, C, K, L

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]


class Through(NamedTuple):
    """Sixbars through nine of the pairs that close at all of them, the nearest to all pairs first; their ``error`` is
    the root mean square, radians. ``complete`` where all that there are were computed."""

    found: list[Found]
    complete: bool


def through_nine(
    pairs: Real, k: float, l_: float, rng: np.random.Generator, progress: Callable[[float], None]
) -> Through:
    """All Watt II sixbars through nine of some pairs that are spread evenly.

    Parameters
    ----------
    pairs : float, shape (2, n)
        Inputs and outputs, in the order of the inputs; nine at least.
    k, l_ : float
        Radians of the input link for one of an input, and of the output link for one of an output.
    rng : Generator
        Draws the ways of the continuation.
    progress : callable
        Told the share of the work that is done.
    """
    nine = pairs[:, np.round(np.linspace(0, pairs.shape[1] - 1, PAIRS)).astype(int)]
    watts = all_watts(k * nine[0], l_ * nine[1], rng, progress, ways=1)
    found = []
    for vectors in watts.real:
        one = sixbar_of(vectors, k, l_, *(float(x) for x in nine[:, 0]))
        errors = followed(WATT_2, one.assembly, one.at, *pairs).errors
        if np.isfinite(errors).all():
            found.append(one._replace(error=float(np.sqrt(np.mean(errors**2)))))
    return Through(sorted(found, key=lambda one: one.error), watts.complete)


def sixbar_of(vectors: Complex, k: float, l_: float, first_input: float, first_output: float) -> Found:
    """A real solution, the vectors a, c, d, e of shape (4,), as a row of
    :mod:`~synthesis.kinds.function.sixbar_kernels`; the input first, radians by its scale ``k``, and so the output."""
    a, c, d, e = (complex(z) for z in vectors)
    at = np.zeros(NUMBERS)
    at[[A, B, C, 7, 8, 9]] = abs(a), abs(1.0 + c - a), abs(c), abs(d), abs(1.0 + e - d), abs(e)
    at[START], at[ZERO] = np.angle(a) - k * first_input, np.angle(e) - l_ * first_output
    at[K], at[L] = k, l_
    at[10] = np.angle(d) - np.angle(c)
    # Whether the joint of each dyad is to the left of the way from its pin to its pivot.
    sides = [((1.0 - pin).conjugate() * (1.0 + arm - pin)).imag > 0.0 for pin, arm in ((a, c), (d, e))]
    return Found("watt_2", int(sides[0]) | int(sides[1]) << 1, at, 0.0)
