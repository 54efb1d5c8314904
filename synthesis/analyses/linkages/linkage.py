"""Analysis of a planar linkage: request and answer, in degrees.

For speed, the answer consists of plain lists; :class:`LinkageAnalysis` documents them. At positions at which the
mechanism cannot be assembled, ``valid`` is False and the numbers are NaN, which becomes null in JSON.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field, TypeAdapter

from kinematics.errors import MechanismError as KinematicsError
from kinematics.linkage.clearance.scene import RangeError
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.mechanism import GROUND
from kinematics.message import compose
from synthesis.analyses.base import AnalysisRequest, Family
from synthesis.analyses.budget import BudgetError, require_values
from synthesis.analyses.input_motion import StatedMotion, Sweep
from synthesis.analyses.linkages.cycle import MAX_EFFORT, estimate_effort, find_cycle
from synthesis.analyses.linkages.dynamics import analyze_forces
from synthesis.analyses.linkages.fourbar import FourbarAnalysis, Points, Topic, analyze_fourbar
from synthesis.analyses.linkages.layout import lay_out_range
from synthesis.analyses.linkages.quantities import analyze_motion
from synthesis.analyses.linkages.targets import analyze_targets, find_target_errors
from synthesis.mechanisms import GivenMechanism, MechanismError
from synthesis.mechanisms.link_bodies import escape_pointer
from synthesis.mechanisms.machine import find_dynamics_errors
from synthesis.mechanisms.skeleton import describe_skeleton
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dynamics.answer import DynamicsAnswer
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.layout import LayoutSizes
from synthesis.model.linkage.answer import Layout, Skeleton
from synthesis.model.linkage.given_linkage import CouplerPointSpec
from synthesis.model.linkage.targets import MAX_TARGETS, MetTarget, TargetSpec
from synthesis.model.manufacture.answer import ManufactureReport, Yield
from synthesis.model.manufacture.request import Exactness

_GIVEN_ADAPTER: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


class LinkPoint(CouplerPointSpec):
    """A point of a link by its distance and angle there, as P on a coupler.

    The distance is from the joint at which the link's angle is measured: the first in its list, of the input its pivot;
    the angle from the line to the second joint to the line to the point, degrees.
    """

    link: str = Field(min_length=1, max_length=50, description="Name of a moving link, as in the answer.")


class LinkageAnalysisRequest(AnalysisRequest):
    """A mechanism and how it is driven; a full turn in 360 steps by default."""

    model_config = ConfigDict(
        title="Linkage: motion and forces",
        json_schema_extra={
            "examples": [
                {
                    "mechanism": {
                        "type": "fourbar",
                        "fixed_pivots": {"input": [0.0, 0.0], "output": [6.0, 0.0]},
                        "links": {"input": 2.0, "coupler": 7.0, "output": 9.0},
                        "coupler_point": {"distance": 6.0, "angle": 30.0},
                        "assembly": "open",
                    },
                    "motion": {"from": 0.0, "to": 360.0, "steps": 360, "speed_rpm": 60.0},
                }
            ]
        },
    )

    mechanism: GivenMechanism
    motion: StatedMotion = Field(
        default=Sweep(),
        description="Motion of the input; by default a full turn in 360 steps, or for a slider from toggle to toggle.",
    )
    include: list[Topic | Literal["branches"]] = Field(
        default=[],
        max_length=5,
        description="Additional results. `branches`: positions of the joints along every branch of every circuit. "
        "The others are available for pin-jointed fourbars only.",
    )

    points: dict[Annotated[str, Field(min_length=1, max_length=50)], LinkPoint] = Field(
        default={}, max_length=20, description="Further points by names of your choice; `points` contains their motion."
    )
    layout: LayoutSizes | None = Field(
        default=None,
        description="Arrange the mechanism in the fewest planes in which it can be built, over the given motion.",
    )
    targets: list[TargetSpec] = Field(
        default=[],
        max_length=MAX_TARGETS,
        description="Targets of the mechanism: its error at each is reported, and `manufacture` refers to them.",
    )
    manufacture: Exactness | None = Field(
        default=None, description="Manufacturing accuracy of the mechanism, evaluated at its targets."
    )
    length_unit: LengthUnit = Field(default="mm", description="Unit of all lengths; `dynamics` converts them.")
    dynamics: DynamicsBlock | None = Field(
        default=None,
        description="Masses and loads, from which joint forces, drive, and shaking force and moment are computed.",
    )

    def find_errors(self) -> list[tuple[str, str]]:
        """Return errors that the validation of single fields cannot find, as pairs (path, detail)."""
        faults = [*self.motion.find_errors(), *find_target_errors(self.mechanism, self.targets, self.manufacture)]
        if not self.points and self.dynamics is None:
            return faults
        try:
            mechanism = self.mechanism.build_mechanism()
        except (MechanismError, KinematicsError):  # building the answer reports this error
            return faults
        moving = [link for link in mechanism.links if link != GROUND]
        for name, point in self.points.items():
            if point.link not in moving:
                detail = compose("analyses-link-not-moving", names=", ".join(moving))
                faults.append((f"/points/{escape_pointer(name)}/link", detail))
        if self.dynamics is not None:
            faults += find_dynamics_errors(self.dynamics, mechanism)
            if self.dynamics.flywheel is not None and self.motion.rate == 0.0:
                faults.append(("/dynamics/flywheel", compose("analyses-flywheel-needs-speed")))
        return faults

    def build_answer(self) -> JsonObject:
        """Build the answer over the motion, in the form of :class:`LinkageAnalysis`."""
        mechanism = self.mechanism.build_mechanism()
        if decompose(mechanism).left and estimate_effort(mechanism) > MAX_EFFORT:
            raise MechanismError("", compose("analyses-too-many-links-outside-dyads"))
        slide, motion = mechanism.has_slide_input, self.motion
        if slide and motion.speed_rpm is not None:
            raise MechanismError("", compose("analyses-slider-speed-as-length"))
        if slide and isinstance(motion, Sweep) and None in (motion.start, motion.end):
            toggles = dict(zip(("start", "end"), find_cycle(mechanism), strict=True))
            stated = {name: getattr(motion, name) for name in toggles if getattr(motion, name) is not None}
            motion = motion.model_copy(update=toggles | stated)
        at, speed, time = motion.list_inputs(slide=slide)
        require_values("/motion/steps" if isinstance(motion, Sweep) else "/motion/time/step", len(at), self._width())
        topics = [topic for topic in self.include if topic != "branches"]
        points = {name: (point.link, point.vector) for name, point in self.points.items()}
        more = analyze_fourbar(mechanism, np.radians(at), topics) if topics else None
        planes = {}
        if self.layout is not None:
            ends = float(at.min()), float(at.max())
            used = ends if slide else (math.radians(ends[0]), math.radians(ends[1]))
            try:
                planes["layout"] = lay_out_range(mechanism, self.layout, used).model_dump()
            except RangeError as error:
                most = error.most if slide else math.degrees(error.most)
                message = "analyses-layout-stroke-too-long" if slide else "analyses-layout-range-too-long"
                raise BudgetError("/motion/to", compose(message, most=f"{most:.6g}")) from None
        met = analyze_targets(self.mechanism, self.targets, self.manufacture) if self.targets else {}
        forces = {}
        if self.dynamics is not None:
            forces = {
                "skeleton": describe_skeleton(mechanism),
                "dynamics": analyze_forces(mechanism, self.dynamics, self.length_unit, at, speed, motion.acceleration),
            }
        return {
            "time": None if time is None else time.tolist(),
            **analyze_motion(
                mechanism, at, speed, motion.acceleration, tracked="branches" in self.include, points=points
            ),
            "fourbar": more,
            **planes,
            **met,
            **forces,
        }

    def _width(self) -> int:
        """Estimate the count of numbers in the answer at each position."""
        mechanism = self.mechanism.build_mechanism()
        tracks = len(mechanism.joints) + len(self.points)
        width = 4 * len(mechanism.links) + 8 * tracks + 4 * len(mechanism.slides) + 2 * len(self.include)
        if self.dynamics is not None:
            width += 4 * (len(mechanism.joints) + len(mechanism.links))
        return width

    @classmethod
    def analyze_cycle(cls, mechanism: JsonObject, steps: int) -> JsonObject:
        """Build the answer over a cycle: a full turn from the first target on, or from toggle to toggle."""
        given = _GIVEN_ADAPTER.validate_python(mechanism).build_mechanism()
        low, high = find_cycle(given)
        at = np.linspace(low, high, steps + 1)
        stated = at if given.has_slide_input else np.degrees(at)
        return {"time": None, **analyze_motion(given, stated, np.ones(steps + 1), 0.0), "fourbar": None}


class Series(Answer):
    """A quantity over the positions; null where the mechanism cannot be assembled, rates also at toggles."""

    angle: list[float | None]
    omega: list[float | None]
    alpha: list[float | None]
    jerk: list[float | None]


class Track(Answer):
    """A joint over the positions: coordinates and their time derivatives."""

    x: list[float | None]
    y: list[float | None]
    vx: list[float | None]
    vy: list[float | None]
    ax: list[float | None]
    ay: list[float | None]
    jx: list[float | None]
    jy: list[float | None]


class Travel(Answer):
    """A slide over the positions, along its line."""

    position: list[float | None]
    velocity: list[float | None]
    acceleration: list[float | None]
    jerk: list[float | None]


class Classification(Answer):
    """Grashof and Barker for a fourbar (null for others), and mobility."""

    grashof: str | None
    barker: int | None
    barker_code: str | None
    mobility: int


class BranchRange(Answer):
    """A branch: the input range that it covers; ``full`` where the input turns through."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    start: float = Field(alias="from")
    end: float = Field(alias="to")
    full: bool
    reference: bool = Field(description="Whether the reference configuration lies on it.")
    joints: dict[str, Points] | None = Field(
        default=None,
        description="Positions of the joints along the branch, if `include` contains `branches`; null if no "
        "assemblies distinguish the branches (class III, or a driving slider).",
    )


class CircuitBranches(Answer):
    """A circuit and its branches."""

    branches: list[BranchRange]


class LinkageAnalysis(Answer):
    """Analysis of a mechanism over the motion; degrees, rad/s, length units per second."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)

    input_angle: list[float]
    time: list[float] | None
    valid: list[bool]
    links: dict[str, Series]
    joints: dict[str, Track]
    points: dict[str, Track] = Field(description="The further points of the request.")
    slides: dict[str, Travel]
    transmission_angle: list[float | None] = Field(description="Minimum of the transmission angles, degrees.")
    transmission_angles: dict[str, list[float | None]] = Field(
        description="Transmission angle at each dyad and each leg of a triad, by link."
    )
    min_transmission_angle: float | None = Field(
        description="Minimum transmission angle over the motion, between the positions too, as in the metrics of "
        "designs: 0 if the motion reaches a toggle. Null as `transmission_angle` is."
    )
    torque_ratio: dict[str, list[float | None]] = Field(
        description="Output torque over input torque without losses: the mechanical advantage of each grounded link. "
        "For a driving slider the input torque is a force."
    )
    force_ratio: dict[str, list[float | None]] = Field(
        description="Output force over input torque (or over a driving slider's force) without losses, of each slide "
        "on the ground; per length unit."
    )
    instant_centers: dict[str, Points] = Field(
        description="Instant centre of every two links, as `link-link`; null if parallel. For a single position only."
    )
    classification: Classification
    toggles: list[float]
    circuits: list[CircuitBranches]
    limits: dict[str, list[float] | None] = Field(
        description="Extreme angles of the grounded links, and extreme positions of the slides, on the reference's "
        "branch; null for a link that makes full turns.",
    )
    notes: list[str] = Field(description="Names of missing fields, with the reason.")
    fourbar: FourbarAnalysis | None = Field(description="Results requested by `include`.")
    targets: list[MetTarget] | None = optional_field("Errors at each of the requested `targets`.")
    manufacture: ManufactureReport | None = optional_field(
        "Properties as manufactured, if the request contains `manufacture`."
    )
    yield_: Yield | None = optional_field("Yield, if `manufacture` has tolerances and a quality.", alias="yield")
    layout: Layout | None = optional_field("Arrangement in planes, if the request contains a `layout`.")
    skeleton: Skeleton | None = optional_field("The reference configuration to which points of `dynamics` refer.")
    dynamics: DynamicsAnswer | None = optional_field("Forces, if the request contains `dynamics`.")


FAMILY = Family(LinkageAnalysisRequest, LinkageAnalysis)
