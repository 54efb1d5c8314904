"""Fourbars through three to eight points under demands, which leave freedom: a search of the family.

Fourbars through fewer than nine points form a continuous family. Its members are sought near a smooth curve through the
points: some ten thousand linkages of the demanded class are compared with that curve, as for whole curves. The most
alike go to least squares at the points alone, with the distances from given pivots and regions as further residuals,
until the cost is zero: each start leads to the nearest member of the family.

The other demands (transmission angle, lengths, order, places of P and of the moving pivots) are kept by few of these
members, or by none. Therefore the ones that break them least are moved along the family: they descend again, with zero
distances from the points as the aim and all demands held by multipliers, so that what is left of the freedom goes into
the demands. All members that differ are driven. Where a room is demanded, pivots are drawn in it instead
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
"""Number of linkages of each class drawn in a round; windows of their curves are compared with a smooth curve
through the points."""

MAX_FOLLOWED = 220
"""Greatest number of the most alike that go to least squares."""

MAX_STEPS = 150
"""Greatest number of steps of least squares; most members are reached in some twenty."""

MAX_LINK = 12.0
"""Longest link, in task sizes, where no limit is stated."""

SAME_DESIGN = 1e-3
"""Members whose joints agree to this share of the task's size are offered once: the family is continuous."""

MIN_LINK = 1e-6
"""Links shorter than this share of the task's size are no links."""

MAX_DRIVEN = 160
"""Greatest number of members that are driven."""

ENOUGH = 24
"""Members that keep all demands, beyond which no others are moved to keep them."""

MAX_MOVED = 32
"""Greatest number of linkages of a class that are moved in a round, those that break demands least."""

ENOUGH_IN_ROOM = 2
"""In a room: members that are verified for each design that is asked for."""

PORTION = 2
"""Number of linkages to be moved that a thread takes at a time."""


class Member(NamedTuple):
    """A linkage through all points, in the problem's coordinates, and by how much it breaks a demand: 0 for none."""

    joints: FourbarConfiguration
    broken: float


def solve_family(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of three to eight points with demands."""
    if bounded(problem):
        found = members_in_room(problem, progress)
        return _answer(problem, [Member(joints, 0.0) for joints in found.members], found.brought, progress)
    given = np.array([point.point for point in problem.points])
    centre, size = complex(given.mean()), problem.task_size
    points = (given - centre) / size
    within = pivot_limits(problem, centre, size)
    limit = problem.constraints.link_length
    longest = MAX_LINK if limit is None or limit.max is None else limit.max / size
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
            if sum(member.broken == 0.0 for member in members) < ENOUGH:
                away = np.where(on_family & (lost == 0.0), math.inf, np.hypot(lost, np.sqrt(ends.cost)))
                moved = _moved(family, ends, signs, away, points, setting)
                members += [met(family, one.x, one.theta, signs[k], 0.0) for k, one in moved]
    return _answer(problem, members, brought, progress)


def _moved(
    family: int, ends: Descent, signs: list[float], away: Real, points: Complex, setting: Real
) -> list[tuple[int, Held]]:
    """Members that keep all demands, and the rows of the ends of descents that they were moved from.

    ``away``, shape (n,), is how far an end is from being one; infinite where it is not to be moved.
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
    """Drive the members that differ, and put those first that are asked for."""
    size = problem.task_size

    def verified(member: Member) -> PathDesign | str | None:
        if min(member.joints.lengths) < MIN_LINK * size:
            return "degenerate"
        return verify_path(problem, fourbar_mechanism(member.joints))

    ordered = sorted(members, key=lambda member: member.broken > 0.0)
    driven = [ordered[k] for k in distinct([member.joints for member in ordered], MAX_DRIVEN, SAME_DESIGN * size)]
    sifting = Sifting[PathDesign](problem)
    # The sweep of a room takes longer than all else that is verified.
    enough = ENOUGH_IN_ROOM * problem.max_designs if bounded(problem) else None
    # Limits on forces are broken by many, as far as a fit sees, and these are driven where there are no others.
    sound = [one for one in driven if one.broken == 0.0] if problem.constraints.of_forces else driven
    sifting.sift(reported(sound, progress, (0.6, 1.0), "{done} of {all} linkages driven"), verified, enough)
    if len(sound) < len(driven) and len(sifting.passed) < problem.max_designs:
        sifting.sift((one for one in driven if one.broken > 0.0), verified, problem.max_designs)
    progress(1.0, "verified")
    text = (
        f"{counted(brought, 'linkage')} near a curve through the points {agreeing(brought, 'was', 'were')} brought to "
        f"them, {grouped(len(ordered))} of them exactly and with the pivots where they are asked for; "
        f"{grouped(sifting.accepted)} of {grouped(len(driven))} that differ "
        f"{agreeing(sifting.accepted, 'satisfies', 'satisfy')} all demands."
    )
    text += sifting.reasons()
    if not sifting.accepted:
        text += " None was found; others may exist."
    return PathResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        search=sifting.search("family_search"),
        summary=text,
        family=FamilySearch(followed=brought, met=len(ordered)),
    )
