"""The threads that analyses run in: nobody waits for ever, and the service can stop whatever they do."""

import asyncio
import threading

import pytest

from service import analyst
from service.analyst import THREADS, Analyst, Busy, TooLong


@pytest.fixture
def ready(monkeypatch):
    monkeypatch.setattr(analyst, "warm_up", lambda: None)
    monkeypatch.setattr(analyst.gc, "freeze", lambda: None)
    made = Analyst()
    made.start(after=lambda: True)
    return made


def test_what_is_returned_or_raised_comes_back(ready):
    assert asyncio.run(ready.call(divmod, 7, 2)) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        asyncio.run(ready.call(divmod, 7, 0))
    assert asyncio.run(ready.call(divmod, 9, 2)) == (4, 1), "the threads live on"


def test_nobody_waits_for_ever(ready, monkeypatch):
    monkeypatch.setattr(analyst, "MAX_ANALYSIS_S", 0.2)
    end, begun = threading.Event(), threading.Semaphore(0)

    def work():
        begun.release()
        end.wait()

    async def ask():
        under_way = [asyncio.ensure_future(ready.call(work)) for _ in range(THREADS)]
        for _ in range(THREADS):
            assert await asyncio.to_thread(begun.acquire, timeout=10)
        waiting = asyncio.ensure_future(ready.call(end.wait))
        return await asyncio.gather(*under_way, waiting, return_exceptions=True)

    found = asyncio.run(ask())
    assert [type(error) for error in found] == [TooLong] * THREADS + [Busy]
    end.set()
    monkeypatch.undo()
    assert asyncio.run(ready.call(divmod, 7, 2)) == (3, 1)


def test_a_core_that_cannot_be_warmed_up_holds_nobody_up(ready, monkeypatch):
    def broken():
        raise RuntimeError("told not to")

    monkeypatch.setattr(analyst, "warm_up", broken)
    other = Analyst()
    other.start(after=lambda: True)
    assert asyncio.run(other.call(divmod, 7, 2)) == (3, 1)


def test_the_core_is_loaded_once_its_kernels_are_compiled(ready, monkeypatch):
    compiled, loaded = threading.Event(), threading.Event()
    monkeypatch.setattr(analyst, "warm_up", loaded.set)
    other = Analyst()
    other.start(after=compiled.is_set)
    assert not loaded.wait(0.1)
    assert not other.loaded
    compiled.set()
    assert asyncio.run(other.call(divmod, 7, 2)) == (3, 1)
    assert other.loaded
