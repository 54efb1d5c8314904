"""Ordinary gear trains: the search, the idlers, and the verification of the designs."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cmp_to_key

from kinematics.message import compose, join_messages
from synthesis.kinds.gear_train.construction.power_capacity import StrengthResult, find_carrying_trains
from synthesis.kinds.gear_train.construction.train import build_mechanism, build_stages, compute_sign
from synthesis.kinds.gear_train.design import (
    GearTrainDesign,
    GearTrainResult,
    GearTrainSearch,
    Idler,
    ParetoTrain,
    Stage,
)
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gear_train.search.search import Outcome, Train, order_trains, search
from synthesis.kinds.gear_train.search.task import Task, build_task
from synthesis.kinds.gear_train.statement.stages import GEARS
from synthesis.kinds.gear_train.statement.train import DEFAULT_TOLERANCE
from synthesis.kinds.gear_train.verification import verify
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.strength import describe_power_rejections, describe_too_weak
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.remarks import list_with_and

MAX_EQUAL_TRAINS = 1000
"""Number of trains, the nearest first, among which those without undercut teeth are sought if the first has some."""

SEARCH_NOTE = "gear_train-distances-in-steps"
"""Message on a search that proves nothing, because the distances that a mesh can have were searched in steps."""


def solve_gear_train(problem: GearTrainProblem, progress: Progress) -> GearTrainResult:
    """Find the best gear trains for a ratio, proven by an exhaustive search."""
    progress(0.0, compose("gear_train-listing-gears"))
    task = build_task(problem, coprime=problem.hunting_tooth == "require")
    sifting = CandidateLog[GearTrainDesign](problem, undriven="gears")
    borne: StrengthResult | None = None
    if problem.strength is None:
        outcome = _rank_trains(problem, task, problem.max_designs, progress)
        made = [build_mechanism(problem, task, train) for train in outcome.trains]
    else:
        borne, outcome = find_carrying_trains(
            problem, task, problem.strength, lambda n: _rank_trains(problem, task, n, progress)
        )
        made = [one.mechanism for one in borne.borne]
    for mechanism in made:
        sifting.record_candidate("idler" if mechanism is None else verify(problem, mechanism))
    # A rejected candidate could hide a better design than those returned.
    complete = not sifting.rejected and not problem.searches_distances
    if borne is not None:
        sifting.reject("strength", borne.failed)
        complete = complete and (borne.every or len(made) == problem.max_designs)
    progress(1.0, compose("gear_train-verified"))
    return GearTrainResult(
        designs=sifting.select_designs(list),
        search=GearTrainSearch(
            **dict(sifting.build_search("exhaustive", complete=complete)),
            combinations=outcome.combinations,
            ties=outcome.ties,
            least_error=_find_least_error(task, outcome),
            judged=None if borne is None else borne.judged,
            every_judged=None if borne is None else borne.every,
        ),
        summary=_write_summary(problem, task, outcome, sifting.passed, borne),
        pareto=_list_front(problem, task, outcome) if borne is None else _list_carrying_front(problem, task, borne),
    )


def _list_front(problem: GearTrainProblem, task: Task, outcome: Outcome) -> list[ParetoTrain]:
    return [
        _build_pareto_train(
            task,
            train,
            build_stages(problem, task, train),
            Ratio.from_fraction(train.ratio * compute_sign(problem, len(train.drivers))),
        )
        for train in outcome.pareto
    ]


def _list_carrying_front(problem: GearTrainProblem, task: Task, borne: StrengthResult) -> list[ParetoTrain]:
    """Build the Pareto set of the trains that carry the power, in the form that carries it."""
    return [
        _build_pareto_train(task, one.train, one.mechanism.stages, one.mechanism.ratio, one.mechanism.idlers)
        for one in borne.front
    ]


def _build_pareto_train(
    task: Task, train: Train, stages: list[Stage], ratio: Ratio, idlers: list[Idler] | None = None
) -> ParetoTrain:
    return ParetoTrain(
        size=train.size(task.largest),
        relative_error=task.target.compute_relative_error(train.ratio),
        stages=stages,
        ratio=ratio,
        idlers=idlers or None,
    )


def _rank_trains(problem: GearTrainProblem, task: Task, wanted: int, progress: Progress) -> Outcome:
    """Return the best trains of the search; of equally near ones those without undercut teeth come first."""
    outcome = _search_trains(problem, task, wanted, progress)
    spur = all(stage.type == "external" for stage in problem.stages or [])
    # Shifted teeth are fitted without undercut, other types of gears have their own limits, and sizes were requested.
    if task.by_size or problem.is_fitted or not spur or not outcome.trains:
        return outcome
    near = cmp_to_key(task.target.compare_distances)
    first = near(outcome.trains[0].ratio)
    equal = [train for train in outcome.trains if near(train.ratio) == first]
    trains = outcome.trains
    if outcome.ties > len(equal) and any(_is_undercut(problem, train) for train in equal):
        # Larger trains of the same error may have no undercut teeth.
        more = search(task, problem.exact_tolerance or DEFAULT_TOLERANCE, MAX_EQUAL_TRAINS, progress).trains
        sound = [train for train in more if near(train.ratio) == first and not _is_undercut(problem, train)]
        trains = [*trains, *(train for train in sound if train not in trains)]
    # Sorting is stable: trains of one error without undercut teeth keep their order.
    ordered = sorted(trains, key=lambda train: (near(train.ratio), _is_undercut(problem, train)))
    return outcome._replace(trains=ordered[:wanted])


def _is_undercut(problem: GearTrainProblem, train: Train) -> bool:
    """Return whether the rack that cuts a gear of a train removes part of its flanks."""
    return min(train.drivers + train.driven) < problem.fewest_teeth


def _search_trains(problem: GearTrainProblem, task: Task, wanted: int, progress: Progress) -> Outcome:
    """Return the best trains of the search; among equals those with hunting teeth come first if preferred."""
    outcome = search(task, problem.exact_tolerance, wanted, progress)
    if problem.hunting_tooth != "prefer" or not outcome.trains:
        return outcome
    progress(0.0, compose("gear_train-searching-hunting-teeth"))
    hunting = search(build_task(problem, coprime=True), problem.exact_tolerance, wanted, progress)
    # Of two pairings of the same gears, the one with hunting teeth represents both.
    met = {_describe_gears(task, train) for train in hunting.trains}
    trains = [train for train in outcome.trains if _describe_gears(task, train) not in met]
    return outcome._replace(trains=order_trains(task, [*trains, *hunting.trains], set(hunting.trains))[:wanted])


def _describe_gears(task: Task, train: Train) -> tuple[object, ...]:
    """Return a train's identity: its meshes if the pairing is part of it, else its drivers and driven gears."""
    alike = task.likeness[: len(train.drivers)]
    if task.reverted:
        return tuple(sorted(zip(*train, alike, strict=True)))
    return tuple(tuple(sorted(zip(alike, gears, strict=True))) for gears in (train.drivers, train.driven))


def _find_least_error(task: Task, outcome: Outcome) -> float | None:
    trains = [*outcome.trains, *outcome.pareto, *([outcome.nearest] if outcome.nearest else [])]
    return min((abs(task.target.compute_relative_error(train.ratio)) for train in trains), default=None)


def _write_summary(
    problem: GearTrainProblem,
    task: Task,
    outcome: Outcome,
    accepted: list[GearTrainDesign],
    borne: StrengthResult | None,
) -> str:
    """Write one or two sentences: the result, or the reason why there is none."""
    if accepted:
        sentences = [
            _describe_best(problem, task, outcome.ties, accepted[0]),
            _describe_undercut(accepted[0]),
            "" if borne is None else describe_power_rejections(borne.failed),
            _describe_scope(problem, outcome.combinations),
        ]
        return join_messages(sentences)
    if outcome.trains:
        return compose("gear_train-none-verified")
    if borne is not None and borne.failed and problem.strength is not None:
        return describe_too_weak(problem.strength, borne.failed, borne.every, borne.strongest)
    if problem.searches_distances:
        none = compose("gear_train-none-found", reason=_explain_none(problem, task, outcome))
        return join_messages([none, compose(SEARCH_NOTE)])
    return compose("gear_train-none-exists", reason=_explain_none(problem, task, outcome))


def _describe_best(problem: GearTrainProblem, task: Task, ties: int, best: GearTrainDesign) -> str:
    """Describe the best train in a sentence, with the number of equally exact ones if all of them were compared."""
    meshes = _format_meshes((stage.driver, stage.driven) for stage in best.mechanism.stages)
    error = f"{best.metrics.relative_error:.3g}"
    if task.by_size:
        within = 100.0 * float(problem.exact_tolerance or 0)
        return compose("gear_train-best-smallest", meshes=meshes, tolerance=f"{within:.3g}", error=error)
    exact = best.metrics.relative_error == 0.0
    if problem.strength is not None:
        if exact:
            return compose("gear_train-best-exact", meshes=meshes)
        return compose("gear_train-best-nearest", meshes=meshes, error=error)
    if exact:
        return compose("gear_train-best-exact-of-ties", meshes=meshes, ties=ties)
    return compose("gear_train-best-nearest-of-ties", meshes=meshes, error=error, ties=ties)


def _describe_undercut(best: GearTrainDesign) -> str:
    """Name the undercut gears of the best train in a sentence; empty if there are none, or if teeth are shifted."""
    teeth = sorted({min(mesh.driver, mesh.driven) for mesh in best.metrics.meshes if mesh.undercut})
    if not teeth:
        return ""
    return compose("gear_train-first-is-undercut", teeth=list_with_and([str(one) for one in teeth]))


def _format_meshes(meshes: Iterable[tuple[int, int]]) -> str:
    """Format the tooth numbers of meshes.

    >>> _format_meshes([(20, 43), (17, 58)])
    '20:43, 17:58'
    """
    return ", ".join(f"{driver}:{driven}" for driver, driven in meshes)


def _describe_scope(problem: GearTrainProblem, count: int) -> str:
    """Describe the scope of the answer: the trains among which it is the best, and whether that is proven."""
    if problem.searches_distances:
        return join_messages([compose("gear_train-best-of-searched", count=count), compose(SEARCH_NOTE)])
    own = any(stage.limits(name) is not None for stage in problem.stages or [] for name in GEARS)
    unchanged = own and problem.teeth is not None
    return compose("gear_train-proven-with-given-gears" if unchanged else "gear_train-proven", count=count)


def _explain_none(problem: GearTrainProblem, task: Task, outcome: Outcome) -> str:
    """Explain why the search is empty, as the end of a sentence."""
    if not task.stage_counts:
        if problem.reverted and problem.required_sign < 0 and problem.most_stages < 3:
            return compose("gear_train-two-stages-turn-same")
        if problem.stock is not None:
            return compose("gear_train-stock-too-small", count=sum(problem.count_stock().values()))
        return compose("gear_train-no-stage-count")
    if outcome.reach is None:
        return compose("gear_train-no-stage")
    low, high = outcome.reach
    if outcome.nearest is not None:
        error = task.target.compute_relative_error(outcome.nearest.ratio)
        meshes = _format_meshes(outcome.nearest.meshes)
        return compose("gear_train-nearest-too-far", meshes=meshes, error=f"{error:.3g}")
    if task.target.compare(high) > 0 or task.target.compare(low) < 0:
        return compose(
            "gear_train-ratio-unreachable",
            ratio=f"{float(task.target):.6g}",
            least=f"{float(low):.6g}",
            most=f"{float(high):.6g}",
            stages=max(task.stage_counts),
        )
    return compose("gear_train-no-combination")
