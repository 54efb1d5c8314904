"""The types of mechanisms that a model with a field ``mechanism`` can hold: read from the model, told nowhere else."""

from __future__ import annotations

from typing import Any, get_args

from pydantic import BaseModel


def mechanism_types(model: type[BaseModel]) -> list[str]:
    """What the field ``type`` of its mechanism may be: of a design, or of a request for an analysis."""
    mechanisms = models_within(model.model_fields["mechanism"].annotation)
    return [name for mechanism in mechanisms for name in get_args(mechanism.model_fields["type"].annotation)]


def models_within(annotation: Any) -> list[type[BaseModel]]:
    """The models that a type is made of."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in get_args(annotation) for model in models_within(part)]
