"""The batches in the store, their shares in the job table, and the samples that have ended.

A slice is stored in one transaction: its samples, the rest of its share, which goes back into the queue, and the counts
of the batch. The transaction succeeds only if the share still belongs to the attempt. So each sample is stored exactly
once, even if a process dies or writes late.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import asdict, fields
from datetime import datetime
from itertools import pairwise
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    Select,
    String,
    Update,
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
from service.jobs.batches.reading import make_sample_id
from service.jobs.batches.rows import BatchRow, BatchSummary, EndedSample, OwnAnswer, Share, TableRow
from service.jobs.faults import WORKER_DIED
from service.jobs.store.admission import Repeatable, find_earlier, insert_confirmed, make_once, serialize_inserts
from service.jobs.store.schema import AnyRow, as_stored, as_values, batches, format_now, jobs, samples
from service.jobs.store.statements import (
    COUNT_QUEUED,
    MAX_CRASHES,
    MAX_IDS,
    MAX_KILLS,
    NO_KEY,
    REQUEUED_VALUES,
    build_move,
    build_row,
    build_turn,
)
from service.jobs.store.states import FINISHED_STATES, UNFINISHED_STATES, Cost, Status

MAX_SHARES = 16
"""Maximum number of shares of a batch; workers beyond this number do not make it faster."""

CLEAR_TIMEOUT_S = 2.0
"""Time that a request to remove a batch spends on deleting it, seconds; readers do not see the batch from the start."""

_LOST_CONDITIONS = (
    batches.c.status.in_(UNFINISHED_STATES),
    ~exists().where(jobs.c.batch == batches.c.id, jobs.c.status.in_(UNFINISHED_STATES)),
)
"""Conditions for lost batches: not finished, but without an unfinished share."""

_SUMMARY_COLUMNS = [batches.c[field.name] for field in fields(BatchSummary)]
_ROW_COLUMNS = [batches.c[field.name] for field in fields(BatchRow)]


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
        """Store a new batch with its shares, or find the batch that the same request created before.

        Returns
        -------
        tuple
            The batch, and the ids of its shares; no ids if the batch is not new.

        Raises
        ------
        KeyReused
            If a different request of the tenant has created a batch with this key.
        QueueFull
            If the batch is new and its shares would raise the tenant's queued jobs above ``max_queued``. A batch has
            at most ``max_queued`` shares.
        """
        row: dict[str, Any] = {
            "id": str(ULID()),
            "tenant": tenant,
            "kind": kind,
            "label": label,
            "status": Status.QUEUED,
            "created_at": format_now(),
            "started_at": None,
            "finished_at": None,
            "total": plan.total,
            "succeeded": 0,
            "failed": 0,
            "cached": 0,
            "revision": 1,
            "stated": plan.dump_statement(),
        }
        key = {} if repeatable is None else {"idempotency_key": repeatable.key, "request_hash": repeatable.request_hash}
        shares = [
            {**build_row(tenant, kind, None, share.dump(), cost), **NO_KEY, "batch": row["id"]}
            for share in _split_shares(plan.total, min(MAX_SHARES, max_queued))
        ]

        def insert_batch(connection: Connection) -> bool:
            # Count only while no other process can insert: in SQLite the first write already takes the only lock.
            serialize_inserts(connection, tenant)
            connection.execute(insert(batches), {**row, "removed": False, "plan": plan.dump_values(), **NO_KEY, **key})
            queued = connection.execute(COUNT_QUEUED, {"of": tenant, "most": max_queued}).scalar_one()
            if queued + len(shares) > max_queued:
                return False
            turn = select(build_turn(tenant, cost, share=True))
            first = connection.execute(turn).scalar_one()
            connection.execute(insert(jobs), [{**share, "turn": first + n} for n, share in enumerate(shares)])
            return True

        def make() -> BatchRow:
            insert_confirmed(
                self._engine, lambda connection: _load_row(connection, row["id"]) is not None, insert_batch
            )
            return BatchRow(**row)

        if repeatable is None:
            return make(), [share["id"] for share in shares]
        batch, new = make_once(make, lambda: self._find_earlier(tenant, repeatable))
        return batch, [share["id"] for share in shares] if new else []

    def _find_earlier(self, tenant: str, repeatable: Repeatable) -> BatchRow | None:
        row = find_earlier(self._engine, batches, _ROW_COLUMNS, tenant, repeatable)
        return None if row is None else BatchRow(*as_values(row))

    def get(self, batch_id: str) -> BatchRow | None:
        """Return the batch, or None if it does not exist."""
        self._settle([batch_id])
        with self._engine.connect() as connection:
            row = _load_row(connection, batch_id)
        return None if row is None else BatchRow(*as_values(row))

    def load_summaries(self, batch_ids: Sequence[str]) -> dict[str, BatchSummary]:
        """Return the existing batches among these ids, by id."""
        self._settle(batch_ids)
        found: dict[str, BatchSummary] = {}
        with self._engine.connect() as connection:
            for start in range(0, len(batch_ids), MAX_IDS):
                query = select(*_SUMMARY_COLUMNS).where(
                    batches.c.id.in_(batch_ids[start : start + MAX_IDS]), removal.NOT_REMOVED
                )
                for row in connection.execute(query):
                    found[row.id] = BatchSummary(*as_values(row))
        return found

    def list_page(self, *, tenant: str, limit: int, before: str | None) -> list[BatchSummary]:
        """Return at most ``limit`` batches of a tenant older than the batch ``before``, newest first."""
        query = select(batches.c.id).where(batches.c.tenant == tenant, removal.NOT_REMOVED)
        if before is not None:
            query = query.where(batches.c.id < before)
        with self._engine.connect() as connection:
            ids = list(connection.execute(query.order_by(batches.c.id.desc()).limit(limit)).scalars())
        found = self.load_summaries(ids)
        return [found[batch_id] for batch_id in ids if batch_id in found]

    def load_rows(self, batch: BatchSummary) -> list[TableRow]:
        """Return the rows of the samples that have ended, by number."""
        query = select(
            samples.c.number, samples.c.status, samples.c.cached, samples.c.figures, samples.c.error
        ).where(samples.c.batch == batch.id).order_by(samples.c.number)  # fmt: skip
        with self._engine.connect() as connection:
            return [
                TableRow(row.number, Status(row.status), row.cached, json.loads(row.figures or "null"), row.error)
                for row in connection.execute(query)
            ]

    def load_plan(self, batch: BatchRow) -> Plan | None:
        """Return the plan of a batch; None if the batch has been removed."""
        values = self.load_values(batch)
        return None if values is None else Plan.read(batch.stated, values)

    def load_values(self, batch: BatchRow) -> str | None:
        """Return the stored values of a batch's plan as JSON; None if the batch has been removed."""
        query = select(batches.c.plan).where(batches.c.id == batch.id, removal.NOT_REMOVED)
        with self._engine.connect() as connection:
            values: str | None = connection.execute(query).scalar_one_or_none()
        return values

    def start_batch(self, batch_id: str) -> BatchRow | None:
        """Mark a queued batch as running and return it; None if it has ended."""
        change = update(batches).where(batches.c.id == batch_id, batches.c.status == Status.QUEUED)
        with self._engine.begin() as connection:
            connection.execute(
                change.values(status=Status.RUNNING, started_at=format_now(), revision=batches.c.revision + 1)
            )
            row = _load_row(connection, batch_id)
        return None if row is None or row.status not in UNFINISHED_STATES else BatchRow(*as_values(row))

    def find_stored(self, batch: BatchSummary, first: int, end: int) -> set[int]:
        """Return the numbers of the stored samples from ``first`` to before ``end``."""
        with self._engine.connect() as connection:
            return _find_stored(connection, batch.id, first, end)

    def find_answers(self, batch: BatchSummary, digests: Collection[str]) -> dict[str, str | OwnAnswer]:
        """Return the tenant's answers to problems with these digests: a sample of this batch, or a result as JSON.

        The query is fast however many rows share a digest: one of the tenant's results is taken, and within a batch a
        sample equal to another one has no digest.
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
                query = _select_results(batch.tenant, left)
                found |= {row.digest: row.result for row in connection.execute(query) if row.result is not None}
        return found

    def store(
        self, batch: BatchSummary | None, share_id: str, attempt: int, left: Share | None, new: Sequence[EndedSample]
    ) -> bool:
        """Store a slice and requeue the rest of its share; return False if the attempt is no longer current."""
        change = _build_finish(share_id) if left is None else _build_requeue(share_id, left, crashes=0)
        # The share first, then the batch: cancel() locks them in the same order.
        with self._engine.begin() as connection:
            if connection.execute(change.where(jobs.c.attempt == attempt)).rowcount == 0:
                return False
            if batch is not None and new and not _store_samples(connection, batch, new):
                connection.rollback()
                return False
        return True

    def record_crash(self, share_id: str, claim: str, number: int | None, *, killed: bool) -> Status | None:
        """Record that the worker of a share died, by itself or ``killed`` from outside, at sample ``number`` if known.

        The share is requeued with that sample to be solved by itself. After as many deaths as a job may cause, the
        sample fails.

        Returns
        -------
        Status or None
            ``queued``; ``succeeded`` if the share has no sample left; None, and no change, if the share is cancelled
            or belongs to another attempt.
        """
        return self._return_share(share_id, claim, number, MAX_KILLS if killed else MAX_CRASHES, WORKER_DIED.as_json)

    def give_up(self, share_id: str, claim: str, number: int | None, error: Callable[[str], str]) -> Status | None:
        """Fail a sample from outside and requeue the rest of its share. ``error`` builds the JSON for a job id."""
        return self._return_share(share_id, claim, number, 0, error)

    def _return_share(
        self, share_id: str, claim: str, number: int | None, retries: int, error: Callable[[str], str]
    ) -> Status | None:
        claimed = select(jobs.c.batch, jobs.c.problem, jobs.c.crashes).where(
            jobs.c.id == share_id, jobs.c.claim == claim, jobs.c.status == Status.RUNNING
        )
        with self._engine.begin() as connection:
            row = connection.execute(claimed.with_for_update()).one_or_none()
            if row is None:
                return None
            left = Share.read(row.problem)
            at = _find_culprit(connection, row.batch, left, number)
            over = row.crashes >= retries
            share = Share(left.first, left.end, None if over else at)
            change = (
                _build_finish(share_id)
                if at is None
                else _build_requeue(share_id, share, crashes=0 if over else row.crashes + 1)
            )
            if connection.execute(change.where(jobs.c.claim == claim)).rowcount == 0:
                return None
            if at is None:
                return Status.SUCCEEDED
            # The failed sample is stored in the transaction that requeues its share, so it cannot run again.
            if over:
                found = _load_row(connection, row.batch)
                failed = EndedSample(
                    at, Status.FAILED, format_now(), format_now(), error=error(make_sample_id(row.batch, at))
                )
                if found is None or not _store_samples(connection, BatchRow(*as_values(found)), [failed]):
                    connection.rollback()
                    return None
        return Status.QUEUED

    def cancel(self, batch_id: str) -> list[str] | None:
        """Cancel an unfinished batch; return the ids of its unfinished shares, or None if there is no such batch."""
        shares = select(jobs.c.id).where(jobs.c.batch == batch_id, jobs.c.status.in_(UNFINISHED_STATES))
        with self._engine.begin() as connection:
            # Lock the shares before the batch, as store() does: the opposite order could deadlock.
            running = list(connection.execute(shares.order_by(jobs.c.id).with_for_update()).scalars())
            for share_id in running:
                connection.execute(
                    build_move("cancel", share_id, progress_message="cancelled", finished_at=format_now())
                )
            change = update(batches).where(batches.c.id == batch_id, batches.c.status.in_(UNFINISHED_STATES))
            cancelled = connection.execute(
                change.values(status=Status.CANCELLED, finished_at=format_now(), revision=batches.c.revision + 1)
            )
            return running if cancelled.rowcount else None

    def delete(self, batch_id: str) -> bool:
        """Remove a finished batch with all its samples; return whether it existed.

        The deletion stops after :data:`CLEAR_TIMEOUT_S` seconds; :meth:`tidy` deletes the rest of a very large batch.
        """
        if not removal.mark(self._engine, batch_id):
            return False
        removal.clear(self._engine, batch_id, CLEAR_TIMEOUT_S)
        return True

    def tidy(self) -> int:
        """End lost batches, and finish removals that were interrupted.

        Returns
        -------
        int
            Number of lost batches: all their shares have ended, some of them given up with samples left.
        """
        with self._engine.connect() as connection:
            lost = list(connection.execute(select(batches.c.id).where(*_LOST_CONDITIONS)).scalars())
        self._settle(lost)
        for batch_id in removal.list_marked(self._engine):
            removal.clear(self._engine, batch_id)
        return len(lost)

    def delete_finished(self, before: datetime) -> int:
        """Remove the oldest batch that finished before a time; return the number removed, 0 or 1."""
        # An id begins with the time of creation, which precedes the end: the index on ids bounds the search.
        oldest = (
            select(batches.c.id)
            .where(
                batches.c.id < str(ULID.from_datetime(before)),
                batches.c.status.in_(FINISHED_STATES),
                batches.c.finished_at < as_stored(before),
                removal.NOT_REMOVED,
            )
            .order_by(batches.c.id)
            .limit(1)
        )
        with self._engine.connect() as connection:
            batch_id = connection.execute(oldest).scalar_one_or_none()
        return 0 if batch_id is None else int(self.delete(batch_id))

    def _settle(self, batch_ids: Iterable[str]) -> None:
        """End batches without unfinished shares: the samples left in shares that were given up have failed."""
        ids = list(batch_ids)
        for start in range(0, len(ids), MAX_IDS):
            these = batches.c.id.in_(ids[start : start + MAX_IDS])
            # Read first: almost always there is none, and a read takes no write lock.
            with self._engine.connect() as connection:
                if connection.execute(select(batches.c.id).where(these, *_LOST_CONDITIONS)).first() is None:
                    continue
            change = update(batches).where(these, *_LOST_CONDITIONS).values(
                status=case((batches.c.succeeded > 0, Status.SUCCEEDED), else_=Status.FAILED),
                failed=batches.c.total - batches.c.succeeded,
                finished_at=format_now(),
                revision=batches.c.revision + 1,
            )  # fmt: skip
            with self._engine.begin() as connection:
                connection.execute(change)


def _split_shares(total: int, most: int) -> list[Share]:
    """Split a batch into at most ``most`` shares whose sizes differ by at most one sample."""
    count = min(total, most)
    bounds = [total * n // count for n in range(count + 1)]
    return [Share(first, end) for first, end in pairwise(bounds)]


def _find_culprit(connection: Connection, batch_id: str, left: Share, number: int | None) -> int | None:
    """Return the sample to blame for a worker's death: the one at work if known, else the first one not stored.

    None if all samples of the share are stored.
    """
    stored = _find_stored(connection, batch_id, left.first, left.end)
    supposed = (n for n in (number, left.alone) if n is not None)
    return next((n for n in (*supposed, *range(left.first, left.end)) if n not in stored), None)


def _build_finish(share_id: str) -> Update:
    return build_move(
        "succeed", share_id, finished_at=format_now(), progress_fraction=1.0, progress_message="succeeded"
    )


def _build_requeue(share_id: str, left: Share, **values: object) -> Update:
    return build_move("requeue", share_id, **{**REQUEUED_VALUES, "problem": left.dump(), **values})


def _store_samples(connection: Connection, batch: BatchSummary, new: Sequence[EndedSample]) -> bool:
    """Store ended samples and count them; return False, for the caller to roll back, if the batch has finished."""
    succeeded = sum(sample.status == Status.SUCCEEDED for sample in new)
    failed, cached = len(new) - succeeded, sum(sample.cached for sample in new)
    done = batches.c.succeeded + batches.c.failed + len(new)
    any_succeeded = batches.c.succeeded + succeeded > 0
    change = update(batches).where(batches.c.id == batch.id, batches.c.status.in_(UNFINISHED_STATES)).values(
        succeeded=batches.c.succeeded + succeeded,
        failed=batches.c.failed + failed,
        cached=batches.c.cached + cached,
        revision=batches.c.revision + 1,
        status=case(
            (done < batches.c.total, Status.RUNNING), (any_succeeded, Status.SUCCEEDED), else_=Status.FAILED
        ),
        finished_at=case((done < batches.c.total, batches.c.finished_at), else_=format_now()),
    )  # fmt: skip
    if connection.execute(change).rowcount == 0:
        return False
    of = {"batch": batch.id, "tenant": batch.tenant}
    connection.execute(
        insert(samples), [{**of, **asdict(sample), "id": make_sample_id(batch.id, sample.number)} for sample in new]
    )
    return True


def _select_results(tenant: str, digests: Collection[str]) -> Select[tuple[str, str | None]]:
    """Return a query for each digest with one of the tenant's results for it, or NULL."""
    wanted = values(column("digest", String), name="wanted").data([(digest,) for digest in digests]).cte("wanted")
    results = [
        select(table.c.result)
        .where(table.c.tenant == tenant, table.c.digest == wanted.c.digest)
        .limit(1)
        .scalar_subquery()
        for table in (samples, jobs)
    ]
    return select(wanted.c.digest, func.coalesce(*results).label("result"))


def _filter_samples(batch_id: str, first: int, end: int) -> Sequence[ColumnElement[bool]]:
    """Return the conditions for the samples of a batch from ``first`` to before ``end``."""
    return samples.c.batch == batch_id, samples.c.number >= first, samples.c.number < end


def _find_stored(connection: Connection, batch_id: str, first: int, end: int) -> set[int]:
    return set(connection.execute(select(samples.c.number).where(*_filter_samples(batch_id, first, end))).scalars())


def _load_row(connection: Connection, batch_id: str) -> AnyRow | None:
    return connection.execute(select(*_ROW_COLUMNS).where(batches.c.id == batch_id, removal.NOT_REMOVED)).one_or_none()
