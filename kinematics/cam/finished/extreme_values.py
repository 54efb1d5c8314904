"""Worst values over a finished profile: curvature, pressure angle, the width that a contact sweeps, the radius.

At a point P of the profile with the outward normal n the follower's position follows without a search. A roller's
centre is C = P + r n, and its distance from the cam's centre determines its position on its path; the position of a
face follows from the distance of the tangent from the cam's centre. So each value is a function of the position on the
profile, smooth on every chord, and its extremes over all chords are exact (:mod:`extremes`), both sides of every point
included. The curvature is measured by :mod:`curvature`. A second curve runs through every second point; the difference
of the values on both curves estimates the error of those on the first one (:mod:`discretization`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Real
from kinematics.cam.finished.barrel_contact import UnrolledWall
from kinematics.cam.finished.contact import Contour, compute_motion_direction, compute_rates, get_kernel_dimensions
from kinematics.cam.finished.contact_normals import Side
from kinematics.cam.finished.curvature import ProfileCurvature, measure_profile_curvature, measure_wall_curvature
from kinematics.cam.finished.discretization import (
    CHORD_SHARES,
    ERROR_SHARE,
    Stretches,
    estimate_uncertainty,
    locate_on_coarser,
    measure_unsteadiness,
)
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.program import TURN
from kinematics.cam.profile import Rotation

REST_VELOCITY = 1e-7
"""Share of the maximum velocity below which the follower counts as at rest: a dwell with rounding."""

BISECTION_STEPS = 30
"""Bisections that locate a reversal of the follower to 1e-9 of a chord; the pressure angle is continuous there."""

SAMPLE_SHARES = np.array([1e-3, 0.25, 0.5, 0.75, 0.999])
"""Shares of a part at which a function is sampled before its exact extremes are computed."""

END_SHARE = 1e-9
"""Distance from the end of a chord, as a share of it, that selects the chord's own side of the point there."""

MIN_CHORD_RESOLUTION = 1e-7
"""Size of a chord relative to the rounding of its points (:meth:`ProfileCurvature.measure_resolution`) below which it
is not divided further: the curvature then has no more than eight digits."""


@dataclass(frozen=True)
class WorstValues:
    """Worst values over a profile, each increased by the bound of its error.

    Attributes
    ----------
    convex, concave : float
        Maximum curvature of the convex parts and of the hollow parts (as a positive number); 0 without such parts.
    rising, falling : float
        Maximum pressure angles of a roller, radians, 0 for a face; a follower at rest counts as rising.
    sweep : float
        Length on a flat face that the contact sweeps; 0 for a roller.
    radius : float
        Maximum distance of the profile from the cam's centre.
    rounded : float
        Share of the maximum curvature that was added for the rounding of the points.
    unsettled : float, shape (n,)
        Discretization error of the curvature of each chord as a multiple of the tolerance, where the curvature may be
        the maximum; 0 elsewhere.
    unsteady : float, shape (n,)
        The same for the pressure angle of a roller, or the extent of the contact on a face.
    """

    convex: float
    concave: float
    rising: float
    falling: float
    sweep: float
    radius: float
    rounded: float
    unsettled: Real
    unsteady: Real


def find_worst_values(contour: Contour, follower: Follower, rotation: Rotation, stretches: Stretches) -> WorstValues:
    """Find the worst values over a profile whose points have known cam angles.

    Parameters
    ----------
    contour : Contour
        The profile, with the cam angles of its points.
    follower : Follower
        The follower, which touches the profile everywhere.
    rotation : {"ccw", "cw"}
        Sense in which the cam turns.
    stretches : Stretches
        The breaks that limit the local curves.
    """
    fine, coarse = (_FollowerStates(curve, follower, rotation) for curve in (contour, contour.coarser))
    # Both curves are compared at the same cam angles, so the shares on the coarser chords have to be found.
    places = np.arange(len(contour.points))[:, None], CHORD_SHARES
    coarser = locate_on_coarser(contour.cam_angles, contour.coarser.cam_angles, CHORD_SHARES)
    bends = [measure_profile_curvature(curve, follower, rotation) for curve in (contour, contour.coarser)]
    (least, greatest), rounded, unsettled = _bound_curvature(bends[0], bends[1], places, coarser, stretches)
    _, radius = find_range(
        lambda u: np.abs(contour.evaluate_at(*_split_chord(u)).point), list_chord_intervals(len(contour.points))
    )
    rising, falling = (
        here + ERROR_SHARE * abs(here - wide)
        for here, wide in zip(fine.find_steepest(), coarse.find_steepest(), strict=True)
    )
    # Each value is increased by the estimated error of its own discretization.
    sweep, wider = fine.sweep(), coarse.sweep()
    return WorstValues(
        max(greatest, 0.0),
        max(-least, 0.0),
        rising,
        falling,
        sweep + ERROR_SHARE * abs(sweep - wider),
        radius,
        rounded,
        unsettled,
        measure_unsteadiness(
            *_compare_curves(fine, places, coarse, coarser), contour.chords / np.abs(contour.points), stretches
        ),
    )


Places = tuple[NDArray[np.int64], Real]
"""Positions on a profile: chords, and shares of them."""


def _bound_curvature(
    fine: ProfileCurvature, coarse: ProfileCurvature, places: Places, coarser: Places, stretches: Stretches
) -> tuple[tuple[float, float], float, Real]:
    """Bound the curvature.

    Return its minimum and maximum, both widened by their errors, the share of the larger one that is due to rounding,
    and the unsettledness of each chord.
    """
    near, wide = fine.curvature_at(*places), coarse.curvature_at(*coarser)
    # Chords between very close breaks carry no measurable curvature and are left out.
    measured = ~stretches.narrow
    grain = fine.estimate_rounding(*places)[measured]
    bottom, top = float(near[measured].min()), float(near[measured].max())
    size = max(abs(bottom), abs(top))
    above, below, unsettled = estimate_uncertainty(
        near, wide, fine.curvature_discrepancy, fine.measure_resolution(size) / MIN_CHORD_RESOLUTION, stretches
    )
    # Rounding counts only where it can raise the extreme itself.
    up = float((near[measured] + grain).max()) - top
    down = bottom - float((near[measured] - grain).min())
    # Between the compared places the curvature may be larger, so take the exact extremes too.
    exact = find_range(lambda u: fine.curvature_at(*_split_chord(u)), list_chord_intervals(len(near))[measured])
    worst_two = min(bottom, exact[0]) - below - down, max(top, exact[1]) + above + up
    return worst_two, max(up, down) / size, unsettled


def _compare_curves(
    fine: _FollowerStates, places: Places, coarse: _FollowerStates, coarser: Places
) -> tuple[Real, Real, Real]:
    """Evaluate the limited quantity at the same places of two curves, unsigned, and its sign on the first.

    For a roller it is the pressure angle, with the sign of the velocity; for a face the distance of the contact from
    the middle of its sweep.
    """
    v, near, ground = fine.evaluate_states(*places)
    _, wide, ground_of_coarser = coarse.evaluate_states(*coarser)
    if isinstance(fine.follower, TranslatingRoller | OscillatingRoller):
        return near, wide, np.sign(v)
    # The sweep is bounded on both sides: compare distances from its middle.
    reach, other = fine.reach(ground), coarse.reach(ground_of_coarser)
    middle = 0.5 * (reach.min() + reach.max())
    return np.abs(reach - middle), np.abs(other - middle), np.sign(reach - middle)


@dataclass(frozen=True)
class WorstWallValues:
    """Worst values over a wall of a barrel cam's groove; see :class:`WorstValues`.

    Attributes
    ----------
    up, down : float
        Maximum curvatures where the wall bends toward +y and away from it (both positive); 0 without such parts.
    rising, falling : float
        Maximum pressure angles, radians.
    lowest, highest : float
        Range of the wall along the axis.
    rounded, unsettled, unsteady
        As in :class:`WorstValues`.
    """

    up: float
    down: float
    rising: float
    falling: float
    lowest: float
    highest: float
    rounded: float
    unsettled: Real
    unsteady: Real


def find_worst_wall_values(
    wall: UnrolledWall, roller_radius: float, side: Side, stretches: Stretches
) -> WorstWallValues:
    """Find the worst values over a wall whose points have known cam angles: its slope is the pressure angle.

    Parameters
    ----------
    wall : UnrolledWall
        The wall, with the cam angles of its points.
    roller_radius : float
        Radius of the roller, which touches the wall everywhere.
    side : {1, -1}
        1 if the roller lies on the wall, −1 if it lies under it.
    stretches : Stretches
        As for :func:`find_worst_values`.
    """
    count = len(wall.points)
    places = np.arange(count)[:, None], CHORD_SHARES
    coarser = locate_on_coarser(wall.cam_angles, wall.coarser.cam_angles, CHORD_SHARES)
    slope, wide = (np.angle(curve.evaluate_at(*at)[0]) for curve, at in ((wall, places), (wall.coarser, coarser)))
    lengths = np.abs(wall.chords) / (wall.period / TURN)
    bends = [measure_wall_curvature(curve, roller_radius, side) for curve in (wall, wall.coarser)]
    (least, greatest), rounded, unsettled = _bound_curvature(bends[0], bends[1], places, coarser, stretches)
    rising, falling = (
        here + ERROR_SHARE * abs(here - wider)
        for here, wider in zip(_find_wall_slopes(wall), _find_wall_slopes(wall.coarser), strict=True)
    )
    lowest, highest = find_range(lambda u: wall.heights(*_split_chord(u)), list_chord_intervals(count))
    return WorstWallValues(
        max(greatest, 0.0),
        max(-least, 0.0),
        rising,
        falling,
        lowest,
        highest,
        rounded,
        unsettled,
        measure_unsteadiness(np.abs(slope), np.abs(wide), np.sign(slope), lengths, stretches),
    )


def _find_wall_slopes(wall: UnrolledWall) -> tuple[float, float]:
    """Find the maximum slopes up and down, radians."""

    def evaluate_states(u: Real) -> tuple[Real, Real]:
        tangent, _ = wall.evaluate_at(*_split_chord(u))
        return tangent.imag, np.abs(np.angle(tangent))

    return _find_steepest(evaluate_states, len(wall.points))


@dataclass(frozen=True)
class _FollowerStates:
    """State of a follower at each place of a profile that it touches, u chords from the first point."""

    contour: Contour
    follower: Follower
    rotation: Rotation

    def evaluate_states(self, chord: ArrayLike, share: ArrayLike) -> tuple[Real, Real, Complex]:
        """Return the velocity, the unsigned pressure angle, and the contact in the ground's frame."""
        place = self.contour.evaluate_at(chord, share)
        point, normal = place.point, place.normal
        # The formulas hold for a cam that turns clockwise; mirror the other one.
        if self.rotation == "ccw":
            point, normal = np.conj(point), np.conj(normal)
        value, turn = _place_follower(self.follower, point, normal)
        ground, upright = turn * point, turn * normal
        # The velocity does not depend on the radius of curvature, so any radius will do.
        v, _ = compute_rates(
            self.follower, value - get_kernel_dimensions(self.follower)[2], ground, upright, np.ones_like(value)
        )
        direction = compute_motion_direction(self.follower, value, ground)
        return v, np.abs(np.angle(upright * np.conj(direction))), ground

    def find_steepest(self) -> tuple[float, float]:
        """Find the maximum pressure angles of a roller, rising or at rest and falling, radians; 0 without motion."""
        if isinstance(self.follower, TranslatingFlat | OscillatingFlat):
            return 0.0, 0.0
        return _find_steepest(lambda u: self.evaluate_states(*_split_chord(u))[:2], len(self.contour.points))

    def sweep(self) -> float:
        """Return the length that the contact sweeps on a flat face; 0 for a roller."""
        if isinstance(self.follower, TranslatingRoller | OscillatingRoller):
            return 0.0
        least, greatest = find_range(
            lambda u: self.reach(self.evaluate_states(*_split_chord(u))[2]),
            list_chord_intervals(len(self.contour.points)),
        )
        return greatest - least

    def reach(self, ground: Complex) -> Real:
        """Return the position of the contact along a face."""
        if not isinstance(self.follower, OscillatingFlat):
            return np.asarray(ground.imag)
        square = np.abs(ground - self.follower.pivot_distance) ** 2 - self.follower.face_offset**2
        return np.sqrt(np.maximum(square, 0.0))


def _find_steepest(states: Callable[[Real], tuple[Real, Real]], count: int) -> tuple[float, float]:
    """Find the maximum angle while rising or at rest, and while falling, over ``count`` chords."""
    chord = np.arange(float(count))
    # Just inside the ends, since neighbouring chords may differ in velocity at a break.
    low, high = states(chord + END_SHARE)[0], states(chord + 1.0 - END_SHARE)[0]
    rest = REST_VELOCITY * max(float(np.abs(low).max()), float(np.abs(high).max()))
    # Rounding around a dwell must not look like reversals.
    low, high = (np.where(np.abs(v) <= rest, 0.0, v) for v in (low, high))
    # Chords on which the follower reverses are split there, so that each part belongs to one direction.
    turns = np.flatnonzero(low * high < 0.0)
    left, right = chord[turns] + END_SHARE, chord[turns] + 1.0 - END_SHARE
    for _ in range(BISECTION_STEPS):
        middle = 0.5 * (left + right)
        same = states(middle)[0] * low[turns] > 0.0
        left, right = np.where(same, middle, left), np.where(same, right, middle)
    ends = np.sort(np.append(np.arange(count + 1.0), 0.5 * (left + right)))
    parts = np.stack([ends[:-1], ends[1:]], axis=1)
    rising = states(parts.mean(axis=1))[0] >= -rest
    rise, fall = (
        find_range(lambda u: states(u)[1], parts[some])[1] if some.any() else 0.0 for some in (rising, ~rising)
    )
    return rise, fall


def list_chord_intervals(count: int) -> Real:
    """Return the start and end of each chord, in chords from the first point; shape (n, 2)."""
    first = np.arange(float(count))
    return np.stack([first, first + 1.0], axis=1)


def find_range(function: Callable[[Real], Real], parts: Real) -> tuple[float, float]:
    """Find the minimum and maximum over parts on which a function is smooth, limits at their ends included.

    Exact extremes are computed only on parts whose samples come near the extreme.

    Parameters
    ----------
    function : callable
        Function of chords from the first point, of any shape; never called at an end of a part.
    parts : float, shape (n, 2)
    """
    low, span = parts[:, :1], np.diff(parts, axis=1)
    values = function(low + span * SAMPLE_SHARES)
    least, greatest = values.min(axis=1), values.max(axis=1)
    swing = greatest - least
    # Assume that between samples a smooth function exceeds them by at most their own range.
    some = np.flatnonzero((greatest + swing >= greatest.max()) | (least - swing <= least.min()))
    low, span = low[some, 0], span[some, 0]

    def evaluate_selected(u: Real) -> Real:
        part, share = _split_chord(u)
        return function(low[part] + span[part] * share)

    found = find_extremes(evaluate_selected, np.arange(len(some) + 1.0))
    return found.least, found.greatest


def _split_chord(u: Real) -> tuple[NDArray[np.int64], Real]:
    """Split u, in chords from the first point, into the chord and its share."""
    chord = np.floor(u).astype(np.int64)
    return chord, u - chord


def _place_follower(follower: Follower, point: Complex, normal: Complex) -> tuple[Real, Complex]:
    """Return the follower's coordinate when it touches at a point of a clockwise cam, and the cam's rotation factor."""
    if isinstance(follower, TranslatingRoller):
        centre = point + follower.roller_radius * normal
        height = np.sqrt(np.maximum(np.abs(centre) ** 2 - follower.offset**2, 0.0))
        # The distance of the centre from the cam's centre fixes its height on the slide.
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
