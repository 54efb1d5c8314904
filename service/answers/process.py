"""Preparation of the processes that answer requests, and compression of their answers."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable

from service.jobs.processes.limits import limit_memory, restrict_process
from service.observability.logs import Format


def prepare(log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its log, and a limit of ``memory_mb`` MiB beyond its present memory."""
    # The parent is the server, or the template process that was forked, which ends with the server.
    restrict_process(os.getppid(), log_level, log_format)
    limit_memory(memory_mb)


PACKED_BYTES = 1 << 20
"""Minimum size of answers compressed by the computing process, bytes; the server compresses others in milliseconds."""

PACKING_LEVEL = 1
"""Compression level: a third of the time of the server's own level, and a tenth more bytes."""

GZIP_MARK = b"\x1f\x8b"
"""First bytes of compressed answers; no JSON begins with them."""


def compute_packed(work: Callable[..., bytes], *args: object) -> bytes:
    """Call a function, and compress a large answer, which would block the event loop of the server."""
    answer = work(*args)
    return gzip.compress(answer, PACKING_LEVEL) if len(answer) >= PACKED_BYTES else answer
