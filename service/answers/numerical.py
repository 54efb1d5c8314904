"""Numerical errors that escape from an analysis: refused at the boundary, and counted as defects.

An input that leads a computation astray is a fault of the service's own, since it should have been refused by its
field. The client still gets an answer that says where, and the operator the trace.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import structlog

from service.refusals import Refusal, invalid_mechanism

NUMERICAL_ERRORS = (ArithmeticError, ValueError, IndexError)
"""What numerical libraries raise on numbers that they cannot take; ``LinAlgError`` is a ``ValueError``."""

log = structlog.get_logger(__name__)


@contextmanager
def refuse_numerical_errors(path: str = "/mechanism") -> Iterator[None]:
    """Turn a numerical error inside into a refusal at ``path``.

    Raises
    ------
    Refusal
        422, marked as a defect. Refusals from inside pass as they are.
    """
    try:
        yield
    except Refusal:
        raise
    except NUMERICAL_ERRORS as error:
        log.exception("a numerical error has escaped", error=type(error).__name__)
        detail = "These numbers cannot be computed with; are all sizes, angles and counts meant so?"
        raise invalid_mechanism([(path, detail)], defect=type(error).__name__) from None
