"""The best machine-tool gearboxes: for every structure the tooth numbers of least deviation for their size."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from kinematics.gear.gearbox import preferred_numbers
from synthesis.designs.base import Search
from synthesis.designs.gearbox import (
    GearboxDesign,
    GearboxMechanism,
    GearboxResult,
    GearboxStage,
    GearPairTeeth,
    StructureVerdict,
)
from synthesis.gearbox.stages import Choice, Options, StageLimits, best_choices, stage_options, together
from synthesis.gearbox.structures import Group, Structure, formula, spread, structures
from synthesis.gearbox.verification import measure, verify
from synthesis.kinds import Progress
from synthesis.problems.gearbox import GearboxProblem

FIXED = Group(1, 1)
"""A stage of one pair."""


class _Made(NamedTuple):
    """A structure with its teeth, and what it is ranked by."""

    error: float
    size: int
    torque: float
    structure: Structure
    stages: tuple[tuple[int, tuple[int, ...]], ...]


def solve_gearbox(problem: GearboxProblem, progress: Progress) -> GearboxResult:
    """The Pareto set of deviation against tooth sum over all structures, each gearbox verified.

    Parameters
    ----------
    problem : GearboxProblem
        A statement without contradictions.
    progress : callable
        Told how many structures are done.

    Returns
    -------
    GearboxResult
        Always complete: no gearbox within the limits has a smaller deviation at the same tooth sum.
    """
    tried = _structures(problem)
    ratio = problem.speeds.progression_ratio
    kinds = {tuple(sorted(structure)): structure for structure in tried}
    covered, choices = 0, {}
    for k, groups in enumerate(kinds):
        progress(k / len(kinds), f"structure {formula(kinds[groups])}")
        choices[groups], count = _choices(problem, groups, ratio)
        covered += count
    made = []
    for groups, found in choices.items():
        orders = [structure for structure in tried if tuple(sorted(structure)) == groups]
        made += [_ordered(choice, groups, orders) for choice in found]
    made.sort(key=lambda m: (m.error, m.size, m.torque) if problem.rank_by == "error" else (m.size, m.error, m.torque))
    designs = [_design(problem, one) for one in made[: problem.max_designs]]
    passed = [design for design in designs if design.verification.passed]
    failed = [design for design in designs if not design.verification.passed]
    rejected = {"outranked": covered - len(designs), "verification": len(failed)}
    progress(1.0, "done")
    return GearboxResult(
        designs=[*passed, *failed] if problem.include_failed else passed,
        search=Search(
            method="exhaustive",
            complete=not failed,
            candidates=covered,
            accepted=len(passed),
            rejected={reason: count for reason, count in rejected.items() if count},
            seed=problem.seed,
        ),
        summary=_summary(problem, tried, passed, covered),
        progression_ratio=ratio,
        structures=[_verdict(structure, choices[tuple(sorted(structure))]) for structure in tried],
    )


def _structures(problem: GearboxProblem) -> list[Structure]:
    if problem.structure is None:
        found = structures(problem.speeds.count, problem.max_pairs)
        return [(FIXED, *structure) for structure in found] if problem.fixed_stage else found
    stated = [pairs for pairs in problem.structure if pairs > 1]
    found = []
    for order in itertools.permutations(range(len(stated))):
        characteristic, groups = 1, {}
        for at in order:
            groups[at] = Group(stated[at], characteristic)
            characteristic *= stated[at]
        several = iter([groups[at] for at in range(len(stated))])
        found.append(tuple(FIXED if pairs == 1 else next(several) for pairs in problem.structure))
    return found


def _limits(problem: GearboxProblem) -> StageLimits:
    return StageLimits(
        (problem.teeth.min, problem.teeth.max),
        (problem.tooth_sum.min, problem.tooth_sum.max),
        (problem.stage_ratio.min, problem.stage_ratio.max),
        math.radians(problem.pressure_angle),
        problem.cluster_difference,
    )


def _choices(problem: GearboxProblem, groups: tuple[Group, ...], ratio: float) -> tuple[list[Choice], int]:
    """Pareto choices of teeth for stages in the order of ``groups``, and how many combinations they stand for."""
    limits = _limits(problem)
    widest = problem.stage_ratio.max / problem.stage_ratio.min * math.exp(2.0 * problem.widest)
    if any(spread(group, ratio) > widest for group in groups):
        return [], 0
    known: dict[Group, Options] = {}
    for group in groups:
        if group not in known:
            known[group] = stage_options(group, ratio, problem.widest, limits)
    stages = [known[group] for group in groups]
    covered = math.prod(stage.covered for stage in stages)
    half = (len(stages) + 1) // 2
    first, second = _joined(stages[:half], problem.widest), _joined(stages[half:], problem.widest)
    if not first.count or not second.count:
        return [], covered
    level = math.log(problem.speeds.min / problem.input_speed)
    found = best_choices(first, second, level)
    return [choice for choice in found if choice.error <= problem.widest * (1.0 + 1e-12)], covered


def _joined(stages: list[Options], widest: float) -> Options:
    if not stages:
        zero = np.zeros(1)
        return Options(zero, zero, np.zeros(1, np.int64), np.zeros((1, 0), np.int64), (), 1)
    joined = stages[0]
    for stage in stages[1:]:
        joined = together(joined, stage, widest)
    return joined


def _ordered(choice: Choice, groups: tuple[Group, ...], orders: Iterable[Structure]) -> _Made:
    """The order of the stages that loads the shafts between input and spindle least, of those that are allowed."""
    found = []
    for structure in orders:
        rest = list(zip(groups, choice.stages, strict=True))
        # Equal groups may have different teeth; the faster one stands nearer to the input.
        rest.sort(key=lambda item: -min(item[1][1]) / item[1][0])
        placed = []
        for group in structure:
            at = next(k for k, (own, _) in enumerate(rest) if own == group)
            placed.append(rest.pop(at)[1])
        speed, torque = 1.0, 0.0
        for total, drivers in placed[:-1]:
            speed *= min(drivers) / (total - min(drivers))
            torque += 1.0 / speed
        found.append(_Made(choice.error, choice.size, torque, structure, tuple(placed)))
    return min(found, key=lambda made: made.torque)


def _design(problem: GearboxProblem, made: _Made) -> GearboxDesign:
    stages = []
    for group, (total, drivers) in zip(made.structure, made.stages, strict=True):
        pairs = [GearPairTeeth(driver=z, driven=total - z) for z in drivers]
        distance = 0.5 * problem.module * total
        stages.append(GearboxStage(characteristic=group.characteristic, pairs=pairs, centre_distance=distance))
    mechanism = GearboxMechanism(
        formula=formula(made.structure),
        input_speed=problem.input_speed,
        stages=stages,
        module=problem.module,
        pressure_angle=problem.pressure_angle,
    )
    series = problem.speeds.series
    standard = (
        None
        if series is None
        else preferred_numbers(series, problem.speeds.min, problem.speeds.count, problem.speeds.step)
    )
    return GearboxDesign(
        mechanism=mechanism, verification=verify(problem, mechanism), metrics=measure(problem, mechanism, standard)
    )


def _verdict(structure: Structure, found: list[Choice]) -> StructureVerdict:
    best = found[-1] if found else None
    return StructureVerdict(
        formula=formula(structure), max_error=best.error if best else None, tooth_sum=best.size if best else None
    )


def _summary(problem: GearboxProblem, tried: list[Structure], passed: list[GearboxDesign], covered: int) -> str:
    count = problem.speeds.count
    if not tried:
        return f"{count} speeds cannot be made by stages of 2 to {problem.max_pairs} pairs."
    if not passed:
        return (
            f"None of {len(tried)} structures with {covered:,} combinations of tooth numbers keeps all {count} speeds "
            f"within {100.0 * problem.widest:.3g} % and the limits."
        )
    first = passed[0]
    return (
        f"{first.mechanism.formula} keeps {count} speeds within {100.0 * first.metrics.max_error:.3g} %, the best of "
        f"{len(tried)} structures with {covered:,} combinations of tooth numbers."
    )
