"""Path generation: choose the method for a problem, and add the cognates to its designs.

Nine points are met by finitely many fourbars, which are all found. Fewer points leave a family, of which members near a
smooth curve are searched; if none is suitable, points are drawn until there are nine.
"""

from __future__ import annotations

from functools import partial

from kinematics.message import compose, join_messages
from synthesis.kinds.path.curve import solver as curve_solver
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.exact.crank_angles import solve_timed
from synthesis.kinds.path.exact.family_search import solve_family
from synthesis.kinds.path.exact.given_pivots import is_solved_completely, solve_given_pivots
from synthesis.kinds.path.exact.nine_point_solver import POINT_COUNT, solve_nine_points
from synthesis.kinds.path.exact.nine_point_solver import warm_up as warm_up_nine_points
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.least_squares import fit_points
from synthesis.kinds.path.multiloop import solver as sixbar_solver
from synthesis.kinds.path.points.fit import warm_up as warm_up_fits
from synthesis.kinds.path.points.workspace_starts import is_workspace_constrained
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.slider_cranks_and_fivebars import solve_other_linkages
from synthesis.kinds.path.type_selection import solve_types
from synthesis.kinds.path.verification.cognates import add_cognates
from synthesis.kinds.path.verification.stance import describe_stance
from synthesis.model.kind import Progress, return_true, scale_progress
from synthesis.model.method_table import Method, solve_by_first

FAMILY_PROGRESS_SHARE = 0.5
"""Share of the progress assigned to the search near a smooth curve, if other searches may follow it."""


def solve_path(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation, and add the cognates to every design."""
    result = (
        _solve_single_type(problem, progress)
        if problem.mechanisms is None
        else solve_types(problem, _solve_single_type, progress)
    )
    designs = [add_cognates(design) for design in result.designs]
    summary = join_messages([result.summary, describe_stance(designs, problem)])
    return result.model_copy(update={"designs": designs, "summary": summary})


def _solve_family_first(problem: PathProblem, progress: Progress) -> PathResult:
    """Search the family of fewer than nine points near a smooth curve; draw further points if that fails."""
    near = solve_family(problem, scale_progress(progress, 0.0, FAMILY_PROGRESS_SHARE))
    if near.search.accepted or is_workspace_constrained(problem):
        # Linkages through additional random points would hardly fit into a workspace, whereas fits are moved into it.
        progress(1.0, compose("path-verified"))
        return near
    return solve_nine_points(problem, scale_progress(progress, FAMILY_PROGRESS_SHARE, 1.0))


_EXACT_METHODS: tuple[Method[PathProblem, PathResult], ...] = (
    Method(is_solved_completely, solve_given_pivots),
    Method(lambda problem: problem.prescribed, solve_timed),
    Method(lambda problem: len(problem.points) < POINT_COUNT, _solve_family_first),
    Method(return_true, solve_nine_points),
)
"""Methods for fourbars that meet the points exactly."""


def _solve_exactly(problem: PathProblem, progress: Progress) -> PathResult:
    return solve_by_first(_EXACT_METHODS, problem, progress)


_METHODS: tuple[Method[PathProblem, PathResult], ...] = (
    Method(lambda problem: problem.mechanism != "fourbar" and problem.is_fitted, solve_other_linkages),
    Method(
        lambda problem: problem.mechanism != "fourbar",
        partial(solve_exactly_or_fit, exact=solve_other_linkages, fitted=solve_other_linkages),
    ),
    Method(lambda problem: problem.is_matched, curve_solver.solve_curve_match),
    Method(lambda problem: problem.is_fitted, fit_points),
    Method(return_true, partial(solve_exactly_or_fit, exact=_solve_exactly, fitted=fit_points)),
)
"""Methods for problems with one type of mechanism; the first two are for types other than fourbars."""


def _solve_single_type(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem with one type of mechanism."""
    return solve_by_first(_METHODS, problem, progress)


def warm_up() -> None:
    """Compile the kernels or load them from cache."""
    curve_solver.warm_up()
    sixbar_solver.warm_up()
    warm_up_nine_points()
    warm_up_fits()
