"""Types of mechanisms that the field ``mechanism`` of a model can contain, derived from its annotation."""

from __future__ import annotations

from typing import get_args

from pydantic import BaseModel


def list_mechanism_types(model: type[BaseModel]) -> list[str]:
    """Return the possible values of ``mechanism.type`` in a model of a design or of an analysis request."""
    mechanisms = collect_models(model.model_fields["mechanism"].annotation)
    return [name for mechanism in mechanisms for name in get_args(mechanism.model_fields["type"].annotation)]


def collect_models(annotation: object) -> list[type[BaseModel]]:
    """Return the models that occur in a type annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in collect_models(part)]
