"""Which job a free lane gets, and what becomes of short jobs beside long ones, floods and cancels."""

import threading
import time
from dataclasses import dataclass

import pytest
from sqlalchemy.exc import OperationalError

from service.jobs.job_store import JobStore
from service.jobs.store.states import Cost
from service.jobs.workers.scheduler import ASK_PERIOD_S, PATIENCE_S, Turns
from synthesis.registry import KINDS, parse_problem
from tests.support.service.access import client_with, post
from tests.support.service.access import made as made_key
from tests.support.service.running import PROBLEM, REACHED_S, SCRIPTED, SOON_S, RunningServer, until
from tests.support.service.scripted_server import GATED, INSTANT, NATIVE, STEPS

LONG = {**PROBLEM, "positions": [{"x": 10.0 * n, "y": 1.0 * n * n, "angle": 9.0 * n} for n in range(7)]}
"""A statement that is taken to be long, whatever the scripted solver makes of it."""


@dataclass(eq=False)
class Seat:
    ready: bool = True
    is_settled: bool = True


@pytest.fixture
def store(emptied):
    return JobStore(emptied)


def made(store, cost, count=1, tenant=""):
    return [
        store.create(tenant=tenant, kind="motion", label=None, problem="{}", cost=cost, max_queued=1000).id
        for _ in range(count)
    ]


def opened(store, seats, most_long):
    turns = Turns(store, seats, most_long)
    turns.open()
    return turns


def cost_for(turns, seat, free_since=None):
    claim = turns.take(seat, time.monotonic() if free_since is None else free_since)
    return None if claim is None else claim.cost


@pytest.mark.slow
def test_a_lane_is_kept_for_short_jobs(store):
    made(store, Cost.LONG, 3)
    seats = [Seat(), Seat(), Seat()]
    turns = opened(store, seats, 2)
    assert [cost_for(turns, seat) for seat in seats] == [Cost.LONG, Cost.LONG, None]
    made(store, Cost.SHORT)
    assert cost_for(turns, seats[2]) == Cost.SHORT
    turns.release(seats[2])
    turns.release(seats[0])
    assert cost_for(turns, seats[0]) == Cost.LONG
    assert cost_for(turns, seats[2], free_since=0.0) is None, "however long it has been idle"


@pytest.mark.slow
def test_a_flood_leaves_the_last_lane_to_other_tenants(store):
    made(store, Cost.SHORT, 9, "flood")
    seats = [Seat(), Seat(), Seat()]
    turns = opened(store, seats, 2)
    assert [cost_for(turns, seat) for seat in seats] == [Cost.SHORT, Cost.SHORT, None]
    [job] = made(store, Cost.SHORT, tenant="guest")
    assert turns.take(seats[2], time.monotonic()).job_id == job
    turns.release(seats[0])
    assert cost_for(turns, seats[0]) is None, "the last one that is free, again"
    turns.release(seats[1])
    assert cost_for(turns, seats[0]) == Cost.SHORT, "another one is free"


@pytest.mark.slow
def test_a_tenant_whose_jobs_turn_out_to_be_long_gets_the_last_lane(store):
    made(store, Cost.SHORT, 3)
    seats = [Seat(), Seat(), Seat()]
    turns = opened(store, seats, 2)
    assert [cost_for(turns, seat) for seat in seats] == [Cost.SHORT, Cost.SHORT, None]
    assert not turns.count_as_long(seats[0])
    assert cost_for(turns, seats[2]) is None, "one of them is short still"
    assert not turns.count_as_long(seats[1])
    assert cost_for(turns, seats[2]) == Cost.SHORT


def test_without_a_reserve_every_lane_takes_every_job(store):
    made(store, Cost.LONG, 2)
    seats = [Seat(), Seat()]
    turns = opened(store, seats, 2)
    assert [cost_for(turns, seat) for seat in seats] == [Cost.LONG, Cost.LONG]


def test_short_and_long_jobs_alternate_where_lanes_are_free_for_both(store):
    made(store, Cost.LONG, 3)
    made(store, Cost.SHORT, 3)
    seats = [Seat(), Seat()]
    turns = opened(store, seats, 2)
    given = []
    for _ in range(6):
        given.append(cost_for(turns, seats[0]))
        turns.release(seats[0])
    assert given == [Cost.SHORT, Cost.LONG] * 3


@pytest.mark.slow
def test_the_last_worker_that_is_ready_is_not_given_to_a_long_job(store):
    """Others are being started again, one after the other: clients cancel what they post."""
    made(store, Cost.LONG)
    seats = [Seat(), Seat(ready=False), Seat(ready=False)]
    turns = opened(store, seats, 2)
    assert cost_for(turns, seats[0]) is None
    made(store, Cost.SHORT)
    assert cost_for(turns, seats[0]) == Cost.SHORT
    turns.release(seats[0])
    assert cost_for(turns, seats[0], time.monotonic() - PATIENCE_S - 1.0) == Cost.LONG, "none of them can be started"


def test_long_jobs_need_not_wait_for_the_first_start_of_the_others(store):
    made(store, Cost.LONG)
    seats = [Seat(), Seat(ready=False, is_settled=False)]
    assert cost_for(opened(store, seats, 1), seats[0]) == Cost.LONG


def test_a_job_that_turns_out_to_be_long_gives_the_last_lane_back(store):
    made(store, Cost.LONG)
    made(store, Cost.SHORT, 2)
    seats = [Seat(), Seat()]
    turns = opened(store, seats, 1)
    assert [cost_for(turns, seat) for seat in seats] == [Cost.SHORT, Cost.LONG]
    assert turns.count_as_long(seats[0])
    turns.release(seats[0])
    turns.release(seats[1])
    assert cost_for(turns, seats[0]) == Cost.SHORT
    assert not turns.count_as_long(seats[0]), "the other is free for short ones"


def test_a_free_lane_hears_of_a_job_at_once(store, monkeypatch):
    seats = [Seat()]
    turns = opened(store, seats, 1)
    taken, asked = [], threading.Event()

    def ask(mark, costs, *more):
        claim = JobStore.take(store, mark, costs, *more)
        asked.set()
        return claim

    monkeypatch.setattr(store, "take", ask)

    def wait():
        while not taken:
            claim = turns.take(seats[0], time.monotonic())
            if claim is not None:
                taken.append(time.monotonic())

    lane = threading.Thread(target=wait)
    lane.start()
    assert asked.wait(SOON_S)
    made(store, Cost.SHORT)
    told = time.monotonic()
    turns.wake()
    lane.join(10)
    assert taken[0] - told < 0.5 * ASK_PERIOD_S


@pytest.mark.slow
def test_a_job_of_which_nobody_tells_is_found(store):
    seats = [Seat()]
    turns = opened(store, seats, 1)
    assert cost_for(turns, seats[0]) is None
    made(store, Cost.SHORT)
    assert cost_for(turns, seats[0]) == Cost.SHORT


@pytest.mark.slow
def test_nothing_is_given_out_before_the_store_is_in_order_or_after_the_end(store):
    made(store, Cost.SHORT, 2)
    seats = [Seat()]
    turns = Turns(store, seats, 1)
    assert cost_for(turns, seats[0]) is None
    turns.open()
    assert cost_for(turns, seats[0]) == Cost.SHORT
    turns.close()
    assert cost_for(turns, seats[0]) is None


@pytest.mark.slow
def test_a_job_that_was_given_while_the_store_broke_off_is_not_forgotten(store, monkeypatch):
    [job] = made(store, Cost.SHORT)
    seats = [Seat()]
    turns = opened(store, seats, 1)

    def broken_off(mark, costs, *more):
        JobStore.take(store, mark, costs, *more)
        monkeypatch.undo()
        raise OperationalError("", None, ConnectionError("the answer does not come"))

    monkeypatch.setattr(store, "take", broken_off)
    assert turns.take(seats[0], time.monotonic()) is None
    assert turns.take(seats[0], time.monotonic()).job_id == job


def test_the_cost_of_every_example_is_known():
    """The first examples of most kinds are brief; whatever is fitted or searched for is not."""
    brief = {name for name, kind in KINDS.items() if kind.brief(parse_problem(kind.examples[0]))}
    assert brief == {
        "motion", "quick_return", "straight_line", "parallel_motion", "gear_train", "planetary_train", "train_series",
        "gearbox", "layshaft_gearbox", "cam", "balancing", "spring_balancing", "flywheel", "engine", "indexing",
    }  # fmt: skip
    assert not KINDS["motion"].brief(parse_problem(LONG))
    sixbars = next(example for example in KINDS["motion"].examples if "mechanisms" in example)
    assert not KINDS["motion"].brief(parse_problem(sixbars))


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """A service with two tenants. Its client is the first one's, ``guest`` the other's."""
    folder = tmp_path_factory.mktemp("fair")
    held = [made_key(folder, name) for name in ("acme", "globex")]
    running = RunningServer(folder, SCRIPTED, workers=2, reserve=1, log_level="warning", rate_limit="100000/minute")
    running.client.headers["Authorization"] = f"Bearer {held[0]}"
    running.guest = client_with(running, held[1])
    yield running
    running.guest.close()
    assert running.stop() == 0


@pytest.fixture
def gate(server):
    """Closed for the test; the jobs behind it end with it."""
    path = server.folder / "open"
    path.unlink(missing_ok=True)
    until(lambda: len(server.workers()) == 3, SOON_S, "all workers")
    yield path
    path.touch()
    (server.folder / "patient").unlink(missing_ok=True)
    until(lambda: not server.client.get("/v1/jobs?status=running").json()["jobs"], SOON_S, "the end of all jobs")


@pytest.mark.slow
@pytest.mark.campaign
def test_a_short_job_does_not_wait_for_long_ones(server, gate):
    long = [server.post(GATED, problem=LONG) for _ in range(5)]
    until(lambda: len(server.client.get("/v1/jobs?status=running").json()["jobs"]) == 2, SOON_S, "two long jobs")
    for _ in range(3):
        assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    assert [server.job(job["id"])["status"] for job in long].count("running") == 2
    gate.touch()
    for job in long:
        server.reaches(job["id"], "succeeded")


@pytest.mark.slow
@pytest.mark.campaign
def test_short_jobs_that_turn_out_to_be_long_do_not_block_others(server, gate):
    mistaken = [server.post(STEPS) for _ in range(4)]
    server.reaches(server.post(INSTANT)["id"], "succeeded")
    gate.touch()
    for job in mistaken:
        server.reaches(job["id"], "succeeded")


@pytest.mark.slow
@pytest.mark.campaign
def test_a_batch_whose_samples_turn_out_to_be_long_does_not_block_others(server, gate):
    body = {"problem": PROBLEM, "vary": [{"field": "/seed", "values": [STEPS] * 6}], "reuse": False}
    place = server.client.post("/v1/batches", json=body).raise_for_status().headers["location"]
    for client in (server.guest, server.client):
        assert post(client).json()["status"] == "succeeded"
    assert server.client.get(place).json()["done"] == 0
    gate.touch()
    ended = until(lambda: (now := server.client.get(place).json())["finished_at"] and now, REACHED_S, "the end")
    assert (ended["status"], ended["succeeded"]) == ("succeeded", 6)


@pytest.mark.slow
@pytest.mark.campaign
def test_a_flood_of_one_tenant_leaves_a_worker_to_the_others(server, gate):
    (server.folder / "patient").touch()  # nobody finds out that these are not short
    flood = [server.post(GATED)["id"] for _ in range(5)]
    until(lambda: len(server.client.get("/v1/jobs?status=running").json()["jobs"]) == 2, SOON_S, "two jobs running")
    for _ in range(3):
        assert post(server.guest).json()["status"] == "succeeded"
    statuses = [server.job(job_id)["status"] for job_id in flood]
    assert sorted(statuses) == ["queued"] * 3 + ["running"] * 2
    gate.touch()
    for job_id in flood:
        server.reaches(job_id, "succeeded")


@pytest.mark.slow
@pytest.mark.embedded
@pytest.mark.campaign
def test_a_cancelled_job_that_reports_progress_costs_no_worker(server, gate):
    def cancelled_attempts():
        return server.sample("mechsynth_job_attempts_total", outcome="cancelled")

    workers, cancelled_before = server.workers(), cancelled_attempts()
    job = server.post(STEPS, problem=LONG)
    until(lambda: server.job(job["id"])["progress"]["message"] == "a quarter", SOON_S, "progress")
    assert server.client.delete(f"/v1/jobs/{job['id']}").json()["status"] == "cancelled"
    until(lambda: cancelled_attempts() > cancelled_before, SOON_S, "the end")
    assert server.post(INSTANT, wait=20)["status"] == "succeeded"
    assert server.workers() == workers


@pytest.mark.slow
@pytest.mark.campaign
def test_a_short_job_is_done_while_workers_are_killed_by_cancels(server, gate):
    """Two clients post what cannot be stopped but by killing its worker, and cancel it as soon as it runs."""
    done = threading.Event()
    cancelled = []

    def storm():
        while not done.is_set():
            job_id = server.post(NATIVE, problem=LONG)["id"]
            until(lambda job_id=job_id: done.is_set() or server.job(job_id)["status"] == "running", 60.0, "it running")
            server.client.delete(f"/v1/jobs/{job_id}")
            cancelled.append(job_id)

    clients = [threading.Thread(target=storm) for _ in range(2)]
    for client in clients:
        client.start()
    took = []
    try:
        for turn in range(10):
            began = time.monotonic()
            assert server.post(INSTANT, wait=20)["status"] == "succeeded"
            took.append(time.monotonic() - began)
            if turn % 2:  # of two jobs one follows upon a kill, the other is right behind it
                before = len(cancelled)
                until(lambda before=before: len(cancelled) > before, 60.0, "another worker killed")
    finally:
        done.set()
        for client in clients:
            client.join()
    print(f"short jobs beside a storm of cancels: {max(took):.2f} s at most")
    assert max(took) < 5.0  # a worker that has to be started first takes longer, on a busy machine by far
