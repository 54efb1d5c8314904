"""Processing of independent rows in portions on two threads.

Compiled kernels release the interpreter's lock, and most machines have a second core. The result does not depend on
which thread takes which portion.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

THREAD_COUNT = 2
"""Number of threads: most machines have a second core."""


def run_in_portions(work: Callable[[slice], None], count: int, portion: int) -> None:
    """Call ``work`` with consecutive slices of ``portion`` of the ``count`` rows, and re-raise its errors."""
    slices = [slice(first, first + portion) for first in range(0, count, portion)]
    # A single portion needs no thread.
    if len(slices) < THREAD_COUNT:
        for some in slices:
            work(some)
        return
    with ThreadPoolExecutor(THREAD_COUNT) as pool:
        # Consume the results: that re-raises an exception of a worker here.
        for _ in pool.map(work, slices):
            pass
