"""The job store: the SQL rows that are the truth about every job.

Every change is a single ``UPDATE`` whose ``WHERE`` clause holds the states that the change may start from
(:data:`service.jobs.store.states.MOVES`) and, for what a worker writes, the number of its attempt. A change that comes
too late matches no row and is refused; there is nothing to read before, and so nothing to go stale in between.

Several servers and worker hosts may share a store; what only they need is in :mod:`service.jobs.cluster.leases`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Engine, delete, func, select, text, update
from ulid import ULID

from service.jobs.batches.reading import sample_as_job, samples_as_jobs
from service.jobs.store.admission import Repeatable, made_by, once, one_after_the_other, surely
from service.jobs.store.schema import QUEUED, Claim, JobRow, JobSummary, as_stored, as_values, jobs, now
from service.jobs.store.statements import (
    BACK_IN_QUEUE,
    BY_ID,
    CLAIM,
    CLAIMED,
    COLUMNS,
    COUNT_QUEUED,
    FAIL,
    INSERT,
    MAX_CRASHES,
    MAX_IDS,
    MAX_KILLS,
    NEXT,
    NEXT_OF_OTHERS,
    NO_KEY,
    SINGLE,
    SUCCEED,
    SUMMARY,
    WHOLE,
    died,
    moved,
    new_row,
    turn_as_long,
)
from service.jobs.store.states import FINISHED, MOVES, UNFINISHED, Cost, Status

_FEW = 8
"""Of a tenant who has more jobs than this in the queue, one is stored after the other, so that each gets a turn of its
own. Below, jobs that come at once may share one."""

_CROWD = 500
"""More servers' connections than can insert at once: so far from its limit, a queue needs no exact count."""

_NO_END = 1 << 30

_MESSAGE_LENGTH = 200  # the width of its column


class JobStore:
    """Reads and changes the rows. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def ping(self) -> None:
        """Ask the database for a sign of life; raises SQLAlchemy's error when there is none."""
        with self._engine.connect() as connection:
            connection.execute(text("SELECT 1"))

    def create(
        self,
        *,
        tenant: str,
        kind: str,
        label: str | None,
        problem: str,
        cost: Cost = Cost.LONG,
        max_queued: int | None = None,
    ) -> JobRow:
        """Store a new job in the queue. When this returns, the job is on the disk.

        Where the database breaks off the id makes sure that there is one job in the end
        (:func:`service.jobs.store.admission.surely`).

        Raises
        ------
        QueueFull
            When ``max_queued`` jobs of the tenant are queued already.
        """
        return self._insert({**new_row(tenant, kind, label, problem, cost), **NO_KEY}, max_queued)

    def create_once(
        self,
        *,
        tenant: str,
        kind: str,
        label: str | None,
        problem: str,
        repeatable: Repeatable,
        cost: Cost = Cost.LONG,
        max_queued: int | None = None,
    ) -> tuple[JobRow, bool]:
        """Like :meth:`create`, or find the job that the same request has made already.

        Returns
        -------
        tuple
            The job, and whether it is new.

        Raises
        ------
        KeyReused
            When another request of the tenant has made a job under this key.
        QueueFull
            When the job would be new, and ``max_queued`` jobs of the tenant are queued already.
        """
        row = {
            **new_row(tenant, kind, label, problem, cost),
            "idempotency_key": repeatable.key,
            "request_hash": repeatable.request_hash,
        }
        return once(lambda: self._insert(row, max_queued), lambda: self._made_by(tenant, repeatable))

    def _insert(self, row: dict[str, Any], max_queued: int | None) -> JobRow:
        surely(
            self._engine,
            lambda connection: _there(connection, row["id"]),
            lambda connection: _inserted(connection, row, max_queued),
        )
        return JobRow(**{name: row[name] for name in COLUMNS})

    def _made_by(self, tenant: str, repeatable: Repeatable) -> JobRow | None:
        row = made_by(self._engine, jobs, WHOLE, tenant, repeatable)
        return None if row is None else JobRow(*as_values(row))

    def get(self, job_id: str) -> JobRow | None:
        """The job, or None where there is none; a problem of a batch that has ended is one, too."""
        with self._engine.connect() as connection:
            row = connection.execute(BY_ID, {"job": job_id}).one_or_none()
            return sample_as_job(connection, job_id) if row is None else JobRow(*as_values(row))

    def unfinished(self) -> dict[str, int]:
        """How many jobs are in each of the states that are not final."""
        query = select(jobs.c.status, func.count()).where(jobs.c.status.in_(UNFINISHED)).group_by(jobs.c.status)
        with self._engine.connect() as connection:
            counts = {row[0]: row[1] for row in connection.execute(query)}
        return {status.value: counts.get(status.value, 0) for status in (Status.QUEUED, Status.RUNNING)}

    def summaries(self, job_ids: Sequence[str]) -> dict[str, JobSummary]:
        """The jobs of these ids that there are, by id."""
        by_id: dict[str, JobSummary] = {}
        with self._engine.connect() as connection:
            for start in range(0, len(job_ids), MAX_IDS):
                query = select(*SUMMARY).where(jobs.c.id.in_(job_ids[start : start + MAX_IDS]), SINGLE)
                for row in connection.execute(query):
                    by_id[row.id] = JobSummary(*as_values(row))
            by_id |= samples_as_jobs(connection, [job_id for job_id in job_ids if job_id not in by_id])
        return by_id

    def page(
        self,
        *,
        tenant: str,
        limit: int,
        status: Status | None = None,
        kind: str | None = None,
        before: str | None = None,
    ) -> list[JobSummary]:
        """At most ``limit`` jobs of a tenant, newest first, from those older than the job ``before``."""
        query = select(*SUMMARY).where(jobs.c.tenant == tenant, SINGLE).order_by(jobs.c.id.desc()).limit(limit)
        if status is not None:
            query = query.where(jobs.c.status == status)
        if kind is not None:
            query = query.where(jobs.c.kind == kind)
        if before is not None:
            query = query.where(jobs.c.id < before)
        with self._engine.connect() as connection:
            return [JobSummary(*as_values(row)) for row in connection.execute(query)]

    def take(self, mark: str, costs: Sequence[Cost], passed_over: Collection[str] = ()) -> Claim | None:
        """Claim the queued job whose turn it is under a mark; None when there is none.

        Jobs of the first of ``costs`` come first, those of the others where there are none. The short jobs of the
        tenants ``passed_over`` are left in the queue. Only one of many who ask gets a job. Who does not know whether it
        has got one asks :meth:`claimed`.
        """
        with self._engine.begin() as connection:
            for cost in costs:
                while (job_id := _next(connection, cost, passed_over if cost == Cost.SHORT else ())) is not None:
                    row = connection.execute(CLAIM, {"job": job_id, "mark": mark, "moment": now()}).one_or_none()
                    if row is not None:  # it was not cancelled meanwhile
                        return _claim(row)
        return None

    def claimed(self, mark: str) -> Claim | None:
        """What was claimed under a mark and is running; None where nothing is."""
        with self._engine.connect() as connection:
            row = connection.execute(CLAIMED, {"mark": mark}).one_or_none()
        return None if row is None else _claim(row)

    def progress(self, job_id: str, attempt: int, fraction: float, message: str) -> bool:
        """Note how far an attempt is; False when the attempt is no longer the one that counts."""
        change = (
            update(jobs)
            .where(jobs.c.id == job_id, jobs.c.attempt == attempt, jobs.c.status == Status.RUNNING)
            .values(
                progress_fraction=min(max(fraction, 0.0), 1.0),
                progress_message=message[:_MESSAGE_LENGTH],
                revision=jobs.c.revision + 1,
            )
        )
        return self._changed(change)

    def succeed(self, job_id: str, attempt: int, result: str, digest: str | None = None) -> bool:
        """End the attempt with its result (JSON text); False when the attempt is no longer the one that counts.

        By the ``digest`` of its problem (:mod:`service.jobs.batches.identity`) the result is found for equal ones.
        """
        ended = {"job": job_id, "of": attempt, "answer": result, "moment": now(), "known_by": digest}
        return self._changed(SUCCEED, ended)

    def fail(self, job_id: str, attempt: int, error: str) -> bool:
        """End the attempt with an error (JSON text); False when the attempt is no longer the one that counts."""
        return self._changed(FAIL, {"job": job_id, "of": attempt, "answer": error, "moment": now()})

    def give_up(self, job_id: str, claim: str, error: str) -> bool:
        """Fail the job from outside; for the executor that has it run under this claim."""
        change = moved("give_up", job_id, error=error, progress_message="failed", finished_at=now())
        return self._changed(change.where(jobs.c.claim == claim))

    def cancel(self, job_id: str) -> bool:
        """Cancel an unfinished job; False when there is none. No attempt can write to it afterwards."""
        return self._changed(moved("cancel", job_id, progress_message="cancelled", finished_at=now()))

    def delete(self, job_id: str) -> bool:
        """Remove a finished job; False when there is none."""
        with self._engine.begin() as connection:
            deletion = connection.execute(delete(jobs).where(jobs.c.id == job_id, jobs.c.status.in_(FINISHED)))
        return deletion.rowcount > 0

    def delete_finished(self, before: datetime, at_most: int) -> int:
        """Remove jobs that finished before a time, oldest first; tells how many."""
        # Ids begin with the time of creation, which lies before that of the end: the oldest are found without a search.
        oldest = (
            select(jobs.c.id)
            .where(
                jobs.c.id < str(ULID.from_datetime(before)),
                jobs.c.status.in_(FINISHED),
                jobs.c.finished_at < as_stored(before),
            )
            .order_by(jobs.c.id)
            .limit(at_most)
        )
        with self._engine.begin() as connection:
            return connection.execute(delete(jobs).where(jobs.c.id.in_(oldest))).rowcount

    def requeue(self, job_id: str, claim: str) -> bool:
        """Put a running job back into the queue because the executor that has it run under this claim stops."""
        return self._changed(moved("requeue", job_id, **BACK_IN_QUEUE).where(jobs.c.claim == claim))

    def requeue_as_long(self, job_id: str, claim: str) -> bool:
        """Put a running job back into the queue because it takes longer than a short one may; it waits its turn."""
        values: dict[str, Any] = {**BACK_IN_QUEUE, "cost": Cost.LONG, "turn": turn_as_long()}
        return self._changed(moved("requeue", job_id, **values).where(jobs.c.claim == claim))

    def requeue_unfinished(self) -> int:
        """Put all running jobs back into the queue; tells how many jobs are in it then.

        For an executor that starts and knows that nobody else runs any of them.
        """
        move = MOVES["requeue"]
        with self._engine.begin() as connection:
            connection.execute(
                update(jobs)
                .where(jobs.c.status == Status.RUNNING)
                .values(status=move.target, revision=jobs.c.revision + 1, **BACK_IN_QUEUE)
            )
            return connection.execute(select(func.count()).select_from(jobs).where(QUEUED)).scalar_one()

    def crashed(self, job_id: str, claim: str, *, killed: bool) -> Status | None:
        """Note that the worker of a job died, by itself or ``killed`` from outside.

        Returns
        -------
        Status or None
            ``queued``: to be tried again; ``failed``: given up after :data:`MAX_CRASHES` retries (or, where the last
            death was a kill, :data:`MAX_KILLS`); None: the job was finished (or removed) already, or another attempt
            has it; nothing changed.
        """
        change = died(job_id, MAX_KILLS if killed else MAX_CRASHES)
        with self._engine.begin() as connection:
            status = connection.execute(change.where(jobs.c.claim == claim)).scalar_one_or_none()
        return None if status is None else Status(status)

    def _changed(self, change: Any, values: Mapping[str, Any] | None = None) -> bool:
        with self._engine.begin() as connection:
            rows: int = connection.execute(change, values).rowcount
        return rows > 0


def _there(connection: Connection, job_id: str) -> bool:
    return connection.execute(select(jobs.c.id).where(jobs.c.id == job_id)).first() is not None


def _inserted(connection: Connection, row: Mapping[str, Any], max_queued: int | None) -> bool:
    """Insert a row unless ``max_queued`` jobs of its tenant are queued already; tells whether."""
    most = _NO_END if max_queued is None else max_queued
    asked = {"of": row["tenant"], "most": most}
    postgresql = connection.dialect.name == "postgresql"
    if postgresql and connection.execute(COUNT_QUEUED, asked).scalar_one() > min(_FEW, most - _CROWD):
        one_after_the_other(connection, row["tenant"])
    return connection.execute(INSERT, {**row, **asked, "as": row["cost"]}).rowcount > 0


def _next(connection: Connection, cost: Cost, passed_over: Collection[str]) -> str | None:
    """The queued job of that cost whose turn it is, but for the tenants that are passed over."""
    if not passed_over:
        return connection.execute(NEXT, {"cost": cost}).scalar_one_or_none()
    return connection.execute(NEXT_OF_OTHERS, {"cost": cost, "passed_over": [*passed_over]}).scalar_one_or_none()


def _claim(row: Any) -> Claim:
    return Claim(row.id, row.tenant, row.claim, row.attempt, Cost(row.cost), row.kind, row.problem, row.batch)
