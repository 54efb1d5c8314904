"""``/v1/problems``: what can be asked."""

from __future__ import annotations

import inspect
from functools import cache

from fastapi import APIRouter

from service.api.schemas import ProblemKind, ProblemKinds
from synthesis.problems import PROBLEM_KINDS, example

TAG = {"name": "problems", "description": "What can be asked."}

router = APIRouter(prefix="/v1/problems", tags=["problems"])


@router.get("", operation_id="list_problems", summary="List the kinds of problems")
async def list_problems() -> ProblemKinds:
    """Every kind of problem with its title, its JSON schema and an example that runs as it is."""
    return _kinds()


@cache
def _kinds() -> ProblemKinds:
    return ProblemKinds(
        problems=[
            ProblemKind(
                kind=kind,
                title=model.model_config.get("title") or kind,
                description=inspect.getdoc(model) or "",
                schema=model.model_json_schema(),
                example=example(kind),
            )
            for kind, model in PROBLEM_KINDS.items()
        ]
    )
