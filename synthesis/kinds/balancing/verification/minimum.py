"""Verification of optimal counterweights: drive the answer over the grid and compare its value with the lower bound.

The forces are the reactions of the answer's own linkage, solved joint by joint, whereas the program used momentum and
energy. The sizes of the weights are measured on the answer, too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.balance import compute_balance
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.reactions import Reactions, compute_reactions
from synthesis.analyses.linkages.requested_motion import Task, pace_machine, place_machine
from synthesis.kinds.balancing.design import BalancedDesign, BalanceMetrics, Counterweight, ForceLevel
from synthesis.kinds.balancing.linkage.force_balance import Weight
from synthesis.kinds.balancing.linkage.minimize import GRID_SIZE, Minimum
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.kinds.balancing.statement.counterweights import Counterweights
from synthesis.kinds.balancing.verification.linkage import build_answer, build_answer_machine, describe_weight
from synthesis.model.answer import Check, Verification
from synthesis.model.dimension import LENGTH, MASS
from synthesis.verification.checks import check_error, check_maximum, check_minimum

MAX_GAP = 5e-3
"""Maximum gap between the value and the lower bound, as a share of the value."""

GYRATION_TOLERANCE = 1e-3
"""Share by which a radius of gyration may exceed its limit."""

CAP_TOLERANCE = 2e-6
"""Share by which a peak may exceed its cap."""

NEGLIGIBLE_VALUE = 1e-6
"""Value of the objective, as a share of its sum of weights, below which it is negligible and a gap has no meaning."""

ROUTE_TOLERANCE = 1e-6
"""Permitted difference of a force computed by two independent methods, as a share of its peak."""

SIZE_TOLERANCE = 1e-9
"""Excess of masses and positions over their limits, as a share, that is attributed to rounding."""


class MeasuredForces(NamedTuple):
    """Reactions over the grid; peaks of shaking force, shaking moment and drive; their differences from a balance."""

    found: Reactions
    peaks: list[float]
    differences: list[float]

    def list_series(self, name: str) -> list[Real]:
        """Return the magnitudes of a quantity at the positions at which it is known."""
        known = self.found.solved
        if name == "shaking_force":
            return [np.abs(self.found.shaking_force[known])]
        if name == "shaking_moment":
            return [np.abs(self.found.shaking_moment[known])]
        if name == "drive":
            return [np.abs(self.found.drive[known])]
        return [np.abs(force[known]) for force in self.found.joints[name.removeprefix("joint ")].values()]

    def compute_level(self, name: str, norm: str) -> float:
        """Return the peak of a quantity, or its root mean square."""
        series = self.list_series(name)
        if norm == "max":
            return max(float(one.max()) for one in series)
        return max(float(np.sqrt((one**2).mean())) for one in series)


def verify_minimum(problem: BalancingProblem, task: Task, found: Minimum) -> BalancedDesign:
    """Measure a linkage with its best counterweights."""
    mechanism = task.machine.mechanism
    answer, block = build_answer(problem, task, mechanism, found.weights, {})
    grid = task.list_positions(max(GRID_SIZE, problem.motion.steps))
    before = _measure_forces(task.machine, task, grid)
    after = _measure_forces(build_answer_machine(problem, answer, block), task, grid)
    difference = max(
        _compute_share(off, max(first, last))
        for one in (before, after)
        for off, first, last in zip(one.differences, before.peaks, after.peaks, strict=True)
    )
    levels = _compare_levels(problem, before, after)
    value = math.fsum(level.weight * level.ratio for level in levels)
    weighed = math.fsum(level.weight for level in levels)
    # A share of a negligible value would be meaningless.
    gap = (value - found.bound) / value if value > NEGLIGIBLE_VALUE * weighed else 0.0
    weights = [describe_weight(problem, task.machine, weight) for weight in found.weights]
    stated, scale = problem.counterweights, task.machine.scale
    checks = [
        check_minimum("bound", value, found.bound),
        check_error("gap", gap, MAX_GAP),
        check_error("routes_agree", difference, ROUTE_TOLERANCE),
    ]
    for level in levels:
        if level.cap is not None:
            checks.append(
                check_maximum(f"max_{level.name.replace(' ', '_')}", level.ratio, level.cap, slack=CAP_TOLERANCE)
            )
    checks += _check_counterweights(stated, weights, found.weights, scale)
    metrics = BalanceMetrics(
        value=value,
        bound=found.bound,
        gap=gap,
        levels=levels,
        shaking_force=after.compute_level("shaking_force", "max"),
        unbalanced_shaking_force=before.compute_level("shaking_force", "max"),
        shaking_moment=after.compute_level("shaking_moment", "max"),
        unbalanced_shaking_moment=before.compute_level("shaking_moment", "max"),
        drive=after.compute_level("drive", "max"),
        unbalanced_drive=before.compute_level("drive", "max"),
        added_mass=math.fsum(weight.mass for weight in weights),
    )
    return BalancedDesign(
        mechanism=answer,
        dynamics=block,
        counterweights=weights,
        geared=[],
        verification=Verification.from_checks(checks),
        metrics=metrics,
    )


def _check_counterweights(
    limits: Counterweights, weights: Sequence[Counterweight], found: Sequence[Weight], scale: float
) -> list[Check]:
    """Check the counterweights of a design against the limits of their mass and size.

    Parameters
    ----------
    limits : Counterweights
        The limits.
    weights, found
        The counterweights as reported, and as the optimization found them.
    scale : float
        Factor of lengths in moments of inertia.
    """
    checks = []
    masses = [weight.mass for weight in weights]
    if limits.total_mass is not None:
        checks.append(check_maximum("total_mass", math.fsum(masses), limits.total_mass, MASS, SIZE_TOLERANCE))
    if limits.max_mass is not None and masses:
        checks.append(check_maximum("mass", max(masses), limits.max_mass, MASS, SIZE_TOLERANCE))
    if limits.reach is not None and weights:
        checks.append(
            check_maximum("reach", max(weight.radius for weight in weights), limits.reach, LENGTH, SIZE_TOLERANCE)
        )
    if limits.max_gyration is not None and weights:
        about = [(weight.mass, weight.inertia / scale**2 + weight.mass * weight.radius**2) for weight in weights]
        gyration = max(math.sqrt(inertia / mass) if mass > 0.0 else math.inf for mass, inertia in about)
        checks.append(check_maximum("gyration", gyration, limits.max_gyration, LENGTH, GYRATION_TOLERANCE))
    if limits.max_disc_radius is not None and weights:
        radius = max(weight.disc_radius or 0.0 for weight in weights)
        checks.append(check_maximum("disc_radius", radius, limits.max_disc_radius, LENGTH, SIZE_TOLERANCE))
    discs = [(weight.inertia, limits.compute_inertia(weight.mass, scale)) for weight in found if weight.mass > 0.0]
    if limits.density is not None and discs:
        checks.append(
            check_minimum("inertia_over_disc", min(own / disc for own, disc in discs), 1.0, slack=SIZE_TOLERANCE)
        )
    return checks


def _compare_levels(problem: BalancingProblem, before: MeasuredForces, after: MeasuredForces) -> list[ForceLevel]:
    """Compare each quantity in the objective or with a cap; a cap limits the peak even if the objective uses means."""
    objective, caps = problem.objective, problem.caps
    names = ["shaking_force", "shaking_moment", "drive"]
    listed = [(name, getattr(objective, name), getattr(caps, name)) for name in names]
    for joint in {**objective.joint_forces, **caps.joint_forces}:
        listed.append((f"joint {joint}", objective.joint_forces.get(joint, 0.0), caps.joint_forces.get(joint)))
    levels = []
    for name, weight, cap in listed:
        together = objective.norm == "max"
        if weight > 0.0:
            ratio = after.compute_level(name, objective.norm) / before.compute_level(name, objective.norm)
            own = cap if together else None
            levels.append(ForceLevel(name=name, norm=objective.norm, weight=weight, cap=own, ratio=ratio))
        if cap is not None and not (weight > 0.0 and together):
            ratio = after.compute_level(name, "max") / before.compute_level(name, "max")
            levels.append(ForceLevel(name=name, norm="max", weight=0.0, cap=cap, ratio=ratio))
    return levels


def _measure_forces(machine: Machine, task: Task, grid: Real) -> MeasuredForces:
    """Measure a machine over the grid by both methods: joint reactions, and momentum with energy."""
    now = place_machine(machine, grid, task.speed, task.acceleration)
    found = compute_reactions(machine, now)
    # The second method uses momentum and energy instead of joint reactions.
    check = compute_balance(machine, now, pace_machine(machine, grid), found.rubbing)
    known = found.solved
    pairs = (
        (found.shaking_force, check.shaking_force),
        (found.shaking_moment, check.shaking_moment),
        (found.drive, check.drive),
    )
    peaks = [float(np.abs(one[known]).max()) for one, _ in pairs]
    return MeasuredForces(found, peaks, [float(np.abs((one - other)[known]).max()) for one, other in pairs])


def _compute_share(part: float, whole: float) -> float:
    return part / whole if whole > 0.0 else part
