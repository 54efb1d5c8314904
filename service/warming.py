"""Compilation ahead of time: every kernel there is, before the first job, on all processors.

The compiler holds the interpreter, so threads would only take turns: processes share the kinds of problems out. What
most of them need is compiled first, by one. Where two compile the same function at once, both keep a sound copy.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context


def warm() -> None:
    """Compile the kernels of the analysis core and of every kind of problem into their cache on disk.

    Raises what a solver raises, and ``BrokenProcessPool`` where a process died, for want of memory for instance.
    """
    from kinematics.linkage.warm import warm_up
    from service import analyst
    from synthesis import dispatch
    from synthesis.registry import KINDS

    warm_up()
    dispatch.warm_up()
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as processes:
        tasks = [processes.submit(dispatch.compile_kind, name) for name in KINDS]
        tasks += [processes.submit(dispatch.compile_demands), processes.submit(analyst.warm_up)]
        for task in tasks:
            task.result()
