"""Distribution of the tests of solids over processes.

pytest-xdist groups tests by appending their group to their names, which has no effect since pytest 9.2. The scheduler
sees names only, so that groups follow from them here.
"""

from __future__ import annotations

from typing import Any

import pytest
from xdist.scheduler import LoadScopeScheduling


class DesignScheduling(LoadScopeScheduling):
    """Runs all tests of one design in one process, which makes its solids once, and all others by file."""

    def _split_scope(self, nodeid: str) -> str:
        file, _, case = nodeid.partition("::")
        return case.partition("[")[2] if file.endswith("test_every_type.py") and "[" in case else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Return the scheduler for ``--dist loadgroup``; None leaves the choice to pytest-xdist."""
    return DesignScheduling(config, log) if config.getvalue("dist") == "loadgroup" else None
