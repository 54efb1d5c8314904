"""How a batch is removed: for its readers at once, and then portion by portion, so that no writer waits for long.

Whatever dies in between, nobody sees a batch that lacks some of its samples; what is left of it is removed later.
"""

from __future__ import annotations

import math
import time

from sqlalchemy import Engine, delete, exists, select, update

from service.jobs.store.schema import batches, jobs, samples
from service.jobs.store.statements import NO_KEY
from service.jobs.store.states import FINISHED

PORTION = 100
"""Samples that are removed in one transaction; there are answers of half a megabyte."""

_PAUSE_S = 0.01
"""Between two portions, so that others get to write."""

THERE = batches.c.removed.is_(False)
"""Batches that have not been removed."""


def mark(engine: Engine, batch_id: str) -> bool:
    """Remove a finished batch for all who read; whether there was one. Its key is free again."""
    change = update(batches).where(batches.c.id == batch_id, batches.c.status.in_(FINISHED), THERE)
    with engine.begin() as connection:
        return connection.execute(change.values(removed=True, **NO_KEY)).rowcount > 0


def clear(engine: Engine, batch_id: str, seconds: float = math.inf) -> None:
    """Remove what is left of a batch that is marked, or as much of it as there is time for."""
    began = time.monotonic()
    portion = select(samples.c.number).where(samples.c.batch == batch_id).limit(PORTION)
    some = delete(samples).where(samples.c.batch == batch_id, samples.c.number.in_(portion))
    while True:
        with engine.begin() as connection:
            if connection.execute(some).rowcount < PORTION:
                break
        if time.monotonic() > began + seconds:
            return
        time.sleep(_PAUSE_S)
    with engine.begin() as connection:
        connection.execute(delete(jobs).where(jobs.c.batch == batch_id))
        # Another server may be at it, and not have committed its last portion.
        left = exists().where(samples.c.batch == batches.c.id)
        connection.execute(delete(batches).where(batches.c.id == batch_id, ~THERE, ~left))


def marked(engine: Engine) -> list[str]:
    """The batches that are marked, and not wholly removed: by whoever was killed, or is at it."""
    with engine.connect() as connection:
        return list(connection.execute(select(batches.c.id).where(~THERE)).scalars())
