"""Listener for PostgreSQL notifications (``LISTEN``) of job changes by any server or worker host."""

from __future__ import annotations

import threading
from collections.abc import Callable

import psycopg
import structlog
from sqlalchemy import text
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.cluster.notifier import RETRY_PERIOD_S
from service.jobs.store.database import create_listener_engine

LISTEN_S = 1.0
"""Longest wait for a notification before the thread checks whether it must stop, seconds."""

log = structlog.get_logger(__name__)


class StoreListener(threading.Thread):
    """Calls back with the content of each notification, and with None if it may have missed some."""

    def __init__(self, url: str, channel: str, notify: Callable[[str | None], None]) -> None:
        super().__init__(name="store-listener", daemon=True)
        self._engine = create_listener_engine(url)
        self._channel = channel
        self._notify = notify
        self._stopping = threading.Event()

    def stop(self) -> None:
        """Request the thread to end; the caller joins it."""
        self._stopping.set()

    def run(self) -> None:
        """Listen until :meth:`stop`."""
        while not self._stopping.is_set():
            try:
                self._receive_notifications()
            except Exception as error:  # errors of psycopg and of SQLAlchemy both arrive here
                if not isinstance(error, (OSError, SQLAlchemyError, psycopg.Error)):
                    log.exception("the store could not be listened to")
                log.warning("no notifications from the store", error=type(error).__name__)
                self._stopping.wait(RETRY_PERIOD_S)

    def _receive_notifications(self) -> None:
        with self._engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text(f"LISTEN {self._channel}"))
            driver = connection.connection.driver_connection
            assert isinstance(driver, psycopg.Connection)
            # Changes before LISTEN took effect were missed: subscribers must read the store once.
            self._notify(None)
            while not self._stopping.is_set():
                for notice in driver.notifies(timeout=LISTEN_S):
                    self._notify(notice.payload)
