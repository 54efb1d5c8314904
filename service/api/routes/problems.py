"""``/v1/problems``: the kinds of problems."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Annotated

from fastapi import APIRouter, Header, Request, Response
from starlette.concurrency import run_in_threadpool

from service.api.http.auth import GuardedRoute
from service.api.http.cached_representation import Representation
from service.api.http.metric_units import collect_measures
from service.api.http.schemas import ExampleName, ProblemKind, ProblemKinds
from service.parts.export.cad_available import is_installed
from service.parts.registry import LINKAGE_KEY, MAKERS
from service.render import FORMS_BY_TYPE, list_forms
from service.simulation.query import FORMS, TRAIN_TYPES
from synthesis.registry import KINDS, get_first_example

TAG = {"name": "problems", "description": "The kinds of problems that the service solves."}

_ETAG = {"ETag": {"description": "Changes whenever the list does.", "schema": {"type": "string"}}}

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
    if_none_match: Annotated[str | None, Header(description="`ETag` of the list that the client has.")] = None,
) -> Response:
    """Return every kind of problem with its title, its JSON schema, and examples that can be posted as they are."""
    # In a thread, because building the schemas of all kinds takes two seconds the first time.
    kinds = await run_in_threadpool(_describe_kinds)
    return kinds.respond(request, {"Cache-Control": "private, no-cache"})


@cache
def _describe_kinds() -> Representation:
    kinds = ProblemKinds(
        solids=is_installed(),
        parts=sorted(MAKERS.keys() - {LINKAGE_KEY}),
        problems=[
            ProblemKind(
                kind=name,
                title=kind.problem.model_config.get("title") or name,
                description=inspect.getdoc(kind.problem) or "",
                schema=kind.problem.model_json_schema(),
                example=get_first_example(name),
                examples=[ExampleName(**named._asdict()) for named in kind.gallery],
                measures={of: str(measure) for of, measure in collect_measures(kind.result).items()},
                files={type_: offered for type_ in kind.mechanisms if (offered := _list_files(type_))},
            )
            for name, kind in KINDS.items()
        ],
    )
    return Representation(kinds.model_dump_json(by_alias=True).encode(), "application/json")


def _list_files(mechanism: str) -> list[str]:
    """Return the file formats of a type of mechanism: drawings, and simulations of linkages and gear trains."""
    simulated = mechanism in TRAIN_TYPES or mechanism not in FORMS_BY_TYPE
    return [*list_forms(mechanism), *(FORMS if simulated else ())]
