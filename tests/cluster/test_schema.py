"""The tables in PostgreSQL."""

import threading

import pytest
from alembic import command
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from sqlalchemy import bindparam, inspect, select, text

from service.access.keys import api_keys
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, upgrade
from service.jobs.store.schema import hosts, jobs, metadata
from service.jobs.store.statements import SELECT_QUEUE_BOUNDS, build_turn
from service.jobs.store.states import Cost
from tests.cluster.backend import CHOSEN
from tests.cluster.load import fill_queue

pytestmark = [pytest.mark.cluster]


@pytest.fixture
def engine(tmp_path):
    engine = connect(CHOSEN.store_url(tmp_path), durable=True)
    yield engine
    engine.dispose()


def test_the_migrations_make_the_tables_of_the_schema(engine):
    upgrade(engine)
    assert {jobs.name, hosts.name, api_keys.name} <= set(inspect(engine).get_table_names())
    with engine.connect() as connection:
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []


def test_nothing_notifies_inside_the_transactions_of_jobs(engine):
    upgrade(engine)
    with engine.connect() as connection:
        assert connection.execute(text("SELECT tgname FROM pg_trigger WHERE NOT tgisinternal")).all() == []


def test_a_downgrade_leaves_nothing_behind(engine):
    upgrade(engine)
    config = Config()
    config.set_main_option("script_location", "service/jobs/migrations")
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "base")
    with engine.connect() as connection:
        left = connection.execute(text("SELECT proname FROM pg_proc WHERE proname = 'tell_of_job'")).all()
    assert left == []
    assert inspect(engine).get_table_names() == ["alembic_version"]


def test_many_may_upgrade_at_once(tmp_path):
    url = CHOSEN.store_url(tmp_path)
    failures = []

    def start():
        engine = connect(url, durable=False)
        try:
            upgrade(engine)
        except Exception as failure:  # a thread of its own would keep it; the test must see it
            failures.append(failure)
        engine.dispose()

    threads = [threading.Thread(target=start) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []


def test_writes_wait_for_the_disk(engine):
    for durable in (True, False):
        other = connect(engine.url.render_as_string(hide_password=False), durable=durable)
        with other.connect() as connection:
            assert connection.execute(text("SHOW synchronous_commit")).scalar() == "on"
        other.dispose()


@pytest.fixture
def crowded(engine):
    """100,000 queued jobs of 100 tenants, long ones only."""
    upgrade(engine)
    with engine.begin() as connection:
        fill_queue(connection, jobs=100_000, tenants=100)
    return engine


@pytest.mark.parametrize(("tenant", "cost"), [("new", "long"), ("t7", "short"), ("t7", "long")])
def test_posting_reads_a_few_pages_of_a_long_queue(crowded, tenant, cost):
    """The planner must not walk through the jobs of all tenants in search of those of one."""
    for statement in (select(build_turn(bindparam("of"), bindparam("as"))), SELECT_QUEUE_BOUNDS):
        made = statement.compile(crowded)
        given = {name: value for name, value in {"of": tenant, "as": cost, "most": 9}.items() if name in made.params}
        with crowded.connect() as connection:
            plan = connection.exec_driver_sql(
                f"EXPLAIN (ANALYZE, BUFFERS, FORMAT JSON) {made}", made.construct_params(given)
            ).scalar_one()[0]["Plan"]
        assert plan["Shared Hit Blocks"] + plan["Shared Read Blocks"] < 60, plan


def test_the_bounds_of_a_queue_hold(engine):
    upgrade(engine)
    store, bounds = JobStore(engine), {"of": "a", "most": 5}
    ids = [store.create(tenant="a", kind="motion", label=None, problem="{}", cost=cost).id for cost in [*Cost] * 6]

    def read():
        with engine.connect() as connection:
            return tuple(connection.execute(SELECT_QUEUE_BOUNDS, bounds).one())

    assert read() == (5, 12)
    assert all(store.cancel(job_id) for job_id in ids[2:-2])
    assert read() == (4, 12), "the cancelled ones lie between the others"
    store.take("mark", [Cost.LONG])
    assert store.requeue(ids[1], "mark")
    assert read()[1] >= 12
    store.create(tenant="b", kind="motion", label=None, problem="{}")
    assert read()[0] == 4


def test_connections_that_were_cut_are_replaced(engine):
    upgrade(engine)
    store = JobStore(engine)
    for _ in range(3):
        store.create(tenant="", kind="motion", label=None, problem="{}", max_queued=10)
        CHOSEN.postgres.query(
            engine.url.database,
            "SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity "
            "WHERE datname = current_database() AND pid <> pg_backend_pid()",
        )
    assert store.count_unfinished()["queued"] == 3
