"""Path generation: all fourbars through nine points; for fewer points, members of the family that they leave.

If a search near a smooth curve finds no suitable member, points are drawn until there are nine.

A real cognate triple yields six designs: three linkages, each with either fixed pivot as the input's. Every one of them
is verified, and the reasons for rejections are counted.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex
from synthesis.kinds.path.curve import solver as curve_solver
from synthesis.kinds.path.design import CognateTriples, PathResult
from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start
from synthesis.kinds.path.exact.crank_angles import solve_timed
from synthesis.kinds.path.exact.family_search import solve_family
from synthesis.kinds.path.exact.given_pivots import is_solved_completely, solve_given_pivots
from synthesis.kinds.path.exact.nine_point_system import (
    ORBIT_COUNT,
    SCALE_GROUPS,
    SCRATCH_SIZE,
    compute_orbit_keys,
    evaluate_nine_point_system,
    evaluate_nine_point_system_extended,
)
from synthesis.kinds.path.exact.nine_points import TripleSolutions, compute_triples
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.least_squares import fit_points
from synthesis.kinds.path.points.fit import warm_up as warm_up_fits
from synthesis.kinds.path.points.workspace_starts import is_workspace_constrained
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import PathCandidateLog
from synthesis.kinds.path.sixbar import solver as sixbar_solver
from synthesis.kinds.path.slider_cranks_and_fivebars import solve_other_linkages
from synthesis.kinds.path.type_selection import solve_types
from synthesis.kinds.path.verification.cognates import add_cognates
from synthesis.kinds.path.verification.stance import describe_stance
from synthesis.model.counting import choose_word, format_count, format_integer
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.conversion import FourbarConfiguration
from synthesis.numerics.continuation import follow, refine

POINT_COUNT = 9

THREAD_COUNT = 2
"""Paths are followed two at a time: the kernels release the interpreter, and most machines have a second core."""

CURVE_OFFSET_RATIO = 0.03
"""Distance of drawn points from the smooth curve, as a share of the points' mean distance, so that no two rounds are
alike."""

FAMILY_PROGRESS_SHARE = 0.5
"""Share of the progress assigned to the search near a smooth curve, if other searches may follow it."""


def solve_path(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation; every design brings its cognates."""
    result = (
        _solve_single_type(problem, progress)
        if problem.mechanisms is None
        else solve_types(problem, _solve_single_type, progress)
    )
    designs = [add_cognates(design) for design in result.designs]
    return result.model_copy(
        update={"designs": designs, "summary": f"{result.summary}{describe_stance(designs, problem)}"}
    )


def _solve_single_type(problem: PathProblem, progress: Progress) -> PathResult:
    """Dispatch a problem with one mechanism type to its solver."""
    if problem.mechanism != "fourbar":
        if problem.is_fitted:
            return solve_other_linkages(problem, progress)
        return solve_exactly_or_fit(problem, progress, solve_other_linkages, solve_other_linkages)
    if problem.is_matched:
        return curve_solver.solve_curve_match(problem, progress)
    if problem.is_fitted:
        return fit_points(problem, progress)
    return solve_exactly_or_fit(problem, progress, _solve_exactly, fit_points)


def _solve_exactly(problem: PathProblem, progress: Progress) -> PathResult:
    """Find fourbars that meet the points exactly."""
    if is_solved_completely(problem):
        return solve_given_pivots(problem, progress)
    if problem.prescribed:
        return solve_timed(problem, progress)
    if len(problem.points) < POINT_COUNT:
        near = solve_family(problem, scale_progress(progress, 0.0, FAMILY_PROGRESS_SHARE))
        if near.search.accepted or is_workspace_constrained(problem):
            # Linkages through additional random points would hardly fit into a workspace; fits are led into it.
            progress(1.0, "verified")
            return near
        return _solve_nine(problem, scale_progress(progress, FAMILY_PROGRESS_SHARE, 1.0))
    return _solve_nine(problem, progress)


def _solve_nine(problem: PathProblem, progress: Progress) -> PathResult:
    """Find all fourbars through nine points, some of which are drawn if fewer are given."""
    rng = np.random.default_rng(problem.seed)
    given = np.array([point.point for point in problem.points])
    rounds = 1 if len(given) == POINT_COUNT else problem.rounds
    harvest = PathCandidateLog(problem)
    computed: list[TripleSolutions] = []
    on_one_circuit = 0
    for n in range(rounds):

        def report_paths(share: float, n: int = n) -> None:
            tracked = f"{round(share * ORBIT_COUNT)} of {ORBIT_COUNT} paths followed"
            message = tracked if rounds == 1 else f"round {n + 1} of {rounds}: {tracked}"
            progress(0.95 * (n + share) / rounds, message)

        triples = compute_triples(_complete_to_nine(given, rng), rng, report_paths, THREAD_COUNT)
        computed.append(triples)
        on_one_circuit += _verify_triples(harvest, triples)
    progress(1.0, "verified")
    complete = len(given) == POINT_COUNT and computed[0].complete and not harvest.unproven
    counts = CognateTriples(
        rounds=rounds,
        computed=sum(len(triples.y) for triples in computed),
        real=sum(len(triples.real) for triples in computed),
        on_one_circuit=on_one_circuit,
        largest_residual=max(triples.largest_residual for triples in computed),
        closed_under_conjugation=all(triples.self_conjugate for triples in computed),
    )
    method = "nine_point_continuation" if len(given) == POINT_COUNT else "nine_point_family"
    text = (
        f"{counts.computed} of {ORBIT_COUNT * rounds} triples of cognate fourbars were computed; "
        f"{format_count(counts.real, 'is real', 'are real')}, {on_one_circuit} of these "
        f"{choose_word(on_one_circuit, 'has', 'have')} all points on one circuit, and "
        f"{format_integer(harvest.accepted)} of "
        f"{format_count(harvest.candidates, 'design')} {choose_word(harvest.accepted, 'satisfies', 'satisfy')} all "
        f"constraints.{harvest.describe_reasons()}{harvest.describe_completeness(complete=complete)}"
    )
    result = harvest.build_result(method, complete=complete, summary=text)
    return result.model_copy(update={"triples": counts})


def warm_up() -> None:
    """Compile or load the kernels by refining a few solutions of the start; the paths of a whole problem would take a
    second."""
    curve_solver.warm_up()
    sixbar_solver.warm_up()
    begun = load_nine_point_start()
    y, low, _ = refine(
        evaluate_nine_point_system_extended,
        SCALE_GROUPS,
        SCRATCH_SIZE,
        begun.y[:2],
        np.zeros_like(begun.y[:2]),
        begun.p,
    )
    follow(evaluate_nine_point_system, SCALE_GROUPS, SCRATCH_SIZE, y, begun.p, begun.p, np.zeros_like(begun.p))
    compute_orbit_keys(y, begun.p, low)
    warm_up_fits()


def _complete_to_nine(given: Complex, rng: np.random.Generator) -> Complex:
    """Return nine points: the given ones in their places, and others drawn near a smooth curve through them."""
    missing = POINT_COUNT - len(given)
    if missing == 0:
        return given
    chords = np.abs(np.diff(given))
    along = np.concatenate([[0.0], np.cumsum(chords)])
    curve = CubicSpline(along, given)
    between = rng.choice(len(chords), missing, p=chords / chords.sum())
    # Away from the given points: nearly equal points make the system nearly singular.
    drawn = along[between] + chords[between] * rng.uniform(0.15, 0.85, missing)
    off = CURVE_OFFSET_RATIO * chords.mean() * (rng.normal(size=(missing, 2)) @ np.array([1.0, 1.0j]))
    return np.concatenate([given, np.asarray(curve(drawn)) + off])


def _verify_triples(harvest: PathCandidateLog, triples: TripleSolutions) -> int:
    """Verify all six designs of every triple; return the number of triples with all points on one circuit."""
    origin = harvest.problem.points[0].point
    on_one_circuit = 0
    for triple in triples.real:
        one_circuit = False
        for o2, a, o4, b in triple:
            for joints in ((o2, a, b, o4, origin), (o4, b, a, o2, origin)):
                one_circuit |= harvest.drive(FourbarConfiguration(*map(complex, joints)))
        on_one_circuit += one_circuit
    return on_one_circuit
