"""What a row is made of: statements with answers that are known to exist."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple


class Task(NamedTuple):
    """One statement of a row.

    Attributes
    ----------
    statement : dict
        As a client posts it.
    answered : callable
        Whether a result is an answer to it, from the result.
    name : str
        What it is called where it fails.
    """

    statement: dict[str, Any]
    answered: Callable[[Any], bool]
    name: str


def passed(result: Any) -> bool:
    """Whether a design passes all checks."""
    return any(design.verification.passed for design in result.designs)
