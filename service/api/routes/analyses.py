"""``/v1/analyses``: immediate analysis of a given mechanism."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any

from fastapi import APIRouter, Body, Request, Response
from pydantic import BaseModel

from service.answers.analysis import analyse
from service.api.http import problem_details
from service.api.http.auth import Tenant
from service.api.http.body import JsonRoute
from service.api.http.computation import respond_with_analysis
from service.api.http.dependencies import Answers
from synthesis.model.json_object import JsonObject

TAG = {"name": "analyses", "description": "Analyse a given mechanism."}

# Importing the models of an analysis loads the analysis core, for which the start of the service must not wait. So the
# body is validated where it is used, and the models are added to the OpenAPI document when it is first requested.
REQUEST = {"$ref": "#/components/schemas/AnalysisRequest"}
ANALYSIS = {"$ref": "#/components/schemas/Analysis"}

router = APIRouter(prefix="/v1/analyses", tags=["analyses"], route_class=JsonRoute)


def describe_analysis_responses(description: str, **described: str) -> dict[int | str, JsonObject]:
    """Return the responses of an operation that answers with an analysis, and its errors as for `responses`."""
    return {
        200: {"description": description, "content": {"application/json": {"schema": ANALYSIS}}},
        **problem_details.describe_responses(**described, e503="The service is busy with other analyses."),
    }


@router.post(
    "",
    operation_id="analyse",
    summary="Analyse a mechanism",
    response_class=Response,
    responses=describe_analysis_responses(
        "The analysis.",
        e400="The body is not JSON.",
        e413="The body is too large.",
        e415="The body is not `application/json`.",
        e422="The body is not a valid mechanism with a motion; `errors` has the places.",
    ),
)
async def analyse_mechanism(
    request: Request, answers: Answers, tenant: Tenant, body: Annotated[Any, Body()]
) -> Response:
    """Compute positions, velocities, accelerations and jerks over the motion, toggles, circuits and limits.

    Nothing is stored. Where the mechanism cannot be assembled, `valid` is false and the numbers are null.
    """
    return await respond_with_analysis(request, answers, tenant, analyse, body)


def complete(document: JsonObject) -> None:
    """Add the models of an analysis to the OpenAPI document."""
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
        AnalysisRequest=_build_union_schema("Analysis request", requests),
        Analysis=_build_union_schema("Analysis", answers),
    )
    content = document["paths"]["/v1/analyses"]["post"]["requestBody"]["content"]["application/json"]
    content["schema"] = REQUEST
    content["examples"] = {
        model.__name__: {"summary": model.model_config["title"], "value": model.get_example()} for model in requests
    }


def _build_union_schema(title: str, models: Iterable[type[BaseModel]]) -> JsonObject:
    return {"title": title, "anyOf": [{"$ref": f"#/components/schemas/{model.__name__}"} for model in models]}
