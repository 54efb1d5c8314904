"""Fourbars through three to eight points in a workspace: members of the family that have their pivots in their zones.

Linkages are drawn in the zones, and those nearest to the points are fitted to them, with the zones as penalties. The
best are then led to satisfy all constraints; the motion through the workspace is constrained only if it does not fit by
itself. If no candidate satisfies everything, fits of points (:mod:`synthesis.kinds.path.point_fit`), which perturb the
nearest ones, are searched for some that miss nothing.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.curve_families import families_of, joints_of
from synthesis.kinds.path.curve_limits import Held, broken, descend_softly, descend_within
from synthesis.kinds.path.limits import setting_of, zoned
from synthesis.kinds.path.point_fit import configuration_of, fitted, point_task
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.room_starts import RoomStarts, room_starts
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkages import FourbarConfiguration
from synthesis.numerics.portions import in_portions

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

COST_TOLERANCE = 1e-22
"""Cost, in squared task sizes, at which a descent has reached a member of the family."""

FOLLOWED, STEPS = 400, 80
"""Number of linkages of a family, drawn in a workspace, that are fitted to the points in a round, and steps of each
fit."""

HELD, MOVED, AT_ONCE = 64, 16, 8
"""Maximum numbers: of these, the best, that are led to satisfy all constraints except the workspace along the motion;
of the results, those with the smallest workspace violation, that are moved into it; and how many of these at a time."""

HOPELESS = 0.3
"""Workspace violation of a member, in task sizes, beyond which it is not moved."""

ENOUGH, SOME = 12, 3
"""Number of members that end the search: within a round, and before another round."""

PORTION = 2
"""Number of linkages that a thread takes at a time."""

FIRST_PART = 0.3
"""Share of the progress assigned to random draws."""


class MembersInRoom(NamedTuple):
    """Linkages through all points that satisfy all constraints, in the problem's coordinates, and the number of fits
    tried."""

    members: list[FourbarConfiguration]
    brought: int


def members_in_room(problem: PathProblem, progress: Progress) -> MembersInRoom:
    """Find members of the family of three to eight points that fit into a workspace; not yet driven."""
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    found: list[FourbarConfiguration] = []
    brought = 0
    families = families_of(problem)
    for turn in range(problem.rounds):
        # Further rounds cost as much as the first one, and a few members are enough to choose from.
        if len(found) >= SOME:
            break
        for n, family in enumerate(families):
            if len(found) >= ENOUGH:
                break
            done = (turn + n / len(families)) / problem.rounds
            message = f"round {turn + 1} of {problem.rounds}: {len(found)} linkages meet all points"
            progress(FIRST_PART * done, message)
            rng = np.random.default_rng([problem.seed, turn, n])
            setting = setting_of(problem, centre, size, sign=1.0, family=family)
            starts = room_starts(problem, points, centre, size, family, rng, FOLLOWED)
            brought += len(starts.x)
            for sign, one in _held(starts, points, setting, family):
                _, joints = joints_of(family, one.x, sign, float(one.theta[0]))
                found.append(FourbarConfiguration(*(centre + size * joint for joint in joints)))
    if not found and problem.method == "exact":
        # Method "auto" falls back to such fits by itself.
        task = point_task(problem)
        candidates = fitted(problem, task, np.random.default_rng(problem.seed), part_of(progress, FIRST_PART, 0.6))
        brought += len(candidates)
        met = [configuration_of(candidate, task) for candidate in candidates if candidate.cost <= COST_TOLERANCE]
        found = [joints for joints in met if joints is not None]
    return MembersInRoom(found, brought)


def _held(starts: RoomStarts, points: Complex, setting: Real, family: int) -> list[tuple[float, Held]]:
    """Find members that satisfy all constraints, with their assemblies, until there are enough."""
    if not len(starts.x):
        return []
    cheap = zoned(setting)
    ends = descend_softly(family, starts.x, starts.theta, starts.sign, points, cheap, STEPS)
    chosen = [int(k) for k in np.argsort(ends.cost, kind="stable")[:HELD] if math.isfinite(ends.cost[k])]
    on_points = _brought(family, [(ends.x[k], ends.theta[k], float(starts.sign[k])) for k in chosen], points, cheap)
    # The sweep through the workspace is expensive, so that it is evaluated only once per member.
    lost = [broken(family, one.x, one.theta, sign, setting) for sign, one in on_points]
    members = [on_points[n] for n in range(len(lost)) if lost[n] == 0.0]
    # Members far outside would need another shape, which moving along the family seldom gives.
    away = [n for n in np.argsort(lost, kind="stable")[:MOVED] if 0.0 < lost[n] <= HOPELESS]
    for first in range(0, len(away), AT_ONCE):
        if len(members) >= ENOUGH:
            break
        some = [on_points[n] for n in away[first : first + AT_ONCE]]
        members += _brought(family, [(one.x, one.theta, sign) for sign, one in some], points, setting)
    return members


def _brought(
    family: int, fits: list[tuple[Real, Real, float]], points: Complex, setting: Real
) -> list[tuple[float, Held]]:
    """Lead fits (unknowns, crank angles, assembly) to members of the family within a setting."""
    found: list[Held | None] = [None] * len(fits)
    weights = np.ones(len(points))

    def work(part: slice) -> None:
        for n, (x, theta, sign) in enumerate(fits[part], part.start):
            found[n] = descend_within(family, x, theta, sign, points, weights, setting)

    in_portions(work, len(fits), PORTION)
    return [
        (sign, one)
        for (_, _, sign), one in zip(fits, found, strict=True)
        if one is not None and one.cost <= COST_TOLERANCE
    ]
