"""The drive over the motion, without springs and with them, for drawings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import build_task, place_machine
from synthesis.kinds.spring_balancing.design import SprungDesign
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.verification import build_answer_machine

POSITION_COUNT = 361
"""Number of positions of a curve."""

ROUNDING_TOLERANCE = 1e-9
"""Share of the unbalanced peak below which the balanced drive is drawn as zero."""


class DriveCurves(NamedTuple):
    """The drive before and after over inputs (radians, or lengths along the slide); NaN where it is unknown."""

    at: Real
    before: Real
    after: Real


def drive_curves(problem: SpringBalancingProblem, design: SprungDesign) -> DriveCurves:
    """Compute the curves of a linkage and of its design."""
    task = build_task(problem.mechanism, problem.dynamics, problem.length_unit, problem.motion)
    at = np.linspace(task.start, task.end, POSITION_COUNT)
    before, after = (
        compute_reactions(machine, place_machine(machine, at, task.speed, task.acceleration)).drive
        for machine in (task.machine, build_answer_machine(problem, design.mechanism, design.dynamics))
    )
    after = np.where(np.abs(after) > ROUNDING_TOLERANCE * np.nanmax(np.abs(before), initial=0.0), after, 0.0)
    return DriveCurves(at, before, after)
