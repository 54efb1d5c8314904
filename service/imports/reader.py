"""What runs in a process that reads files, each to its answer or to what is wrong with it.

This module is imported by the server too, so it brings no library that reads files.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal

from pydantic import BaseModel

from service.jobs.processes.limits import confine, limit_memory
from service.observability.logs import Format
from service.outlines import faults

Door = Literal["imports", "outlines"]

_FAULTS = {each.__name__: each for each in (faults.ForeignFormat, faults.MalformedDrawing, faults.UnsuitableDrawing)}


@dataclass(frozen=True)
class Fault:
    """What is wrong with a file, as it goes through a pipe."""

    kind: str
    message: str
    reasons: tuple[tuple[str, str], ...] = ()

    @classmethod
    def of(cls, error: faults.DrawingError) -> Fault:
        """What an error says."""
        reasons = tuple(error.reasons) if isinstance(error, faults.NoOutline) else ()
        return cls(type(error).__name__, str(error), reasons)

    def error(self) -> faults.DrawingError:
        """The error that it was."""
        if self.kind == faults.NoOutline.__name__:
            return faults.NoOutline(self.message, self.reasons)
        return _FAULTS[self.kind](self.message)


def prepare(server_pid: int, log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: its end, its limits, its libraries."""
    confine(server_pid, log_level, log_format)
    for library in ("service.imports.reading", "service.outlines.reading"):
        import_module(library)
    limit_memory(memory_mb)


def read(door: Door, content: bytes, asked: dict[str, Any]) -> bytes | Fault:
    """What a door answers to a file, as JSON, or what is wrong with the file."""
    from service.imports.reading import imports_of
    from service.outlines.reading import read_outlines

    doors: dict[Door, Callable[..., BaseModel]] = {"imports": imports_of, "outlines": read_outlines}
    try:
        return doors[door](content, **asked).model_dump_json().encode()
    except faults.DrawingError as error:
        return Fault.of(error)
