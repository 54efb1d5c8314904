"""The table of jobs, and a row of it as a value."""

from __future__ import annotations

from dataclasses import dataclass

from sqlalchemy import Column, Float, Index, Integer, MetaData, String, Table, Text

from service.jobs.states import Status

metadata = MetaData()

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
    Index("jobs_by_status", "status", "id"),
    Index("jobs_by_kind", "kind", "id"),
    Index("jobs_by_idempotency_key", "idempotency_key", unique=True),
)


@dataclass(frozen=True, slots=True)
class JobSummary:
    """A job without its problem and its answer."""

    id: str
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
