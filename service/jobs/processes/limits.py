"""Limits of a process that works on client input: it ends with the server, and its memory is bounded.

This module is imported before the process has set its number of threads, so it must not import numpy.
"""

from __future__ import annotations

import os
import resource
import signal
import sys

from service.jobs.processes.parent_death import bind_to_parent
from service.observability import logs

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def restrict_process(server_pid: int, log_level: str, log_format: logs.Format) -> None:
    """Prepare this process: end with the server, signals, threads, log. Must be the first call in the process."""
    bind_to_parent(server_pid)
    # Ctrl-C at a terminal reaches the whole process group; only the server reacts to it, and stops its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The default action ends the process at once; a handler in Python would wait for native code to return.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    use_one_thread()
    logs.configure(log_level, log_format)


def use_one_thread() -> None:
    """Restrict numerical libraries that are imported later to one thread.

    As many workers as processors run in parallel, so threads inside them would only compete.
    """
    for variable in _THREADS:
        os.environ[variable] = "1"


def limit_memory(beyond_mb: int) -> None:
    """Limit the process to ``beyond_mb`` MiB more than its present memory.

    On Linux ``RLIMIT_DATA`` counts private writable memory. ``RLIMIT_AS`` would also count address space that
    allocators and compilers reserve and never touch, so it allows no meaningful limit.
    """
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    limit = _measure_memory() + (beyond_mb << 20)
    # An unprivileged process cannot exceed the hard limit that it inherited.
    hard = resource.getrlimit(kind)[1]
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    resource.setrlimit(kind, (limit, hard))


def _measure_memory() -> int:
    """Return the bytes that count towards the limit; 0 if the system does not report them."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("VmData:"):
                    return int(line.split()[1]) << 10
    except OSError:
        pass
    return 0
