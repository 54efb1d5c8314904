"""Who has analyses and drawings made for requests: two pools of processes, forked from one that is warmed up."""

from __future__ import annotations

import asyncio
import gc
import multiprocessing
import os
import threading
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from service.answers import process
from service.jobs.processes.parent_death import tell_children
from service.jobs.processes.request_pool import Busy, Limits, PoolMetrics, RequestPool
from service.observability.logs import Format

TEMPLATE = "service.answers.template"
"""The module that the process has imported that others are forked from."""

CPU_S = 4.0
"""Processor time of an analysis at most, seconds. No honest one has been seen to take half of that."""

SHORT_S = 0.25
"""Processor time after which a call is long: nine in ten analyses take less than a tenth of it."""

WALL_S = 60.0
"""How long an analysis may take by the clock, on however busy a machine."""

WAIT_S = 10.0
"""How long an analysis waits for its turn: it takes milliseconds where not all processes are busy."""

LOAD_WAIT_S = 45.0
"""How long an analysis waits for the core to be loaded: five seconds on a quiet machine, once."""

DRAWING_CPU_S, DRAWING_WALL_S = 30.0, 60.0
"""The same of drawings, animations, reports and simulations; a report shows twenty designs in full."""

MEMORY_MB = 768
"""Memory of a call beyond what its idle process has, MiB."""

HANDS, MAX_LONG = 4, 2
"""Analyses, or drawings, that run at once, and long ones of these."""

_PERIOD_S = 0.02
"""Period at which it is looked whether the template may be loaded, which tells nobody."""


class AnswerDesk:
    """Has functions of :mod:`service.answers` called. To be used on one event loop only.

    The kernels of the analysis core may have to be compiled first; until then analyses wait.
    """

    def __init__(self, log_level: str, log_format: Format, metrics: PoolMetrics | None = None) -> None:
        settings = log_level, log_format, MEMORY_MB
        self._loaded, self._stopping = threading.Event(), threading.Event()
        self._asked = 0
        self._analyses = RequestPool(
            "analyses", process.prepare, settings, Limits(WALL_S, CPU_S, SHORT_S),
            hands=HANDS, max_long=MAX_LONG, wait_s=WAIT_S, forks=self._loaded.is_set, metrics=metrics,
        )  # fmt: skip
        self._drawings = RequestPool(
            "drawings", process.prepare, settings, Limits(DRAWING_WALL_S, DRAWING_CPU_S),
            hands=MAX_LONG, forks=self._loaded.is_set, metrics=metrics,
        )  # fmt: skip

    def start(self, after: Callable[[], bool]) -> None:
        """Load the template once ``after`` says so, when its kernels have been compiled or must be; returns at once."""
        threading.Thread(target=self._load, args=(after,), name="answers", daemon=True).start()

    def stop(self) -> None:
        """End the processes."""
        self._stopping.set()
        for pool in (self._analyses, self._drawings):
            pool.stop()

    @property
    def is_awaited(self) -> bool:
        """Whether somebody waits for the core to be loaded."""
        return self._asked > 0

    @property
    def loaded(self) -> bool:
        """Whether analyses are begun at once."""
        return self._loaded.is_set()

    def counts(self) -> Mapping[str, Mapping[str, int]]:
        """Calls by pool and state, for the metrics."""
        return {pool.name: pool.counts() for pool in (self._analyses, self._drawings)}

    async def analyse(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., Any], *args: Any
    ) -> Any:
        """Call a function that answers with an analysis.

        Raises
        ------
        Busy, GivenUp, Gone, Lost
            As :meth:`service.jobs.processes.request_pool.RequestPool.call`, and ``Busy`` while kernels are compiled.
        """
        await self._wait_until_loaded()
        return await self._analyses.call(gone, tenant, work, *args)

    async def draw(self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., Any], *args: Any) -> Any:
        """Call a function that draws, reports or exports; errors as of :meth:`analyse`."""
        return await self._drawings.call(gone, tenant, work, *args)

    async def _wait_until_loaded(self) -> None:
        self._asked += 1
        latest = time.monotonic() + LOAD_WAIT_S
        try:
            while not self._loaded.is_set():
                if time.monotonic() > latest:
                    raise Busy
                await asyncio.sleep(_PERIOD_S)
        finally:
            self._asked -= 1

    def _load(self, after: Callable[[], bool]) -> None:
        while not after():
            if self._stopping.wait(_PERIOD_S):
                return
        tell_children()
        multiprocessing.set_forkserver_preload([TEMPLATE])
        # The first process is there when the template is loaded; the others follow within a tenth of a second.
        context = multiprocessing.get_context("forkserver")
        first = context.Process(target=os.getpid, name="answers", daemon=True)
        first.start()
        first.join()
        # All that is imported by now stays; see service.server.web.
        gc.freeze()
        if not self._stopping.is_set():
            self._loaded.set()
            self._analyses.begin()
