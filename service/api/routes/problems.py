"""``/v1/problems``: the kinds of problems."""

from __future__ import annotations

import inspect
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response
from pydantic import BaseModel

from kinematics.message import compose
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute
from service.api.http.cached_representation import pack
from service.api.http.dependencies import ApiDocuments
from service.api.http.metric_units import collect_measures
from service.api.http.problem_details import refuse_not_found
from service.api.http.schemas import ExampleName, ProblemKind, ProblemKinds
from service.parts.export.cad_available import is_installed
from service.parts.registry import LINKAGE_KEY, MAKERS
from service.render import FORMS_BY_TYPE, list_forms
from service.simulation.query import FORMS, TRAIN_TYPES
from synthesis.registry import KINDS, get_first_example

TAG = {"name": "problems", "description": "The kinds of problems that the service solves."}

_LIST = "problems"
"""Name of the document that lists all kinds."""

_HEADERS = {"Cache-Control": "private, no-cache"}
_ETAG = {"ETag": {"description": "Changes whenever the answer does.", "schema": {"type": "string"}}}

router = APIRouter(prefix="/v1/problems", tags=["problems"], route_class=GuardedRoute)


@router.get(
    "",
    operation_id="list_problems",
    summary="List the kinds of problems",
    response_class=Response,
    responses={
        200: {"model": ProblemKinds, "headers": _ETAG},
        304: {"description": "The list is unchanged since the version that the client has.", "headers": _ETAG},
    },
)
async def list_problems(
    request: Request,
    documents: ApiDocuments,
    if_none_match: Annotated[str | None, Header(description="`ETag` of the list that the client has.")] = None,
) -> Response:
    """Return every kind of problem with its title, its JSON schema, and examples that can be posted as they are."""
    return (await documents.find(_LIST)).respond(request, _HEADERS)


@router.get(
    "/{kind}",
    operation_id="get_problem_kind",
    summary="Read a kind of problem",
    response_class=Response,
    responses={
        200: {"model": ProblemKind, "headers": _ETAG},
        304: {"description": "The kind is unchanged since the version that the client has.", "headers": _ETAG},
        **problem_details.describe_responses(e404="There is no such kind of problem."),
    },
)
async def get_problem_kind(
    request: Request,
    documents: ApiDocuments,
    kind: str,
    if_none_match: Annotated[str | None, Header(description="`ETag` of the kind that the client has.")] = None,
) -> Response:
    """Return one kind of problem, as the list has it."""
    if kind not in KINDS:
        raise refuse_not_found(compose("service-problem-kind-unknown", kinds=", ".join(KINDS)))
    return (await documents.find(_name_document(kind))).respond(request, _HEADERS)


def pack_documents() -> dict[str, bytes]:
    """Return the list of all kinds and each kind by itself, packed, by the names of the documents."""
    kinds = ProblemKinds(
        solids=is_installed(),
        parts=sorted(MAKERS.keys() - {LINKAGE_KEY}),
        problems=[_describe_kind(name) for name in KINDS],
    )
    models: dict[str, BaseModel] = {_LIST: kinds, **{_name_document(kind.kind): kind for kind in kinds.problems}}
    return {name: pack(model.model_dump_json(by_alias=True).encode()) for name, model in models.items()}


def _name_document(kind: str) -> str:
    return f"{_LIST}-{kind}"


def _describe_kind(name: str) -> ProblemKind:
    kind = KINDS[name]
    return ProblemKind(
        kind=name,
        title=kind.problem.model_config.get("title") or name,
        description=inspect.getdoc(kind.problem) or "",
        schema=kind.problem.model_json_schema(),
        example=get_first_example(name),
        examples=[ExampleName(**named._asdict()) for named in kind.gallery],
        measures={of: str(measure) for of, measure in collect_measures(kind.result).items()},
        files={type_: offered for type_ in kind.mechanisms if (offered := _list_files(type_))},
    )


def _list_files(mechanism: str) -> list[str]:
    """Return the file formats of a type of mechanism: drawings, and simulations of linkages and gear trains."""
    simulated = mechanism in TRAIN_TYPES or mechanism not in FORMS_BY_TYPE
    return [*list_forms(mechanism), *(FORMS if simulated else ())]
