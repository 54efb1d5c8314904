"""The states of a job and who may move it from one to another: one table, ``MOVES``.

The store turns every row of the table into the ``WHERE`` clause of an ``UPDATE``, so that a move that is not
in the table cannot happen, whichever process asks for it and whatever happened in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal


class Status(StrEnum):
    """Where a job stands."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def finished(self) -> bool:
        """Whether the job will never change again."""
        return self in FINISHED


class Cost(StrEnum):
    """How long a job is taken to compute: ``short`` is a fraction of a second. An estimate, made when it is stated."""

    SHORT = "short"
    LONG = "long"


FINISHED = frozenset({Status.SUCCEEDED, Status.FAILED, Status.CANCELLED})
UNFINISHED = frozenset({Status.QUEUED, Status.RUNNING})


@dataclass(frozen=True, slots=True)
class Move:
    """A permitted change of state: from where, to where, and who makes it."""

    sources: frozenset[Status]
    target: Status
    by: Literal["worker", "executor", "client"]


MOVES = {
    "claim": Move(frozenset({Status.QUEUED}), Status.RUNNING, by="executor"),
    "succeed": Move(frozenset({Status.RUNNING}), Status.SUCCEEDED, by="worker"),
    "fail": Move(frozenset({Status.RUNNING}), Status.FAILED, by="worker"),
    "requeue": Move(frozenset({Status.RUNNING}), Status.QUEUED, by="executor"),
    "give_up": Move(frozenset({Status.RUNNING}), Status.FAILED, by="executor"),
    "cancel": Move(UNFINISHED, Status.CANCELLED, by="client"),
}
"""Every permitted move by name. A finished job never moves; it can only be deleted."""
