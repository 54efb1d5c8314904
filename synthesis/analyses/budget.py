"""What an analysis may be asked for: how much, known before the work begins."""

from __future__ import annotations

MAX_VALUES = 2_000_000
"""Numbers in the lists of an answer at most: some forty megabytes of JSON."""


class BudgetError(ValueError):
    """A request for more than is computed at once; carries the field's path and the greatest value that would do."""

    def __init__(self, path: str, detail: str) -> None:
        self.path = path
        self.detail = detail
        super().__init__(f"{path}: {detail}")


def require_values(path: str, positions: int, numbers: int) -> None:
    """Refuse so many ``numbers`` at each of so many positions where they are more than :data:`MAX_VALUES`.

    Parameters
    ----------
    path : str
        Of the field that says how many positions there are.

    Raises
    ------
    BudgetError
    """
    if positions * numbers > MAX_VALUES:
        most = MAX_VALUES // numbers
        raise BudgetError(path, f"at most {most} positions, each of which has {numbers} numbers here, got {positions}")
