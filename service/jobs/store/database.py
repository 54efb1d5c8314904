"""The connection to the job store, and the upgrade of its tables."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal, ParamSpec, TypeVar
from urllib.parse import unquote, urlsplit

import structlog
from sqlalchemy import URL, Connection, Engine, NullPool, create_engine, event, func, make_url, select
from sqlalchemy.exc import ArgumentError, DBAPIError, InterfaceError, OperationalError, SQLAlchemyError, TimeoutError

BUSY_TIMEOUT_S = 10.0
"""How long a writer waits for another one. A write takes a millisecond, so this is never reached in good health."""


POOL_SIZE = 10
"""Connections to PostgreSQL that a server keeps; under load it takes as many again. PostgreSQL has 100 by default."""

UPGRADE_LOCK, QUEUE_LOCK = 0x6D656368, 0x6D656369
"""The numbers of our advisory locks in PostgreSQL; any that nobody else in the database uses."""

UNREACHABLE = (OperationalError, InterfaceError, TimeoutError)
"""What SQLAlchemy raises when the database is out of reach, is starting or stopping, or has no connection left."""

RETRY_PERIOD_S = 0.5
"""Pause before a write to a store that is out of reach is tried again."""

P = ParamSpec("P")
T = TypeVar("T")

log = structlog.get_logger(__name__)

# A host that vanishes without a word is noticed within 10 s; otherwise it would take the kernel a quarter of an hour.
_POSTGRESQL = {
    "application_name": "mechsynth",
    "connect_timeout": 3,
    "options": "-c synchronous_commit=on",
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
    "tcp_user_timeout": 10_000,
}


class LaterTables(Exception):
    """The tables are those of a later version, which this one cannot know; the message is for the operator."""


def connect(url: str, *, durable: bool) -> Engine:
    """An engine for the store at ``url``.

    ``durable`` decides what SQLite does at a commit. With ``synchronous=FULL`` the log is flushed to the disk each
    time, so that a commit survives a loss of power; with ``NORMAL`` it is not, and a loss of power (not of a
    process) may take the last commits back, though never break the file. The server is durable: a client that
    was told 202 relies on it. A worker is not: the worst it can lose is a finished result, and then the job is
    found unfinished and computed anew. A flush costs 0.3 ms on a virtual disk and up to 10 ms on a real one, so one
    flush a job instead of three is worth the distinction.

    PostgreSQL always waits for the disk. Its connections are looked at before they are used, so that those which a
    restart of the database has broken are replaced by new ones.
    """
    parsed = _with_driver(make_url(url))
    if parsed.get_backend_name() == "postgresql":
        return create_engine(
            parsed,
            pool_pre_ping=True,
            pool_size=POOL_SIZE if durable else 2,
            max_overflow=POOL_SIZE,
            pool_timeout=BUSY_TIMEOUT_S,
            connect_args=_POSTGRESQL,
        )
    if parsed.get_backend_name() != "sqlite":
        raise ArgumentError("the database has to be SQLite or PostgreSQL")
    if parsed.database:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(parsed, pool_size=8, max_overflow=32, connect_args={"timeout": BUSY_TIMEOUT_S})
    synchronous: Literal["FULL", "NORMAL"] = "FULL" if durable else "NORMAL"

    @event.listens_for(engine, "connect")
    def _prepare(connection: Any, _record: object) -> None:
        connection.execute("PRAGMA journal_mode=WAL")
        connection.execute(f"PRAGMA synchronous={synchronous}")

    return engine


def sqlite_file(url: str) -> Path | None:
    """The file of a SQLite store, links followed; None for other databases.

    Raises
    ------
    ArgumentError
        For what is no database URL, and for a database in memory, which the workers could not share.
    """
    parsed = make_url(url)
    if parsed.get_backend_name() != "sqlite":
        return None
    path = parsed.database or ""
    if path.startswith("file:"):
        path = unquote(urlsplit(path).path)
    if path in ("", ":memory:") or "mode=memory" in url:
        raise ArgumentError("a database in memory cannot be shared by the server and its workers")
    file = Path(path).resolve()
    if file.is_dir():
        raise ArgumentError("the database is a folder")
    return file


def listening(url: str) -> Engine:
    """An engine for one connection that stays open to hear what PostgreSQL has to tell."""
    return create_engine(_with_driver(make_url(url)), poolclass=NullPool, connect_args=_POSTGRESQL)


def unreachable(error: BaseException) -> bool:
    """Whether an error says that the store does not answer, and not that what it was asked is wrong.

    What was being written may or may not have been stored.
    """
    return isinstance(error, UNREACHABLE) or (isinstance(error, DBAPIError) and error.connection_invalidated)


def patiently(write: Callable[P, T], *args: P.args, **options: P.kwargs) -> T:
    """Write to the store, and wait for it while it is out of reach: what is to be written would be lost.

    For writes that can be repeated where nobody knows whether they were done, since they name their claim or attempt.
    """
    while True:
        try:
            return write(*args, **options)
        except SQLAlchemyError as error:
            if not unreachable(error):
                raise
            log.warning("the store is out of reach", error=type(error).__name__)
            time.sleep(RETRY_PERIOD_S)  # a store that is started again needs seconds


def _with_driver(url: URL) -> URL:
    return url.set(drivername="postgresql+psycopg") if url.drivername in ("postgresql", "postgres") else url


def upgrade(engine: Engine, revision: str = "head") -> None:
    """Bring the tables to a revision, the newest by default: wholly or, whatever dies on the way, not at all.

    Raises
    ------
    LaterTables
        When they are past every revision that is known here.
    """
    # Alembic takes a tenth of a second to import, which only the server has to spend.
    from alembic import command
    from alembic.config import Config
    from alembic.util import CommandError

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parents[1] / "migrations").replace("%", "%%"))
    with _alone(engine) as connection:
        config.attributes["connection"] = connection
        try:
            command.upgrade(config, revision)
        except CommandError as error:  # there is no such revision
            raise LaterTables(
                "the tables of the database are of a later version of mechsynth; start that one, or go back to a dump"
            ) from error


@contextmanager
def _alone(engine: Engine) -> Iterator[Connection]:
    """A connection in one transaction around all that is done with it, changes of tables included, and no other such.

    Servers and worker hosts may start at once, hence the lock. Python's driver of SQLite begins a transaction before a
    change of rows only, so that each change of a table would be committed by itself: it is told to leave that to us.
    """
    with engine.connect() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(select(func.pg_advisory_xact_lock(UPGRADE_LOCK)))
            yield connection
            connection.commit()
            return
        driver: Any = connection.connection.driver_connection
        usual, driver.isolation_level = driver.isolation_level, None
        try:
            connection.exec_driver_sql("BEGIN IMMEDIATE")
            yield connection
            connection.commit()
        finally:
            connection.rollback()
            driver.isolation_level = usual
