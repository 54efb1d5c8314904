"""The motion program of a cam: segments once around, their motion at any angle, exact peaks, and the joints.

The fundamental law of cam design (Norton §8.3): displacement, velocity and acceleration are continuous all around, so
that the jerk is finite everywhere.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from kinematics.arrays import Real
from kinematics.cam.motion.extremes import Extremes, find_extremes
from kinematics.cam.motion.pieces import MOTION_VALUE_COUNT, Motion, Pieces, join_pieces
from kinematics.cam.motion.segments import Segment
from kinematics.errors import DimensionError

TURN = 2.0 * math.pi

CLOSURE_TOLERANCE = 1e-9
"""Radians by which the segments' angles may miss a full turn: rounding of degrees, invisible on a cam."""

CONTINUITY_TOLERANCE = 1e-6
"""Jump, relative to the derivative's largest value, up to which it counts as continuous: requests carry about seven
digits, and a cam no more."""

MIN_DERIVATIVE_JUMP = 1e-6
"""Jump of a derivative, relative to its largest value at the breaks, above which a break counts as a bend."""

MIN_SHARP_JUMP = 0.03
"""Relative jump above which no curve may be fitted across a bend. Optimal motions have hundreds of smaller jumps, the
steps of a control that changes gradually."""


@dataclass(frozen=True)
class Joint:
    """Continuity where two segments meet, or at a jump within one.

    Parameters
    ----------
    angle : float
        Angle from the program's start; the last segment meets the first one at 0.
    segments : tuple of two ints
        The segment that ends and the one that begins; equal within a segment.
    before, after : tuple of four floats
        s, v, a, j on either side.
    continuous : tuple of four bools
        Whether each of them is the same on both sides.
    """

    angle: float
    segments: tuple[int, int]
    before: tuple[float, float, float, float]
    after: tuple[float, float, float, float]
    continuous: tuple[bool, bool, bool, bool]

    @property
    def jump(self) -> tuple[float, ...]:
        """Jumps of s, v, a, j."""
        return tuple(after - before for before, after in zip(self.before, self.after, strict=True))


@dataclass(frozen=True, eq=False)
class Program:
    """A motion program, periodic over one turn of the cam.

    Parameters
    ----------
    segments : sequence of Segment
        Any number of segments, in order from cam angle 0; their angles sum to one turn.

    Raises
    ------
    DimensionError
        If there is no segment, or the angles do not sum to 2π.
    """

    segments: Sequence[Segment]

    def __post_init__(self) -> None:
        total = math.fsum(segment.angle for segment in self.segments)
        # "not <=" also rejects NaN.
        if not abs(total - TURN) <= CLOSURE_TOLERANCE:
            raise DimensionError("kinematics-segment-angles", "kinematics-one-turn", math.degrees(total))

    @cached_property
    def pieces(self) -> Pieces:
        """All segments as one function from 0 to 2π."""
        pieces = join_pieces([segment.pieces for segment in self.segments])
        # Remove the rounding of the sum, so that the last break is exactly a full turn.
        pieces.start[-1] = TURN
        return pieces

    @property
    def breaks(self) -> Real:
        """Angles between which s and all its derivatives are smooth, from 0 to 2π; shape (n + 1,)."""
        return self.pieces.start

    @property
    def bends(self) -> Real:
        """Angles at which a derivative up to the fifth jumps, ascending from 0 and less than 2π."""
        return np.asarray(self.breaks[:-1][self._jumps > MIN_DERIVATIVE_JUMP])

    @property
    def sharp_bends(self) -> Real:
        """The bends across which no curve may be fitted, see :data:`MIN_SHARP_JUMP`."""
        return np.asarray(self.breaks[:-1][self._jumps > MIN_SHARP_JUMP])

    @cached_property
    def velocity_jumps(self) -> Real:
        """Angles at which the velocity jumps, ascending from 0 and less than 2π."""
        # At angle 0 the value before the break is the one at the end of the turn.
        before = self.pieces.motion(np.append(TURN, self.breaks[1:-1]), before=True).v
        after = self.pieces.motion(self.breaks[:-1]).v
        return np.asarray(self.breaks[:-1][np.abs(after - before) > CONTINUITY_TOLERANCE * self.peaks[1].largest])

    @cached_property
    def _jumps(self) -> Real:
        """Largest relative jump of any derivative at each break except the last, see :data:`MIN_DERIVATIVE_JUMP`."""
        # The second derivative's own a and j are the fourth and fifth derivatives of s.
        fourth = self.pieces.derivative().derivative()
        before, after = (
            np.array([*self.pieces.motion(at, before=side), *fourth.motion(at, before=side)[2:]])
            for at, side in ((np.append(TURN, self.breaks[1:-1]), True), (self.breaks[:-1], False))
        )
        size = np.maximum(np.abs(before), np.abs(after)).max(axis=1, keepdims=True)
        return np.asarray((np.abs(after - before) / np.where(size > 0.0, size, 1.0)).max(axis=0))

    @cached_property
    def joints(self) -> Real:
        """Angles where the segments begin, and 2π; shape (segments + 1,)."""
        counts = np.cumsum([0, *(segment.pieces.count for segment in self.segments)])
        return np.asarray(self.pieces.start[counts])

    def motion(self, angle: ArrayLike, *, before: bool = False) -> Motion:
        """Return s, v, a, j at cam angles of any shape; at a joint the values after it unless ``before``."""
        at = np.mod(np.asarray(angle, dtype=np.float64), TURN)
        # np.mod rounds a small negative angle up to a whole turn.
        at = np.where(at == 0.0, TURN, at) if before else np.where(at == TURN, 0.0, at)
        return self.pieces.motion(at, before=before)

    @cached_property
    def peaks(self) -> tuple[Extremes, Extremes, Extremes, Extremes]:
        """Exact extremes of s, v, a, j with their angles, both sides of every joint included."""
        return self._find_peak(0), self._find_peak(1), self._find_peak(2), self._find_peak(3)

    def _find_peak(self, order: int) -> Extremes:
        return find_extremes(lambda angle: self.pieces.motion(angle)[order], self.breaks)

    @property
    def lift(self) -> float:
        """The follower's whole travel."""
        return self.peaks[0].greatest - self.peaks[0].least

    @cached_property
    def continuity(self) -> tuple[Joint, ...]:
        """Every joint of two segments, the last with the first one included, and every inner jump of s, v or a."""
        counts = np.cumsum([0, *(segment.pieces.count for segment in self.segments)])
        before = np.array(self.pieces.motion(np.append(self.breaks[1:-1], TURN), before=True))
        after = np.array(self.pieces.motion(np.append(self.breaks[1:-1], 0.0)))
        # Each derivative has its own scale; the displacement's scale is the lift.
        allowed = CONTINUITY_TOLERANCE * np.array([self.lift, *(peak.largest for peak in self.peaks[1:])])
        same = np.abs(after - before) <= allowed[:, None]
        found = []
        for piece in range(self.pieces.count):
            index = int(np.searchsorted(counts, piece, side="right")) - 1
            following = int(np.searchsorted(counts, piece + 1, side="right")) - 1
            # Inner breaks of a law, where only the jerk jumps, are no joints.
            if index == following and same[:3, piece].all():
                continue
            s, v, a, j = (bool(value) for value in same[:, piece])
            found.append(
                Joint(
                    float(self.breaks[piece + 1]) % TURN,
                    (index, following % len(self.segments)),
                    _as_four_floats(before[:, piece]),
                    _as_four_floats(after[:, piece]),
                    (s, v, a, j),
                )
            )
        return tuple(found)

    @property
    def smoothness(self) -> int:
        """How many of s, v, a, j, counted in this order, are continuous at every joint."""
        for order in range(MOTION_VALUE_COUNT):
            if not all(joint.continuous[order] for joint in self.continuity):
                return order
        return MOTION_VALUE_COUNT

    @property
    def obeys_fundamental_law(self) -> bool:
        """Whether s, v and a are continuous all around."""
        return self.smoothness >= 3


def _as_four_floats(values: Real) -> tuple[float, float, float, float]:
    s, v, a, j = (float(value) for value in values)
    return s, v, a, j
