"""The requested motion program: start and end of each segment, and contradictions there.

Written without numpy, because requests are checked before the numerical libraries are loaded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from kinematics.message import compose
from synthesis.kinds.cam.statement.segment_ends import (
    MIRROR_LAWS,
    Conditions,
    State,
    compute_law_ends,
    compute_polynomial_ends,
    compute_polynomial_range,
)
from synthesis.kinds.cam.statement.segments import ConstantVelocity, DisplacementBand, Dwell, Move, Polynomial, Segment
from synthesis.model.problem import Contradiction

TURN_TOLERANCE = 1e-7
"""Permitted deviation of the segments' sum from a full turn, degrees: rounding of angles such as 360/7."""

JUMP_TOLERANCE = 1e-6
"""Maximum jump at a joint that counts as continuous, relative to the segments' own rates."""


@dataclass(frozen=True)
class ProgramStatement:
    """The sequence of requested segments, with the unit of their displacements.

    ``displacement_unit`` is the factor from requested displacements to the solver's: radians of an arm, or lengths.
    """

    segments: Sequence[Segment]
    displacement_unit: float

    def convert_conditions(self, segment: Polynomial | Move) -> Conditions:
        """Return a segment's conditions in radians and the solver's displacements.

        A polynomial without a displacement at its start has that at which the previous segment ends.
        """
        start = None
        if isinstance(segment, Polynomial) and not _has_start(segment):
            position = next((k for k, other in enumerate(self.segments) if other is segment), 0)
            start = self.heights()[position - 1][1] if position else None
        return self._convert_conditions(segment, start)

    def _convert_conditions(self, segment: Polynomial | Move, start: float | None) -> Conditions:
        unit = self.displacement_unit
        stated = [
            (math.radians(condition.angle), order, value * (unit if order == 0 else 1.0))
            for condition in segment.conditions
            for order, value in condition.values()
        ]
        return stated if start is None else [(0.0, 0, start), *stated]

    def heights(self) -> list[tuple[float, float]]:
        """Return the displacement at start and end of each segment, in the solver's unit; the first begins at zero.

        A polynomial begins and ends at the values that its conditions determine, or where the previous segment ends.
        """
        heights: list[tuple[float, float]] = []
        at = 0.0
        for segment in self.segments:
            end = at
            if isinstance(segment, Polynomial):
                start = at if heights and not _has_start(segment) else None
                conditions = self._convert_conditions(segment, start)
                ends = compute_polynomial_ends(math.radians(segment.angle), conditions)
                at, end = (at, at) if ends is None else (ends[0][0], ends[1][0])
            elif isinstance(segment, ConstantVelocity):
                end = at + segment.lift * self.displacement_unit
            elif isinstance(segment, Move):
                lift = at if segment.lift is None else segment.lift * self.displacement_unit
                end = at + lift if segment.motion == "rise" else at - lift
            heights.append((at, end))
            at = end
        return heights

    def _compute_ranges(self) -> list[tuple[float, float]]:
        """Return the displacement range of each segment; a polynomial may rise and fall between two equal ends."""
        ranges = [(min(pair), max(pair)) for pair in self.heights()]
        for k, segment in enumerate(self.segments):
            if isinstance(segment, Polynomial):
                conditions = self.convert_conditions(segment)
                ranges[k] = compute_polynomial_range(math.radians(segment.angle), conditions) or ranges[k]
        return ranges

    @property
    def travel(self) -> float:
        """Distance from the lowest to the highest displacement, in the solver's unit."""
        ranges = self._compute_ranges()
        return max(high for _, high in ranges) - min(low for low, _ in ranges)

    def _travels(self) -> bool:
        """Return whether the program leaves its first displacement by more than rounding."""
        return self.travel > JUMP_TOLERANCE * max(abs(end) for pair in self.heights() for end in pair)

    def list_laws(self) -> list[str]:
        """Return the law of each segment, or its motion if it has no law.

        In textbooks, the fall that mirrors a rise has the name of the rise. A fall with such a name is therefore the
        mirrored law, unless only the other one, which begins without acceleration, joins its neighbours.
        """
        stated = [segment.law if isinstance(segment, Move) else segment.motion for segment in self.segments]
        laws = [
            MIRROR_LAWS.get(law, law) if segment.motion in ("fall", "return") else law
            for segment, law in zip(self.segments, stated, strict=True)
        ]
        for k, law in enumerate(stated):
            if laws[k] != law and not self._is_smooth_at(k, laws):
                other = [*laws[:k], law, *laws[k + 1 :]]
                # Keep the mirrored law unless only the other one joins both neighbours.
                laws = other if self._is_smooth_at(k, other) else laws
        return laws

    def compute_ends(self) -> list[tuple[State, State] | None]:
        """Return s, v, a at both ends of each segment; None for automatic and optimal motions, whose ends adapt."""
        return self._compute_ends_by_laws(self.list_laws())

    def _compute_ends_by_laws(self, laws: Sequence[str]) -> list[tuple[State, State] | None]:
        ends: list[tuple[State, State] | None] = []
        for segment, law, (start, end) in zip(self.segments, laws, self.heights(), strict=True):
            angle = math.radians(segment.angle)
            if isinstance(segment, Polynomial):
                ends.append(compute_polynomial_ends(angle, self.convert_conditions(segment)))
            elif isinstance(segment, ConstantVelocity):
                ends.append(compute_law_ends("constant_velocity", angle, start, end))
            elif isinstance(segment, Dwell):
                ends.append(((start, 0.0, 0.0), (end, 0.0, 0.0)))
            elif segment.follows_criterion:
                ends.append(None)
            else:
                ends.append(compute_law_ends(law, angle, start, end))
        return ends

    def find_segment_contradictions(self) -> list[Contradiction]:
        """Return the errors within a segment."""
        contradictions = []
        heights = self.heights()
        for k, segment in enumerate(self.segments):
            where = f"/segments/{k}"
            if isinstance(segment, Move):
                if segment.lift is None and segment.motion != "return":
                    contradictions.append(
                        Contradiction(f"{where}/lift", compose("cam-lift-missing", motion=segment.motion))
                    )
                elif segment.lift is None and heights[k][0] <= 0.0:
                    contradictions.append(Contradiction(f"{where}/lift", compose("cam-return-from-zero")))
                for name in ("conditions", "bands"):
                    if getattr(segment, name) and segment.law != "optimal":
                        contradictions.append(Contradiction(f"{where}/{name}", compose("cam-only-for-optimal-motion")))
                for n, band in enumerate(segment.bands):
                    contradictions += _find_band_errors(f"{where}/bands/{n}", band, segment.angle)
            if isinstance(segment, Move | Polynomial):
                for n, condition in enumerate(segment.conditions):
                    # At the ends of a move the neighbours fix the state; a condition there would be redundant or
                    # contradictory.
                    inner = isinstance(segment, Move)
                    if condition.angle > segment.angle or (inner and condition.angle in (0.0, segment.angle)):
                        detail = compose("cam-condition-outside-segment", angle=f"{segment.angle:g}")
                        contradictions.append(Contradiction(f"{where}/conditions/{n}/angle", detail))
                    if not condition.values():
                        contradictions.append(Contradiction(f"{where}/conditions/{n}", compose("cam-condition-empty")))
            if isinstance(segment, Polynomial) and not contradictions:
                conditions = self.convert_conditions(segment)
                if compute_polynomial_ends(math.radians(segment.angle), conditions) is None:
                    contradictions.append(Contradiction(f"{where}/conditions", compose("cam-conditions-dependent")))
        # A polynomial with one given height may still move to it from the height at which the previous segment ends.
        moves = any(_has_motion(segment) for segment in self.segments) or self._travels()
        if not contradictions and not moves:
            contradictions.append(Contradiction("/segments", compose("cam-follower-rests")))
        return contradictions

    def find_joint_contradictions(self, accept_discontinuity: bool, grooved: bool) -> list[Contradiction]:
        """Return the errors of segments that do not add up to one turn, or do not join as a cam's program must."""
        return [*self._check_turn(), *self._check_joints(accept_discontinuity, grooved)]

    def _check_turn(self) -> list[Contradiction]:
        total = math.fsum(segment.angle for segment in self.segments)
        if abs(total - 360.0) > TURN_TOLERANCE:
            return [Contradiction("/segments", compose("cam-angles-not-one-turn", total=f"{total:.12g}"))]
        return []

    def _compute_scale(self) -> float:
        """Return the size of displacements, the scale for jumps."""
        longest = max(high - low for low, high in self._compute_ranges())
        return longest or max(abs(a) for a, _ in self.heights()) or 1.0

    def _compute_jumps(self, joint: int, ends: Sequence[tuple[State, State] | None]) -> tuple[float, float]:
        """Return the steps of v and a at a joint; 0 if they are rounding, or if one segment adapts to the other."""
        before, after = ends[joint], ends[(joint + 1) % len(ends)]
        if before is None or after is None:
            return 0.0, 0.0
        travel, least = self._compute_scale(), min(math.radians(segment.angle) for segment in self.segments)
        steps = [after[0][order] - before[1][order] for order in (1, 2)]
        velocity, acceleration = (
            step if abs(step) > JUMP_TOLERANCE * travel / least**order else 0.0 for order, step in enumerate(steps, 1)
        )
        return velocity, acceleration

    def _is_smooth_at(self, k: int, laws: Sequence[str]) -> bool:
        """Return whether v and a of a segment are continuous with both neighbours."""
        ends = self._compute_ends_by_laws(laws)
        return not any((*self._compute_jumps(k - 1, ends), *self._compute_jumps(k, ends)))

    def _check_joints(self, accept_discontinuity: bool, grooved: bool) -> list[Contradiction]:
        """Return the joints with a jump of s, an impossible jump of v, or a jump of v or a that is not accepted."""
        heights, ends = self.heights(), self.compute_ends()
        contradictions = []
        for k, segment in enumerate(self.segments):
            n = (k + 1) % len(self.segments)
            following = self.segments[n]
            joint: dict[str, str | int] = {
                "segment": k,
                "motion": segment.motion,
                "following": n,
                "following_motion": following.motion,
            }
            gap = heights[n][0] - heights[k][1]
            if abs(gap) > JUMP_TOLERANCE * self._compute_scale():
                gap /= self.displacement_unit
                fault = "cam-program-does-not-close" if n == 0 else "cam-displacement-jumps"
                contradictions.append(Contradiction(f"/segments/{n}", compose(fault, jump=f"{gap:.6g}", **joint)))
                continue
            velocity, acceleration = self._compute_jumps(k, ends)
            # At a downward jump, or in a groove, the roller would have to turn at an edge: contact cannot be kept.
            needs_edge = velocity < 0.0 or bool(velocity and grooved)
            if accept_discontinuity and not needs_edge:
                continue
            fault = "cam-joint-needs-edge" if needs_edge else "cam-joint-breaks-fundamental-law"
            for name, jump in (("velocity", velocity), ("acceleration", acceleration)):
                if jump:
                    detail = compose(fault, derivative=name, jump=f"{jump:.6g}", **joint)
                    contradictions.append(Contradiction(f"/segments/{n}", detail))
                    break
        if not contradictions and not accept_discontinuity:
            contradictions += self._find_inner_jumps()
        return contradictions

    def _find_inner_jumps(self) -> list[Contradiction]:
        """Return contradictions for laws with a jump of the acceleration in the middle."""
        return [
            Contradiction(
                f"/segments/{k}/law",
                compose("cam-law-jumps", law=segment.law),
            )
            for k, segment in enumerate(self.segments)
            if isinstance(segment, Move) and segment.law == "constant_acceleration"
        ]


def _find_band_errors(where: str, band: DisplacementBand, angle: float) -> list[Contradiction]:
    if band.lower is None and band.upper is None:
        return [Contradiction(where, compose("cam-band-unbounded"))]
    if not band.start < band.end <= angle:
        return [Contradiction(f"{where}/end", compose("cam-band-end-outside", angle=f"{angle:g}"))]
    if band.lower is not None and band.upper is not None and band.lower > band.upper:
        return [Contradiction(f"{where}/upper", compose("cam-band-empty"))]
    return []


def _has_start(segment: Polynomial) -> bool:
    """Return whether a polynomial states the displacement at its start."""
    return any(condition.angle == 0.0 and condition.s is not None for condition in segment.conditions)


def _has_motion(segment: Segment) -> bool:
    """Return whether the follower moves in a segment; the lowest-degree polynomial through one value is constant."""
    if isinstance(segment, Polynomial):
        stated = [pair for condition in segment.conditions for pair in condition.values()]
        return len({value for order, value in stated if order == 0}) > 1 or any(x for order, x in stated if order)
    return isinstance(segment, Move) or (isinstance(segment, ConstantVelocity) and segment.lift != 0.0)
