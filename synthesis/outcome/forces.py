"""Forces of designs, for the block ``dynamics`` of a statement: results and checks."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.model.answer import Check, Result, Verification
from synthesis.model.bodies import Shape, StatedBody
from synthesis.model.dimension import FORCE, POWER, TORQUE, Dimension
from synthesis.model.dynamics import DesignDynamics, LengthUnit, WeighedLinkage
from synthesis.model.forces_answer import DesignForces, ForcePeak, JointForcePeak, PowerPeak, TorquePeak
from synthesis.model.linkage_statement import Constraints, Force, LinkageProblem
from synthesis.model.statement import StatedProblem
from synthesis.proof.checks import at_most
from synthesis.proof.rebuilt import rebuilt

Design = TypeVar("Design", bound=Any)

STEPS = 72
"""Number of steps of a motion, between which peaks are refined."""

DIMENSIONS: Mapping[Force, Dimension | None] = {
    "drive_torque": TORQUE,
    "joint_force": FORCE,
    "shaking_force": FORCE,
    "shaking_moment": TORQUE,
    "power": POWER,
    "joint_force_index": None,
}
"""Dimension of each limit on forces."""


def held_to_forces(problem: StatedProblem, design: Design) -> Design:
    """Return a design with its forces and their checks, if it passed all other checks and forces are limited."""
    if not isinstance(problem, LinkageProblem) or not problem.constraints.of_forces or problem.dynamics is None:
        return design
    if not design.verification.passed:
        return design
    return with_force_checks(problem.constraints, with_forces(problem, design))


def with_force_checks(constraints: Constraints, design: Design) -> Design:
    """Replace the force checks of a design with known forces by checks of the given limits."""
    limits = constraints.of_forces
    if not limits:
        return design
    checks = [check for check in design.verification.checks if check.name not in limits]
    for name, limit in limits.items():
        value = value_of(design, name)
        checks.append(
            Check(name=name, passed=False, limit=limit, dimension=DIMENSIONS[name])
            if value is None
            else at_most(name, value, limit, DIMENSIONS[name])
        )
    checked: Design = design.model_copy(update={"verification": Verification.of(checks)})
    return checked


def value_of(design: Any, name: str) -> float | None:
    """Return the peak that the limit on ``name`` refers to; None if unknown."""
    found = None if design.forces is None else getattr(design.forces, name)
    return found if found is None or isinstance(found, float) else float(found.max)


def all_with_forces(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """Return an answer with the forces of all its designs and of the nearest miss; unchanged without `dynamics`."""
    if problem.dynamics is None:
        return result
    miss = result.nearest_miss
    if miss is not None:
        miss = miss.model_copy(update={"design": with_forces(problem, miss.design)})
    designs = [with_forces(problem, design) for design in result.designs]
    return result.model_copy(update={"designs": designs, "nearest_miss": miss})


def unknown_told(problem: LinkageProblem, result: Result[Any]) -> Result[Any]:
    """Add the reason why the nearest miss has no forces to the summary, if forces are limited."""
    miss = result.nearest_miss
    forces = None if miss is None else miss.design.forces
    if not problem.constraints.of_forces or forces is None or forces.remark is None:
        return result
    return result.model_copy(update={"summary": f"{result.summary} Its forces are not known: {forces.remark}."})


def with_forces(problem: LinkageProblem, design: Design) -> Design:
    """Return a design with its forces; unchanged if it already has them."""
    if problem.dynamics is None or design.forces is not None:
        return design
    measured: Design = design.model_copy(update={"forces": _forces(problem, problem.dynamics, design)})
    return measured


class NoForces(ValueError):
    """Raised if the forces of a design are unknown; carries the responsible field below the problem, if any."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}" if path else detail)


class Run(NamedTuple):
    """Drive of a design: its masses and loads, its inputs (degrees or length units) and their speed.

    The speed is in rad/s, or length units a second.
    """

    mechanism: Mechanism
    block: DesignDynamics
    at: NDArray[np.float64]
    speed: float


def run_of(stated: DesignDynamics, design: Any, steps: int = STEPS) -> Run:
    """Prepare a design for a whole cycle if its input rotates fully, otherwise for its verified range.

    Parameters
    ----------
    stated : DesignDynamics
        What every design weighs and carries.
    design : a design of linkages
        With its mechanism and metrics.
    steps : int
        Of each turn, or of the range.

    Raises
    ------
    NoForces
        Where the block does not fit the design.
    """
    from synthesis.mechanisms.machine import weight_faults

    if stated.links is not None and stated.plate is None:
        raise NoForces("/dynamics/links", stated.laid_out(None) or "")
    mechanism = rebuilt(design.mechanism, from_skeleton=True)
    if mechanism is None:
        raise NoForces("", "no mechanism can be built from these dimensions")
    block = shaped(stated, mechanism.links)
    for path, detail in weight_faults(block, mechanism):
        raise NoForces(_as_written(stated, path), detail)
    slides = mechanism.driven_by_slide
    speed = stated.speed if slides else stated.speed_rpm
    if speed is None:
        missing, moves = ("speed", "slides") if slides else ("speed_rpm", "turns")
        raise NoForces(f"/dynamics/{missing}", f"the input of this linkage {moves}; state it")
    at = _motion(block, mechanism, design.metrics, steps)
    if at is None:
        raise NoForces("", "the design has no verified motion")
    return Run(mechanism, block, at, speed if slides else speed * math.tau / 60.0)


def _forces(problem: LinkageProblem, stated: DesignDynamics, design: Any) -> DesignForces:
    # Only who states the block waits for the import.
    from synthesis.analyses.dynamics import Undetermined, peaks_of

    try:
        run = run_of(stated, design)
        closed, peaks = peaks_of(run.mechanism, run.block, problem.length_unit, run.at, run.speed)
    except (NoForces, Undetermined) as error:
        return DesignForces(units=stated.units, remark=str(error))
    joint = max((name for name in peaks if name.startswith("joint ")), key=lambda name: peaks[name].value)
    slides = run.mechanism.driven_by_slide

    def told(name: str) -> dict[str, float]:
        return {"max": peaks[name].value, "at_place" if slides else "at": peaks[name].at}

    drive = {"drive_force": ForcePeak(**told("drive"))} if slides else {"drive_torque": TorquePeak(**told("drive"))}
    return DesignForces(
        units=stated.units,
        over="cycle" if closed else "used",
        **drive,
        joint_force=JointForcePeak(joint=joint.removeprefix("joint "), **told(joint)),
        shaking_force=ForcePeak(**told("shaking force")),
        shaking_moment=TorquePeak(**told("shaking moment")),
        power=PowerPeak(**told("power")),
        joint_force_index=peaks["index"].value if "index" in peaks else None,
    )


def forces_over_motion(stated: DesignDynamics, design: Any, unit: LengthUnit, steps: int) -> dict[str, Any]:
    """Analyze a design's motion with all forces, in the form of :class:`synthesis.analyses.linkage.LinkageAnalysis`.

    Parameters
    ----------
    stated : DesignDynamics
        What it weighs and carries; with the wishes of a :class:`DynamicsBlock`, where it has them.
    design : a design of linkages
        As it was answered.
    unit : str
        Its length unit.
    steps : int
        Of each turn, or of the range.

    Raises
    ------
    NoForces
        Where the block does not fit the design.
    """
    from synthesis.analyses.linkage import LinkageAnalysisRequest

    run = run_of(stated, design, steps)
    own = {name for name in DesignDynamics.model_fields if name not in WeighedLinkage.model_fields}
    block = run.block.model_dump(mode="json", by_alias=True, exclude_unset=True, exclude=own)
    request = LinkageAnalysisRequest.model_validate(
        {
            "mechanism": design.mechanism.model_dump(mode="json", by_alias=True, exclude_none=True),
            "motion": {"from": run.at[0], "to": run.at[-1], "steps": len(run.at) - 1, "speed": run.speed},
            "length_unit": unit,
            "dynamics": block,
        }
    )
    for path, detail in request.faults():
        raise NoForces(_as_written(stated, path), detail)
    return request.answer()


def _as_written(stated: DesignDynamics, path: str) -> str:
    """Map the path of an error in a link's generated body to the shape of all links, which the client wrote."""
    parts = path.split("/")
    if parts[1:3] != ["dynamics", "bodies"] or stated.links is None or "shape" not in parts[4:5]:
        return path
    unescaped = parts[3].replace("~1", "/").replace("~0", "~")
    return path if unescaped in stated.bodies else "/".join(["/dynamics/links", *parts[5:]])


def shaped(stated: DesignDynamics, links: Mapping[str, Sequence[str]]) -> DesignDynamics:
    """Return the block with the shape of all links assigned to the links of a mechanism that it does not name."""
    if stated.plate is None:
        return stated
    bodies = dict(stated.bodies)
    for link, joints in links.items():
        if link != GROUND and link not in bodies:
            bodies[link] = StatedBody(shape=_shaped_for(stated.plate, joints))
    return stated.model_copy(update={"bodies": bodies, "links": None})


def _shaped_for(shape: Shape, joints: Sequence[str]) -> Shape:
    """Fit the shape of all links to one link: keep the holes of its own joints, and the ends only for a bar."""
    holes = {joint: diameter for joint, diameter in shape.holes.items() if joint in joints}
    update: dict[str, Any] = {"holes": holes}
    if len(joints) != 2:
        update |= {"ends": "round", "overhang": 0.0}
    return shape.model_copy(update=update)


def _motion(block: DesignDynamics, mechanism: Mechanism, metrics: Any, steps: int) -> NDArray[np.float64] | None:
    """Return the inputs of a whole cycle of mechanism and loads if the input rotates fully, else as verified."""
    from synthesis.mechanisms.courses import repeated_after

    turns_through = getattr(metrics, "full_rotation", False)  # a steering linkage is not asked to
    if turns_through and not mechanism.driven_by_slide:
        turns = repeated_after(block, mechanism)
        if turns:
            start = math.degrees(mechanism.reference_input)
            return start + np.linspace(0.0, 360.0 * turns, steps * turns + 1)
    ends = metrics.used_stroke if mechanism.driven_by_slide else metrics.used_range
    return None if ends is None else np.linspace(float(ends[0]), float(ends[1]), steps + 1)
