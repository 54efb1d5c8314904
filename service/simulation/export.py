"""Export of designs as simulation text: MuJoCo models and scripts, URDF, Modelica."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.planar.mechanism import Mechanism
from service.simulation.course import USUAL_RPM, block_of, course_of
from service.simulation.linkage import linkage
from service.simulation.mjcf import mjcf
from service.simulation.model import Multibody
from service.simulation.modelica import modelica
from service.simulation.pmks import Model, pmks
from service.simulation.query import Form, NoSimulation, NotSimulated, SimulationQuery, unused
from service.simulation.script import script
from service.simulation.trains import MAKERS
from service.simulation.urdf import urdf
from service.simulation.weights import SCALE, weights_of
from synthesis.mechanisms import MechanismError as StatedMechanismError
from synthesis.model.dynamics import METRES
from synthesis.proof.rebuilt import rebuilt

LEAST = 1e-14
"""Minimum mass (kg) and inertia (kg m²) of a body. MuJoCo refuses values below 1e-15."""

MOST = 1e9
"""Maximum coordinate, rate or acceleration. MuJoCo resets the simulation above 1e10."""

WRITERS: dict[Form, Callable[[Multibody], str]] = {"mjcf": mjcf, "urdf": urdf, "mo": modelica, "sim.py": script}


def simulation(design: Any, problem: Any, title: str, form: Form, query: SimulationQuery) -> str:
    """Write a design as a simulation.

    Parameters
    ----------
    design : a design of any kind
    problem : StatedProblem
        The problem that it answers.
    title : str
        Free text.
    form : {"mjcf", "urdf", "mo", "sim.py"}
    query : SimulationQuery

    Raises
    ------
    NoSimulation
        The type of mechanism is not supported.
    NotSimulated
        The design cannot be simulated.
    """
    return WRITERS[form](machine_of_design(design, problem, title, form, query))


def machine_of_design(design: Any, problem: Any, title: str, form: Form, query: SimulationQuery) -> Multibody:
    """Build the machine that is simulated; raises as :func:`simulation` does."""
    machine = _made(design, problem, title, form, query)
    # The other formats have no such limit.
    if form in ("mjcf", "sim.py") and _greatest(machine) > MOST:
        raise NotSimulated("Coordinates of this design, or their rates, exceed 1e9, the limit for MuJoCo.")
    # MuJoCo's limits are absolute, so very small designs need a larger build.
    lightest = _lightest(machine)
    if lightest >= LEAST:
        return machine
    if query.scale is None:
        # The inertia of plates grows with the fifth power of their size.
        larger = 10.0 ** math.ceil(0.2 * math.log10(LEAST / lightest))
        # A larger build may violate other limits; then report the original problem.
        with contextlib.suppress(NotSimulated):
            machine = _made(design, problem, title, form, query.model_copy(update={"scale": larger}))
            if _lightest(machine) >= LEAST:
                told = f"Built {larger:g} times larger than the design: its bodies would be too light for MuJoCo."
                return replace(machine, remarks=(*machine.remarks, told))
    raise NotSimulated(
        f"The bodies of this design are too light for MuJoCo: {lightest:.2g} kg or kg m2, less than {LEAST:g}.",
        "" if query.scale is None else SCALE,
    )


def opened_in_pmks(design: Any, problem: Any) -> Model:
    """Return the address at which PMKS+ opens a design; raises as :func:`simulation` does."""
    if not hasattr(design.mechanism, "skeleton"):
        raise NoSimulation(design.mechanism.type)
    stated = getattr(getattr(problem, "dynamics", None), "speed_rpm", None)
    return pmks(_rebuilt(design), stated or USUAL_RPM)


def _rebuilt(design: Any) -> Mechanism:
    mechanism = rebuilt(design.mechanism, from_skeleton=True)
    if mechanism is None:
        raise NotSimulated("The dimensions of this design do not assemble to a mechanism.")
    return mechanism


def _greatest(machine: Multibody) -> float:
    """Estimate the largest joint coordinate, rate or acceleration of the motion by finite differences."""
    step, found = float(machine.times[1]), 0.0
    for course in machine.motion.values():
        rate = np.gradient(course, step)
        found = max(found, *(float(np.abs(jet).max()) for jet in (course, rate, np.gradient(rate, step))))
    return found


def _lightest(machine: Multibody) -> float:
    return min(min(body.mass, body.inertia) for body in machine.bodies)


def _made(design: Any, problem: Any, title: str, form: Form, query: SimulationQuery) -> Multibody:
    kind = design.mechanism.type
    if kind in MAKERS:
        return MAKERS[kind](design, problem, title, query)
    if not hasattr(design.mechanism, "skeleton"):
        raise NoSimulation(kind)
    try:
        return _linkage(design, problem, title, form, query)
    except (MechanismError, StatedMechanismError) as error:
        raise NotSimulated(f"This design cannot be driven: {error}.") from None


def _linkage(design: Any, problem: Any, title: str, form: Form, query: SimulationQuery) -> Multibody:
    unused(query, "a linkage", "gear")
    mechanism = _rebuilt(design)
    if form == "mo" and mechanism.redundant:
        raise NotSimulated(
            "The constraints of this design are redundant: Modelica's equations would be singular. "
            "Use .mjcf with MuJoCo instead."
        )
    inputs, speed = course_of(problem, design, mechanism, query)
    block = block_of(problem, design, mechanism)
    weights = weights_of(mechanism, block, getattr(problem, "layout", None), problem.length_unit, query)
    return linkage(mechanism, inputs, speed, weights, METRES[problem.length_unit] * query.built, title)
