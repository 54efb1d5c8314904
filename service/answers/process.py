"""How a process that answers requests prepares itself."""

from __future__ import annotations

import os

from service.jobs.confined import confine, limit_memory
from service.logs import Format


def prepare(log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its log, and ``memory_mb`` MiB beyond what it has now."""
    # The parent is the server, or the process that it is forked from, which ends with the server.
    confine(os.getppid(), log_level, log_format)
    limit_memory(memory_mb)
