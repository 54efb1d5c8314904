"""Compilation ahead of time: all kernels of the project, part by part, on all processors, in separate processes.

``mechsynth warm`` does it before a service starts. A service with missing kernels does it in parallel with its jobs
once its first worker is ready, most parts at low priority; a job that arrives before its kernels compiles them itself
(:mod:`service.jobs.workers.compile_watch`). Marks on disk record the compiled parts (:mod:`kinematics.kernel_marks`),
so that an interrupted compilation continues at the next start, and processes with a common cache share the work.

The compiler holds the interpreter lock, so threads would only take turns. If two processes compile the same function at
once, both keep a valid copy.
"""

from __future__ import annotations

import importlib
import os
import threading
import time
from collections.abc import Callable, Sequence
from multiprocessing import get_context
from multiprocessing.process import BaseProcess

import structlog

from service.jobs.processes.parent_death import bind_to_parent, export_parent_pid
from service.kernels import ANALYSIS_PART, KernelsState
from service.loading import IMPORTS
from service.observability import logs

CONSTRAINTS_PART = "demands"
"""The kernels of constraints, which no example of a kind calls."""

NICENESS = 10
"""Niceness of processes that compile in parallel with jobs."""

EARLY_LOOK_S = 3.0
"""Time after which the search for missing kernels begins although no worker has started, seconds: the first worker then
probably compiles those of the most common problems."""

MAX_START_DELAY_S = 10.0
"""Time limit for the first worker's start, after which the search for missing kernels begins in any case, seconds."""

_PERIOD_S = 0.1
"""Period at which the marks of compiled parts on disk are checked, seconds; no event announces them."""

log = structlog.get_logger(__name__)


class WarmingFailure(Exception):
    """Kernels could not be compiled; the message names the missing parts."""


def list_parts() -> list[str]:
    """Return all parts of the kernels, first those that most others call."""
    from kinematics.kernel_marks import LINKAGES_PART
    from synthesis.registry import KINDS

    return [LINKAGES_PART, ANALYSIS_PART, *KINDS, CONSTRAINTS_PART]


def list_analysis_parts() -> list[str]:
    """Return the parts needed by a server whose jobs run elsewhere."""
    return [ANALYSIS_PART]


def warm() -> None:
    """Compile all missing kernels and wait for the end.

    Raises
    ------
    WarmingFailure
        If a solver raised or a process died, for example for lack of memory.
    """
    from synthesis import dispatch

    logs.configure("warning", "text")
    compilation = Compilation(list_parts, "warning", "text", priority=0, ahead=True)
    if not compilation.missing:
        return
    dispatch.warm_up()  # kernels that most parts call are compiled once, before the parts are compiled in parallel
    compilation.run()
    if missing := compilation.missing:
        raise WarmingFailure(f"not compiled: {', '.join(missing)}; the log has the reasons")


class Compilation:
    """Compiles parts of the kernels in processes and tracks the progress.

    Without ``ahead`` it compiles nothing and only reports the missing parts, which jobs then compile on demand.
    """

    def __init__(
        self, wanted: Callable[[], list[str]], level: str, form: logs.Format, priority: int = NICENESS, *, ahead: bool
    ) -> None:
        self.state = KernelsState()
        self._wanted = wanted
        self._level, self._form = level, form
        self._priority = priority
        self._ahead = ahead
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self, after: Callable[[], bool]) -> None:
        """Compile in the background once ``after`` returns true, at the latest after :data:`MAX_START_DELAY_S`."""
        self._thread = threading.Thread(target=self._begin, args=(after,), name="compilation", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End the processes and wait for their end; compiled kernels are kept."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    @property
    def missing(self) -> list[str]:
        """The parts that have not been compiled."""
        from kinematics.kernel_marks import is_compiled

        return [part for part in self._wanted() if not is_compiled(part)]

    def look(self) -> list[str]:
        """Look for the missing parts and record them in the state."""
        missing = self.missing
        self.state.look(len(self._wanted()), missing)
        return missing

    def run(self) -> None:
        """Compile the missing parts; return when all are done, cannot be done, or a stop is requested."""
        missing = self.look()
        if not missing or not self._ahead:
            return
        log.info("compiling kernels in the background; jobs compile their own meanwhile", parts=missing)
        began = time.monotonic()
        export_parent_pid()
        context = get_context("spawn")
        arguments = (missing, os.getpid(), self._priority, self._level, self._form)
        processes = [
            context.Process(target=_compile, args=arguments, name=f"compiler-{n}", daemon=True)
            for n in range(min(os.cpu_count() or 1, len(missing)))
        ]
        for process in processes:
            process.start()
        try:
            self._watch(processes)
        finally:
            for process in processes:
                process.kill()
                process.join()
        if self.state.waiting and not self._stopping.is_set():
            log.error("kernels could not be compiled; jobs that need them will try", parts=self.state.waiting)
        elif not self.state.waiting:
            log.info("all kernels are compiled", seconds=round(time.monotonic() - began, 1))

    def _begin(self, after: Callable[[], bool]) -> None:
        try:
            began = time.monotonic()
            self._wait(after, began + EARLY_LOOK_S)
            with IMPORTS:
                importlib.import_module("kinematics.kernel_marks")  # it takes half a second
            if not after() and not self._stopping.is_set() and (missing := self.look()):
                log.warning(
                    "numerical kernels are not compiled yet; the service is ready when the most common ones are, "
                    "after an installation in about a minute",
                    missing=len(missing),
                )
            self._wait(after, began + MAX_START_DELAY_S)
            self.run()
        except Exception:  # not fatal: jobs compile the kernels they need
            log.exception("kernels could not be compiled in the background")
        finally:
            self.state.note_end()

    def _wait(self, after: Callable[[], bool], latest: float) -> None:
        while not after() and time.monotonic() < latest and not self._stopping.is_set():
            self._stopping.wait(_PERIOD_S)

    def _watch(self, processes: Sequence[BaseProcess]) -> None:
        from kinematics.kernel_marks import is_compiled

        alive = True
        while alive and not self._stopping.is_set():
            alive = any(process.is_alive() for process in processes)
            for part in self.state.waiting:
                if is_compiled(part):
                    self.state.note_compiled(part)
                    log.info("kernels compiled", part=part, left=len(self.state.waiting))
            if not self.state.waiting:
                return
            if alive:
                self._stopping.wait(_PERIOD_S)


def _compile(missing: list[str], parent: int, priority: int, level: str, form: logs.Format) -> None:
    """Compile the parts that no other process works on, one at a time; the main function of a process."""
    bind_to_parent(parent)
    logs.configure(level, form)
    from kinematics.kernel_marks import LINKAGES_PART, claim_part, is_compiled, mark_compiled

    waiting = missing
    while waiting:
        elsewhere = []
        for part in waiting:
            with claim_part(part) as ours:
                if not ours:
                    elsewhere.append(part)
                elif not is_compiled(part):
                    if part not in (LINKAGES_PART, ANALYSIS_PART):  # these are needed first: full priority
                        os.nice(priority - os.nice(0))
                    try:
                        _compile_part(part)
                    except Exception:  # an error of a solver: the other parts can still be compiled
                        log.exception("kernels could not be compiled", part=part)
                    else:
                        mark_compiled(part)
        waiting = elsewhere
        if waiting:
            time.sleep(_PERIOD_S)


def _compile_part(part: str) -> None:
    from kinematics.kernel_marks import LINKAGES_PART
    from service import warm_analysis
    from synthesis import dispatch

    if part == LINKAGES_PART:
        dispatch.load_linkages()
    elif part == ANALYSIS_PART:
        warm_analysis.warm_up()
    elif part == CONSTRAINTS_PART:
        dispatch.compile_constraints()
    else:
        dispatch.compile_kind(part)
