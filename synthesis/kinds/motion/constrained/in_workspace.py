"""Constrained fits for positions with tolerances in a workspace with obstacles.

Pairs of dyads are sampled in the permitted areas of their pivots
(:mod:`synthesis.kinds.motion.constrained.workspace_starts`), and those with the smallest workspace violation are fitted
first to all constraints except the collision-free motion. The results that are collision-free are verified; of the
others, those with the smallest violation are fitted to the workspace too, until there are enough designs.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from synthesis.fit.constrained_fit import WORKSPACE_TOLERANCE
from synthesis.fit.workspace import AIM_SHARE, select_zones
from synthesis.kinds.motion.constrained.fit import (
    ConstrainedFit,
    make_constrained_fit,
    make_target_rows,
    measure_workspace_margins,
    pack_task_workspace,
    replace_workspace,
    select_distinct_fits,
    solve_constrained,
    verify_fit,
    with_angle,
)
from synthesis.kinds.motion.constrained.solver import REASONS
from synthesis.kinds.motion.constrained.workspace_starts import list_workspace_starts
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import make_motion_task
from synthesis.kinds.motion.task.target_poses import make_target_poses
from synthesis.model.counting import choose_word, format_count
from synthesis.model.kind import Progress
from synthesis.model.linkage.answer import LinkageDesign
from synthesis.results.candidate_log import OUTRANKED_REASON, CandidateLog
from synthesis.results.ranking import rank_designs, select_most_distinct
from synthesis.verification.workspace import WORKSPACE_CHECKS

MAX_STARTS, BATCH_SIZE = 60, 15
"""Maximum number of fitted starts, and batch size."""

FILTER_FACTOR = 3
"""Factor of the number of starts if constraints that the fit ignores (planes, forces) will reject some results."""

MIN_SEPARATIONS = 0.2 * 0.5 ** np.arange(8)
"""Minimum separations of distinct starts, in task sizes, tried in turn until one yields enough starts."""

HALF_WEIGHT_VIOLATION = 0.05
"""Workspace violation, in task sizes, at which the score of a start is halved."""

MAX_MOVES, MOVE_BATCH_SIZE = 24, 4
"""Maximum number of linkages that are fitted to the workspace, smallest violation first, and batch size."""

MAX_VIOLATION = 0.4
"""Maximum workspace violation, in task sizes, of a linkage that is fitted to the workspace."""


TIGHTER_AIM = 10.0 * AIM_SHARE
"""Tighter margin of the workspace, as a share of the task's size, if the verification finds a collision between the
steps of the fit."""

ANGLE_CORRECTION = 1.8
"""Factor by which the fit overcorrects a transmission angle that was measured to be too small."""


def solve_in_workspace(problem: MotionProblem, exact: MotionResult | None, progress: Progress) -> MotionResult:
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
    task, target = make_motion_task(problem), make_target_poses(problem)
    rows, room = make_target_rows(problem, task), pack_task_workspace(problem, task)
    zones, narrower = select_zones(room), pack_task_workspace(problem, task, TIGHTER_AIM)
    progress(0.0, "sampling linkages in the workspace")
    listed, score = list_workspace_starts(problem, task, rows)
    first = [make_constrained_fit(problem, task, rows, start, zones) for start in listed]
    lacking = np.maximum(-measure_workspace_margins(first, rows, room), 0.0)
    order = np.argsort(-score / (1.0 + (lacking / HALF_WEIGHT_VIOLATION) ** 2), kind="stable")
    order = order[np.isfinite(lacking[order])]
    pivots = np.array([listed[k].pivots for k in order], np.complex128).reshape(-1, 4)
    sifted = problem.layout is not None or bool(problem.constraints.force_limits)
    first = [
        first[order[k]]
        for k in select_most_distinct(pivots, MAX_STARTS * (FILTER_FACTOR if sifted else 1), MIN_SEPARATIONS)
    ]
    sifting = CandidateLog[LinkageDesign](problem, REASONS)
    if exact is not None:
        sifting.merge_search(exact.search)
        sifting.passed = [design for design in exact.designs if design.verification.passed]
        sifting.failed = [design for design in exact.designs if not design.verification.passed]
    met = len(sifting.passed)
    enough = met + problem.max_designs

    def build_design(linkage: ConstrainedFit) -> LinkageDesign | str | None:
        return verify_fit(problem, task, rows, linkage.x, target)

    def verify_linkages(linkages: list[ConstrainedFit]) -> None:
        """Verify linkages until there are enough designs.

        A linkage that misses the workspace or a transmission angle, because the fit only samples the motion, is fitted
        once more with a correspondingly tighter limit.
        """
        again: list[ConstrainedFit] = []
        for n, one in enumerate(linkages):
            if len(sifting.passed) >= enough:
                sifting.reject(OUTRANKED_REASON, len(linkages) - n)
                break
            design = build_design(one)
            reason = sifting.insert_design(design)
            if reason in WORKSPACE_CHECKS:
                again += replace_workspace([one], rows, narrower)
            elif reason == "transmission_angle" and isinstance(design, LinkageDesign):
                # The verified motion may extend beyond the fitted poses if these use a tolerance unnecessarily.
                angle = problem.constraints.min_transmission_angle or 0.0
                short = angle - design.metrics.min_transmission_angle
                again += replace_workspace([with_angle(one, angle + ANGLE_CORRECTION * short)], rows, room)
            else:
                sifting.count(reason)
        held = solve_constrained(rows, again)
        sifting.reject("not_steered", len(again) - len(held))
        sifting.verify_candidates(held, build_design)

    unlike: list[ConstrainedFit] = []
    away: list[tuple[float, ConstrainedFit]] = []
    for n in range(0, len(first), BATCH_SIZE):
        if len(sifting.passed) >= enough:
            sifting.reject(OUTRANKED_REASON, len(first) - n)
            break
        progress(0.2 + 0.4 * n / len(first), f"fitting {len(first)} linkages to the tolerances")
        some = first[n : n + BATCH_SIZE]
        steered = solve_constrained(rows, some)
        fresh = select_distinct_fits([*unlike, *steered])[len(unlike) :]
        sifting.reject("not_steered", len(some) - len(steered))
        sifting.reject(OUTRANKED_REASON, len(steered) - len(fresh))
        unlike += fresh
        left = measure_workspace_margins(fresh, rows, room)
        fitting = [one for one, margin in zip(fresh, left, strict=True) if margin >= -WORKSPACE_TOLERANCE]
        away += [
            (-float(margin), one) for one, margin in zip(fresh, left, strict=True) if margin < -WORKSPACE_TOLERANCE
        ]
        verify_linkages(fitting)
    away.sort(key=lambda one: one[0])
    near = [one for lacks, one in away[:MAX_MOVES] if lacks <= MAX_VIOLATION]
    sifting.reject("outside_room", len(away) - len(near))
    for n in range(0, len(near), MOVE_BATCH_SIZE):
        if len(sifting.passed) >= enough:
            sifting.reject(OUTRANKED_REASON, len(near) - n)
            break
        progress(0.6 + 0.4 * n / len(near), f"moving {len(near)} linkages into the workspace")
        some = near[n : n + MOVE_BATCH_SIZE]
        moved = solve_constrained(rows, replace_workspace(some, rows, room))
        sifting.reject("not_steered", len(some) - len(moved))
        verify_linkages(moved)
    progress(1.0, "verified")
    return MotionResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        curves=[] if exact is None else exact.curves,
        search=sifting.build_search("tolerance_search"),
        summary=_describe_result(sifting, len(listed), len(sifting.passed) - met, met),
    )


def _describe_result(sifting: CandidateLog[LinkageDesign], started: int, fit_count: int, exact: int) -> str:
    if not sifting.passed:
        return (
            f"No design found: fits from {format_count(started, 'start')} in the workspace all violate a constraint "
            f"(rejected: {sifting.format_reasons(OUTRANKED_REASON) or 'none'}). The search is not exhaustive, so a "
            "solution may still "
            "exist."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return (
        f"{format_count(fit_count, 'design', 'designs')} within the workspace {choose_word(fit_count, 'uses', 'use')} "
        "the "
        f"tolerances, and {format_count(exact, 'design meets', 'designs meet')} the positions exactly. Best minimum "
        f"transmission angle: {best:.1f}°. A better linkage may exist."
    )
