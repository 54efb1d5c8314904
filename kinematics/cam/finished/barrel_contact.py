"""Motion of a roller laid against the walls of a barrel cam's groove, from their points alone.

The cylinder on which the roller's middle runs is unrolled, x along its circumference and y along its axis, so that a
wall is a curve that repeats after 2πR. A quintic runs through each six neighbouring points. With the roller's centre at
x, a point (P_x, P_y) of the lower wall requires

    y ≥ P_y + √(r² − (P_x − x)²)

and a point of the upper wall y ≤ P_y − √(…). The roller stands at the maximum of the lower bounds, or at the minimum of
the upper ones.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.cam.finished.contact import (
    GOLDEN_RATIO,
    GOLDEN_SECTION_STEPS,
    MAX_CHORD_TURN,
    MIN_POINTS,
    MIN_ROLLER_CHORDS,
)
from kinematics.cam.finished.local_curves import (
    STENCIL_SIZE,
    choose_stencils,
    compute_unit_tangents,
    evaluate_curve,
    evaluate_derivatives,
    fit_local_curves,
    list_no_breaks,
    measure_chord_lengths,
    select_every_second,
)
from kinematics.cam.motion.program import TURN
from kinematics.compiling import njit
from kinematics.errors import DimensionError, ShapeError


class Touch(NamedTuple):
    """Height of the roller's centre on the axis, NaN where it touches nothing, and the wall's direction there.

    ``tangent`` is a unit vector, ``curvature`` positive where the wall bends toward +y.
    """

    y: Real
    tangent: Complex
    curvature: Real


@dataclass(frozen=True, eq=False)
class UnrolledWall:
    """A wall of the groove over one turn.

    Parameters
    ----------
    points : complex, shape (n,)
        Points in the order of the turn; the first is not repeated at the end.
    period : float
        Circumference of the cylinder.
    at, breaks : float, shape (n,), and int, shape (b,), optional
        Cam angles of the points and points where a derivative may jump, as of a
        :class:`~kinematics.cam.finished.contact.Contour`.

    Raises
    ------
    ShapeError, DimensionError
        For fewer than 16 points, a period that is not positive, or points that are not finite or repeat a neighbour.
    """

    points: Complex
    period: float
    at: Real | None = None
    breaks: Integers = field(default_factory=list_no_breaks)

    def __post_init__(self) -> None:
        if self.points.ndim != 1 or len(self.points) < MIN_POINTS:
            raise ShapeError(points=self.points.shape)
        if not (math.isfinite(self.period) and self.period > 0.0):
            raise DimensionError("period", "kinematics-positive", self.period)
        distinct = np.isfinite(self.points) & (np.abs(self.chords) > 0.0)
        if not distinct.all():
            point = complex(self.points[~distinct][0])
            raise DimensionError("kinematics-wall-points", "kinematics-distinct-neighbours", point)

    @cached_property
    def chords(self) -> Complex:
        """Vectors from each point to the next, shape (n,)."""
        return np.asarray(np.diff(np.append(self.points, self.points[0] + self.period)))

    @property
    def cam_angles(self) -> Real:
        """The cam angles of the points.

        Raises
        ------
        DimensionError
            If the wall has none.
        """
        if self.at is None:
            raise DimensionError("kinematics-point-angles", "kinematics-given-with-points", None)
        return self.at

    @cached_property
    def curves(self) -> Complex:
        """Coefficients of each local curve in the share τ of its own chord, constant first; shape (n, 6)."""
        first, index, turn = self._stencils
        points = self.points[index % len(self.points)] + self.period * turn
        # Points of the next turn lie one period and one turn of the cam further on.
        at = measure_chord_lengths(points) if self.at is None else self.at[index % len(self.points)] + TURN * turn
        return fit_local_curves(points, at, np.arange(len(points)) - first)

    def fit_values(self, values: Real) -> Real:
        """Fit quintics to values at the points over the cam angle, as through the points themselves; (n, 6)."""
        (first, index, turn), n = self._stencils, len(self.points)
        curves = fit_local_curves(
            values[index % n].astype(np.complex128), self.cam_angles[index % n] + TURN * turn, np.arange(n) - first
        )
        return np.ascontiguousarray(curves.real)

    @cached_property
    def _stencils(self) -> tuple[Integers, Integers, Integers]:
        """First point of each chord's curve, all six, and the turn that each belongs to."""
        first = choose_stencils(len(self.points), self.breaks)
        index = first[:, None] + np.arange(STENCIL_SIZE)
        return first, index, index // len(self.points)

    @cached_property
    def coarser(self) -> UnrolledWall:
        """The curve through every second point of each stretch between breaks."""
        kept, breaks = select_every_second(len(self.points), self.breaks)
        return UnrolledWall(self.points[kept], self.period, None if self.at is None else self.at[kept], breaks)

    @cached_property
    def tangents(self) -> Complex:
        """Unit tangents at the points."""
        return compute_unit_tangents(self.curves)

    @property
    def has_cusp(self) -> bool:
        """Whether the wall runs back on itself at a point, as an undercut one does."""
        turn = np.angle(self.chords * np.conj(np.roll(self.chords, 1)))
        return bool(np.abs(turn).max() > MAX_CHORD_TURN)

    def evaluate_at(self, chord: ArrayLike, share: ArrayLike) -> tuple[Complex, Real]:
        """Return unit tangents, and curvatures positive where the wall bends toward +y, at shares of its chords."""
        first, second = evaluate_derivatives(
            self.curves[np.asarray(chord, dtype=np.int64)], np.asarray(share, dtype=np.float64)
        )
        length = np.abs(first)
        return np.asarray(first / length), np.asarray((np.conj(first) * second).imag / length**3)

    def heights(self, chord: ArrayLike, share: ArrayLike) -> Real:
        """Return the positions along the axis at shares of its chords."""
        curves = self.curves[np.asarray(chord, dtype=np.int64)]
        return np.asarray(evaluate_curve(curves, np.asarray(share, dtype=np.float64)).imag)

    def follow(self, x: ArrayLike, roller_radius: float, side: Literal[1, -1]) -> Touch:
        """Lay a roller on a lower wall (side 1) or under an upper one (side −1).

        Parameters
        ----------
        x : array_like
            Positions of the roller's centre along the circumference.
        roller_radius : float
            Radius of the roller, large enough that points of the wall lie on both sides of its contact.
        """
        if not roller_radius >= MIN_ROLLER_CHORDS * np.abs(self.chords).max():
            least = f"{MIN_ROLLER_CHORDS * np.abs(self.chords).max()}"
            raise DimensionError("kinematics-roller-radius", "kinematics-at-least", roller_radius, least=least)
        at = np.asarray(x, dtype=np.float64)
        flat = np.ascontiguousarray(at.reshape(-1))
        values, shares = np.empty(flat.size), np.empty(flat.size)
        pieces = np.empty(flat.size, dtype=np.int64)
        # An upper wall is a lower wall mirrored in the x axis.
        curves = np.ascontiguousarray(self.curves if side == 1 else np.conj(self.curves))
        _lay_roller(curves, self.period, flat, roller_radius, values, pieces, shares)
        first, second = evaluate_derivatives(self.curves[pieces], shares)
        touches = np.isfinite(values)
        tangent = np.where(touches, first / np.abs(first), np.nan)
        curvature = np.where(touches, (np.conj(first) * second).imag / np.abs(first) ** 3, np.nan)
        # Mirror the height of an upper wall back.
        values = np.where(touches, side * values, np.nan)
        return Touch(values.reshape(at.shape), tangent.reshape(at.shape), curvature.reshape(at.shape))


@njit(cache=True, nogil=True)
def _evaluate_height(curves: Complex, base: int, t: float, period: float, x: float, radius: float) -> float:
    """Return the height required at t chords from the point ``base``, −1 ≤ t ≤ 1; −∞ beyond the roller."""
    n = curves.shape[0]
    piece, share = (base, t) if t >= 0.0 else ((base - 1) % n, t + 1.0)
    z = curves[piece, STENCIL_SIZE - 1]
    for k in range(STENCIL_SIZE - 2, -1, -1):
        z = z * share + curves[piece, k]
    across = z.real - x
    # Distance to the nearest image of the point: the wall repeats every period.
    across -= period * round(across / period)
    square = radius * radius - across * across
    return z.imag + math.sqrt(square) if square >= 0.0 else -math.inf


@njit(cache=True, nogil=True)
def _lay_roller(
    curves: Complex,
    period: float,
    at: Real,
    radius: float,
    values: Real,
    pieces: NDArray[np.int64],
    shares: Real,
) -> None:
    """Find the maximum height over the wall: refine every local maximum over the points by golden section."""
    n = curves.shape[0]
    asked = np.empty(n)
    for i in range(at.size):
        for k in range(n):
            asked[k] = _evaluate_height(curves, k, 0.0, period, at[i], radius)
        best, where, share = -math.inf, 0, 0.0
        for k in range(n):
            here = asked[k]
            # Only local maxima over the points are refined; index −1 wraps around the closed wall.
            if here == -math.inf or here < asked[k - 1] or here < asked[(k + 1) % n]:
                continue
            low, high = -1.0, 1.0
            left, right = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
            at_left = _evaluate_height(curves, k, left, period, at[i], radius)
            at_right = _evaluate_height(curves, k, right, period, at[i], radius)
            for _ in range(GOLDEN_SECTION_STEPS):
                if at_left < at_right:
                    low, left, at_left = left, right, at_right
                    right = low + GOLDEN_RATIO * (high - low)
                    at_right = _evaluate_height(curves, k, right, period, at[i], radius)
                else:
                    high, right, at_right = right, left, at_left
                    left = high - GOLDEN_RATIO * (high - low)
                    at_left = _evaluate_height(curves, k, left, period, at[i], radius)
            found, t = (at_left, left) if at_left > at_right else (at_right, right)
            # The two neighbouring curves meet at the point, where their maximum may be a corner.
            if here > found:
                found, t = here, 0.0
            if found > best:
                best = found
                where, share = (k, t) if t >= 0.0 else ((k - 1) % n, t + 1.0)
        values[i] = best if best > -math.inf else math.nan
        pieces[i], shares[i] = where, share
