"""What a row is made of: statements that a known linkage is an answer to."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

Statement = dict[str, Any]


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
    """

    number: int
    group: str
    statement: Statement


def generator(seed: int, number: int) -> np.random.Generator:
    """The random numbers of one task, the same whichever tasks are run beside it."""
    return np.random.default_rng([seed, number])
