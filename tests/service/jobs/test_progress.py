"""What a worker stores of its progress: the newest report, whatever the store raises."""

import threading

import pytest
from sqlalchemy.exc import OperationalError

from service.jobs.workers.progress_writer import ProgressWriter
from tests.support.service.running import SOON_S, until


class Store:
    """Takes progress, or raises what it is to raise first."""

    def __init__(self):
        self.told, self.to_raise = [], []
        self.is_open = threading.Event()
        self.is_open.set()

    def record_progress(self, *report):
        self.is_open.wait()
        if self.to_raise:
            raise self.to_raise.pop()
        self.told.append(report)


@pytest.fixture
def store():
    return Store()


def test_the_last_report_is_told(store):
    with ProgressWriter(store).track_attempt("job", 1) as progress:
        for n in range(1000):
            progress(n / 1000.0, f"{n}")
        until(lambda: store.told, SOON_S, "the report")
    assert store.told[-1] == ("job", 1, 0.999, "999")
    assert len(store.told) <= 2


def test_a_report_waits_for_a_store_that_is_out_of_reach(store):
    store.to_raise = [OperationalError("update", {}, Exception("locked")) for _ in range(3)]
    with ProgressWriter(store).track_attempt("job", 1) as progress:
        progress(0.5, "half")
        until(lambda: store.told, SOON_S, "the report")
    assert store.told == [("job", 1, 0.5, "half")]


def test_a_newer_report_is_told_instead_of_one_that_could_not_be(store):
    store.is_open.clear()
    store.to_raise = [OperationalError("update", {}, Exception("locked"))]
    with ProgressWriter(store).track_attempt("job", 1) as progress:
        progress(0.5, "half")
        progress(0.6, "more")
        store.is_open.set()
        until(lambda: store.told, SOON_S, "the report")
    assert store.told[-1] == ("job", 1, 0.6, "more")


@pytest.mark.parametrize("error", [MemoryError(), TypeError("a defect")], ids=["memory", "defect"])
def test_whatever_the_store_raises_later_jobs_are_told_of(store, error):
    writer = ProgressWriter(store)
    store.to_raise = [error]
    with writer.track_attempt("first", 1) as progress:
        progress(0.5, "half")
        until(lambda: not store.to_raise, SOON_S, "the error")
    with writer.track_attempt("second", 1) as progress:
        progress(0.25, "a quarter")
        until(lambda: store.told, SOON_S, "the report")
    assert store.told == [("second", 1, 0.25, "a quarter")]


def test_what_was_not_told_of_a_job_that_has_ended_is_not_told_of_the_next(store):
    writer = ProgressWriter(store)
    store.is_open.clear()
    store.to_raise = [OperationalError("update", {}, Exception("locked"))]
    with writer.track_attempt("first", 1) as progress:
        progress(0.5, "half")
    with writer.track_attempt("second", 1) as progress:
        store.is_open.set()
        progress(0.25, "a quarter")
        until(lambda: store.told, SOON_S, "the report")
    assert store.told == [("second", 1, 0.25, "a quarter")]
