"""Limits on the size of an analysis, checked before the work begins."""

from __future__ import annotations

MAX_VALUES = 2_000_000
"""Maximum count of numbers in an answer's lists: some forty megabytes of JSON."""


class BudgetError(ValueError):
    """Raised for a request that exceeds the limit; carries the field's path and the largest permitted value."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


def require_values(path: str, positions: int, numbers: int) -> None:
    """Refuse ``numbers`` values at each of several positions if they exceed :data:`MAX_VALUES` in total.

    Parameters
    ----------
    path : str
        Path of the field that determines the number of positions.

    Raises
    ------
    BudgetError
    """
    if positions * numbers > MAX_VALUES:
        # Tell the client the limit in positions, the quantity that the request can change.
        most = MAX_VALUES // numbers
        raise BudgetError(path, f"at most {most} positions, each of which has {numbers} numbers here, got {positions}")
