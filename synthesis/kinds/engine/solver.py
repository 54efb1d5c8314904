"""Piston engines: the given arrangement, or all that fire evenly, ranked by the shaking of the frame."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.engine.firing import list_firing_choices
from kinematics.engine.harmonics import compute_turning_parts, sum_torque
from kinematics.message import compose
from synthesis.kinds.engine.arrangement import Cylinders, arrange_cylinders, compute_middle
from synthesis.kinds.engine.design import EngineCylinder, EngineDesign, EngineMechanism, EngineResult
from synthesis.kinds.engine.enumeration import list_even_arrangements, list_requested_arrangements
from synthesis.kinds.engine.measures import measure_engine
from synthesis.kinds.engine.problem import EngineLayout, EngineProblem
from synthesis.kinds.engine.verification import verify_engine
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.remarks import append_remark, list_with_and, write_name

SCORE_DIGITS = 9
"""Decimals to which the ranking criteria of engines are compared."""

ANALYSED_FACTOR = 3
"""Number of analysed arrangements per requested design if a firing order is required, which many do not allow."""

EVEN_TOLERANCE = 1e-6
"""Maximum difference of the firing intervals, degrees, of an engine that fires evenly."""

BALANCE_TOLERANCE = 1e-9
"""Shaking force in units of m_B r ω², or moment per spacing of the throws, that counts as balanced: rounding."""


class _Candidate(NamedTuple):
    """An arrangement with its ranking criteria."""

    score: tuple[float, ...]
    place: int
    throws: tuple[float, ...]


def solve_engine(problem: EngineProblem, progress: Progress) -> EngineResult:
    """Solve a problem of piston engines.

    Returns
    -------
    EngineResult
        Complete if the throws are given, or if all arrangements were listed, as for up to eight throws.
    """
    sifting = CandidateLog[EngineDesign](problem)
    given = problem.layout.throws
    if given is not None:
        progress(0.1, compose("engine-analysing"))
        sifting.verify_candidates([_Candidate((), 0, tuple(given))], partial(_build_design, problem))
        progress(1.0, compose("results-verified"))
        return EngineResult(
            designs=sifting.select_designs(list),
            search=sifting.build_search("analysis", complete=not sifting.rejected),
            summary=append_remark(_describe_best(sifting), sifting.describe_reasons()),
            count=1,
        )
    candidates: list[_Candidate] = []
    counted, complete = 0, True
    for place, (_, layout) in enumerate(problem.layouts):
        progress(0.6 * place / len(problem.layouts), compose("engine-arranging-throws", number=place + 1))
        angles = problem.throw_angles
        found = (
            list_even_arrangements(problem, layout)
            if angles is None
            else list_requested_arrangements(problem, layout, angles)
        )
        counted, complete = counted + found.total, complete and found.complete
        candidates += _score_arrangements(problem, layout, place, found.phases)
    candidates.sort()
    progress(0.6, compose("engine-analysing-best"))
    # A required firing order rejects many: analyse more arrangements.
    wanted = problem.max_designs * (ANALYSED_FACTOR if problem.firing_order is not None else 1)
    sifting.verify_candidates(candidates[:wanted], partial(_build_design, problem), enough=problem.max_designs)
    verified = sifting.candidates
    sifting.reject("outranked", len(candidates) - verified)
    progress(1.0, compose("results-verified"))
    return EngineResult(
        designs=sifting.select_designs(list),
        search=sifting.build_search("exhaustive", complete=complete and not sifting.failed),
        summary=_write_summary(problem, sifting, counted, len(candidates)),
        count=counted,
    )


def _score_arrangements(
    problem: EngineProblem, layout: EngineLayout, place: int, phases: list[tuple[float, ...]]
) -> list[_Candidate]:
    """Score the arrangements of one layout, all at once."""
    if not phases:
        return []
    plain = arrange_cylinders(layout, problem.cylinders, phases[0])
    lag = np.array(phases)[:, plain.throw]
    axis, top = np.radians(plain.axis), np.radians(lag + plain.axis)
    places = plain.place - compute_middle(plain.place)
    force, moment = compute_turning_parts(1, axis, top), compute_turning_parts(1, axis, top, places)
    second, second_moment = compute_turning_parts(2, axis, top), compute_turning_parts(2, axis, top, places)
    torque = np.max([np.abs(sum_torque(k, top)) for k in (1, 2, 3)], axis=0)
    uneven = np.zeros(len(phases))
    if problem.throw_angles is not None:
        uneven = np.array([list_firing_choices(row, problem.stroke_cycle).unevenness for row in lag + plain.axis])
    columns = [
        uneven,
        np.abs(force.backward),
        np.abs(moment.backward),
        second.major,
        second_moment.major,
        torque,
        # Ties are broken in favour of smaller weights on the crankshaft.
        np.abs(force.forward),
        np.abs(moment.forward),
    ]
    # Round the scores, so that arrangements that are equal except for rounding stay in the order of their phases.
    scores = np.round(np.stack(columns, axis=1), SCORE_DIGITS) + 0.0
    return [_Candidate(tuple(row), place, throws) for row, throws in zip(scores.tolist(), phases, strict=True)]


def _build_design(problem: EngineProblem, candidate: _Candidate) -> EngineDesign:
    """Build an arrangement as a verified design."""
    layout = problem.layouts[candidate.place][1]
    cylinders = arrange_cylinders(layout, problem.cylinders, candidate.throws)
    mechanism = EngineMechanism(
        layout=layout.type,
        crank=problem.crank,
        rod=problem.rod_length,
        throws=list(candidate.throws),
        cylinders=_list_cylinders(cylinders),
    )
    design = measure_engine(problem, layout, mechanism, cylinders)
    return design.model_copy(update={"verification": verify_engine(problem, design)})


def _list_cylinders(cylinders: Cylinders) -> list[EngineCylinder]:
    columns = (column.tolist() for column in cylinders)
    return [
        EngineCylinder(number=n, throw=throw + 1, axis=axis, phase=phase, place=place)
        for n, (throw, axis, phase, place) in enumerate(zip(*columns, strict=True), 1)
    ]


def _describe_best(sifting: CandidateLog[EngineDesign]) -> str:
    """Describe the first design."""
    if not sifting.passed:
        return compose("engine-none-passed")
    best = sifting.passed[0]
    order, metrics = "-".join(map(str, best.firing.orders[0].order)), best.metrics
    if metrics.unevenness <= EVEN_TOLERANCE:
        fired = compose("engine-fires-evenly", layout=best.mechanism.layout, order=order)
    else:
        difference = f"{metrics.unevenness:.4g}"
        fired = compose("engine-fires-unevenly", layout=best.mechanism.layout, order=order, difference=difference)
    shaken = [
        write_name(name)
        for name in ("primary_force", "primary_moment", "secondary_force", "secondary_moment")
        if getattr(metrics, name) > BALANCE_TOLERANCE
    ]
    left = compose("engine-unbalanced", parts=list_with_and(shaken)) if shaken else compose("engine-balanced")
    return append_remark(fired, left)


def _write_summary(problem: EngineProblem, sifting: CandidateLog[EngineDesign], count: int, listed: int) -> str:
    if not count:
        return compose("engine-none-fires-evenly")
    if problem.throw_angles is not None:
        counted = "engine-arrangements" if listed == count else "engine-arrangements-compared"
    else:
        counted = "engine-even-arrangements" if listed == count else "engine-even-arrangements-compared"
    return append_remark(compose(counted, count=count, compared=listed), _describe_best(sifting))
