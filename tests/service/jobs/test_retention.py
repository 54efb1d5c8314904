"""What is lost is ended, and what is old is removed, whatever fails beside it."""

import asyncio
import time
from types import SimpleNamespace

import pytest

from service.jobs import retention
from service.jobs.retention import keep_tidy

DAY_S = 86_400.0


class Stores:
    """Both stores: each step notes what it was asked for, and fails where it is to."""

    def __init__(self, fails=(), old=None):
        self.done, self.fails, self.old = [], fails, old or {}

    def of(self, name):
        def delete_finished(before, at_most=None):
            self.step(name)
            age_s = time.time() - before.timestamp()
            assert abs(age_s - 2 * DAY_S) < 60.0
            gone = min(self.old.get(name, 0), 1 if at_most is None else at_most)
            self.old[name] = self.old.get(name, 0) - gone
            return gone

        return SimpleNamespace(delete_finished=delete_finished, tidy=lambda: self.step("tidy"))

    def step(self, name):
        self.done.append(name)
        if name in self.fails:
            raise RuntimeError(name)
        return 0


def tidied(monkeypatch, stores, days):
    """One round, and the seconds to the next one; how often the jobs at hand were forgotten."""
    removals, rounds = [], []

    async def sleep(seconds):
        if seconds != retention._PAUSE_S:
            rounds.append(seconds)
            raise asyncio.CancelledError

    monkeypatch.setattr(retention.asyncio, "sleep", sleep)
    finished = SimpleNamespace(note_removal=lambda: removals.append(1))
    with pytest.raises(asyncio.CancelledError):
        asyncio.run(keep_tidy(stores.of("jobs"), stores.of("batches"), finished, days))
    return rounds[0], len(removals)


def test_what_is_old_is_removed_portion_by_portion(monkeypatch):
    stores = Stores(old={"jobs": 2 * retention.MAX_REMOVED_AT_ONCE + 1, "batches": 3})
    assert tidied(monkeypatch, stores, 2.0) == (retention.MAX_PERIOD_S, 6)
    assert stores.old == {"jobs": 0, "batches": 0}


@pytest.mark.slow
@pytest.mark.parametrize("fails", [(), ("tidy",), ("jobs",), ("batches",), ("tidy", "jobs", "batches")])
def test_what_fails_stands_in_nothing_elses_way(monkeypatch, fails):
    stores = Stores(fails)
    tidied(monkeypatch, stores, 2.0)
    assert stores.done == ["tidy", "jobs", "batches"]


def test_what_was_lost_is_ended_also_where_all_is_kept(monkeypatch):
    stores = Stores()
    assert tidied(monkeypatch, stores, None) == (retention.MAX_PERIOD_S, 0)
    assert stores.done == ["tidy"]
