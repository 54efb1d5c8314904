"""Compiled motion of variants of one linkage: each driven to its targets, and held to its branch.

*Nearest.* At an input near the nominal one the misses are e + v τ (distance) and ε + ω τ (angle), measured in their
units: two parabolas in τ, of which the sum or the greater is least at a τ in closed form (:func:`step_to_least`).
Steps are taken until they are small, and halved where they do not lessen what they should: Gauss and Newton's method
in one unknown. The crank is turned by (1 + i τ/2)/(1 − i τ/2), which takes no trigonometry.

Arguments of both kernels: ``variants`` (V, n) and ``targets`` (T, 7) as of :mod:`loops`; ``nominal`` (T,), the nominal
inputs; ``settings`` (V, 2), or (0, 2) for none: how much farther on a variant's input starts, and how much less angle
or travel is demanded of it.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.compiling import njit
from kinematics.linkage.kernels import OPTIONS, Real, direction
from kinematics.linkage.variation.loops import OUTPUTS, Drive, closed, misses, on_branch, sound

STEPS = 40
"""Of Gauss and Newton's method, halvings counted; two or three do, except beside toggles."""

LONGEST = 0.25
"""Radians that one step turns the crank by at most."""

SMALL = 1e-5
"""Radians: a step below this is taken along the tangent, and the last; what it misses is some 1e-10 of the crank."""

SETTLED = 1e-12
"""Share by which a step is to lessen what it should, at least: rounding."""

REACH = 0.4
"""Radians: a variant that cannot be assembled at the nominal input is looked for so far to either side."""

FIRST_REACH = 1e-6
"""Radians at which it is looked for first; each further look is twice as far."""


@njit(**OPTIONS)
def step_to_least(greatest: bool, a1: float, b1: float, c1: float, a2: float, b2: float, c2: float) -> float:
    """Where the sum of a1 τ² + 2 b1 τ + c1 and a2 τ² + 2 b2 τ + c2, or the greater of both, is least.

    Both are squares, so that neither is below zero. The greater is least at the least of one of them, where that one
    is the greater, or else where they cross between their least places.
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
    q = -(b + math.copysign(math.sqrt(max(b * b - a * c, 0.0)), b))
    low, high = min(first, second), max(first, second)
    root = c / q if q != 0.0 else 0.0
    if a != 0.0 and not (low <= root <= high):
        root = q / a
    return min(max(root, low), high)


@njit(**OPTIONS)
def _startable(drive: Drive, row: Real, target: Real) -> tuple[bool, float, float]:
    """The input nearest to the nominal one at which a variant can be assembled: whether there is one, cosine, sine."""
    reach = FIRST_REACH
    while reach < REACH:
        for turn in (reach, -reach):
            c, s = math.cos(turn), math.sin(turn)
            cosine, sine = target[0] * c - target[1] * s, target[1] * c + target[0] * s
            if closed(drive, row, target[6], cosine, sine)[0]:
                return True, cosine, sine
        reach *= 2.0
    return False, target[0], target[1]


@njit(**OPTIONS)
def _nearest(drive: Drive, row: Real, target: Real) -> tuple[bool, float, float, float, float]:
    """Whether a variant can be assembled at a target, its deviations there, and how far its input has turned."""
    cosine, sine = target[0], target[1]
    valid, x, y, off, vx, vy, w = misses(drive, row, target, cosine, sine)
    if not drive.adjusted or drive.sort == OUTPUTS:
        return valid, x, y, off, 0.0
    if not valid:
        valid, cosine, sine = _startable(drive, row, target)
        if not valid:
            return False, x, y, off, 0.0
        valid, x, y, off, vx, vy, w = misses(drive, row, target, cosine, sine)
    lengths, angles = drive.per_length * drive.per_length, drive.per_angle * drive.per_angle
    c1, c2 = (x * x + y * y) * lengths, off * off * angles
    missed = max(c1, c2) if drive.greatest else c1 + c2
    step, fresh, last = 0.0, True, 0.0
    for _ in range(STEPS):
        if fresh:
            a1, b1 = (vx * vx + vy * vy) * lengths, (x * vx + y * vy) * lengths
            step = step_to_least(drive.greatest, a1, b1, c1, w * w * angles, off * w * angles, c2)
            step = min(max(step, -LONGEST), LONGEST)
            if not math.isfinite(step):
                break
        if abs(step) < SMALL:
            last = step if fresh else 0.0
            break
        t = 0.5 * step
        scale = 1.0 / (1.0 + t * t)
        c, s = (1.0 - t * t) * scale, 2.0 * t * scale
        next_cosine, next_sine = cosine * c - sine * s, sine * c + cosine * s
        ok, x1, y1, off1, vx1, vy1, w1 = misses(drive, row, target, next_cosine, next_sine)
        d1, d2 = (x1 * x1 + y1 * y1) * lengths, off1 * off1 * angles
        instead = max(d1, d2) if drive.greatest else d1 + d2
        fresh = ok and instead <= missed * (1.0 + SETTLED)
        if fresh:
            cosine, sine, missed = next_cosine, next_sine, instead
            x, y, off, vx, vy, w, c1, c2 = x1, y1, off1, vx1, vy1, w1, d1, d2
        else:
            step *= 0.5
    turned = direction(cosine * target[0] + sine * target[1], sine * target[0] - cosine * target[1])
    return True, x + vx * last, y + vy * last, off + w * last, turned + last


@njit(**OPTIONS)
def _set(drive: Drive, targets: Real, settings: Real, table: Real) -> None:
    """The targets of one variant with its settings into ``table``."""
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
def deviations(
    drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, offsets: Real, inputs: Real
) -> None:
    """Deviations (x, y, angle) into ``offsets`` (V, T, 3), inputs into ``inputs`` (V, T).

    NaN where a variant cannot be assembled, all over where it leaves its branch.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _set(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, whole = np.inf, -np.inf, True
        standing = 1.0 if sound(drive, row) else np.nan
        for k in range(len(targets)):
            valid, x, y, off, turned = _nearest(drive, row, table[k])
            at, known = nominal[k] + start + turned, standing if valid else np.nan
            low, high, whole = min(low, at), max(high, at), whole and valid
            offsets[i, k, 0], offsets[i, k, 1], offsets[i, k, 2] = x * known, y * known, off * known
            inputs[i, k] = at * known
        if whole and not on_branch(drive, row, low, high):
            offsets[i] = np.nan
            inputs[i] = np.nan


@njit(**OPTIONS)
def shares(drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, share: Real) -> None:
    """The greatest share of a unit that a variant takes at a target into ``share`` (V,); infinite where it is none.

    A variant that takes more than 1 at one target is not driven to the others.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _set(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, most = np.inf, -np.inf, 0.0 if sound(drive, row) else np.inf
        for k in range(len(targets)):
            if not most <= 1.0:
                break
            valid, x, y, off, turned = _nearest(drive, row, table[k])
            at = nominal[k] + start + turned
            low, high = min(low, at), max(high, at)
            taken = max(math.sqrt(x * x + y * y) * drive.per_length, abs(off) * drive.per_angle)
            most = max(most, taken) if valid else np.inf
        if most <= 1.0 and not on_branch(drive, row, low, high):
            most = np.inf
        share[i] = most


@njit(**OPTIONS)
def squares(
    drive: Drive, variants: Real, targets: Real, nominal: Real, settings: Real, most: float, square: Real
) -> None:
    """The sum of the squares of the misses of each variant, in their units, into ``square`` (V,).

    Infinite where a variant cannot be assembled, leaves its branch, or has more than ``most``.
    """
    table = targets.copy()
    for i in range(len(variants)):
        row, start = variants[i], 0.0
        if len(settings):
            _set(drive, targets, settings[i], table)
            start = settings[i, 0]
        low, high, taken = np.inf, -np.inf, 0.0 if sound(drive, row) else np.inf
        for k in range(len(targets)):
            if not taken <= most:
                break
            valid, x, y, off, turned = _nearest(drive, row, table[k])
            at = nominal[k] + start + turned
            low, high = min(low, at), max(high, at)
            distance, angle = math.sqrt(x * x + y * y) * drive.per_length, off * drive.per_angle
            taken = taken + distance * distance + angle * angle if valid else np.inf
        square[i] = taken if taken <= most and on_branch(drive, row, low, high) else np.inf
