"""``/v1/analyses``: what the analysis core knows of a given mechanism, at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Annotated, Any, ParamSpec

from fastapi import APIRouter, Body, Response
from fastapi.exceptions import RequestValidationError
from pydantic import BaseModel, ValidationError
from pydantic_core import to_json

from service.analyst import MAX_ANALYSIS_S, Analyst, Busy, TooLong
from service.api import errors
from service.api.body import JsonRoute
from service.api.errors import busy, compiling, invalid_mechanism, invalid_request
from service.api.state import Core
from service.explained import sentence
from service.telemetry import span

TAG = {"name": "analyses", "description": "Drive a given mechanism."}

# The models of an analysis bring the analysis core with them, for which the start of the service does not wait. So the
# body is validated where it is used, and the OpenAPI document gets the models when somebody asks for it.
REQUEST = {"$ref": "#/components/schemas/AnalysisRequest"}
ANALYSIS = {"$ref": "#/components/schemas/Analysis"}


P = ParamSpec("P")


router = APIRouter(prefix="/v1/analyses", tags=["analyses"], route_class=JsonRoute)


def analysis_responses(description: str, **described: str) -> dict[int | str, dict[str, Any]]:
    """The responses of an operation that answers with an analysis; errors as for :func:`errors.responses`."""
    return {
        200: {"description": description, "content": {"application/json": {"schema": ANALYSIS}}},
        **errors.responses(**described, e503="Other analyses have kept this one from being begun."),
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
async def analyse_mechanism(analyst: Core, body: Annotated[Any, Body()]) -> Response:
    """Positions, velocities, accelerations and jerks over the motion, toggles, circuits and limits.

    Nothing is stored. Where the mechanism cannot be assembled `valid` is false and the numbers are null.
    """
    return await answered(analyst, _analysed, body)


async def answered(analyst: Analyst, work: Callable[P, bytes], *args: P.args, **kwargs: P.kwargs) -> Response:
    """What an analysis gives, as the answer to a request.

    Raises
    ------
    Refusal
        422 or 503 when it is not there in time.
    """
    try:
        with span("analysis"):
            return Response(await analyst.call(work, *args, **kwargs), media_type="application/json")
    except TooLong:
        fault = ("/mechanism", f"The analysis was given up after {MAX_ANALYSIS_S:g} seconds; are all lengths meant so?")
        raise invalid_mechanism([fault]) from None
    except Busy:
        raise (busy("analyses") if analyst.loaded else compiling()) from None


def invalid_body(error: ValidationError, body: Any) -> RequestValidationError:
    """The refusal of a body that is validated where it is used."""
    faults = error.errors(include_url=False, include_context=False, include_input=False)
    return RequestValidationError([{**fault, "loc": ("body", *fault["loc"])} for fault in faults], body=body)


def _analysed(body: Any) -> bytes:
    from kinematics import errors as kinematics
    from synthesis.analyses import parse_request
    from synthesis.mechanisms import MechanismError

    try:
        request = parse_request(body)
    except ValidationError as error:
        raise invalid_body(error, body) from None
    contradictions = request.faults()
    if contradictions:
        raise invalid_request([(path, sentence(detail)) for path, detail in contradictions])
    try:
        answer = request.answer()
    except MechanismError as error:
        raise invalid_mechanism([(f"/mechanism{error.path}", sentence(error.detail))]) from None
    except kinematics.MechanismError as error:
        raise invalid_mechanism([("/mechanism", sentence(str(error)))]) from None
    return to_json(answer, inf_nan_mode="null")


def complete(document: dict[str, Any]) -> None:
    """Put the models of an analysis into the OpenAPI document."""
    from pydantic.json_schema import models_json_schema

    from synthesis.analyses import families
    from synthesis.model.dynamics import DesignForcesRequest

    requests, answers = zip(*families(), strict=True)
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
