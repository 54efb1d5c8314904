"""Whoever waits for a job learns of its end, whenever that comes."""

import asyncio
import threading
import time

import pytest
from sqlalchemy.exc import OperationalError

from service.jobs.desk import POLL_PERIOD_S, JobDesk
from service.jobs.events.notifier import ChangeNotifier
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, upgrade
from service.jobs.store.finished_cache import FinishedJobs
from service.jobs.store.states import Cost, Status
from service.observability.metrics import Metrics


class QuickLane(JobStore):
    """A store beside which a lane is free, of another host: it finds each job at once, and has soon done it."""

    def create(self, **stated):
        job = super().create(**stated)
        claim = self.take("another host", [Cost.SHORT])
        assert claim.job_id == job.id
        assert self.complete(job.id, claim.attempt, "{}")
        return job


class NobodyHere:
    """This host runs nothing, and hears of nothing."""

    def submit(self, job_id):
        pass


class SlowLane(JobStore):
    """A store beside which another host does each job, a while after it was stored."""

    def create(self, **stated):
        job = super().create(**stated)
        threading.Timer(0.3, self.do).start()
        return job

    def do(self):
        claim = self.take("another host", [Cost.SHORT])
        assert self.complete(claim.job_id, claim.attempt, "{}")
        self.done_at = time.monotonic()


@pytest.fixture
def store(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite'}", durable=True)
    upgrade(engine)
    yield QuickLane(engine)
    engine.dispose()


async def accepted(store):
    notifier = ChangeNotifier(asyncio.get_running_loop())
    desk = JobDesk(store, NobodyHere(), notifier, Metrics(), 10, FinishedJobs(0))
    return await desk.accept(
        tenant="", kind="motion", label=None, problem="{}", cost=Cost.SHORT, wait_s=20.0, repeatable=None
    )


def test_a_job_that_ends_before_it_is_watched_is_answered_at_once(store):
    began = time.monotonic()
    assert asyncio.run(accepted(store)).status is Status.SUCCEEDED
    assert time.monotonic() - began < 10.0, "the end was not noticed before the wait was over"


def test_an_end_of_which_the_notification_is_lost_is_answered(store):
    store = SlowLane(store._engine)
    assert asyncio.run(accepted(store)).status is Status.SUCCEEDED
    assert time.monotonic() - store.done_at < POLL_PERIOD_S + 0.5


def test_who_waits_while_the_store_is_away_is_answered_when_it_is_back(store):
    store = SlowLane(store._engine)
    get, failures = store.get, iter([OperationalError("SELECT", {}, Exception("connection refused"))] * 2)

    def get_or_fail(job_id):
        if hasattr(store, "done_at") and (failure := next(failures, None)):
            raise failure
        return get(job_id)

    store.get = get_or_fail
    assert asyncio.run(accepted(store)).status is Status.SUCCEEDED
    assert next(failures, None) is None
