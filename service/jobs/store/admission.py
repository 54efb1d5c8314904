"""How something new comes into the store: once, however often it is sent, and surely, whatever breaks in between."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from sqlalchemy import ColumnElement, Connection, Engine, Table, func, select
from sqlalchemy.exc import IntegrityError, SQLAlchemyError

from service.jobs.store.database import QUEUE_LOCK, unreachable

SETTLE_S = 5.0
"""How long something new is tried to be stored when the database breaks off in the middle, so that nobody knows
whether."""

_SETTLE_PERIOD_S = 0.2
"""Pause between two such attempts; a database that restarts needs seconds."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Repeatable:
    """A request that may come again: the key that its client gave it, and a hash of what it says."""

    key: str
    request_hash: str


class QueueFull(Exception):
    """There are as many queued jobs of the tenant as there may be."""


class KeyReused(Exception):
    """A key came with another request than the one that it was first used for; carries the id of what that one made."""

    def __init__(self, made: str) -> None:
        self.job_id = made
        super().__init__(f"the key was used for {made}")


def surely(engine: Engine, there: Callable[[Connection], bool], insert: Callable[[Connection], bool]) -> None:
    """Insert in one transaction.

    A database that breaks off before it has answered may have stored what is new or not. Then it is asked again whether
    it is ``there``, for :data:`SETTLE_S` seconds.

    Raises
    ------
    QueueFull
        When ``insert`` says that it has not.
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
            # Refused before anything was asked: nothing is stored, and the client may know at once.
            broken = broken or getattr(error, "connection_invalidated", False)
            if asked_at is None or not (broken and unreachable(error)) or time.monotonic() > asked_at + SETTLE_S:
                raise
            time.sleep(_SETTLE_PERIOD_S)  # the database is being started again


def one_after_the_other(connection: Connection, tenant: str) -> None:
    """Let nobody else who asks for this insert jobs of the tenant before this transaction is at its end.

    SQLite has one writer at a time. PostgreSQL has many, who do not see each other's rows before the commit.
    """
    if connection.dialect.name == "postgresql":
        connection.execute(select(func.pg_advisory_xact_lock(QUEUE_LOCK, func.hashtext(tenant))))


def once(make: Callable[[], T], made: Callable[[], T | None]) -> tuple[T, bool]:
    """What ``make`` stores under a key, or what the same request has ``made`` under it already; and whether it is new.

    Raises
    ------
    KeyReused
        By ``made``, when another request of the tenant has used the key.
    QueueFull
        When it would be new, and there is no room.
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
            # What held the key has been removed since.


def made_by(
    engine: Engine, table: Table, columns: Iterable[ColumnElement[Any]], tenant: str, repeatable: Repeatable
) -> Sequence[Any] | None:
    """The columns of what the same request has made in the table already; None where it has made nothing.

    Raises
    ------
    KeyReused
        When another request of the tenant has used the key.
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
