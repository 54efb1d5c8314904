"""Path generation: all fourbars through nine points; for fewer points, members of the family that they leave.

If a search near a smooth curve finds no suitable member, points are drawn until there are nine.

A real cognate triple yields six designs: three linkages, each with either fixed pivot as the input's. Every one of them
is verified, and the reasons for rejections are counted.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from synthesis.kinds.path import curve_match, sixbar_search
from synthesis.kinds.path.by_type import solve_types
from synthesis.kinds.path.design import CognateTriples, PathResult
from synthesis.kinds.path.fallback import exact_or_fitted
from synthesis.kinds.path.family_search import solve_family
from synthesis.kinds.path.fits import fit_points
from synthesis.kinds.path.given_pivots import all_are_found, solve_given_pivots
from synthesis.kinds.path.harvest import Harvest
from synthesis.kinds.path.nine_point import Triples, all_triples
from synthesis.kinds.path.nine_point_system import (
    GROUPS,
    ORBITS,
    SCRATCH,
    nine_point_system,
    nine_point_system_extended,
    orbit_keys,
)
from synthesis.kinds.path.other_linkages import solve_other
from synthesis.kinds.path.point_fit import warm_up as warm_up_fits
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.room_starts import bounded
from synthesis.kinds.path.stance import told_of_stance
from synthesis.kinds.path.starts import nine_point_start
from synthesis.kinds.path.timed import solve_timed
from synthesis.kinds.path.verify_cognates import with_cognates
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkages import FourbarConfiguration
from synthesis.numerics.continuation import follow, refine

Complex = NDArray[np.complex128]

NINE = 9

THREADS = 2
"""Paths are followed two at a time: the kernels release the interpreter, and most machines have a second core."""

OFF_CURVE = 0.03
"""Distance of drawn points from the smooth curve, as a share of the points' mean distance, so that no two rounds are
alike."""

FIRST_PART = 0.5
"""Share of the progress assigned to the search near a smooth curve, if other searches may follow it."""


def solve_path(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation; every design brings its cognates."""
    result = _solved(problem, progress) if problem.mechanisms is None else solve_types(problem, _solved, progress)
    designs = [with_cognates(design) for design in result.designs]
    return result.model_copy(
        update={"designs": designs, "summary": f"{result.summary}{told_of_stance(designs, problem)}"}
    )


def _solved(problem: PathProblem, progress: Progress) -> PathResult:
    """Dispatch a problem with one mechanism type to its solver."""
    if problem.mechanism != "fourbar":
        if problem.fitted:
            return solve_other(problem, progress)
        return exact_or_fitted(problem, progress, solve_other, solve_other)
    if problem.matched:
        return curve_match.solve_curve_match(problem, progress)
    if problem.fitted:
        return fit_points(problem, progress)
    return exact_or_fitted(problem, progress, _solve_exactly, fit_points)


def _solve_exactly(problem: PathProblem, progress: Progress) -> PathResult:
    """Find fourbars that meet the points exactly."""
    if all_are_found(problem):
        return solve_given_pivots(problem, progress)
    if problem.prescribed:
        return solve_timed(problem, progress)
    if len(problem.points) < NINE:
        near = solve_family(problem, part_of(progress, 0.0, FIRST_PART))
        if near.search.accepted or bounded(problem):
            # Linkages through additional random points would hardly fit into a workspace; fits are led into it.
            progress(1.0, "verified")
            return near
        return _solve_nine(problem, part_of(progress, FIRST_PART, 1.0))
    return _solve_nine(problem, progress)


def _solve_nine(problem: PathProblem, progress: Progress) -> PathResult:
    """Find all fourbars through nine points, some of which are drawn if fewer are given."""
    rng = np.random.default_rng(problem.seed)
    given = np.array([point.point for point in problem.points])
    rounds = 1 if len(given) == NINE else problem.rounds
    harvest = Harvest(problem)
    computed: list[Triples] = []
    on_one_circuit = 0
    for n in range(rounds):

        def tell(share: float, n: int = n) -> None:
            tracked = f"{round(share * ORBITS)} of {ORBITS} paths followed"
            message = tracked if rounds == 1 else f"round {n + 1} of {rounds}: {tracked}"
            progress(0.95 * (n + share) / rounds, message)

        triples = all_triples(_nine(given, rng), rng, tell, THREADS)
        computed.append(triples)
        on_one_circuit += _gathered(harvest, triples)
    progress(1.0, "verified")
    complete = len(given) == NINE and computed[0].complete and not harvest.unproven
    counts = CognateTriples(
        rounds=rounds,
        computed=sum(len(triples.y) for triples in computed),
        real=sum(len(triples.real) for triples in computed),
        on_one_circuit=on_one_circuit,
        largest_residual=max(triples.largest_residual for triples in computed),
        closed_under_conjugation=all(triples.self_conjugate for triples in computed),
    )
    method = "nine_point_continuation" if len(given) == NINE else "nine_point_family"
    text = (
        f"{counts.computed} of {ORBITS * rounds} triples of cognate fourbars were computed; "
        f"{counted(counts.real, 'is real', 'are real')}, {on_one_circuit} of these "
        f"{agreeing(on_one_circuit, 'has', 'have')} all points on one circuit, and {grouped(harvest.accepted)} of "
        f"{counted(harvest.candidates, 'design')} {agreeing(harvest.accepted, 'satisfies', 'satisfy')} all "
        f"constraints.{harvest.reasons()}{harvest.proof(complete=complete)}"
    )
    result = harvest.result(method, complete=complete, summary=text)
    return result.model_copy(update={"triples": counts})


def warm_up() -> None:
    """Compile or load the kernels by refining a few solutions of the start; the paths of a whole problem would take a
    second."""
    curve_match.warm_up()
    sixbar_search.warm_up()
    begun = nine_point_start()
    y, low, _ = refine(nine_point_system_extended, GROUPS, SCRATCH, begun.y[:2], np.zeros_like(begun.y[:2]), begun.p)
    follow(nine_point_system, GROUPS, SCRATCH, y, begun.p, begun.p, np.zeros_like(begun.p))
    orbit_keys(y, begun.p, low)
    warm_up_fits()


def _nine(given: Complex, rng: np.random.Generator) -> Complex:
    """Return nine points: the given ones in their places, and others drawn near a smooth curve through them."""
    missing = NINE - len(given)
    if missing == 0:
        return given
    chords = np.abs(np.diff(given))
    along = np.concatenate([[0.0], np.cumsum(chords)])
    curve = CubicSpline(along, given)
    between = rng.choice(len(chords), missing, p=chords / chords.sum())
    # Away from the given points: nearly equal points make the system nearly singular.
    drawn = along[between] + chords[between] * rng.uniform(0.15, 0.85, missing)
    off = OFF_CURVE * chords.mean() * (rng.normal(size=(missing, 2)) @ np.array([1.0, 1.0j]))
    return np.concatenate([given, np.asarray(curve(drawn)) + off])


def _gathered(harvest: Harvest, triples: Triples) -> int:
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
