"""Tasks of a table on several processes, in their order."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import Any


class Spread:
    """Where the tasks of a table are worked on.

    Attributes
    ----------
    processes : int
        As many at once; one works in this process.
    """

    processes = 1


def each(work: Callable[..., Any], arguments: Iterable[tuple[Any, ...]]) -> Iterator[Any]:
    """What a function of a module gives for each of some arguments, in their order."""
    if Spread.processes == 1:
        yield from (work(*one) for one in arguments)
        return
    with ProcessPoolExecutor(Spread.processes, multiprocessing.get_context("spawn")) as pool:
        yield from pool.map(work, *zip(*arguments, strict=True))
