"""Compiled motion of variants of one linkage: each driven to its targets, and checked to stay on its branch.

*Closest input.* Near the nominal input the deviations are e + v τ (distance) and ε + ω τ (angle), in their units. Their
squares are two parabolas in τ, whose sum or maximum is minimal at a τ in closed form (:func:`find_minimizing_step`).
Steps are taken until they are small, and halved if the objective does not decrease: the Gauss-Newton method in one
unknown. The crank is rotated by (1 + i τ/2)/(1 − i τ/2), which needs no trigonometric functions.

Arguments of the kernels: ``variants`` (V, n) and ``targets`` (T, 7) as in :mod:`loops`; ``nominal`` (T,), the nominal
inputs; ``settings`` (V, 2), or (0, 2) for none: offset of a variant's input, and reduction of its target angle or
travel.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from kinematics.compiling import njit
from kinematics.linkage.kernels import OPTIONS, compute_direction
from kinematics.linkage.variation.loops import OUTPUTS, Drive, close_loop, is_on_branch, is_sound, measure_misses

MAX_STEPS = 40
"""Maximum number of Gauss-Newton steps, halvings included; two or three suffice, except near toggles."""

MAX_STEP_ANGLE = 0.25
"""Maximum rotation of the crank in one step, radians."""

MIN_STEP_ANGLE = 1e-5
"""Step, radians, below which it is taken along the tangent as the last one; the error is about 1e-10 of the crank."""

DESCENT_TOLERANCE = 1e-12
"""Relative increase of the objective that a step may cause: rounding."""

SEARCH_REACH = 0.4
"""Range, radians, on either side of the nominal input in which a position of a variant is searched."""

INITIAL_REACH = 1e-6
"""Initial distance of that search, radians; it doubles each time."""


@njit(**OPTIONS)
def find_minimizing_step(greatest: bool, a1: float, b1: float, c1: float, a2: float, b2: float, c2: float) -> float:
    """Find τ that minimizes the sum, or the maximum, of a1 τ² + 2 b1 τ + c1 and a2 τ² + 2 b2 τ + c2.

    Both are squares and therefore nonnegative. The maximum is minimal at the vertex of one parabola if that parabola is
    the larger there, otherwise where both cross between their vertices.
    """
    if a1 + a2 == 0.0:
        return 0.0
    if not greatest or a1 == 0.0 or a2 == 0.0:
        return -(b1 + b2) / (a1 + a2)
    first, second = -b1 / a1, -b2 / a2
    if c1 + first * b1 >= c2 + first * (2.0 * b2 + a2 * first):
        return first
    if c2 + second * b2 >= c1 + second * (2.0 * b1 + a1 * second):
        return second
    a, b, c = a1 - a2, b1 - b2, c1 - c2
    # Roots of the difference without cancellation; the one between the vertices is the solution.
    q = -(b + math.copysign(math.sqrt(max(b * b - a * c, 0.0)), b))
    low, high = min(first, second), max(first, second)
    root = c / q if q != 0.0 else 0.0
    if a != 0.0 and not (low <= root <= high):
        root = q / a
    return min(max(root, low), high)


@njit(**OPTIONS)
def _find_start(drive: Drive, row: Real, target: Real) -> tuple[bool, float, float]:
    """Find the input nearest to the nominal one at which a variant can be assembled: success, cosine, sine."""
    reach = INITIAL_REACH
    while reach < SEARCH_REACH:
        for turn in (reach, -reach):
            c, s = math.cos(turn), math.sin(turn)
            cosine, sine = target[0] * c - target[1] * s, target[1] * c + target[0] * s
            if close_loop(drive, row, target[6], cosine, sine)[0]:
                return True, cosine, sine
        reach *= 2.0
    return False, target[0], target[1]


@njit(**OPTIONS)
def _find_nearest(drive: Drive, row: Real, target: Real) -> tuple[bool, float, float, float, float]:
    """Return whether a variant can be assembled at a target, its deviations there, and the adjustment of its input."""
    cosine, sine = target[0], target[1]
    valid, x, y, off, vx, vy, w = measure_misses(drive, row, target, cosine, sine)
    if not drive.adjusted or drive.sort == OUTPUTS:
        return valid, x, y, off, 0.0
    if not valid:
        valid, cosine, sine = _find_start(drive, row, target)
        if not valid:
            return False, x, y, off, 0.0
        valid, x, y, off, vx, vy, w = measure_misses(drive, row, target, cosine, sine)
    lengths, angles = drive.per_length * drive.per_length, drive.per_angle * drive.per_angle
    c1, c2 = (x * x + y * y) * lengths, off * off * angles
    missed = max(c1, c2) if drive.greatest else c1 + c2
    step, fresh, last = 0.0, True, 0.0
    for _ in range(MAX_STEPS):
        if fresh:
            a1, b1 = (vx * vx + vy * vy) * lengths, (x * vx + y * vy) * lengths
            step = find_minimizing_step(drive.greatest, a1, b1, c1, w * w * angles, off * w * angles, c2)
            step = min(max(step, -MAX_STEP_ANGLE), MAX_STEP_ANGLE)
            if not math.isfinite(step):
                break
        # A tiny step is applied to first order, which saves an evaluation.
        if abs(step) < MIN_STEP_ANGLE:
            last = step if fresh else 0.0
            break
        t = 0.5 * step
        scale = 1.0 / (1.0 + t * t)
        c, s = (1.0 - t * t) * scale, 2.0 * t * scale
        next_cosine, next_sine = cosine * c - sine * s, sine * c + cosine * s
        ok, x1, y1, off1, vx1, vy1, w1 = measure_misses(drive, row, target, next_cosine, next_sine)
        d1, d2 = (x1 * x1 + y1 * y1) * lengths, off1 * off1 * angles
        instead = max(d1, d2) if drive.greatest else d1 + d2
        fresh = ok and instead <= missed * (1.0 + DESCENT_TOLERANCE)
        if fresh:
            cosine, sine, missed = next_cosine, next_sine, instead
            x, y, off, vx, vy, w, c1, c2 = x1, y1, off1, vx1, vy1, w1, d1, d2
        else:
            step *= 0.5
    turned = compute_direction(cosine * target[0] + sine * target[1], sine * target[0] - cosine * target[1])
    return True, x + vx * last, y + vy * last, off + w * last, turned + last


@njit(**OPTIONS)
def _apply_settings(drive: Drive, targets: Real, settings: Real, table: Real) -> None:
    """Write the targets of one variant with its settings into ``table``."""
    c, s = math.cos(settings[0]), math.sin(settings[0])
    d, e = math.cos(settings[1]), -math.sin(settings[1])
    for k in range(len(targets)):
        row, given = table[k], targets[k]
        row[:] = given
        row[0], row[1] = given[0] * c - given[1] * s, given[1] * c + given[0] * s
        row[4], row[5] = given[4] * d - given[5] * e, given[5] * d + given[4] * e
        if drive.sort == OUTPUTS:
            row[2] = given[2] - settings[1]


@njit(**OPTIONS)
def measure_deviations(
    drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, offsets: Real, inputs: Real
) -> None:
    """Fill deviations (x, y, angle) into ``offsets`` (V, T, 3), inputs into ``inputs`` (V, T).

    NaN where a variant cannot be assembled, all NaN if it leaves its branch.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _apply_settings(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, whole = np.inf, -np.inf, True
        # A nonpositive length makes the whole variant invalid.
        standing = 1.0 if is_sound(drive, row) else np.nan
        for k in range(len(targets)):
            valid, x, y, off, turned = _find_nearest(drive, row, table[k])
            at, known = nominal[k] + start + turned, standing if valid else np.nan
            low, high, whole = min(low, at), max(high, at), whole and valid
            offsets[i, k, 0], offsets[i, k, 1], offsets[i, k, 2] = x * known, y * known, off * known
            inputs[i, k] = at * known
        if whole and not is_on_branch(drive, row, low, high):
            offsets[i] = np.nan
            inputs[i] = np.nan


@njit(**OPTIONS)
def measure_shares(drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, share: Real) -> None:
    """Fill into ``share`` (V,) the largest share of a unit that each variant uses at any target; infinite if invalid.

    A variant that exceeds 1 at one target is not driven to the others.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _apply_settings(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, most = np.inf, -np.inf, 0.0 if is_sound(drive, row) else np.inf
        for k in range(len(targets)):
            if not most <= 1.0:
                break
            valid, x, y, off, turned = _find_nearest(drive, row, table[k])
            at = nominal[k] + start + turned
            low, high = min(low, at), max(high, at)
            taken = max(math.sqrt(x * x + y * y) * drive.per_length, abs(off) * drive.per_angle)
            most = max(most, taken) if valid else np.inf
        if most <= 1.0 and not is_on_branch(drive, row, low, high):
            most = np.inf
        share[i] = most


@njit(**OPTIONS)
def measure_squares(
    drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, most: float, square: Real
) -> None:
    """Fill the sum of squared misses of each variant, in their units, into ``square`` (V,).

    Infinite if a variant cannot be assembled, leaves its branch, or exceeds ``most``.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _apply_settings(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, taken = np.inf, -np.inf, 0.0 if is_sound(drive, row) else np.inf
        for k in range(len(targets)):
            if not taken <= most:
                break
            valid, x, y, off, turned = _find_nearest(drive, row, table[k])
            at = nominal[k] + start + turned
            low, high = min(low, at), max(high, at)
            distance, angle = math.sqrt(x * x + y * y) * drive.per_length, off * drive.per_angle
            taken = taken + distance * distance + angle * angle if valid else np.inf
        square[i] = taken if taken <= most and is_on_branch(drive, row, low, high) else np.inf
