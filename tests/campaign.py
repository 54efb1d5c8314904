"""The time budget of a campaign, and what a test of it tries within its part.

``--campaign-minutes`` is how long the campaign may take; ``inf`` tries everything. Half of the budget goes to one case
each of as many tests as it suffices for. They are drawn by the date, so that every test has its turn within some days;
``--campaign-day`` repeats the draw of another day. The other half is shared by the further cases of these tests. Loops
over random cases inside a test are shortened in proportion.
"""

from __future__ import annotations

import hashlib
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
"""Share of the budget for further cases. One case of each test that was drawn takes the other half."""

FIRST_CASE_S = 4.5
"""Mean duration of one case with what it shares with others, in seconds: 96 took 8 minutes of two processes, with their
servers and solids."""

MAX_OVERRUN = 1.25
"""Multiple of the budget after which no further case begins: the mean of the drawn cases may be above the usual one."""

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
    """The cases of a campaign that fit into its time, and the time that each test has used in this process."""

    def __init__(self) -> None:
        self._allowance_s = math.inf
        self._first: dict[str, str] = {}
        self._used: dict[str, float] = defaultdict(float)
        self._begun: dict[str, float] = {}
        self._deadline = math.inf

    def choose_cases(self, items: list[pytest.Item], day: int) -> list[pytest.Item]:
        """Take tests out of ``items`` for which the budget has no time today, and return their cases."""
        cases: dict[str, list[str]] = defaultdict(list)
        for item in items:
            if item.get_closest_marker("campaign") is not None:
                cases[_name_test(item)].append(item.nodeid)
        processes = int(os.environ.get("PYTEST_XDIST_WORKER_COUNT", "1"))
        seconds = 60.0 * _budget_minutes * processes
        count = min(len(cases), (1.0 - MAX_FURTHER_SHARE) * seconds / FIRST_CASE_S)
        # The order is another one every day, so that all tests and all of their cases have their turn within days.
        tests = set(sorted(cases, key=lambda test: _draw(test, day))[: math.ceil(count)])
        self._first = {test: min(cases[test], key=lambda case: _draw(case, day)) for test in tests}
        further_tests = sum(len(cases[test]) > 1 for test in tests)
        if further_tests:
            self._allowance_s = MAX_FURTHER_SHARE * seconds / further_tests
        self._deadline = monotonic() + MAX_OVERRUN * 60.0 * _budget_minutes
        dropped = [item for item in items if _name_test(item) in cases.keys() - tests]
        items[:] = [item for item in items if _name_test(item) not in cases or _name_test(item) in tests]
        return dropped

    def begin(self, item: pytest.Item) -> None:
        """Skip a further case of a test that has used its part; otherwise start its clock."""
        test = _name_test(item)
        is_first = self._first.get(test) == item.nodeid
        if (not is_first and self._used[test] >= self._allowance_s) or monotonic() > self._deadline:
            pytest.skip(f"a campaign of {_budget_minutes:g} minutes leaves no time for it")
        self._begun[item.nodeid] = monotonic()

    def end(self, item: pytest.Item) -> None:
        """Stop the clock of a case. The first case of a test is not counted."""
        begun = self._begun.pop(item.nodeid, None)
        test = _name_test(item)
        if begun is not None and self._first.get(test) != item.nodeid:
            self._used[test] += monotonic() - begun


def _name_test(item: pytest.Item) -> str:
    return item.nodeid.partition("[")[0]


def _draw(name: str, day: int) -> bytes:
    """Return what a test or a case is drawn by: the same in every process on one day."""
    return hashlib.sha256(f"{day} {name}".encode()).digest()


BUDGET = Budget()
