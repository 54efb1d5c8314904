"""Verification of a balanced linkage: drive the answer, and sum all joint reactions on its frame.

Nothing is taken from the search. Mechanism and dynamics block are read from the answer as ``POST /v1/analyses`` would
read them. The shaking force is the sum of all joint forces on the frame (Newton's and Euler's equations link by link),
whereas the solver derives the counterweights from the momentum.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import compute_reactions
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses.linkages.requested_motion import Task, place_machine
from synthesis.kinds.balancing.design import (
    BalancedDesign,
    BalancedLinkage,
    BalanceMetrics,
    Counterweight,
    GearedInertia,
)
from synthesis.kinds.balancing.linkage.dynamics_block import add_weights, with_inertias
from synthesis.kinds.balancing.linkage.force_balance import Weight
from synthesis.kinds.balancing.linkage.motion import find_pivot, strip_loads
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.mechanisms.machine import build_machine
from synthesis.mechanisms.skeleton import GivenSkeleton, describe_skeleton
from synthesis.model.answer import Verification
from synthesis.model.dynamics.request import DynamicsBlock
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.answer import Skeleton
from synthesis.verification.checks import check_error

POSITION_COUNT = 720
"""Minimum number of positions at which the forces are measured; the motion's own steps are used if there are more."""

BALANCE_TOLERANCE = 1e-9
"""Remaining peak, as a share of the unbalanced one, that is attributed to rounding."""

GRAM_MILLIMETRES = 1e6
"""g·mm in a kg·m."""


class Shaking(NamedTuple):
    """Peaks over the positions at which the reactions are known.

    ``parts`` are the peaks of force and moment that would result if the contributions of all bodies added up in
    magnitude: the scale of rounding.
    """

    force: float
    moment: float
    drive: float
    parts: tuple[float, float]


def measure_shaking(machine: Machine, task: Task, count: int, acceleration: float) -> Shaking:
    """Measure the peaks of the forces due to a machine's own inertia over the motion of a task."""
    now = place_machine(strip_loads(machine), task.list_positions(count), task.speed, acceleration)
    found = compute_reactions(strip_loads(machine), now)
    # Positions at which the reactions are determined.
    known = found.solved
    if not known.any():
        return Shaking(math.nan, math.nan, math.nan, (math.nan, math.nan))
    force, moment, drive = (
        float(np.abs(values[known]).max()) for values in (found.shaking_force, found.shaking_moment, found.drive)
    )
    alone, tilting = (float(values[known].max()) for values in _sum_parts(machine, now))
    return Shaking(force, moment, drive, (alone, tilting))


def _sum_parts(machine: Machine, now: Places) -> tuple[Real, Real]:
    """Compute Σ m |r''| and Σ (m |r − c| |r''| + I |φ''|) over positions, the scales of force and moment."""
    forces, moments = np.zeros(now.smooth.shape), np.zeros(now.smooth.shape)
    moved = [(part.mass, now.point(link, part.cg)) for link, part in machine.bodies.items()]
    moved += [(mass, now.joints[joint]) for joint, mass in machine.pin_masses.items()]
    for mass, (place, _, acceleration) in moved:
        force = np.asarray(mass)[..., None] * np.abs(acceleration)
        forces, moments = forces + force, moments + np.abs(place - machine.about) * force
    for link, part in machine.bodies.items():
        # Pin masses have no inertia of their own.
        moments = moments + np.asarray(part.inertia)[..., None] * np.abs(now.spins[link][2])
    return forces, moments


def verify_linkage(
    problem: BalancingProblem,
    task: Task,
    mechanism: Mechanism,
    weights: Sequence[Weight],
    inertias: dict[str, float],
) -> BalancedDesign:
    """Measure a linkage with its counterweights; ``inertias`` are those of the geared links by name."""
    answer, block = build_answer(problem, task, mechanism, weights, inertias)
    machine = build_answer_machine(problem, answer, block)
    count = max(POSITION_COUNT, problem.motion.steps)
    # Test with an acceleration as influential as the speed, too: an exact balance must hold in any motion.
    accelerated = task.acceleration + _compute_matching_acceleration(task)
    first, last = (measure_shaking(one, task, count, task.acceleration) for one in (task.machine, machine))
    before, after = (measure_shaking(one, task, count, accelerated) for one in (task.machine, machine))
    checks = [
        check_error("shaking_force", _compute_force_share(last, first), BALANCE_TOLERANCE),
        check_error("shaking_force_accelerated", _compute_force_share(after, before), BALANCE_TOLERANCE),
    ]
    value = _compute_force_share(last, first)
    if problem.goal == "force_and_moment":
        checks += [
            check_error("shaking_moment", _compute_moment_share(last, first), BALANCE_TOLERANCE),
            check_error("shaking_moment_accelerated", _compute_moment_share(after, before), BALANCE_TOLERANCE),
        ]
        value = max(value, _compute_moment_share(last, first))
    metrics = BalanceMetrics(
        value=value,
        bound=0.0,
        levels=[],
        shaking_force=last.force,
        unbalanced_shaking_force=first.force,
        shaking_moment=last.moment,
        unbalanced_shaking_moment=first.moment,
        drive=last.drive,
        unbalanced_drive=first.drive,
        added_mass=math.fsum(weight.mass for weight in weights),
    )
    return BalancedDesign(
        mechanism=answer,
        dynamics=block,
        counterweights=[describe_weight(problem, task.machine, weight) for weight in weights],
        geared=[
            GearedInertia(link=gear.second, against=gear.first, ratio=gear.ratio, inertia=inertias[gear.second])
            for gear in mechanism.gears
            if gear.second in inertias
        ],
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def build_answer(
    problem: BalancingProblem,
    task: Task,
    mechanism: Mechanism,
    weights: Sequence[Weight],
    inertias: dict[str, float],
) -> tuple[BalancedLinkage, JsonObject]:
    """Build the mechanism and the dynamics block of an answer."""
    assert problem.dynamics is not None
    block = with_inertias(add_weights(task.machine, problem.dynamics, weights), inertias)
    return BalancedLinkage(skeleton=Skeleton.model_validate(describe_skeleton(mechanism))), block


def build_answer_machine(problem: BalancingProblem, mechanism: BalancedLinkage, block: JsonObject) -> Machine:
    """Build the machine from the mechanism and the dynamics block of an answer, read as in an analysis."""
    # Use only the data of the answer, not the solver's own.
    built = GivenSkeleton.model_validate(mechanism.model_dump()).build_mechanism()
    return build_machine(DynamicsBlock.model_validate(block), built, problem.length_unit)[0]


def _compute_matching_acceleration(task: Task) -> float:
    """Return the input acceleration that has an effect of the same size as the speed."""
    # A slide's range sets the length scale of its acceleration.
    if task.machine.mechanism.has_slide_input:
        return task.speed**2 / abs(task.end - task.start) if task.end != task.start else 1.0
    return task.speed**2


def _compute_force_share(after: Shaking, before: Shaking) -> float:
    return _compute_share(after.force, before.force, before.parts[0], after.parts[0])


def _compute_moment_share(after: Shaking, before: Shaking) -> float:
    return _compute_share(after.moment, before.moment, before.parts[1], after.parts[1])


def _compute_share(part: float, whole: float, parts: float, parts_after: float) -> float:
    """Return the remaining share of a whole; if the whole is only rounding of its parts, the share of the parts."""
    if whole <= BALANCE_TOLERANCE * parts or whole == 0.0:
        whole = max(parts, parts_after)
    return part / whole if whole > 0.0 else part


def describe_weight(problem: BalancingProblem, machine: Machine, weight: Weight) -> Counterweight:
    """Describe a weight in the units of the answer."""
    assert problem.dynamics is not None
    mechanism, scale, stated = machine.mechanism, machine.scale, problem.counterweights
    joint = find_pivot(mechanism, weight.link)
    about = complex(mechanism.joints[joint])
    # The angle is measured from a joint that differs from the pivot.
    other = next(
        name for name in mechanism.links[weight.link] if name != joint and _is_off_pivot(mechanism, weight, name)
    )
    arm = weight.at / scale - about
    line = complex(mechanism.joints[other]) - about
    written = GRAM_MILLIMETRES * scale if problem.dynamics.units == "si" else 1.0
    # A disc of the counterweight's mass, if density and thickness are given.
    disc = None
    if stated.density is not None and stated.thickness is not None and weight.mass > 0.0:
        disc = math.sqrt(weight.mass / (math.pi * stated.density * scale * stated.thickness)) / scale
    at = weight.at / scale
    return Counterweight(
        link=weight.link,
        mass=weight.mass,
        at=(at.real, at.imag),
        joint=joint,
        radius=abs(arm),
        angle=math.degrees(cmath.phase(arm / line)) if arm != 0.0 else 0.0,
        moment=written * weight.mass * abs(arm),
        inertia=weight.inertia,
        disc_radius=disc,
    )


def _is_off_pivot(mechanism: Mechanism, weight: Weight, joint: str) -> bool:
    """Return whether a joint of the weight's link is not at its pivot."""
    return complex(mechanism.joints[joint]) != complex(mechanism.joints[find_pivot(mechanism, weight.link)])
