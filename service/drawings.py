"""Drawings, animations and reports are made in the server's own process, a few at a time.

They take from a hundredth of a second to a few seconds, most of it with the interpreter held. Without a bound, some
dozens that are asked for at once would take all threads, and whoever reads a job would wait for them.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from starlette.concurrency import run_in_threadpool

MAX_AT_ONCE = 2
"""Drawings that are made at once; more of them would be ready no sooner."""

MAX_WAIT_S = 20.0
"""How long a drawing waits for its turn."""

P = ParamSpec("P")
T = TypeVar("T")


class Busy(Exception):
    """Other drawings have kept this one from being begun in time."""


class Drawings:
    """Has drawings made, each in its turn. To be used on one event loop only."""

    def __init__(self) -> None:
        self._turn = asyncio.Semaphore(MAX_AT_ONCE)

    async def call(self, draw: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call ``draw`` in a thread when its turn has come; what it raises is raised here.

        Raises
        ------
        Busy
            After :data:`MAX_WAIT_S`.
        """
        try:
            async with asyncio.timeout(MAX_WAIT_S):
                await self._turn.acquire()
        except TimeoutError:
            raise Busy from None
        try:
            return await run_in_threadpool(draw, *args, **kwargs)
        finally:
            self._turn.release()
