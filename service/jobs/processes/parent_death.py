"""Prevention of orphan processes: a worker ends with its server, even if the server is killed."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import sys
import threading
import time

_PR_SET_PDEATHSIG = 1
_WATCH_PERIOD_S = 0.5
"""Period at which a process checks for its parent, seconds, on systems whose kernel sends no signal."""

_PARENT = "MECHSYNTH_PARENT_PID"
"""Environment variable with the parent's process id, which a new process needs before its first message. Internal."""


def bind_to_parent(parent_pid: int) -> None:
    """Ensure that this process is killed when its parent, the process ``parent_pid``, ends.

    On Linux the kernel kills it at once, even in native code. To the kernel the parent is the *thread* that created
    this process, so that thread must live as long as the process is needed. Elsewhere a thread checks for a change of
    parent, which native code that holds the interpreter can delay.
    """
    if sys.platform == "linux":
        if ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")
    else:
        threading.Thread(target=_watch, args=(parent_pid,), daemon=True, name="parent-watch").start()
    # The parent may have ended before the call of prctl; then the kernel sends no signal.
    if os.getppid() != parent_pid:
        os.kill(os.getpid(), signal.SIGKILL)


def bind_to_parent_at_start() -> None:
    """Do the same in the first line of our code that a spawned process runs; do nothing in any other process.

    The imports of a worker before its first message take a second, and a minute on a very busy machine. A server that
    is killed meanwhile would leave the worker behind for that time. If the server was killed even before this line, the
    worker already has another parent; so it takes the parent's id from the environment and not from the system.
    """
    # Multiprocessing itself sets this mark in a spawned process while it imports the main module again.
    if sys.platform == "linux" and getattr(multiprocessing.current_process(), "_inheriting", False):
        bind_to_parent(int(os.environ.pop(_PARENT, os.getppid())))


def export_parent_pid() -> None:
    """Pass this process's id to the processes that it spawns from now on."""
    os.environ[_PARENT] = str(os.getpid())


def clear_parent_pid() -> None:
    """Remove the inherited parent id, so that processes forked from this one take this one as their parent."""
    os.environ.pop(_PARENT, None)


def _watch(parent_pid: int) -> None:
    while os.getppid() == parent_pid:
        time.sleep(_WATCH_PERIOD_S)
    os.kill(os.getpid(), signal.SIGKILL)
