"""Constrained fits for positions with tolerances in a workspace with obstacles.

Pairs of dyads are sampled in the permitted areas of their pivots (:mod:`synthesis.kinds.motion.room_starts`), and those
with the smallest workspace violation are fitted first to all constraints except the collision-free motion. The results
that are collision-free are verified; of the others, those with the smallest violation are fitted to the workspace too,
until there are enough designs.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from synthesis.fit.held import NEARLY
from synthesis.fit.room import AIM, zones_alone
from synthesis.kinds.motion.demanded import demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.room_starts import pairs_in_room
from synthesis.kinds.motion.steered import REASONS
from synthesis.kinds.motion.steered_fit import (
    Steered,
    all_steered,
    begun,
    demanded_rows,
    different,
    driven,
    in_rooms,
    room_left,
    room_of,
    with_angle,
)
from synthesis.kinds.motion.task import motion_task
from synthesis.model.counting import agreeing, counted
from synthesis.model.kind import Progress
from synthesis.model.linkage_answer import LinkageDesign
from synthesis.outcome.ranking import ranked, widest_apart
from synthesis.outcome.sifting import OUTRANKED, Sifting
from synthesis.proof.space import ROOM

STARTED, AT_ONCE = 60, 15
"""Maximum number of fitted starts, and batch size."""

SIFTED = 3
"""Factor of the number of starts if constraints that the fit ignores (planes, forces) will reject some results."""

APART = 0.2 * 0.5 ** np.arange(8)
"""Minimum separations of distinct starts, in task sizes, tried in turn until one yields enough starts."""

LACKING = 0.05
"""Workspace violation, in task sizes, at which the score of a start is halved."""

MOVED, MOVED_AT_ONCE = 24, 4
"""Maximum number of linkages that are fitted to the workspace, smallest violation first, and batch size."""

HOPELESS = 0.4
"""Maximum workspace violation, in task sizes, of a linkage that is fitted to the workspace."""


NARROWER = 10.0 * AIM
"""Tighter margin of the workspace, as a share of the task's size, if the verification finds a collision between the
steps of the fit."""

BEYOND = 1.8
"""Factor by which the fit overcorrects a transmission angle that was measured to be too small."""


def solve_in_room(problem: MotionProblem, exact: MotionResult | None, progress: Progress) -> MotionResult:
    """Find designs that use the tolerances and fit into the workspace, and merge them with the exact designs.

    Parameters
    ----------
    problem : MotionProblem
        A problem with a workspace and positions with tolerances.
    exact : MotionResult, optional
        The result with all positions met exactly.
    progress : callable
        Progress callback.
    """
    task, target = motion_task(problem), demanded(problem)
    rows, room = demanded_rows(problem, task), room_of(problem, task)
    zones, narrower = zones_alone(room), room_of(problem, task, NARROWER)
    progress(0.0, "sampling linkages in the workspace")
    listed, score = pairs_in_room(problem, task, rows)
    first = [begun(problem, task, rows, start, zones) for start in listed]
    lacking = np.maximum(-room_left(first, rows, room), 0.0)
    order = np.argsort(-score / (1.0 + (lacking / LACKING) ** 2), kind="stable")
    order = order[np.isfinite(lacking[order])]
    pivots = np.array([listed[k].pivots for k in order], np.complex128).reshape(-1, 4)
    sifted = problem.layout is not None or bool(problem.constraints.of_forces)
    first = [first[order[k]] for k in widest_apart(pivots, STARTED * (SIFTED if sifted else 1), APART)]
    sifting = Sifting[LinkageDesign](problem, REASONS)
    if exact is not None:
        sifting.join(exact.search)
        sifting.passed = [design for design in exact.designs if design.verification.passed]
        sifting.failed = [design for design in exact.designs if not design.verification.passed]
    met = len(sifting.passed)
    enough = met + problem.max_designs

    def verified(linkage: Steered) -> LinkageDesign | str | None:
        return driven(problem, task, rows, linkage.x, target)

    def offer(linkages: list[Steered]) -> None:
        """Verify linkages until there are enough designs.

        A linkage that misses the workspace or a transmission angle, because the fit only samples the motion, is fitted
        once more with a correspondingly tighter limit.
        """
        again: list[Steered] = []
        for n, one in enumerate(linkages):
            if len(sifting.passed) >= enough:
                sifting.reject(OUTRANKED, len(linkages) - n)
                break
            design = verified(one)
            reason = sifting.keep(design)
            if reason in ROOM:
                again += in_rooms([one], rows, narrower)
            elif reason == "transmission_angle" and isinstance(design, LinkageDesign):
                # The verified motion may extend beyond the fitted poses if these use a tolerance unnecessarily.
                angle = problem.constraints.min_transmission_angle or 0.0
                short = angle - design.metrics.min_transmission_angle
                again += in_rooms([with_angle(one, angle + BEYOND * short)], rows, room)
            else:
                sifting.count(reason)
        held = all_steered(rows, again)
        sifting.reject("not_steered", len(again) - len(held))
        sifting.sift(held, verified)

    unlike: list[Steered] = []
    away: list[tuple[float, Steered]] = []
    for n in range(0, len(first), AT_ONCE):
        if len(sifting.passed) >= enough:
            sifting.reject(OUTRANKED, len(first) - n)
            break
        progress(0.2 + 0.4 * n / len(first), f"fitting {len(first)} linkages to the tolerances")
        some = first[n : n + AT_ONCE]
        steered = all_steered(rows, some)
        fresh = different([*unlike, *steered])[len(unlike) :]
        sifting.reject("not_steered", len(some) - len(steered))
        sifting.reject(OUTRANKED, len(steered) - len(fresh))
        unlike += fresh
        left = room_left(fresh, rows, room)
        fitting = [one for one, margin in zip(fresh, left, strict=True) if margin >= -NEARLY]
        away += [(-float(margin), one) for one, margin in zip(fresh, left, strict=True) if margin < -NEARLY]
        offer(fitting)
    away.sort(key=lambda one: one[0])
    near = [one for lacks, one in away[:MOVED] if lacks <= HOPELESS]
    sifting.reject("outside_room", len(away) - len(near))
    for n in range(0, len(near), MOVED_AT_ONCE):
        if len(sifting.passed) >= enough:
            sifting.reject(OUTRANKED, len(near) - n)
            break
        progress(0.6 + 0.4 * n / len(near), f"moving {len(near)} linkages into the workspace")
        some = near[n : n + MOVED_AT_ONCE]
        moved = all_steered(rows, in_rooms(some, rows, room))
        sifting.reject("not_steered", len(some) - len(moved))
        offer(moved)
    progress(1.0, "verified")
    return MotionResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        curves=[] if exact is None else exact.curves,
        search=sifting.search("tolerance_search"),
        summary=_summary(sifting, len(listed), len(sifting.passed) - met, met),
    )


def _summary(sifting: Sifting[LinkageDesign], started: int, steered: int, exact: int) -> str:
    if not sifting.passed:
        return (
            f"No design found: fits from {counted(started, 'start')} in the workspace all violate a constraint "
            f"(rejected: {sifting.listed(OUTRANKED) or 'none'}). The search is not exhaustive, so a solution may still "
            "exist."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return (
        f"{counted(steered, 'design', 'designs')} within the workspace {agreeing(steered, 'uses', 'use')} the "
        f"tolerances, and {counted(exact, 'design meets', 'designs meet')} the positions exactly. Best minimum "
        f"transmission angle: {best:.1f}°. A better linkage may exist."
    )
