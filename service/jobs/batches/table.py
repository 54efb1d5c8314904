"""The table of a batch, one row for each sample, and its Pareto front."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic_core import to_json

from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.rows import BatchSummary, TableRow
from service.jobs.faults import WORKER_DIED
from service.jobs.store.states import Status

Rows = NDArray[np.float64]

SIGNED_METRICS = ("relative_error", "error")
"""Metrics that are signed errors of ratios; their absolute values are compared."""

CHUNK_ROWS = 200
"""Number of rows written in one piece."""


@dataclass(frozen=True)
class Table:
    """Columns and rows; None marks an empty cell."""

    columns: list[str]
    rows: list[list[Any]]

    def as_csv(self) -> Iterator[bytes]:
        """Yield the table as CSV (RFC 4180) in pieces.

        Numbers have all their digits; values other than numbers and texts are JSON.
        """
        yield _write_rows([self.columns])
        for rows in self._iterate_chunks():
            yield _write_rows([[_format_cell(value) for value in row] for row in rows])

    def as_json(self, **more: object) -> Iterator[bytes]:
        """Yield a JSON object of the columns, the fields ``more`` and the rows, in pieces."""
        yield to_json({"columns": self.columns, **more})[:-1] + b',"rows":['
        comma = b""
        for rows in self._iterate_chunks():
            yield comma + to_json(rows)[1:-1]
            comma = b","
        yield b"]}"

    def _iterate_chunks(self) -> Iterator[list[list[Any]]]:
        for start in range(0, len(self.rows), CHUNK_ROWS):
            yield self.rows[start : start + CHUNK_ROWS]

    def select_front(self, least: Sequence[str], greatest: Sequence[str]) -> Table:
        """Return the Pareto front: the rows for which no other row is as good in all columns and better in one.

        Rows without a number in one of these columns are ignored.

        Parameters
        ----------
        least, greatest : sequence of str
            Columns to minimize and columns to maximize. A signed error (:data:`SIGNED_METRICS`) is minimized by its
            absolute value.
        """
        signs = {**dict.fromkeys(least, 1.0), **dict.fromkeys(greatest, -1.0)}
        places = [(self.columns.index(name), sign) for name, sign in signs.items()]
        complete = [row for row in self.rows if all(_is_number(row[place]) for place, _ in places)]
        by_size = {self.columns.index(name) for name in least if name in SIGNED_METRICS}
        weighed = np.array(
            [
                [abs(row[place]) if place in by_size else sign * row[place] for place, sign in places]
                for row in complete
            ],
            float,
        )
        return Table(self.columns, [complete[n] for n in find_unbeaten(weighed.reshape(len(complete), len(places)))])


def build_table(batch: BatchSummary, plan: Plan, ended: Sequence[TableRow]) -> Table:
    """Build the current table of a batch: varied fields, outcome of each sample, its best design, its job."""
    columns = [*plan.fields, "status", "cached", "designs", *plan.metrics, "job", "failure"]
    by_number = {row.number: row for row in ended}
    nothing = [None] * (1 + len(plan.metrics))
    # In a finished batch, a sample that has not ended was cancelled with the batch or given up with its share.
    other = {Status.CANCELLED: Status.CANCELLED, Status.SUCCEEDED: Status.FAILED, Status.FAILED: Status.FAILED}
    without = other.get(batch.status, Status.QUEUED)
    lost = WORKER_DIED.detail if without == Status.FAILED else None
    rows = []
    for number in range(batch.total):
        row = by_number.get(number)
        if row is None:
            rows.append([*plan.sample(number), without.value, False, *nothing, None, lost])
            continue
        error = None if row.error is None else json.loads(row.error)["detail"]
        figures = nothing if row.figures is None else row.figures
        rows.append(
            [*plan.sample(number), row.status.value, row.cached, *figures, make_sample_id(batch.id, number), error]
        )  # fmt: skip
    return Table(columns, rows)


def find_unbeaten(table: Rows) -> list[int]:
    """Return the indices of the Pareto-optimal rows of a table, all columns minimized, in ascending order.

    Equal rows do not dominate each other. The distinct rows are sorted lexicographically; a row is dominated if an
    earlier row is as good in each other column. With two columns, the running minimum of the second decides. With more,
    a block of rows at a time is compared with the rows kept so far.

    Parameters
    ----------
    table : shape (n, m)
        Values to minimize.
    """
    if len(table) == 0:
        return []
    different, which = np.unique(table + 0.0, axis=0, return_inverse=True)  # -0.0 is 0.0
    # The first column needs no comparison: the sort has put smaller values first.
    others = different[:, 1:]
    kept = np.zeros(len(different), bool)
    if others.shape[1] < 2:
        kept[0] = True
        if others.shape[1] == 1:
            kept[1:] = others[1:, 0] < np.minimum.accumulate(others[:-1, 0])
    else:
        for start in range(0, len(different), _BLOCK_ROWS):
            block = others[start : start + _BLOCK_ROWS]
            left = np.flatnonzero(~_as_good(block, others[:start][kept[:start]]).any(axis=1))
            # Within the block only earlier rows can dominate, hence the lower triangle.
            before = np.tri(len(left), k=-1, dtype=bool)
            left = left[~(_as_good(block[left], block[left]) & before).any(axis=1)]
            kept[start + left] = True
    return [int(n) for n in np.flatnonzero(kept[which.reshape(-1)])]


_BLOCK_ROWS = 256
"""Number of rows compared with the earlier ones at a time; bounds the memory of the comparison."""


def _as_good(rows: Rows, others: Rows) -> NDArray[np.bool_]:
    """Return whether ``others[j]`` is as good as ``rows[i]`` in every column, at [i, j]; shape (n, m)."""
    as_good = np.ones((len(rows), len(others)), bool)
    for row, other in zip(rows.T, others.T, strict=True):
        as_good &= other <= row[:, None]
    return as_good


def _write_rows(rows: Iterable[Sequence[object]]) -> bytes:
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue().encode()


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _format_cell(value: object) -> object:
    if value is None or isinstance(value, str):
        return value
    return repr(value) if _is_number(value) else json.dumps(value)
