"""The table of jobs, and a row of it as a value."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from datetime import UTC, datetime
from typing import Any

from sqlalchemy import Boolean, Column, Float, Index, Integer, MetaData, String, Table, Text, text
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.expression import FunctionElement

from service.jobs.store.states import UNFINISHED, Cost, Status

metadata = MetaData()

TENANT_LENGTH = 100
"""Longest name of a tenant."""

# Times are text of one width ("2026-01-31T12:00:00.000000Z"): the same on every database, sorted as they are, and what
# the API shows. How long a running job is taken for alive (due_at) goes by the clock of the database instead, since
# those of several machines differ: seconds since 1970, see StoreClock. Problem, result and error are JSON as text,
# because nothing ever looks inside them here. Nothing reads queued_at; processes of the version before write it. A row
# with a batch is no job that a client has posted but a share of that batch, its problem the range that is left; digest
# is that of the problem and of the solvers, where the job has an answer that equal problems can be given.
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
    "jobs_by_due_at", jobs.c.due_at, postgresql_where=jobs.c.status.in_([s.value for s in sorted(UNFINISHED)])
).ddl_if("postgresql")  # fmt: skip

# What is queued is asked for many times, and is a small part of the table.
QUEUED = text("status = 'queued'")
"""As the indexes of queued jobs state it. A database uses them only where a query says the same."""

for _name, _columns in (("turn", ("cost", "turn", "id")), ("tenant", ("tenant", "cost", "batch", "turn"))):
    Index(f"jobs_queued_by_{_name}", *(jobs.c[c] for c in _columns), sqlite_where=QUEUED, postgresql_where=QUEUED)

# Many problems at once: what was stated and how far it is, which is shown, and the plan, the values of all problems,
# which only their answers and the table need. Both are JSON. One that is removed is none; it is about to vanish.
batches = Table(
    "batches",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("tenant", String(TENANT_LENGTH), nullable=False),
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

# The problems of batches that have ended. They are known by their batch and number, and to clients by their id. One
# that is the same as another of its batch has the answer of that one, by its number (same_as), and no digest: by a
# digest a batch has few answers. What is small comes before what is large, which a database need not read then.
samples = Table(
    "samples",
    metadata,
    Column("id", String(26), nullable=False),
    Column("batch", String(26), primary_key=True),
    Column("tenant", String(TENANT_LENGTH), nullable=False),
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

# Single jobs have no batch, and what has no answer of its own has no digest.
_BY_DIGEST = [samples.c.tenant, samples.c.digest, samples.c.batch]
for _name, _key in (("batch", [jobs.c.batch]), ("digest", [jobs.c.tenant, jobs.c.digest]), ("digest", _BY_DIGEST)):
    _given = text(f"{_name} IS NOT NULL")
    Index(f"{_key[0].table.name}_by_{_name}", *_key, sqlite_where=_given, postgresql_where=_given)

# Who runs jobs for several servers: a row for each worker host that is there.
hosts = Table(
    "hosts",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("workers", Integer, nullable=False),
    Column("seen_at", Float, nullable=False),
)


def _written(function: type[FunctionElement[Any]], **databases: str) -> None:
    """State how each database writes a function; its arguments, if it has any, stand in the braces."""
    for database, expression in databases.items():

        def write(element: Any, compiler: Any, expression: str = expression, **options: Any) -> str:
            return expression.format(compiler.process(element.clauses, **options))

        compiles(function, database)(write)


class StoreClock(FunctionElement[float]):
    """The present time by the clock of the database, which all who share it agree on; seconds since 1970."""

    name = "store_clock"
    type = Float()
    inherit_cache = True


_written(
    StoreClock,
    sqlite="((julianday('now') - 2440587.5) * 86400.0)",
    postgresql="CAST(extract(epoch FROM clock_timestamp()) AS double precision)",
)


class Later(FunctionElement[int]):
    """The greater of two numbers."""

    name = "later"
    type = Integer()
    inherit_cache = True


_written(Later, sqlite="max({})", postgresql="greatest({})")


@dataclass(frozen=True, slots=True)
class Entry:
    """What jobs and batches have."""

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
    """A job without its problem and its answer."""

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


@dataclass(frozen=True, slots=True)
class SampleRow(JobRow):
    """A problem of a batch that has ended, as the job that it is; ``cached``: an equal problem had the answer."""

    batch: str
    cached: bool


@dataclass(frozen=True, slots=True)
class Claim:
    """The right to run a job: its mark, the number of the attempt, the cost as estimated, the problem as JSON text.

    With a ``batch`` it is a share of that one, and the problem what is left of it.
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
    """The columns of an entry that were asked for in the order of its fields, as the values of these."""
    values = [*row]
    values[_STATUS] = Status(values[_STATUS])
    return values


_STATUS = [field.name for field in fields(Entry)].index("status")


def now() -> str:
    """The present time as it is stored."""
    return as_stored(datetime.now(UTC))


def as_stored(time: datetime) -> str:
    """A time (UTC) as it is stored."""
    return time.strftime("%Y-%m-%dT%H:%M:%S.%fZ")
