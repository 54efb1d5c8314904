"""The SQL statements that move a job from one state to another, and those that every job goes through.

Each change is one ``UPDATE`` whose ``WHERE`` clause holds the states that the move may start from
(:data:`service.jobs.store.states.MOVES`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from sqlalchemy import Integer, bindparam, case, func, insert, select, update
from sqlalchemy.sql.dml import ReturningUpdate
from ulid import ULID

from service.jobs.faults import WORKER_DIED
from service.jobs.store.schema import QUEUED, JobRow, JobSummary, Later, StoreClock, jobs, now
from service.jobs.store.states import MOVES, Cost, Status

LEASE_S = 10.0
"""An attempt is abandoned this long after its last sign of life. Signs come twice a second, but a machine may be very
busy, and a database may need some seconds for a restart."""

MAX_CRASHES = 3
"""A job whose worker died by itself is tried again this many times."""

MAX_KILLS = 20
"""A job whose worker was killed from outside is tried again this many times: that is hardly the job's fault. It may be,
where the system kills what takes the last of the memory, so there is an end to it."""

AT_ONCE = 0
"""The turn of a job that has had one, and was put back: before all that are new, whose turns begin with 1. Shares of
batches are put back all the time, and a batch may have thousands of samples that end with a worker: they wait again."""

MAX_IDS = 500
"""Ids in one statement; databases bound the number of its parameters."""

COLUMNS = tuple(field.name for field in fields(JobRow))  # begins with the fields of a summary
SUMMARY = [jobs.c[field.name] for field in fields(JobSummary)]
WHOLE = [jobs.c[name] for name in COLUMNS]
TAKEN = [jobs.c[name] for name in ("id", "tenant", "claim", "attempt", "cost", "kind", "problem", "batch")]
SINGLE = jobs.c.batch.is_(None)
"""Jobs that clients have posted, and no shares of batches."""


def moved(name: str, job_id: Any, **values: Any) -> Any:
    """The move of this name, made with a job in one of its source states; ``values`` are stored with it."""
    move = MOVES[name]
    return (
        update(jobs)
        .where(jobs.c.id == job_id, jobs.c.status.in_(move.sources))
        .values(status=move.target, revision=jobs.c.revision + 1, **values)
    )


NO_KEY: Mapping[str, None] = {"idempotency_key": None, "request_hash": None}


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
            turn=TURN_AGAIN,
        )
        .returning(jobs.c.status)
    )


def new_row(tenant: str, kind: str, label: str | None, problem: str, cost: Cost = Cost.LONG) -> dict[str, Any]:
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
        "cost": cost,
    }


def turn_of(tenant: Any, cost: Any, *, share: bool = False) -> Later:
    """The turn of a further job of a tenant: after the tenant's others, and not before what is next for anybody.

    Jobs are taken in the order of their turns, so that tenants go round: of those who wait, each has one job in each
    turn. Who comes new joins at the present one, however many jobs of others wait. The shares of a tenant's batches go
    round by themselves, so that its jobs do not wait for them.
    """
    others = jobs.alias()
    alike = others.c.batch.is_not(None) if share else others.c.batch.is_(None)
    own = select(func.max(others.c.turn) + 1).where(QUEUED, others.c.tenant == tenant, others.c.cost == cost, alike)
    present = select(func.min(others.c.turn)).where(QUEUED, others.c.cost == cost, others.c.turn > AT_ONCE)
    first = AT_ONCE + 1
    return Later(func.coalesce(own.scalar_subquery(), first), func.coalesce(present.scalar_subquery(), first))


def turn_as_long() -> Any:
    """The turn of a job or share that is taken for long from now on: after those of its tenant that are."""
    tenant = jobs.c.tenant
    return case((SINGLE, turn_of(tenant, Cost.LONG)), else_=turn_of(tenant, Cost.LONG, share=True))


TURN_AGAIN = case((SINGLE, AT_ONCE), else_=turn_of(jobs.c.tenant, jobs.c.cost, share=True))
"""The turn of what had one, and was put back."""

BACK_IN_QUEUE: Mapping[str, Any] = {
    "progress_fraction": 0.0,
    "progress_message": "queued",
    "started_at": None,
    "turn": TURN_AGAIN,
}

# What every job goes through is stated once. SQLAlchemy takes several times as long to put a statement together, and to
# recognize it in its cache of compiled ones, as the database to execute it.
BY_ID = select(*WHOLE).where(jobs.c.id == bindparam("job"), SINGLE)
_STORED = [*new_row("", "", None, ""), *NO_KEY]
_queued = select(jobs.c.id).where(QUEUED, jobs.c.tenant == bindparam("of")).limit(bindparam("most", type_=Integer))
COUNT_QUEUED = select(func.count()).select_from(_queued.subquery())
# Counted by the statement that inserts, so that many who come at once cannot all find the last place.
INSERT = (
    insert(jobs)
    .from_select(
        [*_STORED, "turn"],
        select(
            *(bindparam(name, type_=jobs.c[name].type) for name in _STORED), turn_of(bindparam("of"), bindparam("as"))
        ).where(COUNT_QUEUED.scalar_subquery() < bindparam("most", type_=Integer)),
    )
    .execution_options(preserve_rowcount=True)
)
# Those that another host is about to take are passed over; SQLite has one that takes jobs.
NEXT = (
    select(jobs.c.id)
    .where(QUEUED, jobs.c.cost == bindparam("cost"))
    .order_by(jobs.c.turn, jobs.c.id)
    .limit(1)
    .with_for_update(skip_locked=True)
)
NEXT_OF_OTHERS = NEXT.where(jobs.c.tenant.not_in(bindparam("passed_over", expanding=True)))
CLAIM = (
    update(jobs)
    .where(jobs.c.id == bindparam("job"), jobs.c.status.in_(MOVES["claim"].sources))
    .values(
        status=MOVES["claim"].target,
        revision=jobs.c.revision + 1,
        progress_message="running",
        started_at=bindparam("moment"),
        attempt=jobs.c.attempt + 1,
        claim=bindparam("mark"),
        due_at=StoreClock() + LEASE_S,
    )
    .returning(*TAKEN)
)
CLAIMED = select(*TAKEN).where(jobs.c.status == MOVES["claim"].target, jobs.c.claim == bindparam("mark"))
_OF_THE_ATTEMPT = jobs.c.attempt == bindparam("of")
SUCCEED = moved(
    "succeed",
    bindparam("job"),
    result=bindparam("answer"),
    progress_fraction=1.0,
    progress_message="succeeded",
    finished_at=bindparam("moment"),
    digest=bindparam("known_by"),
).where(_OF_THE_ATTEMPT)
FAIL = moved(
    "fail", bindparam("job"), error=bindparam("answer"), progress_message="failed", finished_at=bindparam("moment")
).where(_OF_THE_ATTEMPT)
