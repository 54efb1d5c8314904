"""Value classes of a batch, a share and an ended sample."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Literal

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
    def ended_count(self) -> int:
        """Number of samples that have ended."""
        return self.succeeded + self.failed


@dataclass(frozen=True, slots=True)
class BatchRow(BatchSummary):
    """A batch with its request, as :meth:`service.jobs.batches.plan.Plan.dump_statement` writes it."""

    stated: str


@dataclass(frozen=True, slots=True)
class Share:
    """The rest of a share: the samples from ``first`` to before ``end``, except those already stored.

    ``alone`` is a sample that may have killed a worker: it is solved by itself in the next turn of the share.
    """

    first: int
    end: int
    alone: int | None = None

    def dump(self) -> str:
        """Return the share as JSON; its row in the job table stores that as the problem."""
        return json.dumps(asdict(self))

    @classmethod
    def read(cls, text: str) -> Share:
        """Rebuild a share from the output of :meth:`dump`."""
        return cls(**json.loads(text))


@dataclass(frozen=True, slots=True)
class EndedSample:
    """A sample that has ended: its ``result`` and its ``figures`` for the table, or its ``error``, in JSON.

    ``same_as`` is the number of an equal sample of the batch: the row then repeats its figures and has no result.
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
    """The answer to an equal problem of the same batch: the number of that sample and its figures for the table."""

    number: int
    figures: str | None


@dataclass(frozen=True, slots=True)
class TableRow:
    """The columns of an ended sample that the table of a batch needs."""

    number: int
    status: Status
    cached: bool
    figures: list[object] | None
    error: str | None
