"""The job store: the SQL rows that are the truth about every job.

Every change is a single ``UPDATE`` whose ``WHERE`` clause holds the states that the change may start from
(:data:`service.jobs.states.MOVES`) and, for what a worker writes, the number of its attempt. A change that comes too
late matches no row and is refused; there is nothing to read before, and so nothing to go stale in between.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from typing import Any

from sqlalchemy import Engine, RowMapping, case, delete, func, insert, literal, select, text, update
from sqlalchemy.exc import IntegrityError
from ulid import ULID

from service.jobs.faults import WORKER_DIED
from service.jobs.schema import JobRow, JobSummary, as_stored, jobs, now
from service.jobs.states import FINISHED, MOVES, UNFINISHED, Status

MAX_CRASHES = 3
"""A job whose worker died is tried again this many times."""

_ROW = tuple(field.name for field in fields(JobRow))
_SUMMARY = [jobs.c[field.name] for field in fields(JobSummary)]
_WHOLE = [jobs.c[name] for name in _ROW]
_MESSAGE_LENGTH = 200
_IDS_AT_ONCE = 500  # databases bound the number of parameters of a statement


@dataclass(frozen=True, slots=True)
class Claim:
    """The right to run a job: the number of the attempt, and the problem as JSON text."""

    attempt: int
    kind: str
    problem: str


@dataclass(frozen=True, slots=True)
class Repeatable:
    """A request that may come again: the key that its client gave it, and a hash of what it says."""

    key: str
    request_hash: str


class QueueFull(Exception):
    """There are as many queued jobs as there may be."""


class KeyReused(Exception):
    """A key came with another request than the one that it was first used for; carries the id of that one's job."""

    def __init__(self, job_id: str) -> None:
        self.job_id = job_id
        super().__init__(f"the key was used for the job {job_id}")


class JobStore:
    """Reads and changes the rows. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def ping(self) -> None:
        """Ask the database for a sign of life; raises SQLAlchemy's error when there is none."""
        with self._engine.connect() as connection:
            connection.execute(text("SELECT 1"))

    def create(
        self, *, tenant: str, kind: str, label: str | None, problem: str, max_queued: int | None = None
    ) -> JobRow:
        """Store a new job in the queue. When this returns, the job is on the disk.

        Raises
        ------
        QueueFull
            When ``max_queued`` jobs are queued already.
        """
        return self._insert(_new_row(tenant, kind, label, problem), max_queued)

    def create_once(
        self,
        *,
        tenant: str,
        kind: str,
        label: str | None,
        problem: str,
        repeatable: Repeatable,
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
            When the job would be new, and ``max_queued`` jobs are queued already.
        """
        row = {
            **_new_row(tenant, kind, label, problem),
            "idempotency_key": repeatable.key,
            "request_hash": repeatable.request_hash,
        }
        while True:
            try:
                return self._insert(row, max_queued), True
            except (IntegrityError, QueueFull) as refusal:
                found = self._made_by(tenant, repeatable)
                if found is not None:
                    return found, False
                if isinstance(refusal, QueueFull):
                    raise
                # The job that held the key has been removed since.

    def _insert(self, row: dict[str, Any], max_queued: int | None) -> JobRow:
        new: Any = insert(jobs).values(row)
        if max_queued is not None:
            # Counted by the statement that inserts, so that many who come at once cannot all find the last place.
            queued = select(jobs.c.id).where(jobs.c.status == Status.QUEUED).limit(max_queued).subquery()
            place = select(func.count()).select_from(queued).scalar_subquery() < max_queued
            values = select(*(literal(value, jobs.c[name].type) for name, value in row.items())).where(place)
            new = insert(jobs).from_select(list(row), values)
        if not self._changed(new):
            raise QueueFull
        return JobRow(**{name: row[name] for name in _ROW})

    def _made_by(self, tenant: str, repeatable: Repeatable) -> JobRow | None:
        query = select(*_WHOLE, jobs.c.request_hash).where(
            jobs.c.tenant == tenant, jobs.c.idempotency_key == repeatable.key
        )
        with self._engine.connect() as connection:
            row = connection.execute(query).mappings().one_or_none()
        if row is None:
            return None
        if row["request_hash"] != repeatable.request_hash:
            raise KeyReused(row["id"])
        return JobRow(**{name: value for name, value in _values(row).items() if name in _ROW})

    def get(self, job_id: str) -> JobRow | None:
        """The job, or None where there is none."""
        with self._engine.connect() as connection:
            row = connection.execute(select(*_WHOLE).where(jobs.c.id == job_id)).mappings().one_or_none()
        return None if row is None else JobRow(**_values(row))

    def unfinished(self) -> dict[str, int]:
        """How many jobs are in each of the states that are not final."""
        query = select(jobs.c.status, func.count()).where(jobs.c.status.in_(UNFINISHED)).group_by(jobs.c.status)
        with self._engine.connect() as connection:
            counted = {row[0]: row[1] for row in connection.execute(query)}
        return {status.value: counted.get(status.value, 0) for status in (Status.QUEUED, Status.RUNNING)}

    def summaries(self, job_ids: Sequence[str]) -> dict[str, JobSummary]:
        """The jobs of these ids that there are, by id."""
        found: dict[str, JobSummary] = {}
        with self._engine.connect() as connection:
            for start in range(0, len(job_ids), _IDS_AT_ONCE):
                query = select(*_SUMMARY).where(jobs.c.id.in_(job_ids[start : start + _IDS_AT_ONCE]))
                for row in connection.execute(query).mappings():
                    found[row["id"]] = JobSummary(**_values(row))
        return found

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
        query = select(*_SUMMARY).where(jobs.c.tenant == tenant).order_by(jobs.c.id.desc()).limit(limit)
        if status is not None:
            query = query.where(jobs.c.status == status)
        if kind is not None:
            query = query.where(jobs.c.kind == kind)
        if before is not None:
            query = query.where(jobs.c.id < before)
        with self._engine.connect() as connection:
            return [JobSummary(**_values(row)) for row in connection.execute(query).mappings()]

    def claim(self, job_id: str) -> Claim | None:
        """Take a queued job; None when it is not there to be taken. Only one of many claimants gets it."""
        change = self._moved("claim", job_id, progress_message="running", started_at=now(), attempt=jobs.c.attempt + 1)
        with self._engine.begin() as connection:
            row = connection.execute(change.returning(jobs.c.attempt, jobs.c.kind, jobs.c.problem)).one_or_none()
        return None if row is None else Claim(*row)

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

    def succeed(self, job_id: str, attempt: int, result: str) -> bool:
        """End the attempt with its result (JSON text); False when the attempt is no longer the one that counts."""
        change = self._moved(
            "succeed", job_id, result=result, progress_fraction=1.0, progress_message="succeeded", finished_at=now()
        )
        return self._changed(change.where(jobs.c.attempt == attempt))

    def fail(self, job_id: str, attempt: int, error: str) -> bool:
        """End the attempt with an error (JSON text); False when the attempt is no longer the one that counts."""
        change = self._moved("fail", job_id, error=error, progress_message="failed", finished_at=now())
        return self._changed(change.where(jobs.c.attempt == attempt))

    def give_up(self, job_id: str, error: str) -> bool:
        """Fail the job from outside, whichever attempt it is at; for the executor that runs it."""
        return self._changed(self._moved("give_up", job_id, error=error, progress_message="failed", finished_at=now()))

    def cancel(self, job_id: str) -> bool:
        """Cancel an unfinished job; False when there is none. No attempt can write to it afterwards."""
        return self._changed(self._moved("cancel", job_id, progress_message="cancelled", finished_at=now()))

    def delete(self, job_id: str) -> bool:
        """Remove a finished job; False when there is none."""
        with self._engine.begin() as connection:
            gone = connection.execute(delete(jobs).where(jobs.c.id == job_id, jobs.c.status.in_(FINISHED)))
        return gone.rowcount > 0

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

    def requeue(self, job_id: str) -> bool:
        """Put an unfinished job back into the queue because its executor stops."""
        return self._changed(self._moved("requeue", job_id, **_BACK_IN_QUEUE))

    def requeue_unfinished(self) -> list[str]:
        """Put all unfinished jobs back into the queue and name them, oldest first.

        For an executor that starts and knows that nobody else runs any of them.
        """
        move = MOVES["requeue"]
        with self._engine.begin() as connection:
            connection.execute(
                update(jobs)
                .where(jobs.c.status == Status.RUNNING)
                .values(status=move.target, revision=jobs.c.revision + 1, **_BACK_IN_QUEUE)
            )
            rows = connection.execute(select(jobs.c.id).where(jobs.c.status == move.target).order_by(jobs.c.id))
            return list(rows.scalars())

    def crashed(self, job_id: str) -> Status | None:
        """Note that the worker of a job died.

        Returns
        -------
        Status or None
            ``queued``: to be tried again; ``failed``: given up after :data:`MAX_CRASHES` retries; None: the job was
            finished (or removed) already, nothing changed.
        """
        again, over = MOVES["requeue"], MOVES["give_up"]
        worn_out = jobs.c.crashes >= MAX_CRASHES
        change = (
            update(jobs)
            .where(jobs.c.id == job_id, jobs.c.status.in_(again.sources & over.sources))
            .values(
                status=case((worn_out, over.target), else_=again.target),
                error=case((worn_out, WORKER_DIED.as_json(job_id)), else_=None),
                started_at=case((worn_out, jobs.c.started_at), else_=None),
                finished_at=case((worn_out, now()), else_=None),
                progress_fraction=case((worn_out, jobs.c.progress_fraction), else_=0.0),
                progress_message=case((worn_out, "failed"), else_="queued"),
                crashes=jobs.c.crashes + 1,
                revision=jobs.c.revision + 1,
            )
            .returning(jobs.c.status)
        )
        with self._engine.begin() as connection:
            status = connection.execute(change).scalar_one_or_none()
        return None if status is None else Status(status)

    def _moved(self, name: str, job_id: str, **values: Any) -> Any:
        move = MOVES[name]
        return (
            update(jobs)
            .where(jobs.c.id == job_id, jobs.c.status.in_(move.sources))
            .values(status=move.target, revision=jobs.c.revision + 1, **values)
        )

    def _changed(self, change: Any) -> bool:
        with self._engine.begin() as connection:
            rows: int = connection.execute(change).rowcount
        return rows > 0


_BACK_IN_QUEUE: Mapping[str, Any] = {"progress_fraction": 0.0, "progress_message": "queued", "started_at": None}


def _new_row(tenant: str, kind: str, label: str | None, problem: str) -> dict[str, Any]:
    return {
        "id": str(ULID()),
        "tenant": tenant,
        "kind": kind,
        "label": label,
        "status": Status.QUEUED,
        "created_at": now(),
        "started_at": None,
        "finished_at": None,
        "progress_fraction": 0.0,
        "progress_message": "queued",
        "problem": problem,
        "result": None,
        "error": None,
        "attempt": 0,
        "crashes": 0,
        "revision": 1,
    }


def _values(row: RowMapping) -> dict[str, Any]:
    return {**row, "status": Status(row["status"])}
