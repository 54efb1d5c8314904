"""The tables of jobs, batches, samples and worker hosts, and value classes of their rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Boolean, Column, Float, Index, Integer, MetaData, Row, String, Table, Text, text
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.expression import FunctionElement

from service.jobs.store.states import UNFINISHED_STATES, Cost, Status

AnyRow = Row[*tuple[Any, ...]]
"""A row of a query; the tables carry no static types of their columns."""

metadata = MetaData()

MAX_TENANT_LENGTH = 100
"""Maximum length of a tenant's name, characters."""

# Times are text of fixed width ("2026-01-31T12:00:00.000000Z"): the same on every database, sortable, and as the API
# shows them. The expiry of a lease (due_at) uses the clock of the database instead, because the clocks of several
# machines differ: seconds since 1970, see StoreClock. Problem, result and error are JSON text, because no query reads
# inside them. queued_at is never read; processes of the previous version write it. A row with a batch is not a client's
# job but a share of that batch, and its problem is the remaining range of samples. digest is the hash of the problem
# and the solvers, set if the job has an answer that equal problems can reuse.
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
    Column("tenant", String(MAX_TENANT_LENGTH), nullable=False, server_default=""),
    Column("claim", String(26)),
    Column("queued_at", Float, nullable=False, server_default="0"),
    Column("due_at", Float, nullable=False, server_default="0"),
    Column("cost", String(5), nullable=False, server_default=Cost.LONG.value),
    Column("turn", Integer, nullable=False, server_default="0"),
    Column("batch", String(26)),
    Column("digest", String(64)),
    Index("jobs_by_status", "status", "id"),
    Index("jobs_by_tenant", "tenant", "id"),
    Index("jobs_by_tenant_and_status", "tenant", "status", "id"),
    Index("jobs_by_tenant_and_kind", "tenant", "kind", "id"),
    Index("jobs_by_idempotency_key", "tenant", "idempotency_key", unique=True),
)
Index(
    "jobs_by_due_at", jobs.c.due_at, postgresql_where=jobs.c.status.in_([s.value for s in sorted(UNFINISHED_STATES)])
).ddl_if("postgresql")  # fmt: skip

# Queued jobs are queried often and are a small part of the table, hence the partial indexes.
QUEUED_CONDITION = text("status = 'queued'")
"""Condition of the partial indexes of queued jobs. A database uses them only for queries with the same condition."""

# The last turn of a tenant is the end of a range in one of two indexes. With one index for jobs and shares, on (tenant,
# cost, batch, turn), PostgreSQL may walk through the queued jobs of all tenants instead: a second at a million.
for _name, _columns, _condition in (
    ("jobs_queued_by_turn", ("cost", "turn", "id"), QUEUED_CONDITION),
    ("jobs_queued_by_tenant", ("tenant", "cost", "turn"), text("status = 'queued' AND batch IS NULL")),
    ("shares_queued_by_tenant", ("tenant", "cost", "turn"), text("status = 'queued' AND batch IS NOT NULL")),
):
    Index(_name, *(jobs.c[c] for c in _columns), sqlite_where=_condition, postgresql_where=_condition)

# Batches: the client's request and the counts, which the API shows, and the plan, the values of all samples, which only
# the solution and the table need. Both texts are JSON. A row marked as removed is hidden and about to be deleted.
batches = Table(
    "batches",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("tenant", String(MAX_TENANT_LENGTH), nullable=False),
    Column("kind", String(40), nullable=False),
    Column("label", String(200)),
    Column("status", String(10), nullable=False),
    Column("created_at", String(27), nullable=False),
    Column("started_at", String(27)),
    Column("finished_at", String(27)),
    Column("total", Integer, nullable=False),
    Column("succeeded", Integer, nullable=False),
    Column("failed", Integer, nullable=False),
    Column("cached", Integer, nullable=False),
    Column("revision", Integer, nullable=False),
    Column("removed", Boolean, nullable=False),
    Column("stated", Text, nullable=False),
    Column("plan", Text, nullable=False),
    Column("idempotency_key", String(200)),
    Column("request_hash", String(64)),
    Index("batches_by_tenant", "tenant", "id"),
    Index("batches_by_idempotency_key", "tenant", "idempotency_key", unique=True),
)

# Ended samples of batches, identified by batch and number, for clients by their id. A sample equal to another one of
# its batch refers to that one's answer by its number (same_as) and has no digest, so that a batch has few rows per
# digest. Small columns come before large ones, which a database then need not read.
samples = Table(
    "samples",
    metadata,
    Column("id", String(26), nullable=False),
    Column("batch", String(26), primary_key=True),
    Column("tenant", String(MAX_TENANT_LENGTH), nullable=False),
    Column("number", Integer, primary_key=True),
    Column("status", String(10), nullable=False),
    Column("cached", Boolean, nullable=False),
    Column("started_at", String(27), nullable=False),
    Column("finished_at", String(27), nullable=False),
    Column("digest", String(64)),
    Column("same_as", Integer),
    Column("figures", Text),
    Column("error", Text),
    Column("result", Text),
    Index("samples_by_id", "id", unique=True),
)

# Partial indexes: single jobs have no batch, and rows without an answer of their own have no digest.
_DIGEST_COLUMNS = [samples.c.tenant, samples.c.digest, samples.c.batch]
for _name, _key in (("batch", [jobs.c.batch]), ("digest", [jobs.c.tenant, jobs.c.digest]), ("digest", _DIGEST_COLUMNS)):
    _given = text(f"{_name} IS NOT NULL")
    Index(f"{_key[0].table.name}_by_{_name}", *_key, sqlite_where=_given, postgresql_where=_given)

# The worker hosts that run jobs for several servers, one row each.
hosts = Table(
    "hosts",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("workers", Integer, nullable=False),
    Column("seen_at", Float, nullable=False),
)


def _register_sql(function: type[FunctionElement[Any]], **databases: str) -> None:
    """Register the SQL of a function for each database; braces in it stand for the arguments."""
    for database, expression in databases.items():

        def write(element: Any, compiler: Any, expression: str = expression, **options: Any) -> str:
            return expression.format(compiler.process(element.clauses, **options))

        compiles(function, database)(write)


class StoreClock(FunctionElement[float]):
    """The present time by the clock of the database, which all its clients share; seconds since 1970."""

    name = "store_clock"
    type = Float()
    inherit_cache = True


_register_sql(
    StoreClock,
    sqlite="((julianday('now') - 2440587.5) * 86400.0)",
    postgresql="CAST(extract(epoch FROM clock_timestamp()) AS double precision)",
)


class Later(FunctionElement[int]):
    """The maximum of two numbers, as SQL."""

    name = "later"
    type = Integer()
    inherit_cache = True


_register_sql(Later, sqlite="max({})", postgresql="greatest({})")


@dataclass(frozen=True, slots=True)
class Entry:
    """The fields that jobs and batches share."""

    id: str
    tenant: str
    kind: str
    label: str | None
    status: Status
    created_at: str
    started_at: str | None
    finished_at: str | None


@dataclass(frozen=True, slots=True)
class JobSummary(Entry):
    """A job without its problem and answer."""

    progress_fraction: float
    progress_message: str
    attempt: int
    crashes: int
    revision: int


@dataclass(frozen=True, slots=True)
class JobRow(JobSummary):
    """A complete job; ``problem``, ``result`` and ``error`` are JSON text."""

    problem: str
    result: str | None
    error: str | None


@dataclass(frozen=True, slots=True)
class SampleRow(JobRow):
    """An ended sample of a batch as a job; ``cached`` means that the answer of an equal problem was reused."""

    batch: str
    cached: bool


@dataclass(frozen=True, slots=True)
class Claim:
    """The right to run a job: its mark, the number of the attempt, the estimated cost, the problem as JSON text.

    With a ``batch`` the job is a share of that batch, and the problem is the rest of the share.
    """

    job_id: str
    tenant: str
    mark: str
    attempt: int
    cost: Cost
    kind: str
    problem: str
    batch: str | None = None


def as_values(row: Sequence[Any]) -> list[Any]:
    """Convert a row, queried in the order of an entry's fields, to the values of these fields."""
    values = [*row]
    values[_STATUS_INDEX] = Status(values[_STATUS_INDEX])
    return values


_STATUS_INDEX = [field.name for field in fields(Entry)].index("status")


def format_now() -> str:
    """Return the present time in its stored form."""
    return as_stored(datetime.now(UTC))


def as_stored(time: datetime) -> str:
    """Format a time (UTC) in its stored form."""
    return time.strftime("%Y-%m-%dT%H:%M:%S.%fZ")
