"""Batches in the store: each sample is there once, whatever dies, comes late or is cancelled in between."""

import threading
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from types import SimpleNamespace

import pytest
from sqlalchemy import select, update
from ulid import ULID

from service.jobs.batches import removal
from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.rows import EndedSample, OwnAnswer, Share
from service.jobs.batches.store import MAX_SHARES, BatchStore, _select_results
from service.jobs.cluster.leases import LeaseStore
from service.jobs.job_store import JobStore
from service.jobs.store.admission import KeyReused, QueueFull, Repeatable
from service.jobs.store.schema import batches, jobs, samples
from service.jobs.store.statements import MAX_CRASHES, MAX_KILLS
from service.jobs.store.states import Cost, Status


@pytest.fixture
def store(emptied):
    return BatchStore(emptied)


@pytest.fixture
def single(engine, store):
    return JobStore(engine)


def made(store, total=3, tenant="", cost=Cost.SHORT, max_queued=1000, repeatable=None):
    plan = Plan({"kind": "motion"}, ["/seed"], [list(range(total))], True, ["size"], True)
    return store.create(
        tenant=tenant, kind="motion", label="many", plan=plan, cost=cost, max_queued=max_queued, repeatable=repeatable
    )[0]


def ended(number, status=Status.SUCCEEDED, digest=None, cached=False):
    return EndedSample(
        number, status, "2026-01-01T00:00:00.000000Z", "2026-01-01T00:00:01.000000Z", cached=cached, digest=digest,
        figures="[1, 2.5]", result=f'{{"of": {number}}}',
    )  # fmt: skip


def take(single, mark):
    return single.take(mark, [Cost.SHORT, Cost.LONG])


def numbers(engine):
    with engine.connect() as connection:
        return list(connection.execute(select(samples.c.number).order_by(samples.c.number)).scalars())


def test_a_batch_is_dealt_into_shares_that_are_no_jobs_of_clients(store, single):
    batch = made(store, 100)
    claims = [take(single, f"m{n}") for n in range(MAX_SHARES + 1)]
    assert claims.pop() is None
    shares = [Share.read(claim.problem) for claim in claims]
    assert {claim.batch for claim in claims} == {batch.id}
    assert [n for share in shares for n in range(share.first, share.end)] == list(range(100))
    assert single.list_page(tenant="", limit=10) == []
    assert single.get(claims[0].job_id) is None
    assert single.load_summaries([claims[0].job_id]) == {}


def test_a_slice_is_stored_whole_and_its_share_goes_on(store, single, engine):
    batch = made(store, 5 * MAX_SHARES)
    claim = take(single, "a")
    share = Share.read(claim.problem)
    assert store.start_batch(batch.id).status is Status.RUNNING
    left = Share(2, share.end)
    assert store.store(batch, claim.job_id, claim.attempt, left, [ended(0), ended(1, Status.FAILED)])
    assert not store.store(batch, claim.job_id, claim.attempt, left, [ended(2)]), "the share is another's now"
    assert numbers(engine) == [0, 1]
    now = store.get(batch.id)
    assert (now.status, now.succeeded, now.failed, now.ended_count) == (Status.RUNNING, 1, 1, 2)
    assert store.find_stored(batch, 0, 5) == {0, 1}
    job = single.get(make_sample_id(batch.id, 0))
    assert (job.status, job.label, job.batch, job.cached) == (Status.SUCCEEDED, "many", batch.id, False)
    assert (job.problem, job.result) == ('{"kind": "motion", "seed": 0}', '{"of": 0}')
    assert single.load_summaries([job.id])[job.id].status is Status.SUCCEEDED


def test_no_sample_is_stored_twice(store, single, engine):
    batch = made(store, 1)
    claim = take(single, "a")
    assert store.store(batch, claim.job_id, claim.attempt, Share(0, 1), [])
    again = take(single, "b")
    assert store.store(batch, again.job_id, again.attempt, None, [ended(0)])
    assert not store.store(batch, claim.job_id, claim.attempt, None, [ended(0)])
    assert numbers(engine) == [0]


def test_batches_and_jobs_of_one_millisecond_have_their_own_samples(store, single, engine, monkeypatch):
    """Ids that are made in one millisecond follow one another."""
    at = datetime.now(UTC).timestamp()
    monkeypatch.setattr("ulid.time", SimpleNamespace(time_ns=lambda: int(at * 1e9), time=lambda: at))
    made_at_once = [made(store, 40, tenant=tenant) for tenant in ("a", "b")]
    job = single.create(tenant="a", kind="motion", label=None, problem="{}", cost=Cost.LONG)
    ids = sorted(int(ULID.from_str(row.id)) for row in (*made_at_once, job))
    assert ids[2] - ids[0] <= 2 * (1 + MAX_SHARES), "or this tests nothing"
    while (claim := single.take("m", [Cost.SHORT])) is not None:
        share = Share.read(claim.problem)
        [batch] = [batch for batch in made_at_once if batch.id == claim.batch]
        assert store.find_stored(batch, share.first, share.end) == set()
        new = [ended(n) for n in range(share.first, share.end)]
        assert store.store(batch, claim.job_id, claim.attempt, None, new)
    for batch in made_at_once:
        rows = store.load_rows(store.get(batch.id))
        assert [row.number for row in rows] == list(range(40))
        assert single.get(make_sample_id(batch.id, 1)).batch == batch.id
    assert single.get(job.id).status is Status.QUEUED
    for gone, left in (made_at_once, made_at_once[::-1]):
        before = len(store.load_rows(left)) if store.get(left.id) else 0
        assert store.delete(gone.id)
        assert len(store.load_rows(left)) == before
    assert numbers(engine) == []


@pytest.mark.parametrize(
    ("statuses", "whole"),
    [("ss", "succeeded"), ("sf", "succeeded"), ("ff", "failed")],
)
def test_a_batch_ends_with_its_last_sample(store, single, statuses, whole):
    batch = made(store, 2)
    for n, status in enumerate(statuses):
        claim = take(single, f"m{n}")
        new = ended(Share.read(claim.problem).first, Status.SUCCEEDED if status == "s" else Status.FAILED)
        assert store.store(batch, claim.job_id, claim.attempt, None, [new])
    now = store.get(batch.id)
    assert (now.status, now.ended_count) == (Status(whole), 2)
    assert now.finished_at is not None
    assert store.start_batch(batch.id) is None


def test_a_sample_that_kills_its_workers_fails_by_itself(store, single, engine):
    batch = made(store, 3 * MAX_SHARES)
    claim = take(single, "a")
    for _ in range(MAX_CRASHES):
        assert store.record_crash(claim.job_id, claim.mark, 1, killed=False) is Status.QUEUED
        claim = again(single, claim.job_id)
        assert Share.read(claim.problem) == Share(0, 3, alone=1), "it comes by itself"
    assert store.record_crash(claim.job_id, claim.mark, 1, killed=False) is Status.QUEUED
    assert numbers(engine) == [1]
    assert single.get(make_sample_id(batch.id, 1)).status is Status.FAILED
    claim = again(single, claim.job_id)
    assert Share.read(claim.problem) == Share(0, 3)
    assert store.record_crash(claim.job_id, "another mark", 0, killed=False) is None


@pytest.mark.parametrize("total", [1, 3, 40])
def test_workers_that_die_before_any_sample_is_begun_fail_one_after_the_other(store, single, engine, total):
    batch = made(store, total)
    most = total * (MAX_CRASHES + 1) + min(total, MAX_SHARES)  # and one of each share with nothing left to do
    deaths = 0
    while (claim := take(single, f"m{deaths}")) is not None and deaths <= most:
        assert store.record_crash(claim.job_id, claim.mark, None, killed=False) is not None
        deaths += 1
    assert numbers(engine) == list(range(total))
    assert (store.get(batch.id).status, deaths) == (Status.FAILED, most)


def test_what_is_stored_already_is_not_blamed(store, single, engine):
    """A share goes on past what was stored of it by itself."""
    batch = made(store, 4 * MAX_SHARES)
    claim = take(single, "a")
    assert Share.read(claim.problem) == Share(0, 4)
    assert store.give_up(claim.job_id, claim.mark, 0, lambda _: "{}") is Status.QUEUED
    for n in range(1, 4):
        claim = again(single, claim.job_id)
        assert store.record_crash(claim.job_id, claim.mark, 0, killed=False) is Status.QUEUED
        claim = again(single, claim.job_id)
        assert Share.read(claim.problem) == Share(0, 4, alone=n)
        assert store.give_up(claim.job_id, claim.mark, None, lambda _: "{}") is not None
    assert numbers(engine) == [0, 1, 2, 3]
    assert store.get(batch.id).failed == 4


def again(single, share_id):
    """The claim of a share whose turn it is somewhen; the others wait again behind it."""
    others = []
    while (claim := take(single, f"again{len(others)}")).job_id != share_id:
        others.append(claim)
    for other in others:
        assert single.requeue(other.job_id, other.mark)
    return claim


def test_kills_from_outside_are_forgiven_more_often(store, single, engine):
    made(store, 1)
    for kill in range(MAX_KILLS):
        claim = take(single, f"m{kill}")
        store.record_crash(claim.job_id, claim.mark, None, killed=True)
        assert numbers(engine) == []
    claim = take(single, "last")
    store.record_crash(claim.job_id, claim.mark, None, killed=True)
    assert numbers(engine) == [0]


def test_a_sample_that_is_given_up_ends_the_batch_where_it_is_the_last(store, single):
    batch = made(store, 1)
    claim = take(single, "a")
    assert store.give_up(claim.job_id, claim.mark, 0, lambda job_id: f'{{"detail": "{job_id}"}}') is Status.QUEUED
    now = store.get(batch.id)
    assert (now.status, now.failed) == (Status.FAILED, 1)
    assert store.load_rows(now)[0].error == f'{{"detail": "{make_sample_id(batch.id, 0)}"}}'


def test_a_cancelled_batch_takes_no_more(store, single, engine):
    batch = made(store, 2)
    claim = take(single, "a")
    assert len(store.cancel(batch.id)) == 2
    assert store.cancel(batch.id) is None
    assert not store.store(batch, claim.job_id, claim.attempt, None, [ended(0)])
    assert store.record_crash(claim.job_id, claim.mark, 0, killed=True) is None
    assert take(single, "b") is None
    assert (store.get(batch.id).status, numbers(engine)) == (Status.CANCELLED, [])


def test_what_a_lost_share_had_to_do_has_failed(store, single, engine):
    """As when hosts vanish with it again and again: the recovery gives it up as it would any job."""
    batch = made(store, 2)
    claim = take(single, "a")
    assert store.store(batch, claim.job_id, claim.attempt, None, [ended(0)])
    lost = take(single, "b")
    with engine.begin() as connection:
        connection.execute(update(jobs).where(jobs.c.id == lost.job_id).values(due_at=0.0, crashes=MAX_KILLS))
    assert LeaseStore(engine).take_back([lost.job_id]) == [(lost.job_id, Status.FAILED)]
    [now] = store.load_summaries([batch.id]).values()
    assert (now.status, now.succeeded, now.failed) == (Status.SUCCEEDED, 1, 1)
    assert now.revision > store.get(batch.id).revision - 1


def test_only_a_finished_batch_is_removed_and_then_with_all_that_it_has(store, single, engine):
    batch = made(store, 1200)
    first = take(single, "a")
    share = Share.read(first.problem)
    store.store(batch, first.job_id, first.attempt, None, [ended(n) for n in range(share.first, share.end)])
    other = made(store, 1)
    assert not store.delete(batch.id)
    store.cancel(batch.id)
    assert store.delete(batch.id)
    assert store.get(batch.id) is None
    assert numbers(engine) == []
    assert store.get(other.id) is not None
    assert take(single, "b").batch == other.id


def test_of_a_batch_whose_removal_breaks_off_nothing_is_seen(store, single, engine, monkeypatch):
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    key = Repeatable("key", "hash")
    batch, other = made(store, 250, repeatable=key), made(store, 2)
    solved(store, single, batch, [ended(n, digest=f"{n}") for n in range(250)])
    solved(store, single, other, [ended(n) for n in range(2)])
    portions = []

    def dies(_seconds):
        portions.append(len(numbers(engine)))
        if len(portions) == 2:
            raise SystemError

    with monkeypatch.context() as dying:
        dying.setattr(removal.time, "sleep", dies)
        with pytest.raises(SystemError):
            store.delete(batch.id)
    assert portions == [250 + 2 - removal.PORTION_SIZE, 250 + 2 - 2 * removal.PORTION_SIZE], (
        "others may write in between"
    )
    left = make_sample_id(batch.id, numbers(engine)[-1])
    assert (store.get(batch.id), store.load_summaries([batch.id]), store.load_plan(batch)) == (None, {}, None)
    assert (single.get(left), single.load_summaries([left])) == (None, {})
    assert [found.id for found in store.list_page(tenant="", limit=9, before=None)] == [other.id]
    assert store.delete_finished(datetime.now(UTC) + timedelta(seconds=1)) == 1, "the other one"
    assert not store.delete(batch.id)
    again = made(store, 2, repeatable=key)
    assert again.id != batch.id
    assert store.tidy() == 0
    assert numbers(engine) == []
    with engine.connect() as connection:
        assert list(connection.execute(select(batches.c.id)).scalars()) == [again.id]
        assert set(connection.execute(select(jobs.c.batch)).scalars()) == {again.id}


def test_nobody_waits_for_the_removal_of_a_very_large_batch(store, single, engine, monkeypatch):
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    monkeypatch.setattr("service.jobs.batches.store.CLEAR_TIMEOUT_S", -1.0)
    batch = made(store, 250)
    solved(store, single, batch, [ended(n) for n in range(250)])
    assert store.delete(batch.id)
    assert (store.get(batch.id), len(numbers(engine))) == (None, 250 - removal.PORTION_SIZE)
    assert store.tidy() == 0
    assert numbers(engine) == []


def test_what_was_lost_is_ended_without_being_looked_at(store, single, engine):
    lost, waiting, whole = (made(store, 1, tenant=tenant) for tenant in "abc")
    claims = {claim.batch: claim for claim in [take(single, f"m{n}") for n in range(3)]}
    change = update(jobs).where(jobs.c.id == claims[lost.id].job_id)
    with engine.begin() as connection:
        connection.execute(change.values(due_at=0.0, crashes=MAX_KILLS))
    assert [move[1] for move in LeaseStore(engine).take_back([claims[lost.id].job_id])] == [Status.FAILED]
    assert single.requeue(claims[waiting.id].job_id, claims[waiting.id].mark)
    assert store.store(whole, claims[whole.id].job_id, claims[whole.id].attempt, None, [ended(0)])
    assert store.tidy() == 1
    assert store.tidy() == 0
    with engine.connect() as connection:
        told = connection.execute(select(batches.c.status).order_by(batches.c.tenant)).scalars()
        assert list(told) == ["failed", "queued", "succeeded"]


def test_old_batches_are_removed(store, single):
    old, young = made(store, 1), made(store, 1)
    store.cancel(old.id)
    assert store.delete_finished(datetime.now(UTC) - timedelta(days=1)) == 0
    later = datetime.now(UTC) + timedelta(seconds=1)
    assert store.delete_finished(later) == 1
    assert store.delete_finished(later) == 0
    assert (store.get(old.id), store.get(young.id).id) == (None, young.id)


def test_a_request_with_a_key_makes_one_batch(store):
    key = Repeatable("key", "hash")
    first = made(store, 2, repeatable=key)
    assert made(store, 2, repeatable=key).id == first.id
    assert made(store, 2, tenant="other", repeatable=key).id != first.id
    with pytest.raises(KeyReused):
        made(store, 2, repeatable=Repeatable("key", "another"))


def test_a_full_queue_takes_no_batch(store, single):
    single.create(tenant="", kind="motion", label=None, problem="{}")
    for most in (1, 2):
        with pytest.raises(QueueFull):
            made(store, 2, max_queued=most)
    assert store.list_page(tenant="", limit=9, before=None) == []
    assert made(store, 2, max_queued=3) is not None
    assert made(store, 100, tenant="other", max_queued=MAX_SHARES) is not None


def test_in_a_small_queue_a_batch_has_few_shares(store, single, engine):
    batch = made(store, 100, max_queued=3)
    shares = [Share.read(take(single, f"m{n}").problem) for n in range(3)]
    assert take(single, "none") is None
    assert [n for share in shares for n in range(share.first, share.end)] == list(range(batch.total))


def test_of_batches_that_come_at_once_the_queue_takes_as_many_as_it_has_room_for(store, single, engine):
    answers, begin = [], threading.Barrier(6)

    def post():
        begin.wait()
        try:
            answers.append(made(store, 100, max_queued=2 * MAX_SHARES + 1))
        except QueueFull as full:
            answers.append(full)

    threads = [threading.Thread(target=post) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(isinstance(answer, QueueFull) for answer in answers) == [False] * 2 + [True] * 4
    with engine.connect() as connection:
        turns = list(connection.execute(select(jobs.c.turn).order_by(jobs.c.turn)).scalars())
    assert turns == list(range(1, 2 * MAX_SHARES + 1)), "each has a turn of its own"


def test_the_same_request_that_comes_at_once_has_one_batch(store, engine):
    answers, begin = [], threading.Barrier(6)

    def post():
        begin.wait()
        answers.append(made(store, 4, repeatable=Repeatable("key", "hash"), max_queued=4).id)

    threads = [threading.Thread(target=post) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 6
    assert len(set(answers)) == 1


def test_single_jobs_do_not_wait_for_the_shares_of_their_tenant(store, single):
    made(store, 100, tenant="a")
    mine = single.create(tenant="a", kind="motion", label=None, problem="{}", cost=Cost.SHORT)
    theirs = single.create(tenant="b", kind="motion", label=None, problem="{}", cost=Cost.SHORT)
    first = [take(single, f"m{n}").job_id for n in range(3)]
    assert {mine.id, theirs.id} <= set(first)


def test_batches_of_tenants_go_round(store, single):
    tenants = {made(store, 100, tenant=tenant).id: tenant for tenant in ("a", "b")}
    taken = [tenants[take(single, f"m{n}").batch] for n in range(8)]
    assert [{*taken[n : n + 2]} for n in range(0, 8, 2)] == [{"a", "b"}] * 4


def test_a_slice_waits_its_turn_again(store, single):
    batch = made(store, 2, tenant="a")
    claim = take(single, "m")
    store.store(batch, claim.job_id, claim.attempt, Share(0, 1), [])
    other = made(store, 1, tenant="b")
    assert {take(single, f"n{n}").batch for n in range(2)} == {batch.id, other.id}


def put_back(how, store, single, engine, claim):
    """A share, or job, whose worker did not come to its end."""
    if how == "lease":
        with engine.begin() as connection:
            connection.execute(update(jobs).where(jobs.c.id == claim.job_id).values(due_at=0.0))
        assert LeaseStore(engine).take_back([claim.job_id]) == [(claim.job_id, Status.QUEUED)]
    elif how == "restart":
        single.requeue_unfinished()
    elif how == "stop":
        assert single.requeue(claim.job_id, claim.mark)
    elif how == "crash":
        assert store.record_crash(claim.job_id, claim.mark, None, killed=False) is Status.QUEUED
    else:
        assert store.give_up(claim.job_id, claim.mark, None, lambda _: "{}") is Status.QUEUED


@pytest.mark.parametrize("how", ["crash", "give up", "lease", "stop", "restart"])
def test_a_batch_whose_samples_take_their_workers_along_holds_nobody_up(store, single, engine, how):
    made(store, 100, tenant="a")
    theirs = {single.create(tenant="b", kind="motion", label=None, problem="{}", cost=Cost.SHORT).id for _ in range(4)}
    for n in range(9):
        claim = take(single, f"m{n}")
        theirs.discard(claim.job_id)
        if claim.batch is not None:
            put_back(how, store, single, engine, claim)
        else:
            assert single.complete(claim.job_id, claim.attempt, "{}")
    assert theirs == set()


def test_a_batch_that_takes_longer_than_expected_goes_round_among_the_long(store, single):
    made(store, 100, tenant="a")
    mine = single.create(tenant="a", kind="motion", label=None, problem="{}", cost=Cost.LONG).id
    while (claim := single.take("m", [Cost.SHORT])) is not None:
        assert single.requeue_as_long(claim.job_id, claim.mark)
    theirs = {single.create(tenant="b", kind="motion", label=None, problem="{}", cost=Cost.LONG).id for _ in range(4)}
    taken = [single.take(f"n{n}", [Cost.LONG]) for n in range(10)]
    assert {mine, *theirs} <= {claim.job_id for claim in taken}


def solved(store, single, batch, new):
    """Store these samples of a batch of one share, and end it."""
    claim = take(single, "m")
    assert claim.batch == batch.id
    assert store.store(batch, claim.job_id, claim.attempt, None, new)


def test_answers_are_found_by_digest_and_are_ones_own(store, single, monkeypatch):
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    for digest, result in (("one", "{1}"), ("none", None), ("two", "{2}")):
        job = single.create(tenant="a", kind="motion", label=None, problem="{}", cost=Cost.SHORT)
        claim = take(single, "m")
        if result is None:
            single.fail(job.id, claim.attempt, "{}")
        else:
            single.complete(job.id, claim.attempt, result, digest)
    earlier = made(store, 3, tenant="a")
    solved(store, single, earlier, [ended(0, digest="three"), failed(1), ended(2, digest="four")])
    now = made(store, 9, tenant="a")
    solved(store, single, now, [ended(7, digest="four"), same(8, 7)])
    wanted = ["one", "two", "three", "four", "five", "none"]
    results = {"one": "{1}", "two": "{2}", "three": '{"of": 0}'}
    assert store.find_answers(now, wanted) == results | {"four": OwnAnswer(7, "[1, 2.5]")}
    assert store.find_answers(earlier, ["three", "one"]) == {"one": "{1}", "three": OwnAnswer(0, "[1, 2.5]")}
    assert store.find_answers(made(store, 1, tenant="b"), wanted) == {}
    assert store.find_answers(now, []) == {}


def failed(number):
    return EndedSample(number, Status.FAILED, "2026-01-01T00:00:00.000000Z", "2026-01-01T00:00:01.000000Z", error="{}")


def same(number, other):
    """A sample that is the same as another of its batch."""
    return replace(ended(number, cached=True), same_as=other, result=None)


def test_of_many_equal_answers_one_is_read(store, single, engine, monkeypatch):
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    for _ in range(2):
        many = made(store, 40, tenant="a")
        solved(store, single, many, [ended(n, digest="ab"[n % 2]) for n in range(40)])
    with engine.connect() as connection:
        rows = connection.execute(_select_results("a", ["a", "b", "c"])).all()
    assert [(digest, result is None) for digest, result in rows] == [("a", False), ("b", False), ("c", True)]
    found = store.find_answers(made(store, 1, tenant="a"), ["a", "b"])
    assert [int(found[digest][7:-1]) % 2 for digest in ("a", "b")] == [0, 1]


def test_what_is_the_same_as_another_has_its_answer(store, single, monkeypatch):
    monkeypatch.setattr("service.jobs.batches.store.MAX_SHARES", 1)
    batch, other = made(store, 3), made(store, 2)
    solved(store, single, batch, [ended(1, digest="one"), same(0, 1), failed(2)])
    solved(store, single, other, [replace(ended(1), result="{3}"), same(0, 1)])
    read = [single.get(make_sample_id(batch.id, n)) for n in range(3)]
    assert [(job.result, job.error, job.cached) for job in read] == [
        ('{"of": 1}', None, True), ('{"of": 1}', None, False), (None, "{}", False),
    ]  # fmt: skip
    assert single.get(make_sample_id(other.id, 0)).result == "{3}"
    assert [row.figures for row in store.load_rows(batch)] == [[1, 2.5], [1, 2.5], None]
    assert store.get(batch.id).cached == 1


def test_pages_of_batches(store):
    ids = [made(store, 1).id for _ in range(3)]
    made(store, 1, tenant="other")
    assert [batch.id for batch in store.list_page(tenant="", limit=2, before=None)] == ids[:0:-1]
    assert [batch.id for batch in store.list_page(tenant="", limit=2, before=ids[1])] == ids[:1]
