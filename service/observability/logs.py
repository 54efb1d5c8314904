"""One log for the service, its libraries and its workers: one line per record on stderr, as text or JSON."""

from __future__ import annotations

import logging
import traceback
from typing import Literal, TextIO

import structlog
from structlog.typing import EventDict, ExcInfo, Processor, WrappedLogger

Format = Literal["text", "json"]

_STAMPS: tuple[Processor, ...] = (
    structlog.contextvars.merge_contextvars,
    structlog.stdlib.add_log_level,
    structlog.processors.TimeStamper(fmt="iso", utc=True),
)

_MARGIN = "    "
"""Indentation of the lines of a traceback, so that no error message can look like a log record."""

# Characters that control a terminal, end a line, or change the direction of text (C0, C1, line and paragraph
# separators, bidirectional controls).
_CONTROLS = [*range(0x20), *range(0x7F, 0xA0), 0x2028, 0x2029, *range(0x202A, 0x202F), *range(0x2066, 0x206A)]
_SPELT = {code: chr(code).encode("unicode_escape").decode() for code in _CONTROLS}


def _escape_controls(_logger: WrappedLogger, _method: str, record: EventDict) -> EventDict:
    """Escape control characters in the record: texts may come from clients, and a record is one line."""
    return {
        key.translate(_SPELT): value if key == "exc_info" else str(value).translate(_SPELT)
        for key, value in record.items()
    }


def _write_traceback(out: TextIO, error: ExcInfo) -> None:
    for part in traceback.format_exception(*error):
        for line in part.rstrip("\n").split("\n"):
            out.write(f"\n{_MARGIN}{line.translate(_SPELT)}")


_RENDERERS: dict[Format, tuple[Processor, ...]] = {
    "text": (_escape_controls, structlog.dev.ConsoleRenderer(colors=False, exception_formatter=_write_traceback)),
    "json": (structlog.processors.format_exc_info, structlog.processors.JSONRenderer()),
}


def configure(level: str, form: Format) -> None:
    """Send the records of structlog and of the standard library to stderr, from ``level`` upwards.

    ``text`` gives lines of ``key=value`` with escaped control characters and indented tracebacks; ``json`` gives one
    object per line.
    """
    line = structlog.stdlib.ProcessorFormatter(
        processors=[
            structlog.stdlib.ProcessorFormatter.remove_processors_meta,
            *_RENDERERS[form],
        ],
        foreign_pre_chain=_STAMPS,
    )
    handler = logging.StreamHandler()
    handler.setFormatter(line)
    logging.basicConfig(level=level.upper(), handlers=[handler], force=True)
    for chatty in ("uvicorn", "alembic", "numba"):
        logging.getLogger(chatty).setLevel(max(logging.WARNING, logging.getLogger().level))
    structlog.configure(
        processors=[
            structlog.stdlib.filter_by_level,
            *_STAMPS,
            structlog.stdlib.ProcessorFormatter.wrap_for_formatter,
        ],
        logger_factory=structlog.stdlib.LoggerFactory(),
        wrapper_class=structlog.stdlib.BoundLogger,
        cache_logger_on_first_use=True,
    )
