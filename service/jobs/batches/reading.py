"""Samples of batches as jobs: each has a problem and, once it has ended, an answer."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import fields
from hashlib import sha256
from typing import Any

from sqlalchemy import Connection, func, select
from ulid import ULID

from service.jobs.batches.plan import Plan
from service.jobs.batches.removal import NOT_REMOVED
from service.jobs.store.schema import AnyRow, JobSummary, SampleRow, batches, samples
from service.jobs.store.statements import MAX_IDS
from service.jobs.store.states import Status

_RANDOM_BITS, _NUMBER_BITS = 80, 14
"""Bits of a ULID below its timestamp, and the bits for a sample's number, which is below 10,000."""

_SAMPLE_COLUMNS = [
    samples.c[name] for name in ("id", "batch", "tenant", "number", "status", "started_at", "finished_at")
]
_BATCH_COLUMNS = [batches.c[name] for name in ("kind", "label", "created_at")]
_BATCH_CONDITIONS = (batches.c.id == samples.c.batch, NOT_REMOVED)

_other = samples.alias()
_SAME_RESULT = select(_other.c.result).where(_other.c.batch == samples.c.batch, _other.c.number == samples.c.same_as)
_RESULT = func.coalesce(samples.c.result, _SAME_RESULT.scalar_subquery()).label("result")


def make_sample_id(batch_id: str, number: int) -> str:
    """Return the id of a sample: the time of its batch, a hash of the batch's id, and the sample's number.

    ULIDs created in the same millisecond are consecutive, so adding the number to the batch's id could give the id of
    another batch; the hash prevents that.
    """
    made_at = int(ULID.from_str(batch_id)) >> _RANDOM_BITS
    own = int.from_bytes(sha256(batch_id.encode()).digest()) & ((1 << _RANDOM_BITS - _NUMBER_BITS) - 1)
    assert 0 <= number < 1 << _NUMBER_BITS
    return str(ULID.from_int((made_at << _RANDOM_BITS) | (own << _NUMBER_BITS) | number))


def load_sample(connection: Connection, job_id: str) -> SampleRow | None:
    """Return the sample with this id as a job; None if it does not exist or has not ended."""
    query = select(
        *_SAMPLE_COLUMNS, *_BATCH_COLUMNS, samples.c.cached, _RESULT, samples.c.error, batches.c.stated, batches.c.plan
    )
    row = connection.execute(query.where(samples.c.id == job_id, *_BATCH_CONDITIONS)).one_or_none()
    if row is None:
        return None
    return SampleRow(
        **_build_summary(row),
        problem=json.dumps(Plan.read(row.stated, row.plan).build_statement(row.number)),
        result=row.result,
        error=row.error,
        batch=row.batch,
        cached=row.cached,
    )


def load_samples(connection: Connection, job_ids: Sequence[str]) -> dict[str, JobSummary]:
    """Return the samples among these ids, as jobs without problems and answers."""
    found = {}
    query = select(*_SAMPLE_COLUMNS, *_BATCH_COLUMNS).where(*_BATCH_CONDITIONS)
    for start in range(0, len(job_ids), MAX_IDS):
        for row in connection.execute(query.where(samples.c.id.in_(job_ids[start : start + MAX_IDS]))):
            found[row.id] = JobSummary(**_build_summary(row))
    return found


def _build_summary(row: AnyRow) -> dict[str, Any]:
    status = Status(row.status)
    stated = {field.name: getattr(row, field.name, None) for field in fields(JobSummary)}
    # A stored sample has ended, in one attempt: the other fields of a job follow from that.
    return {
        **stated,
        "status": status,
        "progress_fraction": 1.0,
        "progress_message": status.value,
        "attempt": 1,
        "crashes": 0,
        "revision": 1,
    }
