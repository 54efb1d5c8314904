"""Inserts into the store: each request is stored once, even if it is repeated or the connection breaks."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from sqlalchemy import ColumnElement, Connection, Engine, Table, func, select
from sqlalchemy.exc import IntegrityError, SQLAlchemyError

from service.jobs.store.database import QUEUE_LOCK, is_unreachable

SETTLE_S = 5.0
"""Time for which an insert is retried after the connection broke with its outcome unknown, seconds."""

_SETTLE_PERIOD_S = 0.2
"""Pause between two such attempts, seconds; a database that restarts needs seconds."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Repeatable:
    """A request that may be repeated: the key chosen by its client, and a hash of its content."""

    key: str
    request_hash: str


class QueueFull(Exception):
    """The tenant has the maximum number of queued jobs."""


class KeyReused(Exception):
    """A key was reused for a different request; carries the id of the job or batch that the first one created."""

    def __init__(self, made: str) -> None:
        self.job_id = made
        super().__init__(f"the key was used for {made}")


def insert_confirmed(engine: Engine, there: Callable[[Connection], bool], insert: Callable[[Connection], bool]) -> None:
    """Insert a row in one transaction, and confirm it if the connection breaks.

    If the connection breaks before the answer, the row may or may not be stored. The database is then queried with
    ``there`` and the insert repeated if necessary, for :data:`SETTLE_S` seconds.

    Raises
    ------
    QueueFull
        If ``insert`` returns False.
    """
    asked_at: float | None = None
    broken = False
    while True:
        try:
            with engine.begin() as connection:
                asked_at = asked_at or time.monotonic()
                if not (broken and there(connection)) and not insert(connection):
                    raise QueueFull
            return
        except SQLAlchemyError as error:
            # Without a connection nothing can have been stored: the client gets the error at once.
            broken = broken or getattr(error, "connection_invalidated", False)
            if asked_at is None or not (broken and is_unreachable(error)) or time.monotonic() > asked_at + SETTLE_S:
                raise
            time.sleep(_SETTLE_PERIOD_S)  # the database may be restarting


def serialize_inserts(connection: Connection, tenant: str) -> None:
    """Lock the tenant's inserts for all other callers of this function until this transaction ends.

    SQLite has one writer at a time. PostgreSQL has many, which do not see each other's rows before the commit.
    """
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(QUEUE_LOCK, func.hashtext(tenant))))


def make_once(make: Callable[[], T], made: Callable[[], T | None]) -> tuple[T, bool]:
    """Return the row that ``make`` stores under a key, or the one ``made`` finds there, and whether it is new.

    Raises
    ------
    KeyReused
        By ``made``, if a different request of the tenant has used the key.
    QueueFull
        If the row is new and the queue is full.
    """
    while True:
        try:
            return make(), True
        except (IntegrityError, QueueFull) as refusal:
            earlier = made()
            if earlier is not None:
                return earlier, False
            if isinstance(refusal, QueueFull):
                raise
            # The row that held the key has been removed since; try again.


def find_earlier(
    engine: Engine, table: Table, columns: Iterable[ColumnElement[Any]], tenant: str, repeatable: Repeatable
) -> Sequence[Any] | None:
    """Return the columns of the row that the same request created before; None if there is none.

    Raises
    ------
    KeyReused
        If a different request of the tenant has used the key.
    """
    query = select(*columns, table.c.id, table.c.request_hash).where(
        table.c.tenant == tenant, table.c.idempotency_key == repeatable.key
    )
    with engine.connect() as connection:
        row = connection.execute(query).one_or_none()
    if row is None:
        return None
    *found, made, request_hash = row
    if request_hash != repeatable.request_hash:
        raise KeyReused(made)
    return found
