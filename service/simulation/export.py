"""Export of designs as simulation text: MuJoCo models and scripts, URDF, Modelica."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.message import compose
from service.simulation.course import DEFAULT_RPM, get_dynamics, plan_motion
from service.simulation.linkage import build_linkage
from service.simulation.mjcf import write_mjcf
from service.simulation.model import Multibody
from service.simulation.modelica import write_modelica
from service.simulation.pmks import PmksModel, write_pmks
from service.simulation.query import Form, NoSimulation, NotSimulated, SimulationQuery, refuse_unused
from service.simulation.script import write_script
from service.simulation.trains import TRAIN_BUILDERS
from service.simulation.urdf import write_urdf
from service.simulation.weights import SCALE_PATH, compute_weights
from synthesis.mechanisms import MechanismError as StatedMechanismError
from synthesis.model.design_interface import AnyDesign
from synthesis.model.dynamics.request import METRES_PER_UNIT
from synthesis.model.problem import ProblemBase
from synthesis.verification.reconstruction import rebuild_mechanism

MIN_MASS = 1e-14
"""Minimum mass (kg) and inertia (kg m²) of a body. MuJoCo refuses values below 1e-15."""

MAX_COORDINATE = 1e9
"""Maximum coordinate, rate or acceleration. MuJoCo resets the simulation above 1e10."""

WRITERS: dict[Form, Callable[[Multibody], str]] = {
    "mjcf": write_mjcf,
    "urdf": write_urdf,
    "mo": write_modelica,
    "sim.py": write_script,
}


def write_simulation(design: AnyDesign, problem: ProblemBase, title: str, form: Form, query: SimulationQuery) -> str:
    """Write a design as a simulation.

    Parameters
    ----------
    design : a design of any kind
    problem : ProblemBase
        The problem that the design solves.
    title : str
        Free text.
    form : {"mjcf", "urdf", "mo", "sim.py"}
    query : SimulationQuery

    Raises
    ------
    NoSimulation
        If the type of mechanism is not supported.
    NotSimulated
        If the design cannot be simulated.
    """
    return WRITERS[form](build_machine(design, problem, title, form, query))


def build_machine(design: AnyDesign, problem: ProblemBase, title: str, form: Form, query: SimulationQuery) -> Multibody:
    """Build the machine that is simulated; the errors are those of :func:`write_simulation`."""
    machine = _build_unscaled(design, problem, title, form, query)
    # The other formats have no such limit.
    if form in ("mjcf", "sim.py") and _estimate_max_coordinate(machine) > MAX_COORDINATE:
        raise NotSimulated(compose("simulation-coordinates-too-large"))
    # MuJoCo's limits are absolute, so very small designs need a larger build.
    lightest = _find_min_mass(machine)
    if lightest >= MIN_MASS:
        return machine
    if query.scale is None:
        # The inertia of plates grows with the fifth power of their size.
        larger = 10.0 ** math.ceil(0.2 * math.log10(MIN_MASS / lightest))
        # A larger build may violate other limits; then report the original problem.
        with contextlib.suppress(NotSimulated):
            machine = _build_unscaled(design, problem, title, form, query.model_copy(update={"scale": larger}))
            if _find_min_mass(machine) >= MIN_MASS:
                remark = compose("simulation-built-larger", factor=f"{larger:g}")
                return replace(machine, remarks=(*machine.remarks, remark))
    raise NotSimulated(
        compose("simulation-bodies-too-light", lightest=f"{lightest:.2g}", least=f"{MIN_MASS:g}"),
        "" if query.scale is None else SCALE_PATH,
    )


def open_in_pmks(design: AnyDesign, problem: ProblemBase) -> PmksModel:
    """Return the address at which PMKS+ opens a design; the errors are those of :func:`write_simulation`."""
    if not hasattr(design.mechanism, "skeleton"):
        raise NoSimulation(design.mechanism.type)
    speed_rpm = getattr(getattr(problem, "dynamics", None), "speed_rpm", None)
    return write_pmks(_rebuild_mechanism(design), speed_rpm or DEFAULT_RPM)


def _rebuild_mechanism(design: AnyDesign) -> Mechanism:
    mechanism = rebuild_mechanism(design.mechanism, from_skeleton=True)
    if mechanism is None:
        raise NotSimulated(compose("simulation-does-not-assemble"))
    return mechanism


def _estimate_max_coordinate(machine: Multibody) -> float:
    """Estimate the largest joint coordinate, rate or acceleration of the motion by finite differences."""
    step, found = float(machine.times[1]), 0.0
    for course in machine.motion.values():
        rate = np.gradient(course, step)
        found = max(found, *(float(np.abs(jet).max()) for jet in (course, rate, np.gradient(rate, step))))
    return found


def _find_min_mass(machine: Multibody) -> float:
    return min(min(body.mass, body.inertia) for body in machine.bodies)


def _build_unscaled(
    design: AnyDesign, problem: ProblemBase, title: str, form: Form, query: SimulationQuery
) -> Multibody:
    kind = design.mechanism.type
    if kind in TRAIN_BUILDERS:
        return TRAIN_BUILDERS[kind](design, problem, title, query)
    if not hasattr(design.mechanism, "skeleton"):
        raise NoSimulation(kind)
    try:
        return _build_linkage(design, problem, title, form, query)
    except (MechanismError, StatedMechanismError) as error:
        raise NotSimulated(compose("simulation-cannot-be-driven", reason=str(error))) from None


def _build_linkage(
    design: AnyDesign, problem: ProblemBase, title: str, form: Form, query: SimulationQuery
) -> Multibody:
    refuse_unused(query, "simulation-unused-with-linkage", "gear")
    mechanism = _rebuild_mechanism(design)
    if form == "mo" and mechanism.redundant:
        raise NotSimulated(compose("simulation-redundant-constraints"))
    inputs, speed = plan_motion(problem, design, mechanism, query)
    block = get_dynamics(problem, design, mechanism)
    weights = compute_weights(mechanism, block, getattr(problem, "layout", None), problem.length_unit, query)
    return build_linkage(mechanism, inputs, speed, weights, METRES_PER_UNIT[problem.length_unit] * query.built, title)
