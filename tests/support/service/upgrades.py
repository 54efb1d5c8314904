"""Processes that are killed while they make or upgrade the tables of a store."""

import os
import signal
import sqlite3

from sqlalchemy import event, func, select

from service.jobs.store.database import connect, upgrade
from service.jobs.store.schema import jobs

JOBS = 3  # in a store of an older version


def engine_of(folder):
    return connect(f"sqlite:///{folder / 'jobs.sqlite3'}", durable=True)


def older(folder, revision, rows=JOBS):
    """A store of an older version with some jobs in it; nothing where there was no version."""
    if revision is None:
        return
    engine = engine_of(folder)
    upgrade(engine, revision)
    engine.dispose()
    raw = sqlite3.connect(folder / "jobs.sqlite3")
    with raw:
        raw.executemany(
            "INSERT INTO jobs (id, kind, status, created_at, progress_fraction, progress_message, problem, attempt, "
            "crashes, revision) VALUES (?, 'motion', 'queued', '', 0, '', '{}', 0, 0, 1)",
            ((f"{n:026}",) for n in range(rows)),
        )
    raw.close()


def killed_at(folder, statement, moment):
    """Upgrade in a process that kills itself before or after so many statements; whether it came so far."""
    child = os.fork()
    if child == 0:
        left = [statement]

        def count(*_):
            if left[0] == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            left[0] -= 1

        try:
            engine = engine_of(folder)
            event.listen(engine, f"{moment}_cursor_execute", count)
            upgrade(engine)
        finally:
            os._exit(0)
    return os.WIFSIGNALED(os.waitpid(child, 0)[1])


def shape(engine):
    with engine.connect() as connection:
        return (
            sorted(connection.exec_driver_sql("SELECT type, name FROM sqlite_master").all()),
            connection.exec_driver_sql("SELECT version_num FROM alembic_version").all(),
        )


def is_whole(folder, rows):
    """Whether a start finds or makes the tables of an undisturbed one, with all jobs in them."""
    engine, undisturbed = engine_of(folder), connect(f"sqlite:///{folder / 'undisturbed.sqlite3'}", durable=False)
    try:
        upgrade(engine)
        upgrade(undisturbed)
        with engine.connect() as connection:
            there = connection.execute(select(func.count()).select_from(jobs)).scalar()
        return (shape(engine), there) == (shape(undisturbed), rows)
    finally:
        engine.dispose()
        undisturbed.dispose()


def dies_everywhere(path, revision, moment, statements):
    """Kill upgrades of stores of a revision, each at one of the statements; how many died."""
    died = 0
    for n in statements:
        folder = path / f"{n}"
        folder.mkdir()
        older(folder, revision)
        if not killed_at(folder, n, moment):
            break
        died += 1
        assert is_whole(folder, 0 if revision is None else JOBS), f"killed {moment} statement {n}"
    return died
