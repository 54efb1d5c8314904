"""Path generation: linkages whose coupler point goes through points or along a curve."""

from __future__ import annotations

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.gallery import GALLERY
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.statement.mechanism_types import list_simple_types
from synthesis.model.kind import Kind, Progress, TableColumns
from synthesis.model.linkage.answer import LinkageMechanism

__all__ = ["KIND"]


def _solve(problem: PathProblem, progress: Progress) -> PathResult:
    from synthesis.kinds.path.solver import solve_path

    return solve_path(problem, progress)


def _verify_on_grid(problem: PathProblem, _design: PathDesign, mechanism: LinkageMechanism) -> PathDesign | None:
    from synthesis.kinds.path.verification.on_grid import verify_on_grid

    return verify_on_grid(problem, mechanism)


def _request_usable(problem: PathProblem) -> PathProblem | None:
    """Return the statement of a search for sound fourbars that are near the points, also if exact ones are useless."""
    if problem.mechanisms is not None:
        if "fourbar" not in list_simple_types(problem.mechanisms):
            return None
        problem = problem.select_type("fourbar")
    # Only exact designs, or the fit that descends from one start, were requested.
    if problem.method == "exact" or problem.start is not None:
        return None
    if problem.method != "auto":
        return problem
    matched = problem.closed and not problem.prescribed and problem.mechanism == "fourbar"
    return problem.model_copy(update={"method": "curve_match" if matched else "least_squares"})


def _warm_up() -> None:
    from synthesis.kinds.path.solver import warm_up

    warm_up()


def _is_brief(problem: PathProblem) -> bool:
    """Return whether the problem is solved quickly: points with crank angles need no search for their timing."""
    return problem.prescribed


KIND = Kind(
    "path",
    PathProblem,
    PathResult,
    _solve,
    _warm_up,
    brief=_is_brief,
    nearly=_verify_on_grid,
    usable=_request_usable,
    columns=TableColumns("points", ("x", "y"), closes=True),
    gallery=GALLERY,
)
