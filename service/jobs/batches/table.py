"""The table of a batch: a row for each sample, and those rows that no other beats."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import sample_id
from service.jobs.batches.rows import BatchSummary, TableRow
from service.jobs.faults import WORKER_DIED
from service.jobs.states import Status


@dataclass(frozen=True)
class Table:
    """Rows by columns; None where a sample has nothing in a column."""

    columns: list[str]
    rows: list[list[Any]]

    def as_csv(self) -> str:
        """The table as CSV (RFC 4180). Numbers have all their digits; what is no number and no text is JSON."""
        text = io.StringIO()
        writer = csv.writer(text)
        writer.writerow(self.columns)
        writer.writerows([_cell(value) for value in row] for row in self.rows)
        return text.getvalue()

    def front(self, least: Sequence[str], greatest: Sequence[str]) -> Table:
        """The rows that no other beats: none is as good in all of these columns and better in one.

        Rows that lack a number in one of them are not looked at.

        Parameters
        ----------
        least, greatest : sequence of str
            Columns in which less is better, and in which more is.
        """
        signs = {**dict.fromkeys(least, 1.0), **dict.fromkeys(greatest, -1.0)}
        places = [(self.columns.index(name), sign) for name, sign in signs.items()]
        complete = [row for row in self.rows if all(_number(row[place]) for place, _ in places)]
        weighed = np.array([[sign * row[place] for place, sign in places] for row in complete], float)
        return Table(self.columns, [complete[n] for n in unbeaten(weighed.reshape(len(complete), len(places)))])


def table_of(batch: BatchSummary, plan: Plan, ended: Sequence[TableRow]) -> Table:
    """The table of a batch as it stands: the varied fields, what came of the sample, its best design, its job."""
    columns = [*plan.fields, "status", "cached", "designs", *plan.metrics, "job", "error"]
    by_number = {row.number: row for row in ended}
    nothing = [None] * (1 + len(plan.metrics))
    # Of a finished batch, what has not ended was cancelled with it, or given up with its share.
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
            [*plan.sample(number), row.status.value, row.cached, *figures, sample_id(batch.id, number), error]
        )  # fmt: skip
    return Table(columns, rows)


def unbeaten(table: np.ndarray[Any, np.dtype[np.float64]]) -> list[int]:
    """The rows of a table, less being better in each column, that no other beats, in their order.

    Each is compared with those that are kept so far, in the order of the first column, among equals of the second, and
    so on: what beats a row stands before it.
    """
    kept: list[int] = []
    for n in np.lexsort(table.T[::-1]):
        before = table[kept]
        if not ((before <= table[n]).all(axis=1) & (before < table[n]).any(axis=1)).any():
            kept.append(int(n))
    return sorted(kept)


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _cell(value: Any) -> Any:
    if value is None or isinstance(value, str):
        return value
    return repr(value) if _number(value) else json.dumps(value)
