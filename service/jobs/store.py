"""The job store: the SQL rows that are the truth about every job.

Every change is a single ``UPDATE`` whose ``WHERE`` clause holds the states that the change may start from
(:data:`service.jobs.states.MOVES`) and, for what a worker writes, the number of its attempt. A change that comes too
late matches no row and is refused; there is nothing to read before, and so nothing to go stale in between.

Several servers and worker hosts may share a store. Words: a *claim* is the mark of one attempt, chosen by who has it
run; as long as the attempt goes on, its *lease* is renewed, and when that is over the job is taken for abandoned. A
queued job is *due* when its message may have been lost, and it should be sent again. Leases and dues go by the clock of
the database, in ``due_at``.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from datetime import datetime
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    Integer,
    and_,
    bindparam,
    case,
    delete,
    func,
    insert,
    or_,
    select,
    text,
    update,
)
from sqlalchemy.exc import IntegrityError, SQLAlchemyError
from sqlalchemy.sql.dml import ReturningUpdate
from ulid import ULID

from service.jobs.database import QUEUE_LOCK, unreachable
from service.jobs.faults import WORKER_DIED
from service.jobs.schema import JobRow, JobSummary, StoreClock, as_stored, hosts, jobs, now
from service.jobs.states import FINISHED, MOVES, UNFINISHED, Status

MAX_CRASHES = 3
"""A job whose worker died by itself is tried again this many times."""

MAX_KILLS = 20
"""A job whose worker was killed from outside is tried again this many times: that is hardly the job's fault. It may be,
where the system kills what takes the last of the memory, so there is an end to it."""

LEASE_S = 10.0
"""So long after its last sign of life an attempt is taken for abandoned. Signs come twice a second, but a machine may
be very busy, and a database may need some seconds for a restart."""

RESEND_S = 5.0
"""A job that nobody has taken is sent again after so long at first, and then whenever it has waited twice as long."""

MAX_RESEND_S = 600.0
"""Longest time from one sending of a waiting job to the next."""

SETTLE_S = 5.0
"""How long a new job is tried to be stored when the database breaks off in the middle, so that nobody knows whether."""

_SETTLE_PERIOD_S = 0.2
_HOST_FORGOTTEN_S = 3600.0
_CROWD = 500
"""More servers' connections than can insert at once: so far from its limit, the queue needs no exact count."""

_ROW = tuple(field.name for field in fields(JobRow))  # begins with the fields of a summary
_SUMMARY = [jobs.c[field.name] for field in fields(JobSummary)]
_WHOLE = [jobs.c[name] for name in _ROW]
_STATUS = _ROW.index("status")
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

        A database that breaks off before it has answered may have stored the job or not. Then it is asked again, for
        :data:`SETTLE_S` seconds; the id makes sure that there is one job in the end.

        Raises
        ------
        QueueFull
            When ``max_queued`` jobs are queued already.
        """
        return self._insert({**_new_row(tenant, kind, label, problem), **_NO_KEY}, max_queued)

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
        asked_at: float | None = None
        broken = False
        while True:
            try:
                with self._engine.begin() as connection:
                    asked_at = asked_at or time.monotonic()
                    if not (broken and _there(connection, row["id"])) and not _inserted(connection, row, max_queued):
                        raise QueueFull
                return JobRow(**{name: row[name] for name in _ROW})
            except SQLAlchemyError as error:
                # Refused before anything was asked: nothing is stored, and the client may know at once.
                broken = broken or getattr(error, "connection_invalidated", False)
                if asked_at is None or not (broken and unreachable(error)) or time.monotonic() > asked_at + SETTLE_S:
                    raise
                time.sleep(_SETTLE_PERIOD_S)  # the database is being started again

    def _made_by(self, tenant: str, repeatable: Repeatable) -> JobRow | None:
        query = select(*_WHOLE, jobs.c.request_hash).where(
            jobs.c.tenant == tenant, jobs.c.idempotency_key == repeatable.key
        )
        with self._engine.connect() as connection:
            row = connection.execute(query).one_or_none()
        if row is None:
            return None
        if row.request_hash != repeatable.request_hash:
            raise KeyReused(row.id)
        return JobRow(*_values(row[:-1]))

    def get(self, job_id: str) -> JobRow | None:
        """The job, or None where there is none."""
        with self._engine.connect() as connection:
            row = connection.execute(_BY_ID, {"job": job_id}).one_or_none()
        return None if row is None else JobRow(*_values(row))

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
                for row in connection.execute(query):
                    found[row.id] = JobSummary(*_values(row))
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
            return [JobSummary(*_values(row)) for row in connection.execute(query)]

    def claim(self, job_id: str, claim: str) -> Claim | None:
        """Take a queued job under the mark ``claim``; None when it is not there to be taken.

        Only one of many claimants gets it. Who has got it and does not know may ask again.
        """
        with self._engine.begin() as connection:
            row = connection.execute(_CLAIM, {"job": job_id, "mark": claim, "moment": now()}).one_or_none()
        return None if row is None else Claim(*row)

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
            found = {row.id: row for row in connection.execute(query)}
        return {claim for claim, job_id in claims.items() if _useless(found.get(job_id), claim)}

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
        return self._changed(_SUCCEED, {"job": job_id, "of": attempt, "answer": result, "moment": now()})

    def fail(self, job_id: str, attempt: int, error: str) -> bool:
        """End the attempt with an error (JSON text); False when the attempt is no longer the one that counts."""
        return self._changed(_FAIL, {"job": job_id, "of": attempt, "answer": error, "moment": now()})

    def give_up(self, job_id: str, claim: str, error: str) -> bool:
        """Fail the job from outside; for the executor that has it run under this claim, or has been about to."""
        change = _moved("give_up", job_id, error=error, progress_message="failed", finished_at=now())
        return self._changed(change.where(_not_anothers(claim)))

    def cancel(self, job_id: str) -> bool:
        """Cancel an unfinished job; False when there is none. No attempt can write to it afterwards."""
        return self._changed(_moved("cancel", job_id, progress_message="cancelled", finished_at=now()))

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

    def requeue(self, job_id: str, claim: str) -> bool:
        """Put an unfinished job back into the queue because the executor that has it run under this claim stops."""
        return self._changed(_moved("requeue", job_id, **_BACK_IN_QUEUE).where(_not_anothers(claim)))

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

    def crashed(self, job_id: str, claim: str, *, killed: bool) -> Status | None:
        """Note that the worker of a job died, by itself or ``killed`` from outside.

        Returns
        -------
        Status or None
            ``queued``: to be tried again; ``failed``: given up after :data:`MAX_CRASHES` retries (or, where the last
            death was a kill, :data:`MAX_KILLS`); None: the job was finished (or removed) already, or another attempt
            has it; nothing changed.
        """
        change = _died(job_id, MAX_KILLS if killed else MAX_CRASHES)
        with self._engine.begin() as connection:
            status = connection.execute(change.where(_not_anothers(claim))).scalar_one_or_none()
        return None if status is None else Status(status)

    def abandoned(self) -> list[tuple[str, Status]]:
        """Take the running jobs whose leases are over back into the queue: whoever ran them is gone with its workers.

        Returns
        -------
        list
            These jobs, and what they are now; like :meth:`crashed`.
        """
        over = select(jobs.c.id).where(jobs.c.status == Status.RUNNING, jobs.c.due_at < StoreClock())
        moved = []
        with self._engine.connect() as connection:
            found = connection.execute(over).scalars().all()
        for job_id in found:
            change = _died(job_id, MAX_KILLS).where(jobs.c.status == Status.RUNNING, jobs.c.due_at < StoreClock())
            with self._engine.begin() as connection:
                status = connection.execute(change).scalar_one_or_none()
            if status is not None:
                moved.append((job_id, Status(status)))
        return moved

    def due(self, at_most: int) -> list[str]:
        """Queued jobs whose messages may be lost, oldest first, to be sent again by the caller and nobody else.

        Whoever asks next does not get them before their next time.
        """
        waiting = (
            select(jobs.c.id)
            .where(jobs.c.status == Status.QUEUED, jobs.c.due_at <= StoreClock())
            .order_by(jobs.c.id)
            .limit(at_most)
            .with_for_update(skip_locked=True)
        )
        waited = StoreClock() - jobs.c.queued_at
        pause = case((waited < RESEND_S, RESEND_S), (waited > MAX_RESEND_S, MAX_RESEND_S), else_=waited)
        change = update(jobs).where(jobs.c.id.in_(waiting)).values(due_at=StoreClock() + pause).returning(jobs.c.id)
        with self._engine.begin() as connection:
            return sorted(connection.execute(change).scalars())

    def not_sent(self, job_ids: Sequence[str]) -> None:
        """Make jobs due again at once that :meth:`due` has given out and that could not be sent."""
        for start in range(0, len(job_ids), _IDS_AT_ONCE):
            ours = jobs.c.id.in_(job_ids[start : start + _IDS_AT_ONCE])
            self._changed(update(jobs).where(ours, jobs.c.status == Status.QUEUED).values(due_at=StoreClock()))

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

    def _changed(self, change: Any, values: Mapping[str, Any] | None = None) -> bool:
        with self._engine.begin() as connection:
            rows: int = connection.execute(change, values).rowcount
        return rows > 0


def _moved(name: str, job_id: Any, **values: Any) -> Any:
    move = MOVES[name]
    return (
        update(jobs)
        .where(jobs.c.id == job_id, jobs.c.status.in_(move.sources))
        .values(status=move.target, revision=jobs.c.revision + 1, **values)
    )


_NO_KEY: Mapping[str, None] = {"idempotency_key": None, "request_hash": None}
_BACK_IN_QUEUE: Mapping[str, Any] = {
    "progress_fraction": 0.0,
    "progress_message": "queued",
    "started_at": None,
    "queued_at": StoreClock(),
    "due_at": StoreClock(),
}


def _there(connection: Connection, job_id: str) -> bool:
    return connection.execute(select(jobs.c.id).where(jobs.c.id == job_id)).first() is not None


def _inserted(connection: Connection, row: Mapping[str, Any], max_queued: int | None) -> bool:
    """Insert a row unless ``max_queued`` jobs are queued already; tells whether."""
    if max_queued is None:
        connection.execute(_INSERT, row)
        return True
    room = {"most": max_queued}
    if connection.dialect.name == "postgresql" and connection.execute(_COUNT, room).scalar_one() > max_queued - _CROWD:
        # SQLite has one writer at a time. PostgreSQL has many, who do not see each other's rows before the commit.
        connection.execute(select(func.pg_advisory_xact_lock(QUEUE_LOCK)))
    return connection.execute(_INSERT_WITH_ROOM, {**row, **room}).rowcount > 0


def _not_anothers(claim: str) -> ColumnElement[bool]:
    """The job has been claimed by nobody yet, or under this claim."""
    return or_(jobs.c.status == Status.QUEUED, jobs.c.claim == claim)


def _useless(row: Any, claim: str) -> bool:
    # A job that is queued is about to be claimed, and one that has ended by itself is about to be done with.
    if row is None:
        return True
    return bool(row.status == Status.CANCELLED or (row.status == Status.RUNNING and row.claim != claim))


def _died(job_id: str, retries: int) -> ReturningUpdate[Any]:
    """The job's worker is dead: to the queue with it, or to its end where that has come ``retries`` times already."""
    again, over = MOVES["requeue"], MOVES["give_up"]
    worn_out = jobs.c.crashes >= retries
    return (
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
            queued_at=StoreClock(),
            due_at=StoreClock(),
        )
        .returning(jobs.c.status)
    )


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


def _values(row: Sequence[Any]) -> list[Any]:
    values = [*row]
    values[_STATUS] = Status(values[_STATUS])
    return values


# What every job goes through is stated once. SQLAlchemy takes several times as long to put a statement together, and to
# recognize it in its cache of compiled ones, as the database to execute it.
_BY_ID = select(*_WHOLE).where(jobs.c.id == bindparam("job"))
_STORED = [*_new_row("", "", None, ""), *_NO_KEY]
_TIMES = {"queued_at": StoreClock(), "due_at": StoreClock() + RESEND_S}
_INSERT = insert(jobs).values(_TIMES)
_QUEUED = select(jobs.c.id).where(jobs.c.status == Status.QUEUED).limit(bindparam("most", type_=Integer)).subquery()
_COUNT = select(func.count()).select_from(_QUEUED)
# Counted by the statement that inserts, so that many who come at once cannot all find the last place.
_INSERT_WITH_ROOM = (
    insert(jobs)
    .from_select(
        [*_STORED, *_TIMES],
        select(*(bindparam(name, type_=jobs.c[name].type) for name in _STORED), *_TIMES.values()).where(
            _COUNT.scalar_subquery() < bindparam("most", type_=Integer)
        ),
    )
    .execution_options(preserve_rowcount=True)
)
_CLAIM = (
    update(jobs)
    .where(
        jobs.c.id == bindparam("job"),
        or_(
            jobs.c.status.in_(MOVES["claim"].sources),
            and_(jobs.c.status == MOVES["claim"].target, jobs.c.claim == bindparam("mark")),
        ),
    )
    .values(
        status=MOVES["claim"].target,
        revision=jobs.c.revision + 1,
        progress_message="running",
        started_at=bindparam("moment"),
        attempt=jobs.c.attempt + 1,
        claim=bindparam("mark"),
        due_at=StoreClock() + LEASE_S,
    )
    .returning(jobs.c.attempt, jobs.c.kind, jobs.c.problem)
)
_OF_THE_ATTEMPT = jobs.c.attempt == bindparam("of")
_SUCCEED = _moved(
    "succeed",
    bindparam("job"),
    result=bindparam("answer"),
    progress_fraction=1.0,
    progress_message="succeeded",
    finished_at=bindparam("moment"),
).where(_OF_THE_ATTEMPT)
_FAIL = _moved(
    "fail", bindparam("job"), error=bindparam("answer"), progress_message="failed", finished_at=bindparam("moment")
).where(_OF_THE_ATTEMPT)
