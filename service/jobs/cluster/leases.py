"""Leases: which attempts and worker hosts are alive.

Several servers and worker hosts may share a store. Words: a *claim* is the mark of one attempt, chosen by whoever has
it run; as long as the attempt goes on, its *lease* is renewed, and when that has expired the job is abandoned. Leases
go by the clock of the database, in ``due_at``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from sqlalchemy import Engine, delete, func, insert, select, update

from service.jobs.store.schema import StoreClock, hosts, jobs
from service.jobs.store.statements import LEASE_S, MAX_KILLS, died
from service.jobs.store.states import Status

_HOST_FORGOTTEN_S = 3600.0
"""Rows of hosts that vanished are removed after this: long after their lease, so that the clocks do not matter."""

_EXPIRED = (jobs.c.status == Status.RUNNING, jobs.c.due_at < StoreClock())


class LeaseStore:
    """Reads and changes the leases of attempts and hosts. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def renew(self, claims: Mapping[str, str]) -> set[str]:
        """Renew the leases of attempts, given as jobs by their claims; names the claims that are of no use any more.

        Those are of jobs that were cancelled, or removed, or that another attempt has been given.
        """
        if not claims:
            return set()
        change = (
            update(jobs)
            .where(jobs.c.status == Status.RUNNING, jobs.c.claim.in_(claims))
            .values(due_at=StoreClock() + LEASE_S)
        )
        query = select(jobs.c.id, jobs.c.status, jobs.c.claim).where(jobs.c.id.in_(set(claims.values())))
        with self._engine.begin() as connection:
            connection.execute(change)
            rows = {row.id: row for row in connection.execute(query)}
        return {claim for claim, job_id in claims.items() if _useless(rows.get(job_id), claim)}

    def expired(self) -> list[str]:
        """The running jobs whose leases are over."""
        with self._engine.connect() as connection:
            return list(connection.execute(select(jobs.c.id).where(*_EXPIRED)).scalars())

    def take_back(self, job_ids: Iterable[str]) -> list[tuple[str, Status]]:
        """Take those of these jobs whose leases are over back into the queue: whoever ran them is gone.

        Returns
        -------
        list
            These jobs, and what they are now; like :meth:`service.jobs.job_store.JobStore.crashed`.
        """
        moves = []
        for job_id in job_ids:
            change = died(job_id, MAX_KILLS).where(*_EXPIRED)
            with self._engine.begin() as connection:
                status = connection.execute(change).scalar_one_or_none()
            if status is not None:
                moves.append((job_id, Status(status)))
        return moves

    def host_is_there(self, host_id: str, workers: int) -> None:
        """Note a sign of life of a worker host, and how many of its workers are ready."""
        values = {"workers": workers, "seen_at": StoreClock()}
        with self._engine.begin() as connection:
            if connection.execute(update(hosts).where(hosts.c.id == host_id).values(values)).rowcount == 0:
                connection.execute(insert(hosts).values(id=host_id, **values))
                connection.execute(delete(hosts).where(hosts.c.seen_at < StoreClock() - _HOST_FORGOTTEN_S))

    def host_is_gone(self, host_id: str) -> None:
        """Forget a worker host that has stopped."""
        with self._engine.begin() as connection:
            connection.execute(delete(hosts).where(hosts.c.id == host_id))

    def workers(self) -> int:
        """How many workers are ready on all hosts that are there."""
        query = select(func.sum(hosts.c.workers)).where(hosts.c.seen_at > StoreClock() - LEASE_S)
        with self._engine.connect() as connection:
            return connection.execute(query).scalar() or 0


def _useless(row: Any, claim: str) -> bool:
    # A job that has ended by itself is about to be done with.
    if row is None:
        return True
    return bool(row.status in (Status.CANCELLED, Status.QUEUED) or row.claim != claim)
