"""Fourbars through three to eight points in a workspace: members of the family that have their pivots in their zones.

Linkages are drawn in the zones, and those nearest to the points are fitted to them, with the zones as penalties. The
best are then refitted under all constraints. The motion through the workspace is constrained only if a linkage leaves
the workspace otherwise. If no candidate satisfies all constraints, exact members are searched among fits to the points
(:mod:`synthesis.kinds.path.points.fit`), which perturb the nearest linkages.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.path.points.fit import build_configuration, build_point_task, find_minima
from synthesis.kinds.path.points.workspace_starts import WorkspaceStarts, draw_workspace_starts
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import pack_setting, restrict_to_zones
from synthesis.kinds.path.residuals.curve_constraints import (
    ConstrainedFit,
    descend_constrained,
    descend_softly,
    measure_violation,
)
from synthesis.kinds.path.residuals.families import compute_joints, list_families
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.conversion import FourbarConfiguration
from synthesis.numerics.portions import run_in_portions

COST_TOLERANCE = 1e-22
"""Cost, in squared task sizes, at which a descent has reached a member of the family."""

MAX_FOLLOWED, MAX_STEPS = 400, 80
"""Number of linkages of a family, drawn in a workspace, that are fitted to the points in a round, and steps of each
fit."""

MAX_CONSTRAINED, MAX_MOVED, BATCH_SIZE = 64, 16, 8
"""Maximum number of the best fitted linkages that are refitted under all constraints except the workspace along the
motion; maximum number of the results, those with the smallest workspace violation, that are moved into the workspace;
and number that is moved at a time."""

MAX_WORKSPACE_VIOLATION = 0.3
"""Workspace violation of a member, in task sizes, beyond which it is not moved."""

SUFFICIENT_MEMBERS, SUFFICIENT_MEMBERS_AFTER_ROUND = 12, 3
"""Number of members that end the search: within a round, and before another round."""

PORTION_SIZE = 2
"""Number of linkages that a thread takes at a time."""

DRAW_PROGRESS_SHARE = 0.3
"""Share of the progress assigned to random draws."""


class WorkspaceMembers(NamedTuple):
    """Linkages through all points that satisfy all constraints, in the problem's coordinates, and the number of fits
    tried."""

    members: list[FourbarConfiguration]
    brought: int


def find_workspace_members(problem: PathProblem, progress: Progress) -> WorkspaceMembers:
    """Find members of the family of three to eight points that fit into a workspace; not yet driven."""
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    found: list[FourbarConfiguration] = []
    brought = 0
    families = list_families(problem)
    for turn in range(problem.rounds):
        # Further rounds cost as much as the first one, and a few members are enough to choose from.
        if len(found) >= SUFFICIENT_MEMBERS_AFTER_ROUND:
            break
        for n, family in enumerate(families):
            if len(found) >= SUFFICIENT_MEMBERS:
                break
            done = (turn + n / len(families)) / problem.rounds
            message = compose("path-round-found", round=turn + 1, rounds=problem.rounds, count=len(found))
            progress(DRAW_PROGRESS_SHARE * done, message)
            rng = np.random.default_rng([problem.seed, turn, n])
            setting = pack_setting(problem, centre, size, sign=1.0, family=family)
            starts = draw_workspace_starts(problem, points, centre, size, family, rng, MAX_FOLLOWED)
            brought += len(starts.x)
            for sign, one in _find_constrained_members(starts, points, setting, family):
                _, joints = compute_joints(family, one.x, sign, float(one.theta[0]))
                found.append(FourbarConfiguration(*(centre + size * joint for joint in joints)))
    if not found and problem.method == "exact":
        # Method "auto" falls back to such fits by itself.
        task = build_point_task(problem)
        candidates = find_minima(
            problem, task, np.random.default_rng(problem.seed), scale_progress(progress, DRAW_PROGRESS_SHARE, 0.6)
        )
        brought += len(candidates)
        met = [build_configuration(candidate, task) for candidate in candidates if candidate.cost <= COST_TOLERANCE]
        found = [joints for joints in met if joints is not None]
    return WorkspaceMembers(found, brought)


def _find_constrained_members(
    starts: WorkspaceStarts, points: Complex, setting: Real, family: int
) -> list[tuple[float, ConstrainedFit]]:
    """Find members that satisfy all constraints, with their assemblies, until there are enough."""
    if not len(starts.x):
        return []
    cheap = restrict_to_zones(setting)
    ends = descend_softly(family, starts.x, starts.theta, starts.sign, points, cheap, MAX_STEPS)
    chosen = [int(k) for k in np.argsort(ends.cost, kind="stable")[:MAX_CONSTRAINED] if math.isfinite(ends.cost[k])]
    on_points = _fit_members(family, [(ends.x[k], ends.theta[k], float(starts.sign[k])) for k in chosen], points, cheap)
    # The sweep through the workspace is expensive, so that it is evaluated only once per member.
    lost = [measure_violation(family, one.x, one.theta, sign, setting) for sign, one in on_points]
    members = [on_points[n] for n in range(len(lost)) if lost[n] == 0.0]
    # Members far outside would need another shape, which moving along the family seldom gives.
    away = [n for n in np.argsort(lost, kind="stable")[:MAX_MOVED] if 0.0 < lost[n] <= MAX_WORKSPACE_VIOLATION]
    for first in range(0, len(away), BATCH_SIZE):
        if len(members) >= SUFFICIENT_MEMBERS:
            break
        some = [on_points[n] for n in away[first : first + BATCH_SIZE]]
        members += _fit_members(family, [(one.x, one.theta, sign) for sign, one in some], points, setting)
    return members


def _fit_members(
    family: int, fits: list[tuple[Real, Real, float]], points: Complex, setting: Real
) -> list[tuple[float, ConstrainedFit]]:
    """Refit linkages (unknowns, crank angles, assembly) to members of the family that satisfy a setting."""
    found: list[ConstrainedFit | None] = [None] * len(fits)
    weights = np.ones(len(points))

    def process_portion(part: slice) -> None:
        for n, (x, theta, sign) in enumerate(fits[part], part.start):
            found[n] = descend_constrained(family, x, theta, sign, points, weights, setting)

    run_in_portions(process_portion, len(fits), PORTION_SIZE)
    return [
        (sign, one)
        for (_, _, sign), one in zip(fits, found, strict=True)
        if one is not None and one.cost <= COST_TOLERANCE
    ]
