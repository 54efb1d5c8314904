"""What is wrong with what a client has sent: where, as a JSON pointer (RFC 6901), and why, in a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from synthesis.model.error_path import select_given_steps

MAX_FAULTS = 20
"""A client corrects what it is shown and asks again; a longer list of faults helps nobody."""

MAX_STEP = 100
"""Longest name in a path, characters."""


def make_sentence(text: str) -> str:
    """A detail as a sentence: with a capital and a full stop.

    >>> sentence("equal to position 0")
    'Equal to position 0.'
    """
    return f"{text[:1].upper()}{text[1:].rstrip('.')}."


def format_pointer(location: Iterable[str | int]) -> str:
    """The JSON pointer to a place that is given step by step; the empty string is the whole.

    A step is cut at :data:`MAX_STEP` characters: a name so long is no field's, and must not come back in full.
    """
    return "".join("/" + str(step)[:MAX_STEP].replace("~", "~0").replace("/", "~1") for step in location)


def locate_fault(fault: Mapping[str, Any], body: Any) -> str:
    """The JSON pointer to where a fault of pydantic's lies in what was sent.

    Its location begins with the part of a request that it is in; in a body the pointer starts at the body itself.
    """
    location = tuple(fault["loc"])
    if location[:1] != ("body",):
        return format_pointer(location)
    steps = select_given_steps(location[1:], body, fault["type"] == "missing")
    if fault["type"] == "unknown_kind" and isinstance(fault["input"], dict):
        steps.append("kind")
    return format_pointer(steps)


def explain_fault(fault: Mapping[str, Any]) -> str:
    """What is wrong there, in a sentence."""
    if fault["type"] == "extra_forbidden":
        return "There is no such field; check its name."
    if fault["type"] == "missing":
        return "This field is required."
    if fault["type"] in ("list_type", "tuple_type"):
        return "This must be a list."
    unread = fault["type"] == "unknown_kind" and not isinstance(fault["input"], dict)
    if unread or fault["type"] in ("model_type", "model_attributes_type", "dict_type"):
        return "This must be an object."
    return make_sentence(str(fault["msg"]).removeprefix("Value error, ").removeprefix("Assertion failed, "))
