"""The answer desk: analyses and drawings for requests, by two pools of processes forked from a warmed-up one."""

from __future__ import annotations

import asyncio
import gc
import multiprocessing
import os
import threading
import time
from collections.abc import Awaitable, Callable, Mapping
from typing import TypeVar

from service.answers import process
from service.jobs.processes.parent_death import export_parent_pid
from service.jobs.processes.request_pool import Busy, Limits, PoolMetrics, ProcessStart, RequestPool
from service.observability.logs import Format

T = TypeVar("T")

TEMPLATE_MODULE = "service.answers.template"
"""Module imported by the process from which the others are forked."""

CPU_S = 4.0
"""Maximum processor time of an analysis, seconds; at least twice that of any legitimate analysis seen so far."""

SHORT_S = 0.25
"""Processor time after which a call is long, seconds; nine in ten analyses take less than a tenth of it."""

WALL_S = 60.0
"""Maximum duration of an analysis, seconds, generous for a busy machine."""

WAIT_S = 10.0
"""Time that an analysis waits for its turn, seconds; milliseconds suffice unless all processes are busy."""

LOAD_WAIT_S = 45.0
"""Time that an analysis waits for the core to be loaded, seconds; it takes five seconds, once, on an idle machine."""

DRAWING_CPU_S, DRAWING_WALL_S = 30.0, 60.0
"""Maximum processor time and duration of a drawing, animation, report or simulation, seconds. A report shows up to 20
designs in full, which takes longest."""

MEMORY_MB = 768
"""Memory of a call beyond that of its idle process, MiB."""

HANDS, MAX_LONG = 4, 2
"""Maximum numbers of concurrent analyses, and of long ones among them."""

_PERIOD_S = 0.02
"""Period of the check whether the template may be loaded, seconds; no event announces it."""


class AnswerDesk:
    """Executes functions of :mod:`service.answers` in processes. For use on one event loop only.

    The kernels of the analysis core may have to be compiled first; analyses wait for that.
    """

    def __init__(self, log_level: str, log_format: Format, metrics: PoolMetrics | None = None) -> None:
        self._loaded, self._stopping = threading.Event(), threading.Event()
        self._asked = 0
        start = ProcessStart(process.prepare, (log_level, log_format, MEMORY_MB), forks=self._loaded.is_set)
        self._analyses = RequestPool(
            "analyses", start, Limits(WALL_S, CPU_S, SHORT_S),
            hands=HANDS, max_long=MAX_LONG, wait_s=WAIT_S, metrics=metrics,
        )  # fmt: skip
        self._drawings = RequestPool(
            "drawings", start, Limits(DRAWING_WALL_S, DRAWING_CPU_S), hands=MAX_LONG, metrics=metrics,
        )  # fmt: skip

    def start(self, after: Callable[[], bool]) -> None:
        """Load the template in the background as soon as ``after`` returns true.

        ``after`` returns true once the kernels of the template are compiled, or once the compilation has ended without
        them and a request waits; the template then compiles them itself.
        """
        threading.Thread(target=self._load, args=(after,), name="answers", daemon=True).start()

    def stop(self) -> None:
        """End the processes."""
        self._stopping.set()
        for pool in (self._analyses, self._drawings):
            pool.stop()

    @property
    def is_awaited(self) -> bool:
        """Whether a request waits for the core to be loaded."""
        return self._asked > 0

    @property
    def is_loaded(self) -> bool:
        """Whether the core is loaded, so that analyses start at once."""
        return self._loaded.is_set()

    def count_calls(self) -> Mapping[str, Mapping[str, int]]:
        """Return the number of calls by pool and state, for the metrics."""
        return {pool.name: pool.count_calls() for pool in (self._analyses, self._drawings)}

    async def analyse(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., T], *args: object
    ) -> T:
        """Call a function that returns an analysis.

        Raises
        ------
        Busy, GivenUp, ClientGone, ProcessLost
            As :meth:`service.jobs.processes.request_pool.RequestPool.call`, and ``Busy`` while kernels are compiled.
        """
        await self._wait_until_loaded()
        return await self._analyses.call(gone, tenant, work, *args)

    async def draw(self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., T], *args: object) -> T:
        """Call a function that draws, reports or exports; errors as for :meth:`analyse`."""
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
        export_parent_pid()
        multiprocessing.set_forkserver_preload([TEMPLATE_MODULE])
        # The first process returns when the template is loaded; later ones start within a tenth of a second.
        context = multiprocessing.get_context("forkserver")
        first = context.Process(target=os.getpid, name="answers", daemon=True)
        first.start()
        first.join()
        # All objects imported so far stay alive; see service.server.web.
        gc.freeze()
        if not self._stopping.is_set():
            self._loaded.set()
            for pool in (self._analyses, self._drawings):
                pool.begin()
