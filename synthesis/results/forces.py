"""Forces of designs and their checks, for the block ``dynamics`` of a statement."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose, join_messages
from synthesis.model.answer import AnyResult, Check, Verification
from synthesis.model.dimension import FORCE, POWER, TORQUE, Dimension
from synthesis.model.dynamics.bodies import BodySpec, Shape
from synthesis.model.dynamics.peak_forces import DesignForces, ForcePeak, JointForcePeak, PowerPeak, TorquePeak
from synthesis.model.dynamics.request import DesignDynamics, ForceQuantity, LengthUnit, LoadedLinkage
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import MotionMetrics
from synthesis.model.linkage.problem import Constraints, LinkageProblem
from synthesis.model.protocols import DrivenDesign, LinkageMeasures
from synthesis.results.remarks import append_remark
from synthesis.verification.checks import check_maximum
from synthesis.verification.reconstruction import rebuild_mechanism

Design = TypeVar("Design", bound=DrivenDesign)

STEP_COUNT = 72
"""Number of steps per turn, or of the range, between which peaks are refined."""

DIMENSIONS: Mapping[ForceQuantity, Dimension | None] = {
    "drive_torque": TORQUE,
    "joint_force": FORCE,
    "shaking_force": FORCE,
    "shaking_moment": TORQUE,
    "power": POWER,
    "joint_force_index": None,
}
"""Dimension of each limit on forces."""


def check_forces(problem: LinkageProblem, design: Design) -> Design:
    """Return a design with its forces and the checks of its force limits."""
    return add_force_checks(problem.constraints, add_forces(problem, design))


def add_force_checks(constraints: Constraints, design: Design) -> Design:
    """Replace the force checks of a design with known forces by checks of the given limits."""
    limits = constraints.force_limits
    if not limits:
        return design
    # Checks may come from a narrower search, whose limits do not apply here.
    checks = [check for check in design.verification.checks if check.name not in limits]
    for name, limit in limits.items():
        value = get_peak(design, name)
        checks.append(
            # Unknown forces cannot be proven to be within the limit.
            Check(name=name, passed=False, limit=limit, dimension=DIMENSIONS[name])
            if value is None
            else check_maximum(name, value, limit, DIMENSIONS[name])
        )
    return design.model_copy(update={"verification": Verification.from_checks(checks)})


def get_peak(design: DrivenDesign, name: str) -> float | None:
    """Return the peak of the force ``name``, to which its limit refers; None if it is unknown."""
    found = None if design.forces is None else getattr(design.forces, name)
    return found if found is None or isinstance(found, float) else float(found.max)


def report_unknown_forces(problem: LinkageProblem, result: AnyResult) -> AnyResult:
    """Add the reason why the nearest miss has no forces to the summary, if forces are limited."""
    miss = result.nearest_miss
    forces = None if miss is None else miss.design.forces
    if not problem.constraints.force_limits or forces is None or forces.remark is None:
        return result
    remark = compose("results-forces-unknown", reason=forces.remark)
    return result.model_copy(update={"summary": append_remark(result.summary, remark)})


def add_forces(problem: LinkageProblem, design: Design) -> Design:
    """Return a design with its forces; unchanged if it already has them."""
    if problem.dynamics is None or design.forces is not None:
        return design
    return design.model_copy(update={"forces": _compute_forces(problem, problem.dynamics, design)})


class ForcesUnknownError(ValueError):
    """Raised if the forces of a design are unknown; carries the path of the responsible field, if there is one."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(join_messages([path, detail], ": "))


class DriveSetup(NamedTuple):
    """A design prepared for the computation of its forces.

    Attributes
    ----------
    mechanism : Mechanism
        The design in its reference configuration.
    block : DesignDynamics
        Its masses and loads.
    at : float, shape (n,)
        Inputs, degrees or length units.
    speed : float
        Input speed, rad/s or length units per second.
    """

    mechanism: Mechanism
    block: DesignDynamics
    at: NDArray[np.float64]
    speed: float


def prepare_drive(dynamics: DesignDynamics, design: DrivenDesign, steps: int = STEP_COUNT) -> DriveSetup:
    """Prepare a design to be driven through a whole cycle if its input rotates fully, otherwise its verified range.

    Parameters
    ----------
    dynamics : DesignDynamics
        Masses and loads of every design.
    design : a design of linkages
        Verified design with its mechanism and metrics.
    steps : int
        Number of steps per turn, or of the range.

    Raises
    ------
    ForcesUnknownError
        If the block does not fit the design.
    """
    from synthesis.mechanisms.machine import find_weight_errors

    # The links' thickness follows from the layout, which this design lacks.
    if dynamics.links is not None and dynamics.plate is None:
        raise ForcesUnknownError("/dynamics/links", dynamics.fill_from_layout(None) or "")
    mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
    if mechanism is None:
        raise ForcesUnknownError("", compose("results-no-mechanism-from-dimensions"))
    block = apply_link_shape(dynamics, mechanism.links)
    for path, detail in find_weight_errors(block, mechanism):
        # Report the first error; others often follow from it.
        raise ForcesUnknownError(map_error_path(dynamics, path), detail)
    slides = mechanism.has_slide_input
    speed = dynamics.speed if slides else dynamics.speed_rpm
    if speed is None:
        if slides:
            raise ForcesUnknownError("/dynamics/speed", compose("results-sliding-speed-missing"))
        raise ForcesUnknownError("/dynamics/speed_rpm", compose("results-rotating-speed-missing"))
    at = _list_inputs(block, mechanism, design.metrics, steps)
    if at is None:
        raise ForcesUnknownError("", compose("results-no-verified-motion"))
    return DriveSetup(mechanism, block, at, speed if slides else speed * math.tau / 60.0)


def _compute_forces(problem: LinkageProblem, dynamics: DesignDynamics, design: DrivenDesign) -> DesignForces:
    # A local import: only problems with this block need the module.
    from synthesis.analyses.linkages.dynamics import UndeterminedForcesError, find_force_peaks

    try:
        run = prepare_drive(dynamics, design)
        closed, peaks = find_force_peaks(run.mechanism, run.block, problem.length_unit, run.at, run.speed)
    except (ForcesUnknownError, UndeterminedForcesError) as error:
        return DesignForces(units=dynamics.units, remark=str(error))
    # Limits refer to the most loaded joint.
    joint = max((name for name in peaks if name.startswith("joint ")), key=lambda name: peaks[name].value)
    slides = run.mechanism.has_slide_input

    def collect_peak(name: str) -> dict[str, float]:
        return {"max": peaks[name].value, "at_place" if slides else "at": peaks[name].at}

    drive = (
        {"drive_force": ForcePeak(**collect_peak("drive"))}
        if slides
        else {"drive_torque": TorquePeak(**collect_peak("drive"))}
    )
    return DesignForces(
        units=dynamics.units,
        over="cycle" if closed else "used",
        **drive,
        joint_force=JointForcePeak(joint=joint.removeprefix("joint "), **collect_peak(joint)),
        shaking_force=ForcePeak(**collect_peak("shaking force")),
        shaking_moment=TorquePeak(**collect_peak("shaking moment")),
        power=PowerPeak(**collect_peak("power")),
        joint_force_index=peaks["index"].value if "index" in peaks else None,
    )


def compute_forces_over_motion(
    dynamics: DesignDynamics, design: DrivenDesign, unit: LengthUnit, steps: int
) -> JsonObject:
    """Analyze a design's motion with all its forces.

    The answer has the form of :class:`synthesis.analyses.linkages.linkage.LinkageAnalysis`.

    Parameters
    ----------
    dynamics : DesignDynamics
        Masses and loads; the report options of a :class:`DynamicsBlock` are used if it has them.
    design : a design of linkages
        The design, as in the answer.
    unit : str
        Length unit of the design.
    steps : int
        Number of steps per turn, or of the range.

    Raises
    ------
    ForcesUnknownError
        If the block does not fit the design.
    """
    from synthesis.analyses.linkages.linkage import LinkageAnalysisRequest

    run = prepare_drive(dynamics, design, steps)
    # Fields that only designs have, such as the shape of all links, have already been applied to the links.
    own = {name for name in DesignDynamics.model_fields if name not in LoadedLinkage.model_fields}
    block = run.block.model_dump(mode="json", by_alias=True, exclude_unset=True, exclude=own)
    request = LinkageAnalysisRequest.model_validate(
        {
            "mechanism": design.mechanism.model_dump(mode="json", by_alias=True, exclude_none=True),
            "motion": {"from": run.at[0], "to": run.at[-1], "steps": len(run.at) - 1, "speed": run.speed},
            "length_unit": unit,
            "dynamics": block,
        }
    )
    for path, detail in request.find_errors():
        raise ForcesUnknownError(map_error_path(dynamics, path), detail)
    return request.build_answer()


def map_error_path(dynamics: DesignDynamics, path: str) -> str:
    """Map the path of an error in a generated body of a link to the shape of all links, the field that was given."""
    parts = path.split("/")
    if parts[1:3] != ["dynamics", "bodies"] or dynamics.links is None or "shape" not in parts[4:5]:
        return path
    # Undo the escaping of JSON pointers in the reverse order.
    unescaped = parts[3].replace("~1", "/").replace("~0", "~")
    return path if unescaped in dynamics.bodies else "/".join(["/dynamics/links", *parts[5:]])


def apply_link_shape(dynamics: DesignDynamics, links: Mapping[str, Sequence[str]]) -> DesignDynamics:
    """Return the block with the shape of all links assigned to the moving links that ``bodies`` does not name."""
    if dynamics.plate is None:
        return dynamics
    bodies = dict(dynamics.bodies)
    for link, joints in links.items():
        if link != GROUND and link not in bodies:
            bodies[link] = BodySpec(shape=_fit_shape_to_link(dynamics.plate, joints))
    return dynamics.model_copy(update={"bodies": bodies, "links": None})


def _fit_shape_to_link(shape: Shape, joints: Sequence[str]) -> Shape:
    """Fit the shape of all links to one link: keep the holes of its own joints, and the ends only for a bar."""
    holes = {joint: diameter for joint, diameter in shape.holes.items() if joint in joints}
    update: dict[str, object] = {"holes": holes}
    # A link with more than two joints is a hull, which has no square ends.
    if len(joints) != 2:
        update |= {"ends": "round", "overhang": 0.0}
    return shape.model_copy(update=update)


def _list_inputs(
    block: DesignDynamics, mechanism: Mechanism, metrics: LinkageMeasures, steps: int
) -> NDArray[np.float64] | None:
    """Return the inputs of a whole cycle of mechanism and loads if the input rotates fully, else of the verified range.

    Return None if the design has no verified motion.
    """
    from synthesis.mechanisms.courses import find_period_turns

    # The metrics of steering linkages lack this field; their input never rotates fully.
    turns_through = isinstance(metrics, MotionMetrics) and metrics.full_rotation
    if turns_through and not mechanism.has_slide_input:
        turns = find_period_turns(block, mechanism)
        # 0 means that motion and loads never repeat together.
        if turns:
            start = math.degrees(mechanism.reference_input)
            # The last position repeats the first, as the force analysis of a closed motion expects.
            return start + np.linspace(0.0, 360.0 * turns, steps * turns + 1)
    ends = metrics.used_stroke if mechanism.has_slide_input else metrics.used_range
    return None if ends is None else np.linspace(float(ends[0]), float(ends[1]), steps + 1)
