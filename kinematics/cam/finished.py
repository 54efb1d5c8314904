"""The worst values over a finished profile: curvature, pressure angle, the width that a contact sweeps, the radius.

At a point P of the profile with the outward normal n the follower's place follows without a search. A roller's centre
is C = P + r n, and its distance from the cam's centre says where on its path it stands; a face stands where the
distance of the tangent from the cam's centre is that of the face. So each value is a function of the place on the
profile, smooth on every chord, and its extremes over all chords are exact (:mod:`extremes`), both sides of every point
included. Through every second point runs another curve; how far its curvature is off says how far the first one's may
be: an error of the fourth order is divided by sixteen when points stand twice as close.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.cam.contact import Contour, dimensions, motion_direction, rates
from kinematics.cam.extremes import extremes
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.profile import Rotation
from kinematics.cam.program import TURN
from kinematics.cam.unrolled import UnrolledWall
from kinematics.errors import DimensionError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

AT_REST = 1e-7
"""Share of the greatest velocity below which the follower counts as resting, as in a dwell but for rounding."""

BISECTIONS = 30
"""To 1e-9 of a chord: where in it the follower turns back. The pressure angle is the same on both sides."""

SETTLED = 1e-6
"""Relative difference of the curvatures through all points and through every second one at which the first is right."""

FAINT = 0.02
"""Curvature, as a share of the greatest, below which another one is right to that share of its own: a profile is hollow
or convex there by so little that nothing hangs on it."""

GAINED = 0.2
"""Share of that difference by which the first may be off: its error is of the fourth order, so that a fifteenth is
usual, and more at the ends of stretches."""

SHARES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Of a chord, where the two curvatures are compared."""

SAMPLES = np.array([1e-3, 0.25, 0.5, 0.75, 0.999])
"""Of a part, where a function is asked at first."""

AT_END = 1e-9
"""Share of a chord that is its end, on its own side of the point there."""

REACH = 2
"""Chords on each side that are divided with an unsettled one."""

NEARLY = 5e-3
"""Share of the greatest curvature by which a place may be less and lie beside it all the same."""

HIDDEN = 1e-4
"""Share of the greatest curvature by which a small break of the motion may change it, where curves run over it."""

FEW = 7.0
"""What an unsettledness counts as at most: chords are divided in two at once, and again in the next round."""

ROUGH = 0.25
"""Share of the difference of two curvatures that are not close yet, by which the one through all points may be off."""

WIDELY = 1e4
"""Stands for the unsettledness of a chord that has to be divided as finely as possible."""

CLOSEST = 1e-8
"""Sagitta of two neighbouring points, as a share of their distance from the centre, below which they are put no closer:
the curvature then has no more than seven digits."""


class Stretches(NamedTuple):
    """How the breaks of a motion divide a profile.

    Attributes
    ----------
    breaks : int, shape (b,)
        Points over which no curve is fitted: the breaks, but for those whose neighbours on both sides are too near for
        curves of their own.
    blurred : bool, shape (n,)
        Chords whose curves run over breaks.
    narrow : bool, shape (n,)
        Those of them between breaks so near to each other that no curvature can be measured there.
    """

    breaks: NDArray[np.int64]
    blurred: NDArray[np.bool_]
    narrow: NDArray[np.bool_]


@dataclass(frozen=True)
class Worst:
    """The worst values over a profile, each made worse by how far it may be off.

    Attributes
    ----------
    convex, concave : float
        Greatest curvature where the profile is convex, and where it is hollow (a positive number); 0 where none is.
    rising, falling : float
        Greatest pressure angles of a roller, radians, 0 of a face; a follower at rest counts as rising.
    sweep : float
        Length on a flat face that the contact sweeps; 0 for a roller.
    radius : float
        Greatest distance of the profile from the cam's centre.
    unsettled : float, shape (n,)
        By how many times what is allowed the curvature of each chord depends on how close the points stand, where it
        may be the greatest; 0 elsewhere.
    """

    convex: float
    concave: float
    rising: float
    falling: float
    sweep: float
    radius: float
    unsettled: Real


def worst(contour: Contour, follower: Follower, rotation: Rotation, stretches: Stretches) -> Worst:
    """The worst values over a profile whose points' cam angles are known.

    Parameters
    ----------
    contour : Contour
        With ``at``.
    follower : Follower
        That touches the profile everywhere.
    rotation : {"ccw", "cw"}
        The way the cam turns.
    stretches : Stretches
        Between whose breaks the local curves run.
    """
    fine, coarse = (_Standing(curve, follower, rotation) for curve in (contour, contour.coarser))
    count = len(contour.points)
    parts = chords(count)
    near = contour.along(np.arange(count)[:, None], SHARES).curvature
    wide = contour.coarser.along(*coarser_places(given(contour.at), given(contour.coarser.at), SHARES)).curvature
    least, greatest = _bends(lambda u: contour.along(*_chord(u)).curvature, near, stretches)
    room = np.abs(near).max(axis=1) * contour.chords**2 >= CLOSEST * np.abs(contour.points)
    above, below, unsettled = doubt(near, wide, room, stretches)
    _, radius = range_of(lambda u: np.abs(contour.along(*_chord(u)).point), parts)
    rising, falling = (
        here + GAINED * abs(here - wide) for here, wide in zip(fine.steepest(), coarse.steepest(), strict=True)
    )
    sweep, wider = fine.sweep(), coarse.sweep()
    return Worst(
        max(greatest + above, 0.0),
        max(below - least, 0.0),
        rising,
        falling,
        sweep + GAINED * abs(sweep - wider),
        radius,
        unsettled,
    )


@dataclass(frozen=True)
class WorstOfWall:
    """The worst values over a wall of a barrel cam's groove, as of :class:`Worst`.

    Attributes
    ----------
    up, down : float
        Greatest curvatures where the wall bends toward +y and away from it (both positive); 0 where none is.
    rising, falling : float
        Greatest pressure angles, radians.
    unsettled : float, shape (n,)
    """

    up: float
    down: float
    rising: float
    falling: float
    unsettled: Real


def worst_of_wall(wall: UnrolledWall, stretches: Stretches) -> WorstOfWall:
    """The worst values over a wall whose points' cam angles are known: its slope is the pressure angle.

    ``stretches`` as for :func:`worst`.
    """
    count = len(wall.points)
    near = wall.along(np.arange(count)[:, None], SHARES)[1]
    wide = wall.coarser.along(*coarser_places(given(wall.at), given(wall.coarser.at), SHARES))[1]
    room = np.abs(near).max(axis=1) * np.abs(wall.chords) ** 2 >= CLOSEST * wall.period / TURN
    above, below, unsettled = doubt(near, wide, room, stretches)
    least, greatest = _bends(lambda u: wall.along(*_chord(u))[1], near, stretches)
    rising, falling = (
        here + GAINED * abs(here - wider) for here, wider in zip(_slopes(wall), _slopes(wall.coarser), strict=True)
    )
    return WorstOfWall(max(greatest + above, 0.0), max(below - least, 0.0), rising, falling, unsettled)


def _slopes(wall: UnrolledWall) -> tuple[float, float]:
    """Greatest slope up and down, radians."""

    def states(u: Real) -> tuple[Real, Real]:
        tangent, _ = wall.along(*_chord(u))
        return tangent.imag, np.abs(np.angle(tangent))

    return _steepest(states, len(wall.points))


def given(at: Real | None) -> Real:
    """The cam angles of the points.

    Raises
    ------
    DimensionError
        Where a curve has none.
    """
    if at is None:
        raise DimensionError("angles of the points", "given with them", None)
    return at


def doubt(near: Real, wide: Real, room: NDArray[np.bool_], stretches: Stretches) -> tuple[float, float, Real]:
    """By how much the greatest and the least curvature may be greater and less than they are through all points.

    Parameters
    ----------
    near, wide : float, shape (n, m)
        Curvatures at m places of n chords, of the curve through all points and of that through every second one.
    room : bool, shape (n,)
        Chords that can be divided: their curvature is not rounding yet.
    stretches : Stretches
        A curve that runs over breaks may hide them at both densities.

    Returns
    -------
    above, below : float
        What to add to the greatest, and to take from the least.
    unsettled : float, shape (n,)
        More than 1 at chords that have to be divided, as what is not known of their curvature may be worse than all
        that is known: how many times more than allowed that is. 0 elsewhere.
    """
    measured, divisible = ~stretches.narrow, room
    unsettled = np.zeros(len(near))
    near, wide, room = near[measured], wide[measured], room[measured]
    apart = np.abs(near - wide)
    # Where chords are too short to be divided, the difference is rounding.
    faint = FAINT * np.abs(near).max()
    error, factor = [], np.zeros(len(near))
    for toward in (near, -near):
        allowed = SETTLED * max(abs(toward.max()), faint)
        rough = (apart > allowed) & room[:, None]
        off = np.where(rough, ROUGH, GAINED) * apart
        error.append(float((toward + off).max() - toward.max()))
        worse = rough & (toward + apart > toward.max() - NEARLY * abs(toward.max()))
        factor = np.maximum(factor, np.where(worse, apart, 0.0).max(axis=1) / allowed)
    above, below = error
    hidden = (near > near.max() - HIDDEN * np.abs(near.max())) | (near < near.min() + HIDDEN * np.abs(near.min()))
    unsettled[measured] = np.where(hidden.any(axis=1) & stretches.blurred[measured], WIDELY, np.minimum(factor, FEW))
    return above, below, np.where(divisible, _spread(unsettled, stretches), 0.0)


def _spread(unsettled: Real, stretches: Stretches) -> Real:
    """To the neighbours of each chord too, since its curve runs through their points, but over no break."""
    ends = np.zeros(len(unsettled), np.bool_)
    ends[stretches.breaks] = True
    ends &= ~(stretches.blurred | np.roll(stretches.blurred, 1))
    for _ in range(REACH):
        before = np.where(ends, 0.0, np.roll(unsettled, 1))
        after = np.roll(np.where(ends, 0.0, unsettled), -1)
        unsettled = np.maximum(unsettled, np.maximum(before, after))
    return unsettled


def _bends(curvature: Callable[[Real], Real], near: Real, stretches: Stretches) -> tuple[float, float]:
    """Least and greatest curvature on chords whose curvature can be measured, the shares of ``near`` among its places.

    A curve over breaks is smooth on its chord too: what it has between those places may be more than at them.
    """
    measured = ~stretches.narrow
    exact = range_of(curvature, chords(len(near))[measured])
    return min(float(near[measured].min()), exact[0]), max(float(near[measured].max()), exact[1])


def coarser_places(at: Real, coarser: Real, share: Real) -> tuple[NDArray[np.int64], Real]:
    """Where shares of chords lie in a curve through fewer of the same points: its chords, and the shares of those.

    Parameters
    ----------
    at, coarser : float, shapes (n,) and (m,)
        Cam angles of the points of both.
    share : float, shape (k,)

    Returns
    -------
    chord, share : int and float, shape (n, k)
    """
    chord = np.searchsorted(coarser, at, side="right") - 1
    start = np.where(chord < 0, coarser[-1] - TURN, coarser[chord])
    step = np.diff(np.append(coarser, coarser[0] + TURN))[chord]
    angle = at[:, None] + share * np.diff(np.append(at, at[0] + TURN))[:, None]
    return np.repeat(chord[:, None], len(share), axis=1), (angle - start[:, None]) / step[:, None]


@dataclass(frozen=True)
class _Standing:
    """Where a follower stands at each place of a profile that it touches, u chords from the first point."""

    contour: Contour
    follower: Follower
    rotation: Rotation

    def _states(self, u: Real) -> tuple[Real, Real, Complex]:
        """Velocity, pressure angle without its sign, and the contact in the ground's frame."""
        place = self.contour.along(*_chord(u))
        point, normal = place.point, place.normal
        if self.rotation == "ccw":
            point, normal = np.conj(point), np.conj(normal)
        value, turn = _stand(self.follower, point, normal)
        ground, upright = turn * point, turn * normal
        v, _ = rates(self.follower, value - dimensions(self.follower)[2], ground, upright, np.ones_like(value))
        direction = motion_direction(self.follower, value, ground)
        return v, np.abs(np.angle(upright * np.conj(direction))), ground

    def steepest(self) -> tuple[float, float]:
        """Greatest pressure angles of a roller, rising or at rest and falling, radians; 0 without a move."""
        if isinstance(self.follower, TranslatingFlat | OscillatingFlat):
            return 0.0, 0.0
        return _steepest(lambda u: self._states(u)[:2], len(self.contour.points))

    def sweep(self) -> float:
        """Length on a flat face that the contact sweeps; 0 for a roller."""
        follower = self.follower
        if isinstance(follower, TranslatingRoller | OscillatingRoller):
            return 0.0

        def reach(u: Real) -> Real:
            ground = self._states(u)[2]
            if isinstance(follower, TranslatingFlat):
                return np.asarray(ground.imag)
            square = np.abs(ground - follower.pivot_distance) ** 2 - follower.face_offset**2
            return np.sqrt(np.maximum(square, 0.0))

        least, greatest = range_of(reach, chords(len(self.contour.points)))
        return greatest - least


def _steepest(states: Callable[[Real], tuple[Real, Real]], count: int) -> tuple[float, float]:
    """Greatest angle while rising or at rest, and while falling, of velocities and angles on so many chords."""
    chord = np.arange(float(count))
    low, high = states(chord + AT_END)[0], states(chord + 1.0 - AT_END)[0]
    rest = AT_REST * max(float(np.abs(low).max()), float(np.abs(high).max()))
    low, high = (np.where(np.abs(v) <= rest, 0.0, v) for v in (low, high))
    turns = np.flatnonzero(low * high < 0.0)
    left, right = chord[turns] + AT_END, chord[turns] + 1.0 - AT_END
    for _ in range(BISECTIONS):
        middle = 0.5 * (left + right)
        same = states(middle)[0] * low[turns] > 0.0
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    ends = np.sort(np.append(np.arange(count + 1.0), 0.5 * (left + right)))
    parts = np.stack([ends[:-1], ends[1:]], axis=1)
    rising = states(parts.mean(axis=1))[0] >= -rest
    rise, fall = (range_of(lambda u: states(u)[1], parts[some])[1] if some.any() else 0.0 for some in (rising, ~rising))
    return rise, fall


def chords(count: int) -> Real:
    """Where each chord begins and ends, in chords from the first point; shape (n, 2)."""
    first = np.arange(float(count))
    return np.stack([first, first + 1.0], axis=1)


def range_of(function: Callable[[Real], Real], parts: Real) -> tuple[float, float]:
    """Least and greatest value over parts on each of which the function is smooth, the ends' limits included.

    Exact values are looked for only where a few samples leave room for one.

    Parameters
    ----------
    function : callable
        Of chords from the first point, any shape; never called at an end of a part.
    parts : float, shape (n, 2)
    """
    low, span = parts[:, :1], np.diff(parts, axis=1)
    values = function(low + span * SAMPLES)
    least, greatest = values.min(axis=1), values.max(axis=1)
    swing = greatest - least
    some = np.flatnonzero((greatest + swing >= greatest.max()) | (least - swing <= least.min()))
    low, span = low[some, 0], span[some, 0]

    def chosen(u: Real) -> Real:
        part, share = _chord(u)
        return function(low[part] + span[part] * share)

    found = extremes(chosen, np.arange(len(some) + 1.0))
    return found.least, found.greatest


def _chord(u: Real) -> tuple[NDArray[np.int64], Real]:
    """The chord and its share at u chords from the first point."""
    chord = np.floor(u).astype(np.int64)
    return chord, u - chord


def _stand(follower: Follower, point: Complex, normal: Complex) -> tuple[Real, Complex]:
    """The follower's coordinate when it touches at a point of a cam that turns clockwise, and the cam's turn then."""
    if isinstance(follower, TranslatingRoller):
        centre = point + follower.roller_radius * normal
        height = np.sqrt(np.maximum(np.abs(centre) ** 2 - follower.offset**2, 0.0))
        return height, (height + 1j * follower.offset) / centre
    if isinstance(follower, OscillatingRoller):
        centre = point + follower.roller_radius * normal
        arm, pivot = follower.arm, follower.pivot_distance
        angle = np.arccos(np.clip((pivot**2 + arm**2 - np.abs(centre) ** 2) / (2.0 * pivot * arm), -1.0, 1.0))
        return angle, (pivot - arm * np.exp(-1j * follower.sense * angle)) / centre
    height = (point * np.conj(normal)).real
    if isinstance(follower, TranslatingFlat):
        return height, np.conj(normal)
    assert isinstance(follower, OscillatingFlat)
    angle = np.arcsin(np.clip((height + follower.face_offset) / follower.pivot_distance, -1.0, 1.0))
    return angle, np.exp(1j * follower.sense * (0.5 * math.pi - angle)) * np.conj(normal)
