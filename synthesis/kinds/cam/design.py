"""Cams as answers: the mechanism, its motion program with its optimality, and the measurements on the finished profile.

Angles are degrees; displacements are lengths, or degrees of an oscillating follower's arm. Derivatives are by the
radian of cam rotation (of an arm in radians).
"""

from __future__ import annotations

from typing import Generic, Literal, TypeVar

from pydantic import Field

from synthesis.model.answer import Answer, Result, Search, Verification, optional_field
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
    """The follower and the dimensions of its type."""

    type: Literal["translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat"]
    roller_radius: Length | None = optional_field()
    offset: Length | None = optional_field(
        "Offset of a translating follower's slide; for a flat face only if it is not 0."
    )
    arm: Length | None = optional_field()
    pivot_distance: Length | None = optional_field()
    face_offset: Length | None = optional_field()
    sense: Literal[1, -1] | None = optional_field()


class CamCurve(Answer):
    """Points of a closed curve in the cam's own frame, with the cam angles at which the follower touches them."""

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
    breaks: list[Angle] = Field(description="Cam angles of the table at which the motion is not smooth.")


class SecondCam(Answer):
    """The second of two conjugate cams, on the same shaft and in the same frame, with the roller opposite the first.

    Its follower's displacement is the distance of the first follower below its highest position. A follower on a slide
    lies on −x at cam angle 0.
    """

    follower: CamFollower
    prime_radius: Length
    roller_distance: Length = Field(description="Distance of the two rollers' centres, the same at all cam angles.")
    arm_angle: Angle | None = optional_field("Angle between the two arms of an oscillating follower, degrees.")
    profile: CamCurve
    pitch_curve: CamCurve


class CamMechanism(Answer):
    """A radial cam. At cam angle 0 its frame is the ground's; the follower lies on the +x axis."""

    type: Literal["cam"] = "cam"
    follower: CamFollower
    prime_radius: Length | None = optional_field("Prime radius of a roller follower's cam.")
    base_radius: Length | None = optional_field("Base radius of a flat-faced follower's cam.")
    rotation: Literal["ccw", "cw"]
    profile: CamCurve
    outer_wall: CamCurve | None = optional_field("Outer wall of a groove; the profile is its inner wall.")
    pitch_curve: CamCurve = Field(description="Path of the roller's centre; the profile itself under a flat face.")
    second: SecondCam | None = optional_field("The second of two conjugate cams.")
    program: ProgramTable


class BarrelFollower(Answer):
    """A roller that moves along the barrel's axis."""

    type: Literal["barrel_roller"] = "barrel_roller"
    roller_radius: Length


class BarrelCamMechanism(Answer):
    """A barrel (cylindrical) cam with its groove unrolled.

    x runs along the circumference of the cylinder on which the roller's middle runs, in the order in which the cam
    passes the follower, from 0 at cam angle 0 to 2π times the radius; y along the axis, like the displacement.
    """

    type: Literal["barrel_cam"] = "barrel_cam"
    follower: BarrelFollower
    cylinder_radius: Length
    rotation: Literal["ccw", "cw"] = Field(description="Sense of rotation, seen against the y axis.")
    lower_wall: CamCurve
    upper_wall: CamCurve
    pitch_curve: CamCurve = Field(description="Path of the roller's centre.")
    program: ProgramTable


class CamSegment(Answer):
    """A segment of the finished program: its law, its cam angles and its peaks."""

    motion: str
    law: str
    start: Angle = Field(description="Cam angle at its start, degrees.")
    angle: Angle
    displacement: tuple[Displacement, Displacement] = Field(description="Displacement at its start and its end.")
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk = Field(description="Peak between jumps of the acceleration, which `joints` lists.")


class CamJump(Answer):
    """Increments of displacement and derivatives at a joint, from the end of one segment to the start of the next."""

    s: Displacement
    v: Velocity
    a: Acceleration
    j: Jerk


class CamJoint(Answer):
    """A joint of two segments: the continuous derivatives, and the jump of each derivative."""

    angle: Angle
    segments: tuple[int, int]
    continuous: list[Literal["s", "v", "a", "j"]]
    jump: CamJump


class Optimality(Answer):
    """Optimality of the program by the criterion: the value reached and a lower bound that no motion can beat.

    ``scope`` names the motions for which the bound holds. ``gap`` is value/bound − 1.
    """

    criterion: str
    value: float
    bound: float | None = optional_field()
    gap: float | None = optional_field()
    scope: str
    warning: str | None = optional_field(
        "Warning about peaks that are many times those of a plain law, as the cost of this criterion."
    )


Binding = Literal["least_force", "min_frequency_ratio", "spring_rate/min", "spring_rate/max"]


class ContactOverSpeeds(Answer):
    """The minimum contact force over all cam angles and all speeds up to the greatest."""

    max_rpm: RotationalSpeed
    min_contact_force: Force
    angle: Angle = Field(description="Cam angle of the minimum, degrees.")
    rpm: RotationalSpeed = Field(description="Speed at the minimum.")


class SpringChoice(Answer):
    """The chosen return spring, measured by its greatest contact force at the given speed.

    ``bound`` is a lower bound for all springs that keep the constraints; it is omitted if none keeps them, and this
    spring comes nearest. ``binding`` lists the active constraints.
    """

    max_contact_force: Force
    bound: Force | None = optional_field()
    gap: float | None = optional_field()
    binding: list[Binding]


class TrainVibration(Answer):
    """The follower as a mass behind an elastic train, with its return spring, in steady state at the cam's speed."""

    natural_frequency: RadianFrequency = Field(description="Natural frequency of the mass on train and spring, rad/s.")
    damped_frequency: RadianFrequency
    frequency_ratio: float = Field(description="Natural frequency over cam speed.")
    period_ratio: float = Field(description="τ: natural period over the time of the shortest move.")
    residual_amplitude: Displacement | None = optional_field(
        "Greatest amplitude of the free vibration at the start of a dwell; omitted without a dwell, at a resonance, "
        "and if the mass hardly follows the cam."
    )
    min_contact_force: Force | None = optional_field("Minimum contact force between the cam and the vibrating train.")
    max_contact_force: Force | None = optional_field()


class PushingCam(Answer):
    """The one of two conjugate cams that pushes the follower between two cam angles."""

    start: Angle = Field(description="Cam angle, degrees.")
    end: Angle = Field(description="Cam angle, degrees; less than the start if the turn ends in between.")
    cam: Literal[1, 2]


class CamForces(Answer):
    """Forces on the follower, modelled as one mass on a spring, at the given speed."""

    preload: Force = Field(description="Spring force at zero displacement.")
    least_preload: Force = Field(description="Smallest preload that keeps the required contact force.")
    min_contact_force: Force
    max_contact_force: Force
    min_torque: Torque
    max_torque: Torque
    wall_changes: list[Angle] | None = optional_field(
        "Cam angles at which a roller in a groove changes walls: the force along its motion changes sign there, "
        "compared "
        "with its last sign. Without spring and preload the force is zero in a dwell."
    )
    pushing: list[PushingCam] | None = optional_field(
        "The pushing one of two conjugate cams, from each wall change to the next."
    )
    spring_rate: Stiffness = Field(description="Rate of the return spring, given or chosen.")
    jump_speed: RotationalSpeed | None = Field(
        description="Speed at which the follower first leaves the cam; null if it never does, and in a groove."
    )
    natural_frequency: RadianFrequency = Field(description="Natural frequency of mass and spring, rad/s.")
    damped_frequency: RadianFrequency | None = Field(
        description="Damped natural frequency, rad/s; null if the damping is critical or more."
    )
    frequency_ratio: float = Field(description="Natural frequency over cam speed.")
    over_speeds: ContactOverSpeeds | None = optional_field("Given if a maximum speed is given or the spring is chosen.")
    spring: SpringChoice | None = optional_field("Given if the spring's rate is free.")
    train: TrainVibration | None = optional_field("Given if the stiffness of the train is given.")
    warning: str | None = optional_field()


class SecondMetrics(Answer):
    """Measurements on the second of two conjugate cams; its rise is the follower's return."""

    size: Length = Field(description="Greatest radius of the profile.")
    max_pressure_angle_rise: Angle = Field(description="Degrees.")
    max_pressure_angle_fall: Angle = Field(description="Degrees.")
    min_convex_radius: Length
    min_concave_radius: Length | None = optional_field(
        "Least concave radius of curvature of the profile; null if it has no hollow."
    )
    curvature_ratio: float


class CamMetrics(Answer):
    """Measurements on the finished cam."""

    size: Length = Field(description="Greatest radius of the profile.")
    lift: Displacement
    max_pressure_angle_rise: Angle | None = optional_field("Degrees.")
    max_pressure_angle_fall: Angle | None = optional_field("Degrees.")
    min_convex_radius: Length = Field(description="Least convex radius of curvature of the profile.")
    min_concave_radius: Length | None = optional_field(
        "Least concave radius of curvature of the profile; null if it has no hollow."
    )
    curvature_ratio: float | None = optional_field(
        "Least radius of curvature of the pitch curve over the roller's radius."
    )
    face_width: Length | None = optional_field("Length that the contact sweeps.")
    second: SecondMetrics | None = optional_field("Measurements on the second of two conjugate cams.")
    overturning_moment: Torque | None = optional_field(
        "Greatest moment on the slide of a translating follower, if its forces and the lever are known."
    )
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk | None = Field(description="Null if the acceleration jumps: the jerk is unbounded there.")
    rms_acceleration: Acceleration
    peak_inertia_torque: AccelerationSquared = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = optional_field()


class BarrelMetrics(Answer):
    """Measurements on the finished groove."""

    lift: Displacement
    groove_width: Length
    length: Length = Field(description="Length along the axis, from the lowest to the highest point of the groove.")
    max_pressure_angle_rise: Angle = Field(description="Degrees.")
    max_pressure_angle_fall: Angle = Field(description="Degrees.")
    min_radius: Length = Field(description="Least radius of curvature of the unrolled pitch curve.")
    curvature_ratio: float = Field(description="Least radius of curvature of the pitch curve over the roller's radius.")
    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_jerk: Jerk | None = Field(description="Null if the acceleration jumps: the jerk is unbounded there.")
    rms_acceleration: Acceleration
    peak_inertia_torque: AccelerationSquared = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = optional_field()


Mechanism = TypeVar("Mechanism", CamMechanism, BarrelCamMechanism)
Metrics = TypeVar("Metrics", CamMetrics, BarrelMetrics)


class ProgrammedDesign(Answer, Generic[Mechanism, Metrics]):
    """A cam of any form with its motion program and its verification."""

    mechanism: Mechanism
    segments: list[CamSegment]
    joints: list[CamJoint]
    optimality: Optimality
    verification: Verification
    metrics: Metrics


class CamDesign(ProgrammedDesign[CamMechanism, CamMetrics]):
    """A radial cam with its verification."""


class BarrelCamDesign(ProgrammedDesign[BarrelCamMechanism, BarrelMetrics]):
    """A barrel cam with its verification."""


class CamSearch(Search):
    """The search for the cam. ``sizing_proven``: no smaller cam follows this program within the limits."""

    sizing_proven: bool


class CamResult(Result[CamDesign | BarrelCamDesign]):
    """The smallest sound cam for the best motion program."""

    search: CamSearch
