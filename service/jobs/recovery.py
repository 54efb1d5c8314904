"""Recovers the jobs of several servers: requeues those whose worker host is gone, sends lost messages again.

Every server and every worker host runs this thread, so that jobs are recovered as long as any of them lives; the store
sees to it that each job is taken up by one of them only.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import structlog
from sqlalchemy.exc import SQLAlchemyError

from service.jobs.broker import BrokerUnreachable, Publisher
from service.jobs.database import unreachable
from service.jobs.leases import LeaseStore
from service.jobs.statements import LEASE_S
from service.jobs.states import Status

PERIOD_S = 1.0

MAX_SENT_AT_ONCE = 200
"""Jobs that are sent again in one round, so that a round does not delay the next by much."""

log = structlog.get_logger(__name__)


class Recovery(threading.Thread):
    """Recovers jobs once a second until it is stopped; calls ``each_round`` as often."""

    def __init__(self, leases: LeaseStore, publisher: Publisher, each_round: Callable[[], None]) -> None:
        super().__init__(name="recovery", daemon=True)
        self._leases = leases
        self._publisher = publisher
        self._each_round = each_round
        self._stopping = threading.Event()
        self._trusted_from = float("-inf")

    def stop(self) -> None:
        """Make the thread end soon; join it after."""
        self._stopping.set()

    def run(self) -> None:
        """Recover jobs until :meth:`stop`."""
        while not self._stopping.wait(PERIOD_S):
            try:
                self._publisher.probe()
                self._each_round()
                self._take_up_abandoned()
                self._send_again()
            except SQLAlchemyError as error:
                if not unreachable(error):
                    log.exception("jobs could not be recovered")
                # Nobody could renew a lease meanwhile, so an expired one proves nothing until all have had time to.
                self._trusted_from = time.monotonic() + LEASE_S
            except Exception:  # whatever it is, the next round must come
                log.exception("jobs could not be recovered")

    def _take_up_abandoned(self) -> None:
        if time.monotonic() < self._trusted_from:
            return
        for job_id, status in self._leases.abandoned():
            log.warning("job abandoned by its worker host", job=job_id, job_is_now=status)
            if status == Status.FAILED:
                log.warning("job failed", job=job_id, reason="its workers died too often")

    def _send_again(self) -> None:
        if not self._publisher.reachable:
            return
        due = self._leases.due(MAX_SENT_AT_ONCE)
        for n, job_id in enumerate(due):
            try:
                self._publisher.send(job_id)
            except BrokerUnreachable:
                self._leases.not_sent(due[n:])
                return
        if due:
            log.info("jobs sent again", jobs=len(due))
