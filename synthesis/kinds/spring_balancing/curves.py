"""The drive over the motion, without springs and with them, for drawings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.reactions import reactions
from synthesis.analyses.driven import driven_task, placed
from synthesis.kinds.spring_balancing.design import SprungDesign
from synthesis.kinds.spring_balancing.problem import SpringBalancingProblem
from synthesis.kinds.spring_balancing.verification import machine_of_answer

Real = NDArray[np.float64]

POSITIONS = 361
"""Number of positions of a curve."""

ROUNDING = 1e-9
"""Share of the unbalanced peak below which the balanced drive is drawn as zero."""


class DriveCurves(NamedTuple):
    """The drive before and after over inputs (radians, or lengths along the slide); NaN where it is unknown."""

    at: Real
    before: Real
    after: Real


def drive_curves(problem: SpringBalancingProblem, design: SprungDesign) -> DriveCurves:
    """Compute the curves of a linkage and of its design."""
    task = driven_task(problem.mechanism, problem.dynamics, problem.length_unit, problem.motion)
    at = np.linspace(task.start, task.end, POSITIONS)
    before, after = (
        reactions(machine, placed(machine, at, task.speed, task.acceleration)).drive
        for machine in (task.machine, machine_of_answer(problem, design.mechanism, design.dynamics))
    )
    after = np.where(np.abs(after) > ROUNDING * np.nanmax(np.abs(before), initial=0.0), after, 0.0)
    return DriveCurves(at, before, after)
