"""Path generation on two given fixed pivots: five points have finitely many fourbars, and all are found."""

from __future__ import annotations

from collections import Counter

import numpy as np

from synthesis.designs import GivenPivotSolutions, PathDesign, PathResult, Search
from synthesis.kinds import Progress
from synthesis.linkages import fourbar_mechanism, to_complex
from synthesis.path.five_point_system import SOLUTIONS
from synthesis.path.five_points import five_points
from synthesis.problems import PathProblem
from synthesis.ranking import ranked
from synthesis.verification.path import verify_path

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
    passed: list[PathDesign] = []
    failed: list[PathDesign] = []
    rejected = Counter[str]()
    on_one_circuit = 0
    for n, joints in enumerate(solved.linkages):
        progress(0.5 + 0.5 * n / len(solved.linkages), f"{n} of {len(solved.linkages)} real linkages verified")
        lengths = abs(joints.a - joints.o2), abs(joints.b - joints.a), abs(joints.b - joints.o4)
        if min(lengths) <= SHORTEST_LINK * max(*lengths, abs(joints.o4 - joints.o2)):
            rejected["degenerate"] += 1
            continue
        design = verify_path(problem, fourbar_mechanism(joints))
        if design is None:
            rejected["cannot_be_driven"] += 1
            continue
        checks = design.verification.checks
        on_one_circuit += all(check.passed for check in checks if check.name in ("reaches_targets", "same_circuit"))
        if design.verification.passed:
            passed.append(design)
        else:
            failed.append(design)
            rejected[next(check.name for check in checks if not check.passed)] += 1
    progress(1.0, "verified")
    # What could not be driven to the points was not measured: no proof rests on it.
    complete = solved.complete and not (
        rejected["degenerate"] or rejected["cannot_be_driven"] or rejected["reaches_targets"]
    )
    shown = ranked(passed, problem.rank_by) + (ranked(failed, problem.rank_by) if problem.include_failed else [])
    text = (
        f"{solved.found} of {SOLUTIONS} solutions on these pivots were computed; {len(solved.linkages)} are real, "
        f"{on_one_circuit} of these have all points on one circuit, and {len(passed)} satisfy all demands."
    )
    listed = {name: count for name, count in rejected.items() if count}
    if listed:
        words = (f"{name.replace('_', ' ')} {count}" for name, count in listed.items())
        text += f" Rejected: {', '.join(words)}."
    if not passed:
        text += " These are all fourbars, so no design exists." if complete else " Others may exist."
    return PathResult(
        designs=shown[: problem.max_designs],
        search=Search(
            method="five_point_continuation",
            complete=complete,
            candidates=len(solved.linkages),
            accepted=len(passed),
            rejected=listed,
            seed=problem.seed,
        ),
        summary=text,
        given_pivots=GivenPivotSolutions(
            computed=solved.found,
            real=len(solved.linkages),
            on_one_circuit=on_one_circuit,
            largest_residual=solved.largest_residual,
        ),
    )
