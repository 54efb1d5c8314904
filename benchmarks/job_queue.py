"""The queue in PostgreSQL: claims, whole lives of jobs and posts, as they are and as they were with triggers.

    python -m benchmarks.job_queue [--seconds 8] [--jobs 100000] [--million]

PostgreSQL is started from its Debian package on a free loopback port, with fsync on. Each client is a thread of pgbench
with the statements of the service, as SQLAlchemy writes them for PostgreSQL. "before" is the schema with the triggers
that notify inside the transactions of jobs, with the claim as a query and an update; "after" has no triggers. The runs
of both alternate, because the speed of a shared machine changes. Then the query for the turn of a new job is timed with
one index for jobs and shares and with the present ones, and whole posts: median and, in brackets, maximum.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import Engine, bindparam, select, text
from sqlalchemy.dialects import postgresql
from sqlalchemy.sql.elements import ClauseElement

from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, upgrade
from service.jobs.store.statements import CLAIM_NEXT, INSERT_JOB, NO_KEY, UPDATE_SUCCEEDED, build_row, build_turn
from service.jobs.store.states import Cost
from tests.cluster.load import fill_queue
from tests.cluster.postgres import Postgres, as_user, find_program

TENANTS = 50
MAX_QUEUED = 1200
"""Limit of a tenant's queued jobs; with a million of 1,000 tenants each queue is near it, and posts count it."""
MARK = "'01K6WM2B7Q3W9Z0V5N8XJ4R1TA'"

TRIGGERS = (
    "CREATE FUNCTION tell_of_job() RETURNS trigger LANGUAGE plpgsql AS "
    "$$ BEGIN PERFORM pg_notify('mechsynth_jobs', NEW.id); RETURN NULL; END $$",
    "CREATE TRIGGER jobs_tell AFTER UPDATE OF status ON jobs FOR EACH ROW "
    "WHEN (OLD.status IS DISTINCT FROM NEW.status) EXECUTE FUNCTION tell_of_job()",
    "CREATE FUNCTION tell_of_work() RETURNS trigger LANGUAGE plpgsql AS "
    "$$ BEGIN PERFORM pg_notify('mechsynth_work', ''); RETURN NULL; END $$",
    "CREATE TRIGGER jobs_tell_of_work AFTER INSERT OR UPDATE OF status ON jobs FOR EACH ROW "
    "WHEN (NEW.status = 'queued') EXECUTE FUNCTION tell_of_work()",
)
NO_TRIGGERS = ("DROP FUNCTION tell_of_job CASCADE", "DROP FUNCTION tell_of_work CASCADE")
OLD_INDEX = (
    "DROP INDEX jobs_queued_by_tenant",
    "DROP INDEX shares_queued_by_tenant",
    "CREATE INDEX jobs_queued_by_tenant ON jobs (tenant, cost, batch, turn) WHERE status = 'queued'",
)
NEW_INDEX = (
    "DROP INDEX jobs_queued_by_tenant",
    "CREATE INDEX jobs_queued_by_tenant ON jobs (tenant, cost, turn) WHERE status = 'queued' AND batch IS NULL",
    "CREATE INDEX shares_queued_by_tenant ON jobs (tenant, cost, turn) WHERE status = 'queued' AND batch IS NOT NULL",
)


def write_sql(statement: ClauseElement, **values: str) -> str:
    """A statement of the service for pgbench: its parameters become values, or SQL given by name."""
    compiled = statement.compile(dialect=postgresql.dialect())

    def show(value: object) -> str:
        return "NULL" if value is None else str(value) if isinstance(value, (int, float)) else f"'{value}'"

    sql = re.sub(
        r"__\[POSTCOMPILE_(\w+)\]", lambda found: ", ".join(map(show, compiled.params[found.group(1)])), str(compiled)
    )
    sql = re.sub(r"%\((\w+)\)s", lambda found: values.get(found.group(1)) or show(compiled.params[found.group(1)]), sql)
    return " ".join(sql.split())


def claim_and_return(sql: str, names: str) -> str:
    return sql.partition(" RETURNING ")[0] + f" RETURNING {names} \\gset\n"


CLAIM = claim_and_return(
    write_sql(CLAIM_NEXT, **{"as": "'long'", "mark": MARK, "moment": "''"}), "jobs.id AS job, jobs.attempt AS attempt"
)
CLAIM_IN_TWO = (
    "BEGIN;\nSELECT id AS job FROM jobs WHERE status = 'queued' AND cost = 'long' ORDER BY turn, id LIMIT 1 "
    "FOR UPDATE SKIP LOCKED \\gset\n"
    + CLAIM[CLAIM.index("UPDATE jobs") :].replace("(SELECT following.id FROM following)", "':job'")
    + "COMMIT;\n"
)
TEN_CLAIMS = write_sql(CLAIM_NEXT, **{"as": "'long'", "mark": MARK, "moment": "''"}).replace("LIMIT 1", "LIMIT 10")
TEN_CLAIMS = TEN_CLAIMS.replace("jobs.id = (SELECT", "jobs.id IN (SELECT") + ";\n"
FINISH = write_sql(
    UPDATE_SUCCEEDED, job="':job'", of=":attempt", answer="repeat('a', 200)", moment="''", known_by="NULL"
) + ";\n"  # fmt: skip
_ROW = {**build_row("", "motion", None, "{}"), **NO_KEY}
POST = (
    "\\set tenant random(1, 1000)\n"
    + write_sql(
        INSERT_JOB,
        **{name: "NULL" if value is None else f"'{value}'" for name, value in _ROW.items()}
        | {"id": "substr(md5(random()::text), 1, 26)", "tenant": "'p' || :tenant", "cost": "'long'"}
        | {"of": "'p' || :tenant", "as": "'long'"},
    )
    + ";\n"
)


class Database:
    """A database with the tables of the service, and pgbench against it."""

    def __init__(self, postgres: Postgres, name: str) -> None:
        self._postgres, self._name = postgres, name
        self.engine: Engine = connect(postgres.database(name), durable=True)
        upgrade(self.engine)

    def execute(self, *statements: str) -> None:
        with self.engine.begin() as connection:
            for statement in statements:
                connection.execute(text(statement))

    def fill(self, jobs: int, tenants: int) -> None:
        """Queued jobs and nothing else."""
        self.execute("TRUNCATE jobs")
        with self.engine.begin() as connection:
            fill_queue(connection, jobs, tenants)

    def run(self, script: str, clients: int, seconds: float) -> float:
        """Transactions a second of a script of pgbench."""
        folder = Path(tempfile.mkdtemp(prefix="mechsynth-pgbench-"))
        folder.chmod(0o755)
        (folder / "script").write_text(script)
        done = subprocess.run(
            as_user(
                find_program("pgbench"), "-n", "-f", str(folder / "script"), "-c", str(clients), "-j", "2",
                "-T", f"{seconds:g}", "-M", "simple", self._postgres.url(self._name),
            ),
            capture_output=True, text=True, cwd=folder,
        )  # fmt: skip
        shutil.rmtree(folder)
        found = re.search(r"tps = ([0-9.]+) \(without", done.stdout)
        assert found, done.stdout + done.stderr
        return float(found.group(1))


@contextmanager
def triggers(database: Database, wanted: bool) -> Iterator[None]:
    if wanted:
        database.execute(*TRIGGERS)
    try:
        yield
    finally:
        if wanted:
            database.execute(*NO_TRIGGERS)


def compare(database: Database, name: str, scripts: tuple[str, str], clients: int, given: argparse.Namespace) -> None:
    """A line: rates before and after, of runs that alternate."""
    rates: dict[bool, list[float]] = {True: [], False: []}
    for _ in range(given.runs):
        for before in (True, False):
            database.fill(given.jobs, TENANTS)
            with triggers(database, before):
                rates[before].append(database.run(scripts[0 if before else 1], clients, given.seconds))
    shown = ["/".join(f"{rate:.0f}" for rate in rates[before]) for before in (True, False)]
    print(f"{name:<74}{shown[0]:>18}{shown[1]:>18}", flush=True)


def compare_rates(database: Database, given: argparse.Namespace) -> None:
    claims, lives = (CLAIM_IN_TWO, CLAIM), (POST + CLAIM_IN_TWO + FINISH, POST + CLAIM + FINISH)
    compare(database, "claims, 8 claimers", claims, 8, given)
    compare(database, "claims, 200 claimers", claims, 200, given)
    compare(database, "whole lives, 8 clients", lives, 8, given)
    compare(database, "whole lives, 64 clients", lives, 64, given)
    compare(database, "trips with ten claims, 20 claimers", (TEN_CLAIMS, TEN_CLAIMS), 20, given)


def time_calls(call: Callable[[], object], calls: int = 20) -> str:
    """Median and maximum of the time that a call takes, milliseconds."""
    times = []
    for _ in range(calls):
        began = time.perf_counter()
        call()
        times.append(1e3 * (time.perf_counter() - began))
    return f"{statistics.median(times):.1f} ({max(times):.1f})"


def compare_posts(database: Database, jobs: int) -> None:
    """Lines: the query for the turn of a new job with the index before and after, and whole posts."""
    database.fill(jobs, min(1000, jobs // 10))
    store, turn = JobStore(database.engine), select(build_turn(bindparam("of"), bindparam("as")))
    shown: dict[str, list[str]] = {"t7": [], "new": []}
    for statements in (OLD_INDEX, NEW_INDEX):
        database.execute(*statements, "ANALYZE jobs")
        with database.engine.connect() as connection:
            for tenant, columns in shown.items():
                given = {"of": tenant, "as": Cost.SHORT if tenant == "t7" else Cost.LONG}
                columns.append(time_calls(lambda given=given: connection.execute(turn, given).scalar_one()))
    for (tenant, columns), words in zip(
        shown.items(), ("with queued jobs of the other cost", "without jobs"), strict=True
    ):
        print(f"{f'turn for a tenant {words}, {jobs:,} queued, ms':<74}{columns[0]:>18}{columns[1]:>18}")
        post = time_calls(
            lambda tenant=tenant: store.create(
                tenant=tenant, kind="motion", label=None, problem="{}", max_queued=MAX_QUEUED
            )
        )
        print(f"{'    whole post':<74}{'':>18}{post:>18}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0] if __doc__ else None)
    parser.add_argument("--seconds", type=float, default=8.0, help="length of each run")
    parser.add_argument("--jobs", type=int, default=100_000, help="queued jobs at the start of each run")
    parser.add_argument("--runs", type=int, default=2, help="runs before and after, which alternate")
    parser.add_argument("--million", action="store_true", help="posts beside a million queued jobs, too")
    parser.add_argument("--posts-only", action="store_true", help="leave out the rates of pgbench")
    given = parser.parse_args()
    postgres = Postgres()
    try:
        database = Database(postgres, "queue")
        print(f"load {os.getloadavg()[0]:.1f}, fsync on; each number is a run of {given.seconds:g} s")
        print(f"{'a second':<74}{'before':>18}{'after':>18}")
        if not given.posts_only:
            compare_rates(database, given)
        for jobs in (1_000, 100_000, *((1_000_000,) if given.million else ())):
            compare_posts(database, jobs)
        print(f"load {os.getloadavg()[0]:.1f}")
    finally:
        postgres.remove()


if __name__ == "__main__":
    main()
