"""Shaking force and moment over the motion, before and after balancing, for drawings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.reactions import reactions
from synthesis.analyses.driven import placed
from synthesis.kinds.balancing.design import BalancedDesign
from synthesis.kinds.balancing.driven import inertial, task_of
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verify_linkage import machine_of_answer

Real = NDArray[np.float64]

POSITIONS = 361
"""Number of positions of a curve."""

ROUNDING = 1e-9
"""Share of the unbalanced peak below which the balanced curve is drawn as zero."""


class ShakingCurves(NamedTuple):
    """Magnitude of the force, and the moment, over inputs in degrees (or lengths); NaN where they are unknown."""

    at: Real
    force_before: Real
    moment_before: Real
    force_after: Real
    moment_after: Real


def shaking_curves(problem: BalancingProblem, design: BalancedDesign) -> ShakingCurves:
    """Compute the curves of a linkage and of its design, from the inertia of the links alone."""
    task = task_of(problem)
    at = np.linspace(task.start, task.end, POSITIONS)
    curves = []
    for machine in (task.machine, machine_of_answer(problem, design.mechanism, design.dynamics)):
        found = reactions(inertial(machine), placed(inertial(machine), at, task.speed, task.acceleration))
        curves += [np.abs(found.shaking_force), found.shaking_moment]
    for before, after in ((0, 2), (1, 3)):
        # Rounding would otherwise be drawn as a noisy curve.
        curves[after] = np.where(
            np.abs(curves[after]) > ROUNDING * np.nanmax(np.abs(curves[before])), curves[after], 0.0
        )
    shown = at if task.machine.mechanism.driven_by_slide else np.degrees(at)
    return ShakingCurves(np.asarray(shown), *curves)
