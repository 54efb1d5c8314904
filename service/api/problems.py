"""``/v1/problems``: what can be asked."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Any, get_args

from fastapi import APIRouter
from pydantic import BaseModel

from service.api.guard import GuardedRoute
from service.api.schemas import ProblemKind, ProblemKinds
from service.render import forms
from service.units import annotated
from synthesis.model.kind import Kind
from synthesis.registry import KINDS, example

TAG = {"name": "problems", "description": "What can be asked."}

router = APIRouter(prefix="/v1/problems", tags=["problems"], route_class=GuardedRoute)


@router.get("", operation_id="list_problems", summary="List the kinds of problems")
async def list_problems() -> ProblemKinds:
    """Every kind of problem with its title, its JSON schema and an example that runs as it is."""
    return _kinds()


@cache
def _kinds() -> ProblemKinds:
    return ProblemKinds(
        problems=[
            ProblemKind(
                kind=name,
                title=kind.problem.model_config.get("title") or name,
                description=inspect.getdoc(kind.problem) or "",
                schema=annotated(kind.problem.model_json_schema(), kind.problem.__name__),
                example=example(name),
                files={one: list(found) for one in _mechanisms(kind) if (found := forms(name, one))},
            )
            for name, kind in KINDS.items()
        ]
    )


def _mechanisms(kind: Kind[Any, Any]) -> list[str]:
    """The types of mechanisms that designs of a kind can have."""
    designs = _models(kind.result.model_fields["designs"].annotation)
    mechanisms = [one for design in designs for one in _models(design.model_fields["mechanism"].annotation)]
    return [name for one in mechanisms for name in get_args(one.model_fields["type"].annotation)]


def _models(annotation: Any) -> list[type[BaseModel]]:
    """The models that a type is made of."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for one in get_args(annotation) for model in _models(one)]
