"""Compiled sweeps of the fourbar over designs × input angles, by the formulas of :mod:`closed_form`.

``pivots`` are O2, O4 and the coupler point in its link's frame, ``lengths`` are a, b, c. With v = B − O4 the
derivatives of the loop reduce to products of the link vectors; Δ = v × u is the determinant of each order, and

    Δ ω3 = −ω2 v×k                Δ α3 = −α2 v×k − ω2² v·k − ω3² v·u + ω4² v·v
    Δ ω4 = −ω2 u×k                Δ α4 = −α2 u×k − ω2² u·k − ω3² u·u + ω4² u·v
    Δ φ3 = (ω2³ − φ2) v×k − 3 ω2 α2 v·k + ω3³ Δ − 3 ω3 α3 v·u + 3 ω4 α4 v·v
    Δ φ4 = (ω2³ − φ2) u×k − 3 ω2 α2 u·k + ω4³ Δ − 3 ω3 α3 u·u + 3 ω4 α4 u·v
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Mask, Real
from kinematics.compiling import njit
from kinematics.linkage.kernels import (
    OPTIONS,
    TILE_SIZE,
    TOGGLE_SINE,
    TOGGLE_SLACK,
    compute_direction,
    divide_by_length,
    fill_accelerations,
    fill_cosines,
    fill_jerks,
    fill_points,
    fill_velocities,
)


@njit(**OPTIONS)
def has_sound_dimensions(pivots: Complex, lengths: Real) -> bool:
    """Return whether all lengths including the ground's are positive and finite, and all points finite."""
    for i in range(pivots.shape[1]):
        ground = abs(pivots[1, i] - pivots[0, i])
        good = math.isfinite(ground) and ground > 0.0
        for row in range(3):
            good = good and math.isfinite(pivots[row, i].real) and math.isfinite(pivots[row, i].imag)
            good = good and math.isfinite(lengths[row, i]) and lengths[row, i] > 0.0
        if not good:
            return False
    return True


@njit(**OPTIONS)
def _close_loop(
    gx: float, gy: float, kx: float, ky: float, b: float, c: float, sign: float
) -> tuple[bool, float, float]:
    """Close the loop: return whether it closes, and the vector u = B − A (else NaN), from ground and crank vectors."""
    dx, dy = gx - kx, gy - ky
    square = dx * dx + dy * dy
    f = math.sqrt(square)
    product = (b + c + f) * (b + c - f) * (f + (b - c)) * (f - (b - c))
    # Non-short-circuit & keeps the loop free of branches.
    valid = (product >= -4.0 * TOGGLE_SLACK * b * c * square) & (f > 0.0)
    root = math.sqrt(product if product > 0.0 else 0.0)
    half = 0.5 / square
    along = (square + (b - c) * (b + c)) * half
    # NaN marks an open loop and spreads to everything that depends on it.
    height = (sign * root if valid else math.nan) * half
    return valid, dx * along - dy * height, dy * along + dx * height


@njit(**OPTIONS)
def _compute_rates(
    gx: float, gy: float, kx: float, ky: float, ux: float, uy: float, least: float, w2: float, a2: float
) -> tuple[bool, float, float, float, float, float]:
    """Compute whether Δ is large enough, 1/Δ (else NaN), and ω3, ω4, α3, α4."""
    vx, vy = (kx - gx) + ux, (ky - gy) + uy
    determinant = vx * uy - vy * ux
    sound = math.fabs(determinant) > least
    # A single division serves all orders of derivatives.
    inverse = (1.0 if sound else math.nan) / determinant
    w3 = -w2 * (vx * ky - vy * kx) * inverse
    w4 = -w2 * (ux * ky - uy * kx) * inverse
    # Second derivative of the loop without the terms in α3 and α4.
    x = -a2 * ky - w2 * w2 * kx - w3 * w3 * ux + w4 * w4 * vx
    y = a2 * kx - w2 * w2 * ky - w3 * w3 * uy + w4 * w4 * vy
    return sound, inverse, w3, w4, (vx * x + vy * y) * inverse, (ux * x + uy * y) * inverse


@njit(**OPTIONS)
def _compute_jerks(
    gx: float,
    gy: float,
    kx: float,
    ky: float,
    ux: float,
    uy: float,
    inverse: float,
    w2: float,
    a2: float,
    j2: float,
    w3: float,
    a3: float,
    w4: float,
    a4: float,
) -> tuple[float, float]:
    """Compute φ3 and φ4."""
    vx, vy = (kx - gx) + ux, (ky - gy) + uy
    n2, t2, n3, n4 = 3.0 * w2 * a2, j2 - w2 * w2 * w2, 3.0 * w3 * a3, 3.0 * w4 * a4
    x = -n2 * kx - t2 * ky - n3 * ux + n4 * vx
    y = t2 * kx - n2 * ky - n3 * uy + n4 * vy
    return w3 * w3 * w3 + (vx * x + vy * y) * inverse, w4 * w4 * w4 + (ux * x + uy * y) * inverse


@njit(**OPTIONS)
def coupler_points(pivots: Complex, lengths: Real, sign: Real, theta: Real, point: Complex, valid: Mask) -> None:
    """Fill P into ``point``, and ``valid``, shape (D, N)."""
    designs, n = valid.shape
    cosine, sine = np.empty(n), np.empty(n)
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        o2, ground = pivots[0, j], pivots[1, j] - pivots[0, j]
        a, b, c = lengths[0, j], lengths[1, j], lengths[2, j]
        p, s = divide_by_length(pivots[2, j], b), sign[i if len(sign) > 1 else 0]
        point_i, valid_i = point[i], valid[i]
        for k in range(n):
            kx, ky = a * cosine[k], a * sine[k]
            good, ux, uy = _close_loop(ground.real, ground.imag, kx, ky, b, c, s)
            x = o2.real + kx + (p.real * ux - p.imag * uy)
            y = o2.imag + ky + (p.real * uy + p.imag * ux)
            point_i[k] = complex(x, y)
            valid_i[k] = good


@njit(**OPTIONS)
def whole_positions(
    pivots: Complex, lengths: Real, sign: Real, theta: Real, points: Complex, angles: Real, valid: Mask
) -> None:
    """Fill A, B, P into ``points`` (3, D, N), coupler and output angles into ``angles`` (2, D, N), ``valid`` (D, N)."""
    designs, n = valid.shape
    cosine, sine, work = np.empty(n), np.empty(n), np.empty((4, TILE_SIZE))
    ax, ay, ux, uy = work[0], work[1], work[2], work[3]
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        o2, ground = pivots[0, j], pivots[1, j] - pivots[0, j]
        a, b, c = lengths[0, j], lengths[1, j], lengths[2, j]
        s = sign[i if len(sign) > 1 else 0]
        for start in range(0, n, TILE_SIZE):
            end = min(start + TILE_SIZE, n)
            cos, sin = cosine[start:end], sine[start:end]
            coupler, output, valid_i = angles[0, i, start:end], angles[1, i, start:end], valid[i, start:end]
            for k in range(end - start):
                kx, ky = a * cos[k], a * sin[k]
                good, x, y = _close_loop(ground.real, ground.imag, kx, ky, b, c, s)
                coupler[k] = compute_direction(x, y)
                output[k] = compute_direction((kx - ground.real) + x, (ky - ground.imag) + y)
                ax[k] = o2.real + (kx if good else math.nan)
                ay[k] = o2.imag + (ky if good else math.nan)
                ux[k], uy[k] = x, y
                valid_i[k] = good
            fill_points(ax, ay, ux, uy, 0j, points[0, i, start:end])
            fill_points(ax, ay, ux, uy, 1 + 0j, points[1, i, start:end])
            fill_points(ax, ay, ux, uy, divide_by_length(pivots[2, j], b), points[2, i, start:end])


@njit(**OPTIONS)
def coupler_motion(
    pivots: Complex, lengths: Real, sign: Real, theta: Real, rates: Real, points: Complex, valid: Mask
) -> None:
    """Fill position, velocity and acceleration of P into ``points`` (3, D, N).

    ``valid`` (2, D, N) marks where the position exists, and where its derivatives exist.
    """
    _, designs, n = valid.shape
    cosine, sine, work = np.empty(n), np.empty(n), np.empty((9, TILE_SIZE))
    ax, ay, kx, ky, ux, uy, w2, w3, a3 = (
        work[0],
        work[1],
        work[2],
        work[3],
        work[4],
        work[5],
        work[6],
        work[7],
        work[8],
    )
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        r = i if rates.shape[1] > 1 else 0
        o2, ground = pivots[0, j], pivots[1, j] - pivots[0, j]
        a, b, c = lengths[0, j], lengths[1, j], lengths[2, j]
        p, s = divide_by_length(pivots[2, j], b), sign[i if len(sign) > 1 else 0]
        least = TOGGLE_SINE * b * c
        for start in range(0, n, TILE_SIZE):
            end = min(start + TILE_SIZE, n)
            cos, sin = cosine[start:end], sine[start:end]
            speed, acceleration = rates[0, r, start:end], rates[1, r, start:end]
            valid_i, sound_i = valid[0, i, start:end], valid[1, i, start:end]
            for k in range(end - start):
                x, y = a * cos[k], a * sin[k]
                valid_i[k], ux[k], uy[k] = _close_loop(ground.real, ground.imag, x, y, b, c, s)
                kx[k], ky[k] = x, y
                ax[k], ay[k] = o2.real + x, o2.imag + y
            for k in range(end - start):
                sound, _, w3[k], _, a3[k], _ = _compute_rates(
                    ground.real, ground.imag, kx[k], ky[k], ux[k], uy[k], least, speed[k], acceleration[k]
                )
                w2[k] = speed[k] if sound else math.nan
                sound_i[k] = sound
            fill_points(ax, ay, ux, uy, p, points[0, i, start:end])
            fill_velocities(kx, ky, ux, uy, w2, w3, p, points[1, i, start:end])
            fill_accelerations(kx, ky, ux, uy, w2, acceleration, w3, a3, p, points[2, i, start:end])


@njit(**OPTIONS)
def whole_motion(
    pivots: Complex, lengths: Real, sign: Real, theta: Real, rates: Real, points: Complex, angles: Real, valid: Mask
) -> None:
    """Fill positions and three derivatives: A, B, P into ``points`` (4, 3, D, N), links into ``angles`` (4, 2, D, N).

    ``valid`` (2, D, N) marks where the position exists, and where its derivatives exist.
    """
    _, designs, n = valid.shape
    cosine, sine, work = np.empty(n), np.empty(n), np.empty((8, TILE_SIZE))
    ax, ay, kx, ky, ux, uy, w2, inverse = (work[0], work[1], work[2], work[3], work[4], work[5], work[6], work[7])
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        r = i if rates.shape[1] > 1 else 0
        o2, ground = pivots[0, j], pivots[1, j] - pivots[0, j]
        a, b, c = lengths[0, j], lengths[1, j], lengths[2, j]
        s = sign[i if len(sign) > 1 else 0]
        least = TOGGLE_SINE * b * c
        for start in range(0, n, TILE_SIZE):
            end = min(start + TILE_SIZE, n)
            cos, sin = cosine[start:end], sine[start:end]
            coupler, output, valid_i = angles[0, 0, i, start:end], angles[0, 1, i, start:end], valid[0, i, start:end]
            for k in range(end - start):
                fx, fy = a * cos[k], a * sin[k]
                good, x, y = _close_loop(ground.real, ground.imag, fx, fy, b, c, s)
                coupler[k] = compute_direction(x, y)
                output[k] = compute_direction((fx - ground.real) + x, (fy - ground.imag) + y)
                kx[k], ky[k] = (fx if good else math.nan), (fy if good else math.nan)
                ux[k], uy[k] = x, y
                valid_i[k] = good
            speed, a2, j2 = rates[0, r, start:end], rates[1, r, start:end], rates[2, r, start:end]
            w3, w4 = angles[1, 0, i, start:end], angles[1, 1, i, start:end]
            a3, a4 = angles[2, 0, i, start:end], angles[2, 1, i, start:end]
            j3, j4 = angles[3, 0, i, start:end], angles[3, 1, i, start:end]
            sound_i = valid[1, i, start:end]
            for k in range(end - start):
                sound, inverse[k], w3[k], w4[k], a3[k], a4[k] = _compute_rates(
                    ground.real, ground.imag, kx[k], ky[k], ux[k], uy[k], least, speed[k], a2[k]
                )
                w2[k] = speed[k] if sound else math.nan
                sound_i[k] = sound
            for k in range(end - start):
                j3[k], j4[k] = _compute_jerks(
                    ground.real, ground.imag, kx[k], ky[k], ux[k], uy[k], inverse[k], w2[k], a2[k], j2[k], w3[k], a3[k],
                    w4[k], a4[k],
                )  # fmt: skip
            for k in range(end - start):
                ax[k], ay[k] = o2.real + kx[k], o2.imag + ky[k]
            for row in range(3):
                arm = 0j if row == 0 else (1 + 0j if row == 1 else divide_by_length(pivots[2, j], b))
                fill_points(ax, ay, ux, uy, arm, points[0, row, i, start:end])
                fill_velocities(kx, ky, ux, uy, w2, w3, arm, points[1, row, i, start:end])
                fill_accelerations(kx, ky, ux, uy, w2, a2, w3, a3, arm, points[2, row, i, start:end])
                fill_jerks(kx, ky, ux, uy, w2, a2, j2, w3, a3, j3, arm, points[3, row, i, start:end])
