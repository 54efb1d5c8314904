"""Path generation on two given fixed pivots: finitely many fourbars go through five points, and all are found."""

from __future__ import annotations

import numpy as np

from kinematics.message import compose
from synthesis.kinds.path.design import GivenPivotSolutions, PathResult
from synthesis.kinds.path.exact.five_point_system import SOLUTION_COUNT
from synthesis.kinds.path.exact.five_points import solve_five_points
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import PathCandidateLog, join_sentences
from synthesis.model.kind import Progress
from synthesis.model.linkage.conversion import to_complex
from synthesis.results.candidate_log import report_candidates

POINT_COUNT, PIVOT_COORDINATE_COUNT = 5, 4
"""Numbers of points, and of given coordinates of fixed pivots, that leave no freedom and are solved completely."""


def is_solved_completely(problem: PathProblem) -> bool:
    """Return whether this module can solve a problem completely."""
    exact = not (problem.is_fitted or problem.prescribed)
    return exact and len(problem.points) == POINT_COUNT and problem.fixed_pivots.count_given() == PIVOT_COORDINATE_COUNT


def solve_given_pivots(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of five points on two given fixed pivots."""
    given = problem.fixed_pivots
    x2, y2, x4, y4 = (
        float(value) for pivot in (given.input, given.output) for value in pivot or () if value is not None
    )
    points = np.array([point.point for point in problem.points])
    progress(0.0, compose("path-following-paths", count=SOLUTION_COUNT))
    solved = solve_five_points(points, to_complex((x2, y2)), to_complex((x4, y4)), np.random.default_rng(problem.seed))
    harvest = PathCandidateLog(problem)
    on_one_circuit = 0
    for joints in report_candidates(solved.linkages, progress, (0.5, 1.0), "path-real-linkages-verified"):
        on_one_circuit += harvest.drive(joints)
    progress(1.0, compose("path-verified"))
    # A solution that rounding kept from being driven might have been a design.
    complete = solved.complete and not harvest.unproven
    text = compose(
        "path-solutions-on-pivots",
        computed=solved.found,
        count=SOLUTION_COUNT,
        real=len(solved.linkages),
        on_one_circuit=on_one_circuit,
        passed=len(harvest.passed),
    )
    summary = join_sentences([text, harvest.describe_reasons(), harvest.describe_completeness(complete=complete)])
    result = harvest.build_result("five_point_continuation", complete=complete, summary=summary)
    counts = GivenPivotSolutions(
        computed=solved.found,
        real=len(solved.linkages),
        on_one_circuit=on_one_circuit,
        largest_residual=solved.largest_residual,
    )
    return result.model_copy(update={"given_pivots": counts})
