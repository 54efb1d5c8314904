"""Fit arcs and lines to pieces of coupler curves, for many curves at once.

To every piece of a closed curve, a given number of samples long, the circle that minimizes Σ (|z − c|² − r²)² is fitted
(Kåsa, IEEE Trans. Instrum. Meas. 25 (1976) 8, doi:10.1109/TIM.1976.6312298): a linear problem in c and r² − |c|². About
the piece's mean, with moments S of x and y,

    [Sxx Sxy; Sxy Syy] c = ½ [Sx(x²+y²); Sy(x²+y²)],        r² = |c|² + (Sxx + Syy) / n.

The line is the least-squares line, along the main axis of the same moments.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.compiling import njit


@njit(cache=True, nogil=True, error_model="numpy")
def _extract_piece(curve: Complex, start: int, piece: Complex) -> tuple[complex, float, float, float]:
    """Write the samples of a piece about their mean; return the mean and the second moments Sxx, Syy, Sxy."""
    length = len(piece)
    # Moments about the mean avoid the cancellation that a small arc far from the origin would suffer.
    mean = 0j
    for k in range(length):
        piece[k] = curve[(start + k) % len(curve)]
        mean += piece[k]
    mean /= length
    sxx = syy = sxy = 0.0
    for k in range(length):
        piece[k] -= mean
        z = piece[k]
        sxx += z.real * z.real
        syy += z.imag * z.imag
        sxy += z.real * z.imag
    return mean, sxx, syy, sxy


@njit(cache=True, nogil=True, error_model="numpy")
def fit_arcs(curves: Complex, length: int, centres: Complex, radii: Real, off: Real) -> None:
    """Fit a circle to every piece of ``length`` samples: centre, radius and maximum distance from it, shape (m, N)."""
    count, n = curves.shape
    piece = np.empty(length, np.complex128)
    for row in range(count):
        for start in range(n):
            mean, sxx, syy, sxy = _extract_piece(curves[row], start, piece)
            sxz = syz = 0.0
            for z in piece:
                square = z.real * z.real + z.imag * z.imag
                sxz += z.real * square
                syz += z.imag * square
            # The determinant of a straight piece is zero. NumPy's error model then gives infinity, which means no arc.
            determinant = sxx * syy - sxy * sxy
            x = 0.5 * (sxz * syy - syz * sxy) / determinant
            y = 0.5 * (syz * sxx - sxz * sxy) / determinant
            centre = complex(x, y)
            radius = math.sqrt(x * x + y * y + (sxx + syy) / length)
            nearest, farthest = np.inf, 0.0
            for z in piece:
                arm = z - centre
                # Compare squares; only the two extremes need a root.
                square = arm.real * arm.real + arm.imag * arm.imag
                nearest, farthest = min(nearest, square), max(farthest, square)
            centres[row, start] = mean + centre
            radii[row, start] = radius
            off[row, start] = max(math.sqrt(farthest) - radius, radius - math.sqrt(nearest))


@njit(cache=True, nogil=True, error_model="numpy")
def fit_lines(curves: Complex, length: int, points: Complex, directions: Real, off: Real) -> None:
    """Fit a line to every piece of ``length`` samples: point, angle and maximum distance from it, shape (m, N)."""
    count, n = curves.shape
    piece = np.empty(length, np.complex128)
    for row in range(count):
        for start in range(n):
            mean, sxx, syy, sxy = _extract_piece(curves[row], start, piece)
            angle = 0.5 * math.atan2(2.0 * sxy, sxx - syy)
            farthest = 0.0
            for z in piece:
                farthest = max(farthest, abs(z.imag * math.cos(angle) - z.real * math.sin(angle)))
            points[row, start] = mean
            directions[row, start] = angle
            off[row, start] = farthest
