"""Analysis of a Geneva drive: position and motion of its wheel while the crank turns."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from kinematics.message import compose
from synthesis.analyses.base import DrivenAnalysis, DrivenRequest, Family
from synthesis.mechanisms.geneva import build_drive
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Count, Degrees, PositiveLength, Statement

ENTRY_TOLERANCE = 1e-9
"""Share by which a crank may be shorter than the radius at which its roller reaches a slot, for rounding."""


class GivenDragLink(Statement):
    """A drag link whose output turns the crank; the ground is the shortest link, and the others make full turns."""

    ground: PositiveLength
    input: PositiveLength
    coupler: PositiveLength
    output: PositiveLength
    crank_offset: Degrees = Field(default=0.0, description="Angle from the output to the crank.")
    input_pivot: object = None
    entry_angle: object = None


class GivenGeneva(Statement):
    """A Geneva drive; the other fields of a design are optional."""

    type: Literal["geneva_external", "geneva_internal", "geneva_spherical"]
    stations: Annotated[Count, Field(ge=3, le=1000)]
    rollers: Annotated[Count, Field(ge=1, le=5)] = 1
    center_distance: PositiveLength | None = Field(default=None, description="Center distance; only for a plane drive.")
    crank_radius: PositiveLength | None = Field(
        default=None, description="Crank radius; only for a plane drive. By default the value for shock-free entry."
    )
    cone_angle: Degrees | None = Field(
        default=None,
        description="Angle of the roller's axis from the crank's; only for a spherical drive. By default the value "
        "for shock-free entry.",
    )
    drag_link: GivenDragLink | None = None
    sphere_radius: object = None
    roller_diameter: object = None
    wheel_radius: object = None
    ring_radius: object = None
    slot_width: object = None
    slot_end_radius: object = None
    slot_end_angle: object = None
    locking_radius: object = None
    locking_arc_radius: object = None
    cap_angle: object = None
    cap_offset: object = None
    locking_arc_angle: object = None
    bore: object = None
    profile: object = None
    disc: object = None


class GenevaAnalysis(DrivenAnalysis):
    """Analysis of a Geneva drive in motion."""

    valid: list[bool]
    moves: list[bool] = Field(description="Whether a roller is in a slot.")
    crank: list[float] = Field(description="Angle of the crank since the roller's entry, degrees.")
    angle: list[float] = Field(description="Angle of the wheel since the entry of a roller at input angle 0, degrees.")
    omega: list[float] = Field(description="rad/s")
    alpha: list[float] = Field(description="rad/s²")


class GenevaAnalysisRequest(DrivenRequest[GivenGeneva]):
    """A Geneva drive and how its crank turns; at input angle 0 the first roller enters a slot."""

    model_config = ConfigDict(
        title="Geneva drive: motion of its wheel",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {"type": "geneva_external", "stations": 4, "center_distance": 100.0},
                    "motion": {"at": 45.0, "speed_rpm": 60.0},
                }
            ]
        },
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find."""
        faults, given = super().find_errors(), self.mechanism
        step = math.pi / given.stations
        if given.type == "geneva_spherical":
            if (
                given.cone_angle is not None
                and not math.degrees(step) * (1.0 - ENTRY_TOLERANCE) <= given.cone_angle < 90.0
            ):
                faults.append(
                    (
                        "/mechanism/cone_angle",
                        compose("analyses-cone-angle-out-of-range", least=f"{math.degrees(step):.9g}"),
                    )
                )
            if given.drag_link is not None:
                faults.append(("/mechanism/drag_link", compose("analyses-drag-link-needs-plane-drive")))
        elif given.crank_radius is not None:
            if given.center_distance is None:
                faults.append(("/mechanism/center_distance", compose("analyses-center-distance-missing")))
            elif not math.sin(step) * (1.0 - ENTRY_TOLERANCE) <= given.crank_radius / given.center_distance < 1.0:
                least = given.center_distance * math.sin(step)
                faults.append(
                    ("/mechanism/crank_radius", compose("analyses-crank-radius-out-of-range", least=f"{least:.9g}"))
                )
        if given.drag_link is not None and not faults:
            faults += _find_drag_link_errors(given.drag_link)
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer for the drive, in the form of :class:`GenevaAnalysis`."""
        at, speed, time = self.motion.list_inputs()
        course, rollers = build_drive(self.mechanism), self.mechanism.rollers
        motion = course.wheel_motion(np.radians(at), rollers)
        return {
            "input_angle": at.tolist(),
            "time": None if time is None else time.tolist(),
            "valid": [True] * len(at),
            "moves": course.is_engaged(np.radians(at), rollers).tolist(),
            "crank": np.degrees(course.from_entry(np.radians(at)).s).tolist(),
            "angle": np.degrees(motion.s).tolist(),
            "omega": (motion.v * speed).tolist(),
            "alpha": (motion.a * speed**2 + motion.v * self.motion.acceleration).tolist(),
        }


def _find_drag_link_errors(link: GivenDragLink) -> list[tuple[str, str]]:
    lengths = (link.input, link.coupler, link.output)
    if min(lengths) > link.ground * (1.0 + ENTRY_TOLERANCE) and link.ground + 2.0 * max(lengths) < sum(lengths) * (
        1.0 - ENTRY_TOLERANCE
    ):
        return []
    return [
        (
            "/mechanism/drag_link",
            compose("analyses-drag-link-cannot-turn"),
        )
    ]


FAMILY = Family(GenevaAnalysisRequest, GenevaAnalysis)
