"""The best layshaft gearboxes: every tooth sum and head pair, with the nearest pair for every gear.

For a given tooth sum S and head pair a, b, the gears are independent. For pairs c, d = S − c, the ratio (b/a)(S − c)/c
falls with c, so that the nearest to a requested ratio t is one of the two integers c next to the real solution
S/(1 + t a/b). Reverse uses the nearest of all pairs that do not touch each other and leave space for an idler.
"""

from __future__ import annotations

import math
from fractions import Fraction
from functools import partial
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.gear.gearbox import compute_layshaft_ratios
from kinematics.message import compose
from synthesis.kinds.layshaft_gearbox.design import (
    LayshaftDesign,
    LayshaftGear,
    LayshaftMechanism,
    LayshaftResult,
    ParetoLayshaft,
    ReverseGear,
)
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.kinds.layshaft_gearbox.verification import CLEARANCE_TOLERANCE, measure, verify
from synthesis.model.gears.answer import GearPairTeeth, Ratio
from synthesis.model.gears.mesh_limits import has_no_external_interference
from synthesis.model.gears.ratio_target import parse_decimal
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.exhaustive import select_pareto, select_within_tolerance

ERROR_TOLERANCE = 1e-12
"""Difference of errors below which they are compared as exact fractions."""


class _Box(NamedTuple):
    """Teeth of a gearbox with its largest error, exact; None for direct drive, and without reverse."""

    error: Fraction
    size: int
    head: tuple[int, int]
    gears: tuple[tuple[int, int] | None, ...]
    reverse: tuple[int, int, int] | None


class _Level(NamedTuple):
    """The best of one tooth sum: largest error by head pair, with the layshaft teeth of every gear and of reverse."""

    heads: Integers
    error: Real
    layshaft: list[Integers | None]
    reverse: tuple[Integers, Integers, Integers] | None
    covered: int


def solve_layshaft_gearbox(problem: LayshaftProblem, progress: Progress) -> LayshaftResult:
    """Find the best layshaft gearboxes, each verified.

    Parameters
    ----------
    problem : LayshaftProblem
        A problem without contradictions.
    progress : callable
        Receives the share of tooth sums that are done.

    Returns
    -------
    LayshaftResult
        Always complete: every tooth sum, head pair and gear pair within the limits was covered.
    """
    boxes: list[_Box] = []
    best: list[_Box] = []
    covered = 0
    sums = range(problem.tooth_sum.min, problem.tooth_sum.max + 1)
    for k, size in enumerate(sums):
        progress(k / len(sums), compose("layshaft_gearbox-searching-tooth-sum", sum=size))
        level = _search_tooth_sum(problem, size)
        covered += level.covered
        own = _select_boxes(problem, size, level, problem.max_designs)
        boxes = sorted([*boxes, *own])[: problem.max_designs]
        best += own[:1]
    sifting = CandidateLog[LayshaftDesign](problem)
    ranked = boxes if problem.rank_by == "error" else best
    chosen = select_within_tolerance(ranked, problem.tolerance, problem.max_designs)
    sifting.verify_best(chosen, covered, partial(_build_design, problem))
    progress(1.0, compose("layshaft_gearbox-done"))
    return LayshaftResult(
        designs=sifting.select_designs(list),
        search=sifting.build_search("exhaustive", complete=not sifting.failed),
        summary=_write_summary(problem, sifting.passed, boxes, covered),
        pareto=[_build_pareto(box) for box in select_pareto(best, lambda box: box.error)],
    )


def _search_tooth_sum(problem: LayshaftProblem, size: int) -> _Level:
    """Find the best pair of every gear for each head pair of one tooth sum."""
    low, high = problem.teeth.min, problem.teeth.max
    # Both gears of a pair must be within the limits: c and S − c.
    own = np.arange(max(low, size - high), min(high, size - low) + 1)
    if problem.interference == "refuse" and len(own):
        angle = math.radians(problem.pressure_angle)
        own = own[has_no_external_interference(own.astype(np.float64), (size - own).astype(np.float64), angle)]
    backs = _list_reverse_pairs(problem, size) if problem.reverse is not None else None
    if not len(own) or (backs is not None and not len(backs[0])):
        return _Level(np.zeros(0, np.int64), np.zeros(0), [], None, 0)
    turned = (size - own) / own
    error = np.zeros(len(own))
    chosen: list[Integers | None] = []
    covered = len(own)
    for ratio in problem.ratios:
        if ratio == 1.0 and problem.direct:
            chosen.append(None)
            continue
        covered *= len(own)
        # The real solution lies between two tooth numbers: compare the errors of both.
        after = np.searchsorted(own, size / (1.0 + ratio / turned))
        near = [own[np.clip(after + step, 0, len(own) - 1)] for step in (-1, 0)]
        errors = [np.abs(turned * (size - c) / c / ratio - 1.0) for c in near]
        better = errors[1] < errors[0]
        chosen.append(np.where(better, near[1], near[0]))
        error = np.maximum(error, np.where(better, errors[1], errors[0]))
    reverse = None
    if backs is not None and problem.reverse is not None:
        covered *= len(backs[0])
        quotient = backs[2] / backs[0]
        after = np.searchsorted(quotient, problem.reverse / turned)
        places = [np.clip(after + step, 0, len(quotient) - 1) for step in (-1, 0)]
        errors = [np.abs(turned * quotient[at] / problem.reverse - 1.0) for at in places]
        at = np.where(errors[1] < errors[0], places[1], places[0])
        error = np.maximum(error, np.minimum(*errors))
        reverse = (backs[0][at], backs[1][at], backs[2][at])
    return _Level(own, error, chosen, reverse, covered)


def _list_reverse_pairs(problem: LayshaftProblem, size: int) -> tuple[Integers, Integers, Integers]:
    """List gears on layshaft and main shaft that clear each other, with the smallest sound idler that reaches both."""
    low, high = problem.teeth.min, problem.teeth.max
    counts = np.arange(low, high + 1)
    one, other = (side.reshape(-1) for side in np.meshgrid(counts, counts, indexing="ij"))
    # The idler must bridge the gap: half the sum of all three diameters is at least the distance.
    idler = np.maximum(low, -((one + other - size) // 2))
    # Tips extend one module beyond each pitch circle.
    kept = (0.5 * (size - one - other) - 2.0 >= CLEARANCE_TOLERANCE) & (idler <= high)
    one, idler, other = one[kept], idler[kept], other[kept]
    if problem.interference == "refuse":
        idler = _find_sound_idler(counts, one, idler, other, math.radians(problem.pressure_angle))
        kept = idler <= high
        one, idler, other = one[kept], idler[kept], other[kept]
    order = np.lexsort((one, other / one))
    return one[order], idler[order], other[order]


def _find_sound_idler(counts: Integers, one: Integers, idler: Integers, other: Integers, angle: float) -> Integers:
    """Return the smallest idler from ``idler`` on that interferes with neither gear; beyond the range if none exists.

    An idler can be too small for a large mate and too large for a small one. For each mate, the sound idlers lie
    between two limits, because the condition z₁ (4 − 2 z₂ sin² φ) ≤ z₂² sin² φ − 4, and the same with z₁ and z₂
    exchanged, are monotonic in z₂.
    """
    real = counts.astype(np.float64)
    # Table of all pairs of tooth numbers, evaluated once.
    sound = has_no_external_interference(real[:, None], real[None, :], angle)
    least = np.where(sound.any(axis=1), counts[sound.argmax(axis=1)], counts[-1] + 1)
    most = counts[-1] - sound[:, ::-1].argmax(axis=1)
    at, to = one - counts[0], other - counts[0]
    smallest = np.maximum(idler, np.maximum(least[at], least[to]))
    sound_one = smallest <= np.minimum(most[at], most[to])
    return np.asarray(np.where(sound_one, smallest, counts[-1] + 1), np.int64)


def _select_boxes(problem: LayshaftProblem, size: int, level: _Level, count: int) -> list[_Box]:
    """Select the best gearboxes of one tooth sum, one for each head pair."""
    if not len(level.heads):
        return []
    most = min(count, len(level.heads))
    # Candidates within rounding of the last place are compared exactly.
    limit = np.partition(level.error, most - 1)[most - 1]
    boxes = []
    for k in np.flatnonzero(level.error <= limit + ERROR_TOLERANCE).tolist():
        own = int(level.heads[k])
        gears = tuple(None if c is None else (int(c[k]), size - int(c[k])) for c in level.layshaft)
        reverse = None
        if level.reverse is not None:
            e, f, g = (int(side[k]) for side in level.reverse)
            reverse = (e, f, g)
        ratios = compute_layshaft_ratios((own, size - own), gears, reverse)
        demanded = [parse_decimal(ratio) for ratio in problem.ratios]
        errors = [abs(r / t - 1) for r, t in zip(ratios.forward, demanded, strict=True)]
        if ratios.reverse is not None and problem.reverse is not None:
            errors.append(abs(-ratios.reverse / parse_decimal(problem.reverse) - 1))
        boxes.append(_Box(max(errors), size, (own, size - own), gears, reverse))
    return sorted(boxes, key=lambda box: box[:3])[:count]


def _build_design(problem: LayshaftProblem, box: _Box) -> LayshaftDesign:
    """Build a choice of teeth as a verified design."""
    ratios = compute_layshaft_ratios(box.head, box.gears, box.reverse)
    reverse = None
    if box.reverse is not None and ratios.reverse is not None:
        e, f, g = box.reverse
        reverse = ReverseGear(layshaft=e, idler=f, mainshaft=g, ratio=Ratio.from_fraction(ratios.reverse))
    mechanism = LayshaftMechanism(
        head=GearPairTeeth(driver=box.head[0], driven=box.head[1]),
        gears=[
            LayshaftGear(
                layshaft=None if pair is None else pair[0],
                mainshaft=None if pair is None else pair[1],
                ratio=Ratio.from_fraction(ratio),
            )
            for pair, ratio in zip(box.gears, ratios.forward, strict=True)
        ],
        reverse=reverse,
        module=problem.module,
        pressure_angle=problem.pressure_angle,
        centre_distance=0.5 * problem.module * box.size,
    )
    return LayshaftDesign(
        mechanism=mechanism, verification=verify(problem, mechanism), metrics=measure(problem, mechanism)
    )


def _build_pareto(box: _Box) -> ParetoLayshaft:
    """Build a gearbox of the Pareto set as the answer reports it."""
    head = GearPairTeeth(driver=box.head[0], driven=box.head[1])
    return ParetoLayshaft(tooth_sum=box.size, max_error=float(box.error), head=head)


def _write_summary(problem: LayshaftProblem, passed: list[LayshaftDesign], boxes: list[_Box], covered: int) -> str:
    """Write the coverage of the search and the best gearbox in one sentence."""
    searched = compose("layshaft_gearbox-combinations-searched", count=covered)
    if passed:
        found = passed[0].metrics
        return compose(
            "layshaft_gearbox-best",
            sum=found.tooth_sum,
            count=len(found.errors),
            error=f"{100.0 * found.max_error:.3g}",
            searched=searched,
        )
    if not boxes:
        return compose("layshaft_gearbox-none-within-limits", searched=searched)
    nearest = f"{100.0 * float(boxes[0].error):.3g}"
    return compose("layshaft_gearbox-none-within-tolerance", error=nearest, searched=searched)
