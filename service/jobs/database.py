"""The connection to the job store, and the upgrade of its tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal
from urllib.parse import unquote, urlsplit

from sqlalchemy import Engine, create_engine, event, make_url
from sqlalchemy.exc import ArgumentError

BUSY_TIMEOUT_S = 10.0
"""How long a writer waits for another one. A write takes a millisecond, so this is never reached in good health."""


def connect(url: str, *, durable: bool) -> Engine:
    """An engine for the store at ``url``.

    ``durable`` decides what SQLite does at a commit. With ``synchronous=FULL`` the log is flushed to the disk each
    time, so that a commit survives a loss of power; with ``NORMAL`` it is not, and a loss of power (not of a
    process) may take the last commits back, though never break the file. The server is durable: a client that
    was told 202 relies on it. A worker is not: the worst it can lose is a finished result, and then the job is
    found unfinished and computed anew. A flush costs 0.3 ms on a virtual disk and up to 10 ms on a real one, so one
    flush a job instead of three is worth the distinction.
    """
    parsed = make_url(url)
    if parsed.get_backend_name() != "sqlite":
        return create_engine(parsed, pool_pre_ping=True)
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


def upgrade(engine: Engine, revision: str = "head") -> None:
    """Bring the tables to a revision, the newest by default."""
    # Alembic takes a tenth of a second to import, which only the server has to spend.
    from alembic import command
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", str(Path(__file__).parent / "migrations").replace("%", "%%"))
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, revision)
