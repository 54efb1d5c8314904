"""A process that is killed while it makes or upgrades the tables leaves the store as it was, or as it is to be."""

import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import text

from service.jobs.batches.plan import Plan
from service.jobs.batches.store import BatchStore
from service.jobs.job_store import JobStore
from service.jobs.store.database import connect, upgrade
from service.jobs.store.states import Cost, Status
from tests.cluster.backend import CHOSEN
from tests.support.service.upgrades import dies_everywhere


@pytest.mark.embedded
@pytest.mark.parametrize("revision", [None, "0002"])
def test_a_killed_upgrade_is_done_again(tmp_path, revision):
    assert dies_everywhere(tmp_path, revision, "after", (7, 10)) == 2


@pytest.fixture
def engine(tmp_path):
    engine = connect(CHOSEN.store_url(tmp_path), durable=True)
    yield engine
    engine.dispose()


OLD = {
    "queued": {"turn": 3, "cost": "short", "attempt": 0},
    "running": {"turn": 0, "cost": "long", "attempt": 2, "started_at": "2026-01-01T00:00:00.000000Z"},
    "succeeded": {"attempt": 1, "result": '{"designs": []}', "finished_at": "2026-01-01T00:00:00.000000Z"},
    "failed": {"attempt": 4, "error": "{}", "finished_at": "2026-01-01T00:00:00.000000Z"},
    "cancelled": {"attempt": 1, "finished_at": "2026-01-01T00:00:00.000000Z"},
}


def job_id(status):
    return f"01K6WM2B7Q3W9Z0V5N8XJ4R1T{'ABCDE'[list(OLD).index(status)]}"


def before_batches(engine):
    """A store of the version before batches, with a job in each state."""
    upgrade(engine, "0005")
    with engine.begin() as connection:
        for status, values in OLD.items():
            row = {
                "id": job_id(status), "kind": "motion", "status": status, "created_at": "2026-01-01T00:00:00.000000Z",
                "progress_fraction": 0.0, "progress_message": status, "problem": '{"kind": "motion"}', "crashes": 0,
                "revision": 5, "tenant": "a", "idempotency_key": status, "request_hash": "hash", **values,
            }  # fmt: skip
            names, marks = ", ".join(row), ", ".join(f":{name}" for name in row)
            connection.execute(text(f"INSERT INTO jobs ({names}) VALUES ({marks})"), row)


def made(store):
    """A batch of two samples, and the ids of its shares."""
    plan = Plan({"kind": "motion"}, ["/seed"], [[1, 2]], True, ["size"], True)
    new = {"tenant": "a", "kind": "motion", "label": None, "plan": plan, "cost": Cost.SHORT, "repeatable": None}
    return store.create(**new, max_queued=3)


def all_jobs(engine):
    with engine.connect() as connection:
        return [dict(row) for row in connection.execute(text("SELECT * FROM jobs ORDER BY id")).mappings()]


def test_jobs_of_the_time_before_batches_are_as_they_were(engine):
    before_batches(engine)
    old = all_jobs(engine)
    upgrade(engine)
    assert all_jobs(engine) == [{**row, "batch": None, "digest": None} for row in old]
    single, store = JobStore(engine), BatchStore(engine)
    assert {single.get(job_id(status)).status for status in OLD} == {Status(status) for status in OLD}
    assert len(single.list_page(tenant="a", limit=9)) == len(OLD)
    batch, shares = made(store)
    assert store.find_answers(batch, ["one"]) == {}, "an answer of that time has no digest"
    taken = [single.take(f"m{n}", [Cost.SHORT]) for n in range(3)]
    assert {claim.job_id for claim in taken} == {job_id("queued"), *shares}
    assert single.complete(job_id("queued"), 1, "{}", "one")
    assert store.find_answers(batch, ["one"]) == {"one": "{}"}
    assert single.requeue_unfinished() == 3


def test_a_downgrade_keeps_the_jobs_and_drops_the_batches(engine):
    before_batches(engine)
    old = all_jobs(engine)
    upgrade(engine)
    made(BatchStore(engine))
    config = Config()
    config.set_main_option("script_location", "service/jobs/migrations")
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "0005")
    assert all_jobs(engine) == old
    upgrade(engine)
    assert [row["id"] for row in all_jobs(engine)] == [row["id"] for row in old]
    assert BatchStore(engine).list_page(tenant="a", limit=9, before=None) == []
