"""Verification of a balanced linkage: drive the answer, and sum the forces on its frame from all joint reactions.

Nothing is taken from the search: mechanism and block are read from the answer as ``POST /v1/analyses`` would read them,
and the shaking force is the sum of all joint forces on the frame (Newton and Euler link by link), while the
counterweights come from momentum.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.dynamics.reactions import reactions
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.analyses.driven import Task, placed
from synthesis.kinds.balancing.block import weighted, with_inertias
from synthesis.kinds.balancing.design import (
    BalancedDesign,
    BalancedLinkage,
    BalanceMetrics,
    Counterweight,
    GearedInertia,
)
from synthesis.kinds.balancing.driven import inertial, pivot
from synthesis.kinds.balancing.force_balance import Weight
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.mechanisms.machine import machine_of
from synthesis.mechanisms.skeleton import GivenSkeleton, skeleton_of
from synthesis.model.answer import Verification
from synthesis.model.dynamics import DynamicsBlock
from synthesis.model.linkage_answer import Skeleton
from synthesis.proof.checks import tolerated

Real = NDArray[np.float64]

POSITIONS = 720
"""Number of positions over the motion at which the forces are measured; the motion's steps if these are more."""

BALANCED = 1e-9
"""Share of the unbalanced peak that is attributed to rounding."""

GRAM_MILLIMETRES = 1e6
"""g·mm in a kg·m."""


class Shaking(NamedTuple):
    """Peaks over the positions at which the reactions are known; ``parts`` are the peaks of force and moment if the
    contributions of all parts of the linkage added up in magnitude.
    """

    force: float
    moment: float
    drive: float
    parts: tuple[float, float]


def measured(machine: Machine, task: Task, count: int, acceleration: float) -> Shaking:
    """Measure the peaks of a machine's own inertia over the motion of a task."""
    now = placed(inertial(machine), task.positions(count), task.speed, acceleration)
    found = reactions(inertial(machine), now)
    # Positions at which the reactions are determined.
    known = found.solved
    if not known.any():
        return Shaking(math.nan, math.nan, math.nan, (math.nan, math.nan))
    force, moment, drive = (
        float(np.abs(values[known]).max()) for values in (found.shaking_force, found.shaking_moment, found.drive)
    )
    alone, tilting = (float(values[known].max()) for values in _parts(machine, now))
    return Shaking(force, moment, drive, (alone, tilting))


def _parts(machine: Machine, now: Places) -> tuple[Real, Real]:
    """Compute Σ m |r''|, and Σ m |r − c| |r''| + I |φ''|, over positions."""
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
    answer, block = answer_of(problem, task, mechanism, weights, inertias)
    machine = machine_of_answer(problem, answer, block)
    count = max(POSITIONS, problem.motion.steps)
    # Also with an acceleration that matters as much as the speed: exact balance must hold in any motion.
    accelerated = task.acceleration + _matching(task)
    first, last = (measured(one, task, count, task.acceleration) for one in (task.machine, machine))
    before, after = (measured(one, task, count, accelerated) for one in (task.machine, machine))
    checks = [
        tolerated("shaking_force", _force_share(last, first), BALANCED),
        tolerated("shaking_force_accelerated", _force_share(after, before), BALANCED),
    ]
    value = _force_share(last, first)
    if problem.goal == "force_and_moment":
        checks += [
            tolerated("shaking_moment", _moment_share(last, first), BALANCED),
            tolerated("shaking_moment_accelerated", _moment_share(after, before), BALANCED),
        ]
        value = max(value, _moment_share(last, first))
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
        counterweights=[told(problem, task.machine, weight) for weight in weights],
        geared=[
            GearedInertia(link=gear.second, against=gear.first, ratio=gear.ratio, inertia=inertias[gear.second])
            for gear in mechanism.gears
            if gear.second in inertias
        ],
        verification=Verification.of(checks),
        metrics=metrics,
    )


def answer_of(
    problem: BalancingProblem,
    task: Task,
    mechanism: Mechanism,
    weights: Sequence[Weight],
    inertias: dict[str, float],
) -> tuple[BalancedLinkage, dict[str, Any]]:
    """Build mechanism and block of an answer."""
    assert problem.dynamics is not None
    block = with_inertias(weighted(task.machine, problem.dynamics, weights), inertias)
    return BalancedLinkage(skeleton=Skeleton.model_validate(skeleton_of(mechanism))), block


def machine_of_answer(problem: BalancingProblem, mechanism: BalancedLinkage, block: dict[str, Any]) -> Machine:
    """Build the machine of an answer's mechanism and block, read like in an analysis."""
    # Read only what the answer states, not the solver's own data.
    built = GivenSkeleton.model_validate(mechanism.model_dump()).mechanism()
    return machine_of(DynamicsBlock.model_validate(block), built, problem.length_unit)[0]


def _matching(task: Task) -> float:
    """Return the acceleration of the input with an effect of the size of the speed's."""
    # A slide's range sets the length scale of its acceleration.
    if task.machine.mechanism.driven_by_slide:
        return task.speed**2 / abs(task.end - task.start) if task.end != task.start else 1.0
    return task.speed**2


def _force_share(after: Shaking, before: Shaking) -> float:
    return _share(after.force, before.force, before.parts[0], after.parts[0])


def _moment_share(after: Shaking, before: Shaking) -> float:
    return _share(after.moment, before.moment, before.parts[1], after.parts[1])


def _share(part: float, whole: float, parts: float, parts_after: float) -> float:
    """Return the remaining share of a whole; if the whole is rounding of its parts, the share of the parts."""
    if whole <= BALANCED * parts or whole == 0.0:
        whole = max(parts, parts_after)
    return part / whole if whole > 0.0 else part


def told(problem: BalancingProblem, machine: Machine, weight: Weight) -> Counterweight:
    """Describe a weight in the units of the answer."""
    assert problem.dynamics is not None
    mechanism, scale, stated = machine.mechanism, machine.scale, problem.counterweights
    joint = pivot(mechanism, weight.link)
    about = complex(mechanism.joints[joint])
    # The angle is measured from a joint that differs from the pivot.
    other = next(name for name in mechanism.links[weight.link] if name != joint and _beyond(mechanism, weight, name))
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


def _beyond(mechanism: Mechanism, weight: Weight, joint: str) -> bool:
    """Return whether a joint of the weight's link is not at its pivot."""
    return complex(mechanism.joints[joint]) != complex(mechanism.joints[pivot(mechanism, weight.link)])
