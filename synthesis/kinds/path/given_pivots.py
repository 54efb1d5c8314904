"""Path generation on two given fixed pivots: five points have finitely many fourbars, and all are found."""

from __future__ import annotations

import numpy as np

from synthesis.kinds.path.design import GivenPivotSolutions, PathResult
from synthesis.kinds.path.five_point_system import SOLUTIONS
from synthesis.kinds.path.five_points import five_points
from synthesis.kinds.path.harvest import Harvest
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.kind import Progress
from synthesis.model.linkages import fourbar_mechanism, to_complex

FIVE, BOTH_PIVOTS = 5, 4
"""Points, and given coordinates of fixed pivots, that leave no freedom and are solved completely."""

SHORTEST_LINK = 1e-9
"""Links shorter than this share of the longest are no links."""


def all_are_found(problem: PathProblem) -> bool:
    """Whether a problem is of the sort that is solved here."""
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
    for n, joints in enumerate(solved.linkages):
        progress(0.5 + 0.5 * n / len(solved.linkages), f"{n} of {len(solved.linkages)} real linkages verified")
        lengths = abs(joints.a - joints.o2), abs(joints.b - joints.a), abs(joints.b - joints.o4)
        if min(lengths) <= SHORTEST_LINK * max(*lengths, abs(joints.o4 - joints.o2)):
            harvest.reject("degenerate")
            continue
        design = verify_path(problem, fourbar_mechanism(joints))
        harvest.add(design)
        on_one_circuit += design is not None and all(
            check.passed for check in design.verification.checks if check.name in ("reaches_targets", "same_circuit")
        )
    progress(1.0, "verified")
    complete = solved.complete and not harvest.unproven
    text = (
        f"{solved.found} of {SOLUTIONS} solutions on these pivots were computed; {len(solved.linkages)} are real, "
        f"{on_one_circuit} of these have all points on one circuit, and {len(harvest.passed)} satisfy all demands."
    )
    if harvest.rejected:
        text += f" Rejected: {harvest.listed()}."
    if not harvest.passed:
        text += " These are all fourbars, so no design exists." if complete else " Others may exist."
    result = harvest.result("five_point_continuation", complete=complete, summary=text)
    counts = GivenPivotSolutions(
        computed=solved.found,
        real=len(solved.linkages),
        on_one_circuit=on_one_circuit,
        largest_residual=solved.largest_residual,
    )
    return result.model_copy(update={"given_pivots": counts})
