"""Entry point to all solvers."""

from __future__ import annotations

import time

from kinematics.kernel_marks import LINKAGES_PART, is_compiled
from kinematics.linkage import warm
from kinematics.message import compose
from synthesis.model.answer import AnyNearestMiss, AnyResult
from synthesis.model.kind import AnyKind, Progress, scale_progress
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.problem import ProblemBase
from synthesis.model.text_messages import list_messages
from synthesis.nearest_miss import Relaxation, find_nearest_miss
from synthesis.registry import KINDS
from synthesis.results.forces import report_unknown_forces
from synthesis.results.measured_ranking import (
    MAX_EXAMINED,
    MAX_ROUNDED,
    rank_by_measure,
    search_below_limits,
    sort_by_measure,
    widen_search,
)
from synthesis.results.measurement import measure_buildability, measure_designs
from synthesis.results.pareto import pareto_front
from synthesis.results.practicality import order_designs
from synthesis.results.remarks import append_remark, write_quantity
from synthesis.results.rounding import round_designs
from synthesis.usable_search import search_usable

__all__ = [
    "Progress",
    "compile_constraints",
    "compile_kind",
    "load_linkages",
    "solve",
    "warm_up",
    "warm_up_rest",
]

POLL_PERIOD_S = 1.0
"""Period, seconds, of polling whether the kernels of a kind have been compiled, which a mark on disk shows."""

SEARCH_SHARE = 0.9
"""Share of the progress for the search; the rest is for the nearest miss if no design passed."""


def _ignore_progress(_fraction: float, _message: str) -> None:
    pass


def solve(problem: ProblemBase, progress: Progress | None = None) -> AnyResult:
    """Solve a problem and verify every design.

    Parameters
    ----------
    problem : ProblemBase
        A problem without contradictions.
    progress : callable, optional
        Progress callback.

    Raises
    ------
    ContradictionError
        If ``problem.find_contradictions()`` is not empty.
    """
    problem.require_consistent()
    told = _ignore_progress if progress is None else progress
    kind = KINDS[problem.kind]
    asked = widen_search(problem)
    result: AnyResult = kind.solve(asked, scale_progress(told, 0.0, SEARCH_SHARE))
    # Designs that fail a check are listed only on request and do not count as a result.
    if not any(design.verification.passed for design in result.designs):
        told(SEARCH_SHARE, compose("synthesis-searching-nearest-miss"))
        rest = scale_progress(told, SEARCH_SHARE, 1.0)
        result = _apply_relaxation(asked, result, find_nearest_miss(asked, kind, rest), kind)
    if isinstance(problem, LinkageProblem):
        result = _finish_linkages(problem, result, kind, scale_progress(told, SEARCH_SHARE, 1.0))
    told(1.0, compose("results-verified"))
    result = result.model_copy(update={"summary": append_remark(result.summary, _describe_listed(problem, result))})
    return result.model_copy(update={"messages": list_messages(result)})


def _finish_linkages(problem: LinkageProblem, result: AnyResult, kind: AnyKind, progress: Progress) -> AnyResult:
    """Complete an answer: search for sound designs if none was found, rank, round, and add what blocks request."""
    result, searched = search_usable(problem, result, kind, progress)
    # Order matters: expensive measures first select and rank, rounding changes designs, and missing results come last.
    is_measured = problem.rank_by in MAX_EXAMINED
    if is_measured:
        result = measure_designs(problem, result, problem.rank_by)
        result = search_below_limits(problem, result, lambda narrower: kind.solve(narrower, _ignore_progress))
    if problem.manufacture is not None and problem.manufacture.is_gridded:
        result = _round_designs(problem, result, kind)
    measured = [measure_buildability(problem, design) for design in result.designs]
    # Practicality is judged in the default order, in which designs were searched.
    designs, remark = order_designs(widen_search(problem), measured, searched=searched)
    if is_measured:
        result = rank_by_measure(problem, result.model_copy(update={"designs": designs}))
    else:
        result = result.model_copy(update={"designs": designs, "summary": append_remark(result.summary, remark)})
    result = report_unknown_forces(problem, measure_designs(problem, result))
    return result.model_copy(update={"front": pareto_front(result.designs)})


def _round_designs(problem: LinkageProblem, result: AnyResult, kind: AnyKind) -> AnyResult:
    """Round designs to the grid; if they are ranked by a measured quantity, round only the best ones."""
    if problem.rank_by not in MAX_EXAMINED:
        return round_designs(problem, result, kind.nearly)
    # Rounding is expensive, so round only as many designs as may be listed, plus some in reserve: a design may have no
    # neighbour on the grid.
    first = sort_by_measure(problem, result.designs)[: max(problem.max_designs, MAX_ROUNDED)]
    every = problem.model_copy(update={"max_designs": len(first) or 1})
    rounded = round_designs(every, result.model_copy(update={"designs": first}), kind.nearly)
    # Rounding changes the design, so its measured quantity must be recomputed.
    return measure_designs(problem, rounded, problem.rank_by)


def _apply_relaxation(problem: ProblemBase, result: AnyResult, found: Relaxation, kind: AnyKind) -> AnyResult:
    """Return an answer without designs, completed by designs found by ignoring constraints or by the nearest miss."""
    if not found.sound:
        miss = found.nearest_miss
        reached = "" if miss is None or kind.easing is None else kind.easing.describe_reached(miss.reachable)
        remark = reached or _describe_overlap(problem, miss)
        return result.model_copy(update={"nearest_miss": miss, "summary": append_remark(result.summary, remark)})
    designs = found.sound[: problem.max_designs]
    count, search = len(designs), result.search
    # These designs were found by another search, so the original one counts as incomplete.
    account = {"complete": False, "candidates": search.candidates + count, "accepted": count}
    return result.model_copy(
        update={
            "designs": [*designs, *result.designs][: problem.max_designs],
            "search": search.model_copy(update=account),
            "summary": compose("synthesis-designs-without-constraints", count=count),
        }
    )


def _describe_listed(problem: ProblemBase, result: AnyResult) -> str:
    """Return a sentence on the number of designs that are listed; empty if all that passed are."""
    # Rounding to a grid drops designs, which the summary says already.
    if isinstance(problem, LinkageProblem) and problem.manufacture is not None and problem.manufacture.is_gridded:
        return ""
    listed = sum(design.verification.passed for design in result.designs)
    if not 0 < listed < result.search.accepted:
        return ""
    return compose("synthesis-designs-listed", listed=listed, count=result.search.accepted)


def _describe_overlap(problem: ProblemBase, miss: AnyNearestMiss | None) -> str:
    """Return a sentence on the penetration depth of a nearest miss in an obstacle; empty if nothing overlaps."""
    gaps = [] if miss is None else miss.gaps
    depth = max((-gap.value for gap in gaps if gap.check == "obstacles" and gap.value is not None), default=0.0)
    if depth <= 0.0:
        return ""
    return compose("synthesis-nearest-miss-overlaps", depth=write_quantity(f"{depth:.4g}", problem.length_unit))


def warm_up() -> None:
    """Compile the kernels of the most common jobs, or load them from the cache.

    :func:`warm_up_rest` loads all other kernels.
    """
    for kind in KINDS.values():
        if kind.is_first_loaded:
            solve(kind.problem.model_validate(kind.examples[0]))


def warm_up_rest() -> None:
    """Load everything else that the first jobs may need: the analysis core, and the solvers of all kinds.

    Wait until another process has compiled the kernels of each part, because compiling them here would delay jobs.
    """
    waiting = [LINKAGES_PART, *KINDS]
    while waiting:
        # A mark on disk shows that another process has compiled the kernels.
        for part in [part for part in waiting if is_compiled(part)]:
            load_linkages() if part == LINKAGES_PART else _load_kernels(part)
            # The loop runs over a new list, so removing from `waiting` is safe.
            waiting.remove(part)
        if waiting:
            time.sleep(POLL_PERIOD_S)


def load_linkages() -> None:
    """Compile the kernels of the analysis of linkages, or load them from the cache."""
    warm.warm_up()


def compile_kind(name: str) -> None:
    """Compile all kernels that the solver of a kind may need.

    These are the kernels that a worker loads, and those that the examples of the kind use.
    """
    kind = KINDS[name]
    _load_kernels(name)
    if kind.warm_up is not None:
        for statement in kind.examples:
            solve(kind.problem.model_validate(statement))


def compile_constraints() -> None:
    """Compile kernels that no example uses, by solving the problems that the kinds declare for this purpose.

    These are the kernels for forces, manufacture, workspaces, and sixbars of each type.
    """
    for kind in KINDS.values():
        for statement in kind.list_warm_up_problems():
            solve(kind.problem.model_validate(statement))


def _load_kernels(name: str) -> None:
    """Load the kernels of a kind, by its ``warm_up`` or by solving its examples."""
    kind = KINDS[name]
    if kind.warm_up is not None:
        kind.warm_up()
        return
    for statement in kind.examples:
        solve(kind.problem.model_validate(statement))
