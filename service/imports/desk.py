"""Files that clients send are read by processes of their own, a file each at a time, within bounded time and memory.

A reader that takes too long or too much is killed and replaced, so that no file can hold the server up or take it down
with it (:mod:`service.jobs.processes.request_pool`).
"""

from __future__ import annotations

import os
from collections.abc import Awaitable, Callable
from typing import Any

from service.imports import reader
from service.imports.limits import MEMORY_MB, READ_TIMEOUT_S
from service.jobs.processes.request_pool import GivenUp, Limits, PoolMetrics, RequestPool
from service.observability.logs import Format
from service.outlines.faults import UnsuitableDrawing

READER_COUNT = 2
"""Files that are read at once."""


class ImportDesk:
    """Has files read, each in its turn; ``memory_mb`` is what a file may take. To be used on one event loop only."""

    def __init__(
        self, log_level: str, log_format: Format, memory_mb: int = MEMORY_MB, metrics: PoolMetrics | None = None
    ) -> None:
        settings = os.getpid(), log_level, log_format, memory_mb
        self.pool = RequestPool(
            "files", reader.prepare, settings, Limits(READ_TIMEOUT_S), hands=READER_COUNT, metrics=metrics
        )

    async def read(
        self, gone: Callable[[], Awaitable[bool]], tenant: str, door: reader.Door, content: bytes, **asked: Any
    ) -> bytes:
        """What a door of :mod:`service.imports.reader` answers to a file, as JSON.

        Raises
        ------
        DrawingError
            Why the file gives nothing; it may also have taken more than the time or the memory that a file has.
        Busy, Gone, Lost
            As :meth:`service.jobs.processes.request_pool.RequestPool.call`.
        """
        try:
            answer = await self.pool.call(gone, tenant, reader.read, door, content, asked)
        except GivenUp as error:
            longer, more = f"longer than {READ_TIMEOUT_S:g} seconds to read", "more memory to read than a file has here"
            taken = longer if error.of == "time" else more
            raise UnsuitableDrawing(f"The file takes {taken}; send a smaller or simpler one.") from None
        if isinstance(answer, reader.Fault):
            raise answer.to_error()
        assert isinstance(answer, bytes)
        return answer

    def stop(self) -> None:
        """End the processes."""
        self.pool.stop()
