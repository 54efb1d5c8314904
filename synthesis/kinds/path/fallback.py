"""Fall back from an exact search to a fit, as method ``auto`` does if no exact design satisfies all constraints.

Few points may still be too many: no linkage of the family may visit them in the given order, or satisfy the
constraints. Nine points on an ellipse are searched like any others: a coupler curve is of the sixth order and may cross
an ellipse twelve times, so that their position does not rule out a fourbar. The answer is then that of least squares,
with the account and the summary of both searches. Because exact points were requested, a fit that misses a point by far
is no answer: the result is then empty, and its summary reports how near a fit comes.
"""

from __future__ import annotations

from collections.abc import Callable

from kinematics.message import compose, join_messages
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.statement.mechanism_types import TYPE_NAMES
from synthesis.model.kind import Progress, scale_progress

EXACT_PROGRESS_SHARE = 0.8
"""Share of the progress assigned to the exact search."""

MAX_FIT_MISS = 0.05
"""Maximum distance from a point, as a share of the task's size, of a fit that replaces an exact design."""

Solve = Callable[[PathProblem, Progress], PathResult]


def solve_exactly_or_fit(
    problem: PathProblem, progress: Progress, exact: Solve, fitted: Solve, type_name: str | None = None
) -> PathResult:
    """Return the result of an exact search or, if it has no design that passes, that of least squares.

    Parameters
    ----------
    problem : PathProblem
        An exact problem of method ``auto`` or ``exact``; only ``auto`` falls back.
    progress : callable
        Receives the share of the work done.
    exact, fitted : callable
        The searches. The second is given the problem with the method ``least_squares``.
    type_name : str, optional
        Type of the linkages as a key of :data:`TYPE_NAMES`; that of the problem by default.
    """
    if problem.method != "auto":
        return exact(problem, progress)
    first = exact(problem, scale_progress(progress, 0.0, EXACT_PROGRESS_SHARE))
    # Any exact design is preferred to every fit.
    if first.search.accepted:
        progress(1.0, compose("path-verified"))
        return first
    nearly = problem.model_copy(update={"method": "least_squares"})
    second = fitted(nearly, scale_progress(progress, EXACT_PROGRESS_SHARE, 1.0))
    # The client asked for exact points; a rough fit would be misleading as an answer.
    near = [design for design in second.designs if _compute_max_miss(design) <= MAX_FIT_MISS * problem.task_size]
    if not any(design.verification.passed for design in near):
        return first.model_copy(
            update={"summary": join_messages([first.summary, _describe_misses(second.designs, problem.length_unit)])}
        )
    account = second.search.model_copy(
        update={
            # A fit can never prove that no exact design exists.
            "complete": False,
            "candidates": first.search.candidates + second.search.candidates,
            "rejected": _add_counts(first.search.rejected, second.search.rejected),
        }
    )
    counted = {name: getattr(first, name) for name in ("triples", "given_pivots", "family", "timed")}
    # Failed exact designs are shown only on request, behind the fits.
    shown = [*near, *first.designs] if problem.include_failed else near
    # Only a complete search proves that no linkage exists.
    summary = compose(
        "path-none-exact-so-fitted" if first.search.complete else "path-none-exact-found-so-fitted",
        type=compose(TYPE_NAMES[type_name or problem.mechanism]),
        fits=second.summary,
        exact=first.summary,
    )
    return second.model_copy(
        update={
            **counted,
            "designs": shown[: problem.max_designs],
            "search": account,
            "summary": summary,
        }
    )


def _compute_max_miss(design: PathDesign) -> float:
    """Return the maximum distance by which a design misses a point, length units."""
    return max(target.point_residual for target in design.targets)


def _describe_misses(fitted: list[PathDesign], unit: str) -> str:
    """Describe in a sentence how near the best feasible fit comes to the points."""
    misses = [_compute_max_miss(design) for design in fitted if design.verification.passed]
    if not misses:
        return ""
    return compose("path-fits-miss-points", miss=f"{min(misses):.4g}", unit=unit, share=f"{100.0 * MAX_FIT_MISS:.0f}")


def _add_counts(one: dict[str, int], other: dict[str, int]) -> dict[str, int]:
    """Add the counts of two tables of reasons."""
    return {name: one.get(name, 0) + other.get(name, 0) for name in (*one, *other)}
