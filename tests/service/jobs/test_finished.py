"""Finished jobs at hand: only such as are finished, no more than there is room for, and none that was removed."""

from service.jobs.store.finished_cache import FinishedJobs
from service.jobs.store.schema import JobRow
from service.jobs.store.states import Status

CAPACITY = 100_000


def job(name, size=0, status=Status.SUCCEEDED):
    return JobRow(
        id=name, tenant="", kind="motion", label=None, status=status, created_at="", started_at=None, finished_at="",
        progress_fraction=1.0, progress_message="", attempt=1, crashes=0, revision=3, problem="{}", result="x" * size,
        error=None,
    )  # fmt: skip


def test_a_finished_job_is_at_hand():
    jobs = FinishedJobs(CAPACITY)
    jobs.keep(job("a"), jobs.removals)
    assert jobs.get("a") == job("a")
    assert jobs.get("b") is None


def test_an_unfinished_job_is_not_kept():
    jobs = FinishedJobs(CAPACITY)
    for status in (Status.QUEUED, Status.RUNNING):
        jobs.keep(job("a", status=status), jobs.removals)
        assert jobs.get("a") is None


def test_those_that_nobody_asks_for_make_room():
    jobs = FinishedJobs(CAPACITY)
    for n in range(50):
        jobs.keep(job(f"{n}", 9_000), jobs.removals)
        assert jobs.get("0") is not None
    assert jobs.get("1") is None
    assert [n for n in range(50) if jobs.get(f"{n}")] == [0, *range(42, 50)]


def test_the_same_job_is_kept_once():
    jobs = FinishedJobs(CAPACITY)
    for _ in range(50):
        jobs.keep(job("a", 9_000), jobs.removals)
    jobs.keep(job("b", 9_000), jobs.removals)
    assert jobs.get("a") is not None


def test_a_job_that_would_push_out_all_others_is_not_kept():
    jobs = FinishedJobs(CAPACITY)
    jobs.keep(job("small"), jobs.removals)
    jobs.keep(job("large", CAPACITY // 4), jobs.removals)
    assert jobs.get("large") is None
    assert jobs.get("small") is not None


def test_a_removed_job_is_gone():
    jobs = FinishedJobs(CAPACITY)
    jobs.keep(job("a"), jobs.removals)
    jobs.keep(job("b"), jobs.removals)
    jobs.note_removal("a")
    assert jobs.get("a") is None
    assert jobs.get("b") is not None
    jobs.note_removal()
    assert jobs.get("b") is None


def test_a_job_that_was_read_before_a_removal_is_not_kept_after_it():
    jobs = FinishedJobs(CAPACITY)
    for removed in ("a", None):
        before = jobs.removals
        jobs.note_removal(removed)
        jobs.keep(job("a"), before)
        assert jobs.get("a") is None


def test_without_room_nothing_is_kept():
    jobs = FinishedJobs(0)
    jobs.keep(job("a"), jobs.removals)
    assert jobs.get("a") is None
