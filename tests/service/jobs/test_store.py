import sqlite3
import threading
import time
from datetime import UTC, datetime, timedelta
from importlib.resources import files

import pytest
from alembic import command
from alembic.config import Config
from sqlalchemy import bindparam, delete, insert, select, text, update

from service.access.keys import api_keys
from service.jobs.cluster.leases import LeaseStore
from service.jobs.job_store import JobStore
from service.jobs.store.admission import KeyReused, QueueFull, Repeatable
from service.jobs.store.database import LaterTables, connect, upgrade
from service.jobs.store.schema import QUEUED_CONDITION, StoreClock, format_now, hosts, jobs, metadata
from service.jobs.store.statements import LEASE_S, MAX_CRASHES, MAX_KILLS, build_claim, build_row
from service.jobs.store.states import FINISHED_STATES, MOVES, Cost, Status
from tests.cluster.backend import CHOSEN

ANY = tuple(Cost)

ACTIONS = {
    "claim": lambda store, job, attempt: store.take("new", ANY) is not None,
    "succeed": lambda store, job, attempt: store.complete(job, attempt, "{}"),
    "fail": lambda store, job, attempt: store.fail(job, attempt, "{}"),
    "requeue": lambda store, job, attempt: store.requeue(job, "old"),
    "give_up": lambda store, job, attempt: store.give_up(job, "old", "{}"),
    "cancel": lambda store, job, attempt: store.cancel(job),
}


@pytest.fixture(scope="module")
def upgraded(tmp_path_factory):
    engine = connect(CHOSEN.store_url(tmp_path_factory.mktemp("store")), durable=True)
    upgrade(engine)
    yield engine
    engine.dispose()


@pytest.fixture
def engine(upgraded):
    with upgraded.begin() as connection:
        for table in metadata.sorted_tables:
            connection.execute(delete(table))
    return upgraded


@pytest.fixture
def store(engine):
    return JobStore(engine)


@pytest.fixture
def leases(engine):
    return LeaseStore(engine)


@pytest.fixture
def job(store):
    return store.create(tenant="", kind="motion", label=None, problem='{"kind":"motion"}')


def claim(store, job_id, mark):
    """Claim this job as :meth:`JobStore.take` does, whosever turn it is; its row, or None."""
    with store._engine.begin() as connection:
        change = build_claim(select(jobs.c.id).where(jobs.c.id == bindparam("job"), QUEUED_CONDITION))
        return connection.execute(change, {"job": job_id, "mark": mark, "moment": format_now()}).one_or_none()


def put(engine, job_id, status, attempt=1):
    with engine.begin() as connection:
        connection.execute(update(jobs).where(jobs.c.id == job_id).values(status=status, attempt=attempt, claim="old"))


def test_every_move_has_an_action():
    assert set(ACTIONS) == set(MOVES)


@pytest.mark.parametrize("status", list(Status))
@pytest.mark.parametrize("name", list(MOVES))
def test_a_move_happens_from_its_sources_only(engine, store, job, name, status):
    put(engine, job.id, status)
    before = store.get(job.id)
    moved = ACTIONS[name](store, job.id, 1)
    after = store.get(job.id)
    assert moved == (status in MOVES[name].sources)
    if moved:
        assert after.status == MOVES[name].target
        assert after.revision == before.revision + 1
        assert (after.finished_at is not None) == (after.status in FINISHED_STATES)
    else:
        assert after == before


@pytest.mark.parametrize("name", ["succeed", "fail"])
def test_an_older_attempt_is_refused(store, job, name):
    first = claim(store, job.id, "first")
    store.requeue(job.id, "first")
    second = claim(store, job.id, "second")
    assert (first.attempt, second.attempt) == (1, 2)
    before = store.get(job.id)
    assert not ACTIONS[name](store, job.id, first.attempt)
    assert not store.record_progress(job.id, first.attempt, 0.9, "stale")
    assert store.get(job.id) == before
    assert ACTIONS[name](store, job.id, second.attempt)


def test_one_of_many_who_ask_at_once_gets_a_job(store, job):
    start = threading.Barrier(8)
    taken = []

    def ask(mark):
        start.wait()
        taken.append(store.take(mark, ANY))

    threads = [threading.Thread(target=ask, args=(f"mark {n}",)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(taken) == 8
    assert [(c.job_id, c.attempt) for c in taken if c is not None] == [(job.id, 1)]


def test_many_who_ask_at_once_get_a_job_each(store):
    """As many as there are: nobody is sent away because another one has been quicker."""
    ids = {store.create(tenant="", kind="motion", label=None, problem="{}").id for _ in range(24)}
    start = threading.Barrier(8)
    taken = []

    def ask(n):
        start.wait()
        taken.extend(store.take(f"mark {n} {k}", ANY) for k in range(3))

    threads = [threading.Thread(target=ask, args=(n,)) for n in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(claim.job_id for claim in taken) == sorted(ids)


def test_a_job_whose_worker_keeps_dying_is_given_up(store, job):
    for crash in range(MAX_CRASHES):
        claim(store, job.id, "claim")
        assert store.record_crash(job.id, "claim", killed=False) == Status.QUEUED
        assert store.get(job.id).crashes == crash + 1
    claim(store, job.id, "claim")
    assert store.record_crash(job.id, "claim", killed=False) == Status.FAILED
    given_up = store.get(job.id)
    assert "/problems/worker-died" in given_up.error
    assert given_up.finished_at is not None
    assert store.record_crash(job.id, "claim", killed=False) is None


def test_the_death_of_the_worker_of_a_cancelled_job_changes_nothing(store, job):
    claim(store, job.id, "claim")
    store.cancel(job.id)
    before = store.get(job.id)
    assert store.record_crash(job.id, "claim", killed=False) is None
    assert not store.requeue(job.id, "claim")
    assert store.get(job.id) == before


def test_a_late_write_does_not_bring_a_deleted_job_back(store, job):
    claimed = claim(store, job.id, "claim")
    assert not store.delete(job.id), "a running job must not be removed"
    store.cancel(job.id)
    assert store.delete(job.id)
    assert not store.complete(job.id, claimed.attempt, "{}")
    assert store.get(job.id) is None


def test_running_jobs_are_queued_again_before_new_ones(store):
    ids = [store.create(tenant="", kind="motion", label=None, problem="{}").id for _ in range(4)]
    claim(store, ids[0], "claim")
    claim(store, ids[2], "claim")
    store.complete(ids[2], 1, "{}")
    claim(store, ids[3], "claim")
    assert store.requeue_unfinished() == 3
    assert [store.take("mark", ANY).job_id for _ in range(3)] == [ids[0], ids[3], ids[1]]
    store.requeue(ids[0], "mark")
    assert store.get(ids[0]).status == Status.QUEUED
    assert store.get(ids[0]).started_at is None
    assert store.get(ids[2]).status == Status.SUCCEEDED


def test_progress_is_kept_within_bounds(store, job):
    claimed = claim(store, job.id, "claim")
    assert store.record_progress(job.id, claimed.attempt, 7.0, "x" * 1000)
    assert store.get(job.id).progress_fraction == 1.0
    assert len(store.get(job.id).progress_message) == 200


def test_pages_are_newest_first_and_filtered(store):
    ids = [store.create(tenant="", kind=kind, label=None, problem="{}").id for kind in ("motion", "cam", "motion")]
    claim(store, ids[0], "claim")
    assert [j.id for j in store.list_page(tenant="", limit=10)] == ids[::-1]
    assert [j.id for j in store.list_page(tenant="", limit=1, before=ids[2])] == [ids[1]]
    assert [j.id for j in store.list_page(tenant="", limit=10, kind="motion")] == [ids[2], ids[0]]
    assert [j.id for j in store.list_page(tenant="", limit=10, status=Status.RUNNING)] == [ids[0]]


def test_the_server_is_durable_and_the_workers_are_not(tmp_path):
    for durable, level in ((True, 2), (False, 1)):
        engine = connect(f"sqlite:///{tmp_path / 'x.sqlite3'}", durable=durable)
        with engine.connect() as connection:
            assert connection.exec_driver_sql("PRAGMA synchronous").scalar() == level
            assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"
            assert connection.exec_driver_sql("PRAGMA busy_timeout").scalar() == 10_000
        engine.dispose()


def test_the_migrations_make_the_tables_of_the_schema(tmp_path):
    made = []
    for name, make in (("migrated", upgrade), ("declared", metadata.create_all)):
        path = tmp_path / name
        engine = connect(f"sqlite:///{path}", durable=False)
        make(engine)
        engine.dispose()
        raw = sqlite3.connect(path)
        columns = [
            raw.execute(f"SELECT name, type, \"notnull\", dflt_value, pk FROM pragma_table_info('{table}')").fetchall()
            for table in (jobs.name, api_keys.name)
        ]
        indexes = raw.execute("SELECT name, sql FROM sqlite_master WHERE type='index' AND sql IS NOT NULL").fetchall()
        raw.close()
        made.append((columns, sorted(indexes)))
    assert made[0] == made[1]
    assert all(made[0][0])


def test_a_key_makes_one_job_until_that_is_removed(store):
    ours = {"tenant": "", "kind": "motion", "label": None, "problem": "{}"}
    first, new = store.create_once(**ours, repeatable=Repeatable("k", "a"))
    assert new
    assert store.create_once(**ours, repeatable=Repeatable("k", "a")) == (first, False)
    with pytest.raises(KeyReused) as reused:
        store.create_once(**ours, repeatable=Repeatable("k", "b"))
    assert reused.value.job_id == first.id
    store.cancel(first.id)
    assert store.delete(first.id)
    second, new = store.create_once(**ours, repeatable=Repeatable("k", "b"))
    assert new
    assert second.id != first.id


def test_the_queue_has_an_end(engine, store):
    ours = {"tenant": "", "kind": "motion", "label": None, "problem": "{}", "max_queued": 3}
    kept = store.create_once(**ours, repeatable=Repeatable("k", "a"))[0]
    created = [store.create(**ours) for _ in range(2)]
    assert store.get(created[0].id) == created[0], "stored as it was returned"
    with pytest.raises(QueueFull):
        store.create(**ours)
    with pytest.raises(QueueFull):
        store.create_once(**ours, repeatable=Repeatable("other", "a"))
    assert store.create_once(**ours, repeatable=Repeatable("k", "a")) == (kept, False), "it has its place already"
    with pytest.raises(KeyReused):
        store.create_once(**ours, repeatable=Repeatable("k", "b"))
    claim(store, created[0].id, "claim")
    assert store.create(**ours).status == Status.QUEUED, "a running job is not in the queue"
    assert store.count_unfinished() == {"queued": 3, "running": 1}


def test_many_who_come_at_once_do_not_overfill_the_queue(store):
    start = threading.Barrier(8)
    refused = []

    def post():
        start.wait()
        for _ in range(5):
            try:
                store.create(tenant="", kind="motion", label=None, problem="{}", max_queued=11)
            except QueueFull:
                refused.append(1)

    threads = [threading.Thread(target=post) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (store.count_unfinished()["queued"], len(refused)) == (11, 29)


def test_old_finished_jobs_are_removed(engine, store):
    ids = [store.create(tenant="", kind="motion", label=None, problem="{}").id for _ in range(6)]
    for job_id in ids[:4]:
        store.cancel(job_id)
    claim(store, ids[5], "claim")
    cutoff = datetime.now(UTC)
    time.sleep(0.01)  # ids and times have milliseconds
    late = store.create(tenant="", kind="motion", label=None, problem="{}").id
    store.cancel(late)
    store.cancel(ids[4])  # old, but finished just now
    assert store.delete_finished(cutoff - timedelta(hours=1), 10) == 0
    assert store.delete_finished(cutoff, 3) == 3
    assert store.delete_finished(cutoff, 3) == 1
    assert [job.id for job in store.list_page(tenant="", limit=10)] == [late, ids[5], ids[4]]


def test_a_downgrade_undoes_the_upgrade(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite3'}", durable=False)
    upgrade(engine, "0002")

    def shape():
        with engine.connect() as connection:
            return sorted(connection.exec_driver_sql("SELECT name, sql FROM sqlite_master WHERE sql IS NOT NULL").all())

    before = shape()
    upgrade(engine)
    assert shape() != before
    config = Config()
    config.set_main_option("script_location", str(files("service.jobs") / "migrations"))
    with engine.begin() as connection:
        config.attributes["connection"] = connection
        command.downgrade(config, "0002")
    assert [name for name, _ in shape()] == [name for name, _ in before]
    engine.dispose()


def test_jobs_of_an_older_store_are_kept(tmp_path):
    engine = connect(f"sqlite:///{tmp_path / 'jobs.sqlite3'}", durable=False)
    upgrade(engine, "0001")
    row = {**build_row("", "motion", "old", "{}"), "status": "succeeded"}
    del row["tenant"], row["cost"]  # there were none yet
    with engine.begin() as connection:
        connection.execute(insert(jobs).values(row))
    upgrade(engine)
    assert JobStore(engine).get(row["id"]).label == "old"
    engine.dispose()


def test_upgrading_twice_keeps_the_jobs(engine, store, job):
    upgrade(engine)
    with engine.connect() as connection:
        assert connection.execute(select(jobs.c.id)).scalars().all() == [job.id]


def overdue(engine, *job_ids):
    with engine.begin() as connection:
        connection.execute(update(jobs).where(jobs.c.id.in_(job_ids)).values(due_at=jobs.c.due_at - 3600.0))


def test_tables_of_a_later_version_are_left_alone(tmp_path):
    engine = connect(f"sqlite:///{tmp_path}/later.sqlite3", durable=False)
    upgrade(engine)
    with engine.begin() as connection:
        connection.execute(text("UPDATE alembic_version SET version_num = '9999'"))
    with pytest.raises(LaterTables, match="later version"):
        upgrade(engine)
    with engine.connect() as connection:
        assert connection.execute(text("SELECT version_num FROM alembic_version")).scalar_one() == "9999"
    engine.dispose()


def test_who_does_not_know_whether_it_has_been_given_a_job_may_ask(store, job):
    assert store.find_claim("mine") is None
    taken = store.take("mine", ANY)
    assert store.find_claim("mine") == taken
    assert (taken.job_id, taken.attempt, taken.problem, taken.cost) == (job.id, 1, job.problem, Cost.LONG)
    assert store.find_claim("another's") is None
    assert store.take("another's", ANY) is None
    assert store.complete(job.id, taken.attempt, "{}")
    assert store.find_claim("mine") is None


@pytest.mark.parametrize("name", ["requeue", "give_up", "crashed"])
def test_an_executor_does_nothing_to_an_attempt_of_another(engine, store, leases, job, name):
    claim(store, job.id, "first")
    overdue(engine, job.id)
    assert leases.take_back(leases.find_expired()) == [(job.id, Status.QUEUED)]
    claim(store, job.id, "second")
    before = store.get(job.id)
    late = {
        "requeue": lambda: store.requeue(job.id, "first"),
        "give_up": lambda: store.give_up(job.id, "first", "{}"),
        "crashed": lambda: store.record_crash(job.id, "first", killed=False),
    }
    assert not late[name]()
    assert store.get(job.id) == before


def test_only_abandoned_jobs_are_taken_back(engine, store, leases):
    ids = [store.create(tenant="", kind="motion", label=None, problem="{}").id for _ in range(4)]
    for job_id in ids[:3]:
        claim(store, job_id, f"claim of {job_id[-4:]}")
    assert leases.take_back(leases.find_expired()) == []
    overdue(engine, *ids)
    store.complete(ids[0], 1, "{}")
    assert leases.renew({f"claim of {ids[1][-4:]}": ids[1]}) == set()
    assert leases.take_back(leases.find_expired()) == [(ids[2], Status.QUEUED)]
    assert leases.take_back(leases.find_expired()) == []
    assert [store.get(job_id).status for job_id in ids] == ["succeeded", "running", "queued", "queued"]


def test_a_job_that_takes_its_hosts_with_it_is_given_up_in_the_end(engine, store, leases, job):
    for kill in range(MAX_KILLS):
        claim(store, job.id, f"claim {kill}")
        overdue(engine, job.id)
        assert leases.take_back(leases.find_expired()) == [(job.id, Status.QUEUED)]
    claim(store, job.id, "last")
    overdue(engine, job.id)
    assert leases.take_back(leases.find_expired()) == [(job.id, Status.FAILED)]
    assert "/problems/worker-died" in store.get(job.id).error


def test_kills_are_forgiven_more_often_than_deaths(store, job):
    for n in range(MAX_CRASHES + 3):
        claim(store, job.id, f"claim {n}")
        assert store.record_crash(job.id, f"claim {n}", killed=True) == Status.QUEUED
    claim(store, job.id, "one more")
    assert store.record_crash(job.id, "one more", killed=False) == Status.FAILED


def test_claims_that_are_of_no_use_are_named(store, leases):
    ids = [store.create(tenant="", kind="motion", label=None, problem="{}").id for _ in range(6)]
    waiting, _, cancelled, removed, done, taken = ids
    for job_id in ids[1:]:
        claim(store, job_id, job_id)
    for job_id in (cancelled, removed):
        store.cancel(job_id)
    store.delete(removed)
    store.complete(done, 1, "{}")
    store.requeue(taken, taken)
    claim(store, taken, "another")
    assert leases.renew({job_id: job_id for job_id in ids}) == {waiting, cancelled, removed, taken}
    assert leases.renew({}) == set()


def test_the_clock_of_the_store_is_the_time(engine):
    with engine.connect() as connection:
        assert connection.execute(select(StoreClock())).scalar() == pytest.approx(time.time(), abs=5.0)


def test_hosts_are_there_as_long_as_they_say_so(engine, leases):
    assert leases.count_workers() == 0
    leases.record_host("one", 2)
    leases.record_host("two", 3)
    leases.record_host("one", 1)
    assert leases.count_workers() == 4
    with engine.begin() as connection:
        connection.execute(update(hosts).where(hosts.c.id == "two").values(seen_at=hosts.c.seen_at - 2 * LEASE_S))
    assert leases.count_workers() == 1
    leases.remove_host("one")
    assert leases.count_workers() == 0


def made(store, tenant, cost=Cost.SHORT, count=1):
    ids = [
        store.create(tenant=tenant, kind="motion", label=None, problem="{}", cost=cost, max_queued=1000).id
        for _ in range(count)
    ]
    return ids[0] if count == 1 else ids


def given(store, costs=ANY, count=1):
    return [store.take("mark", costs).job_id for _ in range(count)]


def test_tenants_go_round(store):
    flood = made(store, "flood", count=6)
    two = made(store, "two", count=2)
    assert given(store, count=2) == [flood[0], two[0]]
    one = made(store, "one")  # joins in the present turn, and need not wait for what was there before
    assert given(store, count=6) == [flood[1], two[1], one, *flood[2:5]]
    again = made(store, "one", count=2)
    assert given(store, count=3) == [flood[5], *again]
    assert store.take("mark", ANY) is None


def test_who_comes_late_has_no_turns_in_hand(store):
    """A tenant that was away while others were served is not served alone until it has caught up."""
    busy = made(store, "busy", count=40)
    given(store, count=20)
    late = made(store, "late", count=5)
    assert given(store, count=6) == [busy[20], late[0], busy[21], late[1], busy[22], late[2]]


def test_a_job_that_comes_back_has_its_turn_at_once(store):
    first, *others = made(store, "a", count=3)
    assert given(store) == [first]
    store.requeue(first, "mark")
    newcomer = made(store, "b")
    assert given(store, count=4) == [first, others[0], newcomer, others[1]]


def test_each_cost_has_turns_of_its_own(store):
    long = made(store, "a", Cost.LONG, 3)
    short = made(store, "a", Cost.SHORT, 2)
    other = made(store, "b", Cost.SHORT)
    assert given(store, [Cost.SHORT], 2) == [short[0], other]
    assert given(store, [Cost.LONG, Cost.SHORT]) == [long[0]]
    assert given(store, [Cost.SHORT, Cost.LONG], 2) == [short[1], long[1]]
    assert store.take("mark", [Cost.SHORT]) is None


def test_a_job_that_is_longer_than_expected_waits_its_turn_among_the_long_ones(store):
    mistaken = made(store, "a", count=2)
    long = made(store, "b", Cost.LONG, 2)
    assert given(store, [Cost.SHORT], 2) == mistaken
    assert all(store.requeue_as_long(job_id, "mark") for job_id in mistaken)
    assert not store.requeue_as_long(mistaken[0], "mark")
    assert store.take("mark", [Cost.SHORT]) is None
    assert given(store, count=4) == [mistaken[0], long[0], mistaken[1], long[1]]


def test_the_queue_of_a_tenant_is_full_for_nobody_else(store):
    ours = {"kind": "motion", "label": None, "problem": "{}", "max_queued": 3}
    for _ in range(3):
        store.create(tenant="flood", **ours)
    with pytest.raises(QueueFull):
        store.create(tenant="flood", **ours)
    assert store.create(tenant="other", **ours).status == Status.QUEUED


def test_a_flood_over_many_connections_has_a_job_a_turn(engine, store):
    """Jobs that are stored at once do not share turns, or a tenant with many connections would have more of them."""
    start = threading.Barrier(8)

    def post():
        start.wait()
        made(store, "flood", count=10)

    threads = [threading.Thread(target=post) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    other = made(store, "other", count=30)
    shared = 15  # the first few, which were there at once, may share turns; each of the others has its own
    first = given(store, count=60 + shared)
    assert [job_id for job_id in first if job_id in other] == other
    with engine.connect() as connection:
        turns = connection.execute(select(jobs.c.turn).where(jobs.c.tenant == "flood")).scalars().all()
    assert len(turns) == 80
    assert len(set(turns)) >= 80 - shared
