"""The service with a solver that does what a problem's seed says. Run like ``mechsynth``.

The worker processes import the main module of the server again, so this script is in force in them too.
"""

import ctypes
import os
import signal
import sys
import time
from pathlib import Path

from synthesis import dispatch
from synthesis.designs import Result, Search

INSTANT, NATIVE, GREEDY, BROKEN, DIES_ONCE, GATED, STEPS = range(100, 107)
FOLDER = Path(os.environ.get("SCRIPTED_FOLDER", "."))


def solve(problem, progress):
    match problem.seed:
        case 101:  # native code that holds the interpreter: no Python handler can run
            ctypes.PyDLL(None).sleep(60)
        case 102:
            hoard = []
            while True:
                hoard.append(bytearray(16 << 20))
        case 103:
            raise ValueError("a secret of the implementation")
        case 104:
            mark = FOLDER / "died"
            if not mark.exists():
                mark.touch()
                os.kill(os.getpid(), signal.SIGKILL)
        case 105:
            progress(0.0, "waiting")
            while not (FOLDER / "open").exists():
                time.sleep(0.01)
        case 106:
            while not (FOLDER / "open").exists():
                time.sleep(0.01)
                progress(0.25, "a quarter")
    search = Search(method="scripted", complete=True, candidates=0, accepted=0, rejected={}, seed=problem.seed)
    return Result(designs=[], search=search, summary="scripted")


def warm_up():
    if (FOLDER / "cannot-start").exists():
        raise RuntimeError("told not to start")


# The tests import this module for its names only; the server runs it as __main__, its workers as __mp_main__.
if __name__ in ("__main__", "__mp_main__"):
    dispatch.solve = solve
    dispatch.warm_up = warm_up

if __name__ == "__main__":
    from service.cli import main

    sys.exit(main())
