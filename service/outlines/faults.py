"""Why a drawing gives no outlines."""

from __future__ import annotations

from collections.abc import Sequence


class DrawingError(ValueError):
    """Anything of a drawing that keeps its outlines from being read; the message is a sentence."""


class ForeignFormat(DrawingError):
    """It is neither SVG nor the text form of DXF."""


class Malformed(DrawingError):
    """It is not what its format is."""


class Unsuitable(DrawingError):
    """It is a drawing, but larger than is read here, or with numbers that cannot be meant."""


class NoOutline(DrawingError):
    """It has no closed outline; ``reasons`` are pairs of the element's id and what keeps it from being one."""

    def __init__(self, message: str, reasons: Sequence[tuple[str, str]]) -> None:
        super().__init__(message)
        self.reasons = reasons
