"""The table of jobs, and a row of it as a value."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime

from sqlalchemy import Column, Float, Index, Integer, MetaData, String, Table, Text

from service.jobs.states import Status

metadata = MetaData()

TENANT_LENGTH = 100
"""Longest name of a tenant."""

# Times are text of one width ("2026-01-31T12:00:00.000000Z"): the same on every database, sorted as they are,
# and what the API shows. Problem, result and error are JSON as text, because nothing ever looks inside them here.
jobs = Table(
    "jobs",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("kind", String(40), nullable=False),
    Column("label", String(200)),
    Column("status", String(10), nullable=False),
    Column("created_at", String(27), nullable=False),
    Column("started_at", String(27)),
    Column("finished_at", String(27)),
    Column("progress_fraction", Float, nullable=False),
    Column("progress_message", String(200), nullable=False),
    Column("problem", Text, nullable=False),
    Column("result", Text),
    Column("error", Text),
    Column("attempt", Integer, nullable=False),
    Column("crashes", Integer, nullable=False),
    Column("revision", Integer, nullable=False),
    Column("idempotency_key", String(200)),
    Column("request_hash", String(64)),
    Column("tenant", String(TENANT_LENGTH), nullable=False, server_default=""),
    Index("jobs_by_status", "status", "id"),
    Index("jobs_by_tenant", "tenant", "id"),
    Index("jobs_by_tenant_and_status", "tenant", "status", "id"),
    Index("jobs_by_tenant_and_kind", "tenant", "kind", "id"),
    Index("jobs_by_idempotency_key", "tenant", "idempotency_key", unique=True),
)


@dataclass(frozen=True, slots=True)
class JobSummary:
    """A job without its problem and its answer."""

    id: str
    tenant: str
    kind: str
    label: str | None
    status: Status
    created_at: str
    started_at: str | None
    finished_at: str | None
    progress_fraction: float
    progress_message: str
    attempt: int
    crashes: int
    revision: int


@dataclass(frozen=True, slots=True)
class JobRow(JobSummary):
    """A job with everything that is stored of it; ``problem``, ``result`` and ``error`` are JSON text."""

    problem: str
    result: str | None
    error: str | None


def now() -> str:
    """The present time as it is stored."""
    return as_stored(datetime.now(UTC))


def as_stored(time: datetime) -> str:
    """A time (UTC) as it is stored."""
    return time.strftime("%Y-%m-%dT%H:%M:%S.%fZ")
