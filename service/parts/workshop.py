"""Parts are made in a process of their own, one request after the other, with the limits of jobs."""

from __future__ import annotations

import os
from collections import OrderedDict
from collections.abc import Awaitable, Callable
from importlib import import_module
from typing import Any

from service.jobs.confined import confine, limit_memory
from service.jobs.request_pool import Limits, PoolMetrics, RequestPool, digest
from service.jobs.worker import LIBRARIES_MB
from service.logs import Format
from service.parts.extra import installed

MAX_PARTS_S = 60.0
"""How long parts may be made; no longer than a job."""

KEPT_BYTES = 64 << 20
"""Files that are kept for those who ask for the same again."""

CAD_MB = 800
"""What the libraries of solids take beside what a job is allowed."""


class Workshop:
    """Has parts made, and keeps their files. To be used on one event loop only.

    Parameters
    ----------
    memory_mb : int
        What one request may take beyond the idle process, MiB.
    timeout_s : float
        How long a job may take.
    log_level, log_format : str
        Of the process.
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
        self.pool = RequestPool("parts", _prepare, settings, Limits(min(timeout_s, MAX_PARTS_S)), metrics=metrics)
        self._kept: OrderedDict[bytes, bytes] = OrderedDict()

    async def made(self, gone: Callable[[], Awaitable[bool]], tenant: str, work: Callable[..., Any], *args: Any) -> Any:
        """What a function of a module makes, or has made of the same; files are kept, other answers are not.

        Raises
        ------
        Busy, GivenUp, Gone, Lost
            As :meth:`service.jobs.request_pool.RequestPool.call`.
        """
        key = digest(work, args)
        if key in self._kept:
            self._kept.move_to_end(key)
            return self._kept[key]
        made = await self.pool.call(gone, tenant, work, *args)
        if isinstance(made, bytes):
            self._kept[key] = made
            while sum(map(len, self._kept.values())) > KEPT_BYTES:
                self._kept.popitem(last=False)
        return made

    def stop(self) -> None:
        """End the process."""
        self.pool.stop()


def _prepare(server_pid: int, log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its limits, its libraries."""
    confine(server_pid, log_level, log_format)
    import_module("service.parts.orders")
    if installed():
        import_module("build123d")
    limit_memory(memory_mb + LIBRARIES_MB + CAD_MB)


def filled(*args: Any) -> Any:
    """:func:`service.parts.orders.filled`, which is imported in the process alone."""
    from service.parts import orders

    return orders.filled(*args)


def part_filled(*args: Any) -> Any:
    """:func:`service.parts.orders.part_filled`, likewise."""
    from service.parts import orders

    return orders.part_filled(*args)
