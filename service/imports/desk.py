"""Reading of client files in separate processes, one file at a time each, within bounded time and memory.

A reader that exceeds its limits is killed and replaced, so that no file can block or crash the server
(:mod:`service.jobs.processes.request_pool`).
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from kinematics.message import compose
from service.imports import reader
from service.imports.limits import MEMORY_MB, READ_TIMEOUT_S
from service.jobs.processes.request_pool import GivenUp, Limits, PoolMetrics, ProcessStart, RequestPool
from service.observability.logs import Format
from service.outlines.faults import UnsuitableDrawing

READER_COUNT = 2
"""Maximum number of files that are read at once."""


class ImportDesk:
    """Reads files in turn. For use on one event loop only.

    ``memory_mb`` is the memory limit for a file. ``forks`` returns whether the readers can be forked from the template
    process (:mod:`service.answers.template`), which has loaded their libraries; else they are spawned.
    """

    def __init__(
        self,
        log_level: str,
        log_format: Format,
        memory_mb: int = MEMORY_MB,
        metrics: PoolMetrics | None = None,
        forks: Callable[[], bool] = lambda: False,
    ) -> None:
        start = ProcessStart(reader.prepare, (log_level, log_format, memory_mb), forks)
        self.pool = RequestPool("files", start, Limits(READ_TIMEOUT_S), hands=READER_COUNT, metrics=metrics)

    async def read(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, door: reader.Door, content: bytes, **asked: Any
    ) -> bytes:
        """Return the content that a door of :mod:`service.imports.reader` reads from a file, as JSON.

        Raises
        ------
        DrawingError
            If the file is unusable or exceeds the limits of time or memory.
        Busy, ClientGone, ProcessLost
            As :meth:`service.jobs.processes.request_pool.RequestPool.call`.
        """
        try:
            answer = await self.pool.call(gone, tenant, reader.read, door, content, asked)
        except GivenUp as error:
            if error.of == "time":
                raise UnsuitableDrawing(compose("imports-reading-too-long", seconds=f"{READ_TIMEOUT_S:g}")) from None
            raise UnsuitableDrawing(compose("imports-reading-too-large")) from None
        if isinstance(answer, reader.Fault):
            raise answer.to_error()
        assert isinstance(answer, bytes)
        return answer

    def stop(self) -> None:
        """End the processes."""
        self.pool.stop()
