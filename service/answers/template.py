"""The template process: it loads and warms up the analysis core before others are forked from it.

The processes that answer requests are forked from a process that has imported this module, so that they share its
memory and start within some hundredths of a second. The import has side effects for that reason; nothing else may
import it.
"""

from __future__ import annotations

import gc
import os

from service.jobs.processes.limits import use_one_thread
from service.jobs.processes.parent_death import clear_parent_pid

use_one_thread()
# Forked processes are children of this one, not of the server that started this one.
clear_parent_pid()


def _load() -> None:
    import structlog

    from service import render, warm_analysis
    from service.answers import analysis, designs, forces, reports, simulations
    from service.imports import reading as curve_reading
    from service.outlines import reading as outline_reading
    from synthesis import registry

    # Only their import matters: forked processes then need no imports of their own.
    assert all((analysis, designs, forces, reports, simulations, registry, curve_reading, outline_reading))
    render.load_sheets()
    try:
        warm_analysis.warm_up()
    except Exception:  # each request will report its own failure
        structlog.get_logger(__name__).exception("the analysis core could not be warmed up", pid=os.getpid())
    # A later garbage collection would write to the memory pages that the forked processes share.
    gc.collect()
    gc.freeze()


_load()
