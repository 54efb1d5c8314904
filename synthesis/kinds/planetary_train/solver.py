"""The best planetary trains for a ratio, over all arrangements and members that the problem leaves open.

Every planet set's sound tooth numbers are listed once; every choice of members then ranks the resulting trains. As
nothing is sampled, the answer is optimal, and an empty answer is a proof.
"""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction
from functools import partial

from kinematics.message import compose, join_messages
from synthesis.kinds.planetary_train.build import build_demands, build_mechanism
from synthesis.kinds.planetary_train.design import (
    ParetoPlanetaryTrain,
    PlanetaryDesign,
    PlanetaryMechanism,
    PlanetaryResult,
    PlanetarySearch,
)
from synthesis.kinds.planetary_train.efficiency import EfficientTrains, find_efficient_trains
from synthesis.kinds.planetary_train.nearest import (
    Candidate,
    NearestTrains,
    SetTable,
    compute_train_value,
    find_nearest,
)
from synthesis.kinds.planetary_train.power_capacity import (
    CarryingTrain,
    StrengthResult,
    TrainListing,
    find_carrying_trains,
)
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.tooth_numbers import ToothNumbers
from synthesis.kinds.planetary_train.verification import measure, verify
from synthesis.model.gears.answer import Ratio
from synthesis.model.gears.ratio_target import format_ratio
from synthesis.model.gears.strength import describe_power_rejections, describe_too_weak
from synthesis.model.kind import Progress
from synthesis.results.candidate_log import CandidateLog
from synthesis.results.exhaustive import select_pareto, select_within_tolerance


def solve_planetary_train(problem: PlanetaryProblem, progress: Progress) -> PlanetaryResult:
    """Find the best planetary trains for a ratio, each verified.

    Parameters
    ----------
    problem : PlanetaryProblem
        A problem without contradictions.
    progress : callable
        Receives the share of arrangements and choices of members that are done.

    Returns
    -------
    PlanetaryResult
        Always complete: every combination of tooth numbers within the limits was covered.
    """
    ranking, listing = _Ranking(problem), TrainListing(problem)
    rows = problem.arrangements
    for k, arrangement in enumerate(rows):
        progress(k / len(rows), compose("planetary_train-listing-teeth", arrangement=arrangement.name))
        numbers = [
            ToothNumbers(arrangement, planets, build_demands(problem, arrangement))
            for planets in arrangement.planet_sets
        ]
        # Only coupled sets need train values.
        coupled = len(numbers) > 1
        tables = [
            SetTable(each.teeth, each.size, compute_train_value(arrangement.name, planets).form if coupled else None)
            for each, planets in zip(numbers, arrangement.planet_sets, strict=True)
        ]
        roles = problem.list_roles(arrangement)
        for j, members in enumerate(roles):
            message = compose(
                "planetary_train-searching-members",
                arrangement=arrangement.name,
                input=members[0],
                output=members[1],
            )
            progress((k + j / len(roles)) / len(rows), message)
            ranking.record_nearest(
                numbers, find_nearest(arrangement, tables, members, problem.target, problem.max_designs)
            )
            listing.add(arrangement, tables, members)
    if problem.strength is not None:
        progress(1.0, compose("planetary_train-judging-strength"))
        return ranking.build_carrying_result(find_carrying_trains(problem, problem.strength, listing))
    progress(1.0, compose("planetary_train-done"))
    if problem.judges_efficiency:
        return ranking.build_efficient_result(find_efficient_trains(problem, listing))
    return ranking.build_result()


class _Ranking:
    """Accumulates the best trains over all arrangements and members."""

    def __init__(self, problem: PlanetaryProblem) -> None:
        self._problem = problem
        self._best: list[Candidate] = []
        self._by_size: dict[int, Candidate] = {}
        self._ties: Counter[Fraction] = Counter()
        self._sound = self._idle = 0
        self._sifting = CandidateLog[PlanetaryDesign](problem)

    def record_nearest(self, numbers: list[ToothNumbers], nearest: NearestTrains | None) -> None:
        """Record the best trains of one choice of members; None if a planet set does not affect its ratio."""
        if nearest is None:
            self._idle += 1
            return
        self._count(numbers)
        if nearest.best:
            self._ties[nearest.best[0].error] += nearest.ties
        self._best = sorted([*self._best, *nearest.best])[: self._problem.max_designs]
        for size, candidate in nearest.by_size.items():
            known = self._by_size.get(size)
            if known is None or candidate < known:
                self._by_size[size] = candidate

    def _count(self, numbers: list[ToothNumbers]) -> None:
        """Count the combinations of one choice of members: those of its planet sets with each other."""
        self._sound += math.prod(each.count for each in numbers)
        before, after = 1, math.prod(each.combinations for each in numbers)
        for each in numbers:
            after //= max(each.combinations, 1)
            for reason, fallen in each.rejected.items():
                # A combination rejected in one set stands for all its combinations with the other sets.
                self._sifting.reject(reason, before * fallen * after)
            before *= each.count

    def build_result(self) -> PlanetaryResult:
        """Build the verified answer."""
        problem = self._problem
        by_size = [self._by_size[size] for size in sorted(self._by_size)]
        ranked = self._best if problem.rank_by == "error" else by_size
        sifting = self._sifting
        best = select_within_tolerance(ranked, problem.tolerance, problem.max_designs)
        sifting.verify_best(
            [_build_mechanism(problem, one) for one in best], self._sound, partial(_build_design, problem)
        )
        front = select_pareto(by_size, lambda candidate: candidate.error)
        return PlanetaryResult(
            designs=sifting.select_designs(list),
            search=PlanetarySearch(**dict(sifting.build_search("exhaustive", complete=not sifting.failed))),
            summary=self._write_summary(self._ties[self._best[0].error] if self._best else 0),
            ties=self._ties[self._best[0].error] if self._best else 0,
            pareto=[
                _build_pareto(problem, candidate, candidate.size * problem.module)
                for candidate in front
                if _is_verified(problem, _build_mechanism(problem, candidate))
            ],
        )

    def build_efficient_result(self, found: EfficientTrains) -> PlanetaryResult:
        """Build the verified answer for trains that are judged by their efficiency."""
        problem, sifting = self._problem, self._sifting
        sifting.reject("efficiency", found.failed)
        made = [_build_mechanism(problem, one) for one in found.best]
        sifting.verify_best(made, self._sound - found.failed, partial(_build_design, problem))
        search = sifting.build_search("exhaustive", complete=found.proven and not sifting.failed)
        ties = sum(one.error == found.best[0].error for one in found.best)
        summary = self._write_summary(ties if problem.rank_by == "error" else 0)
        if found.failed and not found.best:
            summary = compose(
                "planetary_train-none-efficient" if found.every else "planetary_train-none-judged-efficient",
                count=found.judged,
                efficiency=f"{problem.min_efficiency:g}",
                greatest=f"{found.greatest:.4g}",
            )
        return PlanetaryResult(
            designs=sifting.select_designs(list),
            search=PlanetarySearch(**dict(search), judged=found.judged, every_judged=found.every),
            summary=summary,
            ties=ties,
            pareto=[
                _build_pareto(problem, one, one.size * problem.module)
                for one in select_pareto(sorted(found.best, key=lambda one: (one.size, one)), lambda one: one.error)
            ],
        )

    def build_carrying_result(self, borne: StrengthResult) -> PlanetaryResult:
        """Build the verified answer for a given power: the best of the trains that carry it."""
        problem, sifting = self._problem, self._sifting
        sifting.reject("strength", borne.failed)
        made = [one.mechanism for one in borne.best]
        sifting.verify_best(made, self._sound - borne.failed, partial(_build_design, problem))
        search = sifting.build_search("exhaustive", complete=borne.proven and not sifting.failed)
        remark = describe_power_rejections(borne.failed) if sifting.passed else ""
        return PlanetaryResult(
            designs=sifting.select_designs(list),
            search=PlanetarySearch(**dict(search), judged=borne.judged, every_judged=borne.every),
            summary=self._explain_too_weak(borne) or join_messages([self._write_summary(borne.ties), remark]),
            ties=borne.ties,
            pareto=[
                _build_carrying_pareto(problem, one) for one in borne.front if _is_verified(problem, one.mechanism)
            ],
        )

    def _explain_too_weak(self, borne: StrengthResult) -> str:
        """Explain that trains are near enough but none carries the power; empty otherwise."""
        stated = self._problem.strength
        if borne.best or not borne.failed or stated is None:
            return ""
        return describe_too_weak(stated, borne.failed, borne.every, borne.strongest)

    def _write_summary(self, ties: int) -> str:
        """Write the coverage of the search and the best train in one sentence."""
        problem, sifting = self._problem, self._sifting
        searched = compose("planetary_train-combinations-searched", count=sifting.candidates)
        if sifting.passed:
            return self._describe_best(sifting.passed[0], searched, ties)
        if self._idle and not sifting.candidates:
            return compose("planetary_train-set-without-effect")
        if not self._sound:
            reasons = sifting.format_reasons() or compose("planetary_train-none-permitted")
            return compose("planetary_train-none-within-limits", searched=searched, reasons=reasons)
        if not self._best:
            same = problem.target > 0
            none = "planetary_train-none-turns-same" if same else "planetary_train-none-turns-opposite"
            return compose(none, searched=searched)
        near = self._best[0]
        return compose(
            "planetary_train-none-within-tolerance",
            searched=searched,
            ratio=f"{float(near.ratio):.6g}",
            arrangement=near.arrangement,
            teeth=", ".join(f"{gear} {count}" for gear, count in near.teeth),
            input=near.roles[0],
            output=near.roles[1],
            fixed=near.roles[2],
            error=f"{100.0 * float(near.error):.4g}",
        )

    def _describe_best(self, best: PlanetaryDesign, searched: str, ties: int) -> str:
        """Describe the best train, and the number of equally exact ones if trains are ranked by error."""
        problem = self._problem
        if problem.rank_by == "error" and ties > 1:
            searched = join_messages([searched, compose("planetary_train-ties", count=ties)], "; ")
        known = {
            "arrangement": best.mechanism.arrangement,
            "ratio": format_ratio(problem.ratio),
            "searched": searched,
        }
        if best.metrics.error == 0:
            return compose("planetary_train-best-exact", **known)
        return compose("planetary_train-best-nearest", error=f"{100.0 * best.metrics.error:.4g}", **known)


def _build_mechanism(problem: PlanetaryProblem, candidate: Candidate) -> PlanetaryMechanism:
    return build_mechanism(problem, candidate, problem.module)


def _build_design(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> PlanetaryDesign:
    return PlanetaryDesign(
        mechanism=mechanism, verification=verify(problem, mechanism), metrics=measure(problem, mechanism)
    )


def _is_verified(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> bool:
    """Return whether a train passes its checks except the tolerance: a smaller train may be less exact."""
    verification = verify(problem.model_copy(update={"tolerance": None}), mechanism)
    return verification.passed


def _build_carrying_pareto(problem: PlanetaryProblem, borne: CarryingTrain) -> ParetoPlanetaryTrain:
    """Build a train of the Pareto set in the form that carries the power."""
    made = {"module": borne.mechanism.module, "face_widths": borne.mechanism.face_widths}
    return _build_pareto(problem, borne.candidate, borne.candidate.size * borne.mechanism.module).model_copy(
        update=made
    )


def _build_pareto(problem: PlanetaryProblem, candidate: Candidate, size: float) -> ParetoPlanetaryTrain:
    """Build a train of the Pareto set as the answer reports it."""
    driving, driven, fixed = candidate.roles
    return ParetoPlanetaryTrain(
        arrangement=candidate.arrangement,
        input=driving,
        output=driven,
        fixed=fixed,
        teeth=dict(candidate.teeth),
        ratio=Ratio.from_fraction(candidate.ratio),
        error=float(candidate.ratio / problem.target - 1),
        size=size,
    )
