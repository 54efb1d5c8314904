"""How much of a campaign is run: a share of its random cases, the first by seed, and one of 24 of its listed ones.

With ``--campaign-share 1`` it is all of them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from typing import Any

import pytest

DEFAULT_SHARE = 0.05
"""Of random cases. Those left out are of the same sorts."""

LISTED = 24
"""One of so many listed cases of a test is run; the others, too, are of the same sorts."""

_share = DEFAULT_SHARE


def choose(share: float) -> None:
    """Take this share of every campaign from now on; before the tests are collected."""
    global _share
    if not 0.0 < share <= 1.0:
        raise ValueError(f"a share of a campaign lies between 0 and 1, not at {share}")
    _share = share


def further(values: Iterable[Any], always: Iterable[Any]) -> list[Any]:
    """Parameters of a test: it is tried with those of ``always`` in every run, with the others in the campaign.

    A tuple is the values of several parameters.
    """
    kept = list(always)
    later = pytest.mark.campaign
    return [
        value if value in kept else pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=later)
        for value in values
    ]


def sampled(cases: int) -> int:
    """How many of so many random cases are to be tried: at least one."""
    return math.ceil(_share * cases)


def thinned(items: Iterable[pytest.Item]) -> tuple[list[pytest.Item], list[pytest.Item]]:
    """Tests to be run, and those left out: one of 24 cases that a test has in the campaign, unless all are run."""
    kept: list[pytest.Item] = []
    left_out: list[pytest.Item] = []
    seen: Counter[str] = Counter()
    for item in items:
        test, _, case = item.nodeid.partition("[")
        if not case or _share == 1.0 or item.get_closest_marker("campaign") is None:
            kept.append(item)
            continue
        (left_out if seen[test] % LISTED else kept).append(item)
        seen[test] += 1
    return kept, left_out
