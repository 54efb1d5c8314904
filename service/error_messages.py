"""Descriptions of faults in client input: the place as a JSON pointer (RFC 6901), and the reason as a sentence."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from difflib import get_close_matches
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from pydantic import BaseModel

from kinematics.message import compose, find_message, make_sentence
from synthesis.model.error_path import select_given_steps

MAX_FAULTS = 20
"""Maximum number of reported faults; a client corrects these and sends the request again."""

MAX_STEP = 100
"""Maximum length of a reported name in a path, characters."""


MAX_LISTED_FIELDS = 8
"""Maximum number of fields that the message on an unknown field lists."""

_TYPE_IDS = {
    "extra_forbidden": "service-unknown-field",
    "missing": "service-field-required",
    "list_type": "service-list-expected",
    "tuple_type": "service-list-expected",
    "model_type": "service-object-expected",
    "model_attributes_type": "service-object-expected",
    "dict_type": "service-object-expected",
    "string_type": "service-string-expected",
    "int_type": "service-integer-expected",
    "int_parsing": "service-integer-expected",
    "int_parsing_size": "service-integer-expected",
    "float_type": "service-number-expected",
    "float_parsing": "service-number-expected",
    "finite_number": "service-input-not-finite",
    "bool_type": "service-boolean-expected",
}
"""Messages without values, by pydantic's types of errors."""

_LIMIT_IDS = {
    "greater_than": ("service-input-greater-than", "gt"),
    "greater_than_equal": ("service-input-greater-equal", "ge"),
    "less_than": ("service-input-less-than", "lt"),
    "less_than_equal": ("service-input-less-equal", "le"),
}
"""Messages on limits of numbers by pydantic's types of errors, with the name of the limit in the error's context."""

_CUSTOM_IDS = {"unknown_kind": "service-kind-unknown", "unknown_output": "service-output-unknown"}
"""Messages by our own types of errors, whose texts end with the permitted names after a colon."""

_UNKNOWN_FIELD_PREFIX = "service-unknown-field"
"""Beginning of the ids of all messages on an unknown field."""

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
    # A body may have thousands of equal faults, and composing a text takes longer than finding it.
    explained: dict[tuple[str, str, bool], str] = {}
    for fault in faults:
        key = fault["type"], fault["msg"], isinstance(fault["input"], dict)
        if key not in explained:
            explained[key] = _explain_fault(fault)
        placed.setdefault((locate_fault(fault, body), explained[key]), []).append(fault)
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
        return compose("service-unknown-field-resembles", field=near[0])
    if 0 < len(known) <= MAX_LISTED_FIELDS:
        *others, final = (f"`{field}`" for field in known)
        if not others:
            return compose("service-unknown-field-besides-one", field=final)
        return compose("service-unknown-field-besides", fields=", ".join(others), last=final)
    return compose("service-unknown-field")


def is_unknown_field(detail: str) -> bool:
    """Return whether a description that was composed in this process is that of an unknown field."""
    message = find_message(detail)
    return message is not None and message.id.startswith(_UNKNOWN_FIELD_PREFIX)


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
    type_, text = fault["type"], str(fault["msg"])
    # A value of an unknown kind that is not an object cannot have a kind at all.
    if type_ == "unknown_kind" and not isinstance(fault["input"], dict):
        return compose("service-object-expected")
    if type_ in _CUSTOM_IDS:
        return compose(_CUSTOM_IDS[type_], names=text.rpartition(": ")[2])
    if type_ in _TYPE_IDS:
        return compose(_TYPE_IDS[type_])
    known = _explain_by_context(type_, fault.get("ctx", {}))
    return known or make_sentence(text.removeprefix("Value error, ").removeprefix("Assertion failed, "))


def _explain_by_context(type_: str, context: Mapping[str, Any]) -> str | None:
    """Describe a fault of pydantic by the values in its context; return None for a type without a message."""
    if type_ in _LIMIT_IDS:
        message_id, name = _LIMIT_IDS[type_]
        return compose(message_id, limit=_format_limit(context[name]))
    if type_ in ("too_short", "too_long"):
        return _explain_length(type_, context)
    match type_:
        case "string_too_short":
            return compose("service-string-too-short", count=context["min_length"])
        case "string_too_long":
            return compose("service-string-too-long", count=context["max_length"])
        case "string_pattern_mismatch":
            return compose("service-string-mismatch", pattern=context["pattern"])
        case "literal_error":
            return _explain_literal(context["expected"])
        case "union_tag_not_found":
            return compose("service-discriminator-missing", field=context["discriminator"])
        case "union_tag_invalid":
            # The tag is text from the client and is not repeated.
            names = context["expected_tags"]
            return compose("service-discriminator-unknown", field=context["discriminator"], names=names)
    return None


def _explain_length(type_: str, context: Mapping[str, Any]) -> str | None:
    """Describe a list or an object with too few or too many members."""
    count, is_object = context["actual_length"], context["field_type"] == "Dictionary"
    if type_ == "too_long" and is_object:
        # Pydantic stops counting the members of an object at the limit.
        return compose("service-object-too-long", most=context["max_length"])
    if count is None:
        return None
    if type_ == "too_long":
        return compose("service-list-too-long", most=context["max_length"], count=count)
    message_id = "service-object-too-short" if is_object else "service-list-too-short"
    return compose(message_id, least=context["min_length"], count=count)


def _explain_literal(expected: str) -> str:
    """Describe a value other than the expected ones, which pydantic lists as "'mm', 'cm' or 'in'"."""
    names, joined, last = expected.rpartition(" or ")
    if not joined:
        return compose("service-input-is", name=last)
    return compose("service-input-one-of", names=names, last=last)


def _format_limit(limit: float) -> str:
    """Format a limit with all its digits and without an exponent.

    >>> _format_limit(1e9), _format_limit(1e-6), _format_limit(0.5)
    ('1000000000', '0.000001', '0.5')
    """
    return f"{Decimal(repr(limit)):f}".removesuffix(".0")
