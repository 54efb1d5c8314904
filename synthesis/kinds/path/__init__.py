"""Path generation: linkages whose coupler point goes through points or along a curve."""

from __future__ import annotations

from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.gallery import GALLERY
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.kind import Kind, Progress, TableColumns
from synthesis.model.linkage.answer import LinkageMechanism

__all__ = ["KIND"]


def _solve(problem: PathProblem, progress: Progress) -> PathResult:
    from synthesis.kinds.path.solver import solve_path

    return solve_path(problem, progress)


def _verify_on_grid(problem: PathProblem, _design: PathDesign, mechanism: LinkageMechanism) -> PathDesign | None:
    from synthesis.kinds.path.verification.on_grid import verify_on_grid

    return verify_on_grid(problem, mechanism)


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
    columns=TableColumns("points", ("x", "y")),
    gallery=GALLERY,
)
