"""What a worker does with a share: each sample ends by itself, whatever its solver, its statement or its plan does."""

import json

import pytest
from sqlalchemy import select

from service.error_messages import MAX_FAULTS
from service.jobs import faults
from service.jobs.batches import slices
from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.slices import SliceSolver
from service.jobs.batches.store import BatchStore
from service.jobs.job_store import JobStore
from service.jobs.processes.stop_flag import Solving
from service.jobs.store.schema import samples
from service.jobs.store.states import Cost
from synthesis import dispatch
from synthesis.model.answer import Result, Search
from synthesis.model.problem import Contradiction, ContradictionError
from tests.support.service.running import PROBLEM

INVALID, DEFECT, MEMORY = "/problems/invalid-problem", "/problems/internal-error", "/problems/out-of-memory"

# The linkage can just not be assembled, which nothing but the solver sees.
APART = {
    "kind": "parallel_motion",
    "linkage": {
        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
        "links": {"input": 20.0, "coupler": 40.0, "output": 40.0 - 80.0 * 5e-7},
        "coupler_point": {"distance": 60.0, "angle": 30.0},
        "assembly": "open",
        "reference_input_angle": 180.0,
    },
}


class Bench:
    """A store, and the slices of a worker in this process."""

    def __init__(self, engine):
        self.engine = engine
        self.store, self.single = BatchStore(engine), JobStore(engine)
        self.slices = SliceSolver(self.store, Solving(), faults.make_out_of_memory(1))

    def batch(self, *seeds, problem=PROBLEM, reuse=False, tenant=""):
        plan = Plan(problem, ["/seed"], [list(seeds)], True, ["size"], reuse)
        return self.store.create(
            tenant=tenant, kind=problem["kind"], label=None, plan=plan, cost=Cost.SHORT, max_queued=1000,
            repeatable=None,
        )[0]  # fmt: skip

    def run(self):
        """Run all that is queued; the outcomes."""
        outcomes = []
        while (claim := self.single.take(f"m{len(outcomes)}", [Cost.SHORT])) is not None:
            outcomes.append(self.slices.run(claim, claim.batch))
            assert len(outcomes) < 1000
        return outcomes

    def ended(self, batch):
        """The batch, and of each sample the type of its error."""
        now = self.store.get(batch.id)
        return now, [None if row.error is None else json.loads(row.error)["type"] for row in self.store.load_rows(now)]


@pytest.fixture
def bench(emptied):
    return Bench(emptied)


class Solver:
    """Has no designs for any problem; raises what is set for a seed."""

    def __init__(self):
        self.given, self.raises = [], {}

    def solve(self, problem, _progress):
        self.given.append(problem.seed)
        if problem.seed in self.raises:
            raise self.raises[problem.seed]
        search = Search(method="scripted", complete=True, candidates=0, accepted=0, rejected={}, seed=problem.seed)
        return Result(designs=[], search=search, summary="scripted")


@pytest.fixture
def solver(monkeypatch):
    scripted = Solver()
    monkeypatch.setattr(dispatch, "solve", scripted.solve)
    return scripted


def test_a_contradiction_that_only_the_solver_sees_fails_its_sample(bench):
    batch = bench.batch(1, 2, problem=APART)
    assert bench.run() == ["slice", "slice"]
    now, errors = bench.ended(batch)
    assert (now.failed, errors) == (2, [INVALID, INVALID])
    [told, _] = [json.loads(row.error) for row in bench.store.load_rows(now)]
    assert [fault["path"].startswith("/linkage") for fault in told["errors"]] == [True]


@pytest.mark.slow
def test_whatever_is_raised_ends_one_sample_only(bench, solver, monkeypatch):
    solver.raises = {1: ContradictionError(Contradiction("/seed", "no")), 2: ValueError(), 3: RecursionError()}
    broken_for(monkeypatch, slices.hash_problem, lambda problem: problem.seed == 5)
    broken_for(monkeypatch, slices._extract_figures, lambda result: json.loads(result)["search"]["seed"] == 6)
    batch = bench.batch(*range(7))
    assert set(bench.run()) == {"slice"}
    now, errors = bench.ended(batch)
    assert errors == [None, INVALID, DEFECT, DEFECT, None, DEFECT, DEFECT]
    assert (now.status.value, now.succeeded, now.failed) == ("succeeded", 2, 5)


def broken_for(monkeypatch, sound, which):
    """A function of the slices has a defect where its first argument is such."""

    def broken(first, *others):
        if which(first):
            raise TypeError("a defect")
        return sound(first, *others)

    monkeypatch.setattr(slices, sound.__name__, broken)


def test_a_plan_that_takes_too_much_memory_fails_its_batch(bench, solver, monkeypatch):
    def read(*_texts):
        raise MemoryError

    batch = bench.batch(*range(40))
    with monkeypatch.context() as small:
        small.setattr(slices.Plan, "read", read)
        assert bench.run() == ["out of memory"] * 16
    now, errors = bench.ended(batch)
    assert (now.status.value, errors, solver.given) == ("failed", [MEMORY] * 40, [])
    other = bench.batch(1)
    assert bench.run() == ["slice"]
    assert bench.ended(other)[0].status.finished


def test_a_plan_has_the_memory_of_those_that_are_kept(bench, solver, monkeypatch):
    bench.batch(1)
    bench.run()
    read, held = slices.Plan.read, []

    def read_alone(*texts):
        held.append(len(bench.slices._plans))
        if held[-1]:
            raise MemoryError
        return read(*texts)

    monkeypatch.setattr(slices.Plan, "read", read_alone)
    batch = bench.batch(2)
    assert bench.run() == ["slice"]
    assert (bench.ended(batch)[1], held) == ([None], [1, 0])


def test_what_takes_too_much_memory_fails_alone(bench, solver, monkeypatch):
    """Statements are read ahead, to look for their answers together; those before it are not blamed."""
    read = slices.hash_problem

    def read_alone(problem):
        if problem.seed == 3:
            raise MemoryError
        return read(problem)

    monkeypatch.setattr(slices, "hash_problem", read_alone)
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    solver.raises = {6: MemoryError()}
    batch = bench.batch(*range(8), reuse=True)
    assert bench.run() == ["out of memory", "out of memory", "slice"]
    now, errors = bench.ended(batch)
    assert (errors, now.succeeded) == ([None, None, None, MEMORY, None, None, MEMORY, None], 6)


def results(bench, batch):
    """What is stored of the samples of a batch: whether there is a result, and the number of the same."""
    with bench.engine.connect() as connection:
        rows = connection.execute(
            select(samples.c.result, samples.c.same_as).where(samples.c.batch == batch.id).order_by(samples.c.number)
        )
        return [(row.result is not None, row.same_as) for row in rows]


def test_equal_samples_are_solved_once_and_stored_once(bench, solver, monkeypatch):
    """Within those whose answers are looked for together, later in the slice, and in a later slice of the batch."""
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    monkeypatch.setattr(slices, "SLICE_S", 60.0)
    monkeypatch.setattr(slices, "MAX_SAMPLES", 3 * slices.LOOKUP_GROUP_SIZE)
    later, slice_after = 2 * slices.LOOKUP_GROUP_SIZE, 3 * slices.LOOKUP_GROUP_SIZE
    seeds = [5, 5, *range(10, 10 + slice_after)]
    seeds[later], seeds[slice_after] = 5, 5
    batch = bench.batch(*seeds, reuse=True)
    assert bench.run() == ["slice", "slice"]
    again = [1, later, slice_after]
    assert solver.given == [seed for n, seed in enumerate(seeds) if n not in again]
    stored = results(bench, batch)
    assert [(n, row) for n, row in enumerate(stored) if row != (True, None)] == [(n, (False, 0)) for n in again]
    now, errors = bench.ended(batch)
    assert (now.cached, set(errors)) == (3, {None})
    jobs = [bench.single.get(make_sample_id(batch.id, n)) for n in (0, *again)]
    assert [job.cached for job in jobs] == [False, True, True, True]
    assert {job.result for job in jobs} == {jobs[0].result}
    assert json.loads(jobs[0].result)["search"]["seed"] == 5


def test_an_answer_of_another_batch_is_copied_once(bench, solver, monkeypatch):
    """It may be removed there."""
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    first = bench.batch(1, reuse=True)
    bench.run()
    second = bench.batch(1, 1, 1, reuse=True)
    anew = bench.batch(1, 1)
    theirs = bench.batch(1, reuse=True, tenant="other")
    bench.run()
    assert solver.given == [1, 1, 1, 1], "once, twice without reuse, and once for another tenant"
    assert results(bench, second) == [(True, None), (False, 0), (False, 0)]
    assert results(bench, anew) == [(True, None)] * 2
    assert [bench.store.get(batch.id).cached for batch in (first, second, anew, theirs)] == [0, 3, 0, 0]
    assert bench.store.delete(first.id)
    assert json.loads(bench.single.get(make_sample_id(second.id, 2)).result)["search"]["seed"] == 1


def test_of_many_faults_of_a_sample_some_are_stored(bench):
    """Ten thousand samples of a thousand faults each would be a gigabyte."""
    batch = bench.batch(1, problem={"kind": "path", "points": [{"x": 1.0}] * 500})
    bench.run()
    [row] = bench.store.load_rows(batch)
    told = json.loads(row.error)
    assert [fault["path"] for fault in told["errors"]] == [f"/points/{n}/y" for n in range(MAX_FAULTS)]
    assert told["detail"].endswith("/points/0/y: This field is required.")


@pytest.mark.parametrize(("length", "kept"), [(1000, 4), (slices.MAX_PLANS_SIZE // 3, 2), (slices.MAX_PLANS_SIZE, 1)])
def test_plans_are_kept_as_far_as_they_are_small(bench, solver, monkeypatch, length, kept):
    reads, read = [], slices.Plan.read
    monkeypatch.setattr(slices.Plan, "read", lambda *texts: reads.append(1) or read(*texts))
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    monkeypatch.setattr(slices, "MAX_SAMPLES", 1)
    for n in range(4):
        bench.batch(n, n + 10, problem={**PROBLEM, "kind": "motion", "seed": 1} | {"note": "a" * length})
    assert bench.run() == ["slice"] * 8
    assert len(bench.slices._plans) == kept
    assert len(reads) == (4 if kept == 4 else 8), "the batches go round"
