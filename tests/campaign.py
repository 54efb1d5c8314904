"""The time budget of a campaign, and what a test of it tries within its part.

``--campaign-minutes`` is how long the campaign may take; ``inf`` tries everything. Every test of the campaign tries
its first case, whatever the budget. It goes on with its further cases until they have used its part of the budget;
the rest is skipped with that reason. Loops over random cases inside a test are shortened in proportion.
"""

from __future__ import annotations

import math
import os
from collections import defaultdict
from collections.abc import Iterable
from time import monotonic
from typing import Any

import pytest

DEFAULT_MINUTES = 15.0
"""Without the option; tests outside the campaign take their number of random cases from it."""

WHOLE_MINUTES = 300.0
"""Duration of the whole campaign on two cores, in minutes; the random cases inside a test are a share by it."""

MAX_FURTHER_SHARE = 0.5
"""Share of the budget for further cases. The first case of each test takes the other half."""

_budget_minutes = DEFAULT_MINUTES


def choose_budget(minutes: float) -> None:
    """Set the budget of every campaign from now on; before the tests are collected."""
    global _budget_minutes
    if not minutes > 0.0:
        raise ValueError(f"the budget of a campaign must be positive, got {minutes} minutes")
    _budget_minutes = minutes


def further(values: Iterable[Any], always: Iterable[Any]) -> list[Any]:
    """Return parameters of a test: those of ``always`` are tried in every run, the others in the campaign.

    A tuple is the values of several parameters.
    """
    kept = list(always)
    later = pytest.mark.campaign
    return [
        value if value in kept else pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=later)
        for value in values
    ]


def sampled(cases: int) -> int:
    """Return how many random cases a loop tries within the budget: at least one, at most all."""
    return math.ceil(min(1.0, _budget_minutes / WHOLE_MINUTES) * cases)


class Budget:
    """Time that the cases of each campaign test have used in this process."""

    def __init__(self) -> None:
        self._allowance_s = math.inf
        self._first: dict[str, str] = {}
        self._used: dict[str, float] = defaultdict(float)
        self._begun: dict[str, float] = {}

    def share_out(self, items: Iterable[pytest.Item]) -> None:
        """Give each test with further cases the same part of the budget."""
        counts: dict[str, int] = defaultdict(int)
        for item in items:
            if item.get_closest_marker("campaign") is not None:
                test = item.nodeid.partition("[")[0]
                self._first.setdefault(test, item.nodeid)
                counts[test] += 1
        tests = sum(count > 1 for count in counts.values())
        processes = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
        if tests:
            self._allowance_s = MAX_FURTHER_SHARE * 60.0 * _budget_minutes * processes / tests

    def begin(self, item: pytest.Item) -> None:
        """Skip a further case of a test that has used its part; otherwise start its clock."""
        test = item.nodeid.partition("[")[0]
        if self._first.get(test, item.nodeid) != item.nodeid and self._used[test] >= self._allowance_s:
            pytest.skip(f"a campaign of {_budget_minutes:g} minutes leaves no time for it")
        self._begun[item.nodeid] = monotonic()

    def end(self, item: pytest.Item) -> None:
        """Stop the clock of a case. The first case of a test is not counted."""
        begun = self._begun.pop(item.nodeid, None)
        test = item.nodeid.partition("[")[0]
        if begun is not None and self._first.get(test) != item.nodeid:
            self._used[test] += monotonic() - begun


BUDGET = Budget()
