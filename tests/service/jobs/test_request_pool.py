"""Pools of processes: one ends where it must, requests for the same wait for one call, and tenants have their turns."""

from __future__ import annotations

import asyncio
import math
import operator
import os
import signal
import time
from typing import Any

import pytest

from service.jobs.processes.request_pool import (
    Busy,
    ClientGone,
    GivenUp,
    Limits,
    ProcessLost,
    ProcessStart,
    RequestPool,
)
from service.jobs.processes.request_queue import Call, RequestQueue
from tests.support.service.request_pool import never


async def at_once() -> bool:
    """A client that has gone."""
    return True


class Awkward(Exception):
    """One that no pipe brings back."""

    def __init__(self, what: str, count: int) -> None:
        super().__init__(what)
        self.count = count


def raises_awkwardly() -> None:
    raise Awkward("a broken wheel", 3)


@pytest.fixture
def pool() -> Any:
    """Of a process that starts at once, as it loads nothing."""
    made = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), Limits(1.0))
    yield made
    made.stop()


def test_a_call_that_is_left_or_takes_too_long_ends_its_process(pool: RequestPool) -> None:
    async def all_of_it() -> None:
        assert await pool.call(never, "acme", math.hypot, 3.0, 4.0) == 5.0
        began = time.monotonic()
        with pytest.raises(ClientGone):
            await pool.call(at_once, "acme", time.sleep, 30.0)
        with pytest.raises(GivenUp, match="time"):
            await pool.call(never, "acme", time.sleep, 30.0)
        assert await pool.call(never, "acme", math.hypot, 3.0, 4.0) == 5.0
        assert time.monotonic() - began < 25.0
        with pytest.raises(ZeroDivisionError):
            await pool.call(never, "acme", operator.truediv, 1.0, 0.0)
        with pytest.raises(RuntimeError, match="no running event loop"):  # a defect is not told as too slow
            await pool.call(never, "acme", asyncio.get_running_loop)
        pid = await pool.call(never, "acme", os.getpid)
        with pytest.raises(GivenUp, match="memory"):  # as native code ends that gets none
            await pool.call(never, "acme", os.abort)
        assert await pool.call(never, "acme", os.getpid) != pid

    asyncio.run(all_of_it())


def test_what_no_pipe_carries_is_raised_by_its_words_and_not_taken_for_a_lack_of_memory() -> None:
    made = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), Limits(20.0))

    async def all_of_it() -> None:
        with pytest.raises(RuntimeError, match="Awkward: a broken wheel"):
            await made.call(never, "acme", raises_awkwardly)

    try:
        asyncio.run(all_of_it())
    finally:
        made.stop()


def test_a_process_that_dies_idle_is_replaced(pool: RequestPool) -> None:
    async def all_of_it() -> None:
        pid = await pool.call(never, "acme", os.getpid)
        os.kill(pid, signal.SIGKILL)
        assert await pool.call(never, "acme", math.hypot, 3.0, 4.0) == 5.0

    asyncio.run(all_of_it())


def test_requests_for_the_same_wait_for_one_call_until_the_last_has_gone(pool: RequestPool) -> None:
    async def all_of_it() -> None:
        one, other = await asyncio.gather(*(pool.call(never, "acme", os.urandom, 9) for _ in range(2)))
        assert one == other
        assert await pool.call(never, "acme", os.urandom, 9) != one  # nothing is kept here

        pid = await pool.call(never, "acme", os.getpid)
        left, had = await asyncio.gather(
            pool.call(at_once, "acme", time.sleep, 0.6),
            pool.call(never, "acme", time.sleep, 0.6),
            return_exceptions=True,
        )
        assert isinstance(left, ClientGone)
        assert had is None
        assert await pool.call(never, "acme", os.getpid) == pid

        both = await asyncio.gather(
            *(pool.call(at_once, "acme", time.sleep, 0.9) for _ in range(2)), return_exceptions=True
        )
        assert [type(one) for one in both] == [ClientGone, ClientGone]
        assert await pool.call(never, "acme", os.getpid) != pid

    asyncio.run(all_of_it())


def _no_process(*_settings: Any) -> None:
    raise ImportError("a library is missing")


def test_a_process_that_cannot_start_is_no_fault_of_the_call() -> None:
    pool = RequestPool("pool", ProcessStart(_no_process, (0,)), Limits(1.0))
    try:
        with pytest.raises(ProcessLost):
            asyncio.run(pool.call(never, "acme", math.hypot, 3.0, 4.0))
    finally:
        pool.stop()


def spin(seconds: float) -> float:
    """Take so much processor time."""
    until = time.process_time() + seconds
    while time.process_time() < until:
        pass
    return seconds


@pytest.mark.slow
def test_long_calls_leave_a_process_to_short_ones() -> None:
    """Four tenants post what takes all the time that there is; a fifth one is answered all the same."""
    limits = Limits(wall_s=90.0, cpu_s=1.5, short_s=0.2)
    pool = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), limits, hands=3, max_long=1, wait_s=60.0)

    async def all_of_it() -> None:
        await asyncio.gather(*(pool.call(never, f"warm-{n}", math.hypot, 1.0, n) for n in range(6)))
        heavy = [asyncio.ensure_future(pool.call(never, f"tenant-{n % 4}", spin, 30.0 + n)) for n in range(8)]
        async with asyncio.timeout(60.0):  # processes that take the place of killed ones are started anew here
            while pool.count_calls()["running_long"] == 0:
                await asyncio.sleep(0.05)
        assert await pool.call(never, "fifth", math.hypot, 3.0, 4.0) == 5.0
        assert pool.count_calls()["running_long"] <= 1
        for task in heavy:
            task.cancel()
        await asyncio.gather(*heavy, return_exceptions=True)

    try:
        asyncio.run(all_of_it())
    finally:
        pool.stop()


@pytest.mark.slow
def test_processor_time_is_bounded_and_a_long_call_that_waited_is_done() -> None:
    limits = Limits(wall_s=90.0, cpu_s=1.0, short_s=0.1)
    pool = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), limits, hands=2, max_long=1)

    async def all_of_it() -> None:
        with pytest.raises(GivenUp, match="time"):
            await pool.call(never, "acme", spin, 30.0)
        both = await asyncio.gather(*(pool.call(never, "acme", spin, 0.5 + 0.1 * n) for n in range(2)))
        assert both == [0.5, 0.6]

    try:
        asyncio.run(all_of_it())
    finally:
        pool.stop()


def test_who_is_not_begun_in_time_is_told_so() -> None:
    pool = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), Limits(20.0), wait_s=0.5)

    async def all_of_it() -> None:
        assert await pool.call(never, "acme", math.hypot, 3.0, 4.0) == 5.0
        first = asyncio.ensure_future(pool.call(never, "acme", time.sleep, 3.0))
        await asyncio.sleep(0.1)
        with pytest.raises(Busy):
            await pool.call(never, "other", math.hypot, 3.0, 4.0)
        await first

    try:
        asyncio.run(all_of_it())
    finally:
        pool.stop()


def test_tenants_have_their_turns() -> None:
    queue = RequestQueue(max_long=1)
    for tenant, n in (("flood", 1), ("flood", 2), ("flood", 3), ("other", 4)):
        queue.add(Call(math.hypot, (n,), tenant))
    assert [queue.take(0.0).args[0] for _ in range(4)] == [1, 4, 2, 3]  # type: ignore[union-attr]
    assert queue.take(0.0) is None


def test_an_answer_of_bytes_and_what_no_future_takes() -> None:
    pool = RequestPool("pool", ProcessStart(operator.itemgetter, (0,)), Limits(20.0))

    async def all_of_it() -> None:
        assert len(await pool.call(never, "acme", bytes, 5_000_000)) == 5_000_000
        with pytest.raises(RuntimeError, match="StopIteration"):
            await pool.call(never, "acme", next, _Empty())

    try:
        asyncio.run(all_of_it())
    finally:
        pool.stop()


class _Empty:
    """An iterator that goes through a pipe and has nothing."""

    def __next__(self) -> Any:
        raise StopIteration
