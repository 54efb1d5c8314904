"""``mechsynth backup`` and ``mechsynth upgrade``: copy the database of a running service, upgrade its tables."""

from __future__ import annotations

import os
import sqlite3
import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.store.database import LaterTables, connect, find_sqlite_file, list_missing_revisions, upgrade
from service.settings import Settings


class MaintenanceFailure(Exception):
    """The command failed; the message is for the operator."""


def back_up(settings: Settings, target: Path) -> None:
    """Copy the SQLite database to a new file while the service may be running, and check the copy.

    Raises
    ------
    MaintenanceFailure
        If the database is not SQLite or missing, the file exists, or the copy is not sound.
    """
    file = _find_file(settings)
    if file is None:
        raise MaintenanceFailure("PostgreSQL has a program for backups: pg_dump --format=custom")
    if target.exists():
        raise MaintenanceFailure(f"{target} exists; give the name of a new file")
    part = target.with_name(f"{target.name}.part")
    try:
        part.unlink(missing_ok=True)
        _copy_database(file, part)
        part.rename(target)
    except (sqlite3.Error, OSError) as error:
        part.unlink(missing_ok=True)
        raise MaintenanceFailure(f"cannot copy the database: {error}") from None
    print(f"{target}: {target.stat().st_size / 1e6:.1f} MB", file=sys.stderr)


def run_upgrade(settings: Settings, *, only_check: bool) -> bool:
    """Upgrade the tables, or only report whether that is necessary; return whether they are current now.

    Raises
    ------
    MaintenanceFailure
        If the database cannot be used, or belongs to a later version.
    """
    if only_check:
        _find_file(settings)  # a check makes no new database
    with _open_store(settings) as engine:
        missing = list_missing_revisions(engine)
        if not missing:
            print("the tables are those of this version", file=sys.stderr)
            return True
        steps = ", ".join(missing)
        if only_check:
            print(f"the tables need these steps: {steps}; back up the database, then start this version")
            return False
        upgrade(engine)
        print(f"the tables have been upgraded: {steps}", file=sys.stderr)
        return True


def _find_file(settings: Settings) -> Path | None:
    """Return the file of a SQLite database, which exists; None for PostgreSQL."""
    try:
        file = find_sqlite_file(settings.store_url)
    except SQLAlchemyError as error:
        raise _describe_database_error(error) from None
    if file is not None and not file.exists():
        raise MaintenanceFailure(f"there is no database {file}; set MECHSYNTH_DATA_DIR or MECHSYNTH_DATABASE_URL")
    return file


def _copy_database(file: Path, target: Path) -> None:
    """Copy a database by SQLite's online backup, which includes its log and waits for no writer."""
    with (
        closing(sqlite3.connect(f"{file.as_uri()}?mode=ro", uri=True)) as source,
        closing(sqlite3.connect(target)) as copy,
    ):
        source.backup(copy)
        (outcome,) = copy.execute("PRAGMA quick_check").fetchone()
        if outcome != "ok":
            raise sqlite3.DatabaseError(f"the copy is damaged: {outcome}")
    with target.open("rb") as written:
        os.fsync(written.fileno())


@contextmanager
def _open_store(settings: Settings) -> Iterator[Engine]:
    try:
        engine = connect(settings.store_url, durable=True)
        try:
            yield engine
        finally:
            engine.dispose()
    except LaterTables as error:
        raise MaintenanceFailure(str(error)) from None
    except (SQLAlchemyError, ImportError, OSError) as error:
        raise _describe_database_error(error) from None


def _describe_database_error(error: Exception) -> MaintenanceFailure:
    # The message omits the URL, which may contain a password.
    return MaintenanceFailure(f"cannot use the database ({type(error).__name__}); set MECHSYNTH_DATABASE_URL")
