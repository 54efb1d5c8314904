"""Tables as CSV: lines of remarks that begin with ``#``, the columns' names with their units, rows of numbers.

Numbers are written in full precision, so that reading them gives the same numbers; a number that is not finite is an
empty cell.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

Cell = str | int | float | None


def table(heads: Iterable[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Rows of words and numbers below the columns' names; lines end as RFC 4180 wants them."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(heads)
    for row in rows:
        writer.writerow([written(cell) if isinstance(cell, float) else cell for cell in row])
    return text.getvalue()


def written(value: float) -> str:
    """A number in full precision; an empty cell where it is not finite."""
    return repr(value) if math.isfinite(value) else ""


def short(value: float) -> str:
    """A number to twelve digits, for values that were rounded before; an empty cell where it is not finite."""
    return f"{value:.12g}" if math.isfinite(value) else ""


def numbers(remarks: Iterable[str], columns: Mapping[str, ArrayLike], write: Callable[[float], str] = written) -> str:
    """Columns of numbers below their names, and the remarks above them."""
    text = io.StringIO()
    text.writelines(f"# {remark}\n" for remark in remarks)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*(np.asarray(values, dtype=np.float64).tolist() for values in columns.values()), strict=True):
        writer.writerow([write(value) for value in row])
    return text.getvalue()
