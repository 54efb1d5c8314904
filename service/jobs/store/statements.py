"""The SQL statements that move a job between states, and those executed for every job.

Each change is one ``UPDATE`` whose ``WHERE`` clause names the states from which the move is allowed
(:data:`service.jobs.store.states.MOVES`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from sqlalchemy import (
    Case,
    ColumnElement,
    Integer,
    ScalarSelect,
    Select,
    Update,
    bindparam,
    case,
    func,
    insert,
    literal,
    select,
    update,
)
from sqlalchemy.sql.dml import ReturningUpdate
from ulid import ULID

from service.jobs.faults import WORKER_DIED
from service.jobs.store.schema import QUEUED_CONDITION, JobRow, JobSummary, Later, StoreClock, format_now, jobs
from service.jobs.store.states import MOVES, Cost, Status

LEASE_S = 10.0
"""Time after its last sign of life when an attempt counts as abandoned, seconds. Signs come twice a second, but a
machine may be very busy, and a database may need some seconds for a restart."""

MAX_CRASHES = 3
"""Number of retries of a job whose worker died by itself."""

MAX_KILLS = 20
"""Number of retries of a job whose worker was killed from outside. That is rarely the job's fault; it may be if the
system kills processes for lack of memory, so the number is bounded."""

IMMEDIATE_TURN = 0
"""The turn of a requeued job: before all new ones, whose turns begin with 1. Shares of batches are requeued all the
time, and a batch may have thousands of samples that kill a worker, so shares wait for a new turn instead."""

MAX_IDS = 500
"""Maximum number of ids in one statement; databases limit the number of its parameters."""

COLUMNS = tuple(field.name for field in fields(JobRow))  # begins with the fields of a summary
SUMMARY_COLUMNS = [jobs.c[field.name] for field in fields(JobSummary)]
JOB_COLUMNS = [jobs.c[name] for name in COLUMNS]
CLAIM_COLUMNS = [jobs.c[name] for name in ("id", "tenant", "claim", "attempt", "cost", "kind", "problem", "batch")]
IS_SINGLE_JOB = jobs.c.batch.is_(None)
"""Condition for jobs posted by clients, as opposed to shares of batches."""


def build_move(name: str, job_id: str | ColumnElement[str] | ScalarSelect[str], **values: object) -> Update:
    """Build the update that makes the named move with a job in a source state; ``values`` are stored with it."""
    move = MOVES[name]
    return (
        update(jobs)
        .where(jobs.c.id == job_id, jobs.c.status.in_(move.sources))
        .values(status=move.target, revision=jobs.c.revision + 1, **values)
    )


NO_KEY: Mapping[str, None] = {"idempotency_key": None, "request_hash": None}


def build_death_update(job_id: str, retries: int) -> ReturningUpdate[Any]:
    """Build the update for a dead worker: requeue the job, or fail it after ``retries`` deaths; returns the state."""
    again, over = MOVES["requeue"], MOVES["give_up"]
    worn_out = jobs.c.crashes >= retries
    return (
        update(jobs)
        .where(jobs.c.id == job_id, jobs.c.status.in_(again.sources & over.sources))
        .values(
            status=case((worn_out, over.target), else_=again.target),
            error=case((worn_out, WORKER_DIED.as_json(job_id)), else_=None),
            started_at=case((worn_out, jobs.c.started_at), else_=None),
            finished_at=case((worn_out, format_now()), else_=None),
            progress_fraction=case((worn_out, jobs.c.progress_fraction), else_=0.0),
            progress_message=case((worn_out, "failed"), else_="queued"),
            crashes=jobs.c.crashes + 1,
            revision=jobs.c.revision + 1,
            turn=REPEATED_TURN,
        )
        .returning(jobs.c.status)
    )


def build_row(tenant: str, kind: str, label: str | None, problem: str, cost: Cost = Cost.LONG) -> dict[str, Any]:
    """Build the row of a job that has just been accepted."""
    return {
        "id": str(ULID()),
        "tenant": tenant,
        "kind": kind,
        "label": label,
        "status": Status.QUEUED,
        "created_at": format_now(),
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


def build_turn(tenant: str | ColumnElement[str], cost: str | ColumnElement[str], *, share: bool = False) -> Later:
    """Build the turn of a tenant's next job: after the tenant's other jobs, and not before the present turn.

    Jobs are taken in the order of their turns, which is a round robin: each waiting tenant has one job in each turn. A
    new tenant joins at the present turn, however many jobs of others wait. The shares of a tenant's batches have turns
    of their own, so that its jobs do not wait for them.
    """
    others = jobs.alias()
    alike = others.c.batch.is_not(None) if share else others.c.batch.is_(None)
    own = select(func.max(others.c.turn) + 1).where(
        QUEUED_CONDITION, others.c.tenant == tenant, others.c.cost == cost, alike
    )
    present = select(func.min(others.c.turn)).where(
        QUEUED_CONDITION, others.c.cost == cost, others.c.turn > IMMEDIATE_TURN
    )
    first = IMMEDIATE_TURN + 1
    return Later(func.coalesce(own.scalar_subquery(), first), func.coalesce(present.scalar_subquery(), first))


def build_long_turn() -> Case[int]:
    """Build the turn of a job or share that becomes long: after the tenant's other long ones."""
    tenant = jobs.c.tenant
    return case((IS_SINGLE_JOB, build_turn(tenant, Cost.LONG)), else_=build_turn(tenant, Cost.LONG, share=True))


REPEATED_TURN = case((IS_SINGLE_JOB, IMMEDIATE_TURN), else_=build_turn(jobs.c.tenant, jobs.c.cost, share=True))
"""The turn of a requeued job or share."""

REQUEUED_VALUES: Mapping[str, object] = {
    "progress_fraction": 0.0,
    "progress_message": "queued",
    "started_at": None,
    "turn": REPEATED_TURN,
}

# The statements executed for every job are built once. SQLAlchemy takes several times as long to build a statement and
# to find it in its cache of compiled ones as the database takes to execute it.
SELECT_BY_ID = select(*JOB_COLUMNS).where(jobs.c.id == bindparam("job"), IS_SINGLE_JOB)
_STORED_COLUMNS = [*build_row("", "", None, ""), *NO_KEY]
_queued = (
    select(jobs.c.id).where(QUEUED_CONDITION, jobs.c.tenant == bindparam("of")).limit(bindparam("most", type_=Integer))
)
COUNT_QUEUED = select(func.count()).select_from(_queued.subquery())


def _count_turns(cost: Cost, *, share: bool = False) -> ColumnElement[int]:
    """Build the number of turns from a tenant's first queued job to its last one, which takes two look-ups."""
    alike = jobs.c.batch.is_not(None) if share else IS_SINGLE_JOB
    turns = select(func.coalesce(func.max(jobs.c.turn) - func.min(jobs.c.turn) + 1, 0))
    return turns.where(QUEUED_CONDITION, jobs.c.tenant == bindparam("of"), jobs.c.cost == cost, alike).scalar_subquery()


# The first number is exact up to the limit given; the second is at least the number of queued jobs that do not share a
# turn. A job that has been requeued has turn 0, which makes the second number large, never too small.
SELECT_QUEUE_BOUNDS = select(
    COUNT_QUEUED.scalar_subquery(),
    sum((_count_turns(cost, share=share) for cost in Cost for share in (False, True)), start=literal(0)),
)
_NEW_JOB = select(
    *(bindparam(name, type_=jobs.c[name].type) for name in _STORED_COLUMNS),
    build_turn(bindparam("of"), bindparam("as")),
)
INSERT_JOB = insert(jobs).from_select([*_STORED_COLUMNS, "turn"], _NEW_JOB)
# This statement itself counts, so that concurrent inserts cannot all take the last place.
INSERT_JOB_UNLESS_FULL = (
    insert(jobs)
    .from_select(
        [*_STORED_COLUMNS, "turn"],
        _NEW_JOB.where(COUNT_QUEUED.scalar_subquery() < bindparam("most", type_=Integer)),
    )
    .execution_options(preserve_rowcount=True)
)
# Skips jobs that another host is about to claim; with SQLite only one process claims jobs.
SELECT_NEXT = (
    select(jobs.c.id)
    .where(QUEUED_CONDITION, jobs.c.cost == bindparam("as"))
    .order_by(jobs.c.turn, jobs.c.id)
    .limit(1)
    .with_for_update(skip_locked=True)
)
SELECT_NEXT_OF_OTHERS = SELECT_NEXT.where(jobs.c.tenant.not_in(bindparam("passed_over", expanding=True)))


def build_claim(following: Select[tuple[str]]) -> ReturningUpdate[Any]:
    """Build the update that claims the job that a query finds, in one statement and so in one trip."""
    return build_move(
        "claim",
        # Found before the update and once: PostgreSQL might repeat a subquery, and lock another job each time.
        select(following.cte("following").c.id).scalar_subquery(),
        progress_message="running",
        started_at=bindparam("moment"),
        attempt=jobs.c.attempt + 1,
        claim=bindparam("mark"),
        due_at=StoreClock() + LEASE_S,
    ).returning(*CLAIM_COLUMNS)


CLAIM_NEXT = build_claim(SELECT_NEXT)
CLAIM_NEXT_OF_OTHERS = build_claim(SELECT_NEXT_OF_OTHERS)
SELECT_CLAIMED = select(*CLAIM_COLUMNS).where(jobs.c.status == MOVES["claim"].target, jobs.c.claim == bindparam("mark"))
_IS_ATTEMPT = jobs.c.attempt == bindparam("of")
UPDATE_SUCCEEDED = build_move(
    "succeed",
    bindparam("job"),
    result=bindparam("answer"),
    progress_fraction=1.0,
    progress_message="succeeded",
    finished_at=bindparam("moment"),
    digest=bindparam("known_by"),
).where(_IS_ATTEMPT)
UPDATE_FAILED = build_move(
    "fail", bindparam("job"), error=bindparam("answer"), progress_message="failed", finished_at=bindparam("moment")
).where(_IS_ATTEMPT)
