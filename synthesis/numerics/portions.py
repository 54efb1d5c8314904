"""Rows that do not hang on one another, worked off in portions, two at a time.

Compiled kernels leave the interpreter free, and most machines have a second core. What is computed does not hang on
which thread takes which portion.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

THREADS = 2


def in_portions(work: Callable[[slice], None], count: int, portion: int) -> None:
    """Call ``work`` with all slices of ``count`` rows, ``portion`` rows each; what it raises is raised here."""
    slices = [slice(first, first + portion) for first in range(0, count, portion)]
    if len(slices) < THREADS:
        for some in slices:
            work(some)
        return
    with ThreadPoolExecutor(THREADS) as pool:
        for _ in pool.map(work, slices):
            pass
