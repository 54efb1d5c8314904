"""How far the compilation of kernels is: what whoever watches over the service sees, and whoever waits for a part."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

ANALYSIS_PART = "analysis"
"""The part of the kernels that the server itself calls."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How many parts of the kernels there are, and how many of them have been compiled."""

    compiled: int
    total: int


class Compiling(Protocol):
    """Whoever compiles kernels beside the jobs (:mod:`service.server.precompile`)."""

    def start(self, after: Callable[[], bool]) -> None:
        """Begin in the background, once ``after`` says so or ten seconds from now."""
        ...

    def stop(self) -> None:
        """End it, and wait for that. What is compiled is kept."""
        ...


@dataclass(slots=True)
class KernelsState:
    """Which parts are waited for. Written by one thread and read by others."""

    waiting: tuple[str, ...] = ()
    _total: int | None = None
    _ended: threading.Event = field(default_factory=threading.Event)

    def look(self, total: int, missing: Sequence[str]) -> None:
        """Note how much there is to be and what is missing."""
        self.waiting, self._total = tuple(missing), total

    def note_compiled(self, part: str) -> None:
        """Note that a part is there."""
        self.waiting = tuple(each for each in self.waiting if each != part)

    def note_end(self) -> None:
        """Note that nobody compiles any more, for whatever reason."""
        self._ended.set()

    @property
    def progress(self) -> Progress | None:
        """How far it is; None as long as nobody has looked."""
        return None if self._total is None else Progress(self._total - len(self.waiting), self._total)

    @property
    def is_ended(self) -> bool:
        """Whether nobody compiles any more, so that what is missing is compiled by whoever needs it."""
        return self._ended.is_set()

    def has(self, part: str) -> bool:
        """Whether it is known that the part is compiled."""
        return self._total is not None and part not in self.waiting
