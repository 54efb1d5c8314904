"""How a process that answers requests prepares itself."""

from __future__ import annotations

import gzip
import os
from collections.abc import Callable
from typing import Any

from service.jobs.processes.limits import confine, limit_memory
from service.observability.logs import Format


def prepare(log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its log, and ``memory_mb`` MiB beyond what it has now."""
    # The parent is the server, or the process that it is forked from, which ends with the server.
    confine(os.getppid(), log_level, log_format)
    limit_memory(memory_mb)


PACKED_BYTES = 1 << 20
"""Answers from this size on are packed where they are computed; smaller ones by the server, in some milliseconds."""

PACKING_LEVEL = 1
"""A third of the time of the server's own level, and a tenth more bytes."""

GZIP_MARK = b"\x1f\x8b"
"""What begins in this way is packed: no JSON does."""


def compute_packed(work: Callable[..., bytes], *args: Any) -> bytes:
    """Call a function, and pack a large answer: that would hold the event loop of the server up."""
    answer = work(*args)
    return gzip.compress(answer, PACKING_LEVEL) if len(answer) >= PACKED_BYTES else answer
