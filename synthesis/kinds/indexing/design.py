"""Answers to problems of indexing drives."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional_field
from synthesis.model.dimension import (
    Acceleration,
    Angle,
    Displacement,
    Force,
    Jerk,
    Length,
    Torque,
    Velocity,
)


class Profile(Answer):
    """Corners of a closed outline in the wheel's frame: its axis is the origin, the first slot lies along x."""

    x: list[Length]
    y: list[Length]


class LockingDisc(Answer):
    """The locking disc in the crank's frame: its radii in directions counter-clockwise from the first roller.

    The drive is seen with the crank turning counter-clockwise. With an inner radius of 0 the disc surrounds the shaft;
    in an internal drive it is a crescent, fastened to the arm next to the wheel's plane.
    """

    angle: list[Angle]
    outer_radius: list[Length]
    inner_radius: list[Length]


class DragLinkDriver(Answer):
    """A drag link whose output turns the crank; its input turns at constant speed.

    The input's pivot lies on the line of both axes, beyond the crank's; angles are measured from there towards the
    crank's axis, counter-clockwise like the crank.
    """

    input_pivot: Point
    ground: Length
    input: Length
    coupler: Length
    output: Length
    crank_offset: Angle = Field(description="Angle from the output to the crank's roller.")
    entry_angle: Angle = Field(description="Angle of the input when the roller enters.")


class GenevaMechanism(Answer):
    """A Geneva drive in the plane."""

    type: Literal["geneva_external", "geneva_internal"]
    stations: int
    rollers: int
    center_distance: Length
    crank_radius: Length
    roller_diameter: Length
    wheel_radius: Length = Field(description="Radius to the mouths of the slots: outside, for a ring inside.")
    ring_radius: Length | None = optional_field("Outer radius of a ring.")
    slot_width: Length
    slot_end_radius: Length = Field(description="Distance from the wheel's axis to the center of a slot's rounded end.")
    locking_radius: Length = Field(description="Radius of the disc on the crank.")
    locking_arc_radius: Length = Field(description="Radius of the arcs in the wheel.")
    bore: Length
    drag_link: DragLinkDriver | None = optional_field("Given if the crank is not the input.")
    profile: Profile
    disc: LockingDisc


class SphericalGenevaMechanism(Answer):
    """A Geneva drive on a sphere: the wheel is a hemisphere about its axis, the crank's axis lies in its rim's plane.

    The locking cap on the crank, opposite the roller, ends at a plane parallel to the crank's axis, which clears the
    wheel's rim. The profile is the wheel seen along its axis.
    """

    type: Literal["geneva_spherical"] = "geneva_spherical"
    stations: int
    rollers: int
    sphere_radius: Length
    cone_angle: Angle = Field(description="Angle of the roller's axis from the crank's.")
    roller_diameter: Length
    slot_width: Length
    slot_end_angle: Angle = Field(description="Angle from the rim up to the center of a slot's rounded end.")
    cap_angle: Angle = Field(description="Angle from the crank's axis to the edge of the locking cap.")
    cap_offset: Length = Field(description="Distance from the crank's axis to the plane at which the cap ends.")
    locking_arc_angle: Angle = Field(description="Angle from the crank's axis to the edge of the hollows in the wheel.")
    bore: Length
    profile: Profile


class IndexingProgram(Answer):
    """The wheel during an index, over the angle of the crank or the drag link's input from the entry of a roller."""

    angle: list[Angle]
    s: list[Displacement]
    v: list[Velocity]
    a: list[Acceleration]
    j: list[Jerk]


class IndexingCourse(Answer):
    """Torques and forces during an index, at the crank angles of the program."""

    wheel_torque: list[Torque]
    drive_torque: list[Torque]
    pin_force: list[Force] = Field(
        description="Force of the roller on the slot's side, positive in the direction of the wheel's rotation."
    )


SizedBy = Literal[
    "locking_disc",
    "crescent",
    "web",
    "bore",
    "crank_shaft",
    "locking_angle",
    "pin_force",
    "play",
    "locked_rest",
    "passing_roller",
]


class IndexingMetrics(Answer):
    """Properties of a drive; those of its outlines and forces are measured by another route in the verification."""

    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_acceleration_angle: Angle = Field(
        description="Crank angle of the peak acceleration, from the entry of the roller."
    )
    peak_jerk: Jerk
    steady_share: float = Field(description="Share of an index with at least nine tenths of the greatest speed.")
    min_transmission_angle: Angle | None = optional_field("Minimum transmission angle of a drag link.")
    entry_speed: float = Field(
        description="Speed of the wheel over the crank's when the roller enters; 0 without shock."
    )
    peak_wheel_torque: Torque
    peak_drive_torque: Torque
    peak_pin_force: Force
    wall: Length = Field(description="Minimum thickness between a slot and a locking arc.")
    web: Length = Field(description="Minimum distance between neighbouring slots; negative if they meet.")
    undercut: bool = Field(description="Whether slots run into one another or into the bore.")
    locking_angle: Angle = Field(description="Crank angle over which the disc fills a locking arc.")
    play: Angle = Field(
        description="Angle by which the locked wheel can be turned in either direction, in the middle of a rest."
    )
    size: Length = Field(description="Extent along the line of both axes; for a ring or a sphere its diameter.")
    sized_by: SizedBy | None = optional_field("Constraint that determines the smallest size, if the size is found.")


class IndexingDesign(Answer):
    """A drive with its motion and its verification."""

    mechanism: GenevaMechanism | SphericalGenevaMechanism
    verification: Verification
    index_angle: Angle = Field(description="Angle of the crank, or of the drag link's input, for one index.")
    dwell_share: float = Field(description="Share of the time in which the wheel rests.")
    program: IndexingProgram
    course: IndexingCourse
    metrics: IndexingMetrics


class Pawl(Answer):
    """A pawl at rest on the teeth, with the wheel free to turn counter-clockwise."""

    pivot: Point
    nose: Point = Field(description="Nose of the pawl, at the foot of the tooth that it holds.")
    stop: Angle = Field(description="Angle of the wheel beyond its first stop when this pawl first holds it.")


class RatchetMechanism(Answer):
    """A ratchet wheel held by the first pawl, with its axis at the origin; and its pawls."""

    type: Literal["ratchet"] = "ratchet"
    stations: int
    teeth: int
    overlap: int = Field(description="Number of pawls that hold the wheel at the same time.")
    wheel_radius: Length = Field(description="Radius to the tips.")
    tooth_height: Length
    face_angle: Angle = Field(description="Angle of a face from the radius at its middle, leaning over the pawl.")
    pawl_length: Length = Field(
        description="Distance from the middle of the held face to the pivot, along the tangent."
    )
    bore: Length
    pawls: list[Pawl]
    profile: Profile


class RatchetMetrics(Answer):
    """Properties of a ratchet."""

    step: Angle = Field(
        description="Angle between stops; just before a pawl falls in, the wheel can turn back by this plus the "
        "overtravel."
    )
    tooth_force: Force = Field(description="Force of each holding pawl, normal to the face.")
    locking_angle: Angle = Field(
        description="Minimum angle over the face between its normal and the line to the pivot."
    )
    friction_angle: Angle
    tooth_thickness: Length = Field(description="Thickness at the foot.")
    lift: Angle = Field(description="Rotation of a pawl when a tip passes.")
    overtravel: Angle = Field(description="Angle by which the wheel must turn beyond a stop for the pawl to fall in.")
    size: Length = Field(description="Diameter to the tips.")
    sized_by: SizedBy | None = optional_field("Constraint that determines the smallest size, if the size is found.")


class RatchetDesign(Answer):
    """A ratchet with its verification."""

    mechanism: RatchetMechanism
    verification: Verification
    metrics: RatchetMetrics


class IndexingResult(Result[IndexingDesign | RatchetDesign]):
    """Drives, those with the fewest rollers or pawls first."""
