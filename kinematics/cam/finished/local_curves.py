"""Quintics through neighbouring points of a profile, which never cross a break.

A profile is smooth in the cam's angle except at the breaks of its motion, where a derivative jumps. A polynomial
through points on both sides of a jump of the n-th derivative has an error of the n-th power of the step; one through
points of a single side has an error of the sixth power. So each chord's curve runs through its own two points and four
more of the same stretch between breaks: two on each side if possible, else more on the other side.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from kinematics.arrays import Complex, Integers, Real
from kinematics.cam.motion.program import TURN
from kinematics.errors import DimensionError

Values = TypeVar("Values", Real, Complex)
"""Coefficients of curves of points (complex) or of numbers (float)."""

STENCIL_SIZE = 6
"""Number of points that a local curve runs through: it has degree 5."""

MIN_CHORDS = STENCIL_SIZE - 1
"""Minimum number of chords between two breaks that have curves of their own."""

MAX_EDGE_ANGLE = 1e-6
"""Cam angle, radians, between two neighbouring breaks up to which the curve is straight: an edge under a face whose
velocity jumps, or a stretch too short to show any curvature."""

MIN_CHORDS_FOR_COARSER = 7
"""Minimum number of chords between two breaks that also have a second, coarser curve, through six of their points: the
error of its derivative grows with the fifth power of its span, so it is at least (7/5)⁵ = 5 times as large."""

POINTS_BEFORE_CHORD = 2
"""Points of a stencil before the chord's own first point, away from breaks: the stencil is then centred on the
chord."""


def choose_stencils(count: int, breaks: Integers) -> Integers:
    """Choose the first point of each chord's stencil; it may be negative or run past the last point of the closed
    curve.

    Parameters
    ----------
    count : int
        Number of points of the closed curve, and of its chords.
    breaks : int, shape (b,)
        Points that no curve crosses, ascending. A stretch of fewer than five chords has too few points, so its curves
        do cross its ends.

    Returns
    -------
    int, shape (count,)
    """
    chord = np.arange(count)
    # Away from breaks the stencil is centred on the chord: two points before it, two after it.
    central = chord - POINTS_BEFORE_CHORD
    if not len(breaks):
        return central
    after = np.searchsorted(breaks, chord, side="right")
    # The curve is closed: the last break of the previous turn and the first of the next one bound the ends.
    around = np.concatenate([breaks[-1:] - count, breaks, breaks[:1] + count])
    low, high = around[after], around[after + 1]
    # Shift the stencil into the stretch; one-sided stencils still have full order.
    inside = np.clip(central, low, np.maximum(high - MIN_CHORDS, low))
    return np.where(high - low >= MIN_CHORDS, inside, central)


def fit_local_curves(points: Complex, at: Real, own: Integers) -> Complex:
    """Fit curves through six points each, in the share τ of a chord: 0 at its first point, 1 at its second.

    Parameters
    ----------
    points : complex, shape (n, 6)
        Points in order along the curve.
    at : float, shape (n, 6)
        Parameter of each point, ascending.
    own : int, shape (n,)
        Index (0 to 4) of the chord's first point among them.

    Returns
    -------
    complex, shape (n, 6)
        Coefficients, constant first.
    """
    rows = np.arange(len(points))
    start, from_start = points[rows, own], at - at[rows, own][:, None]
    along = from_start / from_start[rows, own + 1][:, None]
    # Relative to the chord's own point, so that rounding scales with distances instead of coordinates.
    values = points - start[:, None]
    # With τ of the order of 1 the Vandermonde matrix of six points is well conditioned.
    powers = along[:, :, None] ** np.arange(STENCIL_SIZE)
    try:
        solved = np.linalg.solve(powers, np.stack([values.real, values.imag], axis=-1))
    except np.linalg.LinAlgError:
        # A point far away from all others makes their angles, seen from the centre, equal to rounding.
        raise DimensionError("kinematics-profile-points", "kinematics-apart-in-angle", "points that coincide") from None
    curves = solved[..., 0] + 1j * solved[..., 1]
    # The solution reproduces the first point only to rounding; set it exactly.
    curves[:, 0] = start
    return np.asarray(curves)


def list_no_breaks() -> Integers:
    """Return the breaks of a curve without breaks, shape (0,)."""
    return np.empty(0, dtype=np.int64)


def apply_straight_edges(curves: Complex, at: Real, breaks: Integers) -> Complex:
    """Replace curves by straight edges between neighbouring breaks at almost the same cam angle.

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
    # Only stretches whose both ends are breaks; a short chord elsewhere is a proper curve.
    edges = np.flatnonzero(is_break & np.roll(is_break, -1) & (step < MAX_EDGE_ANGLE))
    straight = curves.copy()
    straight[edges, 1] = curves[(edges + 1) % count, 0] - curves[edges, 0]
    straight[edges, 2:] = 0.0
    return straight


def measure_chord_lengths(points: Complex) -> Real:
    """Return cumulative chord lengths from the first of six points, the parameter if no cam angle is known."""
    chords = np.abs(np.diff(points, axis=1))
    return np.asarray(np.concatenate([np.zeros((len(points), 1)), np.cumsum(chords, axis=1)], axis=1))


def evaluate_curve(curves: Values, share: Real) -> Values:
    """Evaluate local curves, or their derivatives, at τ."""
    result = curves[..., -1]
    # Horner's scheme.
    for k in range(curves.shape[-1] - 2, -1, -1):
        result = result * share + curves[..., k]
    return result


def evaluate_derivatives(curves: Complex, share: Real) -> tuple[Complex, Complex]:
    """Return the first and second derivatives of local curves by τ."""
    first = differentiate_curve(curves)
    return evaluate_curve(first, share), evaluate_curve(differentiate_curve(first), share)


def differentiate_curve(curves: Values) -> Values:
    """Return the coefficients of the derivatives by τ, one fewer than those of the curves."""
    return curves[..., 1:] * np.arange(1.0, curves.shape[-1])


def compute_unit_tangents(curves: Complex) -> Complex:
    """Return the directions of local curves at their first points, shape (n,)."""
    return np.asarray(curves[:, 1] / np.abs(curves[:, 1]))


def select_every_second(count: int, breaks: Integers) -> tuple[Integers, Integers]:
    """Select every second point of each stretch between breaks, and report the breaks among them.

    A stretch of 7 to 9 chords keeps six points, a shorter one all of them.

    Returns
    -------
    kept : int, shape (m,)
        Selected points, ascending.
    breaks : int, shape (b,)
        Indices of the breaks among them.
    """
    keep = np.zeros(count, dtype=np.bool_)
    if not len(breaks):
        keep[::2] = True
    else:
        for low, high in zip(breaks, np.append(breaks[1:], breaks[0] + count), strict=True):
            # Too short for every second point: spread six points as evenly as possible.
            if MIN_CHORDS_FOR_COARSER <= high - low < 2 * MIN_CHORDS:
                keep[(low + np.arange(STENCIL_SIZE) * (high - low) // MIN_CHORDS) % count] = True
            else:
                keep[np.arange(low, high, 2 if high - low >= 2 * MIN_CHORDS else 1) % count] = True
    kept = np.flatnonzero(keep)
    return kept, np.searchsorted(kept, breaks)
