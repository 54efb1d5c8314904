"""Fourbars through three to eight points under constraints: a search of the continuous family of solutions.

Fourbars through fewer than nine points form a continuous family. Its members are sought near a smooth curve through the
points: some ten thousand linkages of the required class are compared with that curve, as for whole curves. The most
similar ones are refined by least squares at the points alone, with the distances from given pivots and regions as
further residuals, until the cost is zero. Each start leads to the nearest member of the family.

Few of these members, or none, satisfy the other constraints (transmission angle, lengths, order, places of P and of the
moving pivots). Therefore the members with the smallest violations are moved along the family: they descend again, with
zero distances from the points as the aim and all constraints enforced by multipliers, so that the remaining freedom
goes into the constraints. All distinct members are driven. If a workspace is given, pivots are drawn in it instead
(:mod:`synthesis.kinds.path.exact.family_in_workspace`).
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.message import compose
from synthesis.kinds.path.curve.shape_matching import compare_shapes, select_most_similar
from synthesis.kinds.path.design import FamilySearch, PathDesign, PathResult
from synthesis.kinds.path.exact.family_in_workspace import COST_TOLERANCE, find_workspace_members
from synthesis.kinds.path.points.workspace_starts import is_workspace_constrained
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.constraint_vector import pack_setting
from synthesis.kinds.path.residuals.curve_constraints import (
    ConstrainedFit,
    compute_pivot_limits,
    descend_constrained,
    measure_violation,
)
from synthesis.kinds.path.residuals.curve_descent import Descent, LinkageLimits, descend
from synthesis.kinds.path.residuals.families import compute_joints, list_families
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.task.target_curve import interpolate_crank_angles, sample_smooth_steps
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.kind import Progress
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.numerics.portions import run_in_portions
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.ranking import rank_designs, select_distinct

DRAW_COUNT = 6144
"""Number of linkages of each class drawn in a round; windows of their curves are compared with a smooth curve through
the points."""

MAX_FOLLOWED = 220
"""Maximum number of the most similar linkages that are refined by least squares."""

MAX_STEPS = 150
"""Maximum number of steps of least squares; most members are reached in some twenty."""

MAX_LINK = 12.0
"""Longest link, in task sizes, if no limit is given."""

DESIGN_DUPLICATE_TOLERANCE = 1e-3
"""Members whose joints agree to this share of the task's size are offered once: the family is continuous."""

MIN_LINK = 1e-6
"""Linkages with a link shorter than this share of the task's size are degenerate."""

MAX_DRIVEN = 160
"""Maximum number of members that are driven."""

SUFFICIENT_MEMBERS = 24
"""Number of feasible members beyond which no others are moved."""

MAX_MOVED = 32
"""Maximum number of linkages of a class that are moved in a round, those with the smallest violations."""

VERIFIED_PER_DESIGN = 2
"""Number of members verified in a workspace for each requested design."""

PORTION_SIZE = 2
"""Number of linkages to be moved that a thread takes at a time."""


class Member(NamedTuple):
    """A linkage through all points, in the problem's coordinates, and its maximum constraint violation; 0 for none."""

    joints: FourbarConfiguration
    broken: float


def solve_family(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of three to eight points with constraints."""
    if is_workspace_constrained(problem):
        found = find_workspace_members(problem, progress)
        return _build_result(problem, [Member(joints, 0.0) for joints in found.members], found.brought, progress)
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    limit = problem.constraints.link_length
    longest = MAX_LINK if limit is None or limit.max is None else limit.max / size
    limits = LinkageLimits(longest=longest, within=compute_pivot_limits(problem, centre, size))
    # A few points do not define a shape; the spline through them is a plausible curve to compare with.
    smooth, places = sample_smooth_steps(points, closed=False)
    families = list_families(problem)
    members: list[Member] = []
    brought = 0

    def build_member(family: int, x: Real, theta: Real, sign: float, much: float) -> Member:
        _, joints = compute_joints(family, x, sign, float(theta[0]))
        return Member(FourbarConfiguration(*(centre + size * joint for joint in joints)), much)

    for turn in range(problem.rounds):
        for n, family in enumerate(families):
            done = (turn + n / len(families)) / problem.rounds
            progress(0.6 * done, compose("path-round-found", round=turn + 1, rounds=problem.rounds, count=len(members)))
            seed = int(np.random.default_rng([problem.seed, turn, n]).integers(2**31))
            compared = compare_shapes(family, smooth, False, DRAW_COUNT, seed=seed)
            starts = select_most_similar(compared, MAX_FOLLOWED, longest)
            brought += len(starts.x)
            if not len(starts.x):
                continue
            signs = [float(sign) for sign in starts.sign]
            theta = np.array([interpolate_crank_angles(places, angles, False, 0.0) for angles in starts.theta])
            ends = descend(family, starts.x, starts.sign, theta, points, limits, iterations=MAX_STEPS)
            setting = pack_setting(problem, centre, size, sign=1.0, family=family)
            lost = np.full(len(signs), math.inf)
            for k in np.flatnonzero(np.isfinite(ends.cost)):
                lost[k] = measure_violation(family, ends.x[k], ends.theta[k], signs[k], setting)
            on_family = ends.cost <= COST_TOLERANCE
            members += [
                build_member(family, ends.x[k], ends.theta[k], signs[k], lost[k]) for k in np.flatnonzero(on_family)
            ]
            # Moving is expensive and only needed while feasible members are scarce.
            if sum(member.broken == 0.0 for member in members) < SUFFICIENT_MEMBERS:
                # Feasible members need no move; the others are ordered by violation and distance from the points
                # together.
                away = np.where(on_family & (lost == 0.0), math.inf, np.hypot(lost, np.sqrt(ends.cost)))
                moved = _move_members(family, ends, signs, away, points, setting)
                members += [build_member(family, one.x, one.theta, signs[k], 0.0) for k, one in moved]
    return _build_result(problem, members, brought, progress)


def _move_members(
    family: int, ends: Descent, signs: list[float], away: Real, points: Complex, setting: Real
) -> list[tuple[int, ConstrainedFit]]:
    """Move linkages along the family until they satisfy all constraints; return them with the rows of their starts.

    ``away``, shape (n,), is the distance of an end from feasibility; infinite for one that is not to be moved.
    """
    order = np.argsort(away, kind="stable")[:MAX_MOVED]
    chosen = [int(k) for k in order if math.isfinite(away[k])]
    held: list[ConstrainedFit | None] = [None] * len(chosen)

    def process_portion(some: slice) -> None:
        for n, k in enumerate(chosen[some], some.start):
            weights = np.ones(len(points))
            held[n] = descend_constrained(family, ends.x[k], ends.theta[k], signs[k], points, weights, setting)

    run_in_portions(process_portion, len(chosen), PORTION_SIZE)
    return [(k, one) for k, one in zip(chosen, held, strict=True) if one is not None and one.cost <= COST_TOLERANCE]


def _build_result(problem: PathProblem, members: list[Member], brought: int, progress: Progress) -> PathResult:
    """Drive the distinct members, rank them, and build the result."""
    size = problem.task_size

    def verify_member(member: Member) -> PathDesign | str | None:
        if min(member.joints.lengths) < MIN_LINK * size:
            return "degenerate"
        return verify_path(problem, build_fourbar(member.joints))

    # Feasible members first: they must not be lost as duplicates of infeasible ones.
    ordered = sorted(members, key=lambda member: member.broken > 0.0)
    driven = [
        ordered[k]
        for k in select_distinct([member.joints for member in ordered], MAX_DRIVEN, DESIGN_DUPLICATE_TOLERANCE * size)
    ]
    sifting = CandidateLog[PathDesign](problem)
    # Sweeping a workspace takes longer than all other checks together.
    enough = VERIFIED_PER_DESIGN * problem.max_designs if is_workspace_constrained(problem) else None
    # Force limits are violated by many fits, as far as their residuals show; drive these only if there are no others.
    sound = [one for one in driven if one.broken == 0.0] if problem.constraints.force_limits else driven
    sifting.verify_candidates(
        report_candidates(sound, progress, (0.6, 1.0), "path-linkages-driven"), verify_member, enough
    )
    if len(sound) < len(driven) and len(sifting.passed) < problem.max_designs:
        sifting.verify_candidates((one for one in driven if one.broken > 0.0), verify_member, problem.max_designs)
    progress(1.0, compose("path-verified"))
    summary = join_sentences(
        [
            compose("path-family-fitted", starts=brought, reached=len(ordered)),
            compose("path-distinct-linkages-passed", passed=sifting.accepted, count=len(driven)),
            sifting.describe_reasons(),
            "" if sifting.accepted else compose("path-none-found"),
        ]
    )
    return PathResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        search=sifting.build_search("family_search"),
        summary=summary,
        family=FamilySearch(followed=brought, met=len(ordered)),
    )
