"""Dimensions of the numbers in a design, by name, from which a client can determine their units."""

from __future__ import annotations

from collections.abc import Iterator
from typing import get_args

from pydantic import BaseModel

from synthesis.model.dimension import Dimension, collect_dimensions

MEASURED_FIELDS = ("metrics", "mechanism", "springs")
"""Fields of a design with numbers for people; only kinds that design springs have ``springs``."""


def collect_measures(result: type[BaseModel]) -> dict[str, Dimension]:
    """Return the dimension of each named number in the designs of an answer.

    A name with different dimensions in different places is omitted.

    Parameters
    ----------
    result : type of pydantic model
        Result model of a kind of problem, with the field ``designs``.
    """
    found: dict[str, set[Dimension]] = {}
    for design in _iterate_models(result.model_fields["designs"].annotation):
        for part in filter(design.model_fields.__contains__, MEASURED_FIELDS):
            for model in _collect_models(design.model_fields[part].annotation, set()):
                for name, dimension in collect_dimensions(model).items():
                    found.setdefault(name, set()).add(dimension)
    return {name: next(iter(of)) for name, of in sorted(found.items()) if len(of) == 1}


def _collect_models(annotation: object, seen: set[type[BaseModel]]) -> set[type[BaseModel]]:
    """Collect all models that a value may contain, at any depth."""
    for model in _iterate_models(annotation):
        if model not in seen:
            seen.add(model)
            for field in model.model_fields.values():
                _collect_models(field.annotation, seen)
    return seen


def _iterate_models(annotation: object) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for part in get_args(annotation):
        yield from _iterate_models(part)
