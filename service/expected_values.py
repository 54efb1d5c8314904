"""Expected form of the values of a request: the types at a place of its document, their fields, and an example."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from types import UnionType
from typing import Annotated, Any, Literal, TypeGuard, Union, get_args, get_origin

from pydantic import BaseModel

MAX_EXAMPLE_LENGTH = 160
"""Maximum length of an example in a message, characters; a longer one is omitted."""

MAX_EXAMPLE_DEPTH = 4
"""Maximum depth of an example; values below are omitted."""

_SAMPLES: tuple[tuple[type, object], ...] = ((bool, False), (int, 0), (float, 0), (str, "..."))
"""Values that stand for a type in an example."""


def list_known_fields(annotation: object, steps: Iterable[str | int]) -> list[str]:
    """Return the names in JSON of the fields that the object at a place may have.

    Parameters
    ----------
    annotation : type or annotation
        Type of the whole document.
    steps : iterable of str or int
        Place as in pydantic's errors: after each union, a step names the member that was tried.
    """
    models = [type_ for type_ in find_types(annotation, steps) if _is_model(type_)]
    return [field.alias or name for model in models for name, field in model.model_fields.items()]


def find_types(annotation: object, steps: Iterable[str | int]) -> list[object]:
    """Return the types that the value at a place may have; parameters are those of :func:`list_known_fields`."""
    types = _list_members(annotation)
    for step in steps:
        named = [type_ for type_ in types if len(types) > 1 and _is_named(type_, step)]
        below = [member for type_ in types for member in _list_types_below(type_, step)]
        # Validators of pydantic add steps that name neither a union member nor a field; such a step changes nothing.
        types = named or below or types
    return types


def write_example(annotation: object, steps: Iterable[str | int]) -> str | None:
    """Return an example of the object or list at a place as JSON, with the required fields of objects.

    Return None if the value is neither an object nor a list, or if the example would be long.

    >>> from synthesis.registry import KINDS
    >>> write_example(KINDS["motion"].problem, ["positions", 0])
    '{"x": 0, "y": 0, "angle": 0}'
    """
    for type_ in find_types(annotation, steps):
        if _is_model(type_) or get_origin(type_) in (list, tuple, dict, Sequence, Mapping):
            text = json.dumps(_build_sample(type_, MAX_EXAMPLE_DEPTH))
            return text if len(text) <= MAX_EXAMPLE_LENGTH else None
    return None


def _build_sample(annotation: object, depth: int) -> Any:
    """Build a value that has the form of a type; a list has one element."""
    type_ = next((member for member in _list_members(annotation) if member is not type(None)), None)
    arguments = get_args(type_)
    if get_origin(type_) is Literal:
        return arguments[0]
    if _is_model(type_):
        fields = [(field.alias or name, field) for name, field in type_.model_fields.items()]
        # A model without required fields is shown by its first one.
        shown = [pair for pair in fields if pair[1].is_required()] or fields[:1]
        return {name: _build_sample(field.annotation, depth - 1) for name, field in shown} if depth else {}
    if get_origin(type_) is tuple and depth:
        return [_build_sample(part, depth - 1) for part in arguments if part is not Ellipsis]
    if get_origin(type_) in (list, Sequence):
        return [_build_sample(arguments[0], depth - 1)] if depth else []
    if get_origin(type_) in (dict, Mapping):
        return {"name": _build_sample(arguments[1], depth - 1)} if depth else {}
    return next((value for basic, value in _SAMPLES if isinstance(type_, type) and issubclass(type_, basic)), 0)


def _is_model(type_: object) -> TypeGuard[type[BaseModel]]:
    return isinstance(type_, type) and issubclass(type_, BaseModel)


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
    if not _is_model(type_):
        return False
    tags = (type_.model_fields[name].annotation for name in ("kind", "type") if name in type_.model_fields)
    return str(step).strip("<>") == type_.__name__ or any(str(step).strip("<>") in get_args(tag) for tag in tags)


def _list_types_below(type_: object, step: str | int) -> list[object]:
    """Return the types of a field of a model, or of the elements of a list or a mapping."""
    if _is_model(type_):
        fields = (field for name, field in type_.model_fields.items() if step in (name, field.alias))
        return [member for field in fields for member in _list_members(field.annotation)]
    elements = get_args(type_)
    if isinstance(step, int) and get_origin(type_) in (list, tuple, Sequence):
        return [member for element in elements for member in _list_members(element)]
    if isinstance(step, str) and get_origin(type_) in (dict, Mapping):
        return _list_members(elements[1])
    return []
