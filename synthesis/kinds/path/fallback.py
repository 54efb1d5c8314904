"""What method ``auto`` does where no design meets the points exactly and keeps all demands: the points are fitted.

Few points may still be too many: in an order that no linkage of the family visits them in, or where the demands leave
none. Nine points on an ellipse are searched like any others: a coupler curve is of the sixth order and may cross an
ellipse twelve times, so that where they lie does not rule a fourbar out.
The answer is then that of least squares, and the account and the summary are those of both searches. Points were to be
met, so that a fit which misses one by far is no answer: the task has then none, and how near a fit comes is told.
"""

from __future__ import annotations

from collections.abc import Callable

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.stated_mechanisms import NAMES
from synthesis.model.kind import Progress, part_of

FIRST_PART = 0.8
"""Share of the progress that the exact search counts for."""

FAR = 0.05
"""Share of the task's size by which a fit may miss a point and still be offered."""

Solve = Callable[[PathProblem, Progress], PathResult]


def exact_or_fitted(problem: PathProblem, progress: Progress, exact: Solve, fitted: Solve) -> PathResult:
    """The answer of an exact search, or, where it has no design that passes, that of least squares.

    Parameters
    ----------
    problem : PathProblem
        One of method ``auto`` or ``exact`` that is to be met exactly; only ``auto`` falls back.
    progress : callable
        Told how far the work is.
    exact, fitted : callable
        The searches. The second is given the problem with the method ``least_squares``.
    """
    if problem.method != "auto":
        return exact(problem, progress)
    first = exact(problem, part_of(progress, 0.0, FIRST_PART))
    if first.search.accepted:
        return first
    nearly = problem.model_copy(update={"method": "least_squares"})
    second = fitted(nearly, part_of(progress, FIRST_PART, 1.0))
    near = [design for design in second.designs if _farthest(design) <= FAR * problem.task_size]
    if not any(design.verification.passed for design in near):
        return first.model_copy(update={"summary": f"{first.summary}{_too_far(second.designs, problem.length_unit)}"})
    account = second.search.model_copy(
        update={
            "complete": False,
            "candidates": first.search.candidates + second.search.candidates,
            "rejected": _sum(first.search.rejected, second.search.rejected),
        }
    )
    counted = {name: getattr(first, name) for name in ("triples", "given_pivots", "family", "timed")}
    shown = [*near, *first.designs] if problem.include_failed else near
    name = NAMES["sixbar" if problem.sixbars else problem.mechanism]
    begun = (
        f"No {name}{'' if first.search.complete else ' was found that'} meets the points exactly and keeps all demands"
    )
    return second.model_copy(
        update={
            **counted,
            "designs": shown[: problem.max_designs],
            "search": account,
            "summary": f"{begun}; they are fitted instead. {second.summary} Exactly: {first.summary}",
        }
    )


def _farthest(design: PathDesign) -> float:
    return max(target.point_residual for target in design.targets)


def _too_far(fitted: list[PathDesign], unit: str) -> str:
    """How near the nearest fit that keeps all demands comes to the points, in a sentence."""
    misses = [_farthest(design) for design in fitted if design.verification.passed]
    if not misses:
        return ""
    return (
        f" Fitted by least squares, the farthest point is missed by {min(misses):.4g} {unit} at best, which is more "
        f"than {FAR:.0%} of the task's size; the method least_squares shows such designs."
    )


def _sum(one: dict[str, int], other: dict[str, int]) -> dict[str, int]:
    return {name: one.get(name, 0) + other.get(name, 0) for name in (*one, *other)}
