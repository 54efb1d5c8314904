"""Descriptions of faults in client input: the place as a JSON pointer (RFC 6901), and the reason as a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

from kinematics.message import make_sentence
from synthesis.model.error_path import select_given_steps

MAX_FAULTS = 20
"""Maximum number of reported faults; a client corrects these and sends the request again."""

MAX_STEP = 100
"""Maximum length of a reported name in a path, characters."""


MAX_LISTED_FIELDS = 8
"""Maximum number of fields that the message on an unknown field lists."""

Models = Mapping[str, object]
"""Types that the parts of a request are validated against: `body`, `query`."""


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


def describe_faults(faults: Iterable[Mapping[str, Any]], body: object, models: Models) -> list[tuple[str, str]]:
    """Return the place and a description of each fault of pydantic, without repetitions.

    Unknown fields get the most similar name among the fields that their object may have according to ``models``.
    """
    # A union tries several models, which may report the same fault.
    placed: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for fault in faults:
        placed.setdefault((locate_fault(fault, body), _explain_fault(fault)), []).append(fault)
    described: list[tuple[str, str]] = []
    for (path, detail), same in placed.items():
        # Similar names are searched only for faults that are reported: a body may have thousands of unknown fields, and
        # comparing names is slow.
        if same[0]["type"] == "extra_forbidden" and len(described) < MAX_FAULTS:
            detail = _explain_unknown_field(same, models)
        described.append((path, detail))
    return described


def _explain_unknown_field(faults: Iterable[Mapping[str, Any]], models: Models) -> str:
    """Describe an unknown field, reported by one or more members of a union."""
    name = ""
    known: dict[str, None] = {}
    for fault in faults:
        part, *steps, last = fault["loc"]
        name = str(last)
        known |= dict.fromkeys(list_known_fields(models.get(part), steps))
    if len(name) <= MAX_STEP and (near := get_close_matches(name, known, 1)):
        return f"Unknown field; did you mean `{near[0]}`?"
    if 0 < len(known) <= MAX_LISTED_FIELDS:
        *others, final = (f"`{field}`" for field in known)
        listed = f"fields are {', '.join(others)} and {final}" if others else f"only field is {final}"
        return f"Unknown field; the {listed}."
    return "Unknown field; check its name."


def list_known_fields(annotation: object, steps: Iterable[str | int]) -> list[str]:
    """Return the names in JSON of the fields that the object at a place may have.

    Parameters
    ----------
    annotation : type or annotation
        Type of the whole document.
    steps : iterable of str or int
        Place as in pydantic's errors: after each union, a step names the member that was tried.
    """
    types = _list_members(annotation)
    for step in steps:
        named = [type_ for type_ in types if len(types) > 1 and _is_named(type_, step)]
        below = [member for type_ in types for member in _list_types_below(type_, step)]
        # Validators of pydantic add steps that name neither a union member nor a field; such a step changes nothing.
        types = named or below or types
    models = [type_ for type_ in types if isinstance(type_, type) and issubclass(type_, BaseModel)]
    return [field.alias or name for model in models for name, field in model.model_fields.items()]


def _list_members(annotation: object) -> list[object]:
    """Return the members of a union, without annotations; of another type the type itself."""
    origin = get_origin(annotation)
    if origin is Annotated:
        return _list_members(get_args(annotation)[0])
    if origin in (Union, UnionType):
        return [member for part in get_args(annotation) for member in _list_members(part)]
    return [annotation]


def _is_named(type_: object, step: str | int) -> bool:
    """Return whether a step of a location names a member of a union: by its class, or by the tag of its kind."""
    if not (isinstance(type_, type) and issubclass(type_, BaseModel)):
        return False
    tags = (type_.model_fields[name].annotation for name in ("kind", "type") if name in type_.model_fields)
    return step == type_.__name__ or any(str(step).strip("<>") in get_args(tag) for tag in tags)


def _list_types_below(type_: object, step: str | int) -> list[object]:
    """Return the types of a field of a model, or of the elements of a list or a mapping."""
    if isinstance(type_, type) and issubclass(type_, BaseModel):
        fields = (field for name, field in type_.model_fields.items() if step in (name, field.alias))
        return [member for field in fields for member in _list_members(field.annotation)]
    elements = get_args(type_)
    if isinstance(step, int) and get_origin(type_) in (list, tuple, Sequence):
        return [member for element in elements for member in _list_members(element)]
    if isinstance(step, str) and get_origin(type_) in (dict, Mapping):
        return _list_members(elements[1])
    return []


def _explain_fault(fault: Mapping[str, Any]) -> str:
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
