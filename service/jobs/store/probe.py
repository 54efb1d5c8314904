"""Whether the store takes writes, and why not: for the readiness of a server, and for every use of a SQLite file."""

from __future__ import annotations

import os
import shutil
import sqlite3
import threading
import time
from pathlib import Path

import structlog
from sqlalchemy import Engine, func, select, text
from sqlalchemy.exc import DBAPIError, OperationalError

FRESH_S = 1.0
"""Time for which an outcome is kept, seconds: anybody may ask for it, and each check waits for the disk."""

MIN_FREE_BYTES = 16 << 20
"""Free space on the disk of a SQLite file below which it counts as full. The log of the file may have room for the
little row of a check after the disk is full; an answer to a problem takes up to a megabyte."""

STORE_SILENT = "service-store-silent"
_FILE_LOST, _FULL, _READ_ONLY = "service-store-file-lost", "service-store-full", "service-store-read-only"

# Results of SQLite, and SQLSTATE codes of PostgreSQL (disk_full, read_only_sql_transaction).
_MESSAGES = {
    sqlite3.SQLITE_FULL: _FULL,
    sqlite3.SQLITE_READONLY: _READ_ONLY,
    sqlite3.SQLITE_CANTOPEN: _FILE_LOST,
    "53100": _FULL,
    "25006": _READ_ONLY,
}

# A statement that writes and changes nothing. Alembic's table has one row in every database of the service.
_WRITE = text("UPDATE alembic_version SET version_num = version_num")

log = structlog.get_logger(__name__)


class FileLost(OperationalError):
    """The SQLite file was removed or replaced while it is open: all writes would be lost with the next restart."""

    def __init__(self, file: Path) -> None:
        super().__init__(None, None, Exception(f"the database file {file} has been removed or replaced"))


class FileWatch:
    """Remembers which file a path named when it was opened first."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._opened: tuple[int, int] | None = None

    def note_opened(self) -> None:
        """Remember the file, unless one is remembered already."""
        self._opened = self._opened or self._identify()

    def require_same(self) -> None:
        """Raise :class:`FileLost` if the path names no file now, or another one than the first."""
        if self._opened is not None and self._identify() != self._opened:
            raise FileLost(self._file)

    def _identify(self) -> tuple[int, int] | None:
        try:
            status = os.stat(self._file)
        except OSError:
            return None
        return status.st_dev, status.st_ino


class StoreProbe:
    """Checks whether the store takes writes. Safe to use from many threads."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._lock = threading.Lock()
        self._checked_at = float("-inf")
        self._fault: str | None = None

    def find_fault(self) -> str | None:
        """Return the id of the message why the store takes no writes; None if it does."""
        with self._lock:
            if time.monotonic() - self._checked_at >= FRESH_S:
                self._fault = self._check()
                self._checked_at = time.monotonic()
            return self._fault

    def _check(self) -> str | None:
        try:
            with self._engine.begin() as connection:
                connection.execute(_WRITE)
        except Exception as error:  # any error of the database driver means that the store is of no use now
            log.exception("the store takes no writes")
            return explain_error(error)
        database = self._engine.url.database
        if self._engine.dialect.name == "sqlite" and database:
            free = shutil.disk_usage(Path(database).parent).free
            if free < MIN_FREE_BYTES:
                log.error("the disk of the store is full", free=free)
                return _FULL
        return None


def measure_size(engine: Engine) -> tuple[int, int | None]:
    """Return the size of the database and, for SQLite, the free space on its disk, bytes."""
    database = engine.url.database
    if engine.dialect.name == "sqlite" and database:
        files = [Path(f"{database}{suffix}") for suffix in ("", "-wal")]
        return sum(file.stat().st_size for file in files if file.exists()), shutil.disk_usage(files[0].parent).free
    with engine.connect() as connection:
        size = connection.execute(select(func.pg_database_size(func.current_database()))).scalar_one()
    return int(size), None


def explain_error(error: Exception) -> str:
    """Return the id of the message that explains an error of the store."""
    if isinstance(error, FileLost):
        return _FILE_LOST
    cause = error.orig if isinstance(error, DBAPIError) else error
    code = getattr(cause, "sqlite_errorcode", None) or getattr(cause, "sqlstate", None)
    # The low byte of an extended result of SQLite is the result itself.
    return _MESSAGES.get(code & 0xFF if isinstance(code, int) else code, STORE_SILENT)
