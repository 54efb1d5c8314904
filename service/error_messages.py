"""Descriptions of faults in client input: the place as a JSON pointer (RFC 6901), and the reason as a sentence."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from difflib import get_close_matches
from typing import Any

from kinematics.message import compose, find_message, make_sentence
from service.expected_values import list_known_fields, write_example
from synthesis.model.error_path import select_given_steps

MAX_FAULTS = 20
"""Maximum number of reported faults; a client corrects these and sends the request again."""

MAX_STEP = 100
"""Maximum length of a reported name in a path, characters."""


MAX_LISTED_FIELDS, MAX_FIELDS_BESIDES = 40, 8
"""Maximum number of fields that the message on an unknown field lists: alone, and besides a similar name."""

LIMITS_PAGE = "docs/methods/overview.md#what-the-service-does-not-do"
"""Section of the documentation on what the service does not do."""

_UNSUPPORTED_KIND_WORDS = (
    "3d", "arm", "belt", "chain", "compliant", "delta", "flexure", "hexapod", "hydraulic", "manipulator", "motor",
    "multi_dof", "parallel_robot", "pneumatic", "pulley", "robot", "scara", "serial", "spatial", "stewart", "two_dof",
)  # fmt: skip
"""Parts of names of mechanisms that the service does not treat."""

MIN_KIND_SIMILARITY = 0.5
"""Minimum similarity of kinds that are suggested: names of different kinds share few letters."""

_TYPE_IDS = {
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

_SHAPE_IDS = {
    "missing": ("service-field-required", "service-field-required-as"),
    "list_type": ("service-list-expected", "service-list-expected-as"),
    "tuple_type": ("service-list-expected", "service-list-expected-as"),
    "model_type": ("service-object-expected", "service-object-expected-as"),
    "model_attributes_type": ("service-object-expected", "service-object-expected-as"),
    "dict_type": ("service-object-expected", "service-object-expected-as"),
}
"""Messages on the form of a value by pydantic's types of errors: without and with an example."""

_LIMIT_IDS = {
    "greater_than": ("service-input-greater-than", "gt"),
    "greater_than_equal": ("service-input-greater-equal", "ge"),
    "less_than": ("service-input-less-than", "lt"),
    "less_than_equal": ("service-input-less-equal", "le"),
}
"""Messages on limits of numbers by pydantic's types of errors, with the name of the limit in the error's context."""

_OWN_TYPES = ("value_error", "assertion_error")
"""Types of errors whose texts are messages of our own validators."""

_UNKNOWN_FIELD_PREFIX = "service-unknown-field"
"""Beginning of the ids of all messages on an unknown field."""

_WRAPPERS = {"problem": "kind", "mechanism": "type"}
"""Fields of a body whose contents a client may send without them, with a field of these contents."""

Models = Mapping[str, object]
"""Types that the parts of a request are validated against: `body`, `query`."""

Fault = Mapping[str, Any]
"""An error of pydantic."""


def format_pointer(location: Iterable[str | int]) -> str:
    """Return the JSON pointer of a place given by its steps; the empty string is the whole document.

    A step is cut at :data:`MAX_STEP` characters: no field has such a long name, and it must not be repeated in full.
    """
    return "".join("/" + str(step)[:MAX_STEP].replace("~", "~0").replace("/", "~1") for step in location)


def locate_fault(fault: Fault, body: object) -> str:
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


def describe_faults(faults: Iterable[Fault], body: object, models: Models) -> list[tuple[str, str]]:
    """Return the place and a description of each fault of pydantic, without repetitions.

    The members of a union, each of which reports its own faults, are described together. Names and values get the most
    similar permitted one, and values of another form an example, according to ``models``.
    """
    placed: dict[str, list[Fault]] = {}
    for fault in faults:
        placed.setdefault(locate_fault(fault, body), []).append(fault)
    for name, own_field in _WRAPPERS.items():
        if isinstance(body, dict) and name not in body and own_field in body and f"/{name}" in placed:
            example = f'{{"{name}": {{"{own_field}": "...", ...}}}}'
            return [(f"/{name}", compose("service-wrapper-missing", field=name, example=example))]
    containers = {path.rpartition("/")[0] for path in placed}
    described: dict[tuple[str, str], None] = {}
    # A body may have thousands of equal faults, and composing a text takes longer than finding it.
    explained: dict[tuple[str, str], str] = {}
    for path, same in placed.items():
        for group in _group_faults(same, has_faults_below=path in containers):
            key = group[0]["type"], group[0]["msg"]
            if len(described) < MAX_FAULTS:
                detail = _explain_faults(group, models)
            # Further faults are counted only.
            elif key not in explained:
                explained[key] = detail = _explain_faults(group[:1], {})
            else:
                detail = explained[key]
            described[path, detail] = None
    return list(described)


def _group_faults(faults: Sequence[Fault], *, has_faults_below: bool) -> list[list[Fault]]:
    """Group the faults at one place that are described together.

    A member of a union that is no list or object has nothing to say about one in which another member finds faults.
    """
    literal = [fault for fault in faults if fault["type"] == "literal_error"]
    others = [fault for fault in faults if fault["type"] != "literal_error"]
    if has_faults_below:
        literal = [fault for fault in literal if not isinstance(fault["input"], list | dict)]
    unknown = [fault for fault in others if fault["type"] == "extra_forbidden"]
    lists = [fault for fault in others if fault["type"] in ("list_type", "tuple_type")]
    apart = ("extra_forbidden", "list_type", "tuple_type") if literal else ("extra_forbidden",)
    rest = [fault for fault in others if fault["type"] not in apart]
    first = [*literal, *lists] if literal else []
    return [group for group in (first, unknown) if group] + [[fault] for fault in rest]


def _explain_faults(faults: Sequence[Fault], models: Models) -> str:
    """Describe the faults of one place."""
    match faults[0]["type"]:
        case "extra_forbidden":
            return _explain_unknown_field(faults, models)
        case "literal_error":
            return _explain_literals(faults, models)
        case _:
            return _explain_fault(faults[0], models)


def _explain_unknown_field(faults: Iterable[Fault], models: Models) -> str:
    """Describe an unknown field, reported by one or more members of a union."""
    name = ""
    known: dict[str, None] = {}
    for fault in faults:
        part, *steps, last = fault["loc"]
        name = str(last)
        known |= dict.fromkeys(list_known_fields(models.get(part), steps))
    near = _find_similar(name, known)
    if not known or len(known) > (MAX_FIELDS_BESIDES if near else MAX_LISTED_FIELDS):
        return compose("service-unknown-field-resembles", field=near) if near else compose("service-unknown-field")
    *others, final = (f"`{field}`" for field in known)
    if not others:
        return compose("service-unknown-field-besides-one", field=final)
    listed = {"fields": ", ".join(others), "last": final}
    if near:
        return compose("service-unknown-field-resembles-one-of", field=near, **listed)
    return compose("service-unknown-field-besides", **listed)


def _find_similar(name: object, known: Iterable[str]) -> str | None:
    """Return the most similar of the known names."""
    near = get_close_matches(name, known, 1) if isinstance(name, str) and len(name) <= MAX_STEP else []
    return near[0] if near else None


def is_unknown_field(detail: str) -> bool:
    """Return whether a description that was composed in this process is that of an unknown field."""
    message = find_message(detail)
    return message is not None and message.id.startswith(_UNKNOWN_FIELD_PREFIX)


def explain_kind(kind: object, kinds: Iterable[str]) -> str:
    """Describe a missing or unknown kind of problem or type of mechanism, from the client or None, by similar ones."""
    listed = list(kinds)
    names = ", ".join(listed)
    if kind is None:
        return compose("service-kind-missing", names=names)
    name = str(kind)[:MAX_STEP].lower().replace("-", "_").replace(" ", "_")
    if any(part in name for part in _UNSUPPORTED_KIND_WORDS):
        return compose("service-kind-unsupported", page=LIMITS_PAGE, names=names)
    if near := get_close_matches(name, listed, 3, MIN_KIND_SIMILARITY):
        return compose("service-kind-resembles", near=", ".join(near), names=names)
    return compose("service-kind-unknown", names=names)


def _explain_fault(fault: Fault, models: Models) -> str:
    """Describe a fault of pydantic in a sentence."""
    type_, text = fault["type"], str(fault["msg"])
    if type_ == "unknown_kind":
        names = text.rpartition(": ")[2].split(", ")
        # A value of an unknown kind that is not an object cannot have a kind at all.
        if isinstance(fault["input"], dict):
            return explain_kind(fault["input"].get("kind"), names)
        return compose("service-object-expected")
    if type_ == "unknown_output":
        return compose("service-output-unknown", names=text.rpartition(": ")[2])
    if type_ in _SHAPE_IDS:
        part, *steps = fault["loc"]
        example = write_example(models.get(part), steps)
        plain, shaped = _SHAPE_IDS[type_]
        return compose(plain) if example is None else compose(shaped, example=example)
    if type_ in _TYPE_IDS:
        return compose(_TYPE_IDS[type_])
    known = _explain_by_context(fault, fault.get("ctx", {}))
    if known is None and type_ in _OWN_TYPES:
        known = make_sentence(text.removeprefix("Value error, ").removeprefix("Assertion failed, "))
    return compose("service-input-invalid") if known is None else known


def _explain_by_context(fault: Fault, context: Mapping[str, Any]) -> str | None:
    """Describe a fault of pydantic by the values in its context; return None for a type without a message."""
    type_ = fault["type"]
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
        case "union_tag_not_found":
            return compose("service-discriminator-missing", field=context["discriminator"])
        case "union_tag_invalid":
            # The tag is text from the client and is not repeated.
            field, names = context["discriminator"], context["expected_tags"]
            near = _find_similar(context["tag"], _read_names(names))
            if near:
                return compose("service-discriminator-resembles", field=field, near=f"'{near}'", names=names)
            return compose("service-discriminator-unknown", field=field, names=names)
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


def _explain_literals(faults: Sequence[Fault], models: Models) -> str:
    """Describe a value other than the permitted ones, which the members of a union may list in parts.

    A fault that is no literal is that of a list, which is permitted as well.
    """
    literal = [fault for fault in faults if fault["type"] == "literal_error"]
    # Pydantic lists the values as "'mm', 'cm' or 'in'".
    listed = [name for fault in literal for name in re.split(r", | or ", fault["ctx"]["expected"])]
    *others, last = dict.fromkeys(listed)
    near = _find_similar(literal[0]["input"], [name.strip("'") for name in (*others, last)])
    names = ", ".join(others)
    if len(literal) < len(faults):
        part, *steps = faults[-1]["loc"]
        example = write_example(models.get(part), steps) or "[...]"
        given = {"names": ", ".join((*others, last)), "example": example}
        if near is None:
            return compose("service-input-or-list", **given)
        return compose("service-input-or-list-resembles", near=f"'{near}'", **given)
    if not others:
        return compose("service-input-is", name=last)
    if near is None:
        return compose("service-input-one-of", names=names, last=last)
    return compose("service-input-resembles", near=f"'{near}'", names=names, last=last)


def _read_names(listed: str) -> list[str]:
    """Return the names in a list such as "'dwell', 'rise'"."""
    return re.findall(r"'([^']*)'", listed)


def _format_limit(limit: float) -> str:
    """Format a limit with all its digits and without an exponent.

    >>> _format_limit(1e9), _format_limit(1e-6), _format_limit(0.5)
    ('1000000000', '0.000001', '0.5')
    """
    return f"{Decimal(repr(limit)):f}".removesuffix(".0")
