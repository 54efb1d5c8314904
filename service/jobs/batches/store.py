"""The batches in the store, their shares among the jobs, and the samples that have ended.

A slice comes into the store in one transaction: its samples, what is left of its share, which goes back into the queue,
and the counts of the batch. The transaction holds only where the share is still that of the attempt, so that whatever
dies or comes late, each sample is there once.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import asdict, fields
from datetime import datetime
from itertools import pairwise
from typing import Any

from sqlalchemy import (
    Connection,
    Engine,
    Select,
    String,
    case,
    column,
    exists,
    func,
    insert,
    select,
    update,
    values,
)
from ulid import ULID

from service.jobs.batches import removal
from service.jobs.batches.plan import Plan
from service.jobs.batches.reading import sample_id
from service.jobs.batches.rows import BatchRow, BatchSummary, Ended, OwnAnswer, Share, TableRow
from service.jobs.faults import WORKER_DIED
from service.jobs.store.admission import Repeatable, made_by, once, one_after_the_other, surely
from service.jobs.store.schema import as_stored, as_values, batches, jobs, now, samples
from service.jobs.store.statements import (
    BACK_IN_QUEUE,
    COUNT_QUEUED,
    MAX_CRASHES,
    MAX_IDS,
    MAX_KILLS,
    NO_KEY,
    moved,
    new_row,
    turn_of,
)
from service.jobs.store.states import FINISHED, UNFINISHED, Cost, Status

SHARES = 16
"""Shares of a batch at most: more workers than this do not make it faster."""

CLEARED_S = 2.0
"""How long whoever removes a batch waits for that, seconds; nobody sees it from the beginning."""

_LOST = (
    batches.c.status.in_(UNFINISHED),
    ~exists().where(jobs.c.batch == batches.c.id, jobs.c.status.in_(UNFINISHED)),
)
"""Batches of whose shares none is left, and that are not at their end."""

_SUMMARY = [batches.c[field.name] for field in fields(BatchSummary)]
_WHOLE = [batches.c[field.name] for field in fields(BatchRow)]


class BatchStore:
    """Reads and changes the rows. Safe to use from many threads and processes."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def create(
        self,
        *,
        tenant: str,
        kind: str,
        label: str | None,
        plan: Plan,
        cost: Cost,
        max_queued: int,
        repeatable: Repeatable | None,
    ) -> tuple[BatchRow, list[str]]:
        """Store a new batch with its shares, or find the one that the same request has made already.

        Returns
        -------
        tuple
            The batch, and the ids of its shares where it is new.

        Raises
        ------
        KeyReused
            When another request of the tenant has made a batch under this key.
        QueueFull
            When it would be new, and with its shares more than ``max_queued`` jobs of the tenant were queued. It has
            no more shares than that.
        """
        row: dict[str, Any] = {
            "id": str(ULID()),
            "tenant": tenant,
            "kind": kind,
            "label": label,
            "status": Status.QUEUED,
            "created_at": now(),
            "started_at": None,
            "finished_at": None,
            "total": plan.total,
            "succeeded": 0,
            "failed": 0,
            "cached": 0,
            "revision": 1,
            "stated": plan.stated_as_json(),
        }
        key = {} if repeatable is None else {"idempotency_key": repeatable.key, "request_hash": repeatable.request_hash}
        shares = [
            {**new_row(tenant, kind, None, share.written(), cost), **NO_KEY, "batch": row["id"]}
            for share in _dealt(plan.total, min(SHARES, max_queued))
        ]

        def inserted(connection: Connection) -> bool:
            # Counted when nobody else inserts any more: in SQLite, whoever has written is alone.
            one_after_the_other(connection, tenant)
            connection.execute(
                insert(batches), {**row, "removed": False, "plan": plan.values_as_json(), **NO_KEY, **key}
            )
            queued = connection.execute(COUNT_QUEUED, {"of": tenant, "most": max_queued}).scalar_one()
            if queued + len(shares) > max_queued:
                return False
            turn = select(turn_of(tenant, cost, share=True))
            first = connection.execute(turn).scalar_one()
            connection.execute(insert(jobs), [{**share, "turn": first + n} for n, share in enumerate(shares)])
            return True

        def make() -> BatchRow:
            surely(self._engine, lambda connection: _row(connection, row["id"]) is not None, inserted)
            return BatchRow(**row)

        if repeatable is None:
            return make(), [share["id"] for share in shares]
        batch, new = once(make, lambda: self._made_by(tenant, repeatable))
        return batch, [share["id"] for share in shares] if new else []

    def _made_by(self, tenant: str, repeatable: Repeatable) -> BatchRow | None:
        row = made_by(self._engine, batches, _WHOLE, tenant, repeatable)
        return None if row is None else BatchRow(*as_values(row))

    def get(self, batch_id: str) -> BatchRow | None:
        """The batch, or None where there is none."""
        self._settle([batch_id])
        with self._engine.connect() as connection:
            row = _row(connection, batch_id)
        return None if row is None else BatchRow(*as_values(row))

    def summaries(self, batch_ids: Sequence[str]) -> dict[str, BatchSummary]:
        """The batches of these ids that there are, by id."""
        self._settle(batch_ids)
        found: dict[str, BatchSummary] = {}
        with self._engine.connect() as connection:
            for start in range(0, len(batch_ids), MAX_IDS):
                query = select(*_SUMMARY).where(batches.c.id.in_(batch_ids[start : start + MAX_IDS]), removal.THERE)
                for row in connection.execute(query):
                    found[row.id] = BatchSummary(*as_values(row))
        return found

    def page(self, *, tenant: str, limit: int, before: str | None) -> list[BatchSummary]:
        """At most ``limit`` batches of a tenant, newest first, from those older than the batch ``before``."""
        query = select(batches.c.id).where(batches.c.tenant == tenant, removal.THERE)
        if before is not None:
            query = query.where(batches.c.id < before)
        with self._engine.connect() as connection:
            ids = list(connection.execute(query.order_by(batches.c.id.desc()).limit(limit)).scalars())
        found = self.summaries(ids)
        return [found[batch_id] for batch_id in ids if batch_id in found]

    def table(self, batch: BatchSummary) -> list[TableRow]:
        """The samples that have ended, in their order."""
        query = select(
            samples.c.number, samples.c.status, samples.c.cached, samples.c.figures, samples.c.error
        ).where(samples.c.batch == batch.id).order_by(samples.c.number)  # fmt: skip
        with self._engine.connect() as connection:
            return [
                TableRow(row.number, Status(row.status), row.cached, json.loads(row.figures or "null"), row.error)
                for row in connection.execute(query)
            ]

    def plan(self, batch: BatchRow) -> Plan | None:
        """The plan of a batch; None where it has been removed since."""
        values = self.values(batch)
        return None if values is None else Plan.read(batch.stated, values)

    def values(self, batch: BatchRow) -> str | None:
        """What the plan of a batch has beside what was stated, as it is written; None where it has been removed."""
        query = select(batches.c.plan).where(batches.c.id == batch.id, removal.THERE)
        with self._engine.connect() as connection:
            values: str | None = connection.execute(query).scalar_one_or_none()
        return values

    def begun(self, batch_id: str) -> BatchRow | None:
        """Note that a worker is at the batch; the batch, or None where it is not to be worked at any more."""
        change = update(batches).where(batches.c.id == batch_id, batches.c.status == Status.QUEUED)
        with self._engine.begin() as connection:
            connection.execute(change.values(status=Status.RUNNING, started_at=now(), revision=batches.c.revision + 1))
            row = _row(connection, batch_id)
        return None if row is None or row.status not in UNFINISHED else BatchRow(*as_values(row))

    def ended(self, batch: BatchSummary, first: int, end: int) -> set[int]:
        """Which of the samples from ``first`` to before ``end`` are stored."""
        with self._engine.connect() as connection:
            return _ended(connection, batch.id, first, end)

    def answers(self, batch: BatchSummary, digests: Collection[str]) -> dict[str, str | OwnAnswer]:
        """What the tenant has of problems of these digests: an answer of the batch's own, or a result in JSON.

        What is asked for is found at once, however many have the same digest: of the tenant's one is taken, and of a
        batch there are not many, since those that are the same as another of it have none.
        """
        if not digests:
            return {}
        own = select(samples.c.digest, samples.c.number, samples.c.figures).where(
            samples.c.tenant == batch.tenant, samples.c.batch == batch.id, samples.c.digest.in_(digests)
        )
        found: dict[str, str | OwnAnswer] = {}
        with self._engine.connect() as connection:
            for row in connection.execute(own):
                found[row.digest] = OwnAnswer(row.number, row.figures)
            left = [digest for digest in digests if digest not in found]
            if left:
                query = _one_result_each(batch.tenant, left)
                found |= {row.digest: row.result for row in connection.execute(query) if row.result is not None}
        return found

    def store(
        self, batch: BatchSummary | None, share_id: str, attempt: int, left: Share | None, new: Sequence[Ended]
    ) -> bool:
        """Store a slice; what is left of its share goes back into the queue. False where the attempt counts no more."""
        change = _done(share_id) if left is None else _back(share_id, left, crashes=0)
        with self._engine.begin() as connection:
            if connection.execute(change.where(jobs.c.attempt == attempt)).rowcount == 0:
                return False
            if batch is not None and new and not _stored(connection, batch, new):
                connection.rollback()
                return False
        return True

    def crashed(self, share_id: str, claim: str, number: int | None, *, killed: bool) -> Status | None:
        """Note that the worker of a share died, by itself or ``killed`` from outside, at a sample, where that is known.

        The share goes on with that sample by itself; after as many deaths as a job may cause, the sample has failed.

        Returns
        -------
        Status or None
            ``queued``; ``succeeded`` where nothing of the share is left to do; or None where it is that of another
            attempt, or cancelled; nothing changed.
        """
        return self._given_back(share_id, claim, number, MAX_KILLS if killed else MAX_CRASHES, WORKER_DIED.as_json)

    def give_up(self, share_id: str, claim: str, number: int | None, error: Callable[[str], str]) -> Status | None:
        """Fail a sample from outside; its share goes on with the others. ``error`` gives the JSON for the job's id."""
        return self._given_back(share_id, claim, number, 0, error)

    def _given_back(
        self, share_id: str, claim: str, number: int | None, retries: int, error: Callable[[str], str]
    ) -> Status | None:
        held = select(jobs.c.batch, jobs.c.problem, jobs.c.crashes).where(
            jobs.c.id == share_id, jobs.c.claim == claim, jobs.c.status == Status.RUNNING
        )
        with self._engine.begin() as connection:
            row = connection.execute(held.with_for_update()).one_or_none()
            if row is None:
                return None
            left = Share.read(row.problem)
            at = _to_blame(connection, row.batch, left, number)
            over = row.crashes >= retries
            share = Share(left.first, left.end, None if over else at)
            change = _done(share_id) if at is None else _back(share_id, share, crashes=0 if over else row.crashes + 1)
            if connection.execute(change.where(jobs.c.claim == claim)).rowcount == 0:
                return None
            if at is None:
                return Status.SUCCEEDED
            if over:
                found = _row(connection, row.batch)
                failed = Ended(at, Status.FAILED, now(), now(), error=error(sample_id(row.batch, at)))
                if found is None or not _stored(connection, BatchRow(*as_values(found)), [failed]):
                    connection.rollback()
                    return None
        return Status.QUEUED

    def cancel(self, batch_id: str) -> list[str] | None:
        """Cancel an unfinished batch: the ids of its shares that were not at their end; None where there is no such."""
        shares = select(jobs.c.id).where(jobs.c.batch == batch_id, jobs.c.status.in_(UNFINISHED))
        with self._engine.begin() as connection:
            # The shares before the batch, in the order in which slices are stored.
            running = list(connection.execute(shares.order_by(jobs.c.id).with_for_update()).scalars())
            for share_id in running:
                connection.execute(moved("cancel", share_id, progress_message="cancelled", finished_at=now()))
            change = update(batches).where(batches.c.id == batch_id, batches.c.status.in_(UNFINISHED))
            cancelled = connection.execute(
                change.values(status=Status.CANCELLED, finished_at=now(), revision=batches.c.revision + 1)
            )
            return running if cancelled.rowcount else None

    def delete(self, batch_id: str) -> bool:
        """Remove a finished batch with all that it has; whether there was one.

        Of a very large one what takes longer than :data:`CLEARED_S` is left to :meth:`tidy`.
        """
        if not removal.mark(self._engine, batch_id):
            return False
        removal.clear(self._engine, batch_id, CLEARED_S)
        return True

    def tidy(self) -> int:
        """End the batches that were lost, and remove what is left of those whose removal broke off.

        Returns
        -------
        int
            How many were lost: none of their shares is left, and what these had still to do was given up.
        """
        with self._engine.connect() as connection:
            lost = list(connection.execute(select(batches.c.id).where(*_LOST)).scalars())
        self._settle(lost)
        for batch_id in removal.marked(self._engine):
            removal.clear(self._engine, batch_id)
        return len(lost)

    def delete_finished(self, before: datetime) -> int:
        """Remove the oldest batch that finished before a time; tells how many."""
        oldest = (
            select(batches.c.id)
            .where(
                batches.c.id < str(ULID.from_datetime(before)),
                batches.c.status.in_(FINISHED),
                batches.c.finished_at < as_stored(before),
                removal.THERE,
            )
            .order_by(batches.c.id)
            .limit(1)
        )
        with self._engine.connect() as connection:
            batch_id = connection.execute(oldest).scalar_one_or_none()
        return 0 if batch_id is None else int(self.delete(batch_id))

    def _settle(self, batch_ids: Iterable[str]) -> None:
        """End batches of whose shares none is left: what these had still to do was given up, and has failed."""
        ids = list(batch_ids)
        for start in range(0, len(ids), MAX_IDS):
            these = batches.c.id.in_(ids[start : start + MAX_IDS])
            with self._engine.connect() as connection:
                if connection.execute(select(batches.c.id).where(these, *_LOST)).first() is None:
                    continue
            change = update(batches).where(these, *_LOST).values(
                status=case((batches.c.succeeded > 0, Status.SUCCEEDED), else_=Status.FAILED),
                failed=batches.c.total - batches.c.succeeded,
                finished_at=now(),
                revision=batches.c.revision + 1,
            )  # fmt: skip
            with self._engine.begin() as connection:
                connection.execute(change)


def _dealt(total: int, most: int) -> list[Share]:
    """The shares of a batch, so many at most: as even as can be."""
    count = min(total, most)
    bounds = [total * n // count for n in range(count + 1)]
    return [Share(first, end) for first, end in pairwise(bounds)]


def _to_blame(connection: Connection, batch_id: str, left: Share, number: int | None) -> int | None:
    """The sample at which a worker is taken to have died: the one that it was at, else the one that it had to begin.

    None where all of the share are stored.
    """
    stored = _ended(connection, batch_id, left.first, left.end)
    supposed = (n for n in (number, left.alone) if n is not None)
    return next((n for n in (*supposed, *range(left.first, left.end)) if n not in stored), None)


def _done(share_id: str) -> Any:
    return moved("succeed", share_id, finished_at=now(), progress_fraction=1.0, progress_message="succeeded")


def _back(share_id: str, left: Share, **values: Any) -> Any:
    return moved("requeue", share_id, **{**BACK_IN_QUEUE, "problem": left.written(), **values})


def _stored(connection: Connection, batch: BatchSummary, new: Sequence[Ended]) -> bool:
    """Store ended samples and count them; False, and to be rolled back, where the batch is finished."""
    succeeded = sum(sample.status == Status.SUCCEEDED for sample in new)
    failed, cached = len(new) - succeeded, sum(sample.cached for sample in new)
    done = batches.c.succeeded + batches.c.failed + len(new)
    any_succeeded = batches.c.succeeded + succeeded > 0
    change = update(batches).where(batches.c.id == batch.id, batches.c.status.in_(UNFINISHED)).values(
        succeeded=batches.c.succeeded + succeeded,
        failed=batches.c.failed + failed,
        cached=batches.c.cached + cached,
        revision=batches.c.revision + 1,
        status=case(
            (done < batches.c.total, Status.RUNNING), (any_succeeded, Status.SUCCEEDED), else_=Status.FAILED
        ),
        finished_at=case((done < batches.c.total, batches.c.finished_at), else_=now()),
    )  # fmt: skip
    if connection.execute(change).rowcount == 0:
        return False
    of = {"batch": batch.id, "tenant": batch.tenant}
    connection.execute(
        insert(samples), [{**of, **asdict(sample), "id": sample_id(batch.id, sample.number)} for sample in new]
    )
    return True


def _one_result_each(tenant: str, digests: Collection[str]) -> Select[Any]:
    """The digests, each with one result that the tenant has by it, or with None."""
    wanted = values(column("digest", String), name="wanted").data([(digest,) for digest in digests]).cte("wanted")
    results = [
        select(table.c.result)
        .where(table.c.tenant == tenant, table.c.digest == wanted.c.digest)
        .limit(1)
        .scalar_subquery()
        for table in (samples, jobs)
    ]
    return select(wanted.c.digest, func.coalesce(*results).label("result"))


def _of(batch_id: str, first: int, end: int) -> Sequence[Any]:
    """The samples of a batch from ``first`` to before ``end``."""
    return samples.c.batch == batch_id, samples.c.number >= first, samples.c.number < end


def _ended(connection: Connection, batch_id: str, first: int, end: int) -> set[int]:
    return set(connection.execute(select(samples.c.number).where(*_of(batch_id, first, end))).scalars())


def _row(connection: Connection, batch_id: str) -> Any:
    return connection.execute(select(*_WHOLE).where(batches.c.id == batch_id, removal.THERE)).one_or_none()
