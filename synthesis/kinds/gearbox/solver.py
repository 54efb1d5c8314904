"""The best machine-tool gearboxes: for every structure the tooth numbers of minimum deviation for their size."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable
from functools import partial
from typing import NamedTuple

from kinematics.gear.gearbox import list_preferred_numbers
from kinematics.message import compose, join_messages
from synthesis.kinds.gearbox.design import (
    GearboxDesign,
    GearboxMechanism,
    GearboxResult,
    GearboxStage,
    StructureVerdict,
)
from synthesis.kinds.gearbox.front import Choice, find_best_choices
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.gearbox.stages import Options, StageLimits, list_stage_options
from synthesis.kinds.gearbox.structures import Group, Structure, compute_spread, format_formula, list_structures
from synthesis.kinds.gearbox.verification import measure, verify
from synthesis.model.gears.answer import GearPairTeeth
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog

FIXED_STAGE = Group(1, 1)
"""A stage of one pair."""


class _StructureTeeth(NamedTuple):
    """A structure with its teeth and its ranking criteria."""

    error: float
    size: int
    torque: float
    structure: Structure
    stages: tuple[tuple[int, tuple[int, ...]], ...]


def solve_gearbox(problem: GearboxProblem, progress: Progress) -> GearboxResult:
    """Find the Pareto set of deviation against tooth sum over all structures, each gearbox verified.

    Parameters
    ----------
    problem : GearboxProblem
        A problem without contradictions.
    progress : callable
        Receives the share of structures that are done.

    Returns
    -------
    GearboxResult
        Complete if no gearbox within the limits has a smaller deviation at the same tooth sum: unless the problem
        permits gearboxes without a structural formula.
    """
    tried = _list_structures(problem)
    ratio = problem.speeds.progression_ratio
    # The teeth do not depend on the order of the stages: structures with equal groups share one search.
    kinds = {tuple(sorted(structure)): structure for structure in tried}
    covered, choices = 0, {}
    for k, groups in enumerate(kinds):
        label = compose("gearbox-searching-structure", formula=format_formula(kinds[groups]))

        def report_share(share: float, done: int = k, message: str = label) -> None:
            progress((done + share) / len(kinds), message)

        choices[groups], count = _find_choices(problem, groups, ratio, report_share)
        covered += count
    gearboxes = []
    for groups, front in choices.items():
        orders = [structure for structure in tried if tuple(sorted(structure)) == groups]
        gearboxes += [_order_stages(choice, groups, orders) for choice in front]
    gearboxes.sort(
        key=lambda m: (m.error, m.size, m.torque) if problem.rank_by == "error" else (m.size, m.error, m.torque)
    )
    unsearched = _describe_unsearched(problem, tried)
    sifting = CandidateLog[GearboxDesign](problem)
    sifting.verify_best(gearboxes[: problem.max_designs], covered, partial(_build_design, problem))
    progress(1.0, compose("gearbox-done"))
    return GearboxResult(
        designs=sifting.select_designs(list),
        search=sifting.build_search("exhaustive", complete=not unsearched and not sifting.failed),
        summary=join_messages([_write_summary(problem, tried, sifting.passed, covered), unsearched]),
        progression_ratio=ratio,
        structures=[_build_verdict(structure, choices[tuple(sorted(structure))]) for structure in tried],
    )


def _list_structures(problem: GearboxProblem) -> list[Structure]:
    """List the structures to search: all of them, or those with the given pairs in the given order."""
    if problem.structure is None:
        candidates = list_structures(problem.speeds.count, problem.max_pairs)
        return [(FIXED_STAGE, *structure) for structure in candidates] if problem.fixed_stage else candidates
    stated = [pairs for pairs in problem.structure if pairs > 1]
    candidates = []
    for order in itertools.permutations(range(len(stated))):
        characteristic, groups = 1, {}
        for at in order:
            groups[at] = Group(stated[at], characteristic)
            characteristic *= stated[at]
        # Fixed stages keep their given places between the others.
        several = iter([groups[at] for at in range(len(stated))])
        candidates.append(tuple(FIXED_STAGE if pairs == 1 else next(several) for pairs in problem.structure))
    return candidates


def _build_limits(problem: GearboxProblem) -> StageLimits:
    """Build the limits on the teeth of a stage."""
    return StageLimits(
        (problem.teeth.min, problem.teeth.max),
        (problem.tooth_sum.min, problem.tooth_sum.max),
        (problem.stage_ratio.min, problem.stage_ratio.max),
        math.radians(problem.pressure_angle),
        problem.cluster_difference,
    )


def _find_choices(
    problem: GearboxProblem, groups: tuple[Group, ...], ratio: float, progress: Callable[[float], None]
) -> tuple[list[Choice], int]:
    """Find Pareto choices of teeth for stages in the order of ``groups``, and the number of combinations covered."""
    progress(0.0)
    limits = _build_limits(problem)
    widest = problem.stage_ratio.max / problem.stage_ratio.min * math.exp(2.0 * problem.widest)
    # The ratios of a stage spread more than the stage ratio limits permit: no teeth can serve.
    if any(compute_spread(group, ratio) > widest for group in groups):
        return [], 0
    known: dict[Group, Options] = {}
    for group in groups:
        if group not in known:
            known[group] = list_stage_options(group, ratio, problem.widest, limits)
    stages = [known[group] for group in groups]
    # L: the lowest speed relative to the input, the target of the summed middles.
    level = math.log(problem.speeds.min / problem.input_speed)
    front = find_best_choices(stages, level, problem.widest, progress)
    return front, math.prod(stage.covered for stage in stages)


def _order_stages(choice: Choice, groups: tuple[Group, ...], orders: Iterable[Structure]) -> _StructureTeeth:
    """Choose, among the permitted orders of the stages, the one that loads the intermediate shafts least."""
    gearboxes = []
    for structure in orders:
        rest = list(zip(groups, choice.stages, strict=True))
        # Equal groups may have different teeth; the faster one is placed nearer to the input.
        rest.sort(key=lambda item: -min(item[1][1]) / item[1][0])
        placed = []
        for group in structure:
            at = next(k for k, (own, _) in enumerate(rest) if own == group)
            placed.append(rest.pop(at)[1])
        speed, torque = 1.0, 0.0
        for total, drivers in placed[:-1]:
            speed *= min(drivers) / (total - min(drivers))
            torque += 1.0 / speed
        gearboxes.append(_StructureTeeth(choice.error, choice.size, torque, structure, tuple(placed)))
    return min(gearboxes, key=lambda gearbox: gearbox.torque)


def _build_design(problem: GearboxProblem, gearbox: _StructureTeeth) -> GearboxDesign:
    """Build a gearbox of the front as a verified design."""
    stages = []
    for group, (total, drivers) in zip(gearbox.structure, gearbox.stages, strict=True):
        pairs = [GearPairTeeth(driver=z, driven=total - z) for z in drivers]
        distance = 0.5 * problem.module * total
        stages.append(GearboxStage(characteristic=group.characteristic, pairs=pairs, centre_distance=distance))
    mechanism = GearboxMechanism(
        formula=format_formula(gearbox.structure),
        input_speed=problem.input_speed,
        stages=stages,
        module=problem.module,
        pressure_angle=problem.pressure_angle,
    )
    series = problem.speeds.series
    standard = (
        None
        if series is None
        else list_preferred_numbers(series, problem.speeds.min, problem.speeds.count, problem.speeds.step)
    )
    return GearboxDesign(
        mechanism=mechanism, verification=verify(problem, mechanism), metrics=measure(problem, mechanism, standard)
    )


def _build_verdict(structure: Structure, front: list[Choice]) -> StructureVerdict:
    best = front[-1] if front else None
    return StructureVerdict(
        formula=format_formula(structure), max_error=best.error if best else None, tooth_sum=best.size if best else None
    )


def _describe_unsearched(problem: GearboxProblem, tried: list[Structure]) -> str:
    """Describe the gearboxes without a structural formula that were not searched; empty if there are none.

    In a gearbox of several stages a stage with a prime number of pairs has one characteristic. One of 4 or 6 may have
    two: {0, 1, 4, 5} with {0, 2} makes the steps 0 to 7 too (de Bruijn, On number systems, Nieuw Arch. Wisk. 4, 1956).
    """
    if problem.widest > problem.structure_tolerance:
        return compose("gearbox-unstructured-not-searched")
    several = [[group.pairs for group in structure if group.pairs > 1] for structure in tried]
    if any(len(pairs) > 1 and max(pairs) > 3 for pairs in several):
        return compose("gearbox-split-stages-not-searched")
    return ""


def _write_summary(problem: GearboxProblem, tried: list[Structure], passed: list[GearboxDesign], covered: int) -> str:
    """Write the coverage of the search and the best gearbox in one sentence."""
    count = problem.speeds.count
    if not tried:
        return compose("gearbox-speeds-not-factorable", count=count, pairs=problem.max_pairs)
    searched = {
        "structures": compose("gearbox-structures", count=len(tried)),
        "combinations": compose("gearbox-combinations", count=covered),
    }
    if not passed:
        return compose("gearbox-none-found", count=count, tolerance=f"{100.0 * problem.widest:.3g}", **searched)
    first = passed[0]
    formula, error = first.mechanism.formula, first.metrics.max_error
    if not error:
        return compose("gearbox-best-exact", formula=formula, count=count, **searched)
    return compose("gearbox-best-within", formula=formula, count=count, error=f"{100.0 * error:.3g}", **searched)
