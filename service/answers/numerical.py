"""Numerical errors that escape from an analysis: refused at the boundary and counted as defects.

An input that breaks a computation is a defect of the service, since the validation of its field should have refused it.
The client still gets an answer with the place, and the log has the traceback for the operator.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import structlog

from kinematics.message import compose
from service.refusals import Refusal, refuse_invalid_mechanism

NUMERICAL_ERRORS = (ArithmeticError, ValueError, IndexError)
"""Errors of numerical libraries for numbers they cannot handle; ``LinAlgError`` is a ``ValueError``."""

log = structlog.get_logger(__name__)


@contextmanager
def refuse_numerical_errors(path: str = "/mechanism") -> Iterator[None]:
    """Turn a numerical error inside into a refusal at ``path``.

    Raises
    ------
    Refusal
        422, marked as a defect. Refusals from inside pass unchanged.
    """
    try:
        yield
    except Refusal:
        raise
    except NUMERICAL_ERRORS as error:
        log.exception("a numerical error has escaped", error=type(error).__name__)
        detail = compose("service-computation-impossible")
        raise refuse_invalid_mechanism([(path, detail)], defect=type(error).__name__) from None
