"""Constrained fits for positions with tolerances in a workspace with obstacles.

Pairs of dyads are sampled in the permitted areas of their pivots
(:mod:`synthesis.kinds.motion.constrained.workspace_starts`), and those with the smallest workspace violation are fitted
first to all constraints except the collision-free motion. The results that are collision-free are verified; of the
others, those with the smallest violation are fitted to the workspace too, until there are enough designs.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from kinematics.message import compose, join_messages
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


class _WorkspaceSearch:
    """Fits of one problem in its workspace, and the designs found so far.

    Parameters
    ----------
    problem : MotionProblem
        A problem with a workspace and positions with tolerances.
    exact : MotionResult, optional
        The result with all positions met exactly, which counts towards the requested number of designs.
    """

    def __init__(self, problem: MotionProblem, exact: MotionResult | None) -> None:
        self._problem = problem
        self._task, self._target = make_motion_task(problem), make_target_poses(problem)
        self._rows, self._room = make_target_rows(problem, self._task), pack_task_workspace(problem, self._task)
        self._narrower = pack_task_workspace(problem, self._task, TIGHTER_AIM)
        self.sifting = CandidateLog[LinkageDesign](problem, REASONS)
        if exact is not None:
            self.sifting.merge_search(exact.search)
            # Exact designs count as found, so that the search only fills what is missing.
            self.sifting.passed = [design for design in exact.designs if design.verification.passed]
            self.sifting.failed = [design for design in exact.designs if not design.verification.passed]
        self.exact_count = len(self.sifting.passed)
        self.start_count = 0

    @property
    def _has_enough(self) -> bool:
        # The requested number of new designs, in addition to exact ones, since those may be of poorer quality.
        return len(self.sifting.passed) >= self.exact_count + self._problem.max_designs

    def list_starts(self) -> list[ConstrainedFit]:
        """Return the most promising distinct starts, those with a high score and a small workspace violation."""
        problem, rows = self._problem, self._rows
        listed, score = list_workspace_starts(problem, self._task, rows)
        self.start_count = len(listed)
        zones = select_zones(self._room)
        starts = [make_constrained_fit(problem, self._task, rows, start, zones) for start in listed]
        lacking = np.maximum(-measure_workspace_margins(starts, rows, self._room), 0.0)
        # Divide by the violation: far outside, a start is unlikely to be brought into the workspace.
        order = np.argsort(-score / (1.0 + (lacking / HALF_WEIGHT_VIOLATION) ** 2), kind="stable")
        # Infinite violations belong to linkages that do not close.
        order = order[np.isfinite(lacking[order])]
        pivots = np.array([listed[k].pivots for k in order], np.complex128).reshape(-1, 4)
        sifted = problem.layout is not None or bool(problem.constraints.force_limits)
        most = MAX_STARTS * (FILTER_FACTOR if sifted else 1)
        return [starts[order[k]] for k in select_most_distinct(pivots, most, MIN_SEPARATIONS)]

    def fit_to_tolerances(self, starts: list[ConstrainedFit], progress: Progress) -> list[ConstrainedFit]:
        """Fit starts to everything but the workspace, and verify those that fit into it.

        Returns the others, smallest violation first.
        """
        unlike: list[ConstrainedFit] = []
        away: list[tuple[float, ConstrainedFit]] = []
        # Batches, because the search often has enough designs after the first ones.
        for n in range(0, len(starts), BATCH_SIZE):
            if self._has_enough:
                self.sifting.reject(OUTRANKED_REASON, len(starts) - n)
                break
            progress(0.2 + 0.4 * n / len(starts), compose("motion-fitting-linkages", count=len(starts)))
            some = starts[n : n + BATCH_SIZE]
            solved = solve_constrained(self._rows, some)
            # Distinct from all earlier results, not only within the batch.
            fresh = select_distinct_fits([*unlike, *solved])[len(unlike) :]
            self.sifting.reject("not_steered", len(some) - len(solved))
            self.sifting.reject(OUTRANKED_REASON, len(solved) - len(fresh))
            unlike += fresh
            margins = [float(margin) for margin in measure_workspace_margins(fresh, self._rows, self._room)]
            fits = list(zip(fresh, margins, strict=True))
            away += [(-margin, one) for one, margin in fits if margin < -WORKSPACE_TOLERANCE]
            self._verify_linkages([one for one, margin in fits if margin >= -WORKSPACE_TOLERANCE])
        # Nearest to the workspace first: the move into it is expensive.
        away.sort(key=lambda one: one[0])
        near = [one for lacks, one in away[:MAX_MOVES] if lacks <= MAX_VIOLATION]
        self.sifting.reject("outside_room", len(away) - len(near))
        return near

    def move_into_workspace(self, near: list[ConstrainedFit], progress: Progress) -> None:
        """Fit linkages that violate the workspace slightly to it, and verify them."""
        for n in range(0, len(near), MOVE_BATCH_SIZE):
            if self._has_enough:
                self.sifting.reject(OUTRANKED_REASON, len(near) - n)
                break
            progress(0.6 + 0.4 * n / len(near), compose("motion-moving-into-workspace", count=len(near)))
            some = near[n : n + MOVE_BATCH_SIZE]
            moved = solve_constrained(self._rows, replace_workspace(some, self._rows, self._room))
            self.sifting.reject("not_steered", len(some) - len(moved))
            self._verify_linkages(moved)

    def _verify_linkages(self, linkages: list[ConstrainedFit]) -> None:
        """Verify linkages until there are enough designs.

        A linkage that misses the workspace or a transmission angle, because the fit only samples the motion, is fitted
        once more with a correspondingly tighter limit.
        """
        again: list[ConstrainedFit] = []
        for n, one in enumerate(linkages):
            if self._has_enough:
                self.sifting.reject(OUTRANKED_REASON, len(linkages) - n)
                break
            design = self._build_design(one)
            reason = self.sifting.insert_design(design)
            # A collision between the fit's sampled steps: leave a larger margin.
            if reason in WORKSPACE_CHECKS:
                again += replace_workspace([one], self._rows, self._narrower)
            elif reason == "transmission_angle" and isinstance(design, LinkageDesign):
                # The verified motion may extend beyond the fitted poses if these use a tolerance unnecessarily.
                angle = self._problem.constraints.min_transmission_angle or 0.0
                short = angle - design.metrics.min_transmission_angle
                stricter = with_angle(one, angle + ANGLE_CORRECTION * short)
                again += replace_workspace([stricter], self._rows, self._room)
            # Other failures would occur again.
            else:
                self.sifting.count(reason)
        held = solve_constrained(self._rows, again)
        self.sifting.reject("not_steered", len(again) - len(held))
        self.sifting.verify_candidates(held, self._build_design)

    def _build_design(self, linkage: ConstrainedFit) -> LinkageDesign | str | None:
        return verify_fit(self._problem, self._task, self._rows, linkage.x, self._target)


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
    search = _WorkspaceSearch(problem, exact)
    progress(0.0, compose("motion-sampling-linkages"))
    near = search.fit_to_tolerances(search.list_starts(), progress)
    search.move_into_workspace(near, progress)
    progress(1.0, compose("motion-verified"))
    sifting, met = search.sifting, search.exact_count
    return MotionResult(
        designs=sifting.select_designs(partial(rank_designs, rank_by=problem.rank_by)),
        curves=[] if exact is None else exact.curves,
        search=sifting.build_search("tolerance_search"),
        summary=_describe_result(sifting, search.start_count, len(sifting.passed) - met, met),
    )


def _describe_result(sifting: CandidateLog[LinkageDesign], started: int, fit_count: int, exact: int) -> str:
    if not sifting.passed:
        reasons = sifting.format_reasons(OUTRANKED_REASON) or compose("motion-none-rejected")
        return compose("motion-no-fit-in-workspace", starts=started, reasons=reasons)
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    return join_messages(
        [
            compose("motion-fits-in-workspace", fits=fit_count, exact=exact),
            compose("motion-best-transmission-angle", angle=f"{best:.1f}"),
            compose("motion-better-possible"),
        ]
    )
