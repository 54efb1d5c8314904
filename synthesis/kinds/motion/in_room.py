"""Positions of which some have tolerances, in a room: linkages that are steered into both.

Pairs of dyads that are drawn where their pivots may lie (:mod:`synthesis.kinds.motion.room_starts`), those first that
lack least of the room, are brought to hold everything but the motion through the room. What then keeps that too is
driven and swept; of the others those that lack least are held within it as well, until there are designs enough.
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
"""Linkages that are steered, and how many of them at a time."""

SIFTED = 3
"""Times as many are steered where demands that do not steer, on planes or forces, leave only some of them."""

APART = 0.2 * 0.5 ** np.arange(8)
"""Distinct starts move some joint by at least this share of the task's size: the first at which there are enough."""

LACKING = 0.05
"""What a start lacks of the room, in task sizes, with which it counts half."""

MOVED, MOVED_AT_ONCE = 24, 4
"""Linkages that are moved into the room, those that lack least of it, and how many of them at a time."""

HOPELESS = 0.4
"""What a linkage lacks of the room, in task sizes, with which it is not moved."""


NARROWER = 10.0 * AIM
"""Share of the task's size by which a room is kept more narrowly where the sweep finds what the fit passes over between
its steps."""

BEYOND = 1.8
"""By how many times what it lacks a transmission angle is asked for that was measured to be too small."""


def solve_in_room(problem: MotionProblem, exact: MotionResult | None, progress: Progress) -> MotionResult:
    """Designs that use the tolerances and fit into the room, beside those that meet the positions exactly.

    Parameters
    ----------
    problem : MotionProblem
        With a room, and positions with tolerances.
    exact : MotionResult, optional
        The answer with all positions met exactly.
    progress : callable
        Told how far the work is.
    """
    task, target = motion_task(problem), demanded(problem)
    rows, room = demanded_rows(problem, task), room_of(problem, task)
    zones, narrower = zones_alone(room), room_of(problem, task, NARROWER)
    progress(0.0, "drawing linkages in the room")
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
        """Drive and sweep linkages until there are enough; what misses the room or a transmission angle by what the fit
        does not see is held once more, as much more narrowly."""
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
                # The motion ends beyond the poses of the fit, where these use a tolerance that it need not.
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
        progress(0.2 + 0.4 * n / len(first), f"steering {len(first)} linkages into the tolerances")
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
        progress(0.6 + 0.4 * n / len(near), f"moving {len(near)} linkages into the room")
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
            f"None of {counted(started, 'linkage')} that were drawn in the room and steered into the tolerances and "
            "demands "
            f"satisfies them all (rejected: {sifting.listed(OUTRANKED) or 'none'}). A linkage may exist that the "
            "search did not meet."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return (
        f"{counted(steered, 'linkage that was', 'linkages that were')} steered into the room and the tolerances "
        f"{agreeing(steered, 'satisfies', 'satisfy')} all demands, and {counted(exact, 'that meets', 'that meet')} the "
        f"positions exactly; the least transmission angle is up to {best:.1f}°. A better linkage may exist."
    )
