"""Code of a process that reads files; the answer is the content or the fault of the file.

The server imports this module, too, so it imports no library that reads files.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal

from pydantic import BaseModel

from service.jobs.processes.limits import limit_memory, restrict_process
from service.observability.logs import Format
from service.outlines import faults

Door = Literal["imports", "outlines"]

_FAULT_CLASSES = {
    each.__name__: each for each in (faults.ForeignFormat, faults.MalformedDrawing, faults.UnsuitableDrawing)
}


@dataclass(frozen=True)
class Fault:
    """The fault of a file in a form that can be pickled."""

    kind: str
    message: str
    reasons: tuple[tuple[str, str], ...] = ()

    @classmethod
    def from_error(cls, error: faults.DrawingError) -> Fault:
        """Convert an error to a fault."""
        reasons = tuple(error.reasons) if isinstance(error, faults.NoOutline) else ()
        return cls(type(error).__name__, str(error), reasons)

    def to_error(self) -> faults.DrawingError:
        """Convert the fault back to the error."""
        if self.kind == faults.NoOutline.__name__:
            return faults.NoOutline(self.message, self.reasons)
        return _FAULT_CLASSES[self.kind](self.message)


def prepare(log_level: str, log_format: Format, memory_mb: int) -> None:
    """Prepare the process: end with the server, limits, libraries."""
    # The parent is the server, or the template process that was forked, which ends with the server.
    restrict_process(os.getppid(), log_level, log_format)
    for library in ("service.imports.reading", "service.outlines.reading"):
        import_module(library)
    limit_memory(memory_mb)


def read(door: Door, content: bytes, options: dict[str, Any]) -> bytes | Fault:
    """Return the content that a door reads from a file, as JSON, or the fault of the file."""
    from service.imports.reading import read_curves
    from service.outlines.reading import read_outlines

    doors: dict[Door, Callable[..., BaseModel]] = {"imports": read_curves, "outlines": read_outlines}
    try:
        return doors[door](content, **options).model_dump_json().encode()
    except faults.DrawingError as error:
        return Fault.from_error(error)
