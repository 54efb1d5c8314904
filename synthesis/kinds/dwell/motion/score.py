"""Score outputs of a dwell sixbar: each is driven through the turn on a grid, in compiled loops.

A rocker has the numbers R = P D, O6 (x, y), O6 D; a slider R, the line's distance from O2 to its left and its angle; a
slotted link O6 (x, y). Directions are handled as unit vectors and as half tangents, so that no arctangent is computed
for the many outputs that are discarded.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from synthesis.kinds.dwell.motion.outputs import MIN_SLOT_DISTANCE

ROCKER_CODE, SLIDER_CODE, SLOT_CODE = range(3)
"""Codes of the kinds of output in the loops."""


@njit(cache=True, nogil=True, error_model="numpy")
def score_outputs(
    kind: int,
    curves: Complex,
    rows: Integers,
    first: Integers,
    second: Integers,
    numbers: Real,
    length: int,
    dwells: int,
    way: float,
    least: float,
    scores: Real,
    signs: Integers,
    ends: Integers,
) -> None:
    """Drive every output through the turn and score its movement during the dwells and its shortcomings."""
    n = curves.shape[1]
    out, ux, uy = np.empty(n), np.empty(n), np.empty(n)
    for k in range(len(rows)):
        curve = curves[rows[k]]
        scores[k], signs[k] = np.inf, 1
        a, b, c, d = numbers[k]
        if kind == ROCKER_CODE:
            signs[k] = _select_rocker_sign(curve, first[k], length, a, complex(b, c), d)
            sine = drive_rocker(curve, a, b, c, d, signs[k], ux, uy)
        elif kind == SLIDER_CODE:
            signs[k] = _select_slider_sign(curve, first[k], length, a, b, c)
            sine = drive_slider(curve, a, b, c, signs[k], out)
        else:
            sine = drive_slot(curve, a, b, ux, uy)
        if not sine > 0.0:
            continue
        if kind != SLIDER_CODE:
            compute_half_tangents(ux, uy, out)
        low, high = convert_output(kind, out.min()), convert_output(kind, out.max())
        span = high - low
        if not span > 0.0:
            continue
        rest, ending = 0.0, 0.0
        for dwell in range(dwells):
            begin = first[k] if dwell == 0 else second[k]
            least_out, most_out, mean = np.inf, -np.inf, 0.0
            for m in range(length):
                # The grid is periodic, and a dwell may cross its seam.
                value = out[(begin + m) % n]
                least_out, most_out = min(least_out, value), max(most_out, value)
                mean += convert_output(kind, value) / length
            rest = max(rest, (convert_output(kind, most_out) - convert_output(kind, least_out)) / span)
            ends[k, dwell] = 1 if high - mean < mean - low else -1
            ending = max(ending, min(high - mean, mean - low) / span)
        # Both dwells at one end leave the other end without a rest.
        if dwells == 2 and ends[k, 0] == ends[k, 1]:
            continue
        scores[k] = add_shortcomings(rest + 0.5 * ending, kind, curve, span, way, least, sine)


@njit(cache=True, nogil=True, error_model="numpy")
def add_shortcomings(
    score: float, kind: int, curve: Complex, span: float, way: float, least: float, sine: float
) -> float:
    """Add the shortcomings of transmission and range to a score.

    For a slider, whose stroke is free, a curve that is large compared with the stroke counts instead of the range.

    ``span`` is the output's range, ``way`` the required one, ``least`` and ``sine`` are sines of transmission angles.
    """
    # A start should exceed the required transmission angle, because refinement trades some of it for stillness.
    score += 0.5 * max(0.0, 1.5 * least - sine)
    if kind != SLIDER_CODE:
        return score + 0.3 * abs(math.log(span / way))
    extent = 0.0
    for z in curve:
        extent = max(extent, abs(z - curve[0]))
    # A slider's linkage is scaled to the stroke: a small stroke makes it large.
    return score + 0.05 * max(0.0, math.log(2.0 * extent / span))


@njit(cache=True, nogil=True, error_model="numpy")
def drive_rocker(
    curve: Complex, link: float, x: float, y: float, rocker: float, sign: int, ux: Real, uy: Real
) -> float:
    """Compute a rocker's direction at every sample; return its minimum transmission sine, 0 if P is out of reach."""
    nearest, farthest = np.inf, 0.0
    for m in range(len(curve)):
        dx, dy = curve[m].real - x, curve[m].imag - y
        square = dx * dx + dy * dy
        nearest, farthest = min(nearest, square), max(farthest, square)
        # Triangle P D O6 must close at every sample.
        if not (rocker - link) ** 2 < square < (rocker + link) ** 2:
            return 0.0
        r = math.sqrt(square)
        cosine = (rocker * rocker + square - link * link) / (2.0 * rocker * r)
        leaning = sign * math.sqrt(max(1.0 - cosine * cosine, 0.0))
        ux[m], uy[m] = (dx * cosine - dy * leaning) / r, (dx * leaning + dy * cosine) / r
    # The angle at D is extreme where P is nearest to and farthest from O6.
    ends = rocker * rocker + link * link - nearest, rocker * rocker + link * link - farthest
    pin = max(abs(ends[0]), abs(ends[1])) / (2.0 * rocker * link)
    return math.sqrt(max(1.0 - pin * pin, 0.0))


@njit(cache=True, nogil=True, error_model="numpy")
def drive_slider(curve: Complex, link: float, offset: float, angle: float, sign: int, out: Real) -> float:
    """Compute a slider's position at every sample; return its minimum transmission sine, 0 if P is out of reach."""
    along_x, along_y = math.cos(angle), math.sin(angle)
    least = 1.0
    for m in range(len(curve)):
        across = (curve[m].imag * along_x - curve[m].real * along_y - offset) / link
        square = 1.0 - across * across
        if not square > 0.0:
            return 0.0
        sine = math.sqrt(square)
        least = min(least, sine)
        out[m] = curve[m].real * along_x + curve[m].imag * along_y + sign * link * sine
    return least


@njit(cache=True, nogil=True, error_model="numpy")
def drive_slot(curve: Complex, x: float, y: float, ux: Real, uy: Real) -> float:
    """Compute a slotted link's direction at every sample; return 1, or 0 if P comes too close to its pivot."""
    for m in range(len(curve)):
        dx, dy = curve[m].real - x, curve[m].imag - y
        r = math.sqrt(dx * dx + dy * dy)
        if not r >= MIN_SLOT_DISTANCE:
            return 0.0
        ux[m], uy[m] = dx / r, dy / r
    return 1.0


@njit(cache=True, nogil=True, error_model="numpy")
def compute_half_tangents(ux: Real, uy: Real, out: Real) -> None:
    """Compute the tangents of half the angles from the mean direction, which increase with the angles."""
    x, y = ux.sum(), uy.sum()
    size = math.sqrt(x * x + y * y)
    for m in range(len(ux)):
        out[m] = (uy[m] * x - ux[m] * y) / (size + ux[m] * x + uy[m] * y)


@njit(cache=True, nogil=True, error_model="numpy")
def convert_output(kind: int, value: float) -> float:
    """Return the output for a value of ``out``: the angle of its half tangent, or a slider's place."""
    return value if kind == SLIDER_CODE else 2.0 * math.atan(value)


@njit(cache=True, nogil=True, error_model="numpy")
def _select_slider_sign(curve: Complex, begin: int, length: int, link: float, offset: float, angle: float) -> int:
    """Return the assembly in which a slider moves least while P passes a piece."""
    along_x, along_y = math.cos(angle), math.sin(angle)
    n = len(curve)
    best, chosen = np.inf, 1
    for sign in (1, -1):
        low, high = np.inf, -np.inf
        for m in range(length):
            z = curve[(begin + m) % n]
            across = z.imag * along_x - z.real * along_y - offset
            along = z.real * along_x + z.imag * along_y
            value = along + sign * math.sqrt(max(link * link - across * across, 0.0))
            low, high = min(low, value), max(high, value)
        if high - low < best:
            best, chosen = high - low, sign
    return chosen


@njit(cache=True, nogil=True, error_model="numpy")
def _select_rocker_sign(curve: Complex, begin: int, length: int, link: float, pivot: complex, rocker: float) -> int:
    """Return the assembly in which a rocker's pin moves least while P passes a piece."""
    n = len(curve)
    best, chosen = np.inf, 1
    for sign in (1, -1):
        farthest, origin = 0.0, 0j
        for m in range(length):
            arm = curve[(begin + m) % n] - pivot
            r = abs(arm)
            cosine = (rocker * rocker + r * r - link * link) / (2.0 * rocker * r)
            cosine = min(max(cosine, -1.0), 1.0)
            pin = arm / r * complex(cosine, sign * math.sqrt(1.0 - cosine * cosine))
            if m == 0:
                origin = pin
            farthest = max(farthest, abs(pin - origin))
        if farthest < best:
            best, chosen = farthest, sign
    return chosen
