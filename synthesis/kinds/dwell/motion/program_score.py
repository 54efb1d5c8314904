"""Score outputs for a program of dwells, each of its own length and at its own place in the output's range.

Every output is driven through the turn on a grid. For each dwell the section of the turn is searched in which the
output moves least near the dwell's place; the times of the dwells within the turn are free.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.dwell.motion.score import (
    ROCKER_CODE,
    SLIDER_CODE,
    add_shortcomings,
    compute_half_tangents,
    convert_output,
    drive_rocker,
    drive_slider,
    drive_slot,
)

MAX_LOG_RANGE_ERROR = 1.0
"""Maximum absolute logarithm of the output's range over the required one; refinement does not correct larger errors."""


@njit(cache=True, nogil=True, error_model="numpy")
def score_program(
    kind: int,
    curves: Complex,
    rows: Integers,
    numbers: Real,
    lengths: Integers,
    places: Real,
    way: float,
    least: float,
    scores: Real,
    signs: Integers,
    begins: Integers,
    ends: Real,
) -> None:
    """Drive every output through the turn in both assemblies and score the better: range, rests, and shortcomings.

    Parameters
    ----------
    kind : int
        ``ROCKER_CODE``, ``SLIDER_CODE`` or ``SLOT_CODE``.
    curves : complex, shape (m, N)
        Places of P.
    rows : int, shape (n,)
        The curve of each output.
    numbers : float, shape (n, 4)
        Its dimensions, in the order of :mod:`synthesis.kinds.dwell.motion.score`.
    lengths, places : int and float, shape (k,)
        Number of samples of each dwell, and its share of the range from the minimum output; NaN for either end.
    way, least : float
        The required range, radians, or NaN for a slider, and the minimum sine of a transmission angle.
    scores, signs : float and int, shape (n,)
        Filled: the score, infinite for unsuitable outputs, and the assembly.
    begins, ends : int and float, shape (n, k)
        Filled: first sample of each dwell, and its share of the range.
    """
    n, dwells = curves.shape[1], len(lengths)
    out, ux, uy = np.empty(n), np.empty(n), np.empty(n)
    at, share = np.empty(dwells, np.int64), np.empty(dwells)
    for k in range(len(rows)):
        curve = curves[rows[k]]
        scores[k], signs[k] = np.inf, 1
        a, b, c, d = numbers[k]
        for sign in (1, -1):
            if kind == ROCKER_CODE:
                sine = drive_rocker(curve, a, b, c, d, sign, ux, uy)
            elif kind == SLIDER_CODE:
                sine = drive_slider(curve, a, b, c, sign, out)
            elif sign == 1:
                sine = drive_slot(curve, a, b, ux, uy)
            else:
                break
            # Out of reach in one assembly means out of reach in both.
            if not sine > 0.0:
                break
            if kind != SLIDER_CODE:
                compute_half_tangents(ux, uy, out)
            low, high = convert_output(kind, out.min()), convert_output(kind, out.max())
            span = high - low
            if not span > 0.0 or (kind != SLIDER_CODE and not abs(math.log(span / way)) < MAX_LOG_RANGE_ERROR):
                continue
            if kind != SLIDER_CODE:
                for m in range(n):
                    out[m] = convert_output(kind, out[m])
            score = add_shortcomings(0.0, kind, curve, span, way, least, sine)
            # Each dwell may lie anywhere in the turn, so that all places of the grid are tried.
            score += locate_rests(out, low, span, lengths, places, at, share)
            if score < scores[k]:
                scores[k], signs[k] = score, sign
                begins[k], ends[k] = at, share


@njit(cache=True, nogil=True, error_model="numpy")
def locate_rests(
    out: Real, low: float, span: float, lengths: Integers, places: Real, at: Integers, share: Real
) -> float:
    """Find for each dwell the section of minimum movement near its place; return the worst score of all dwells.

    ``at`` and ``share`` receive the first sample and the place of each section.
    """
    n, worst = len(out), 0.0
    for dwell in range(len(lengths)):
        best = np.inf
        for begin in range(n):
            least, most, total = np.inf, -np.inf, 0.0
            for m in range(lengths[dwell]):
                value = out[(begin + m) % n]
                least, most = min(least, value), max(most, value)
                total += value
                # This section is already worse than the best one.
                if most - least > best * span:
                    break
            rest = (most - least) / span
            if rest > best:
                continue
            mean = (total / lengths[dwell] - low) / span
            place = places[dwell]
            if math.isnan(place):
                place = 1.0 if mean > 0.5 else 0.0
            rest += 0.5 * abs(mean - place)
            if rest < best:
                best, at[dwell], share[dwell] = rest, begin, place
        worst = max(worst, best)
    return worst
