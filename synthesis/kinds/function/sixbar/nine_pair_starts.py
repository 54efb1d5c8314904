"""Watt II sixbars through nine of many pairs, as starting points of a fit to all of them.

If a sixbar meets all pairs exactly, it is among the complete set of sixbars through nine of them
(:mod:`synthesis.kinds.function.nine_pairs.continuation`); a search by descents might miss it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.fit.linkage.descent import Fit
from synthesis.fit.linkage.topology import FUNCTION_SIXBARS
from synthesis.kinds.function.nine_pairs.continuation import find_all_watts
from synthesis.kinds.function.nine_pairs.system import PAIR_COUNT
from synthesis.kinds.function.sixbar.fits import SixbarCandidate, evaluate_errors


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
        one = make_sixbar(vectors, (k, l_), pairs[0], float(nine[0, 0]), float(nine[1, 0]))
        evaluated = evaluate_errors(one, *pairs)
        # Others cannot be assembled at some pair in the assembly of the first.
        if evaluated is not None:
            found.append(replace(one, error=float(np.sqrt(np.mean(evaluated[1] ** 2)))))
    return NinePairSixbars(sorted(found, key=lambda one: one.error), watts.complete)


def make_sixbar(
    vectors: Complex, scales: tuple[float, float], inputs: Real, first_input: float, first_output: float
) -> SixbarCandidate:
    """Convert a real solution, vectors a, c, d, e of shape (4,), to a candidate.

    ``scales`` are k and l, ``inputs`` (m,) those of the pairs, ``first_input`` and ``first_output`` the values of the
    pair at which the vectors stand.
    """
    a, c, d, e = (complex(z) for z in vectors)
    # The second fourbar, with ground 1 as the first, continues the ground line.
    joints = np.array([0.0, a, 1.0, 1.0 + c, 1.0 + d, 2.0, 2.0 + e])
    # Turned so that the output is at its value.
    joints *= np.exp(1j * (scales[1] * first_output - math.atan2(e.imag, e.real)))
    x = np.column_stack([joints.real, joints.imag]).ravel()
    fit = Fit(FUNCTION_SIXBARS["watt_2"], x, scales[0] * (inputs - first_input))
    return SixbarCandidate("watt_2", fit, inputs, first_input, scales, 0.0)
