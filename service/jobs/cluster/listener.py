"""Listens to PostgreSQL for what becomes of jobs (``LISTEN``), whichever server or worker host has done it."""

from __future__ import annotations

import threading
from typing import Any

import psycopg
import structlog
from sqlalchemy import text
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.executor import Changed
from service.jobs.store.database import listening

CHANGES, WORK = "mechsynth_jobs", "mechsynth_work"
"""The channels that triggers on the table of jobs notify: of jobs whose states change, and of jobs in the queue."""

LISTEN_S = 1.0
"""Longest wait for a notification before the thread looks whether it is to stop."""

RETRY_PERIOD_S = 0.5
"""Pause before a lost connection is made again."""

log = structlog.get_logger(__name__)


class StoreListener(threading.Thread):
    """Calls ``told`` with what each notification holds, and with None when it may have missed some."""

    def __init__(self, url: str, channel: str, told: Changed) -> None:
        super().__init__(name="store-listener", daemon=True)
        self._engine = listening(url)
        self._channel = channel
        self._told = told
        self._stopping = threading.Event()

    def stop(self) -> None:
        """Make the thread end soon; join it after."""
        self._stopping.set()

    def run(self) -> None:
        """Listen until :meth:`stop`."""
        while not self._stopping.is_set():
            try:
                self._listen()
            except Exception as error:  # psycopg's own errors come through here, and SQLAlchemy's
                if not isinstance(error, (OSError, SQLAlchemyError, psycopg.Error)):
                    log.exception("the store could not be listened to")
                log.warning("no notifications from the store", error=type(error).__name__)
                self._stopping.wait(RETRY_PERIOD_S)

    def _listen(self) -> None:
        with self._engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text(f"LISTEN {self._channel}"))
            driver: Any = connection.connection.driver_connection
            self._told(None)
            while not self._stopping.is_set():
                for notice in driver.notifies(timeout=LISTEN_S):
                    self._told(notice.payload)
