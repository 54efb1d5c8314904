"""Parts of a mechanism in motion: their distances at given inputs, and bounds of their motion around these."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.errors import DimensionError
from kinematics.linkage.clearance.enclosures import bound_approaches, bound_by_closures, bound_by_theorem
from kinematics.linkage.clearance.outlines import OVERLAP_DEPTH, Part, build_stretches, measure_distances
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.planar.program import build_program, compute_unit_frame
from kinematics.linkage.planar.triads import Loops, build_loop_equations

Pairs = Sequence[tuple[int, int]]

JOINT_TOLERANCE = 1e-12
"""Share of the size within which a single point counts as lying at a joint: rounding."""

MAX_CELLS = 400_000
"""Maximum number of initial parts of a range over all pairs: a sweep holds arrays of this length in memory."""

INITIAL_HALF_WIDTH = 0.05
"""Maximum half-width of the initial parts of a range: radians, or a share of the mechanism's size along an input
slide."""


class RangeError(DimensionError):
    """A range of the input that is too long to sweep; ``most`` is the longest that would be accepted."""

    def __init__(self, length: float, most: float) -> None:
        super().__init__("kinematics-input-range", "kinematics-at-most-long", length, most=f"{most:.4g}")
        self.most = most
        # Arguments with which pickle creates a copy.
        self.args = length, most


class _Pose(NamedTuple):
    """A mechanism at n inputs: joints in unit coordinates (joints, n), rotations of the links and e^{iφ} (links, n)."""

    places: Complex
    rotations: Real
    turn: Complex
    valid: NDArray[np.bool_]


class Scene:
    """Parts of a mechanism in the kernels' layout.

    Attributes
    ----------
    size : float
        Size of the mechanism, in length units.
    unit : float
        Unit of the input: 1 radian, or the size along a slide.
    pairs : int, shape (p, 2)
    overlaps : float, shape (p,)
        Distance assigned to each pair whose cores intersect: minus the sum of the radii, and a little more.
    """

    def __init__(self, mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs) -> None:
        if mechanism.shape != ():
            raise DimensionError("mechanism", "kinematics-single-design", mechanism.shape)
        for part in parts:
            if part.link not in mechanism.links:
                raise DimensionError("kinematics-part-link", "kinematics-link-of-mechanism", part.link)
            if not len(part.points) or not np.isfinite(part.points).all():
                raise DimensionError("kinematics-part-points", "kinematics-finite-points", part.points)
            if not 0.0 <= part.radius < np.inf:
                raise DimensionError("kinematics-part-radius", "kinematics-zero-or-more", part.radius)
        self._mechanism = mechanism
        self._program, frame = build_program(mechanism), compute_unit_frame(mechanism)
        self.size, self._origin = float(frame.size), complex(frame.origin)
        self.unit = self.size if mechanism.has_slide_input else 1.0
        self.pairs = np.asarray(pairs, np.int64)
        links, joints = self._program.links, list(mechanism.joints)
        place = self._program.code.joints[0]
        self._on = np.array([[joint in mechanism.links[link] for joint in joints] for link in links])
        self._pins = self._on.argmax(axis=1)
        self._links = np.array([links.index(part.link) for part in parts], np.int64)
        points = [(np.asarray(part.points, np.complex128) - self._origin) / self.size for part in parts]
        self._vertices = np.concatenate(points)
        self._starts = np.concatenate([[0], np.cumsum([len(own) for own in points])])
        self._stretches = build_stretches(self._vertices, self._starts)
        # Distance of a part's vertices from each joint: the lever of a rotation about that joint.
        self._reach = np.array([[np.abs(own - joint).max() for joint in place] for own in points])
        # A disc about a joint of its link belongs to every link of that joint.
        discs = np.array([len(own) == 1 for own in points])
        about = discs[:, None] & self._on[self._links] & (self._reach <= JOINT_TOLERANCE)
        self._reach[about] = 0.0
        self._carries = about @ self._on.T
        self._carries[np.arange(len(parts)), self._links] = True
        self._radii = np.array([part.radius for part in parts])[self.pairs].sum(axis=1)
        self.overlaps = -self._radii - OVERLAP_DEPTH * self.size
        self._loops: Loops | None = None
        if self._program.class_iii:
            self._loops = build_loop_equations(mechanism, dict(zip(joints, place.tolist(), strict=True)))

    def divide_range(self, low: float, high: float) -> tuple[Real, Real]:
        """Divide a range into equal parts of at most the initial width; return their middles and half-widths.

        Raises
        ------
        RangeError
            For a range that would need more than :data:`MAX_CELLS` parts for all pairs together.
        """
        if not (np.isfinite(low) and np.isfinite(high) and low <= high):
            raise DimensionError("kinematics-input-range", "kinematics-ordered-ends", (low, high))
        most = 2.0 * INITIAL_HALF_WIDTH * self.unit * (MAX_CELLS // max(len(self.pairs), 1))
        if high - low > most:
            raise RangeError(high - low, most)
        count = max(int(np.ceil((high - low) / (2.0 * INITIAL_HALF_WIDTH * self.unit))), 1)
        half = 0.5 * (high - low) / count
        return np.asarray(low + half * (2.0 * np.arange(count) + 1.0), np.float64), np.full(count, half)

    def distances(self, pair: Integers, centre: Real, half: Real) -> tuple[Real, Real]:
        """Measure distances of pairs at inputs (NaN without a position), and bound their decrease nearby.

        Parameters
        ----------
        pair : int, shape (m,)
            Indices into :attr:`pairs`.
        centre, half : float, shape (m,)
            Inputs, and half the range of the input around them.

        Returns
        -------
        distance, bound : float, shape (m,)
            Distances of the outlines, and bounds of their decrease, in length units. An unknown bound is infinite.
        """
        # Pairs share positions: each distinct (input, half-width) is driven once, packed into a complex number.
        around, item = np.unique(centre + 1j * half, return_inverse=True)
        inputs, halves = around.real.copy(), around.imag.copy()
        pose = self._evaluate_pose(inputs)
        shift = self._compute_shifts(pose)
        items = np.stack([pair, item], axis=1)
        cores = self._vertices, self._starts, self._links, self.pairs
        apart = measure_distances(*cores, items, pose.turn, shift, self._stretches)
        # No position, no distance.
        apart[~pose.valid[item]] = np.nan
        nearer = bound_approaches(
            self._on, self._carries, self._reach, self.pairs, items, *self._bound_moves(pose, halves)
        )
        return self.size * apart - self._radii[pair], self.size * nearer

    def has_position(self, inputs: Real) -> NDArray[np.bool_]:
        """Return whether the mechanism has a position at each input."""
        return self._evaluate_pose(inputs).valid

    def carry_points(self, part: int, points: Complex, inputs: Real) -> Complex:
        """Carry points with a part to inputs; return them in length units, shape (n, points), NaN without a position.

        ``points``, shape (points,), are those of the reference configuration.
        """
        pose, link = self._evaluate_pose(inputs), self._links[part]
        shift = self._compute_shifts(pose)[link][:, None]
        moved = pose.turn[link][:, None] * ((points - self._origin) / self.size) + shift
        return np.asarray(np.where(pose.valid[:, None], self._origin + self.size * moved, np.nan))

    def _compute_shifts(self, pose: _Pose) -> Complex:
        """Compute the displacements (links, n) that follow the rotations of links about the origin."""
        shift = np.asarray(pose.places[self._pins] - pose.turn * self._program.code.joints[0][self._pins, None])
        # The ground does not move: remove the rounding errors of the formula.
        shift[0] = 0.0
        return shift

    def _evaluate_pose(self, inputs: Real) -> _Pose:
        """Drive the mechanism to inputs, shape (n,), and return its pose."""
        code, links = self._program.code, self._program.links
        motion = drive(self._mechanism, inputs, order=0)
        places = np.stack([motion.joints[name][0] for name in self._mechanism.joints]) - self._origin
        angles = np.stack([np.zeros(len(inputs)), *(motion.angles[link][0] for link in links[1:])])
        rotations = angles - code.link_angles[0][:, None]
        return _Pose(places / self.size, rotations, np.exp(1j * rotations), motion.valid)

    def _bound_moves(self, pose: _Pose, half: Real) -> tuple[Real, Real]:
        """Bound the rotations of links and the displacements of joints, (links, n) and (joints, n)."""
        code, links = self._program.code, self._program.links
        turned = np.full(pose.rotations.shape, np.pi)
        if self._loops is not None:
            unknown = [links.index(link) for link in self._loops.links]
            turned[unknown] = bound_by_theorem(self._loops, pose.rotations[unknown], half)
        moved = np.empty(pose.places.shape)
        bound_by_closures(
            code.rows, code.ratios, code.gives, self._on, code.joints[0], code.lines[0], code.line_angles[0],
            code.driver, pose.places, pose.turn, half / self.unit, turned, moved,
        )  # fmt: skip
        return turned, moved
