"""Shaking force and moment over the motion, before and after balancing, for drawings."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.reactions import compute_reactions
from synthesis.analyses.linkages.requested_motion import place_machine
from synthesis.kinds.balancing.design import BalancedDesign
from synthesis.kinds.balancing.linkage.motion import build_balancing_task, strip_loads
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.verification.linkage import build_answer_machine

POSITION_COUNT = 361
"""Number of positions of a curve."""

ROUNDING_TOLERANCE = 1e-9
"""Share of the unbalanced peak below which the balanced curve is drawn as zero."""


class ShakingCurves(NamedTuple):
    """Magnitude of the force, and the moment, over inputs in degrees or lengths; NaN where the forces are unknown."""

    at: Real
    force_before: Real
    moment_before: Real
    force_after: Real
    moment_after: Real


def compute_shaking_curves(problem: BalancingProblem, design: BalancedDesign) -> ShakingCurves:
    """Compute the curves before and after balancing, from the inertia of the links alone."""
    task = build_balancing_task(problem)
    at = np.linspace(task.start, task.end, POSITION_COUNT)
    curves = []
    for machine in (task.machine, build_answer_machine(problem, design.mechanism, design.dynamics)):
        found = compute_reactions(
            strip_loads(machine), place_machine(strip_loads(machine), at, task.speed, task.acceleration)
        )
        curves += [np.abs(found.shaking_force), found.shaking_moment]
    for before, after in ((0, 2), (1, 3)):
        # Set rounding errors to zero, which would otherwise be drawn as a noisy curve.
        curves[after] = np.where(
            np.abs(curves[after]) > ROUNDING_TOLERANCE * np.nanmax(np.abs(curves[before])), curves[after], 0.0
        )
    shown = at if task.machine.mechanism.has_slide_input else np.degrees(at)
    return ShakingCurves(np.asarray(shown), *curves)
