"""The SQL statements that move a job from one state to another, and those that every job goes through.

Each change is one ``UPDATE`` whose ``WHERE`` clause holds the states that the move may start from
(:data:`service.jobs.states.MOVES`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from sqlalchemy import ColumnElement, Integer, and_, bindparam, case, func, insert, or_, select, update
from sqlalchemy.sql.dml import ReturningUpdate
from ulid import ULID

from service.jobs.faults import WORKER_DIED
from service.jobs.schema import JobRow, JobSummary, StoreClock, jobs, now
from service.jobs.states import MOVES, Status

LEASE_S = 10.0
"""An attempt is abandoned this long after its last sign of life. Signs come twice a second, but a machine may be very
busy, and a database may need some seconds for a restart."""

RESEND_S = 5.0
"""A job that nobody has taken is sent again after so long at first, and then whenever it has waited twice as long."""

MAX_IDS = 500
"""Ids in one statement; databases bound the number of its parameters."""

COLUMNS = tuple(field.name for field in fields(JobRow))  # begins with the fields of a summary
SUMMARY = [jobs.c[field.name] for field in fields(JobSummary)]
WHOLE = [jobs.c[name] for name in COLUMNS]


def moved(name: str, job_id: Any, **values: Any) -> Any:
    """The move of this name, made with a job in one of its source states; ``values`` are stored with it."""
    move = MOVES[name]
    return (
        update(jobs)
        .where(jobs.c.id == job_id, jobs.c.status.in_(move.sources))
        .values(status=move.target, revision=jobs.c.revision + 1, **values)
    )


NO_KEY: Mapping[str, None] = {"idempotency_key": None, "request_hash": None}
BACK_IN_QUEUE: Mapping[str, Any] = {
    "progress_fraction": 0.0,
    "progress_message": "queued",
    "started_at": None,
    "queued_at": StoreClock(),
    "due_at": StoreClock(),
}


def held_by(claim: str) -> ColumnElement[bool]:
    """The job has been claimed by nobody yet, or under this claim."""
    return or_(jobs.c.status == Status.QUEUED, jobs.c.claim == claim)


def died(job_id: str, retries: int) -> ReturningUpdate[Any]:
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


def new_row(tenant: str, kind: str, label: str | None, problem: str) -> dict[str, Any]:
    """A job that has just been accepted."""
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


# What every job goes through is stated once. SQLAlchemy takes several times as long to put a statement together, and to
# recognize it in its cache of compiled ones, as the database to execute it.
BY_ID = select(*WHOLE).where(jobs.c.id == bindparam("job"))
_STORED = [*new_row("", "", None, ""), *NO_KEY]
_TIMES = {"queued_at": StoreClock(), "due_at": StoreClock() + RESEND_S}
INSERT = insert(jobs).values(_TIMES)
_QUEUED = select(jobs.c.id).where(jobs.c.status == Status.QUEUED).limit(bindparam("most", type_=Integer)).subquery()
COUNT_QUEUED = select(func.count()).select_from(_QUEUED)
# Counted by the statement that inserts, so that many who come at once cannot all find the last place.
INSERT_WITH_ROOM = (
    insert(jobs)
    .from_select(
        [*_STORED, *_TIMES],
        select(*(bindparam(name, type_=jobs.c[name].type) for name in _STORED), *_TIMES.values()).where(
            COUNT_QUEUED.scalar_subquery() < bindparam("most", type_=Integer)
        ),
    )
    .execution_options(preserve_rowcount=True)
)
CLAIM = (
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
SUCCEED = moved(
    "succeed",
    bindparam("job"),
    result=bindparam("answer"),
    progress_fraction=1.0,
    progress_message="succeeded",
    finished_at=bindparam("moment"),
).where(_OF_THE_ATTEMPT)
FAIL = moved(
    "fail", bindparam("job"), error=bindparam("answer"), progress_message="failed", finished_at=bindparam("moment")
).where(_OF_THE_ATTEMPT)
