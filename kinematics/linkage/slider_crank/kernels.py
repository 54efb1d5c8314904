"""Compiled sweeps of the slider-crank over designs × crank angles, by the formulas of :mod:`closed_form`.

``pivots`` are O2, a point of the slide (only its distances from O2 along and across the slide are used) and the coupler
point in its link's frame. ``lengths`` are a, b and the angle of the slide. In the frame of the slide, x along it, the
pin B has no motion across:

    Δ = u_x                       d'   = −ω2 k_y − ω3 u_y
    Δ ω3 = −ω2 k_x                d''  = −α2 k_y − ω2² k_x − α3 u_y − ω3² u_x
    Δ α3 = −α2 k_x + ω2² k_y + ω3² u_y
    Δ φ3 = (ω2³ − φ2) k_x + 3 ω2 α2 k_y + ω3³ u_x + 3 ω3 α3 u_y
                                  d''' = (ω2³ − φ2) k_y − 3 ω2 α2 k_x + (ω3³ − φ3) u_y − 3 ω3 α3 u_x
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
    """Return whether crank and coupler are positive and finite, and all points and the slide's angle finite."""
    for i in range(pivots.shape[1]):
        good = lengths[0, i] > 0.0 and lengths[1, i] > 0.0
        for row in range(3):
            good = good and math.isfinite(pivots[row, i].real) and math.isfinite(pivots[row, i].imag)
            good = good and math.isfinite(lengths[row, i])
        if not good:
            return False
    return True


@njit(**OPTIONS)
def _close_loop(y: float, b: float, sign: float, slack: float) -> tuple[bool, float]:
    """Close the loop: return whether B reaches the slide, and u along it (else NaN); ``y`` is u across it."""
    square = (b - y) * (b + y)
    valid = square >= -slack
    root = math.sqrt(square if square > 0.0 else 0.0)
    return valid, sign * root if valid else math.nan


@njit(**OPTIONS)
def _compute_slack(a: float, b: float, offset: float) -> float:
    """Compute by how much u_x² may be negative at a toggle, given the rounding of u_y from crank and offset."""
    return 2.0 * TOGGLE_SLACK * b * max(a, b, abs(offset))


@njit(**OPTIONS)
def coupler_points(pivots: Complex, lengths: Real, sign: Real, theta: Real, point: Complex, valid: Mask) -> None:
    """Fill P into ``point``, and ``valid``, shape (D, N)."""
    designs, n = valid.shape
    cosine, sine = np.empty(n), np.empty(n)
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        a, b, ex, ey = lengths[0, j], lengths[1, j], math.cos(lengths[2, j]), math.sin(lengths[2, j])
        o2, to_slide = pivots[0, j], (pivots[1, j] - pivots[0, j]) * complex(ex, -ey)
        p, s = divide_by_length(pivots[2, j], b) * complex(ex, ey), sign[i if len(sign) > 1 else 0]
        slack = _compute_slack(a, b, to_slide.imag)
        point_i, valid_i = point[i], valid[i]
        for k in range(n):
            kx, ky = a * cosine[k], a * sine[k]
            y = to_slide.imag - (ky * ex - kx * ey)
            good, x = _close_loop(y, b, s, slack)
            point_i[k] = complex(o2.real + kx + (p.real * x - p.imag * y), o2.imag + ky + (p.real * y + p.imag * x))
            valid_i[k] = good


@njit(**OPTIONS)
def _close_row(
    a: float,
    b: float,
    offset: float,
    ex: float,
    ey: float,
    sign: float,
    cosine: Real,
    sine: Real,
    kx: Real,
    ky: Real,
    ux: Real,
    uy: Real,
    valid: Mask,
) -> None:
    """Fill crank and coupler in the slide's frame over a row of angles; NaN where B does not reach the slide."""
    slack = _compute_slack(a, b, offset)
    for k in range(len(valid)):
        x, y = a * (cosine[k] * ex + sine[k] * ey), a * (sine[k] * ex - cosine[k] * ey)
        good, along = _close_loop(offset - y, b, sign, slack)
        kx[k], ky[k] = (x if good else math.nan), (y if good else math.nan)
        ux[k], uy[k] = along, (offset - y if good else math.nan)
        valid[k] = good


@njit(**OPTIONS)
def _place_joints(
    o2: complex,
    to_slide: float,
    ex: float,
    ey: float,
    kx: Real,
    ky: Real,
    ux: Real,
    uy: Real,
    ax: Real,
    ay: Real,
    angle: Real,
    travel: Real,
) -> None:
    """Fill A, the absolute angle of the coupler, and the slider's position on the slide."""
    for k in range(len(travel)):
        ax[k], ay[k] = o2.real + (kx[k] * ex - ky[k] * ey), o2.imag + (kx[k] * ey + ky[k] * ex)
        angle[k] = compute_direction(ux[k] * ex - uy[k] * ey, ux[k] * ey + uy[k] * ex)
        travel[k] = kx[k] + ux[k] - to_slide


@njit(**OPTIONS)
def whole_positions(
    pivots: Complex, lengths: Real, sign: Real, theta: Real, points: Complex, angles: Real, valid: Mask
) -> None:
    """Fill A, B, P into ``points`` (3, D, N), coupler angle and travel into ``angles`` (2, D, N), ``valid`` (D, N)."""
    designs, n = valid.shape
    cosine, sine, work = np.empty(n), np.empty(n), np.empty((6, TILE_SIZE))
    kx, ky, ux, uy, ax, ay = work[0], work[1], work[2], work[3], work[4], work[5]
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        a, b, ex, ey = lengths[0, j], lengths[1, j], math.cos(lengths[2, j]), math.sin(lengths[2, j])
        o2, e = pivots[0, j], complex(ex, ey)
        to_slide, s = (pivots[1, j] - o2) * complex(ex, -ey), sign[i if len(sign) > 1 else 0]
        for start in range(0, n, TILE_SIZE):
            end = min(start + TILE_SIZE, n)
            cos, sin, valid_i = cosine[start:end], sine[start:end], valid[i, start:end]
            _close_row(a, b, to_slide.imag, ex, ey, s, cos, sin, kx, ky, ux, uy, valid_i)
            angle, travel = angles[0, i, start:end], angles[1, i, start:end]
            _place_joints(o2, to_slide.real, ex, ey, kx, ky, ux, uy, ax, ay, angle, travel)
            fill_points(ax, ay, ux, uy, 0j, points[0, i, start:end])
            fill_points(ax, ay, ux, uy, e, points[1, i, start:end])
            fill_points(ax, ay, ux, uy, divide_by_length(pivots[2, j], b) * e, points[2, i, start:end])


@njit(**OPTIONS)
def _solve_rates(
    least: float,
    kx: Real,
    ky: Real,
    ux: Real,
    uy: Real,
    speed: Real,
    a2: Real,
    j2: Real,
    w2: Real,
    w3: Real,
    a3: Real,
    j3: Real,
    sound: Mask,
) -> None:
    """Solve for ω3, α3, φ3 over a row of angles; ω2 becomes NaN where they do not exist."""
    for k in range(len(sound)):
        good = math.fabs(ux[k]) > least
        # A single division serves all orders; NaN at a toggle.
        inverse = (1.0 if good else math.nan) / ux[k]
        w, n2 = speed[k], speed[k] * speed[k]
        x = -w * kx[k] * inverse
        y = (-a2[k] * kx[k] + n2 * ky[k] + x * x * uy[k]) * inverse
        w2[k], w3[k], a3[k] = (w if good else math.nan), x, y
        j3[k] = x * x * x + ((n2 * w - j2[k]) * kx[k] + 3.0 * w * a2[k] * ky[k] + 3.0 * x * y * uy[k]) * inverse
        sound[k] = good


@njit(**OPTIONS)
def whole_motion(
    pivots: Complex, lengths: Real, sign: Real, theta: Real, rates: Real, points: Complex, angles: Real, valid: Mask
) -> None:
    """Fill positions and three derivatives: A, B, P into ``points`` (4, 3, D, N), and ``angles`` (4, 2, D, N).

    ``angles`` holds coupler angle and travel; ``valid`` (2, D, N) marks where the position exists, and where its
    derivatives exist.
    """
    _, designs, n = valid.shape
    cosine, sine, work = np.empty(n), np.empty(n), np.empty((9, TILE_SIZE))
    kx, ky, ux, uy, ax, ay = work[0], work[1], work[2], work[3], work[4], work[5]
    w2, gx, gy = work[6], work[7], work[8]
    for i in range(designs):
        j = i if pivots.shape[1] > 1 else 0
        if i == 0 or len(theta) > 1:
            fill_cosines(theta[i], cosine, sine)
        r = i if rates.shape[1] > 1 else 0
        a, b, ex, ey = lengths[0, j], lengths[1, j], math.cos(lengths[2, j]), math.sin(lengths[2, j])
        o2, e = pivots[0, j], complex(ex, ey)
        to_slide, s = (pivots[1, j] - o2) * complex(ex, -ey), sign[i if len(sign) > 1 else 0]
        for start in range(0, n, TILE_SIZE):
            end = min(start + TILE_SIZE, n)
            cos, sin, valid_i = cosine[start:end], sine[start:end], valid[0, i, start:end]
            _close_row(a, b, to_slide.imag, ex, ey, s, cos, sin, kx, ky, ux, uy, valid_i)
            angle, travel = angles[0, 0, i, start:end], angles[0, 1, i, start:end]
            _place_joints(o2, to_slide.real, ex, ey, kx, ky, ux, uy, ax, ay, angle, travel)
            speed, a2, j2 = rates[0, r, start:end], rates[1, r, start:end], rates[2, r, start:end]
            w3, a3, j3 = angles[1, 0, i, start:end], angles[2, 0, i, start:end], angles[3, 0, i, start:end]
            _solve_rates(TOGGLE_SINE * b, kx, ky, ux, uy, speed, a2, j2, w2, w3, a3, j3, valid[1, i, start:end])
            for k in range(end - start):
                angles[1, 1, i, start + k] = -w2[k] * ky[k] - w3[k] * uy[k]
                angles[2, 1, i, start + k] = (
                    -a2[k] * ky[k] - w2[k] * w2[k] * kx[k] - a3[k] * uy[k] - w3[k] * w3[k] * ux[k]
                )
                t2, t3 = w2[k] * w2[k] * w2[k] - j2[k], w3[k] * w3[k] * w3[k] - j3[k]
                angles[3, 1, i, start + k] = (
                    t2 * ky[k] - 3.0 * w2[k] * a2[k] * kx[k] + t3 * uy[k] - 3.0 * w3[k] * a3[k] * ux[k]
                )
                gx[k], gy[k] = kx[k] * ex - ky[k] * ey, kx[k] * ey + ky[k] * ex
            for row in range(3):
                arm = 0j if row == 0 else (e if row == 1 else divide_by_length(pivots[2, j], b) * e)
                fill_points(ax, ay, ux, uy, arm, points[0, row, i, start:end])
                fill_velocities(gx, gy, ux, uy, w2, w3, arm, points[1, row, i, start:end])
                fill_accelerations(gx, gy, ux, uy, w2, a2, w3, a3, arm, points[2, row, i, start:end])
                fill_jerks(gx, gy, ux, uy, w2, a2, j2, w3, a3, j3, arm, points[3, row, i, start:end])
