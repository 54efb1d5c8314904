"""What runs in a process that reads files: one after the other, each to its answer or to what is wrong with it.

This module is imported by the server too, so it brings no library that reads files.
"""

from __future__ import annotations

from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Final, Literal

import structlog

from service.jobs.confined import confine, limit_memory
from service.logs import Format
from service.outlines import faults

Door = Literal["imports", "outlines"]

READY: Final = "ready"
OUT_OF_MEMORY: Final = "out of memory"

_FAULTS = {each.__name__: each for each in (faults.ForeignFormat, faults.Malformed, faults.Unsuitable)}

log = structlog.get_logger(__name__)


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


def serve(pipe: Connection, server_pid: int, log_level: str, log_format: Format, memory_mb: int) -> None:
    """Read files from a pipe until it is closed."""
    confine(server_pid, log_level, log_format)
    from service.imports.reading import imports_of
    from service.outlines.reading import outlines_of

    doors = {"imports": imports_of, "outlines": outlines_of}
    limit_memory(memory_mb)
    pipe.send(READY)
    while True:
        try:
            door, content, asked = pipe.recv()
        except EOFError:
            return
        pipe.send(_answered(doors[door], content, asked))


def _answered(door: Any, content: bytes, asked: dict[str, Any]) -> bytes | str | Fault:
    try:
        answer: bytes = door(content, **asked).model_dump_json().encode()
    except faults.DrawingError as error:
        return Fault.of(error)
    except MemoryError:
        return OUT_OF_MEMORY
    except Exception as error:  # a defect: logged here with its trace, ReaderLost in the server, and so a 500
        log.exception("a file could not be read")
        return type(error).__name__
    return answer
