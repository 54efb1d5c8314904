"""Hears from PostgreSQL which jobs have changed, whichever server or worker has changed them."""

from __future__ import annotations

import threading
from typing import Any

import psycopg
import structlog
from sqlalchemy import text
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.database import listening
from service.jobs.executor import Changed

CHANNEL = "mechsynth_jobs"
"""What the trigger on the table of jobs notifies."""

LISTEN_S = 1.0
"""How long a listener hears nothing of being stopped."""

RETRY_PERIOD_S = 0.5

log = structlog.get_logger(__name__)


class News(threading.Thread):
    """Tells ``changed`` the ids of jobs that have moved from one state to another, and None when it may have missed
    some.
    """

    def __init__(self, url: str, changed: Changed) -> None:
        super().__init__(name="news", daemon=True)
        self._engine = listening(url)
        self._changed = changed
        self._stopping = threading.Event()

    def stop(self) -> None:
        """Make the thread end soon; join it after."""
        self._stopping.set()

    def run(self) -> None:
        """Listen until told to stop."""
        while not self._stopping.is_set():
            try:
                self._listen()
            except Exception as error:  # psycopg's own errors come through here, and SQLAlchemy's
                if not isinstance(error, (OSError, SQLAlchemyError, psycopg.Error)):
                    log.exception("the news of the store could not be followed")
                log.warning("no news from the store", error=type(error).__name__)
                self._stopping.wait(RETRY_PERIOD_S)

    def _listen(self) -> None:
        with self._engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
            connection.execute(text(f"LISTEN {CHANNEL}"))
            driver: Any = connection.connection.driver_connection
            self._changed(None)
            while not self._stopping.is_set():
                for notice in driver.notifies(timeout=LISTEN_S):
                    self._changed(notice.payload)
