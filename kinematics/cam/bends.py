"""Curvature of a finished profile: how fast the normals of its contacts turn along it.

With φ the angle of the normal that the follower asks for at a point (:mod:`contact_normals`) and s the length of the
profile,

    κ = dφ/ds = φ′/|P′|,

both derivatives by the cam angle, of curves of the fifth degree through φ and P at six neighbouring points. Points are
rounded to ε p, with p their distance from the cam's centre and ε = 2⁻⁵³. Over chords of h the second derivative of P,
which the curvature of a curve through points takes, is off by some 10 ε p/h². The first is by ε p/h, and so is φ′, but
for the arm of the normal: where points are a ten-thousandth of p apart κ has eleven digits instead of seven.

It is the points that are measured, and no relation of the program or of the solver is used. But φ is where the normal
has to be if the follower touches the point at its angle, and a wrong profile does not keep to that. Whether it does
shows in the chords: from a point to the next one the profile leads

    D = ∫ |P′| i e^{iφ} dτ,

and the chord itself has another direction by the mean of what the true normals are off φ. The difference of that
between neighbouring chords, over the distance of their middles, is what the curvature is off: of it as much as is more
than the rounding of the points is *unexplained*, and :func:`~kinematics.cam.settled.doubt` adds it to the curvature
and has the points put closer, in case it comes of the curves. What is less than rounding is in no profile that these
points describe.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.cam.contact import Contour
from kinematics.cam.contact_normals import Normals, Side, contact_normals, wall_normals
from kinematics.cam.follower import Follower
from kinematics.cam.local_curves import curve_value, differentiated
from kinematics.cam.profile import Rotation
from kinematics.cam.program import TURN
from kinematics.cam.unrolled import UnrolledWall
from kinematics.errors import DimensionError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ROUNDED = 8.0 * float(np.finfo(np.float64).eps)
"""Of a point, as a share of its distance from the centre: both coordinates, the cam angle (written in degrees), and
what was rounded before these, with some room."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS


@dataclass(frozen=True, eq=False)
class Bends:
    """Curvature along a profile of n points, cut into chords.

    Attributes
    ----------
    chords : complex, shape (n,)
        From each point to the next, in the frame of a cam that turns clockwise.
    sizes : float, shape (n,)
        Whose ROUNDED-th part the points are rounded by.
    arm : float, shape (n,)
        Of the normals.
    velocity : complex, shape (n, 5)
        P′ on each chord: coefficients in the share τ of the chord, constant first, derivative by τ.
    turn : float, shape (n, 6)
        φ, likewise.
    """

    chords: Complex
    sizes: Real
    arm: Real
    velocity: Complex
    turn: Real

    @cached_property
    def _turning(self) -> Real:
        return differentiated(self.turn)

    def along(self, chord: ArrayLike, share: ArrayLike) -> Real:
        """dφ/ds at shares of chords, 0 to 1; both of any shape that go together."""
        chosen, tau = np.asarray(chord, dtype=np.int64), np.asarray(share, dtype=np.float64)
        speed = np.abs(curve_value(self.velocity[chosen], tau))
        return curve_value(self._turning[chosen], tau) / speed

    def room(self, greatest: float) -> Real:
        """Length of each chord, and what its normals turn by, as a share of what the points are rounded by; (n,).

        Of the smaller one, in ROUNDED-th parts, where the curvature is the ``greatest``.
        """
        arm = np.minimum(self.arm, np.roll(self.arm, -1))
        return np.asarray(np.abs(self.chords) * np.minimum(arm * greatest, 1.0) / self.sizes)

    def rounding(self, chord: ArrayLike, share: ArrayLike) -> Real:
        """By how much the curvature there may be off by rounding; arguments as for :meth:`along`.

        Of κ = φ′/|P′|, derivatives by the share of the chord, the denominator is off by ROUNDED p, the numerator by
        that over the arm, and by the rounding of the cam angle itself. At the end of six points a first derivative of
        the fifth degree takes 17 times their error at most, and seven times its scatter.
        """
        chosen, tau = np.asarray(chord, dtype=np.int64), np.asarray(share, dtype=np.float64)
        speed = np.abs(curve_value(self.velocity[chosen], tau))
        bend = np.abs(curve_value(self._turning[chosen], tau)) / speed
        arm = np.minimum(self.arm, np.roll(self.arm, -1))[chosen]
        return np.asarray(ROUNDED * (self.sizes[chosen] * (bend + 1.0 / arm) + 1.0) / speed)

    @cached_property
    def unexplained(self) -> Real:
        """By how much κ may differ from dφ/ds on each chord, since the chords have other directions; shape (n,)."""
        turn = curve_value(self.turn[:, None], _NODES)
        ahead = (np.abs(curve_value(self.velocity[:, None], _NODES)) * np.exp(1j * turn)) @ _WEIGHTS
        length = np.abs(self.chords)
        off = np.angle(self.chords * np.conj(1j * ahead))
        rounded = ROUNDED * self.sizes * (1.0 / length + 1.0 / self.arm)
        more = np.abs(np.roll(off, -1) - off) - rounded - np.roll(rounded, -1)
        beyond = np.maximum(more, 0.0) / (0.5 * (length + np.roll(length, -1)))
        # Between a chord and the next one, and the one before.
        return np.asarray(np.maximum(beyond, np.roll(beyond, 1)))


def bends_of_profile(contour: Contour, follower: Follower, rotation: Rotation) -> Bends:
    """Of a profile with its cam angles, under its follower; curvature is positive where it is convex.

    Raises
    ------
    DimensionError
        A profile without cam angles; a knife edge.
    """
    at = contour.given_at
    points = np.conj(contour.points) if rotation == "ccw" else contour.points
    velocity = differentiated(contour.curves)
    return _bends(
        np.roll(points, -1) - points,
        np.abs(points),
        contact_normals(follower, points, at),
        np.conj(velocity) if rotation == "ccw" else velocity,
        contour.fitted,
        at,
        np.diff(np.append(at, at[0] + TURN)),
    )


def bends_of_wall(wall: UnrolledWall, roller_radius: float, side: Side) -> Bends:
    """Of a wall with its cam angles, under a roller on that side; curvature is positive where it bends toward +y.

    Raises
    ------
    DimensionError
        As for a profile.
    """
    at, count = wall.given_at, len(wall.points)
    normals = wall_normals(wall.period / TURN, roller_radius, side, wall.points, at)
    # The normals point up; i e^{iφ} is to lead along the wall.
    upward = Normals(normals.lean - 0.5 * math.pi, normals.arm)
    sizes, still = np.full(count, wall.period), np.zeros(count)
    return _bends(wall.chords, sizes, upward, differentiated(wall.curves), wall.fitted, still, still)


def _bends(
    chords: Complex,
    sizes: Real,
    normals: Normals,
    velocity: Complex,
    fitted: Callable[[Real], Real],
    start: Real,
    step: Real,
) -> Bends:
    """With the angle at which the frame of the normals stands at each point, and how far it turns to the next one."""
    if not np.isfinite(normals.lean).all():
        raise DimensionError("profile", "touched by the follower at the angles of its points", normals.lean)
    turn = fitted(normals.lean)
    turn[:, 0] += start
    turn[:, 1] += step
    return Bends(chords, sizes, normals.arm, velocity, turn)
