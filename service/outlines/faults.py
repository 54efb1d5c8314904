"""Reasons why a drawing gives no outlines, and why an element gives none.

A drawing may have thousands of elements without an outline, of which an answer lists a few. Their reasons are messages
that are composed only when they are listed.
"""

from __future__ import annotations

from collections.abc import Sequence

from kinematics.message import Message, Value, make_sentence, remember


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


class Obstacle(ValueError):
    """An element gives no outline or no curve; ``reason`` is the message that says why."""

    def __init__(self, message_id: str, /, **values: Value) -> None:
        super().__init__(message_id)
        self.reason = Message(message_id, values)


def get_reason(error: ValueError) -> Message:
    """Return the message that says why an element gives no outline."""
    return error.reason if isinstance(error, Obstacle) else Message("outlines-element-unreadable", {})


def describe_reason(reason: Message) -> str:
    """Compose the reason as a sentence."""
    return make_sentence(remember(reason))
