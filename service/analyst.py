"""The analysis core in the server's own process: loaded beside the start, then called in threads.

Jobs are computed in worker processes, which can be killed; an analysis takes milliseconds, and a thread will do. Its
library takes a second to import and its kernels some more to load, so that is done in the background when the service
has started, and whoever asks before it is done waits. To compile kernels here would hold up all requests: other
processes do that (:mod:`service.warming`).
"""

from __future__ import annotations

import asyncio
import gc
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from queue import SimpleQueue
from typing import Any, ParamSpec, TypeVar

import structlog

from service.loading import IMPORTS

THREADS = 2
"""Analyses that run at once. They hold the interpreter most of the time; more of them would only delay all others."""

MAX_ANALYSIS_S = 20.0
"""How long a client is kept waiting for an analysis."""

_PERIOD_S = 0.02
"""Period at which it looks whether the core may be loaded, which tells nobody."""

P = ParamSpec("P")
T = TypeVar("T")

log = structlog.get_logger(__name__)


class Busy(Exception):
    """Other analyses have kept this one from being begun in time."""


class TooLong(Exception):
    """The analysis was begun and has not ended in time."""


class Analyst:
    """Runs functions that need the analysis core, each in one of a few threads of its own, once it is loaded.

    A thread cannot be killed. An analysis that takes too long keeps its thread, but nobody waits for it any more, and
    the threads are daemons, so that the service can stop without it.
    """

    def __init__(self) -> None:
        self._calls: SimpleQueue[tuple[Future[Any], Callable[[], Any]]] = SimpleQueue()
        self._loaded = threading.Event()

    def start(self, after: Callable[[], bool]) -> None:
        """Load the core once ``after`` says so, when its kernels have been compiled or must be; returns at once."""
        for n in range(THREADS):
            loading = after if n == 0 else None
            threading.Thread(target=self._serve, args=(loading,), name=f"analyst-{n}", daemon=True).start()

    @property
    def asked(self) -> bool:
        """Whether somebody waits for an analysis."""
        return not self._calls.empty()

    @property
    def loaded(self) -> bool:
        """Whether analyses are begun at once."""
        return self._loaded.is_set()

    async def call(self, work: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """Call a function in a thread; what it raises is raised here.

        Raises
        ------
        Busy, TooLong
            After :data:`MAX_ANALYSIS_S`.
        """
        future: Future[T] = Future()
        self._calls.put((future, partial(work, *args, **kwargs)))
        try:
            async with asyncio.timeout(MAX_ANALYSIS_S):
                return await asyncio.wrap_future(future)
        except TimeoutError:
            raise (Busy if future.cancelled() else TooLong) from None

    def _serve(self, loading: Callable[[], bool] | None) -> None:
        if loading is not None:
            while not loading():
                time.sleep(_PERIOD_S)
            self._load()
        self._loaded.wait()
        while True:
            future, work = self._calls.get()
            if future.set_running_or_notify_cancel():
                try:
                    future.set_result(work())
                except Exception as error:  # it is the caller's
                    future.set_exception(error)

    def _load(self) -> None:
        try:
            warm_up()
        except Exception:  # the requests will say, one by one, what they could not have
            log.exception("the analysis core could not be warmed up")
        # All that is imported by now stays; see service.web.
        gc.freeze()
        self._loaded.set()


def warm_up() -> None:
    """Compile the kernels of the analysis core, or load them from their cache, by an analysis of each sort."""
    with IMPORTS:
        from synthesis.analyses import families, parse_request

    for family in families():
        family.request.example().answer()
    for mechanism in (_SLIDER_CRANK, _CLASS_III, _REDUNDANT):
        parse_request({"mechanism": mechanism, "dynamics": {}}).answer()
    rubbing = {"friction": {"pins": {"B": {"mu": 0.1, "radius": 0.1}}}}
    parse_request({"mechanism": _SLIDER_CRANK, "motion": {"at": 30.0}, "dynamics": rubbing}).answer()


_SLIDER_CRANK = {
    "type": "slider_crank",
    "fixed_pivot": [0.0, 0.0],
    "links": {"crank": 2.0, "coupler": 7.0},
    "slide": {"point": [0.0, 1.0], "angle": 0.0},
}
_REDUNDANT = {
    "type": "skeleton",
    "skeleton": {
        "joints": {"O": [0.0, 0.0], "P": [1.0, 0.0], "Q": [0.0, 1.0]},
        "links": [
            {"name": "ground", "joints": ["O"]},
            {"name": "input", "joints": ["O", "P"]},
            {"name": "output", "joints": ["O", "Q"]},
        ],
        "gears": [{"links": ["input", "output"], "ratio": -1.0}] * 2,
        "input_link": "input",
    },
}
_CLASS_III = {
    "type": "stephenson_2",
    "skeleton": {
        "joints": {
            "O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.3, 1.0], "C": [0.8, 0.6],
            "B": [1.5, 3.0], "D": [3.0, 2.2], "E": [4.2, 2.0],
        },
        "links": [
            {"name": "ground", "joints": ["O2", "O4"]},
            {"name": "input", "joints": ["O2", "A", "C"]},
            {"name": "link_3", "joints": ["A", "B"]},
            {"name": "link_4", "joints": ["B", "D", "E"]},
            {"name": "link_5", "joints": ["C", "D"]},
            {"name": "output", "joints": ["O4", "E"]},
        ],
        "input_link": "input",
    },
}  # fmt: skip
