"""Fourbars through three to eight points under demands, which leave freedom: a search of the family.

Fourbars through fewer than nine points form a continuous family. Its members are sought near a smooth curve through the
points: some ten thousand linkages of the demanded class are compared with that curve, as for whole curves. The most
alike go to least squares at the points alone, with the distances from given pivots and regions as further residuals,
until the cost is zero: each start leads to the nearest member of the family. All members that differ are driven, and
the other demands (transmission angle, lengths, order) select among them.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from synthesis.kinds.path.curve_descent import descend
from synthesis.kinds.path.curve_families import families_of, joints_of
from synthesis.kinds.path.curve_limits import pivot_limits
from synthesis.kinds.path.curve_shapes import alike
from synthesis.kinds.path.curve_target import angles_at, smooth_steps
from synthesis.kinds.path.design import FamilySearch, PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.kind import Progress
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import Sifting, reported

DRAWN = 6144
"""Number of linkages of each class drawn in a round; windows of their curves are compared with a smooth curve
through the points."""

MAX_FOLLOWED = 220
"""Greatest number of the most alike that go to least squares."""

MAX_STEPS = 150
"""Greatest number of steps of least squares; most members are reached in some twenty."""

COST_TOLERANCE = 1e-22
"""Cost, in squared task sizes, at which a descent has reached a member of the family."""

MAX_LINK = 12.0
"""Longest link, in task sizes, where no limit is stated."""

SAME_DESIGN = 1e-3
"""Members whose joints agree to this share of the task's size are offered once: the family is continuous."""

MIN_LINK = 1e-6
"""Links shorter than this share of the task's size are no links."""

MAX_DRIVEN = 160
"""Greatest number of members that are driven."""


def solve_family(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of three to eight points with demands."""
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    within = pivot_limits(problem, centre, size)
    limit = problem.constraints.link_length
    longest = MAX_LINK if limit is None or limit.max is None else limit.max / size
    smooth, places = smooth_steps(points, closed=False)
    families = families_of(problem)
    members: list[FourbarConfiguration] = []
    brought = 0
    for turn in range(problem.rounds):
        for n, family in enumerate(families):
            done = (turn + n / len(families)) / problem.rounds
            progress(0.6 * done, f"round {turn + 1} of {problem.rounds}: {len(members)} linkages meet all points")
            seed = int(np.random.default_rng([problem.seed, turn, n]).integers(2**31))
            starts = alike(family, smooth, False, DRAWN, MAX_FOLLOWED, longest=longest, seed=seed)
            brought += len(starts.x)
            if not len(starts.x):
                continue
            theta = np.array([angles_at(places, angles, False, 0.0) for angles in starts.theta])
            ends = descend(
                family, starts.x, starts.sign, theta, points, longest=longest, within=within, iterations=MAX_STEPS
            )
            for k in np.flatnonzero(ends.cost <= COST_TOLERANCE):
                _, joints = joints_of(family, ends.x[k], float(starts.sign[k]), float(ends.theta[k, 0]))
                members.append(FourbarConfiguration(*(centre + size * joint for joint in joints)))
    return _answer(problem, members, brought, progress)


def _answer(problem: PathProblem, met: list[FourbarConfiguration], brought: int, progress: Progress) -> PathResult:
    """Drive the members that differ, and put those first that are asked for."""
    size = problem.task_size

    def verified(member: FourbarConfiguration) -> PathDesign | str | None:
        if min(member.lengths) < MIN_LINK * size:
            return "degenerate"
        return verify_path(problem, fourbar_mechanism(member))

    driven = [met[k] for k in distinct(met, MAX_DRIVEN, SAME_DESIGN * size)]
    sifting = Sifting[PathDesign](problem)
    sifting.sift(reported(driven, progress, (0.6, 1.0), "{done} of {all} linkages driven"), verified)
    progress(1.0, "verified")
    text = (
        f"{brought} linkages near a curve through the points were brought to them, {len(met)} of them exactly and "
        f"with the pivots where they are asked for; {sifting.accepted} of {len(driven)} that differ satisfy all "
        "demands."
    )
    text += sifting.reasons()
    if not sifting.accepted:
        text += " None was found; others may exist."
    return PathResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        search=sifting.search("family_search"),
        summary=text,
        family=FamilySearch(followed=brought, met=len(met)),
    )
