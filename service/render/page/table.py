"""Tables as CSV: remark lines that begin with ``#``, column names with units, rows of numbers.

Numbers are written in full precision, so that reading them returns the same values; a number that is not finite is
an empty cell.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

Cell = str | int | float | None


def write_table(heads: Iterable[str], rows: Iterable[Sequence[Cell]]) -> str:
    """Write rows of words and numbers below the column names; line ends follow RFC 4180."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(heads)
    for row in rows:
        writer.writerow([format_cell(cell) if isinstance(cell, float) else cell for cell in row])
    return text.getvalue()


def format_cell(value: float) -> str:
    """Format a number in full precision; return an empty cell if it is not finite."""
    return repr(value) if math.isfinite(value) else ""


def format_rounded(value: float) -> str:
    """Format a rounded value to twelve digits; return an empty cell if it is not finite."""
    return f"{value:.12g}" if math.isfinite(value) else ""


def write_number_table(
    remarks: Iterable[str], columns: Mapping[str, ArrayLike], write: Callable[[float], str] = format_cell
) -> str:
    """Write columns of numbers below their names, after the remarks."""
    text = io.StringIO()
    text.writelines(f"# {remark}\n" for remark in remarks)
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*(np.asarray(values, dtype=np.float64).tolist() for values in columns.values()), strict=True):
        writer.writerow([write(value) for value in row])
    return text.getvalue()
