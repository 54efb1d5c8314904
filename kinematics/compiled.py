"""Which kernels have been compiled on this machine: marks on disk, beside the kernels themselves.

Kernels are compiled by parts, such as all those of a kind of problem. Whoever has compiled a part leaves a mark; a mark
counts as long as the sources, the compiler and the processor are those that it was made with. Several processes share
parts out by locks, which end with the process that holds them.
"""

from __future__ import annotations

import fcntl
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

from numba.core.registry import cpu_target

from kinematics.compiling import LOCATORS

ROOT = Path(__file__).resolve().parents[1]

LINKAGES = "linkages"
"""The part that is the analysis of linkages, which most of the other parts call."""

PACKAGES = ("kinematics", "synthesis")
"""The folders that hold kernels, or constants that kernels contain."""


def is_compiled(part: str) -> bool:
    """Whether the kernels of a part have been compiled from the present sources, for this machine."""
    return _mark(part).exists()


def mark_compiled(part: str) -> None:
    """Say that all kernels of a part have been compiled.

    Raises
    ------
    OSError
        Where the kernels' own folder cannot be written.
    """
    _mark(part).parent.mkdir(parents=True, exist_ok=True)
    _mark(part).touch()


@contextmanager
def claimed(part: str) -> Iterator[bool]:
    """Whether the part is this process's to compile; False where another process is at it."""
    mark = _mark(part)
    mark.parent.mkdir(parents=True, exist_ok=True)
    with open(mark.with_suffix(".lock"), "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        yield True


def _mark(part: str) -> Path:
    return _folder() / f"compiled-{_state()}-{part}.mark"


@cache
def _folder() -> Path:
    """Where the kernels of this package are kept."""
    found = (locator.from_function(is_compiled, __file__) for locator in LOCATORS)
    return Path(next(locator.get_cache_path() for locator in found if locator is not None))


@cache
def _state() -> str:
    """A digest of all that compiled kernels depend on."""
    files = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
    target = cpu_target.target_context.codegen().magic_tuple()  # the system, the processor and what it can do
    parts = [sys.version, version("numba"), version("llvmlite"), *target]
    parts += [sha256(path.read_bytes()).hexdigest() for path in files]
    return sha256("\n".join(parts).encode()).hexdigest()[:16]
