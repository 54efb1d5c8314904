"""The proof of a balanced linkage: its answer driven, and the forces on its frame from the reactions of all joints.

Nothing is taken from the search: mechanism and block are read from the answer as ``POST /v1/analyses`` would read them,
and the shaking force is the sum of what all joints do to the frame (Newton and Euler link by link), while the
counterweights come from momentum.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from kinematics.dynamics.machine import Machine
from kinematics.dynamics.reactions import reactions
from kinematics.linkage.planar.mechanism import Mechanism
from synthesis.kinds.balancing.block import weighted, with_inertias
from synthesis.kinds.balancing.design import (
    BalancedDesign,
    BalancedLinkage,
    BalanceMetrics,
    Counterweight,
    GearedInertia,
)
from synthesis.kinds.balancing.driven import Task, inertial, pivot, placed
from synthesis.kinds.balancing.force_balance import Weight
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.mechanisms.machine import machine_of
from synthesis.mechanisms.skeleton import GivenSkeleton, skeleton_of
from synthesis.model.answer import Check, Verification
from synthesis.model.dynamics import DynamicsBlock
from synthesis.model.linkage_answer import Skeleton
from synthesis.proof.checks import tolerated

POSITIONS = 720
"""Over the motion, at which the forces are measured, or as many as its steps where these are more."""

BALANCED = 1e-9
"""Share of the unbalanced peak that is rounding."""

GRAM_MILLIMETRES = 1e6
"""g·mm in a kg·m."""


class Shaking(NamedTuple):
    """Peaks over the positions at which the reactions are known."""

    force: float
    moment: float
    drive: float


def measured(machine: Machine, task: Task, count: int, acceleration: float) -> Shaking:
    """The peaks of a machine's own inertia over the motion of a task."""
    now = placed(inertial(machine), task.positions(count), task.speed, acceleration)
    found = reactions(inertial(machine), now)
    known = found.solved
    if not known.any():
        return Shaking(math.nan, math.nan, math.nan)
    force, moment, drive = (
        float(np.abs(values[known]).max()) for values in (found.shaking_force, found.shaking_moment, found.drive)
    )
    return Shaking(force, moment, drive)


def verify_linkage(
    problem: BalancingProblem,
    task: Task,
    mechanism: Mechanism,
    weights: Sequence[Weight],
    inertias: dict[str, float],
) -> BalancedDesign:
    """A linkage with its counterweights, measured; ``inertias`` are those of the geared links by name."""
    answer, block = answer_of(problem, task, mechanism, weights, inertias)
    machine = machine_of_answer(problem, answer, block)
    count = max(POSITIONS, problem.motion.steps)
    # Also with an acceleration that matters as much as the speed.
    accelerated = task.acceleration + _matching(task)
    first, last = (measured(one, task, count, task.acceleration) for one in (task.machine, machine))
    before, after = (measured(one, task, count, accelerated) for one in (task.machine, machine))
    checks = [
        _vanishes("shaking_force", last.force, first.force),
        _vanishes("shaking_force_accelerated", after.force, before.force),
    ]
    value = _share(last.force, first.force)
    if problem.goal == "force_and_moment":
        checks += [
            _vanishes("shaking_moment", last.moment, first.moment),
            _vanishes("shaking_moment_accelerated", after.moment, before.moment),
        ]
        value = max(value, _share(last.moment, first.moment))
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
    """Mechanism and block of an answer."""
    assert problem.dynamics is not None
    block = with_inertias(weighted(task.machine, problem.dynamics, weights), inertias)
    return BalancedLinkage(skeleton=Skeleton.model_validate(skeleton_of(mechanism))), block


def machine_of_answer(problem: BalancingProblem, mechanism: BalancedLinkage, block: dict[str, Any]) -> Machine:
    """The machine that mechanism and block of an answer make, read as an analysis reads them."""
    built = GivenSkeleton.model_validate(mechanism.model_dump()).mechanism()
    return machine_of(DynamicsBlock.model_validate(block), built, problem.length_unit)[0]


def _matching(task: Task) -> float:
    """The acceleration of the input that moves its joints as its speed does."""
    if task.machine.mechanism.driven_by_slide:
        return task.speed**2 / abs(task.end - task.start) if task.end != task.start else 1.0
    return task.speed**2


def _vanishes(name: str, left: float, before: float) -> Check:
    return tolerated(name, _share(left, before), BALANCED)


def _share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else part


def told(problem: BalancingProblem, machine: Machine, weight: Weight) -> Counterweight:
    """A weight in the units of the answer."""
    assert problem.dynamics is not None
    mechanism, scale, stated = machine.mechanism, machine.scale, problem.counterweights
    joint = pivot(mechanism, weight.link)
    about = complex(mechanism.joints[joint])
    other = next(name for name in mechanism.links[weight.link] if name != joint and _beyond(mechanism, weight, name))
    arm = weight.at / scale - about
    line = complex(mechanism.joints[other]) - about
    written = GRAM_MILLIMETRES * scale if problem.dynamics.units == "si" else 1.0
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
    """Whether a joint of the weight's link is elsewhere than its pivot."""
    return complex(mechanism.joints[joint]) != complex(mechanism.joints[pivot(mechanism, weight.link)])
