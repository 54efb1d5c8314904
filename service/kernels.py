"""State of the compilation of kernels, for monitoring and for code that waits for a part."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

ANALYSIS_PART = "analysis"
"""The part of the kernels that the server itself needs."""


@dataclass(frozen=True, slots=True)
class Progress:
    """Number of compiled parts of the kernels, and of all parts."""

    compiled: int
    total: int


class Compiling(Protocol):
    """A compilation of kernels in parallel with the jobs (:mod:`service.server.precompile`)."""

    def start(self, after: Callable[[], bool]) -> None:
        """Start in the background once ``after`` returns true, at the latest after ten seconds."""
        ...

    def stop(self) -> None:
        """End the compilation and wait for its end; compiled kernels are kept."""
        ...


@dataclass(slots=True)
class KernelsState:
    """The parts not compiled yet. Written by one thread and read by others."""

    waiting: tuple[str, ...] = ()
    _total: int | None = None
    _ended: threading.Event = field(default_factory=threading.Event)

    def look(self, total: int, missing: Sequence[str]) -> None:
        """Record the number of all parts and the missing ones."""
        self.waiting, self._total = tuple(missing), total

    def note_compiled(self, part: str) -> None:
        """Record that a part is compiled."""
        self.waiting = tuple(each for each in self.waiting if each != part)

    def note_end(self) -> None:
        """Record that the compilation has ended, for any reason."""
        self._ended.set()

    @property
    def progress(self) -> Progress | None:
        """Progress of the compilation; None before the first check."""
        return None if self._total is None else Progress(self._total - len(self.waiting), self._total)

    @property
    def is_ended(self) -> bool:
        """Whether the compilation has ended, so that missing kernels are compiled on demand."""
        return self._ended.is_set()

    def has(self, part: str) -> bool:
        """Return whether the part is known to be compiled."""
        return self._total is not None and part not in self.waiting
