"""Fourbars through three to eight points under constraints: a search of the continuous family that they leave.

Fourbars through fewer than nine points form a continuous family. Its members are sought near a smooth curve through the
points: some ten thousand linkages of the required class are compared with that curve, as for whole curves. The most
similar ones go to least squares at the points alone, with the distances from given pivots and regions as further
residuals, until the cost is zero: each start leads to the nearest member of the family.

Few of these members, or none, satisfy the other constraints (transmission angle, lengths, order, places of P and of the
moving pivots). Therefore the members with the smallest violations are moved along the family: they descend again, with
zero distances from the points as the aim and all constraints enforced by multipliers, so that the remaining freedom
goes into the constraints. All distinct members are driven. If a workspace is given, pivots are drawn in it instead
(:mod:`synthesis.kinds.path.family_in_room`).
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.curve_descent import Descent, descend
from synthesis.kinds.path.curve_families import families_of, joints_of
from synthesis.kinds.path.curve_limits import Held, broken, descend_within, pivot_limits
from synthesis.kinds.path.curve_shapes import alike
from synthesis.kinds.path.curve_target import angles_at, smooth_steps
from synthesis.kinds.path.design import FamilySearch, PathDesign, PathResult
from synthesis.kinds.path.family_in_room import COST_TOLERANCE, members_in_room
from synthesis.kinds.path.limits import setting_of
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.room_starts import bounded
from synthesis.kinds.path.verification import verify_path
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.numerics.portions import in_portions
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import Sifting, reported

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

DRAWN = 6144
"""Number of linkages of each class drawn in a round; windows of their curves are compared with a smooth curve through
the points."""

MAX_FOLLOWED = 220
"""Maximum number of the most similar linkages that go to least squares."""

MAX_STEPS = 150
"""Maximum number of steps of least squares; most members are reached in some twenty."""

MAX_LINK = 12.0
"""Longest link, in task sizes, if no limit is given."""

SAME_DESIGN = 1e-3
"""Members whose joints agree to this share of the task's size are offered once: the family is continuous."""

MIN_LINK = 1e-6
"""Linkages with a link shorter than this share of the task's size are degenerate."""

MAX_DRIVEN = 160
"""Maximum number of members that are driven."""

ENOUGH = 24
"""Number of feasible members beyond which no others are moved."""

MAX_MOVED = 32
"""Maximum number of linkages of a class that are moved in a round, those with the smallest violations."""

ENOUGH_IN_ROOM = 2
"""Number of members verified in a workspace for each requested design."""

PORTION = 2
"""Number of linkages to be moved that a thread takes at a time."""


class Member(NamedTuple):
    """A linkage through all points, in the problem's coordinates, and its largest constraint violation: 0 for none."""

    joints: FourbarConfiguration
    broken: float


def solve_family(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of three to eight points with constraints."""
    if bounded(problem):
        found = members_in_room(problem, progress)
        return _answer(problem, [Member(joints, 0.0) for joints in found.members], found.brought, progress)
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    within = pivot_limits(problem, centre, size)
    limit = problem.constraints.link_length
    longest = MAX_LINK if limit is None or limit.max is None else limit.max / size
    # A few points do not define a shape; the spline through them is a plausible curve to compare with.
    smooth, places = smooth_steps(points, closed=False)
    families = families_of(problem)
    members: list[Member] = []
    brought = 0

    def met(family: int, x: Real, theta: Real, sign: float, much: float) -> Member:
        _, joints = joints_of(family, x, sign, float(theta[0]))
        return Member(FourbarConfiguration(*(centre + size * joint for joint in joints)), much)

    for turn in range(problem.rounds):
        for n, family in enumerate(families):
            done = (turn + n / len(families)) / problem.rounds
            progress(0.6 * done, f"round {turn + 1} of {problem.rounds}: {len(members)} linkages meet all points")
            seed = int(np.random.default_rng([problem.seed, turn, n]).integers(2**31))
            starts = alike(family, smooth, False, DRAWN, MAX_FOLLOWED, longest=longest, seed=seed)
            brought += len(starts.x)
            if not len(starts.x):
                continue
            signs = [float(sign) for sign in starts.sign]
            theta = np.array([angles_at(places, angles, False, 0.0) for angles in starts.theta])
            ends = descend(
                family, starts.x, starts.sign, theta, points, longest=longest, within=within, iterations=MAX_STEPS
            )
            setting = setting_of(problem, centre, size, sign=1.0, family=family)
            lost = np.full(len(signs), math.inf)
            for k in np.flatnonzero(np.isfinite(ends.cost)):
                lost[k] = broken(family, ends.x[k], ends.theta[k], signs[k], setting)
            on_family = ends.cost <= COST_TOLERANCE
            members += [met(family, ends.x[k], ends.theta[k], signs[k], lost[k]) for k in np.flatnonzero(on_family)]
            # Moving is expensive and only needed while feasible members are scarce.
            if sum(member.broken == 0.0 for member in members) < ENOUGH:
                # Feasible members need no move; the others are ordered by violation and distance from the points
                # together.
                away = np.where(on_family & (lost == 0.0), math.inf, np.hypot(lost, np.sqrt(ends.cost)))
                moved = _moved(family, ends, signs, away, points, setting)
                members += [met(family, one.x, one.theta, signs[k], 0.0) for k, one in moved]
    return _answer(problem, members, brought, progress)


def _moved(
    family: int, ends: Descent, signs: list[float], away: Real, points: Complex, setting: Real
) -> list[tuple[int, Held]]:
    """Move linkages along the family until they satisfy all constraints; return them with the rows of their starts.

    ``away``, shape (n,), is the distance of an end from feasibility; infinite for one that is not to be moved.
    """
    order = np.argsort(away, kind="stable")[:MAX_MOVED]
    chosen = [int(k) for k in order if math.isfinite(away[k])]
    held: list[Held | None] = [None] * len(chosen)

    def work(some: slice) -> None:
        for n, k in enumerate(chosen[some], some.start):
            weights = np.ones(len(points))
            held[n] = descend_within(family, ends.x[k], ends.theta[k], signs[k], points, weights, setting)

    in_portions(work, len(chosen), PORTION)
    return [(k, one) for k, one in zip(chosen, held, strict=True) if one is not None and one.cost <= COST_TOLERANCE]


def _answer(problem: PathProblem, members: list[Member], brought: int, progress: Progress) -> PathResult:
    """Drive the distinct members, rank them, and build the result."""
    size = problem.task_size

    def verified(member: Member) -> PathDesign | str | None:
        if min(member.joints.lengths) < MIN_LINK * size:
            return "degenerate"
        return verify_path(problem, fourbar_mechanism(member.joints))

    # Feasible members first: they must not be lost as duplicates of infeasible ones.
    ordered = sorted(members, key=lambda member: member.broken > 0.0)
    driven = [ordered[k] for k in distinct([member.joints for member in ordered], MAX_DRIVEN, SAME_DESIGN * size)]
    sifting = Sifting[PathDesign](problem)
    # Sweeping a workspace takes longer than all other checks together.
    enough = ENOUGH_IN_ROOM * problem.max_designs if bounded(problem) else None
    # Force limits are violated by many fits, as far as their residuals show; drive these only if there are no others.
    sound = [one for one in driven if one.broken == 0.0] if problem.constraints.of_forces else driven
    sifting.sift(reported(sound, progress, (0.6, 1.0), "{done} of {all} linkages driven"), verified, enough)
    if len(sound) < len(driven) and len(sifting.passed) < problem.max_designs:
        sifting.sift((one for one in driven if one.broken > 0.0), verified, problem.max_designs)
    progress(1.0, "verified")
    text = (
        f"{counted(brought, 'start')} near a curve through the points {agreeing(brought, 'was', 'were')} fitted; "
        f"{grouped(len(ordered))} reached all points exactly, with the required pivots. "
        f"{grouped(sifting.accepted)} of {grouped(len(driven))} distinct linkages "
        f"{agreeing(sifting.accepted, 'satisfies', 'satisfy')} all constraints."
    )
    text += sifting.reasons()
    if not sifting.accepted:
        text += " None was found; some may still exist."
    return PathResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        search=sifting.search("family_search"),
        summary=text,
        family=FamilySearch(followed=brought, met=len(ordered)),
    )
