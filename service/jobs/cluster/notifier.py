"""Notifications of PostgreSQL (``NOTIFY``), sent in bundles after the commits that they announce.

PostgreSQL holds one lock of the whole cluster while a transaction with a notification commits and is flushed to disk.
A notification inside the transactions of jobs would therefore make all of them wait for one another. A notification by
itself has nothing to flush.

A process may die between a commit and its notification, and a notification may be lost with a connection. Nothing
relies on one: all that wait for a change also read the store, at least once a second.
"""

from __future__ import annotations

import threading

import psycopg
import structlog
from sqlalchemy import Connection, text
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.store.database import create_listener_engine

CHANGES_CHANNEL, WORK_CHANNEL = "mechsynth_jobs", "mechsynth_work"
"""Channels of changed jobs, with their ids separated by commas, and of queued jobs, with their number. The triggers of
earlier versions use the same channels, with one id and without a number."""

BUNDLE_S = 0.02
"""Shortest time between two bundles of notifications, seconds; the first one after a pause is sent at once."""

MAX_BUNDLE = 250
"""Maximum number of ids in a notification, which PostgreSQL limits to 8000 bytes; more ids are announced as any job."""

RETRY_PERIOD_S = 0.5
"""Pause before a lost connection is restored, seconds."""

_NOTIFY = text("SELECT pg_notify(:channel, :payload)")

log = structlog.get_logger(__name__)


def split_ids(payload: str | None) -> list[str | None]:
    """Return the ids of changed jobs in a notification; None stands for any job."""
    return [*payload.split(",")] if payload else [None]


def read_count(payload: str | None) -> int:
    """Return the number of queued jobs in a notification."""
    return int(payload) if payload and payload.isdecimal() else 1


class StoreNotifier(threading.Thread):
    """Notifies all servers of changed jobs, and all worker hosts of queued ones. Callable from any thread."""

    def __init__(self, url: str) -> None:
        super().__init__(name="store-notifier", daemon=True)
        self._engine = create_listener_engine(url)
        self._news = threading.Condition()
        self._changed: dict[str | None, None] = {}
        self._queued = 0
        self._stopping = threading.Event()

    def announce_change(self, job_id: str | None) -> None:
        """Announce a stored change of a job, or of any job if ``job_id`` is None."""
        with self._news:
            self._changed[job_id] = None
            self._news.notify()

    def announce_work(self) -> None:
        """Announce a queued job."""
        with self._news:
            self._queued += 1
            self._news.notify()

    def stop(self) -> None:
        """Request the thread to send what is left and to end; the caller joins it."""
        self._stopping.set()
        with self._news:
            self._news.notify()

    def run(self) -> None:
        """Send notifications until :meth:`stop`."""
        while not self._stopping.is_set():
            try:
                with self._engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
                    self._send_bundles(connection)
            except (OSError, SQLAlchemyError, psycopg.Error) as error:
                # All that wait also read the store, so that a lost bundle only costs them up to a second.
                log.warning("no notifications to the store", error=type(error).__name__)
                self._stopping.wait(RETRY_PERIOD_S)

    def _send_bundles(self, connection: Connection) -> None:
        stopping = False
        while not stopping:
            with self._news:
                self._news.wait_for(lambda: self._changed or self._queued or self._stopping.is_set())
                stopping = self._stopping.is_set()
                changed, self._changed = self._changed, {}
                queued, self._queued = self._queued, 0
            ids = [job_id for job_id in changed if job_id is not None]
            if changed:
                exact = len(ids) == len(changed) <= MAX_BUNDLE
                _notify(connection, CHANGES_CHANNEL, ",".join(ids) if exact else "")
            if queued:
                _notify(connection, WORK_CHANNEL, str(queued))
            self._stopping.wait(BUNDLE_S)


def _notify(connection: Connection, channel: str, payload: str) -> None:
    connection.execute(_NOTIFY, {"channel": channel, "payload": payload})
