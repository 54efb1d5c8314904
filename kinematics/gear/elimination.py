"""Linear equations with named unknowns, solved exactly over the rationals."""

from __future__ import annotations

from fractions import Fraction


class Elimination:
    """Gauss–Jordan elimination over the rationals, one equation at a time; reduced rows are stored by their pivot."""

    def __init__(self, unknowns: tuple[str, ...]) -> None:
        self._unknowns = unknowns
        self._rows: dict[str, tuple[dict[str, Fraction], Fraction]] = {}

    @property
    def rank(self) -> int:
        """Number of independent equations."""
        return len(self._rows)

    def add(self, row: dict[str, Fraction], right: Fraction) -> bool:
        """Add an equation; return False if it contradicts the earlier ones, which then stay unchanged."""
        for pivot, (known, value) in self._rows.items():
            share = row.get(pivot)
            if share:
                row, right = _subtract(row, known, share), right - share * value
        row = {name: c for name, c in row.items() if c}
        # A dependent equation: consistent only if its right side vanishes too.
        if not row:
            return right == 0
        pivot, lead = next(iter(row.items()))
        row, right = {name: c / lead for name, c in row.items()}, right / lead
        for other, (known, value) in self._rows.items():
            share = known.get(pivot)
            # Keep the rows fully reduced, so that values can be read off at any time.
            if share:
                self._rows[other] = (_subtract(known, row, share), value - share * right)
        self._rows[pivot] = (row, right)
        return True

    def values(self) -> dict[str, Fraction | None]:
        """Return the unknowns that the equations determine, None for the others."""
        solution: dict[str, Fraction | None] = dict.fromkeys(self._unknowns)
        for pivot, (row, right) in self._rows.items():
            if all(name == pivot or not c for name, c in row.items()):
                solution[pivot] = right
        return solution


def _subtract(row: dict[str, Fraction], subtrahend: dict[str, Fraction], share: Fraction) -> dict[str, Fraction]:
    return {
        name: row.get(name, Fraction(0)) - share * subtrahend.get(name, Fraction(0)) for name in {**row, **subtrahend}
    }
