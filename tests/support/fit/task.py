"""What a row is made of: statements that a known linkage is an answer to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

Statement = dict[str, Any]


def always(_design: Any) -> bool:
    """What is demanded of a design beyond its checks where that is nothing."""
    return True


class Task(NamedTuple):
    """One planted task.

    Attributes
    ----------
    number : int
        Its place in the row; with the seed it says all that is random of the task.
    group : str
        What it counts with in the table.
    statement : dict
        As a client posts it.
    good : callable
        Whether a design of the answer counts as one.
    """

    number: int
    group: str
    statement: Statement
    good: Callable[[Any], bool] = always


def generator(seed: int, number: int) -> np.random.Generator:
    """The random numbers of one task, the same whichever tasks are run beside it."""
    return np.random.default_rng([seed, number])
