"""Recovery of the jobs of several servers: requeues those whose worker host is gone.

Every server and every worker host runs this thread, so jobs are recovered as long as one of them is alive. The store
ensures that only one of them requeues a given job.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.cluster.leases import LeaseStore
from service.jobs.store.database import is_unreachable
from service.jobs.store.statements import LEASE_S
from service.jobs.store.states import Status

PERIOD_S = 1.0

log = structlog.get_logger(__name__)


class Recovery(threading.Thread):
    """Recovers jobs and calls ``each_round`` once a second until it is stopped."""

    def __init__(self, leases: LeaseStore, each_round: Callable[[], None] = lambda: None) -> None:
        super().__init__(name="recovery", daemon=True)
        self._leases = leases
        self._each_round = each_round
        self._stopping = threading.Event()
        self._trusted_from = float("-inf")

    def stop(self) -> None:
        """Request the thread to end; the caller joins it."""
        self._stopping.set()

    def run(self) -> None:
        """Recover jobs until :meth:`stop`."""
        while not self._stopping.wait(PERIOD_S):
            try:
                self._each_round()
                self._take_up_abandoned()
            except SQLAlchemyError as error:
                if not is_unreachable(error):
                    log.exception("jobs could not be recovered")
                # No host could renew its leases meanwhile, so expired leases prove nothing until every host has had
                # time to renew its own.
                self._trusted_from = time.monotonic() + LEASE_S
            except Exception:  # the next round must come after any error
                log.exception("jobs could not be recovered")

    def _take_up_abandoned(self) -> None:
        # Query even before the answer can be trusted: it shows whether the store is back.
        expired = self._leases.find_expired()
        if time.monotonic() < self._trusted_from:
            return
        for job_id, status in self._leases.take_back(expired):
            log.warning("job abandoned by its worker host", job=job_id, job_is_now=status)
            if status == Status.FAILED:
                log.warning("job failed", job=job_id, reason="its workers died too often")
