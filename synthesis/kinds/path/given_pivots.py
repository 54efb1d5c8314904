"""Path generation on two given fixed pivots: five points have finitely many fourbars, and all are found."""

from __future__ import annotations

import numpy as np

from synthesis.kinds.path.design import GivenPivotSolutions, PathResult
from synthesis.kinds.path.five_point_system import SOLUTIONS
from synthesis.kinds.path.five_points import five_points
from synthesis.kinds.path.harvest import Harvest
from synthesis.kinds.path.problem import PathProblem
from synthesis.model.counting import agreeing, counted
from synthesis.model.kind import Progress
from synthesis.model.linkages import to_complex
from synthesis.outcome.sifting import reported

FIVE, BOTH_PIVOTS = 5, 4
"""Numbers of points, and of given coordinates of fixed pivots, that leave no freedom and are solved completely."""


def all_are_found(problem: PathProblem) -> bool:
    """Return whether this module can solve a problem completely."""
    exact = not (problem.fitted or problem.prescribed)
    return exact and len(problem.points) == FIVE and problem.fixed_pivots.given() == BOTH_PIVOTS


def solve_given_pivots(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of five points on two given fixed pivots."""
    given = problem.fixed_pivots
    x2, y2, x4, y4 = (
        float(value) for pivot in (given.input, given.output) for value in pivot or () if value is not None
    )
    points = np.array([point.point for point in problem.points])
    progress(0.0, f"{SOLUTIONS} paths")
    solved = five_points(points, to_complex((x2, y2)), to_complex((x4, y4)), np.random.default_rng(problem.seed))
    harvest = Harvest(problem)
    on_one_circuit = 0
    for joints in reported(solved.linkages, progress, (0.5, 1.0), "{done} of {all} real linkages verified"):
        on_one_circuit += harvest.drive(joints)
    progress(1.0, "verified")
    # A solution that rounding kept from being driven might have been a design.
    complete = solved.complete and not harvest.unproven
    text = (
        f"{solved.found} of {SOLUTIONS} solutions on these pivots were computed; "
        f"{counted(len(solved.linkages), 'is real', 'are real')}, {on_one_circuit} of these "
        f"{agreeing(on_one_circuit, 'has', 'have')} all points on one circuit, and "
        f"{counted(len(harvest.passed), 'satisfies', 'satisfy')} all constraints."
    )
    text += harvest.reasons() + harvest.proof(complete=complete)
    result = harvest.result("five_point_continuation", complete=complete, summary=text)
    counts = GivenPivotSolutions(
        computed=solved.found,
        real=len(solved.linkages),
        on_one_circuit=on_one_circuit,
        largest_residual=solved.largest_residual,
    )
    return result.model_copy(update={"given_pivots": counts})
