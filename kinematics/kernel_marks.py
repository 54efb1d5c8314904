"""Marks on disk that record which kernels have been compiled on this machine, in the kernels' own cache folder.

Kernels are compiled in parts, for example all kernels of one kind of problem. The process that compiles a part leaves a
mark, which is valid only for the same sources, compiler and processor. Processes divide the parts among themselves by
file locks, which the system releases when the process that holds them ends.
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

LINKAGES_PART = "linkages"
"""Name of the part that holds the analysis of linkages; most other parts call its kernels."""

PACKAGES = ("kinematics", "synthesis")
"""Folders that hold kernels, or constants that are compiled into kernels."""


def is_compiled(part: str) -> bool:
    """Return whether the kernels of a part have been compiled from the present sources for this machine."""
    return _mark_path(part).exists()


def mark_compiled(part: str) -> None:
    """Record that all kernels of a part have been compiled.

    Raises
    ------
    OSError
        If the kernels' cache folder cannot be written.
    """
    _mark_path(part).parent.mkdir(parents=True, exist_ok=True)
    _mark_path(part).touch()


@contextmanager
def claim_part(part: str) -> Iterator[bool]:
    """Yield True if this process may compile the part, False if another process is compiling it."""
    mark = _mark_path(part)
    mark.parent.mkdir(parents=True, exist_ok=True)
    # The lock belongs to the open file, so the system releases it even when this process is killed.
    with open(mark.with_suffix(".lock"), "w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            yield False
            return
        yield True


def _mark_path(part: str) -> Path:
    return _find_cache_folder() / f"compiled-{_compute_state_digest()}-{part}.mark"


@cache
def _find_cache_folder() -> Path:
    """Return the folder in which the kernels of this package are cached."""
    # Use the first locator that accepts this file, as numba does, so that marks and kernels share one folder.
    found = (locator.from_function(is_compiled, __file__) for locator in LOCATORS)
    return Path(next(locator.get_cache_path() for locator in found if locator is not None))


@cache
def _compute_state_digest() -> str:
    """Return a digest of everything that compiled kernels depend on."""
    files = sorted(path for package in PACKAGES for path in (ROOT / package).rglob("*.py"))
    target = cpu_target.target_context.codegen().magic_tuple()  # the system, the processor and its features
    parts = [sys.version, version("numba"), version("llvmlite"), *target]
    # Any changed source invalidates all marks: inlined callees and constants come from other files.
    parts += [sha256(path.read_bytes()).hexdigest() for path in files]
    return sha256("\n".join(parts).encode()).hexdigest()[:16]
