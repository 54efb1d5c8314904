"""Removal of a batch: hidden from readers at once, then deleted in portions, so that no writer waits long.

If a process dies in between, readers still never see an incomplete batch; the rest of it is deleted later.
"""

from __future__ import annotations

import math
import time

from sqlalchemy import Engine, delete, exists, select, update

from service.jobs.store.schema import batches, jobs, samples
from service.jobs.store.statements import NO_KEY
from service.jobs.store.states import FINISHED_STATES

PORTION_SIZE = 100
"""Number of samples deleted in one transaction; an answer may have half a megabyte."""

_PAUSE_S = 0.01
"""Pause between two portions, seconds, in which other writers get their turn."""

NOT_REMOVED = batches.c.removed.is_(False)
"""Condition for batches that have not been removed."""


def mark(engine: Engine, batch_id: str) -> bool:
    """Hide a finished batch from all readers and free its key; return whether it existed."""
    change = update(batches).where(batches.c.id == batch_id, batches.c.status.in_(FINISHED_STATES), NOT_REMOVED)
    with engine.begin() as connection:
        return connection.execute(change.values(removed=True, **NO_KEY)).rowcount > 0


def clear(engine: Engine, batch_id: str, seconds: float = math.inf) -> None:
    """Delete the rest of a marked batch, within the time limit."""
    began = time.monotonic()
    portion = select(samples.c.number).where(samples.c.batch == batch_id).limit(PORTION_SIZE)
    some = delete(samples).where(samples.c.batch == batch_id, samples.c.number.in_(portion))
    while True:
        with engine.begin() as connection:
            if connection.execute(some).rowcount < PORTION_SIZE:
                break
        if time.monotonic() > began + seconds:
            return
        time.sleep(_PAUSE_S)
    with engine.begin() as connection:
        connection.execute(delete(jobs).where(jobs.c.batch == batch_id))
        # Another server may be deleting the same batch and not have committed its last portion.
        left = exists().where(samples.c.batch == batches.c.id)
        connection.execute(delete(batches).where(batches.c.id == batch_id, ~NOT_REMOVED, ~left))


def list_marked(engine: Engine) -> list[str]:
    """Return the ids of batches that are marked but not completely deleted: the deletion is running or was killed."""
    with engine.connect() as connection:
        return list(connection.execute(select(batches.c.id).where(~NOT_REMOVED)).scalars())
