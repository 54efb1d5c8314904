"""What a process has loaded before it is forked: the analysis core, warmed up.

The processes that answer requests are forked from one that has imported this module, so that they share its memory and
are there within some hundredths of a second. The import has effects for that reason; nothing else may import it.
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
    from synthesis import registry

    # Named here to be there when they are called.
    assert all((render, analysis, designs, forces, reports, simulations, registry))
    try:
        warm_analysis.warm_up()
    except Exception:  # the requests will say, one by one, what they could not have
        structlog.get_logger(__name__).exception("the analysis core could not be warmed up", pid=os.getpid())
    # A collection would write to the pages that forked processes share.
    gc.collect()
    gc.freeze()


_load()
