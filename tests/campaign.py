"""How much of a campaign is run: a share of its random cases, the first by seed (``--campaign-share 1``: all)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import pytest

DEFAULT_SHARE = 0.25
"""With this the campaign ends in a quarter of an hour on two cores. The cases left out are of the same sorts."""

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
