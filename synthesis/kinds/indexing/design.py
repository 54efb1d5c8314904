"""Answers to problems of indexing drives."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from synthesis.model.answer import Answer, Point, Result, Verification, optional
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

    The drive is seen with the crank turning counter-clockwise. Where the inner radius is 0 the disc is about the shaft;
    of an internal drive it is a crescent, fastened to the arm beside the wheel's plane.
    """

    angle: list[Angle]
    outer_radius: list[Length]
    inner_radius: list[Length]


class DragLinkDriver(Answer):
    """A drag link whose output turns the crank; its input turns steadily.

    Its input's pivot lies on the line of both axes, beyond the crank's; angles are from there towards the crank's axis,
    counter-clockwise as the crank turns.
    """

    input_pivot: Point
    ground: Length
    input: Length
    coupler: Length
    output: Length
    crank_offset: Angle = Field(description="From the output to the crank's roller.")
    entry_angle: Angle = Field(description="Of the input, as the roller enters.")


class GenevaMechanism(Answer):
    """A Geneva drive in the plane."""

    type: Literal["geneva_external", "geneva_internal"]
    stations: int
    rollers: int
    center_distance: Length
    crank_radius: Length
    roller_diameter: Length
    wheel_radius: Length = Field(description="To the mouths of the slots: outside, of a ring inside.")
    ring_radius: Length | None = optional("The outside of a ring.")
    slot_width: Length
    slot_end_radius: Length = Field(description="From the wheel's axis to the center of a slot's rounded end.")
    locking_radius: Length = Field(description="Of the disc on the crank.")
    locking_arc_radius: Length = Field(description="Of the arcs in the wheel.")
    bore: Length
    drag_link: DragLinkDriver | None = optional("Where the crank is not the input.")
    profile: Profile
    disc: LockingDisc


class SphericalGenevaMechanism(Answer):
    """A Geneva drive on a sphere: the wheel is a hemisphere about its axis, the crank's axis lies in its rim's plane.

    The locking cap on the crank, opposite the roller, ends at a plane along the crank's axis, which the wheel's rim
    passes. The profile is the wheel seen along its axis.
    """

    type: Literal["geneva_spherical"] = "geneva_spherical"
    stations: int
    rollers: int
    sphere_radius: Length
    cone_angle: Angle = Field(description="Of the roller's axis from the crank's.")
    roller_diameter: Length
    slot_width: Length
    slot_end_angle: Angle = Field(description="From the rim up to the center of a slot's rounded end.")
    cap_angle: Angle = Field(description="From the crank's axis to the edge of the locking cap.")
    cap_offset: Length = Field(description="From the crank's axis to the plane at which the cap ends.")
    locking_arc_angle: Angle = Field(description="The same of the hollows in the wheel.")
    bore: Length
    profile: Profile


class IndexingProgram(Answer):
    """The wheel during an index, over the angle of the crank or the drag link's input from where a roller enters."""

    angle: list[Angle]
    s: list[Displacement]
    v: list[Velocity]
    a: list[Acceleration]
    j: list[Jerk]


class IndexingCourse(Answer):
    """What an index asks of the drive, at the crank's angles of the program."""

    wheel_torque: list[Torque]
    drive_torque: list[Torque]
    pin_force: list[Force] = Field(description="Of the roller on the slot's side, positive the way the wheel turns.")


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
    """Properties of a drive; what its outlines and forces have is measured by another route in the verification."""

    peak_velocity: Velocity
    peak_acceleration: Acceleration
    peak_acceleration_angle: Angle = Field(description="Of the crank, from where the roller enters.")
    peak_jerk: Jerk
    steady_share: float = Field(description="Of an index, with nine tenths of the greatest speed and more.")
    min_transmission_angle: Angle | None = optional("Of a drag link.")
    entry_speed: float = Field(description="Of the wheel over the crank's as the roller enters; 0 without shock.")
    peak_wheel_torque: Torque
    peak_drive_torque: Torque
    peak_pin_force: Force
    wall: Length = Field(description="Between a slot and a locking arc, where it is thinnest.")
    web: Length = Field(description="Between neighbouring slots, where they are nearest; negative where they meet.")
    undercut: bool = Field(description="Whether slots run into one another or into the bore.")
    locking_angle: Angle = Field(description="Of the crank, over which the disc fills a locking arc.")
    play: Angle = Field(description="By which the locked wheel can be turned either way, in the middle of a rest.")
    size: Length = Field(description="Along the line of both axes; of a ring or a sphere its diameter.")
    sized_by: SizedBy | None = optional("The demand that keeps the drive from being smaller, where its size is found.")


class IndexingDesign(Answer):
    """A drive with its motion and its proof."""

    mechanism: GenevaMechanism | SphericalGenevaMechanism
    verification: Verification
    index_angle: Angle = Field(description="Of the crank, or of the drag link's input, for one index.")
    dwell_share: float = Field(description="Of the time, in which the wheel rests.")
    program: IndexingProgram
    course: IndexingCourse
    metrics: IndexingMetrics


class Pawl(Answer):
    """A pawl at rest on the teeth, the wheel being free to turn counter-clockwise."""

    pivot: Point
    nose: Point = Field(description="At the foot of the tooth that it holds, where it holds one.")
    stop: Angle = Field(description="By how much the wheel is beyond its first stop where this pawl first holds it.")


class RatchetMechanism(Answer):
    """A ratchet wheel, its axis the origin, as the first pawl holds it; and its pawls."""

    type: Literal["ratchet"] = "ratchet"
    stations: int
    teeth: int
    overlap: int = Field(description="Pawls that hold the wheel at once.")
    wheel_radius: Length = Field(description="To the tips.")
    tooth_height: Length
    face_angle: Angle = Field(description="Of a face from the radius at its middle, leaning over the pawl.")
    pawl_length: Length = Field(description="From the middle of the held face to the pivot, along the tangent.")
    bore: Length
    pawls: list[Pawl]
    profile: Profile


class RatchetMetrics(Answer):
    """Properties of a ratchet."""

    step: Angle = Field(
        description="From stop to stop; just before a pawl falls in the wheel can turn back by this and the overtravel."
    )
    tooth_force: Force = Field(description="Of each pawl that holds, square to the face.")
    locking_angle: Angle = Field(description="Least over the face, between its normal and the line to the pivot.")
    friction_angle: Angle
    tooth_thickness: Length = Field(description="At the foot.")
    lift: Angle = Field(description="Of a pawl as a tip passes.")
    overtravel: Angle = Field(description="By which the wheel must turn beyond a stop for the pawl to fall in.")
    size: Length = Field(description="The diameter to the tips.")
    sized_by: SizedBy | None = optional("The demand that keeps the wheel from being smaller, where its size is found.")


class RatchetDesign(Answer):
    """A ratchet with its proof."""

    mechanism: RatchetMechanism
    verification: Verification
    metrics: RatchetMetrics


class IndexingResult(Result[IndexingDesign | RatchetDesign]):
    """Drives, those with the fewest rollers or pawls first."""
