"""Cams as answers: the mechanism, its motion program and how good it is, and what was measured on the finished profile.

Angles are degrees; displacements are lengths, or degrees of an oscillating follower's arm. Derivatives are by the
radian of cam rotation (of an arm in radians).
"""

from __future__ import annotations

from typing import Generic, Literal, TypeVar

from pydantic import Field

from synthesis.model.answer import Answer, Result, Search, Verification, optional
from synthesis.model.dimension import (
    Acceleration,
    AccelerationSquared,
    Angle,
    Displacement,
    Force,
    Jerk,
    Length,
    RadianFrequency,
    RotationalSpeed,
    Stiffness,
    Torque,
    Velocity,
)


class CamFollower(Answer):
    """The follower and what belongs to its type."""

    type: Literal["translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat"]
    roller_radius: Length | None = optional()
    offset: Length | None = optional("Of a translating follower's slide; of a face only where it is not 0.")
    arm: Length | None = optional()
    pivot_distance: Length | None = optional()
    face_offset: Length | None = optional()
    sense: Literal[1, -1] | None = optional()


class CamCurve(Answer):
    """Points of a closed curve in the cam's own frame, and the cam angles at which the follower stands there."""

    angle: list[Angle]
    x: list[Length]
    y: list[Length]


class ProgramTable(Answer):
    """The motion program at equal cam angles."""

    angle: list[Angle]
    s: list[Displacement]
    v: list[Velocity]
    a: list[Acceleration]
    j: list[Jerk]
    breaks: list[Angle] = Field(description="Cam angles of the table between which the motion is smooth.")


class SecondCam(Answer):
    """The second of two conjugate cams, on the same shaft and in the same frame, with the roller opposite the first.

    The follower is as its own cam sees it: displaced by what the first is below its highest place. On a slide it lies
    on −x at cam angle 0.
    """

    follower: CamFollower
    prime_radius: Length
    roller_distance: Length = Field(description="Of the two rollers' centres, the same at all cam angles.")
    arm_angle: Angle | None = optional("Between the two arms of an oscillating follower, degrees.")
    profile: CamCurve
    pitch_curve: CamCurve


class CamMechanism(Answer):
    """A radial cam. At cam angle 0 its frame is the ground's; the follower lies on the +x axis."""

    type: Literal["cam"] = "cam"
    follower: CamFollower
    prime_radius: Length | None = optional("Of a roller follower's cam.")
    base_radius: Length | None = optional("Of a flat-faced follower's cam.")
    rotation: Literal["ccw", "cw"]
    profile: CamCurve
    outer_wall: CamCurve | None = optional("Of a groove; the profile is its inner wall.")
    pitch_curve: CamCurve = Field(description="Path of the roller's centre; the profile itself under a flat face.")
    second: SecondCam | None = optional("Of conjugate cams.")
    program: ProgramTable


class BarrelFollower(Answer):
    """A roller that moves along the barrel's axis."""

    type: Literal["barrel_roller"] = "barrel_roller"
    roller_radius: Length


class BarrelCamMechanism(Answer):
    """A barrel (cylindrical) cam with its groove unrolled.

    x runs along the circumference of the cylinder on which the roller's middle runs, as the cam passes under the
    follower, from 0 at cam angle 0 to 2π times the radius; y along the axis, as the follower's displacement.
    """

    type: Literal["barrel_cam"] = "barrel_cam"
    follower: BarrelFollower
    cylinder_radius: Length
    rotation: Literal["ccw", "cw"] = Field(description="Seen against the y axis.")
    lower_wall: CamCurve
    upper_wall: CamCurve
    pitch_curve: CamCurve = Field(description="Path of the roller's centre.")
    program: ProgramTable


class CamSegment(Answer):
    """A segment of the program as it came out: its law, its place and its peaks."""

    motion: str
    law: str
    start: Angle = Field(description="Cam angle, degrees.")
    angle: Angle
    displacement: tuple[Displacement, Displacement] = Field(description="At its start and its end.")
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk = Field(description="Between jumps of the acceleration, which `joints` tell.")


class CamJump(Answer):
    """What displacement and derivatives gain at a joint, from the end of one segment to the start of the next."""

    s: Displacement
    v: Velocity
    a: Acceleration
    j: Jerk


class CamJoint(Answer):
    """Where two segments meet: what is continuous there, and by how much each derivative jumps."""

    angle: Angle
    segments: tuple[int, int]
    continuous: list[Literal["s", "v", "a", "j"]]
    jump: CamJump


class Optimality(Answer):
    """How good the program is by the criterion: the value reached and a lower bound that no motion can beat.

    ``scope`` says for which motions the bound holds. ``gap`` is value/bound − 1.
    """

    criterion: str
    value: float
    bound: float | None = optional()
    gap: float | None = optional()
    scope: str
    warning: str | None = optional("Peaks that are many times those of a plain law, where the criterion costs them.")


Binding = Literal["least_force", "min_frequency_ratio", "spring_rate/min", "spring_rate/max"]


class ContactOverSpeeds(Answer):
    """The least contact force at all cam angles and all speeds up to the greatest."""

    max_rpm: RotationalSpeed
    min_contact_force: Force
    angle: Angle = Field(description="At which it is, degrees.")
    rpm: RotationalSpeed = Field(description="At which it is.")


class SpringChoice(Answer):
    """The return spring that was chosen, by its greatest contact force at the stated speed.

    ``bound``: no spring that keeps the demands has a smaller one; left out where none keeps them, and this is the one
    that comes nearest. ``binding`` are the demands that are met with nothing to spare.
    """

    max_contact_force: Force
    bound: Force | None = optional()
    gap: float | None = optional()
    binding: list[Binding]


class TrainVibration(Answer):
    """The follower as a mass behind an elastic train, with its return spring, in steady state at the cam's speed."""

    natural_frequency: RadianFrequency = Field(description="Of the mass on train and spring, rad/s.")
    damped_frequency: RadianFrequency
    frequency_ratio: float = Field(description="Natural frequency over cam speed.")
    period_ratio: float = Field(description="τ: natural period over the time of the shortest move.")
    residual_amplitude: Displacement | None = optional(
        "Greatest amplitude of the free vibration at the start of a dwell; left out without a dwell, at a resonance, "
        "and where the mass hardly follows."
    )
    min_contact_force: Force | None = optional("Of the cam on the vibrating train.")
    max_contact_force: Force | None = optional()


class PushingCam(Answer):
    """From one cam angle to another one of two conjugate cams pushes the follower."""

    start: Angle = Field(description="Degrees.")
    end: Angle = Field(description="Degrees; less than the start where the turn ends between.")
    cam: Literal[1, 2]


class CamForces(Answer):
    """The follower as one mass on a spring, at the stated speed."""

    preload: Force = Field(description="Spring force at zero displacement.")
    least_preload: Force = Field(description="That keeps the least contact force.")
    min_contact_force: Force
    max_contact_force: Force
    min_torque: Torque
    max_torque: Torque
    wall_changes: list[Angle] | None = optional(
        "Cam angles at which a roller in a groove changes walls: where the force along its motion begins to have the "
        "other sign than the last one that it had. Without spring and preload it is zero in a rest."
    )
    pushing: list[PushingCam] | None = optional("Of conjugate cams, from each change of walls to the next.")
    spring_rate: Stiffness = Field(description="Of the return spring, stated or chosen.")
    jump_speed: RotationalSpeed | None = Field(
        description="At which the follower first leaves the cam; null where it does at none, and in a groove."
    )
    natural_frequency: RadianFrequency = Field(description="Of mass and spring, rad/s.")
    damped_frequency: RadianFrequency | None = Field(
        description="Likewise with the damping; null where it is critical."
    )
    frequency_ratio: float = Field(description="Natural frequency over cam speed.")
    over_speeds: ContactOverSpeeds | None = optional("Where a greatest speed is stated, or the spring is chosen.")
    spring: SpringChoice | None = optional("Where the spring's rate is free.")
    train: TrainVibration | None = optional("Where the stiffness of the train is stated.")
    warning: str | None = optional()


class SecondMetrics(Answer):
    """Measured on the second of two conjugate cams; its rise is where the follower comes back."""

    size: Length = Field(description="Greatest radius of the profile.")
    max_pressure_angle_rise: Angle = Field(description="Degrees.")
    max_pressure_angle_fall: Angle = Field(description="Degrees.")
    min_convex_radius: Length
    min_concave_radius: Length | None = optional("None where it is convex.")
    curvature_ratio: float


class CamMetrics(Answer):
    """Measured on the finished cam."""

    size: Length = Field(description="Greatest radius of the profile.")
    lift: Displacement
    max_pressure_angle_rise: Angle | None = optional("Degrees.")
    max_pressure_angle_fall: Angle | None = optional("Degrees.")
    min_convex_radius: Length = Field(description="Least convex radius of curvature of the profile.")
    min_concave_radius: Length | None = optional("None where it is convex.")
    curvature_ratio: float | None = optional("Pitch curve over roller.")
    face_width: Length | None = optional("Length that the contact sweeps.")
    second: SecondMetrics | None = optional("Of conjugate cams.")
    overturning_moment: Torque | None = optional(
        "Greatest on the slide of a translating follower, where its forces and the lever are known."
    )
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk | None = Field(description="Null where the acceleration jumps: the jerk has no bound there.")
    rms_acceleration: Acceleration
    peak_inertia_torque: AccelerationSquared = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = optional()


class BarrelMetrics(Answer):
    """Measured on the finished groove."""

    lift: Displacement
    groove_width: Length
    length: Length = Field(description="Along the axis, from the lowest to the highest point of the groove.")
    max_pressure_angle_rise: Angle = Field(description="Degrees.")
    max_pressure_angle_fall: Angle = Field(description="Degrees.")
    min_radius: Length = Field(description="Least radius of curvature of the unrolled pitch curve.")
    curvature_ratio: float = Field(description="That over the roller's radius.")
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk | None = Field(description="Null where the acceleration jumps: the jerk has no bound there.")
    rms_acceleration: Acceleration
    peak_inertia_torque: AccelerationSquared = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = optional()


Mechanism = TypeVar("Mechanism", CamMechanism, BarrelCamMechanism)
Metrics = TypeVar("Metrics", CamMetrics, BarrelMetrics)


class ProgrammedDesign(Answer, Generic[Mechanism, Metrics]):
    """A cam of any form with its motion program and the proof of what it does."""

    mechanism: Mechanism
    segments: list[CamSegment]
    joints: list[CamJoint]
    optimality: Optimality
    verification: Verification
    metrics: Metrics


class CamDesign(ProgrammedDesign[CamMechanism, CamMetrics]):
    """A cam with the proof of what it does."""


class BarrelCamDesign(ProgrammedDesign[BarrelCamMechanism, BarrelMetrics]):
    """A barrel cam with the proof of what it does."""


class CamSearch(Search):
    """How the cam was found. ``sizing_proven``: no smaller cam carries this program within the limits."""

    sizing_proven: bool


class CamResult(Result[CamDesign | BarrelCamDesign]):
    """The smallest sound cam for the best motion program."""

    search: CamSearch
