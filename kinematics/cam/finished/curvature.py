"""Curvature of a finished profile, as the rate at which the contact normals turn along it.

With φ the angle of the normal that the follower requires at a point (:mod:`contact_normals`) and s the arc length of
the profile,

    κ = dφ/ds = φ′/|P′|,

both derivatives by the cam angle, taken from quintics through φ and P at six neighbouring points. Points are rounded to
ε p, with p their distance from the cam's centre and ε = 2⁻⁵³. Over chords of length h the second derivative of P, which
the curvature of a curve through points needs, has an error of about 10 ε p/h². The first derivative has an error of
ε p/h, and so has φ′ apart from the arm of the normal: with points spaced by p/10,000, κ has eleven digits, not seven.

Only the points are used, no relation of the program or of the solver. But φ is the direction that the normal must have
if the follower touches the point at its angle, and a wrong profile violates that. The chords show whether it does: from
one point to the next the profile leads

    D = ∫ |P′| i e^{iφ} dτ,

and the chord itself deviates from D by the mean error of φ. The change of that deviation between neighbouring chords,
over the distance of their middles, is the error of the curvature. The part that exceeds the rounding of the points is
*unexplained*: :func:`~kinematics.cam.finished.discretization.estimate_uncertainty` adds it to the curvature and
requests closer points, in case the interpolation causes it. A deviation below the rounding cannot be resolved by these
points.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Complex, Real
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.finished.contact import Contour
from kinematics.cam.finished.contact_normals import Normals, Side, compute_contact_normals, compute_wall_normals
from kinematics.cam.finished.local_curves import differentiate_curve, evaluate_curve
from kinematics.cam.follower import Follower
from kinematics.cam.motion.program import TURN
from kinematics.cam.profile import Rotation
from kinematics.errors import DimensionError

ROUNDING_ERROR = 8.0 * float(np.finfo(np.float64).eps)
"""Rounding error of a point, as a share of its distance from the centre: 8 ε covers both coordinates, the cam angle
(written in degrees) and earlier roundings."""

_GAUSS_NODES, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)
# Move Gauss's rule from [−1, 1] to the share of a chord, [0, 1].
_GAUSS_NODES, _GAUSS_WEIGHTS = 0.5 * (_GAUSS_NODES + 1.0), 0.5 * _GAUSS_WEIGHTS


@dataclass(frozen=True, eq=False)
class ProfileCurvature:
    """Curvature along a profile of n points, chord by chord.

    Attributes
    ----------
    chords : complex, shape (n,)
        Vectors from each point to the next, in the frame of a cam that turns clockwise.
    sizes : float, shape (n,)
        Lengths relative to which the points are rounded: their error is the share :data:`ROUNDING_ERROR` of these.
    arm : float, shape (n,)
        Arms of the normals, see :class:`~kinematics.cam.finished.contact_normals.Normals`.
    velocity : complex, shape (n, 5)
        P′ on each chord: coefficients in the share τ of the chord, constant first, derivative by τ.
    turn : float, shape (n, 6)
        φ on each chord, as coefficients of the same kind.
    """

    chords: Complex
    sizes: Real
    arm: Real
    velocity: Complex
    turn: Real

    @cached_property
    def _turn_rate(self) -> Real:
        return differentiate_curve(self.turn)

    def curvature_at(self, chord: ArrayLike, share: ArrayLike) -> Real:
        """Return the curvature dφ/ds at shares (0 to 1) of chords; arguments of any shapes that broadcast."""
        chosen, tau = np.asarray(chord, dtype=np.int64), np.asarray(share, dtype=np.float64)
        # Both derivatives are by the share of the chord, which cancels in the quotient.
        speed = np.abs(evaluate_curve(self.velocity[chosen], tau))
        return evaluate_curve(self._turn_rate[chosen], tau) / speed

    def measure_resolution(self, greatest: float) -> Real:
        """Return the size of each chord in units of the rounding of its points, shape (n,).

        The size is the chord's length or, if smaller, that length times arm × ``greatest`` curvature, which is how
        far the normals turn along it. The unit is the share :data:`ROUNDING_ERROR` of ``sizes``.
        """
        # The smaller arm of the chord's two ends is the more sensitive one.
        arm = np.minimum(self.arm, np.roll(self.arm, -1))
        return np.asarray(np.abs(self.chords) * np.minimum(arm * greatest, 1.0) / self.sizes)

    def estimate_rounding(self, chord: ArrayLike, share: ArrayLike) -> Real:
        """Return the error bound of the curvature by rounding; arguments as for :meth:`curvature_at`.

        In κ = φ′/|P′| (derivatives by the share of the chord) the denominator has the rounding error of the points, and
        the numerator that error over the arm plus the rounding of the cam angle. At the end of six points the first
        derivative of a quintic amplifies their error at most 17 times, and its scatter 7 times.
        """
        chosen, tau = np.asarray(chord, dtype=np.int64), np.asarray(share, dtype=np.float64)
        speed = np.abs(evaluate_curve(self.velocity[chosen], tau))
        bend = np.abs(evaluate_curve(self._turn_rate[chosen], tau)) / speed
        arm = np.minimum(self.arm, np.roll(self.arm, -1))[chosen]
        return np.asarray(ROUNDING_ERROR * (self.sizes[chosen] * (bend + 1.0 / arm) + 1.0) / speed)

    @cached_property
    def curvature_discrepancy(self) -> Real:
        """Largest error of κ = dφ/ds on each chord, judged by the directions of the chords; shape (n,)."""
        turn = evaluate_curve(self.turn[:, None], _GAUSS_NODES)
        ahead = (np.abs(evaluate_curve(self.velocity[:, None], _GAUSS_NODES)) * np.exp(1j * turn)) @ _GAUSS_WEIGHTS
        length = np.abs(self.chords)
        # Deviation of the chord from the direction that the normals predict; its change per length is a curvature.
        off = np.angle(self.chords * np.conj(1j * ahead))
        # Rounding of the chord's direction, plus that of the normals.
        rounded = ROUNDING_ERROR * self.sizes * (1.0 / length + 1.0 / self.arm)
        # Subtract what rounding of both chords can explain.
        more = np.abs(np.roll(off, -1) - off) - rounded - np.roll(rounded, -1)
        beyond = np.maximum(more, 0.0) / (0.5 * (length + np.roll(length, -1)))
        # A chord takes the larger discrepancy of its two ends.
        return np.asarray(np.maximum(beyond, np.roll(beyond, 1)))


def measure_profile_curvature(contour: Contour, follower: Follower, rotation: Rotation) -> ProfileCurvature:
    """Measure the curvature of a profile from its cam angles and its follower; positive where convex.

    Raises
    ------
    DimensionError
        For a profile without cam angles, or a knife edge.
    """
    at = contour.cam_angles
    # All relations hold for a cam that turns clockwise; the other sense is its mirror image.
    points = np.conj(contour.points) if rotation == "ccw" else contour.points
    velocity = differentiate_curve(contour.curves)
    return _build_curvature(
        np.roll(points, -1) - points,
        np.abs(points),
        compute_contact_normals(follower, points, at),
        np.conj(velocity) if rotation == "ccw" else velocity,
        contour.fit_values,
        at,
        np.diff(np.append(at, at[0] + TURN)),
    )


def measure_wall_curvature(wall: UnrolledWall, roller_radius: float, side: Side) -> ProfileCurvature:
    """Measure the curvature of a wall from its cam angles and the roller on one side; positive toward +y.

    Raises
    ------
    DimensionError
        As for :func:`measure_profile_curvature`.
    """
    at, count = wall.cam_angles, len(wall.points)
    normals = compute_wall_normals(wall.period / TURN, roller_radius, side, wall.points, at)
    # The normals point to +y, but i e^{iφ} must point along the wall (+x), so φ is a quarter turn less.
    upward = Normals(normals.lean - 0.5 * math.pi, normals.arm)
    sizes, still = np.full(count, wall.period), np.zeros(count)
    return _build_curvature(wall.chords, sizes, upward, differentiate_curve(wall.curves), wall.fit_values, still, still)


def _build_curvature(
    chords: Complex,
    sizes: Real,
    normals: Normals,
    velocity: Complex,
    fitted: Callable[[Real], Real],
    start: Real,
    step: Real,
) -> ProfileCurvature:
    """Build the curvature, given the angle of the normals' frame at each point and its turn to the next."""
    untouched = int((~np.isfinite(normals.lean)).sum())
    if untouched:
        raise DimensionError("profile", "kinematics-touched-at-points", untouched)
    turn = fitted(normals.lean)
    # Add the frame's own rotation, linear in the share of the chord, to the constant and linear coefficients.
    turn[:, 0] += start
    turn[:, 1] += step
    return ProfileCurvature(chords, sizes, normals.arm, velocity, turn)
