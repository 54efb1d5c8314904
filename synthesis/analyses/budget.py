"""Limits on the size of an analysis, checked before the work begins."""

from __future__ import annotations

from kinematics.message import compose

MAX_VALUES = 2_000_000
"""Maximum count of numbers in the lists of an answer: about forty megabytes of JSON."""


class BudgetError(ValueError):
    """Raised for a request that exceeds the limit; carries the path of the field, and the permitted maximum."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


def require_values(path: str, positions: int, numbers: int) -> None:
    """Refuse an answer with more than :data:`MAX_VALUES` numbers.

    Parameters
    ----------
    path : str
        Path of the field that determines the number of positions.
    positions, numbers : int
        Number of positions, and count of numbers at each of them.

    Raises
    ------
    BudgetError
        If the product exceeds the limit.
    """
    if positions * numbers > MAX_VALUES:
        # Report the limit in positions, because the request determines their number.
        most = MAX_VALUES // numbers
        raise BudgetError(path, compose("analyses-too-many-positions", most=most, numbers=numbers, positions=positions))
