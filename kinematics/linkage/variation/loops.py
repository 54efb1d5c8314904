"""The loop of a fourbar or a slider-crank of any dimensions, compiled: closure, misses, branch check.

Both are treated as one loop: a crank k = a e^{iθ} from O2, a coupler u = B − A, and a *guide* of the pin B: the
output's circle about O4, or the slide. With a normal n of the guide at B (B − O4, or the slide's own),

    n · (i ω2 k + i ω3 u) = 0,        ω3 / ω2 = − n·ik / n·iu,        v / ω2 = i k + i (ω3/ω2) (P − A),

so that only the closure distinguishes both. A row of dimensions is O2 (x, y), O4 (x, y), a, b, c, P (along A →
B, across it) of a fourbar; O2 (x, y), offset, a, b, P (along, across) of a slider-crank; P is omitted for tasks without
a coupler point. A row of a target is cos θ, sin θ, P (x, y) or the travel, cos, sin of the angle, and the assembly
sign.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from kinematics.arrays import Real
from kinematics.compiling import njit
from kinematics.linkage.kernels import OPTIONS, TOGGLE_SLACK, compute_direction

POSES, POINTS, OUTPUTS = 0, 1, 2
"""Kinds of targets: poses of the coupler's body, positions of P, or positions of the output."""


class Drive(NamedTuple):
    """Settings for driving variants.

    Attributes
    ----------
    sort : int
        Kind of the targets.
    slides : bool
        Whether the linkage is a slider-crank.
    ex, ey : float
        Direction of the slide of a slider-crank.
    adjusted, greatest : bool
        Whether the input is adjusted at each target, and whether the larger miss is minimized instead of the sum of
        squares.
    per_length, per_angle : float
        Inverses of the units of distance and angle.
    before, after : float
        Extension of the motion beyond the smallest and largest input; NaN without a range.
    """

    sort: int
    slides: bool
    ex: float
    ey: float
    adjusted: bool
    greatest: bool
    per_length: float
    per_angle: float
    before: float
    after: float


@njit(**OPTIONS)
def close_loop(
    drive: Drive, row: Real, sign: float, cosine: float, sine: float
) -> tuple[bool, float, float, float, float, float, float, float, float]:
    """Close the loop: return whether it closes; k, u = B − A and the guide's normal n at B; and the length b."""
    if drive.slides:
        ex, ey = drive.ex, drive.ey
        a, b = row[3], row[4]
        kx, ky = a * cosine, a * sine
        # Along and across the slide: A is k_y above the pivot's parallel to it, the slide ``offset`` below.
        across = -row[2] - (kx * -ey + ky * ex)
        square = (b - across) * (b + across)
        valid = square >= -2.0 * TOGGLE_SLACK * b * max(a, b, abs(row[2]))
        along = sign * math.sqrt(max(square, 0.0))
        return valid, kx, ky, ex * along - ey * across, ey * along + ex * across, -ey, ex, b, along
    a, b, c = row[4], row[5], row[6]
    kx, ky = a * cosine, a * sine
    dx, dy = row[2] - row[0] - kx, row[3] - row[1] - ky
    square = dx * dx + dy * dy
    f = math.sqrt(square)
    product = (b + c + f) * (b + c - f) * (f + (b - c)) * (f - (b - c))
    valid = (product >= -4.0 * TOGGLE_SLACK * b * c * square) & (f > 0.0)
    half = 0.5 / square
    along = (square + (b - c) * (b + c)) * half
    height = sign * math.sqrt(max(product, 0.0)) * half
    ux, uy = dx * along - dy * height, dy * along + dx * height
    return valid, kx, ky, ux, uy, ux - dx, uy - dy, b, 0.0


@njit(**OPTIONS)
def measure_misses(
    drive: Drive, row: Real, target: Real, cosine: float, sine: float
) -> tuple[bool, float, float, float, float, float, float]:
    """Return whether the loop closes; deviations x, y and angle from a target; and their rates by the input."""
    valid, kx, ky, ux, uy, nx, ny, b, _ = close_loop(drive, row, target[6], cosine, sine)
    turn = -(ny * kx - nx * ky) / (ny * ux - nx * uy)
    if drive.sort == OUTPUTS:
        if drive.slides:
            travel = (row[0] + kx + ux) * drive.ex + (row[1] + ky + uy) * drive.ey - target[2]
            return valid, travel, 0.0, 0.0, (-ky - turn * uy) * drive.ex + (kx + turn * ux) * drive.ey, 0.0, 0.0
        off = compute_direction(nx * target[4] + ny * target[5], ny * target[4] - nx * target[5])
        square = nx * nx + ny * ny
        return valid, 0.0, 0.0, off, 0.0, 0.0, (nx * (kx + turn * ux) + ny * (ky + turn * uy)) / square
    at = 5 if drive.slides else 7
    armx, army = row[at] / b, row[at + 1] / b
    px, py = armx * ux - army * uy, armx * uy + army * ux
    x, y = row[0] + kx + px - target[2], row[1] + ky + py - target[3]
    off = 0.0
    if drive.sort == POSES:
        off = compute_direction(ux * target[4] + uy * target[5], uy * target[4] - ux * target[5])
    return valid, x, y, off, -ky - turn * py, kx + turn * px, turn if drive.sort == POSES else 0.0


@njit(**OPTIONS)
def is_sound(drive: Drive, row: Real) -> bool:
    """Return whether all links have a positive length."""
    least = min(row[3], row[4]) if drive.slides else min(row[4], row[5], row[6])
    return bool(least > 0.0)


@njit(**OPTIONS)
def _is_between(low: float, high: float, place: float) -> bool:
    """Return whether a range of angles contains an angle modulo full turns."""
    return place + math.tau * math.ceil((low - place) / math.tau) <= high


@njit(**OPTIONS)
def is_on_branch(drive: Drive, row: Real, low: float, high: float) -> bool:
    """Return whether a variant turns over all its targets, and the margins beyond them, without a toggle.

    The distance of A from O4, or from the slide, is extreme with the crank along the ground or normal to the slide.
    """
    # No range was requested.
    if math.isnan(drive.before):
        return True
    ends = drive.before > 0.0 or drive.after > 0.0
    low, high = low - drive.before, high + drive.after
    if drive.slides:
        a, b = row[3], row[4]
        up, down = -row[2] - a, -row[2] + a
        far_up, far_down = abs(up) >= b, abs(down) >= b
        zero = math.atan2(drive.ey, drive.ex) + 0.5 * math.pi
        if not (far_up or far_down):
            return True
        if (far_up and _is_between(low, high, zero)) or (far_down and _is_between(low, high, zero + math.pi)):
            return False
        return not ends or max(abs(row[2] + a * math.cos(low - zero)), abs(row[2] + a * math.cos(high - zero))) < b
    a, b, c = row[4], row[5], row[6]
    gx, gy = row[2] - row[0], row[3] - row[1]
    d = math.sqrt(gx * gx + gy * gy)
    # Whether a folded and an extended toggle exist at all.
    near, far = abs(d - a) <= abs(b - c), d + a >= b + c
    if not (near or far):
        return True
    zero = compute_direction(gx, gy)
    if (near and _is_between(low, high, zero)) or (far and _is_between(low, high, zero + math.pi)):
        return False
    if not ends:
        return True
    least, most = (b - c) * (b - c), (b + c) * (b + c)
    first = a * a + d * d - 2.0 * a * d * math.cos(low - zero)
    second = a * a + d * d - 2.0 * a * d * math.cos(high - zero)
    return bool(least < min(first, second) and max(first, second) < most)
