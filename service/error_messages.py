"""Faults of client input: the place as a JSON pointer (RFC 6901), and the reason as a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from synthesis.model.error_path import select_given_steps

MAX_FAULTS = 20
"""Maximum number of reported faults; a client corrects these and sends the request again."""

MAX_STEP = 100
"""Maximum length of a reported name in a path, characters."""


def make_sentence(text: str) -> str:
    """Format a detail as a sentence, with a capital and a full stop.

    >>> sentence("equal to position 0")
    'Equal to position 0.'
    """
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def format_pointer(location: Iterable[str | int]) -> str:
    """Return the JSON pointer of a place given by its steps; the empty string is the whole document.

    A step is cut at :data:`MAX_STEP` characters: no field has such a long name, and it must not be repeated in full.
    """
    return "".join("/" + str(step)[:MAX_STEP].replace("~", "~0").replace("/", "~1") for step in location)


def locate_fault(fault: Mapping[str, Any], body: object) -> str:
    """Return the JSON pointer to a fault of pydantic in the request.

    A location begins with the part of the request; in a body the pointer starts at the body itself.
    """
    location = tuple(fault["loc"])
    if location[:1] != ("body",):
        return format_pointer(location)
    steps = select_given_steps(location[1:], body, fault["type"] == "missing")
    if fault["type"] == "unknown_kind" and isinstance(fault["input"], dict):
        steps.append("kind")
    return format_pointer(steps)


def explain_fault(fault: Mapping[str, Any]) -> str:
    """Describe a fault of pydantic in a sentence."""
    if fault["type"] == "extra_forbidden":
        return "Unknown field; check its name."
    if fault["type"] == "missing":
        return "This field is required."
    if fault["type"] in ("list_type", "tuple_type"):
        return "This must be a list."
    # A value of an unknown kind that is not an object cannot have a kind at all.
    unread = fault["type"] == "unknown_kind" and not isinstance(fault["input"], dict)
    if unread or fault["type"] in ("model_type", "model_attributes_type", "dict_type"):
        return "This must be an object."
    return make_sentence(str(fault["msg"]).removeprefix("Value error, ").removeprefix("Assertion failed, "))
