"""Reasons why a drawing gives no outlines."""

from __future__ import annotations

from collections.abc import Sequence


class DrawingError(ValueError):
    """Base of all errors that prevent reading outlines; the message is a sentence for the client."""


class ForeignFormat(DrawingError):
    """The content is neither SVG nor text DXF."""


class MalformedDrawing(DrawingError):
    """The content violates the rules of its format."""


class UnsuitableDrawing(DrawingError):
    """The drawing is too large, or its coordinates are out of range."""


class NoOutline(DrawingError):
    """The drawing has no closed outline; ``reasons`` pairs each element's id with the obstacle."""

    def __init__(self, message: str, reasons: Sequence[tuple[str, str]]) -> None:
        super().__init__(message)
        self.reasons = reasons
