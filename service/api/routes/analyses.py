"""``/v1/analyses``: what the analysis core knows of a given mechanism, at once."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any

from fastapi import APIRouter, Body, Request, Response
from pydantic import BaseModel

from service.answers.analysis import analyse
from service.api.http import problem_details
from service.api.http.auth import Tenant
from service.api.http.body import JsonRoute
from service.api.http.computation import answer_with_analysis
from service.api.http.dependencies import Answers

TAG = {"name": "analyses", "description": "Drive a given mechanism."}

# The models of an analysis bring the analysis core with them, for which the start of the service does not wait. So the
# body is validated where it is used, and the OpenAPI document gets the models when somebody asks for it.
REQUEST = {"$ref": "#/components/schemas/AnalysisRequest"}
ANALYSIS = {"$ref": "#/components/schemas/Analysis"}

router = APIRouter(prefix="/v1/analyses", tags=["analyses"], route_class=JsonRoute)


def analysis_responses(description: str, **described: str) -> dict[int | str, dict[str, Any]]:
    """The responses of an operation that answers with an analysis; errors as for :func:`errors.responses`."""
    return {
        200: {"description": description, "content": {"application/json": {"schema": ANALYSIS}}},
        **problem_details.responses(**described, e503="Other analyses have kept this one from being begun."),
    }


@router.post(
    "",
    operation_id="analyse",
    summary="Analyse a mechanism",
    response_class=Response,
    responses=analysis_responses(
        "The analysis.",
        e400="The body is not JSON.",
        e413="The body is too large.",
        e415="The body is not `application/json`.",
        e422="The body does not state a mechanism and its motion; `errors` says where.",
    ),
)
async def analyse_mechanism(
    request: Request, answers: Answers, tenant: Tenant, body: Annotated[Any, Body()]
) -> Response:
    """Positions, velocities, accelerations and jerks over the motion, toggles, circuits and limits.

    Nothing is stored. Where the mechanism cannot be assembled `valid` is false and the numbers are null.
    """
    return await answer_with_analysis(request, answers, tenant, analyse, body)


def complete(document: dict[str, Any]) -> None:
    """Put the models of an analysis into the OpenAPI document."""
    from pydantic.json_schema import models_json_schema

    from synthesis.analyses import list_families
    from synthesis.model.dynamics.request import DesignForcesRequest

    requests, answers = zip(*list_families(), strict=True)
    _, schemas = models_json_schema(
        [
            *((model, "validation") for model in (*requests, DesignForcesRequest)),
            *((model, "serialization") for model in answers),
        ],
        ref_template="#/components/schemas/{model}",
    )
    document["components"]["schemas"].update(
        schemas["$defs"],
        AnalysisRequest=_any_of("Analysis request", requests),
        Analysis=_any_of("Analysis", answers),
    )
    content = document["paths"]["/v1/analyses"]["post"]["requestBody"]["content"]["application/json"]
    content["schema"] = REQUEST
    content["examples"] = {
        model.__name__: {"summary": model.model_config["title"], "value": model.model_json_schema()["examples"][0]}
        for model in requests
    }


def _any_of(title: str, models: Iterable[type[BaseModel]]) -> dict[str, Any]:
    return {"title": title, "anyOf": [{"$ref": f"#/components/schemas/{model.__name__}"} for model in models]}
