"""Cams: a motion program, a follower, limits, and what is made least.

Angles are degrees of cam rotation. Displacements are lengths, or degrees of an oscillating follower's arm; their
derivatives are by the radian of cam rotation (length/rad, length/rad², …; rad/rad, … for an arm).
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import ConfigDict, Discriminator, Field

from synthesis.kinds.cam.joints import Conditions, State, law_ends, polynomial_ends
from synthesis.model.dimension import (
    ACCELERATION,
    ANGLE,
    DISPLACEMENT,
    FORCE,
    JERK,
    LENGTH,
    MASS,
    ROTATIONAL_SPEED,
    STIFFNESS,
    VELOCITY,
)
from synthesis.model.statement import (
    Contradiction,
    Coordinate,
    Count,
    Flag,
    NonNegative,
    Number,
    PositiveLength,
    PositiveNumber,
    Sizable,
    StatedProblem,
    Statement,
)

WHOLE_TURN = 1e-7
"""Degrees by which the segments may miss a full turn: rounding of angles like 360/7."""

SMOOTH = 1e-6
"""Jump at a joint, relative to the segments' own rates, up to which it is continuous."""

Span = Annotated[float, ANGLE, Field(strict=True, ge=1e-4, le=360.0, allow_inf_nan=False)]
"""Of a segment, degrees: shorter ones are below what any shaft is set to, and rates over them are rounding."""


Law = Literal[
    "auto",
    "optimal",
    "constant_velocity",
    "constant_acceleration",
    "simple_harmonic",
    "cycloidal",
    "trapezoidal",
    "modified_trapezoid",
    "modified_sine",
    "modified_constant_velocity",
    "polynomial_23",
    "polynomial_345",
    "polynomial_4567",
    "polynomial_456789",
    "eighth_power",
    "eighth_power_reversed",
    "double_harmonic",
    "double_harmonic_reversed",
    "half_harmonic_start",
    "half_harmonic_end",
    "half_cycloidal_start",
    "half_cycloidal_end",
]
"""Laws by their names; ``auto`` takes the best of them by the criterion, ``optimal`` the best of all motions."""


class ProgramCondition(Statement):
    """What must hold at one angle; whatever is left out is free."""

    angle: Annotated[NonNegative, ANGLE] = Field(description="From the segment's start, degrees.")
    s: Annotated[Number, DISPLACEMENT] | None = Field(default=None, description="Displacement from the program's zero.")
    v: Annotated[Number, VELOCITY] | None = Field(default=None, description="Velocity, per radian of cam rotation.")
    a: Annotated[Number, ACCELERATION] | None = Field(default=None, description="Acceleration, per radian squared.")
    j: Annotated[Number, JERK] | None = Field(default=None, description="Jerk, per radian cubed.")

    def values(self) -> list[tuple[int, float]]:
        """(order, value) of what is stated."""
        return [(k, x) for k, x in enumerate((self.s, self.v, self.a, self.j)) if x is not None]


class DisplacementBand(Statement):
    """A stretch in which the displacement stays between two values."""

    start: Annotated[NonNegative, ANGLE] = Field(description="From the segment's start, degrees.")
    end: Span = Field(description="From the segment's start, degrees.")
    lower: Annotated[Number, DISPLACEMENT] | None = None
    upper: Annotated[Number, DISPLACEMENT] | None = None


class Dwell(Statement):
    """A rest where the segment before has ended."""

    motion: Literal["dwell"]
    angle: Span


class Move(Statement):
    """A rise, or a fall (``return`` is another word for it), by a law."""

    motion: Literal["rise", "fall", "return"]
    angle: Span
    lift: Annotated[PositiveNumber, DISPLACEMENT] | None = Field(
        default=None, description="Travel, positive for a fall too; a return without it goes back to zero."
    )
    law: Law = "auto"
    conditions: list[ProgramCondition] = Field(default=[], description="Interior conditions of an optimal motion.")
    bands: list[DisplacementBand] = Field(default=[], description="Bands of an optimal motion.")

    @property
    def follows_criterion(self) -> bool:
        """Whether no law is stated, so that the criterion chooses the motion, within the limits."""
        return self.law in ("auto", "optimal")


class ConstantVelocity(Statement):
    """A stretch of constant velocity."""

    motion: Literal["constant_velocity"]
    angle: Span
    lift: Annotated[Number, DISPLACEMENT] = Field(description="Travel, with its sign.")


class Polynomial(Statement):
    """The polynomial of least degree through conditions anywhere in the segment."""

    motion: Literal["polynomial"]
    angle: Span
    conditions: list[ProgramCondition] = Field(min_length=1, max_length=40)


Segment = Annotated[Dwell | Move | ConstantVelocity | Polynomial, Discriminator("motion")]


class LengthRange(Statement):
    """A dimension that is free between two lengths."""

    min: PositiveLength
    max: PositiveLength


class TranslatingRoller(Statement):
    """A roller on a slide. Without a prime radius the smallest sound one is found."""

    type: Literal["translating_roller"]
    roller_radius: PositiveLength | LengthRange = Field(
        description="Radius, or a range: the largest that fits is taken."
    )
    offset: Coordinate | Literal["free"] = Field(
        default=0.0,
        description="Distance of the slide from the cam's centre; positive lowers the rise's pressure angle.",
    )
    prime_radius: PositiveLength | None = None


class OscillatingRoller(Statement):
    """A roller on a swinging arm; lifts are degrees of the arm."""

    type: Literal["oscillating_roller"]
    roller_radius: PositiveLength | LengthRange = Field(
        description="Radius, or a range: the largest that fits is taken."
    )
    arm: PositiveLength = Field(description="From the pivot to the roller's centre.")
    pivot_distance: PositiveLength | LengthRange = Field(description="From the cam's centre to the pivot, or a range.")
    sense: Literal[1, -1] = Field(
        default=1, description="1: the arm swings outward in the sense in which the cam turns; -1: against it."
    )
    prime_radius: PositiveLength | None = None


class TranslatingFlat(Statement):
    """A flat face on a slide, square to its motion. Without a base radius the smallest sound one is found."""

    type: Literal["translating_flat"]
    base_radius: PositiveLength | None = None


class OscillatingFlat(Statement):
    """A flat face on a swinging arm; lifts are degrees of the arm."""

    type: Literal["oscillating_flat"]
    pivot_distance: PositiveLength
    face_offset: Coordinate = Field(
        default=0.0, description="Distance of the face from the pivot, positive toward the cam."
    )
    sense: Literal[1, -1] = 1
    base_radius: PositiveLength | None = None


class BarrelRoller(Statement):
    """A roller in the groove of a barrel (cylindrical) cam, moving along its axis; the groove's two walls guide it."""

    type: Literal["barrel_roller"]
    roller_radius: PositiveLength
    cylinder_radius: PositiveLength | None = Field(
        default=None, description="Of the cylinder on which the roller's middle runs; null: the smallest sound one."
    )


Follower = Annotated[
    TranslatingRoller | OscillatingRoller | TranslatingFlat | OscillatingFlat | BarrelRoller, Discriminator("type")
]

LimitAngle = Annotated[float, ANGLE, Field(strict=True, gt=0.0, le=85.0), Sizable]


class CamLimits(Statement):
    """What a sound cam keeps."""

    pressure_angle: LimitAngle = Field(
        default=30.0, description="Greatest pressure angle of a roller follower, degrees."
    )
    pressure_angle_fall: LimitAngle | None = Field(
        default=None, description="Another limit while falling, where a spring and not the cam drives; degrees."
    )
    curvature_ratio: NonNegative = Field(
        default=2.0, description="Least radius of curvature of the pitch curve over the roller radius (Norton: 2 to 3)."
    )
    min_radius: Annotated[NonNegative, LENGTH] = Field(
        default=0.0,
        description="Least radius of curvature of the cam under a flat face; a fiftieth of the travel at least.",
    )
    face_width: PositiveLength | None = Field(default=None, description="Length that the contact may sweep on a face.")
    hub_radius: Annotated[NonNegative, LENGTH] = Field(default=0.0, description="The base circle is at least as large.")
    size: PositiveLength | None = Field(
        default=None, description="Greatest prime radius (roller) or base radius (face)."
    )
    velocity: Annotated[PositiveNumber, VELOCITY] | None = Field(
        default=None, description="Peak of every optimal or automatic motion."
    )
    acceleration: Annotated[PositiveNumber, ACCELERATION] | None = None
    jerk: Annotated[PositiveNumber, JERK] | None = None

    @property
    def falling_pressure_angle(self) -> float:
        """The limit while falling, degrees: that of the rise where none is stated."""
        return self.pressure_angle_fall or self.pressure_angle


class FollowerDynamics(Statement):
    """The follower as one mass on a spring. Newton, kilogram and the length unit; pound-force and lbf s²/in for inches.

    For an oscillating follower all is taken at its arm's end: effective mass and spring at the roller.
    """

    mass: Annotated[PositiveNumber, MASS]
    spring_rate: Annotated[NonNegative, STIFFNESS] = Field(default=0.0, description="Force per length unit.")
    damping_ratio: NonNegative = Field(default=0.0, description="Share of critical damping of mass and spring.")
    preload: Annotated[NonNegative, FORCE] | None = Field(
        default=None, description="Spring force at zero displacement; null: the least."
    )
    least_force: Annotated[NonNegative, FORCE] = Field(
        default=0.0, description="Contact force that must always be left."
    )


Criterion = Literal[
    "size",
    "peak_velocity",
    "peak_acceleration",
    "peak_jerk",
    "rms_velocity",
    "rms_acceleration",
    "rms_jerk",
    "peak_torque",
    "rms_torque",
    "peak_contact_force",
]


class CamProblem(StatedProblem):
    """A motion program and the smallest sound cam for it.

    Every segment follows the one before; their angles make one turn. Displacement, velocity and acceleration must be
    continuous all around, the fundamental law of cam design, unless ``accept_discontinuity`` is set.
    """

    model_config = ConfigDict(
        title="Cam",
        json_schema_extra={
            "examples": [
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "dwell", "angle": 90.0},
                        {"motion": "rise", "angle": 90.0, "lift": 25.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 90.0},
                        {"motion": "return", "angle": 90.0, "law": "cycloidal"},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 10.0},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0},
                    "speed_rpm": 60.0,
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 90.0, "lift": 1.0, "law": "optimal"},
                        {"motion": "fall", "angle": 90.0, "lift": 1.0, "law": "optimal"},
                        {"motion": "dwell", "angle": 180.0},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 0.5, "offset": "free"},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0, "jerk": 30.0},
                    "minimize": "peak_acceleration",
                    "speed_rpm": 143.24,
                    "length_unit": "in",
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "constant_velocity", "angle": 180.0, "lift": 5.0},
                        {"motion": "return", "angle": 180.0, "law": "optimal"},
                    ],
                    "follower": {"type": "translating_roller", "roller_radius": 1.0},
                    "limits": {"pressure_angle": 30.0, "curvature_ratio": 2.0, "jerk": 19.351},
                    "minimize": "peak_acceleration",
                    "speed_rpm": 60.0,
                    "length_unit": "in",
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 62.0, "lift": 9.0, "law": "optimal"},
                        {"motion": "fall", "angle": 62.0, "lift": 9.0, "law": "optimal"},
                        {"motion": "dwell", "angle": 236.0},
                    ],
                    "follower": {"type": "translating_flat"},
                    "limits": {"min_radius": 3.0, "jerk": 350.0, "face_width": 32.0},
                    "dynamics": {"mass": 0.12, "spring_rate": 30.0, "least_force": 100.0},
                    "minimize": "peak_contact_force",
                    "speed_rpm": 3000.0,
                },
                {
                    "kind": "cam",
                    "segments": [
                        {"motion": "rise", "angle": 150.0, "lift": 40.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 30.0},
                        {"motion": "return", "angle": 150.0, "law": "modified_sine"},
                        {"motion": "dwell", "angle": 30.0},
                    ],
                    "follower": {"type": "barrel_roller", "roller_radius": 8.0},
                    "limits": {"pressure_angle": 35.0, "curvature_ratio": 1.5},
                    "speed_rpm": 120.0,
                },
            ]
        },
    )

    kind: Literal["cam"]
    segments: list[Segment] = Field(min_length=1, description="Once around, in order.")
    follower: Follower
    limits: CamLimits = CamLimits()
    speed_rpm: Annotated[PositiveNumber, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Cam speed, revolutions a minute."
    )
    rotation: Literal["ccw", "cw"] = Field(default="ccw", description="Sense in which the cam turns.")
    minimize: Criterion = Field(
        default="peak_acceleration",
        description="What automatic and optimal motions make least; the cam is as small as then can be.",
    )
    closure: Literal["force", "form"] = Field(
        default="force",
        description="What holds the follower to the cam: a force, or a groove whose two walls guide the roller.",
    )
    dynamics: FollowerDynamics | None = None
    continuity: Literal["acceleration", "jerk"] = Field(
        default="acceleration", description="The highest derivative that is continuous in optimal motions."
    )
    accept_discontinuity: Flag = Field(
        default=False, description="Take a program with jumps in displacement, velocity or acceleration."
    )
    profile_points: Annotated[Count, Field(ge=180, le=7200)] = Field(
        default=720,
        description="Points of the profile at equal cam angles; more where the motion needs them.",
    )

    @property
    def oscillating(self) -> bool:
        """Whether displacements are degrees of an arm."""
        return self.follower.type.startswith("oscillating")

    @property
    def displacement_unit(self) -> float:
        """Stated displacements times this are the solver's: radians of an arm, or lengths."""
        return math.pi / 180.0 if self.oscillating else 1.0

    def polynomial_conditions(self, segment: Polynomial | Move) -> Conditions:
        """A segment's conditions in radians and the solver's displacements."""
        unit = self.displacement_unit
        return [
            (math.radians(condition.angle), order, value * (unit if order == 0 else 1.0))
            for condition in segment.conditions
            for order, value in condition.values()
        ]

    def heights(self) -> list[tuple[float, float]]:
        """Displacement at start and end of each segment, in the solver's unit; the first begins at zero.

        A polynomial begins and ends where its conditions put it.
        """
        heights = []
        at = 0.0
        for segment in self.segments:
            end = at
            if isinstance(segment, Polynomial):
                ends = polynomial_ends(math.radians(segment.angle), self.polynomial_conditions(segment))
                at, end = (at, at) if ends is None else (ends[0][0], ends[1][0])
            elif isinstance(segment, ConstantVelocity):
                end = at + segment.lift * self.displacement_unit
            elif isinstance(segment, Move):
                lift = at if segment.lift is None else segment.lift * self.displacement_unit
                end = at + lift if segment.motion == "rise" else at - lift
            heights.append((at, end))
            at = end
        return heights

    def ends(self) -> list[tuple[State, State] | None]:
        """s, v, a at both ends of each segment; None for automatic and optimal motions, which follow others."""
        ends: list[tuple[State, State] | None] = []
        for segment, (start, end) in zip(self.segments, self.heights(), strict=True):
            angle = math.radians(segment.angle)
            if isinstance(segment, Polynomial):
                ends.append(polynomial_ends(angle, self.polynomial_conditions(segment)))
            elif isinstance(segment, ConstantVelocity):
                ends.append(law_ends("constant_velocity", angle, start, end))
            elif isinstance(segment, Dwell):
                ends.append(((start, 0.0, 0.0), (end, 0.0, 0.0)))
            elif segment.follows_criterion:
                ends.append(None)
            else:
                ends.append(law_ends(segment.law, angle, start, end))
        return ends

    def contradictions(self) -> list[Contradiction]:
        """Faults that no single field shows."""
        contradictions = [*self._segments(), *self._dimensions(), *self._inputs()]
        return contradictions or [*self._turn(), *self._joints()]

    def _turn(self) -> list[Contradiction]:
        total = math.fsum(segment.angle for segment in self.segments)
        if abs(total - 360.0) > WHOLE_TURN:
            return [Contradiction("/segments", f"the angles add up to {total:.12g} degrees; they must make one turn")]
        return []

    def _segments(self) -> list[Contradiction]:
        """Faults within a segment."""
        contradictions = []
        heights = self.heights()
        for k, segment in enumerate(self.segments):
            where = f"/segments/{k}"
            if isinstance(segment, Move):
                if segment.lift is None and segment.motion != "return":
                    contradictions.append(Contradiction(f"{where}/lift", f"a {segment.motion} needs a lift"))
                elif segment.lift is None and heights[k][0] <= 0.0:
                    contradictions.append(
                        Contradiction(f"{where}/lift", "there is nothing to return from; state a lift")
                    )
                for name in ("conditions", "bands"):
                    if getattr(segment, name) and segment.law != "optimal":
                        contradictions.append(Contradiction(f"{where}/{name}", "only an optimal motion can meet them"))
                for n, band in enumerate(segment.bands):
                    contradictions += _band_faults(f"{where}/bands/{n}", band, segment.angle)
            if isinstance(segment, Move | Polynomial):
                for n, condition in enumerate(segment.conditions):
                    inner = isinstance(segment, Move)
                    if condition.angle > segment.angle or (inner and condition.angle in (0.0, segment.angle)):
                        detail = f"must lie within the segment's {segment.angle:g} degrees"
                        contradictions.append(Contradiction(f"{where}/conditions/{n}/angle", detail))
                    if not condition.values():
                        contradictions.append(
                            Contradiction(f"{where}/conditions/{n}", "states nothing; give s, v, a or j")
                        )
            if isinstance(segment, Polynomial) and not contradictions:
                conditions = self.polynomial_conditions(segment)
                if polynomial_ends(math.radians(segment.angle), conditions) is None:
                    contradictions.append(Contradiction(f"{where}/conditions", "do not determine one polynomial"))
        if not contradictions and not any(_moves(segment) for segment in self.segments):
            contradictions.append(Contradiction("/segments", "the follower never moves; state a rise"))
        return contradictions

    def _joints(self) -> list[Contradiction]:
        """Joints where s jumps, or v or a without being accepted."""
        heights, ends = self.heights(), self.ends()
        travel = max(abs(b - a) for a, b in heights) or max(abs(a) for a, _ in heights) or 1.0
        least = min(math.radians(segment.angle) for segment in self.segments)
        contradictions = []
        for k, segment in enumerate(self.segments):
            n = (k + 1) % len(self.segments)
            following = self.segments[n]
            joint = f"where segment {n} ({following.motion}) follows segment {k} ({segment.motion})"
            gap = heights[n][0] - heights[k][1]
            if abs(gap) > SMOOTH * travel:
                hint = "; the program must come back to where it began" if n == 0 else ""
                gap /= self.displacement_unit
                contradictions.append(Contradiction(f"/segments/{n}", f"displacement jumps by {gap:.6g} {joint}{hint}"))
                continue
            before, after = ends[k], ends[n]
            if self.accept_discontinuity or before is None or after is None:
                continue
            for order, name in ((1, "velocity"), (2, "acceleration")):
                jump = after[0][order] - before[1][order]
                if abs(jump) > SMOOTH * travel / least**order:
                    law = "which breaks the fundamental law of cam design; choose other laws or accept_discontinuity"
                    contradictions.append(Contradiction(f"/segments/{n}", f"{name} jumps by {jump:.6g} {joint}, {law}"))
                    break
        if not contradictions and not self.accept_discontinuity:
            contradictions += self._inner_jumps()
        return contradictions

    def _inner_jumps(self) -> list[Contradiction]:
        """Laws whose acceleration jumps in their middle."""
        return [
            Contradiction(
                f"/segments/{k}/law", f"the acceleration of {segment.law} jumps; accept_discontinuity takes it"
            )
            for k, segment in enumerate(self.segments)
            if isinstance(segment, Move) and segment.law == "constant_acceleration"
        ]

    def _dimensions(self) -> list[Contradiction]:
        """Dimensions of the follower that contradict one another."""
        follower, contradictions = self.follower, []
        for name in ("roller_radius", "pivot_distance"):
            stated = getattr(follower, name, None)
            if isinstance(stated, LengthRange) and stated.min >= stated.max:
                contradictions.append(Contradiction(f"/follower/{name}/max", "must be above min"))
        if isinstance(follower, TranslatingRoller | OscillatingRoller) and follower.prime_radius is not None:
            radius = follower.roller_radius
            least = radius.min if isinstance(radius, LengthRange) else radius
            if follower.prime_radius <= least:
                contradictions.append(Contradiction("/follower/prime_radius", "must be larger than the roller"))
            if isinstance(follower, TranslatingRoller):
                offset = follower.offset
                if offset == "free":
                    detail = "a free offset needs a free prime radius; leave the prime radius out or state the offset"
                    contradictions.append(Contradiction("/follower/offset", detail))
                elif abs(offset) >= follower.prime_radius:
                    contradictions.append(Contradiction("/follower/offset", "must be less than the prime radius"))
            elif isinstance(follower.pivot_distance, LengthRange):
                detail = "a free pivot needs a free prime radius; leave the prime radius out or state the pivot"
                contradictions.append(Contradiction("/follower/pivot_distance", detail))
            else:
                arm, pivot = follower.arm, follower.pivot_distance
                if not abs(pivot - arm) < follower.prime_radius < pivot + arm:
                    contradictions.append(
                        Contradiction("/follower/prime_radius", "arm and pivot distance do not reach it")
                    )
        if self.closure == "form" and not isinstance(follower, TranslatingRoller | OscillatingRoller | BarrelRoller):
            contradictions.append(
                Contradiction("/closure", "only a roller runs in a groove; take another follower or force")
            )
        if isinstance(follower, OscillatingFlat):
            reach = (follower.base_radius or 0.0) + follower.face_offset
            if reach >= follower.pivot_distance:
                contradictions.append(
                    Contradiction("/follower/pivot_distance", "must exceed base radius and face offset")
                )
        return contradictions

    def _inputs(self) -> list[Contradiction]:
        """What a criterion needs."""
        contradictions = []
        force = self.minimize == "peak_contact_force"
        if force and self.dynamics is None:
            contradictions.append(Contradiction("/dynamics", "a contact force needs the follower's mass and spring"))
        if force and (self.closure == "form" or isinstance(self.follower, BarrelRoller)):
            contradictions.append(
                Contradiction("/minimize", "in a groove no force holds the follower; choose otherwise")
            )
        if self.dynamics is not None and self.speed_rpm is None:
            contradictions.append(Contradiction("/speed_rpm", "forces need the cam's speed"))
        optimal = any(isinstance(segment, Move) and segment.law == "optimal" for segment in self.segments)
        if optimal and self.minimize == "size" and self.oscillating:
            detail = "optimal motions of least size are found for translating followers; choose another criterion"
            contradictions.append(Contradiction("/minimize", detail))
        if optimal and self.minimize == "size" and isinstance(self.follower, BarrelRoller):
            detail = "by pressure angle a barrel is smallest where the peak velocity is; choose peak_velocity"
            contradictions.append(Contradiction("/minimize", detail))
        return contradictions


def _band_faults(where: str, band: DisplacementBand, angle: float) -> list[Contradiction]:
    if band.lower is None and band.upper is None:
        return [Contradiction(where, "states no bound; give lower or upper")]
    if not band.start < band.end <= angle:
        return [Contradiction(f"{where}/end", f"must be after start and within the segment's {angle:g} degrees")]
    if band.lower is not None and band.upper is not None and band.lower > band.upper:
        return [Contradiction(f"{where}/upper", "must not be below lower")]
    return []


def _moves(segment: Segment) -> bool:
    """Whether the follower moves in a segment; the polynomial of least degree through one value is that value."""
    if isinstance(segment, Polynomial):
        stated = [pair for condition in segment.conditions for pair in condition.values()]
        return len({value for order, value in stated if order == 0}) > 1 or any(x for order, x in stated if order)
    return isinstance(segment, Move) or (isinstance(segment, ConstantVelocity) and segment.lift != 0.0)
