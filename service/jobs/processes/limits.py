"""A process of the server's that runs what a client has sent: it ends with the server, and its memory is bounded.

Imported before the process has set its number of threads, so it must not import numpy.
"""

from __future__ import annotations

import os
import resource
import signal
import sys

from service.jobs.processes.parent_death import die_with
from service.observability import logs

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def confine(server_pid: int, log_level: str, log_format: logs.Format) -> None:
    """Prepare this process: its end, its signals, its threads, its log. Called first of all."""
    die_with(server_pid)
    # Ctrl-C at a terminal reaches the whole group of processes; it is the server's to act on, and it stops its workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The default action ends the process at once; a handler in Python would wait for native code to return.
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    use_one_thread()
    logs.configure(log_level, log_format)


def use_one_thread() -> None:
    """Keep numeric libraries that are imported from now on to one thread.

    As many workers as processors run side by side, so threads inside them would only compete.
    """
    for variable in _THREADS:
        os.environ[variable] = "1"


def limit_memory(beyond_mb: int) -> None:
    """Allow ``beyond_mb`` MiB on top of what the process has now.

    On Linux ``RLIMIT_DATA`` counts the private memory that can be written. ``RLIMIT_AS`` would count address space
    as well that allocators and compilers reserve and never touch, so no honest figure could be set with it.
    """
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    limit = _memory_in_use() + (beyond_mb << 20)
    hard = resource.getrlimit(kind)[1]
    if hard != resource.RLIM_INFINITY:
        limit = min(limit, hard)
    resource.setrlimit(kind, (limit, hard))


def _memory_in_use() -> int:
    """The bytes that count against the limit; 0 where the system does not tell."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("VmData:"):
                    return int(line.split()[1]) << 10
    except OSError:
        pass
    return 0
