"""Connections to the job store, and the upgrade of its tables."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Literal, ParamSpec, TypeVar
from urllib.parse import unquote, urlsplit

import structlog
from sqlalchemy import URL, Connection, Engine, NullPool, create_engine, event, func, make_url, select
from sqlalchemy.exc import ArgumentError, DBAPIError, InterfaceError, OperationalError, SQLAlchemyError, TimeoutError

from service.jobs.store.probe import FileWatch

if TYPE_CHECKING:
    from alembic.config import Config

BUSY_TIMEOUT_S = 10.0
"""Time that a writer waits for another one, seconds. A write takes a millisecond, so healthy systems never reach it."""


POOL_SIZE = 10
"""Number of PostgreSQL connections that a server keeps, doubled under load. PostgreSQL allows 100 by default."""

UPGRADE_LOCK, QUEUE_LOCK = 0x6D656368, 0x6D656369
"""Keys of our advisory locks in PostgreSQL; arbitrary, but unique in the database."""

UNREACHABLE_ERRORS = (OperationalError, InterfaceError, TimeoutError)
"""Errors of SQLAlchemy for a database that is unreachable, starting, stopping, or out of connections."""

RETRY_PERIOD_S = 0.5
"""Pause before a write to an unreachable store is retried, seconds."""

P = ParamSpec("P")
T = TypeVar("T")

log = structlog.get_logger(__name__)

# A host that vanishes silently is noticed within 10 s; with the kernel's defaults it would take a quarter of an hour.
_POSTGRESQL_OPTIONS = {
    "application_name": "mechsynth",
    "connect_timeout": 3,
    "options": "-c synchronous_commit=on",
    "keepalives_idle": 5,
    "keepalives_interval": 2,
    "keepalives_count": 3,
    "tcp_user_timeout": 10_000,
}


class LaterTables(Exception):
    """The tables belong to a later version; the message is for the operator."""

    def __init__(self) -> None:
        super().__init__(
            "the database tables belong to a later version of mechsynth; start that version or restore a dump"
        )


def connect(url: str, *, durable: bool) -> Engine:
    """Create an engine for the store at ``url``.

    ``durable`` sets the behaviour of SQLite at a commit. With ``synchronous=FULL`` it flushes the log to disk, so that
    a commit survives a power failure. With ``NORMAL`` it does not: a power failure (not the death of a process) may
    undo the last commits, but never corrupts the file. The server is durable, because a client relies on the answer
    202. A worker is not: at worst a finished result is lost, and the job is computed again. A flush costs 0.3 ms on a
    virtual disk and up to 10 ms on a real one, so one flush per job instead of three is worth the distinction.

    PostgreSQL always waits for the disk. Its connections are tested before use, so that those broken by a restart of
    the database are replaced.
    """
    parsed = _with_driver(make_url(url))
    if parsed.get_backend_name() == "postgresql":
        return create_engine(
            parsed,
            pool_pre_ping=True,
            # Worker processes write one thing at a time and need few connections.
            pool_size=POOL_SIZE if durable else 2,
            max_overflow=POOL_SIZE,
            pool_timeout=BUSY_TIMEOUT_S,
            connect_args=_POSTGRESQL_OPTIONS,
        )
    if parsed.get_backend_name() != "sqlite":
        raise ArgumentError("the database must be SQLite or PostgreSQL")
    if parsed.database:
        Path(parsed.database).parent.mkdir(parents=True, exist_ok=True)
    engine = create_engine(parsed, pool_size=8, max_overflow=32, connect_args={"timeout": BUSY_TIMEOUT_S})
    synchronous: Literal["FULL", "NORMAL"] = "FULL" if durable else "NORMAL"

    file = find_sqlite_file(url)
    watch = None if file is None else FileWatch(file)

    @event.listens_for(engine, "connect")
    def _prepare(connection: sqlite3.Connection, _record: object) -> None:
        connection.execute("PRAGMA journal_mode=WAL")
        connection.execute(f"PRAGMA synchronous={synchronous}")
        if watch is not None:
            watch.note_opened()

    if watch is not None:
        # The check costs two microseconds before each use. Without it, jobs would be stored in a removed file and lost
        # with the next restart, and a new connection would empty the log of the missing file.
        event.listen(engine, "do_connect", lambda *_: watch.require_same())
        event.listen(engine, "checkout", lambda *_: watch.require_same())

    return engine


def find_sqlite_file(url: str) -> Path | None:
    """Return the file of a SQLite store with links resolved; None for other databases.

    Raises
    ------
    ArgumentError
        If the URL is invalid, or names a database in memory, which the workers could not share.
    """
    parsed = make_url(url)
    if parsed.get_backend_name() != "sqlite":
        return None
    path = parsed.database or ""
    if path.startswith("file:"):
        path = unquote(urlsplit(path).path)
    if path in ("", ":memory:") or "mode=memory" in url:
        raise ArgumentError("the server and its workers cannot share a database in memory")
    file = Path(path).resolve()
    if file.is_dir():
        raise ArgumentError("the path of the database is a folder")
    return file


def create_listener_engine(url: str) -> Engine:
    """Create an engine for one connection that stays open for PostgreSQL notifications."""
    return create_engine(_with_driver(make_url(url)), poolclass=NullPool, connect_args=_POSTGRESQL_OPTIONS)


def is_unreachable(error: BaseException) -> bool:
    """Return whether an error means that the store does not answer, as opposed to a wrong statement.

    The outcome of a write that failed like this is unknown.
    """
    return isinstance(error, UNREACHABLE_ERRORS) or (isinstance(error, DBAPIError) and error.connection_invalidated)


def write_when_reachable(write: Callable[P, T], *args: P.args, **options: P.kwargs) -> T:
    """Write to the store, retrying while it is unreachable: the data would be lost otherwise.

    The write must be repeatable with its outcome unknown; it is if it names its claim or attempt.
    """
    while True:
        try:
            return write(*args, **options)
        except SQLAlchemyError as error:
            if not is_unreachable(error):
                raise
            log.warning("the store is out of reach", error=type(error).__name__)
            time.sleep(RETRY_PERIOD_S)  # a store that restarts needs seconds


def _with_driver(url: URL) -> URL:
    return url.set(drivername="postgresql+psycopg") if url.drivername in ("postgresql", "postgres") else url


def upgrade(engine: Engine, revision: str = "head") -> None:
    """Upgrade the tables to a revision, the newest by default, in one transaction: completely or not at all.

    Raises
    ------
    LaterTables
        If they are beyond every revision known to this version.
    """
    # The import of Alembic takes a tenth of a second, which only the server needs to spend.
    from alembic import command
    from alembic.util import CommandError

    config = _configure_alembic()
    with _begin_exclusive(engine) as connection:
        config.attributes["connection"] = connection
        try:
            command.upgrade(config, revision)
        except CommandError as error:  # the revision of the tables is unknown here
            raise LaterTables from error


def list_missing_revisions(engine: Engine) -> list[str]:
    """Return the revisions of the tables from the present one to the newest, in order, without changing anything.

    Raises
    ------
    LaterTables
        If the tables are beyond every revision known to this version.
    """
    from alembic.migration import MigrationContext
    from alembic.script import ScriptDirectory
    from alembic.script.revision import ResolutionError

    scripts = ScriptDirectory.from_config(_configure_alembic())
    with engine.connect() as connection:
        current = MigrationContext.configure(connection).get_current_revision()
    try:
        steps = [step.revision for step in scripts.iterate_revisions("head", current or "base")]
    except ResolutionError as error:
        raise LaterTables from error
    return steps[::-1]


def _configure_alembic() -> Config:
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parents[1] / "migrations").replace("%", "%%"))
    return config


@contextmanager
def _begin_exclusive(engine: Engine) -> Iterator[Connection]:
    """Open a connection with one exclusive transaction around all its work, changes of tables included.

    Servers and worker hosts may start at once, hence the lock. Python's SQLite driver begins transactions only before
    changes of rows and would commit each change of a table by itself, so its transaction control is switched off.
    """
    with engine.connect() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(select(func.pg_advisory_xact_lock(UPGRADE_LOCK)))
            yield connection
            connection.commit()
            return
        driver = connection.connection.driver_connection
        assert isinstance(driver, sqlite3.Connection)
        usual, driver.isolation_level = driver.isolation_level, None
        try:
            connection.exec_driver_sql("BEGIN IMMEDIATE")
            yield connection
            connection.commit()
        finally:
            connection.rollback()
            driver.isolation_level = usual
