"""Curves of the fifth degree through neighbouring points of a profile, which never reach over a break.

A profile is smooth in the cam's angle but for the breaks of its motion, where a derivative jumps. A polynomial through
points on both sides of a jump of the n-th derivative is wrong by the n-th power of the step; one through points of a
single side by the sixth. So each chord's curve runs through its own two points and four more of the same stretch
between breaks: two on each side where there are as many, else more on the other.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.program import TURN
from kinematics.errors import DimensionError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Indices = NDArray[np.int64]

Values = TypeVar("Values", Real, Complex)
"""Of curves of points, or of one number."""

STENCIL = 6
"""Points that a local curve runs through."""

FEWEST_STEPS = STENCIL - 1
"""Chords between two breaks that have curves of their own."""

EDGE = 1e-6
"""Cam angle, radians, between two neighbouring breaks up to which the curve is straight: an edge under a face whose
velocity jumps, or too short a stretch to show that it bends."""

FEWEST_FOR_TWO = 7
"""Chords between two breaks that have a second curve too, through six of their points: the error of its derivative
goes with the fifth power of what it spans, so that it is (7/5)⁵ = 5 times as large."""

AHEAD = 2
"""Of them before the chord's own first point, where no break is near."""


def stencils(count: int, breaks: Indices) -> Indices:
    """The first point of each chord's stencil; may be negative, or run beyond the last point, around a closed curve.

    Parameters
    ----------
    count : int
        Points of the closed curve, and so chords.
    breaks : int, shape (b,)
        Points over which no curve reaches, ascending. A stretch of fewer than five chords has too few points, and its
        curves reach over its ends.

    Returns
    -------
    int, shape (count,)
    """
    chord = np.arange(count)
    central = chord - AHEAD
    if not len(breaks):
        return central
    after = np.searchsorted(breaks, chord, side="right")
    around = np.concatenate([breaks[-1:] - count, breaks, breaks[:1] + count])
    low, high = around[after], around[after + 1]
    inside = np.clip(central, low, np.maximum(high - FEWEST_STEPS, low))
    return np.where(high - low >= FEWEST_STEPS, inside, central)


def local_curves(points: Complex, at: Real, own: Indices) -> Complex:
    """Coefficients of curves through six points each, in the share τ of a chord: 0 at its first point, 1 at its second.

    Parameters
    ----------
    points : complex, shape (n, 6)
        In order along the curve.
    at : float, shape (n, 6)
        Parameter of each of them, ascending.
    own : int, shape (n,)
        Which of them is the first point of the chord, 0 to 4.

    Returns
    -------
    complex, shape (n, 6)
        Constant first.
    """
    rows = np.arange(len(points))
    start, from_start = points[rows, own], at - at[rows, own][:, None]
    along = from_start / from_start[rows, own + 1][:, None]
    # Less the chord's own point, so that the rounding is that of the distances and not of the coordinates.
    values = points - start[:, None]
    powers = along[:, :, None] ** np.arange(STENCIL)
    try:
        solved = np.linalg.solve(powers, np.stack([values.real, values.imag], axis=-1))
    except np.linalg.LinAlgError:
        # A point far away from all others makes their angles, seen from the centre, equal to rounding.
        raise DimensionError("points of the profile", "apart in the cam's angle", "points that coincide") from None
    curves = solved[..., 0] + 1j * solved[..., 1]
    curves[:, 0] = start
    return np.asarray(curves)


def no_breaks() -> Indices:
    """The breaks of a curve that has none, shape (0,)."""
    return np.empty(0, dtype=np.int64)


def straightened(curves: Complex, at: Real, breaks: Indices) -> Complex:
    """Curves with edges: straight between two neighbouring points that are breaks at almost one cam angle.

    Parameters
    ----------
    curves : complex, shape (n, 6)
    at : float, shape (n,)
        Cam angles of the points.
    breaks : int, shape (b,)
    """
    count = len(at)
    step = np.diff(np.append(at, at[0] + TURN))
    is_break = np.zeros(count, np.bool_)
    is_break[breaks] = True
    edges = np.flatnonzero(is_break & np.roll(is_break, -1) & (step < EDGE))
    straight = curves.copy()
    straight[edges, 1] = curves[(edges + 1) % count, 0] - curves[edges, 0]
    straight[edges, 2:] = 0.0
    return straight


def chord_lengths(points: Complex) -> Real:
    """The parameter where no other is known: the length of the chords from the first of six points on."""
    chords = np.abs(np.diff(points, axis=1))
    return np.asarray(np.concatenate([np.zeros((len(points), 1)), np.cumsum(chords, axis=1)], axis=1))


def curve_value(curves: Values, share: Real) -> Values:
    """Points of local curves at τ, or of their derivatives."""
    result = curves[..., -1]
    for k in range(curves.shape[-1] - 2, -1, -1):
        result = result * share + curves[..., k]
    return result


def curve_derivatives(curves: Complex, share: Real) -> tuple[Complex, Complex]:
    """First and second derivative of the local curves by τ."""
    first = differentiated(curves)
    return curve_value(first, share), curve_value(differentiated(first), share)


def differentiated(curves: Values) -> Values:
    """Coefficients of the derivatives by τ, one fewer."""
    return curves[..., 1:] * np.arange(1.0, curves.shape[-1])


def unit_tangents(curves: Complex) -> Complex:
    """Directions of local curves at their first points, shape (n,)."""
    return np.asarray(curves[:, 1] / np.abs(curves[:, 1]))


def halved(count: int, breaks: Indices) -> tuple[Indices, Indices]:
    """Every second point of each stretch between breaks, or six of fewer than eleven, and the breaks among them.

    Of a stretch of fewer than seven chords all points.

    Returns
    -------
    kept : int, shape (m,)
        Points that are left, ascending.
    breaks : int, shape (b,)
        Which of those are breaks.
    """
    keep = np.zeros(count, dtype=np.bool_)
    if not len(breaks):
        keep[::2] = True
    else:
        for low, high in zip(breaks, np.append(breaks[1:], breaks[0] + count), strict=True):
            if FEWEST_FOR_TWO <= high - low < 2 * FEWEST_STEPS:
                keep[(low + np.arange(STENCIL) * (high - low) // FEWEST_STEPS) % count] = True
            else:
                keep[np.arange(low, high, 2 if high - low >= 2 * FEWEST_STEPS else 1) % count] = True
    kept = np.flatnonzero(keep)
    return kept, np.searchsorted(kept, breaks)
