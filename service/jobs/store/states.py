"""The states of a job and the permitted moves between them, in the table ``MOVES``.

The store turns each entry of the table into the ``WHERE`` clause of an ``UPDATE``, so no process can make a move that
is not in the table, even if the state has changed in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal


class Status(StrEnum):
    """State of a job."""

    QUEUED = "queued"
    RUNNING = "running"
    SUCCEEDED = "succeeded"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def finished(self) -> bool:
        """Whether the state is final."""
        return self in FINISHED_STATES


class Cost(StrEnum):
    """Estimated computing time of a job, made when it is accepted: ``short`` means a fraction of a second."""

    SHORT = "short"
    LONG = "long"


FINISHED_STATES = frozenset({Status.SUCCEEDED, Status.FAILED, Status.CANCELLED})
UNFINISHED_STATES = frozenset({Status.QUEUED, Status.RUNNING})


@dataclass(frozen=True, slots=True)
class Move:
    """A permitted change of state: the source states, the target state and the party that makes it."""

    sources: frozenset[Status]
    target: Status
    by: Literal["worker", "executor", "client"]


MOVES = {
    "claim": Move(frozenset({Status.QUEUED}), Status.RUNNING, by="executor"),
    "succeed": Move(frozenset({Status.RUNNING}), Status.SUCCEEDED, by="worker"),
    "fail": Move(frozenset({Status.RUNNING}), Status.FAILED, by="worker"),
    "requeue": Move(frozenset({Status.RUNNING}), Status.QUEUED, by="executor"),
    "give_up": Move(frozenset({Status.RUNNING}), Status.FAILED, by="executor"),
    "cancel": Move(UNFINISHED_STATES, Status.CANCELLED, by="client"),
}
"""Every permitted move by name. A finished job never moves; it can only be deleted."""
