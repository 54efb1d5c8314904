"""A batch, a share of it and an ended sample as values."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any, Literal

from service.jobs.store.schema import Entry
from service.jobs.store.states import Status


@dataclass(frozen=True, slots=True)
class BatchSummary(Entry):
    """A batch without its plan."""

    total: int
    succeeded: int
    failed: int
    cached: int
    revision: int

    @property
    def done(self) -> int:
        """How many of its samples have ended."""
        return self.succeeded + self.failed


@dataclass(frozen=True, slots=True)
class BatchRow(BatchSummary):
    """A batch with what was stated, as :meth:`service.jobs.batches.plan.Plan.stated_as_json` has it."""

    stated: str


@dataclass(frozen=True, slots=True)
class Share:
    """What is left of a share: the samples from ``first`` to before ``end``, but for those that are stored already.

    ``alone`` is one that a worker has died of, or may have: in the next turn of the share it comes by itself.
    """

    first: int
    end: int
    alone: int | None = None

    def written(self) -> str:
        """The share in JSON, as its row among the jobs has it for a problem."""
        return json.dumps(asdict(self))

    @classmethod
    def read(cls, text: str) -> Share:
        """The share that :meth:`written` has written."""
        return cls(**json.loads(text))


@dataclass(frozen=True, slots=True)
class Ended:
    """A sample that has ended: its ``result`` with the ``figures`` of it for the table, or its ``error``, in JSON.

    One that is the ``same_as`` another of its batch, by the number of that one, has its figures and no result itself.
    """

    number: int
    status: Literal[Status.SUCCEEDED, Status.FAILED]
    started_at: str
    finished_at: str
    cached: bool = False
    digest: str | None = None
    same_as: int | None = None
    figures: str | None = None
    error: str | None = None
    result: str | None = None


@dataclass(frozen=True, slots=True)
class OwnAnswer:
    """The answer of an equal problem of the same batch: the number of that sample, and its figures for the table."""

    number: int
    figures: str | None


@dataclass(frozen=True, slots=True)
class TableRow:
    """What the table of a batch has of an ended sample."""

    number: int
    status: Status
    cached: bool
    figures: list[Any] | None
    error: str | None
