"""Motion of a follower laid against a finished profile, from the points of the profile alone.

Nothing here uses the program or the construction of the profile. A quintic runs through each six neighbouring points
(:mod:`local_curves`), over the cam angle if it is given with the points, else over the length of the chords. At each
cam angle every point of the curve that the follower could touch requires a displacement; the follower stands at the
maximum, because at any smaller one the cam would penetrate it. This finds interference elsewhere on the cam, and
hollows too narrow for the roller.
With P the point in the ground's frame, C the distance of the pivot, D = |P − C| and β the angle of P at the pivot:

    translating roller    x = P_x + √(r² − (P_y − e)²)
    oscillating roller    ψ = β + arccos((L² + D² − r²)/(2 L D))
    translating face      x = P_x
    oscillating face      ψ = β + arcsin(f/D)

The pressure angle is measured between the curve's normal and the motion of the follower's point there. The velocity
follows from the direction of the curve at the contact, since the roller's centre and the face's contact move along
their offset curves, and the acceleration from its curvature there (the relations of :mod:`follower`, solved for v and
a); neither is a difference quotient of displacements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.cam.finished.local_curves import (
    STENCIL_SIZE,
    apply_straight_edges,
    choose_stencils,
    compute_unit_tangents,
    evaluate_curve,
    evaluate_derivatives,
    fit_local_curves,
    list_no_breaks,
    measure_chord_lengths,
    select_every_second,
)
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.program import TURN
from kinematics.cam.profile import Rotation
from kinematics.compiling import njit
from kinematics.errors import DimensionError, ShapeError

MIN_POINTS = 16
"""Minimum number of points of a profile: fewer do not describe a curve."""

MIN_ROLLER_CHORDS = 4.0
"""Minimum radius of a roller in chords, so that points of the profile lie on both sides of its contact."""

MAX_CHORD_TURN = math.pi / 3.0
"""Angle between neighbouring chords, radians, above which a profile has a cusp: the next chord runs back there."""

TRANSLATING_ROLLER, OSCILLATING_ROLLER, TRANSLATING_FACE, OSCILLATING_FACE = range(4)
TRANSLATING_INNER_ROLLER, OSCILLATING_INNER_ROLLER = 4, 5
"""Rollers inside the outer wall of a groove; their coordinates are negated, so that the maximum is needed here too."""

GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)

GOLDEN_SECTION_STEPS = 42
"""Steps of the golden section: they locate the maximum to 1e-9 of a chord, an error whose square is below rounding."""


class ContactMotion(NamedTuple):
    """Position of the follower at each cam angle; NaN where it touches nothing.

    ``s``, ``v`` and ``a`` are its displacement and the derivatives by the cam angle. ``point`` is the contact and
    ``normal`` the outward unit normal there, in the cam's frame. ``pressure_angle`` is unsigned. ``radius`` is the
    radius of curvature of the profile at the contact, positive where convex.
    """

    s: Real
    v: Real
    a: Real
    point: Complex
    normal: Complex
    pressure_angle: Real
    radius: Real

    @property
    def valid(self) -> NDArray[np.bool_]:
        """Whether there is a contact, by angle."""
        return np.isfinite(self.s)


class CurvePoint(NamedTuple):
    """Points of a profile, the outward unit normals there, and the curvature, positive where convex."""

    point: Complex
    normal: Complex
    curvature: Real


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed profile through points in the cam's frame.

    Parameters
    ----------
    points : complex, shape (n,)
        Points in order around the cam, in either direction; the first is not repeated at the end.
    at : float, shape (n,), optional
        A parameter in which the curve is smooth between breaks, ascending within a turn: the cam angles at which the
        follower stands at the points; by default the length of the chords.
    breaks : int, shape (b,), optional
        Indices of points at which a derivative of the curve may jump, ascending. Breaks only limit the local curves:
        even with wrong breaks the curve passes through all points.

    Raises
    ------
    ShapeError
        For fewer than 16 points, or a different number of angles.
    DimensionError
        For a point that is not finite or repeats its neighbour, or angles that do not ascend within a turn.
    """

    points: Complex
    at: Real | None = None
    breaks: Integers = field(default_factory=list_no_breaks)

    def __post_init__(self) -> None:
        if self.points.ndim != 1 or len(self.points) < MIN_POINTS:
            raise ShapeError(points=self.points.shape)
        if self.at is not None:
            if self.at.shape != self.points.shape:
                raise ShapeError(points=self.points.shape, at=self.at.shape)
            # Including the step back to the first point: the angles stay within one turn.
            ascending = np.diff(np.append(self.at, self.at[0] + TURN)) > 0.0
            if not ascending.all():
                angle = float(self.at[~ascending][0])
                raise DimensionError("kinematics-point-angles", "kinematics-ascending-within-turn", angle)
        distinct = np.isfinite(self.points) & (self.chords > 0.0)
        if not distinct.all():
            point = complex(self.points[~distinct][0])
            raise DimensionError("kinematics-profile-points", "kinematics-distinct-neighbours", point)

    @cached_property
    def chords(self) -> Real:
        """Distances from each point to the next, shape (n,)."""
        return np.asarray(np.abs(np.roll(self.points, -1) - self.points))

    @cached_property
    def tangents(self) -> Complex:
        """Unit tangents of the profile at its points, in the order of the points."""
        return compute_unit_tangents(self.curves)

    @property
    def cam_angles(self) -> Real:
        """The cam angles of the points.

        Raises
        ------
        DimensionError
            If the profile has none.
        """
        if self.at is None:
            raise DimensionError("kinematics-point-angles", "kinematics-given-with-points", None)
        return self.at

    @cached_property
    def curves(self) -> Complex:
        """Coefficients of each local curve in the share τ of its own chord, constant first; shape (n, 6)."""
        if self.at is None:
            first, index = self._stencils
            points = self.points[index % len(self.points)]
            return fit_local_curves(points, measure_chord_lengths(points), np.arange(len(points)) - first)
        return apply_straight_edges(self._fit_over_angle(self.points, self.at), self.at, self.breaks)

    def fit_values(self, values: Real) -> Real:
        """Fit quintics to values at the points over the cam angle, as through the points themselves; (n, 6)."""
        return np.ascontiguousarray(self._fit_over_angle(values.astype(np.complex128), self.cam_angles).real)

    @cached_property
    def _stencils(self) -> tuple[Integers, Integers]:
        """First point of each chord's curve, and all six; indices beyond the last point belong to the next turn."""
        first = choose_stencils(len(self.points), self.breaks)
        return first, first[:, None] + np.arange(STENCIL_SIZE)

    def _fit_over_angle(self, values: Complex, at: Real) -> Complex:
        """Fit local curves over the cam angle."""
        (first, index), n = self._stencils, len(self.points)
        # Points of the next turn have angles beyond 2π, so that the parameter ascends.
        return fit_local_curves(values[index % n], at[index % n] + TURN * (index // n), np.arange(n) - first)

    @cached_property
    def coarser(self) -> Contour:
        """The curve through every second point of each stretch between breaks."""
        kept, breaks = select_every_second(len(self.points), self.breaks)
        return Contour(self.points[kept], None if self.at is None else self.at[kept], breaks)

    @cached_property
    def turns_ccw(self) -> bool:
        """Whether the points run counter-clockwise."""
        following = np.roll(self.points, -1)
        # Twice the enclosed area has the sign of the orientation.
        return bool((np.conj(self.points) * following).imag.sum() > 0.0)

    def curvature(self, per_chord: int = 4) -> Real:
        """Return the curvature at equal shares of every chord, positive where convex; shape (n · per_chord,)."""
        share = np.arange(per_chord) / per_chord
        return self.evaluate_at(np.arange(len(self.points))[:, None], share).curvature.reshape(-1)

    def evaluate_at(self, chord: ArrayLike, share: ArrayLike) -> CurvePoint:
        """Evaluate the profile at shares (0 to 1) of its chords; arguments of any shapes that broadcast."""
        curves = self.curves[np.asarray(chord, dtype=np.int64)]
        tau = np.asarray(share, dtype=np.float64)
        first, second = evaluate_derivatives(curves, tau)
        sign = 1.0 if self.turns_ccw else -1.0
        length = np.abs(first)
        bend = sign * (np.conj(first) * second).imag / length**3
        return CurvePoint(evaluate_curve(curves, tau), np.asarray(-1j * sign * first / length), np.asarray(bend))

    @cached_property
    def sharpest_turn(self) -> float:
        """Maximum angle between neighbouring chords, radians."""
        chord = np.roll(self.points, -1) - self.points
        return float(np.abs(np.angle(chord * np.conj(np.roll(chord, 1)))).max())

    @property
    def has_cusp(self) -> bool:
        """Whether the profile runs back on itself at a point, as an undercut one does."""
        return self.sharpest_turn > MAX_CHORD_TURN

    @cached_property
    def crossings(self) -> Complex:
        """Points where the profile crosses itself; a sound cam has none."""
        p = self.points
        # One crossing per chord is enough to report; the kernel stops counting when the array is full.
        crossings = np.empty(len(p), dtype=np.complex128)
        return crossings[: _find_crossings(p, crossings)]

    def follow(self, follower: Follower, angle: ArrayLike, rotation: Rotation = "ccw") -> ContactMotion:
        """Lay a follower against the profile.

        Parameters
        ----------
        follower : Follower
            The follower with its dimensions; its displacement is measured from the prime or base radius.
        angle : array_like
            Cam angles of any shape, measured as in :class:`~kinematics.cam.profile.Cam`.
        rotation : {"ccw", "cw"}
            Sense in which the cam turns.

        Raises
        ------
        DimensionError
            For a roller so small that it fits between the points, except a knife edge.
        """
        theta = np.asarray(angle, dtype=np.float64)
        kind, sizes, zero = get_kernel_dimensions(follower)
        mirrored = rotation == "ccw"
        # Mirroring reduces a counter-clockwise cam to the clockwise case.
        curves = np.conj(self.curves) if mirrored else self.curves
        # An arm that swings against the cam is the mirror image of one that swings with it.
        flipped = getattr(follower, "sense", 1) == -1
        roller = isinstance(follower, TranslatingRoller | OscillatingRoller)
        if roller and 0.0 < sizes[2] < MIN_ROLLER_CHORDS * self.chords.max():
            least = f"{MIN_ROLLER_CHORDS * self.chords.max()}"
            given = float(sizes[2])
            raise DimensionError("kinematics-roller-radius", "kinematics-zero-or-at-least", given, least=least)
        values: Real = np.empty(theta.size)
        shares: Real = np.empty(theta.size)
        pieces = np.empty(theta.size, dtype=np.int64)
        flat = np.ascontiguousarray(theta.reshape(-1))
        # A knife edge touches where its path crosses the profile. There is no tangency, so it needs another search.
        edge = roller and sizes[2] == 0.0
        _lay_follower(np.ascontiguousarray(curves), flat, kind, sizes, flipped, edge, values, pieces, shares)
        values = values.reshape(theta.shape)
        local, share = curves[pieces.reshape(theta.shape)], shares.reshape(theta.shape)
        point = evaluate_curve(local, share)
        first, second = evaluate_derivatives(local, share)
        valid = np.isfinite(values)
        # Mirroring also reverses the orientation of the points.
        orientation = 1.0 if self.turns_ccw != mirrored else -1.0
        # A straight stretch has an infinite radius; angles without contact divide NaN.
        with np.errstate(divide="ignore", invalid="ignore"):
            radius = np.where(valid, np.abs(first) ** 3 / (orientation * (np.conj(first) * second).imag), np.nan)
            normal = np.where(valid, -1j * orientation * first / np.abs(first), np.nan)
            point = np.where(valid, point, np.nan)
            turn = np.exp(-1j * theta)
            v, a = compute_rates(follower, values - zero, turn * point, turn * normal, radius)
            direction = compute_motion_direction(follower, values, turn * point)
            pressure = np.abs(np.angle(turn * normal * np.conj(direction)))
        own = np.conj if mirrored else np.asarray
        return ContactMotion(values - zero, v, a, own(point), own(normal), pressure, radius)

    def follow_inside(self, follower: Follower, angle: ArrayLike, rotation: Rotation = "ccw") -> Real:
        """Lay a roller from inside against this curve, the outer wall of a groove.

        The wall's points are taken on the follower's side of the cam. The parameters are those of :meth:`follow`.

        Returns
        -------
        float
            The smallest displacement at which the roller touches, NaN where it touches nothing.

        Raises
        ------
        DimensionError
            For a follower without a roller, or a roller so small that it fits between the points.
        """
        theta = np.asarray(angle, dtype=np.float64)
        kind, sizes, zero = get_kernel_dimensions(follower)
        kinds = {TRANSLATING_ROLLER: TRANSLATING_INNER_ROLLER, OSCILLATING_ROLLER: OSCILLATING_INNER_ROLLER}
        if kind not in kinds or not sizes[2] >= MIN_ROLLER_CHORDS * self.chords.max():
            least = f"{MIN_ROLLER_CHORDS * self.chords.max()}"
            raise DimensionError("kinematics-roller-radius", "kinematics-at-least", float(sizes[2]), least=least)
        curves = np.ascontiguousarray(np.conj(self.curves) if rotation == "ccw" else self.curves)
        flat = np.ascontiguousarray(theta.reshape(-1))
        values: Real = np.empty(flat.size)
        flipped = getattr(follower, "sense", 1) == -1
        _lay_follower(
            curves, flat, kinds[kind], sizes, flipped, False, values, np.empty(flat.size, np.int64), np.empty(flat.size)
        )
        # The kernel maximizes negated coordinates for a roller inside a wall.
        return -values.reshape(theta.shape) - zero


def compute_rates(follower: Follower, s: Real, contact: Complex, normal: Complex, radius: Real) -> tuple[Real, Real]:
    """Compute v and a from the contact, the profile's normal and its radius of curvature, in the ground's frame."""
    if isinstance(follower, TranslatingRoller):
        # The roller's centre moves along the offset curve, whose tangent is that of the profile.
        height, tangent = follower.height + s, 1j * normal
        across = height / tangent.imag * tangent.real
        v = follower.offset + across
        bend = np.hypot(height, across) ** 3 / (radius + follower.roller_radius)
        return v, np.asarray(height + (across * (v + across) - bend) / height)
    if isinstance(follower, OscillatingRoller):
        turn = -1j * follower.sense
        arm = -follower.arm * np.exp(turn * (follower.start_angle + s))
        p, tangent, swing = follower.pivot_distance + arm, 1j * normal, turn * arm
        v = -(1j * p * np.conj(tangent)).imag / (swing * np.conj(tangent)).imag
        # Tangent of the pitch curve in the ground's frame; |w|³ κ gives the equation for a.
        w = v * swing + 1j * p
        rest = (np.conj(w) * (-(v**2) * arm + 2j * v * swing - p)).imag
        bend = np.abs(w) ** 3 / (radius + follower.roller_radius)
        return np.asarray(v), np.asarray((bend - rest) / (np.conj(w) * swing).imag)
    if isinstance(follower, TranslatingFlat):
        return np.asarray(contact.imag), np.asarray(radius - follower.base_radius - s)
    angle = follower.start_angle + s
    x, y = follower.pivot_distance * np.cos(angle), follower.pivot_distance * np.sin(angle)
    reach = np.sqrt(np.abs(contact - follower.pivot_distance) ** 2 - follower.face_offset**2)
    v = follower.sense * (1.0 - x / reach)
    rate = 1.0 - follower.sense * v
    return np.asarray(v), np.asarray(((radius - y + follower.face_offset) * rate**2 + y * v**2) * rate / x)


def get_kernel_dimensions(follower: Follower) -> tuple[int, tuple[float, float, float], float]:
    """Return the kind of follower, its three lengths for the kernels, and its coordinate at zero displacement."""
    if isinstance(follower, TranslatingRoller):
        return TRANSLATING_ROLLER, (follower.offset, 0.0, follower.roller_radius), follower.height
    if isinstance(follower, OscillatingRoller):
        sizes = (follower.arm, follower.pivot_distance, follower.roller_radius)
        return OSCILLATING_ROLLER, sizes, follower.start_angle
    if isinstance(follower, TranslatingFlat):
        return TRANSLATING_FACE, (0.0, 0.0, 0.0), follower.base_radius
    return OSCILLATING_FACE, (0.0, follower.pivot_distance, follower.face_offset), follower.start_angle


def compute_motion_direction(follower: Follower, value: Real, contact: Complex) -> Complex:
    """Return the unit vector of the motion of the roller's centre or the face's contact, in the ground's frame."""
    if isinstance(follower, TranslatingRoller | TranslatingFlat):
        return np.ones_like(contact)
    turn = -1j * follower.sense
    if isinstance(follower, OscillatingFlat):
        arm = contact - follower.pivot_distance
        return np.asarray(turn * arm / np.abs(arm))
    return np.asarray(-turn * np.exp(turn * value))


@njit(cache=True, nogil=True)
def _compute_coordinate(x: float, y: float, kind: int, sizes: tuple[float, float, float]) -> float:
    """Return the follower's coordinate when it touches (x, y), −∞ where it cannot."""
    if kind == TRANSLATING_FACE:
        return x
    if kind == TRANSLATING_INNER_ROLLER:
        across = y - sizes[0]
        square = sizes[2] * sizes[2] - across * across
        # Only the half of the wall on the roller's side of the centre can be touched from inside.
        return math.sqrt(square) - x if square >= 0.0 and x > 0.0 else -math.inf
    if kind == TRANSLATING_ROLLER:
        across = y - sizes[0]
        square = sizes[2] * sizes[2] - across * across
        return x + math.sqrt(square) if square >= 0.0 else -math.inf
    dx = sizes[1] - x
    distance = math.hypot(dx, y)
    beta = math.atan2(y, dx)
    if kind == OSCILLATING_FACE:
        share = sizes[2] / distance
        return beta + math.asin(share) if abs(share) <= 1.0 else -math.inf
    share = (sizes[0] * sizes[0] + distance * distance - sizes[2] * sizes[2]) / (2.0 * sizes[0] * distance)
    if kind == OSCILLATING_INNER_ROLLER:
        return math.acos(share) - beta if abs(share) <= 1.0 and beta > 0.0 else -math.inf
    return beta + math.acos(share) if abs(share) <= 1.0 else -math.inf


@njit(cache=True, nogil=True)
def _evaluate_point(curves: Complex, piece: int, share: float, turn: complex, flipped: bool) -> tuple[float, float]:
    """Return a point of the profile in the ground's frame."""
    z = curves[piece, STENCIL_SIZE - 1]
    for k in range(STENCIL_SIZE - 2, -1, -1):
        z = z * share + curves[piece, k]
    z *= turn
    return z.real, -z.imag if flipped else z.imag


@njit(cache=True, nogil=True)
def _evaluate_coordinate(
    curves: Complex, base: int, t: float, turn: complex, flipped: bool, kind: int, sizes: tuple[float, float, float]
) -> float:
    """Return the coordinate required at t chords from the point ``base``, −1 ≤ t ≤ 1."""
    n = curves.shape[0]
    piece, share = (base, t) if t >= 0.0 else ((base - 1) % n, t + 1.0)
    x, y = _evaluate_point(curves, piece, share, turn, flipped)
    return _compute_coordinate(x, y, kind, sizes)


@njit(cache=True, nogil=True)
def _find_touch(
    curves: Complex, coordinates: Real, turn: complex, flipped: bool, kind: int, sizes: tuple[float, float, float]
) -> tuple[float, int, float]:
    """Find the maximum coordinate over the profile: refine every local maximum over the points by golden section."""
    n = curves.shape[0]
    for k in range(n):
        z = curves[k, 0] * turn
        coordinates[k] = _compute_coordinate(z.real, -z.imag if flipped else z.imag, kind, sizes)
    best, where, share = -math.inf, 0, 0.0
    # All local maxima are refined, since the largest sample need not belong to the largest maximum.
    for k in range(n):
        here = coordinates[k]
        if here == -math.inf or here < coordinates[k - 1] or here < coordinates[(k + 1) % n]:
            continue
        low, high = -1.0, 1.0
        left, right = high - GOLDEN_RATIO * (high - low), low + GOLDEN_RATIO * (high - low)
        at_left = _evaluate_coordinate(curves, k, left, turn, flipped, kind, sizes)
        at_right = _evaluate_coordinate(curves, k, right, turn, flipped, kind, sizes)
        for _ in range(GOLDEN_SECTION_STEPS):
            if at_left < at_right:
                low, left, at_left = left, right, at_right
                right = low + GOLDEN_RATIO * (high - low)
                at_right = _evaluate_coordinate(curves, k, right, turn, flipped, kind, sizes)
            else:
                high, right, at_right = right, left, at_left
                left = high - GOLDEN_RATIO * (high - low)
                at_left = _evaluate_coordinate(curves, k, left, turn, flipped, kind, sizes)
        found, t = (at_left, left) if at_left > at_right else (at_right, right)
        # The two neighbouring curves meet at the point, where their maximum may be a corner.
        if here > found:
            found, t = here, 0.0
        if found > best:
            best = found
            where, share = (k, t) if t >= 0.0 else ((k - 1) % n, t + 1.0)
    return best, where, share


@njit(cache=True, nogil=True)
def _measure_edge_offset(x: float, y: float, kind: int, sizes: tuple[float, float, float]) -> tuple[float, float]:
    """Return the distance of a point from the path of a knife edge, and the edge's coordinate at the foot."""
    if kind == TRANSLATING_ROLLER:
        return y - sizes[0], x
    dx = sizes[1] - x
    return math.hypot(dx, y) - sizes[0], math.atan2(y, dx)


@njit(cache=True, nogil=True)
def _find_edge_crossing(
    curves: Complex, turn: complex, flipped: bool, kind: int, sizes: tuple[float, float, float]
) -> tuple[float, int, float]:
    """Find the farthest crossing of a knife edge's path with the profile."""
    best, where, share = -math.inf, 0, 0.0
    for k in range(curves.shape[0]):
        a, _ = _measure_edge_offset(*_evaluate_point(curves, k, 0.0, turn, flipped), kind, sizes)
        b, _ = _measure_edge_offset(*_evaluate_point(curves, k, 1.0, turn, flipped), kind, sizes)
        # Both ends on the same side of the edge's path: no crossing on this chord.
        if (a > 0.0) == (b > 0.0):
            continue
        low, high = 0.0, 1.0
        # Bisection to the last bit of a double.
        for _ in range(60):
            middle = 0.5 * (low + high)
            m, _ = _measure_edge_offset(*_evaluate_point(curves, k, middle, turn, flipped), kind, sizes)
            if (m > 0.0) == (a > 0.0):
                low = middle
            else:
                high = middle
        _, found = _measure_edge_offset(*_evaluate_point(curves, k, low, turn, flipped), kind, sizes)
        if found > best:
            best, where, share = found, k, low
    return best, where, share


@njit(cache=True, nogil=True)
def _lay_follower(
    curves: Complex,
    angles: Real,
    kind: int,
    sizes: tuple[float, float, float],
    flipped: bool,
    edge: bool,
    values: Real,
    pieces: NDArray[np.int64],
    shares: Real,
) -> None:
    """Fill the follower's position at each cam angle, and the piece and its share where it touches."""
    asked = np.empty(curves.shape[0])
    for i in range(angles.size):
        turn = complex(math.cos(angles[i]), -math.sin(angles[i]))
        if edge:
            best, where, share = _find_edge_crossing(curves, turn, flipped, kind, sizes)
        else:
            best, where, share = _find_touch(curves, asked, turn, flipped, kind, sizes)
        values[i] = best if best > -math.inf else math.nan
        pieces[i], shares[i] = where, share


@njit(cache=True, nogil=True)
def _find_crossings(points: Complex, found: Complex) -> int:
    """Find crossings of chords that are not neighbours, at most as many as the array holds."""
    n = points.size
    count = 0
    for i in range(n):
        a, b = points[i], points[(i + 1) % n]
        left, right = min(a.real, b.real), max(a.real, b.real)
        low, high = min(a.imag, b.imag), max(a.imag, b.imag)
        for k in range(i + 2, n):
            # The last chord is a neighbour of the first.
            if i == 0 and k == n - 1:
                continue
            c, d = points[k], points[(k + 1) % n]
            # Bounding boxes first: most pairs of chords are far from each other.
            if max(c.real, d.real) < left or min(c.real, d.real) > right:
                continue
            if max(c.imag, d.imag) < low or min(c.imag, d.imag) > high:
                continue
            u, v, w = b - a, d - c, c - a
            area = u.real * v.imag - u.imag * v.real
            # Parallel chords: overlapping ones are reported by their neighbours.
            if area == 0.0:
                continue
            s = (w.real * v.imag - w.imag * v.real) / area
            t = (w.real * u.imag - w.imag * u.real) / area
            if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0 and count < found.size:
                found[count] = a + s * u
                count += 1
    return count
