"""One log for the service, its libraries and its workers: a line a record on stderr, for people or for machines."""

from __future__ import annotations

import logging
from typing import Literal

import structlog
from structlog.typing import Processor

Format = Literal["text", "json"]

_STAMPS: tuple[Processor, ...] = (
    structlog.contextvars.merge_contextvars,
    structlog.stdlib.add_log_level,
    structlog.processors.TimeStamper(fmt="iso", utc=True),
)


_RENDERERS: dict[Format, tuple[Processor, ...]] = {
    "text": (structlog.dev.ConsoleRenderer(colors=False, exception_formatter=structlog.dev.plain_traceback),),
    "json": (structlog.processors.format_exc_info, structlog.processors.JSONRenderer()),
}


def configure(level: str, form: Format) -> None:
    """Send the records of structlog and of the standard library to stderr, from ``level`` upwards.

    ``text`` gives lines of ``key=value`` with tracebacks as they are known; ``json`` an object a line.
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
