"""The work on a share of a batch: a worker solves a slice of it and stores the slice in one transaction.

A slice ends after :data:`SLICE_S` seconds or :data:`MAX_SAMPLES` samples, whichever comes first. That is short enough
to free the worker for the next job in turn. It is long enough that claiming and storing, which take as long as a quick
problem, are a small part of the work.

This module is imported before the worker has set its number of threads, so it must not import numpy.
"""

from __future__ import annotations

import json
import time
from collections import OrderedDict, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import structlog
from pydantic_core import from_json

from service.jobs import faults
from service.jobs.batches.identity import hash_problem
from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.rows import BatchRow, BatchSummary, EndedSample, OwnAnswer, Share
from service.jobs.batches.store import BatchStore
from service.jobs.processes.stop_flag import SolverStopped, Solving
from service.jobs.store.database import write_when_reachable
from service.jobs.store.schema import Claim, format_now
from service.jobs.store.states import Status
from synthesis.model.problem import ProblemBase

SLICE_S = 0.1
"""Time after which a slice begins no further sample, seconds."""

MAX_SAMPLES = 200
"""Maximum number of samples of a slice."""

LOOKUP_GROUP_SIZE = 16
"""Number of samples whose stored answers are queried together."""

MAX_PLANS_SIZE = 2 << 20
"""Size of the plans that a worker caches, characters of JSON; in memory they take about ten times as much. Parsing a
plan for each of many slices would take long. The plan in use is kept even if it is larger."""

Outcome = Literal["slice", "superseded", "stopped", "out of memory"]

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class _PreparedSample:
    """A sample ready to be solved: the problem and its digest, or the fault that prevents it."""

    number: int
    problem: ProblemBase | None = None
    digest: str | None = None
    fault: faults.Fault | None = None


@dataclass(frozen=True, slots=True)
class _CachedPlan:
    """A batch, its plan, and the size of both in characters of JSON."""

    batch: BatchRow
    plan: Plan
    size: int


class SliceSolver:
    """Solves slices in a worker process, one at a time."""

    def __init__(self, store: BatchStore, solving: Solving, out_of_memory: faults.Fault) -> None:
        self._store = store
        self._solving = solving
        self._out_of_memory = out_of_memory
        self._plans: OrderedDict[str, _CachedPlan] = OrderedDict()

    def run(self, claim: Claim, batch_id: str) -> Outcome:
        """Solve a slice of the claimed share and store it before returning.

        If the lane requests a stop, nothing of the slice is stored; solving it again takes little time.
        """
        share = Share.read(claim.problem)
        try:
            known = self._load_plan(batch_id)
            if known is None:
                write_when_reachable(self._store.store, None, claim.job_id, claim.attempt, None, [])
                return "superseded"
            batch, plan = known
            todo, end = self._select_window(batch, share)
        except MemoryError:
            return self._fail_share(claim, batch_id, share)
        new: list[EndedSample] = []
        outcome: Outcome = "slice"
        until = time.perf_counter() + SLICE_S
        try:
            for sample, answer in self._attach_answers(batch, plan, todo, new):
                new.append(self._finish_sample(batch, plan, sample, answer))
                if time.perf_counter() >= until:
                    break
        except SolverStopped:
            return "stopped"
        except MemoryError:
            # The samples before this one are valid and are stored; only the sample being solved has failed.
            at = todo[len(new)]
            new.append(_build_failure(batch, at, format_now(), self._out_of_memory))
            outcome = "out of memory"
        # After a sample solved by itself the share goes on from its beginning; stored samples are skipped there.
        first = share.first if share.alone is not None else todo[len(new)] if len(new) < len(todo) else end
        left = Share(first, share.end) if first < share.end else None
        stored = write_when_reachable(self._store.store, batch, claim.job_id, claim.attempt, left, new)
        return outcome if stored else "superseded"

    def _load_plan(self, batch_id: str) -> tuple[BatchRow, Plan] | None:
        """Return the batch and its plan, from the cache if possible; None if the batch has ended."""
        if batch_id not in self._plans:
            batch = write_when_reachable(self._store.start_batch, batch_id)
            if batch is None:
                return None
            try:
                known = self._read(batch)
            except MemoryError:
                # The cached plans take most of the memory: try again without them.
                self._plans.clear()
                known = self._read(batch)
            if known is None:
                return None
            self._plans[batch_id] = known
            while len(self._plans) > 1 and sum(each.size for each in self._plans.values()) > MAX_PLANS_SIZE:
                self._plans.popitem(last=False)
        self._plans.move_to_end(batch_id)
        kept = self._plans[batch_id]
        return kept.batch, kept.plan

    def _read(self, batch: BatchRow) -> _CachedPlan | None:
        values = write_when_reachable(self._store.load_values, batch)
        if values is None:
            return None
        return _CachedPlan(batch, Plan.read(batch.stated, values), len(batch.stated) + len(values))

    def _fail_share(self, claim: Claim, batch_id: str, share: Share) -> Outcome:
        """Fail the rest of a share whose plan exceeds the memory limit of a job, so that no sample can be solved."""
        self._plans.clear()
        batch = write_when_reachable(self._store.load_summaries, [batch_id]).get(batch_id)
        new = []
        if batch is not None:
            there = write_when_reachable(self._store.find_stored, batch, share.first, share.end)
            left = (number for number in range(share.first, share.end) if number not in there)
            new = [_build_failure(batch, number, format_now(), self._out_of_memory) for number in left]
        write_when_reachable(self._store.store, batch, claim.job_id, claim.attempt, None, new)
        return "out of memory"

    def _select_window(self, batch: BatchRow, share: Share) -> tuple[list[int], int]:
        """Return the numbers of the samples to solve next, and the number at which the samples after them begin."""
        if share.alone is not None:
            first, end = share.alone, share.alone + 1
        else:
            first, end = share.first, min(share.end, share.first + MAX_SAMPLES)
        there = write_when_reachable(self._store.find_stored, batch, first, end)
        return [number for number in range(first, end) if number not in there], end

    def _attach_answers(
        self, batch: BatchRow, plan: Plan, todo: Sequence[int], new: Sequence[EndedSample]
    ) -> Iterator[tuple[_PreparedSample, str | OwnAnswer | None]]:
        """Yield the prepared samples, each with the answer to an equal problem from this slice or from the store."""
        own: dict[str, OwnAnswer] = {}
        left = deque(todo)
        while left:
            group = self._group(batch, plan, left)
            stored: dict[str, str | OwnAnswer] = {}
            if plan.reuse:
                digests = {sample.digest for sample in group if sample.digest is not None}
                stored = write_when_reachable(self._store.find_answers, batch, digests - own.keys())
            for sample in group:
                # The caller appends to `new` between two yields: the last entry is the sample yielded before.
                if plan.reuse and new and new[-1].digest is not None:
                    own[new[-1].digest] = OwnAnswer(new[-1].number, new[-1].figures)
                known_by = sample.digest or ""
                yield sample, own.get(known_by) or stored.get(known_by)

    def _group(self, batch: BatchRow, plan: Plan, left: deque[int]) -> list[_PreparedSample]:
        """Prepare the next samples of ``left`` and remove them from it, as many as are queried together.

        If preparing one takes too much memory, return those before it. The error is raised if it is the first.
        """
        group: list[_PreparedSample] = []
        for number in list(left)[: LOOKUP_GROUP_SIZE if plan.reuse else 1]:
            try:
                group.append(self._prepare_sample(batch, plan, number))
            except MemoryError:
                if not group:
                    raise
                break
            left.popleft()
        return group

    def _finish_sample(
        self, batch: BatchRow, plan: Plan, prepared: _PreparedSample, answer: str | OwnAnswer | None
    ) -> EndedSample:
        began = format_now()
        if isinstance(answer, OwnAnswer):
            return EndedSample(
                prepared.number,
                Status.SUCCEEDED,
                began,
                format_now(),
                cached=True,
                same_as=answer.number,
                figures=answer.figures,
            )
        try:
            result = self._solve_sample(prepared) if answer is None else answer
            if isinstance(result, faults.Fault):
                return _build_failure(batch, prepared.number, began, result)
            return EndedSample(
                prepared.number,
                Status.SUCCEEDED,
                began,
                format_now(),
                cached=answer is not None,
                digest=prepared.digest,
                figures=_extract_figures(result, plan.metrics),
                result=result,
            )
        except MemoryError:
            raise
        except Exception:  # the boundary of the solvers: a defect in them ends this sample only
            log.exception("the solver raised", batch=batch.id, sample=prepared.number)
            return _build_failure(batch, prepared.number, began, faults.INTERNAL_ERROR)

    def _solve_sample(self, prepared: _PreparedSample) -> str | faults.Fault:
        """Return the answer as JSON, or the fault."""
        from kinematics.message import make_sentence
        from service.requests import check_consistency
        from synthesis import dispatch
        from synthesis.model.problem import ContradictionError

        if prepared.fault is not None:
            return prepared.fault
        assert prepared.problem is not None
        try:
            with self._solving.track_work(prepared.number):
                return dispatch.solve(
                    prepared.problem, self._solving.make_stoppable(_ignore_progress)
                ).model_dump_json()
        except ContradictionError as error:
            # Some contradictions are found by the solver only and are not among those of the statement.
            path, detail = error.contradiction
            return faults.make_invalid_problem(check_consistency(prepared.problem) or [(path, make_sentence(detail))])

    def _prepare_sample(self, batch: BatchRow, plan: Plan, number: int) -> _PreparedSample:
        from service.requests import check_fields

        try:
            with self._solving.track_work(number):
                problem, wrong = check_fields(batch.kind, plan.build_statement(number))
                if wrong:
                    return _PreparedSample(number, fault=faults.make_invalid_problem(wrong))
                return _PreparedSample(number, problem, hash_problem(problem))
        except MemoryError:
            raise
        except Exception:  # a defect in the checks or in the hash ends this sample only
            log.exception("a statement could not be read", batch=batch.id, sample=number)
            return _PreparedSample(number, fault=faults.INTERNAL_ERROR)


def _ignore_progress(_fraction: float, _message: str) -> None:
    pass


def _build_failure(batch: BatchSummary, number: int, began: str, fault: faults.Fault) -> EndedSample:
    error = fault.as_json(make_sample_id(batch.id, number))
    return EndedSample(number, Status.FAILED, began, format_now(), error=error)


def _extract_figures(result: str, metrics: Sequence[str]) -> str:
    """Return the figures of an answer for the table: number of designs that passed, metrics of the best of them."""
    passed = [design for design in from_json(result)["designs"] if design["verification"]["passed"]]
    best = passed[0]["metrics"] if passed else {}
    return json.dumps([len(passed), *(best.get(name) for name in metrics)])
