"""Leases: which attempts and worker hosts are alive.

Several servers and worker hosts may share a store. A *claim* is the mark of one attempt, chosen by the executor. While
the attempt runs, its *lease* is renewed, and a job with an expired lease counts as abandoned. The column ``due_at`` has
the expiry of a lease by the clock of the database.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from sqlalchemy import Engine, delete, func, insert, select, update

from service.jobs.store.schema import AnyRow, StoreClock, hosts, jobs
from service.jobs.store.statements import LEASE_S, MAX_KILLS, build_death_update
from service.jobs.store.states import Status

_HOST_FORGOTTEN_S = 3600.0
"""Age at which the row of a lost host is removed, seconds; much longer than a lease, so clock errors are harmless."""

_EXPIRED_CONDITIONS = (jobs.c.status == Status.RUNNING, jobs.c.due_at < StoreClock())


class LeaseStore:
    """Reads and changes the leases of attempts and hosts. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def renew(self, claims: Mapping[str, str]) -> set[str]:
        """Renew the leases of attempts, given as claim -> job id, and return the claims that are no longer valid.

        A claim is invalid once its job was cancelled, removed or given to another attempt.
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
        return {claim for claim, job_id in claims.items() if _is_useless(rows.get(job_id), claim)}

    def find_expired(self) -> list[str]:
        """Return the ids of running jobs with expired leases."""
        with self._engine.connect() as connection:
            return list(connection.execute(select(jobs.c.id).where(*_EXPIRED_CONDITIONS)).scalars())

    def take_back(self, job_ids: Iterable[str]) -> list[tuple[str, Status]]:
        """Requeue those of the jobs whose leases have expired: the host that ran them is gone.

        Returns
        -------
        list
            The ids of these jobs and their new states; see :meth:`service.jobs.job_store.JobStore.record_crash`.
        """
        moves = []
        for job_id in job_ids:
            # The condition is repeated here: the host may have renewed the lease since the query.
            change = build_death_update(job_id, MAX_KILLS).where(*_EXPIRED_CONDITIONS)
            with self._engine.begin() as connection:
                status = connection.execute(change).scalar_one_or_none()
            if status is not None:
                moves.append((job_id, Status(status)))
        return moves

    def record_host(self, host_id: str, workers: int) -> None:
        """Record a sign of life of a worker host and the number of its ready workers."""
        values = {"workers": workers, "seen_at": StoreClock()}
        with self._engine.begin() as connection:
            if connection.execute(update(hosts).where(hosts.c.id == host_id).values(values)).rowcount == 0:
                connection.execute(insert(hosts).values(id=host_id, **values))
                connection.execute(delete(hosts).where(hosts.c.seen_at < StoreClock() - _HOST_FORGOTTEN_S))

    def remove_host(self, host_id: str) -> None:
        """Remove a worker host that has stopped."""
        with self._engine.begin() as connection:
            connection.execute(delete(hosts).where(hosts.c.id == host_id))

    def count_workers(self) -> int:
        """Return the number of ready workers on all live hosts."""
        query = select(func.sum(hosts.c.workers)).where(hosts.c.seen_at > StoreClock() - LEASE_S)
        with self._engine.connect() as connection:
            return connection.execute(query).scalar() or 0


def _is_useless(row: AnyRow | None, claim: str) -> bool:
    # A claim stays valid when its job has ended normally: its lane is about to release it anyway.
    if row is None:
        return True
    return bool(row.status in (Status.CANCELLED, Status.QUEUED) or row.claim != claim)
