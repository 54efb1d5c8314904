"""The job store: SQL rows, the only source of truth about jobs.

Every change is a single ``UPDATE`` whose ``WHERE`` clause names the states from which the change is allowed
(:data:`service.jobs.store.states.MOVES`) and, for writes of a worker, the number of its attempt. A change that comes
too late matches no row and is refused. No row is read before a change, so no stale value can decide it.

Several servers and worker hosts may share a store; :mod:`service.jobs.cluster.leases` holds the queries only they need.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Connection, Delete, Engine, Update, delete, func, select, text, update
from ulid import ULID

from service.jobs.batches.reading import load_sample, load_samples
from service.jobs.store.admission import Repeatable, find_earlier, insert_confirmed, make_once, serialize_inserts
from service.jobs.store.probe import StoreProbe, measure_size
from service.jobs.store.progress_message import write_progress
from service.jobs.store.schema import (
    QUEUED_CONDITION,
    AnyRow,
    Claim,
    JobRow,
    JobSummary,
    as_stored,
    as_values,
    format_now,
    jobs,
)
from service.jobs.store.statements import (
    CLAIM_NEXT,
    CLAIM_NEXT_OF_OTHERS,
    COLUMNS,
    INSERT_JOB,
    INSERT_JOB_UNLESS_FULL,
    IS_SINGLE_JOB,
    JOB_COLUMNS,
    MAX_CRASHES,
    MAX_IDS,
    MAX_KILLS,
    NO_KEY,
    REQUEUED_VALUES,
    SELECT_BY_ID,
    SELECT_CLAIMED,
    SELECT_NEXT,
    SELECT_NEXT_OF_OTHERS,
    SELECT_QUEUE_BOUNDS,
    SUMMARY_COLUMNS,
    UPDATE_FAILED,
    UPDATE_SUCCEEDED,
    build_death_update,
    build_long_turn,
    build_move,
    build_row,
)
from service.jobs.store.states import FINISHED_STATES, MOVES, UNFINISHED_STATES, Cost, Status
from service.observability.store_figures import StoreFigures

_SERIAL_THRESHOLD = 8
"""Number of queued jobs above which a tenant's inserts are serialized, so that each job gets its own turn. Below it,
jobs that arrive at the same time may share a turn."""

_MAX_CONCURRENT_INSERTS = 500
"""Upper bound of the concurrent inserts of all servers. A queue this far below its limit needs no exact count."""

_NO_LIMIT = 1 << 30
"""Limit that stands for no limit: no queue gets this long."""


class JobStore:
    """Reads and changes the rows. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._probe = StoreProbe(engine)

    def find_fault(self) -> str | None:
        """Return the id of the message why the store takes no writes; None if it does."""
        return self._probe.find_fault()

    def ping(self) -> None:
        """Check that the database answers; SQLAlchemy's error is raised if it does not."""
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
        """Store a new job in the queue. On return the job is on disk.

        If the connection breaks, the job's id ensures that it is stored exactly once
        (:func:`service.jobs.store.admission.insert_confirmed`).

        Raises
        ------
        QueueFull
            If ``max_queued`` jobs of the tenant are already queued.
        """
        return self._insert({**build_row(tenant, kind, label, problem, cost), **NO_KEY}, max_queued)

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
        """Store a new job like :meth:`create`, or find the job that the same request created before.

        Returns
        -------
        tuple
            The job, and whether it is new.

        Raises
        ------
        KeyReused
            If a different request of the tenant has created a job with this key.
        QueueFull
            If the job is new and ``max_queued`` jobs of the tenant are already queued.
        """
        row = {
            **build_row(tenant, kind, label, problem, cost),
            "idempotency_key": repeatable.key,
            "request_hash": repeatable.request_hash,
        }
        return make_once(lambda: self._insert(row, max_queued), lambda: self._find_earlier(tenant, repeatable))

    def _insert(self, row: dict[str, Any], max_queued: int | None) -> JobRow:
        insert_confirmed(
            self._engine,
            lambda connection: _is_stored(connection, row["id"]),
            lambda connection: _insert_unless_full(connection, row, max_queued),
        )
        return JobRow(**{name: row[name] for name in COLUMNS})

    def _find_earlier(self, tenant: str, repeatable: Repeatable) -> JobRow | None:
        row = find_earlier(self._engine, jobs, JOB_COLUMNS, tenant, repeatable)
        return None if row is None else JobRow(*as_values(row))

    def get(self, job_id: str) -> JobRow | None:
        """Return the job, which may be an ended sample of a batch; None if it does not exist."""
        with self._engine.connect() as connection:
            row = connection.execute(SELECT_BY_ID, {"job": job_id}).one_or_none()
            return load_sample(connection, job_id) if row is None else JobRow(*as_values(row))

    def count_unfinished(self, tenant: str | None = None) -> dict[str, int]:
        """Return the number of queued and of running jobs, of a tenant or of all."""
        query = select(jobs.c.status, func.count()).where(jobs.c.status.in_(UNFINISHED_STATES)).group_by(jobs.c.status)
        if tenant is not None:
            query = query.where(jobs.c.tenant == tenant)
        with self._engine.connect() as connection:
            counts = {row[0]: row[1] for row in connection.execute(query)}
        return {status.value: counts.get(status.value, 0) for status in (Status.QUEUED, Status.RUNNING)}

    def measure(self) -> StoreFigures:
        """Return the figures of the store for the metrics."""
        oldest = select(func.min(jobs.c.created_at)).where(QUEUED_CONDITION, IS_SINGLE_JOB)
        with self._engine.connect() as connection:
            since = connection.execute(oldest).scalar()
        age = 0.0 if since is None else (datetime.now(UTC) - datetime.fromisoformat(since)).total_seconds()
        return StoreFigures(self.count_unfinished(), max(age, 0.0), *measure_size(self._engine))

    def load_summaries(self, job_ids: Sequence[str]) -> dict[str, JobSummary]:
        """Return the existing jobs among these ids, by id, samples of batches included."""
        by_id: dict[str, JobSummary] = {}
        with self._engine.connect() as connection:
            for start in range(0, len(job_ids), MAX_IDS):
                query = select(*SUMMARY_COLUMNS).where(jobs.c.id.in_(job_ids[start : start + MAX_IDS]), IS_SINGLE_JOB)
                for row in connection.execute(query):
                    by_id[row.id] = JobSummary(*as_values(row))
            by_id |= load_samples(connection, [job_id for job_id in job_ids if job_id not in by_id])
        return by_id

    def list_page(
        self,
        *,
        tenant: str,
        limit: int,
        status: Status | None = None,
        kind: str | None = None,
        before: str | None = None,
    ) -> list[JobSummary]:
        """Return at most ``limit`` jobs of a tenant older than the job ``before``, newest first."""
        query = (
            select(*SUMMARY_COLUMNS)
            .where(jobs.c.tenant == tenant, IS_SINGLE_JOB)
            .order_by(jobs.c.id.desc())
            .limit(limit)
        )
        if status is not None:
            query = query.where(jobs.c.status == status)
        if kind is not None:
            query = query.where(jobs.c.kind == kind)
        if before is not None:
            query = query.where(jobs.c.id < before)
        with self._engine.connect() as connection:
            return [JobSummary(*as_values(row)) for row in connection.execute(query)]

    def take(self, mark: str, costs: Sequence[Cost], passed_over: Collection[str] = ()) -> Claim | None:
        """Claim the queued job whose turn it is under a mark; return None if there is none.

        ``costs`` are tried in order. The short jobs of the tenants ``passed_over`` stay in the queue. Of concurrent
        callers only one gets a given job. A caller whose connection broke uses :meth:`find_claim` to learn whether it
        got one.
        """
        with self._engine.begin() as connection:
            for cost in costs:
                row = _claim_next(connection, cost, mark, passed_over if cost == Cost.SHORT else ())
                if row is not None:
                    return _claim(row)
        return None

    def find_claim(self, mark: str) -> Claim | None:
        """Return the running job that was claimed under a mark; None if there is none."""
        with self._engine.connect() as connection:
            row = connection.execute(SELECT_CLAIMED, {"mark": mark}).one_or_none()
        return None if row is None else _claim(row)

    def record_progress(self, job_id: str, attempt: int, fraction: float, message: str) -> bool:
        """Store the progress of an attempt; return False if the attempt is no longer current."""
        change = (
            update(jobs)
            .where(jobs.c.id == job_id, jobs.c.attempt == attempt, jobs.c.status == Status.RUNNING)
            .values(
                progress_fraction=min(max(fraction, 0.0), 1.0),
                progress_message=write_progress(message),
                revision=jobs.c.revision + 1,
            )
        )
        return self._execute_change(change)

    def complete(self, job_id: str, attempt: int, result: str, digest: str | None = None) -> bool:
        """End the attempt with its result (JSON text); return False if the attempt is no longer current.

        Equal problems find the result by the ``digest`` of the problem (:mod:`service.jobs.batches.identity`).
        """
        ended = {"job": job_id, "of": attempt, "answer": result, "moment": format_now(), "known_by": digest}
        return self._execute_change(UPDATE_SUCCEEDED, ended)

    def fail(self, job_id: str, attempt: int, error: str) -> bool:
        """End the attempt with an error (JSON text); return False if the attempt is no longer current."""
        return self._execute_change(
            UPDATE_FAILED, {"job": job_id, "of": attempt, "answer": error, "moment": format_now()}
        )

    def give_up(self, job_id: str, claim: str, error: str) -> bool:
        """Fail the job from outside; for the executor that runs it under this claim."""
        change = build_move("give_up", job_id, error=error, progress_message="failed", finished_at=format_now())
        return self._execute_change(change.where(jobs.c.claim == claim))

    def cancel(self, job_id: str) -> bool:
        """Cancel an unfinished job; return False if there is none. No attempt can write to it afterwards."""
        return self._execute_change(
            build_move("cancel", job_id, progress_message="cancelled", finished_at=format_now())
        )

    def delete(self, job_id: str) -> bool:
        """Remove a finished job; return False if there is none."""
        with self._engine.begin() as connection:
            deletion = connection.execute(delete(jobs).where(jobs.c.id == job_id, jobs.c.status.in_(FINISHED_STATES)))
        return deletion.rowcount > 0

    def delete_finished(self, before: datetime, at_most: int) -> int:
        """Remove at most ``at_most`` jobs that finished before a time, oldest first; return the number removed."""
        # An id begins with the time of creation, which precedes the end: the index on ids bounds the search.
        oldest = (
            select(jobs.c.id)
            .where(
                jobs.c.id < str(ULID.from_datetime(before)),
                jobs.c.status.in_(FINISHED_STATES),
                jobs.c.finished_at < as_stored(before),
            )
            .order_by(jobs.c.id)
            .limit(at_most)
        )
        with self._engine.begin() as connection:
            return connection.execute(delete(jobs).where(jobs.c.id.in_(oldest))).rowcount

    def requeue(self, job_id: str, claim: str) -> bool:
        """Requeue a running job because the executor that runs it under this claim stops."""
        return self._execute_change(build_move("requeue", job_id, **REQUEUED_VALUES).where(jobs.c.claim == claim))

    def requeue_as_long(self, job_id: str, claim: str) -> bool:
        """Requeue a running job as a long one because it exceeds the time of a short job."""
        values = {**REQUEUED_VALUES, "cost": Cost.LONG, "turn": build_long_turn()}
        return self._execute_change(build_move("requeue", job_id, **values).where(jobs.c.claim == claim))

    def requeue_unfinished(self) -> int:
        """Requeue all running jobs; return the number of queued jobs after that.

        For an executor that starts and knows that no other process runs any of them.
        """
        move = MOVES["requeue"]
        with self._engine.begin() as connection:
            connection.execute(
                update(jobs)
                .where(jobs.c.status == Status.RUNNING)
                .values(status=move.target, revision=jobs.c.revision + 1, **REQUEUED_VALUES)
            )
            return connection.execute(select(func.count()).select_from(jobs).where(QUEUED_CONDITION)).scalar_one()

    def record_crash(self, job_id: str, claim: str, *, killed: bool) -> Status | None:
        """Record that the worker of a job died, by itself or ``killed`` from outside.

        Returns
        -------
        Status or None
            ``queued``: to be retried; ``failed``: given up after :data:`MAX_CRASHES` retries (:data:`MAX_KILLS` if the
            last death was a kill); None, and no change: the job had finished, was removed, or belongs to another
            attempt.
        """
        change = build_death_update(job_id, MAX_KILLS if killed else MAX_CRASHES)
        with self._engine.begin() as connection:
            status = connection.execute(change.where(jobs.c.claim == claim)).scalar_one_or_none()
        return None if status is None else Status(status)

    def _execute_change(self, change: Delete | Update, values: Mapping[str, object] | None = None) -> bool:
        with self._engine.begin() as connection:
            rows = connection.execute(change, values).rowcount
        return rows > 0


def _is_stored(connection: Connection, job_id: str) -> bool:
    return connection.execute(select(jobs.c.id).where(jobs.c.id == job_id)).first() is not None


def _insert_unless_full(connection: Connection, row: Mapping[str, Any], max_queued: int | None) -> bool:
    """Insert a row unless ``max_queued`` jobs of its tenant are already queued; return whether it was inserted."""
    most = _NO_LIMIT if max_queued is None else max_queued
    of, values = row["tenant"], {**row, "of": row["tenant"], "as": row["cost"]}
    # SQLite has one writer at a time, so its inserts need no further order.
    if connection.dialect.name == "postgresql":
        few = max(0, min(_SERIAL_THRESHOLD, most - _MAX_CONCURRENT_INSERTS))
        queued, turns = connection.execute(SELECT_QUEUE_BOUNDS, {"of": of, "most": few + 1}).one()
        if queued > few or most < _MAX_CONCURRENT_INSERTS:
            serialize_inserts(connection, of)
        # Counting reads each of the tenant's queued rows, so it is left to the queues that may be full.
        if turns + _MAX_CONCURRENT_INSERTS < most:
            connection.execute(INSERT_JOB, values)
            return True
    return connection.execute(INSERT_JOB_UNLESS_FULL, {**values, "most": most}).rowcount > 0


def _claim_next(connection: Connection, cost: Cost, mark: str, passed_over: Collection[str]) -> AnyRow | None:
    """Claim the next queued job of this cost, skipping the tenants ``passed_over``."""
    of = {"as": cost, **({"passed_over": [*passed_over]} if passed_over else {})}
    # Every write to SQLite waits for its one lock, also one that would find no job.
    if connection.dialect.name == "sqlite":
        query = SELECT_NEXT_OF_OTHERS if passed_over else SELECT_NEXT
        if connection.execute(query, of).first() is None:
            return None
    change = CLAIM_NEXT_OF_OTHERS if passed_over else CLAIM_NEXT
    return connection.execute(change, {**of, "mark": mark, "moment": format_now()}).one_or_none()


def _claim(row: AnyRow) -> Claim:
    return Claim(row.id, row.tenant, row.claim, row.attempt, Cost(row.cost), row.kind, row.problem, row.batch)
