"""What a worker does with a share of a batch: it solves a slice of it and stores that in one go.

A slice ends after :data:`SLICE_S` or :data:`MOST` samples, whichever comes first: soon enough that a worker is free for
whatever comes next in turn, and seldom enough that claiming and storing, which takes as long as a quick problem, is a
small part of the work.

This module is imported before the worker has set its number of threads, so it must not import numpy.
"""

from __future__ import annotations

import json
import time
from collections import OrderedDict, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import structlog
from pydantic_core import from_json

from service.jobs import faults
from service.jobs.batches.identity import digest
from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import sample_id
from service.jobs.batches.rows import BatchRow, BatchSummary, Ended, OwnAnswer, Share
from service.jobs.batches.store import BatchStore
from service.jobs.processes.stop_flag import Solving, Stopped
from service.jobs.store.database import patiently
from service.jobs.store.schema import Claim, now
from service.jobs.store.states import Status

SLICE_S = 0.1
"""Seconds after which no further sample of a slice is begun."""

MOST = 200
"""Samples of a slice at most."""

LOOKED_UP = 16
"""Samples whose answers are looked for together among those that are stored."""

PLANS_SIZE = 2 << 20
"""Characters of the plans that a worker keeps: reading one takes a while, and there are many slices. They take some ten
times as much memory. The one that is worked at is kept in any case."""

Outcome = Literal["slice", "superseded", "stopped", "out of memory"]

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class _Stated:
    """A sample as it is to be solved: the problem and its digest, or why there is none."""

    number: int
    problem: Any = None
    digest: str | None = None
    fault: faults.Fault | None = None


@dataclass(frozen=True, slots=True)
class _Kept:
    """A batch, its plan, and how many characters that is."""

    batch: BatchRow
    plan: Plan
    size: int


class Slices:
    """Solves slices in a worker process, one after the other."""

    def __init__(self, store: BatchStore, solving: Solving, out_of_memory: faults.Fault) -> None:
        self._store = store
        self._solving = solving
        self._out_of_memory = out_of_memory
        self._plans: OrderedDict[str, _Kept] = OrderedDict()

    def run(self, claim: Claim, batch_id: str) -> Outcome:
        """Solve a slice of the share that was claimed. The store has it when this returns.

        Nothing of it is stored where the lane says that it is to stop; that is soon done again.
        """
        share = Share.read(claim.problem)
        try:
            known = self._known(batch_id)
            if known is None:
                patiently(self._store.store, None, claim.job_id, claim.attempt, None, [])
                return "superseded"
            batch, plan = known
            todo, end = self._window(batch, share)
        except MemoryError:
            return self._without_its_plan(claim, batch_id, share)
        new: list[Ended] = []
        outcome: Outcome = "slice"
        until = time.perf_counter() + SLICE_S
        try:
            for stated, answer in self._with_answers(batch, plan, todo, new):
                new.append(self._ended(batch, plan, stated, answer))
                if time.perf_counter() >= until:
                    break
        except Stopped:
            return "stopped"
        except MemoryError:
            at = todo[len(new)]
            new.append(_failed(batch, at, now(), self._out_of_memory))
            outcome = "out of memory"
        first = share.first if share.alone is not None else todo[len(new)] if len(new) < len(todo) else end
        left = Share(first, share.end) if first < share.end else None
        stored = patiently(self._store.store, batch, claim.job_id, claim.attempt, left, new)
        return outcome if stored else "superseded"

    def _known(self, batch_id: str) -> tuple[BatchRow, Plan] | None:
        """The batch and its plan; None where it has ended."""
        if batch_id not in self._plans:
            batch = patiently(self._store.begun, batch_id)
            if batch is None:
                return None
            try:
                known = self._read(batch)
            except MemoryError:
                self._plans.clear()
                known = self._read(batch)
            if known is None:
                return None
            self._plans[batch_id] = known
            while len(self._plans) > 1 and sum(each.size for each in self._plans.values()) > PLANS_SIZE:
                self._plans.popitem(last=False)
        self._plans.move_to_end(batch_id)
        kept = self._plans[batch_id]
        return kept.batch, kept.plan

    def _read(self, batch: BatchRow) -> _Kept | None:
        values = patiently(self._store.values, batch)
        if values is None:
            return None
        return _Kept(batch, Plan.read(batch.stated, values), len(batch.stated) + len(values))

    def _without_its_plan(self, claim: Claim, batch_id: str, share: Share) -> Outcome:
        """Fail what is left of a share whose plan takes more memory than a job may: none of it can be solved."""
        self._plans.clear()
        batch = patiently(self._store.summaries, [batch_id]).get(batch_id)
        new = []
        if batch is not None:
            there = patiently(self._store.ended, batch, share.first, share.end)
            left = (number for number in range(share.first, share.end) if number not in there)
            new = [_failed(batch, number, now(), self._out_of_memory) for number in left]
        patiently(self._store.store, batch, claim.job_id, claim.attempt, None, new)
        return "out of memory"

    def _window(self, batch: BatchRow, share: Share) -> tuple[list[int], int]:
        """The samples to be solved next, and where those begin that come after them."""
        if share.alone is not None:
            first, end = share.alone, share.alone + 1
        else:
            first, end = share.first, min(share.end, share.first + MOST)
        there = patiently(self._store.ended, batch, first, end)
        return [number for number in range(first, end) if number not in there], end

    def _with_answers(
        self, batch: BatchRow, plan: Plan, todo: Sequence[int], new: Sequence[Ended]
    ) -> Iterator[tuple[_Stated, str | OwnAnswer | None]]:
        """The samples as they are stated, each with the answer that the slice or the store has of its like."""
        own: dict[str, OwnAnswer] = {}
        left = deque(todo)
        while left:
            group = self._group(batch, plan, left)
            stored: dict[str, str | OwnAnswer] = {}
            if plan.reuse:
                wanted = {stated.digest for stated in group if stated.digest is not None}
                stored = patiently(self._store.answers, batch, wanted - own.keys())
            for stated in group:
                if plan.reuse and new and new[-1].digest is not None:
                    own[new[-1].digest] = OwnAnswer(new[-1].number, new[-1].figures)
                known_by = stated.digest or ""
                yield stated, own.get(known_by) or stored.get(known_by)

    def _group(self, batch: BatchRow, plan: Plan, left: deque[int]) -> list[_Stated]:
        """The next samples, taken from those that are ``left``: as many as are looked for together.

        Where one takes too much memory to be stated, those before it; the error is its own when it comes first.
        """
        group: list[_Stated] = []
        for number in list(left)[: LOOKED_UP if plan.reuse else 1]:
            try:
                group.append(self._stated(batch, plan, number))
            except MemoryError:
                if not group:
                    raise
                break
            left.popleft()
        return group

    def _ended(self, batch: BatchRow, plan: Plan, stated: _Stated, answer: str | OwnAnswer | None) -> Ended:
        began = now()
        if isinstance(answer, OwnAnswer):
            return Ended(
                stated.number,
                Status.SUCCEEDED,
                began,
                now(),
                cached=True,
                same_as=answer.number,
                figures=answer.figures,
            )
        try:
            result = self._solved(stated) if answer is None else answer
            if isinstance(result, faults.Fault):
                return _failed(batch, stated.number, began, result)
            return Ended(
                stated.number,
                Status.SUCCEEDED,
                began,
                now(),
                cached=answer is not None,
                digest=stated.digest,
                figures=_figures(result, plan.metrics),
                result=result,
            )
        except MemoryError:
            raise
        except Exception:  # the boundary of the solvers: whatever defect they have ends this sample only
            log.exception("the solver raised", batch=batch.id, sample=stated.number)
            return _failed(batch, stated.number, began, faults.INTERNAL_ERROR)

    def _solved(self, stated: _Stated) -> str | faults.Fault:
        """The answer in JSON, or why there is none."""
        from service.error_messages import sentence
        from service.requests import consistent
        from synthesis import dispatch
        from synthesis.model.problem import ContradictionError

        if stated.fault is not None:
            return stated.fault
        try:
            with self._solving.at_work(stated.number):
                return dispatch.solve(stated.problem, self._solving.stoppable(_silent)).model_dump_json()
        except ContradictionError as error:
            # Some are seen by the solver alone, and stand among those of the statement nowhere.
            path, detail = error.contradiction
            return faults.invalid_problem(consistent(stated.problem) or [(path, sentence(detail))])

    def _stated(self, batch: BatchRow, plan: Plan, number: int) -> _Stated:
        from service.requests import well_formed

        try:
            with self._solving.at_work(number):
                problem, wrong = well_formed(batch.kind, plan.statement(number))
                if wrong:
                    return _Stated(number, fault=faults.invalid_problem(wrong))
                return _Stated(number, problem, digest(problem))
        except MemoryError:
            raise
        except Exception:  # a defect of what checks or tells problems apart ends this sample only
            log.exception("a statement could not be read", batch=batch.id, sample=number)
            return _Stated(number, fault=faults.INTERNAL_ERROR)


def _silent(_fraction: float, _message: str) -> None:
    pass


def _failed(batch: BatchSummary, number: int, began: str, fault: faults.Fault) -> Ended:
    error = fault.as_json(sample_id(batch.id, number))
    return Ended(number, Status.FAILED, began, now(), error=error)


def _figures(result: str, metrics: Sequence[str]) -> str:
    """What the table has of an answer: the number of designs that passed, and the metrics of the best of them."""
    passed = [design for design in from_json(result)["designs"] if design["verification"]["passed"]]
    best = passed[0]["metrics"] if passed else {}
    return json.dumps([len(passed), *(best.get(name) for name in metrics)])
