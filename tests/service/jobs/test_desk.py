"""Whoever waits for a job learns of its end, whenever that comes."""

import asyncio
import time

import pytest

from service.jobs.desk import JobDesk
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


@pytest.fixture
def store(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite'}", durable=True)
    upgrade(engine)
    yield QuickLane(engine)
    engine.dispose()


def test_a_job_that_ends_before_it_is_watched_is_answered_at_once(store):
    async def accepted():
        notifier = ChangeNotifier(asyncio.get_running_loop())
        desk = JobDesk(store, NobodyHere(), notifier, Metrics(), 10, FinishedJobs(0))
        return await desk.accept(
            tenant="", kind="motion", label=None, problem="{}", cost=Cost.SHORT, wait_s=20.0, repeatable=None
        )

    began = time.monotonic()
    assert asyncio.run(accepted()).status is Status.SUCCEEDED
    assert time.monotonic() - began < 10.0, "the end was not noticed before the wait was over"
