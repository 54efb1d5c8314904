"""Worker process that makes parts, one request after the other, with the limits of jobs."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from importlib import import_module
from typing import TypeVar

from kinematics.message import get_language
from service.jobs.processes.limits import limit_memory, restrict_process
from service.jobs.processes.request_pool import Limits, PoolMetrics, ProcessStart, RequestPool, hash_call
from service.jobs.workers.worker import LIBRARIES_MB
from service.observability.logs import Format
from service.parts.assembly.sizes import File, FileRefusal, PartFile
from service.parts.export.cad_available import is_installed
from synthesis.model.json_object import JsonObject

T = TypeVar("T")

MAX_PARTS_S = 60.0
"""Maximum time for making parts; a job's limit also applies."""

MAX_CACHE_BYTES = 64 << 20
"""Maximum size of cached files for repeated requests."""

CAD_MB = 800
"""Memory for the CAD libraries in addition to a job's limit, MiB."""


class Workshop:
    """Makes parts in a worker process, and caches their files. Use it on one event loop only.

    Parameters
    ----------
    memory_mb : int
        Memory limit of one request in addition to the idle process, MiB.
    timeout_s : float
        Time limit of a job, seconds.
    log_level, log_format : str
        Logging options of the process.
    """

    def __init__(
        self,
        memory_mb: int,
        timeout_s: float,
        log_level: str = "info",
        log_format: Format = "text",
        metrics: PoolMetrics | None = None,
    ) -> None:
        settings = os.getpid(), log_level, log_format, memory_mb
        self.pool = RequestPool(
            "parts", ProcessStart(_prepare, settings), Limits(min(timeout_s, MAX_PARTS_S)), metrics=metrics
        )
        self._kept: OrderedDict[bytes, bytes] = OrderedDict()

    async def run_cached(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., T], *args: object
    ) -> T | bytes:
        """Return the result of a function of a module, or the cached file of an identical call; only files are cached.

        Raises
        ------
        Busy, GivenUp, ClientGone, ProcessLost
            See :meth:`service.jobs.processes.request_pool.RequestPool.call`.
        """
        key = hash_call(work, (get_language(), *args))
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        made = await self.pool.call(gone, tenant, work, *args)
        if isinstance(made, bytes):
            self._kept[key] = made
            # Evict the least recently used files.
            while sum(map(len, self._kept.values())) > MAX_CACHE_BYTES:
                self._kept.popitem(last=False)
        return made

    def stop(self) -> None:
        """Stop the process."""
        self.pool.stop()


def _prepare(server_pid: int, log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: termination with the server, limits, libraries."""
    restrict_process(server_pid, log_level, log_format)
    import_module("service.parts.export.requests")
    if is_installed():
        import_module("build123d")
    limit_memory(memory_mb + LIBRARIES_MB + CAD_MB)


def make_file(order: JsonObject, file: File) -> bytes | FileRefusal:
    """Call :func:`service.parts.export.requests.make_file`, which is imported only in the worker process."""
    from service.parts.export import requests

    return requests.make_file(order, file)


def make_item_file(order: JsonObject, name: str, form: PartFile) -> bytes | FileRefusal:
    """Call :func:`service.parts.export.requests.make_item_file`, which is imported only in the worker process."""
    from service.parts.export import requests

    return requests.make_item_file(order, name, form)
