"""Fourbars through nine points; if fewer are given, the others are drawn near a smooth curve through them.

A real cognate triple yields six designs: three linkages, each with either fixed pivot as the input's. Every one of them
is verified, and the reasons for rejections are counted.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from kinematics.arrays import Complex
from kinematics.message import compose
from synthesis.kinds.path.design import CognateTriples, PathResult
from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start
from synthesis.kinds.path.exact.nine_point_system import (
    NINE_POINT_SYSTEM,
    ORBIT_COUNT,
    PRECISE_NINE_POINT_SYSTEM,
    compute_orbit_keys,
)
from synthesis.kinds.path.exact.nine_points import TripleSolutions, compute_triples
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import PathCandidateLog, join_sentences
from synthesis.model.kind import Progress
from synthesis.model.linkage.conversion import FourbarConfiguration
from synthesis.numerics.continuation import ParameterPath, follow, refine

POINT_COUNT = 9

THREAD_COUNT = 2
"""Number of paths followed in parallel. The kernels release the interpreter lock, and most machines have a second
core."""

CURVE_OFFSET_RATIO = 0.03
"""Distance of drawn points from the smooth curve, as a share of the points' mean distance; it makes rounds differ."""


def solve_nine_points(problem: PathProblem, progress: Progress) -> PathResult:
    """Find all fourbars through nine points, some of which are drawn if fewer are given."""
    rng = np.random.default_rng(problem.seed)
    given = np.array([point.point for point in problem.points])
    rounds = 1 if len(given) == POINT_COUNT else problem.rounds
    harvest = PathCandidateLog(problem)
    computed: list[TripleSolutions] = []
    on_one_circuit = 0
    for n in range(rounds):

        def report_paths(share: float, n: int = n) -> None:
            message = compose("path-paths-followed", done=round(share * ORBIT_COUNT), count=ORBIT_COUNT)
            if rounds > 1:
                message = compose("path-round", round=n + 1, rounds=rounds, progress=message)
            progress(0.95 * (n + share) / rounds, message)

        triples = compute_triples(_complete_to_nine(given, rng), rng, report_paths, THREAD_COUNT)
        computed.append(triples)
        on_one_circuit += _verify_triples(harvest, triples)
    progress(1.0, compose("path-verified"))
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
    text = compose(
        "path-triples-computed",
        computed=counts.computed,
        count=ORBIT_COUNT * rounds,
        real=counts.real,
        on_one_circuit=on_one_circuit,
        passed=harvest.accepted,
        designs=harvest.candidates,
    )
    summary = join_sentences([text, harvest.describe_reasons(), harvest.describe_completeness(complete=complete)])
    result = harvest.build_result(method, complete=complete, summary=summary)
    return result.model_copy(update={"triples": counts})


def warm_up() -> None:
    """Compile or load the kernels by refining a few solutions of the start.

    Following the paths of a whole problem would take a second.
    """
    begun = load_nine_point_start()
    y, low, _ = refine(
        PRECISE_NINE_POINT_SYSTEM,
        begun.y[:2],
        np.zeros_like(begun.y[:2]),
        begun.p,
    )
    follow(NINE_POINT_SYSTEM, y, ParameterPath(begun.p, begun.p, np.zeros_like(begun.p)))
    compute_orbit_keys(y, begun.p, low)


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
