"""No orphans: a worker dies with its server, however the server dies."""

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
"""Where the kernel does not tell, a process looks this often whether its parent is there."""

_PARENT = "MECHSYNTH_PARENT_PID"
"""Not a setting: how a process is told, before it is told anything else, whose child it is."""


def die_with(parent_pid: int) -> None:
    """See to it that this process is killed when its parent, the process ``parent_pid``, ends.

    On Linux the kernel does it, at once and in native code too. The kernel takes the *thread* that created this
    process for the parent, so that thread has to live as long as the process is wanted. Elsewhere a thread looks
    for a change of parent, which native code that holds the interpreter can delay.
    """
    if sys.platform == "linux":
        if ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0) != 0:
            raise OSError(ctypes.get_errno(), "prctl(PR_SET_PDEATHSIG) failed")
    else:
        threading.Thread(target=_watch, args=(parent_pid,), daemon=True, name="parent-watch").start()
    # The parent may have ended before the kernel was asked; then nobody will send the signal any more.
    if os.getppid() != parent_pid:
        os.kill(os.getpid(), signal.SIGKILL)


def die_with_parent_from_the_start() -> None:
    """The same, at the first line of our own that a spawned process runs; nothing in any other process.

    What a worker imports before it can be told anything takes a second, and a minute on a very busy machine. A server
    that is killed meanwhile would leave it behind for so long. One that was killed before this line has left it to
    another parent already, so the worker does not ask who that is.
    """
    # The mark that multiprocessing itself goes by while it imports the main module again.
    if sys.platform == "linux" and getattr(multiprocessing.current_process(), "_inheriting", False):
        die_with(int(os.environ.pop(_PARENT, os.getppid())))


def tell_children() -> None:
    """Let the processes that this one spawns from now on know whose children they are."""
    os.environ[_PARENT] = str(os.getpid())


def forget_parent() -> None:
    """Let the processes that are forked from this one take it for their parent, not the one that has started it."""
    os.environ.pop(_PARENT, None)


def _watch(parent_pid: int) -> None:
    while os.getppid() == parent_pid:
        time.sleep(_WATCH_PERIOD_S)
    os.kill(os.getpid(), signal.SIGKILL)
