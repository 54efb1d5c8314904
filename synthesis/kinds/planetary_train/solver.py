"""The best planetary trains for a ratio, over all arrangements and members that the problem leaves open.

Every planet set's sound tooth numbers are listed once; every choice of members then ranks the resulting trains. As
nothing is sampled, the answer is optimal, and an empty answer is a proof.
"""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction
from functools import partial

from synthesis.kinds.planetary_train.carrying import Borne, Judged, Listing, judged
from synthesis.kinds.planetary_train.design import (
    ParetoPlanetaryTrain,
    PlanetaryDesign,
    PlanetaryMechanism,
    PlanetaryResult,
    PlanetarySearch,
)
from synthesis.kinds.planetary_train.making import demands_of, mechanism_of
from synthesis.kinds.planetary_train.nearest import Candidate, Nearest, SetTable, nearest, train_value
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.planetary_train.tooth_numbers import ToothNumbers
from synthesis.kinds.planetary_train.verification import measure, verify
from synthesis.model.counting import counted, grouped
from synthesis.model.gear_answer import Ratio
from synthesis.model.gear_strength import carrying_words, too_weak_words
from synthesis.model.kind import Progress
from synthesis.model.ratio_target import as_stated
from synthesis.outcome.exhaustive import first_within, pareto
from synthesis.outcome.sifting import Sifting


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
    ranking, listing = _Ranking(problem), Listing(problem)
    rows = problem.arrangements
    for k, arrangement in enumerate(rows):
        progress(k / len(rows), f"{arrangement.name}: tooth numbers")
        numbers = [
            ToothNumbers(arrangement, planets, demands_of(problem, arrangement)) for planets in arrangement.planet_sets
        ]
        # Only coupled sets need train values.
        coupled = len(numbers) > 1
        tables = [
            SetTable(each.teeth, each.size, train_value(arrangement.name, planets).form if coupled else None)
            for each, planets in zip(numbers, arrangement.planet_sets, strict=True)
        ]
        roles = problem.roles(arrangement)
        for j, members in enumerate(roles):
            progress((k + j / len(roles)) / len(rows), f"{arrangement.name}: {' to '.join(members[:2])}")
            ranking.take(numbers, nearest(arrangement, tables, members, problem.target, problem.max_designs))
            listing.add(arrangement, tables, members)
    if problem.strength is not None:
        progress(1.0, "judging the strength of the trains")
        return ranking.result_of(judged(problem, problem.strength, listing))
    progress(1.0, "done")
    return ranking.result()


class _Ranking:
    """Accumulates the best trains over all arrangements and members."""

    def __init__(self, problem: PlanetaryProblem) -> None:
        self._problem = problem
        self._best: list[Candidate] = []
        self._by_size: dict[int, Candidate] = {}
        self._ties: Counter[Fraction] = Counter()
        self._sound = self._idle = 0
        self._sifting = Sifting[PlanetaryDesign](problem)

    def take(self, numbers: list[ToothNumbers], nearest: Nearest | None) -> None:
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

    def result(self) -> PlanetaryResult:
        """Build the verified answer."""
        problem = self._problem
        by_size = [self._by_size[size] for size in sorted(self._by_size)]
        ranked = self._best if problem.rank_by == "error" else by_size
        sifting = self._sifting
        best = first_within(ranked, problem.tolerance, problem.max_designs)
        sifting.sift_best([_made(problem, one) for one in best], self._sound, partial(_design, problem))
        front = pareto(by_size, lambda candidate: candidate.error)
        return PlanetaryResult(
            designs=sifting.designs(list),
            search=PlanetarySearch(**dict(sifting.search("exhaustive", complete=not sifting.failed))),
            summary=self._summary(self._ties[self._best[0].error] if self._best else 0),
            ties=self._ties[self._best[0].error] if self._best else 0,
            pareto=[
                _pareto(problem, candidate, candidate.size * problem.module)
                for candidate in front
                if _holds(problem, _made(problem, candidate))
            ],
        )

    def result_of(self, borne: Judged) -> PlanetaryResult:
        """Build the verified answer for a given power: the best of the trains that carry it."""
        problem, sifting = self._problem, self._sifting
        sifting.reject("strength", borne.failed)
        made = [one.mechanism for one in borne.best]
        sifting.sift_best(made, self._sound - borne.failed, partial(_design, problem))
        search = sifting.search("exhaustive", complete=borne.proven and not sifting.failed)
        told = ""
        if sifting.passed:
            told = f" {carrying_words(borne.failed)}"
        return PlanetaryResult(
            designs=sifting.designs(list),
            search=PlanetarySearch(**dict(search), judged=borne.judged, every_judged=borne.every),
            summary=self._too_weak(borne) or f"{self._summary(borne.ties)}{told}",
            ties=borne.ties,
            pareto=[_borne_pareto(problem, one) for one in borne.front if _holds(problem, one.mechanism)],
        )

    def _too_weak(self, borne: Judged) -> str:
        """Explain that trains are near enough but none carries the power; empty otherwise."""
        stated = self._problem.strength
        if borne.best or not borne.failed or stated is None:
            return ""
        return too_weak_words(stated, borne.failed, borne.every, borne.strongest)

    def _summary(self, ties: int) -> str:
        """Write the coverage of the search and the best train in one sentence."""
        problem, sifting = self._problem, self._sifting
        covered = f"{counted(sifting.candidates, 'combination')} of tooth numbers and members searched"
        if sifting.passed:
            first = sifting.passed[0]
            exact = "exactly" if first.metrics.error == 0 else f"with an error of {100.0 * first.metrics.error:.4g} %"
            alike = f"; {grouped(ties)} trains have this error" if problem.rank_by == "error" and ties > 1 else ""
            name = first.mechanism.arrangement.replace("_", " ")
            return f"The {name} arrangement reaches {as_stated(problem.ratio)} {exact}; {covered}{alike}."
        if self._idle and not sifting.candidates:
            return "With these members a planet set does not affect the ratio; choose a simpler arrangement."
        if not self._sound:
            return f"No train keeps the limits: {covered} ({sifting.listed() or 'the limits permit none'})."
        if not self._best:
            direction = "the same" if problem.target > 0 else "the opposite"
            return f"With these members no train turns input and output in {direction} direction; {covered}."
        near = self._best[0]
        teeth = ", ".join(f"{gear} {count}" for gear, count in near.teeth)
        return (
            f"No train is within the tolerance: {covered}. The nearest ratio is {float(near.ratio):.6g}, by "
            f"{near.arrangement} ({teeth}; {' to '.join(near.roles[:2])}, "
            f"{near.roles[2]} fixed), with an error of {100.0 * float(near.error):.4g} %."
        )


def _made(problem: PlanetaryProblem, candidate: Candidate) -> PlanetaryMechanism:
    return mechanism_of(problem, candidate, problem.module)


def _design(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> PlanetaryDesign:
    return PlanetaryDesign(
        mechanism=mechanism, verification=verify(problem, mechanism), metrics=measure(problem, mechanism)
    )


def _holds(problem: PlanetaryProblem, mechanism: PlanetaryMechanism) -> bool:
    """Return whether a train passes its checks except the tolerance: a smaller train may be less exact."""
    verification = verify(problem.model_copy(update={"tolerance": None}), mechanism)
    return verification.passed


def _borne_pareto(problem: PlanetaryProblem, borne: Borne) -> ParetoPlanetaryTrain:
    """Build a train of the Pareto set in the form that carries the power."""
    made = {"module": borne.mechanism.module, "face_widths": borne.mechanism.face_widths}
    return _pareto(problem, borne.candidate, borne.candidate.size * borne.mechanism.module).model_copy(update=made)


def _pareto(problem: PlanetaryProblem, candidate: Candidate, size: float) -> ParetoPlanetaryTrain:
    """Build a train of the Pareto set as the answer reports it."""
    driving, driven, fixed = candidate.roles
    return ParetoPlanetaryTrain(
        arrangement=candidate.arrangement,
        input=driving,
        output=driven,
        fixed=fixed,
        teeth=dict(candidate.teeth),
        ratio=Ratio.of(candidate.ratio),
        error=float(candidate.ratio / problem.target - 1),
        size=size,
    )
