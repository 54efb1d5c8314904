"""Errands: the process that does them ends where it must, and requests for the same wait for one errand."""

from __future__ import annotations

import asyncio
import math
import operator
import os
import signal
import time
from typing import Any

import pytest

from service.jobs.errands import Errands, GivenUp, Gone, Lost
from tests.support.service.errands import never


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
def errands() -> Any:
    """Of a process that starts at once, as it loads nothing."""
    made = Errands("errands", operator.itemgetter, (0,), limit_s=1.0)
    yield made
    made.stop()


def test_an_errand_that_is_left_or_takes_too_long_ends_its_process(errands: Errands) -> None:
    async def all_of_it() -> None:
        assert await errands.call(never, math.hypot, 3.0, 4.0) == 5.0
        began = time.monotonic()
        with pytest.raises(Gone):
            await errands.call(at_once, time.sleep, 30.0)
        with pytest.raises(GivenUp, match="time"):
            await errands.call(never, time.sleep, 30.0)
        assert await errands.call(never, math.hypot, 3.0, 4.0) == 5.0
        assert time.monotonic() - began < 25.0
        with pytest.raises(ZeroDivisionError):
            await errands.call(never, operator.truediv, 1.0, 0.0)
        with pytest.raises(RuntimeError, match="no running event loop"):  # a defect is not told as too slow
            await errands.call(never, asyncio.get_running_loop)
        pid = await errands.call(never, os.getpid)
        with pytest.raises(GivenUp, match="memory"):  # as native code ends that gets none
            await errands.call(never, os.abort)
        assert await errands.call(never, os.getpid) != pid

    asyncio.run(all_of_it())


def test_what_no_pipe_carries_is_raised_by_its_words_and_not_taken_for_a_lack_of_memory() -> None:
    made = Errands("errands", operator.itemgetter, (0,), limit_s=20.0)

    async def all_of_it() -> None:
        with pytest.raises(RuntimeError, match="Awkward: a broken wheel"):
            await made.call(never, raises_awkwardly)

    try:
        asyncio.run(all_of_it())
    finally:
        made.stop()


def test_a_process_that_dies_idle_is_replaced(errands: Errands) -> None:
    async def all_of_it() -> None:
        pid = await errands.call(never, os.getpid)
        os.kill(pid, signal.SIGKILL)
        assert await errands.call(never, math.hypot, 3.0, 4.0) == 5.0

    asyncio.run(all_of_it())


def test_requests_for_the_same_wait_for_one_errand_until_the_last_has_gone(errands: Errands) -> None:
    async def all_of_it() -> None:
        one, other = await asyncio.gather(*(errands.call(never, os.urandom, 9) for _ in range(2)))
        assert one == other
        assert await errands.call(never, os.urandom, 9) != one  # nothing is kept here

        pid = await errands.call(never, os.getpid)
        left, had = await asyncio.gather(
            errands.call(at_once, time.sleep, 0.6), errands.call(never, time.sleep, 0.6), return_exceptions=True
        )
        assert isinstance(left, Gone)
        assert had is None
        assert await errands.call(never, os.getpid) == pid

        both = await asyncio.gather(*(errands.call(at_once, time.sleep, 0.9) for _ in range(2)), return_exceptions=True)
        assert [type(one) for one in both] == [Gone, Gone]
        assert await errands.call(never, os.getpid) != pid

    asyncio.run(all_of_it())


def _no_process(*_settings: Any) -> None:
    raise ImportError("a library is missing")


def test_a_process_that_cannot_start_is_no_fault_of_the_errand() -> None:
    errands = Errands("errands", _no_process, (0,), limit_s=1.0)
    try:
        with pytest.raises(Lost):
            asyncio.run(errands.call(never, math.hypot, 3.0, 4.0))
    finally:
        errands.stop()
