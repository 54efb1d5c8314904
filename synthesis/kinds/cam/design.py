"""Cams as answers: the mechanism, its motion program and how good it is, and what was measured on the finished profile.

Angles are degrees; displacements are lengths, or degrees of an oscillating follower's arm. Derivatives are by the
radian of cam rotation (of an arm in radians).
"""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from synthesis.model.answer import (
    Answer,
    Result,
    Search,
    Verification,
)


def _blank(value: Any) -> bool:
    return value is None


class CamFollower(Answer):
    """The follower and what belongs to its type."""

    type: Literal["translating_roller", "oscillating_roller", "translating_flat", "oscillating_flat"]
    roller_radius: float | None = Field(default=None, exclude_if=_blank)
    offset: float | None = Field(default=None, exclude_if=_blank, description="Of a translating roller's slide.")
    arm: float | None = Field(default=None, exclude_if=_blank)
    pivot_distance: float | None = Field(default=None, exclude_if=_blank)
    face_offset: float | None = Field(default=None, exclude_if=_blank)
    sense: Literal[1, -1] | None = Field(default=None, exclude_if=_blank)


class CamCurve(Answer):
    """Points of a closed curve in the cam's own frame, and the cam angles at which the follower stands there."""

    angle: list[float]
    x: list[float]
    y: list[float]


class ProgramTable(Answer):
    """The motion program at equal cam angles."""

    angle: list[float]
    s: list[float]
    v: list[float]
    a: list[float]
    j: list[float]


class CamMechanism(Answer):
    """A radial cam. At cam angle 0 its frame is the ground's; the follower lies on the +x axis."""

    type: Literal["cam"] = "cam"
    follower: CamFollower
    prime_radius: float | None = Field(default=None, exclude_if=_blank, description="Of a roller follower's cam.")
    base_radius: float | None = Field(default=None, exclude_if=_blank, description="Of a flat-faced follower's cam.")
    rotation: Literal["ccw", "cw"]
    profile: CamCurve
    outer_wall: CamCurve | None = Field(
        default=None,
        exclude_if=_blank,
        description="Of a groove; the profile is its inner wall.",
    )
    pitch_curve: CamCurve = Field(description="Path of the roller's centre; the profile itself under a flat face.")
    program: ProgramTable


class BarrelFollower(Answer):
    """A roller that moves along the barrel's axis."""

    type: Literal["barrel_roller"] = "barrel_roller"
    roller_radius: float


class BarrelCamMechanism(Answer):
    """A barrel (cylindrical) cam with its groove unrolled.

    x runs along the circumference of the cylinder on which the roller's middle runs, as the cam passes under the
    follower, from 0 at cam angle 0 to 2π times the radius; y along the axis, as the follower's displacement.
    """

    type: Literal["barrel_cam"] = "barrel_cam"
    follower: BarrelFollower
    cylinder_radius: float
    rotation: Literal["ccw", "cw"] = Field(description="Seen against the y axis.")
    lower_wall: CamCurve
    upper_wall: CamCurve
    pitch_curve: CamCurve = Field(description="Path of the roller's centre.")
    program: ProgramTable


class CamSegment(Answer):
    """A segment of the program as it came out: its law, its place and its peaks."""

    motion: str
    law: str
    start: float = Field(description="Cam angle, degrees.")
    angle: float
    displacement: tuple[float, float] = Field(description="At its start and its end.")
    peak_velocity: float
    peak_acceleration: float
    peak_jerk: float


class CamJoint(Answer):
    """Where two segments meet: what is continuous there, and by how much each derivative jumps."""

    angle: float
    segments: tuple[int, int]
    continuous: list[Literal["s", "v", "a", "j"]]
    jump: tuple[float, float, float, float]


class Optimality(Answer):
    """How good the program is by the criterion: the value reached and a lower bound that no motion can beat.

    ``scope`` says for which motions the bound holds. ``gap`` is value/bound − 1.
    """

    criterion: str
    value: float
    bound: float | None = Field(default=None, exclude_if=_blank)
    gap: float | None = Field(default=None, exclude_if=_blank)
    scope: str


class CamForces(Answer):
    """The follower as one mass on a spring, at the stated speed."""

    preload: float = Field(description="Spring force at zero displacement.")
    least_preload: float = Field(description="That keeps the least contact force.")
    min_contact_force: float
    max_contact_force: float
    min_torque: float
    max_torque: float
    wall_changes: list[float] | None = Field(
        default=None, exclude_if=_blank, description="Cam angles at which a roller in a groove changes walls."
    )
    natural_frequency: float = Field(description="Of mass and spring, rad/s.")
    frequency_ratio: float = Field(description="Natural frequency over cam speed.")
    warning: str | None = Field(default=None, exclude_if=_blank)


class CamMetrics(Answer):
    """Measured on the finished cam."""

    size: float = Field(description="Greatest radius of the profile.")
    lift: float
    max_pressure_angle_rise: float | None = Field(default=None, exclude_if=_blank, description="Degrees.")
    max_pressure_angle_fall: float | None = Field(default=None, exclude_if=_blank, description="Degrees.")
    min_convex_radius: float = Field(description="Least convex radius of curvature of the profile.")
    min_concave_radius: float | None = Field(default=None, exclude_if=_blank, description="None where it is convex.")
    curvature_ratio: float | None = Field(default=None, exclude_if=_blank, description="Pitch curve over roller.")
    face_width: float | None = Field(default=None, exclude_if=_blank, description="Length that the contact sweeps.")
    peak_velocity: float
    peak_acceleration: float
    peak_jerk: float
    rms_acceleration: float
    peak_inertia_torque: float = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = Field(default=None, exclude_if=_blank)


class CamDesign(Answer):
    """A cam with the proof of what it does."""

    mechanism: CamMechanism
    segments: list[CamSegment]
    joints: list[CamJoint]
    optimality: Optimality
    verification: Verification
    metrics: CamMetrics


class BarrelMetrics(Answer):
    """Measured on the finished groove."""

    lift: float
    groove_width: float
    length: float = Field(description="Along the axis, from the lowest to the highest point of the groove.")
    max_pressure_angle_rise: float = Field(description="Degrees.")
    max_pressure_angle_fall: float = Field(description="Degrees.")
    min_radius: float = Field(description="Least radius of curvature of the unrolled pitch curve.")
    curvature_ratio: float = Field(description="That over the roller's radius.")
    peak_velocity: float
    peak_acceleration: float
    peak_jerk: float
    rms_acceleration: float
    peak_inertia_torque: float = Field(description="Greatest |v a|: torque by unit mass at unit speed.")
    forces: CamForces | None = Field(default=None, exclude_if=_blank)


class BarrelCamDesign(Answer):
    """A barrel cam with the proof of what it does."""

    mechanism: BarrelCamMechanism
    segments: list[CamSegment]
    joints: list[CamJoint]
    optimality: Optimality
    verification: Verification
    metrics: BarrelMetrics


class CamSearch(Search):
    """How the cam was found. ``sizing_proven``: no smaller cam carries this program within the limits."""

    sizing_proven: bool


class CamResult(Result[CamDesign | BarrelCamDesign]):
    """The smallest sound cam for the best motion program."""

    search: CamSearch
