"""Watt II sixbars through nine of many pairs, as starting points of a fit to all of them.

If a sixbar meets all pairs exactly, it is among the complete set of sixbars through nine of them
(:mod:`synthesis.kinds.function.nine_pairs.continuation`); a search by descents might miss it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.function.nine_pairs.continuation import find_all_watts
from synthesis.kinds.function.nine_pairs.system import PAIR_COUNT
from synthesis.kinds.function.sixbar.descents import SixbarCandidate
from synthesis.kinds.function.sixbar.followers import follow_sixbar
from synthesis.kinds.function.sixbar.kernels import ROW_SIZE, START, WATT_2, ZERO, A, B, C, K, L


class NinePairSixbars(NamedTuple):
    """Sixbars through nine of the pairs that can be assembled at all of them, in ascending order of error.

    ``error`` is the RMS over all pairs, radians; ``complete`` states whether all of them were computed.
    """

    found: list[SixbarCandidate]
    complete: bool


def find_sixbars_through_nine(
    pairs: Real, k: float, l_: float, rng: np.random.Generator, progress: Callable[[float], None]
) -> NinePairSixbars:
    """Find all Watt II sixbars through nine evenly spread pairs.

    Parameters
    ----------
    pairs : float, shape (2, n)
        Inputs and outputs, in order of the inputs; n ≥ 9.
    k, l_ : float
        Scales: rotation of the input (output) link, radians, per unit of the input (output).
    rng : Generator
        Source of the random parameter paths.
    progress : callable
        Callback that receives the share of finished work.
    """
    # Evenly spread pairs determine the function best over the whole range.
    nine = pairs[:, np.round(np.linspace(0, pairs.shape[1] - 1, PAIR_COUNT)).astype(int)]
    watts = find_all_watts(k * nine[0], l_ * nine[1], rng, progress, ways=1)
    found = []
    for vectors in watts.real:
        one = make_sixbar(vectors, k, l_, *(float(x) for x in nine[:, 0]))
        errors = follow_sixbar(WATT_2, one.assembly, one.at, *pairs).errors
        # NaN means that the sixbar cannot be assembled at some pair in the assembly of the first.
        if np.isfinite(errors).all():
            found.append(one._replace(error=float(np.sqrt(np.mean(errors**2)))))
    return NinePairSixbars(sorted(found, key=lambda one: one.error), watts.complete)


def make_sixbar(vectors: Complex, k: float, l_: float, first_input: float, first_output: float) -> SixbarCandidate:
    """Convert a real solution, vectors a, c, d, e of shape (4,), to a row of the sixbar kernels.

    ``k`` and ``l_`` are the scales; ``first_input`` and ``first_output`` the values of the first pair.
    """
    a, c, d, e = (complex(z) for z in vectors)
    at = np.zeros(ROW_SIZE)
    at[[A, B, C, 7, 8, 9]] = abs(a), abs(1.0 + c - a), abs(c), abs(d), abs(1.0 + e - d), abs(e)
    # Angles of the crank and the output at value 0 follow from those at the first pair.
    at[START], at[ZERO] = np.angle(a) - k * first_input, np.angle(e) - l_ * first_output
    at[K], at[L] = k, l_
    at[10] = np.angle(d) - np.angle(c)
    # The assembly bits: whether each dyad's joint is to the left of the line from its pin to its pivot.
    sides = [((1.0 - pin).conjugate() * (1.0 + arm - pin)).imag > 0.0 for pin, arm in ((a, c), (d, e))]
    return SixbarCandidate("watt_2", int(sides[0]) | int(sides[1]) << 1, at, 0.0)
