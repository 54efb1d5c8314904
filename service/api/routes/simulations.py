"""``/v1/jobs/{id}/designs/{n}.mjcf``, ``.urdf``, ``.mo`` and ``.sim.py``: a design for programs that simulate it."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.answers.simulations import open_in_pmks, simulate_design
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.computation import draw_in_turn
from service.api.http.dependencies import Answers, Desk
from service.api.routes.designs import OTHER_DRAWINGS, solved_job
from service.api.routes.jobs import TAG
from service.observability.telemetry import span
from service.simulation.query import Form, SimulationQuery

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


class Simulation(NamedTuple):
    """A form of simulation, as the API describes it."""

    media_type: str
    operation_id: str
    summary: str
    description: str


_DRIVEN = (
    " SI units: metres, kilograms, radians, seconds. Its input turns once at constant speed where it turns through, "
    "and otherwise goes along the range that the design was verified along. Masses are those of the problem's "
    "`dynamics`, or of plates. Linkages and gear trains have simulations."
)

SIMULATIONS: dict[Form, Simulation] = {
    "mjcf": Simulation(
        "application/xml",
        "export_design_mjcf",
        "Export a design to MuJoCo",
        "Design ``number`` of the job's result as a model of MuJoCo, with its loops closed and its input driven."
        + _DRIVEN,
    ),
    "urdf": Simulation(
        "application/xml",
        "export_design_urdf",
        "Export a design as URDF",
        "Design ``number`` of the job's result as URDF: a tree; its loops are closed by joints of SDF in the block "
        "`gazebo`." + _DRIVEN,
    ),
    "mo": Simulation(
        "text/plain; charset=utf-8",
        "export_design_modelica",
        "Export a design to Modelica",
        "Design ``number`` of the job's result as a model of Modelica.Mechanics.MultiBody." + _DRIVEN,
    ),
    "sim.py": Simulation(
        "text/x-python; charset=utf-8",
        "export_design_script",
        "Export a design as a script that simulates it",
        "Design ``number`` of the job's result as a Python script that runs it in MuJoCo, and compares its joint "
        "angles with those of the analysis, which stand in it." + _DRIVEN,
    ),
}


def _offer(form: Form, export: Simulation) -> None:
    """Add the operation that gives the simulations of one form."""

    async def file(
        request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str,
        query: Annotated[SimulationQuery, Query()],
    ) -> Response:  # fmt: skip
        job = await solved_job(desk, tenant, job_id)
        with span("simulation"):
            n, content = await draw_in_turn(request, answers, tenant, simulate_design, job, number, form, query)
        headers = {
            "X-Content-Type-Options": "nosniff",
            "Content-Disposition": f'attachment; filename="{job.kind}-{n + 1}.{form}"',
        }
        return Response(content, media_type=export.media_type, headers=headers)

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}.{form}",
        file,
        operation_id=export.operation_id,
        summary=export.summary,
        description=export.description,
        response_class=Response,
        responses={
            200: {"description": "The file.", "content": {export.media_type: {"schema": {"type": "string"}}}},
            **problem_details.responses(
                e404="There is no such job or design, or no simulation of its type of mechanism.",
                e409="The job has no result (yet), or the design cannot be simulated; `detail` says why.",
                e422="A parameter is not valid, or does not fit the design; `errors` says which.",
                e503=OTHER_DRAWINGS,
            ),
        },
    )


for _form, _export in SIMULATIONS.items():
    _offer(_form, _export)


class PmksModel(BaseModel):
    """A design for PMKS+, whose models are in their addresses."""

    model_config = ConfigDict(title="Model of PMKS+")

    url: str = Field(description="Where PMKS+ opens it. Nothing is sent there but by who follows it.")
    scale: float = Field(description="PMKS+'s length units to one of the design; its first joint is at PMKS+'s origin.")


@router.get(
    "/{job_id}/designs/{number}/pmks",
    operation_id="open_design_in_pmks",
    summary="Open a design in PMKS+",
    response_model=PmksModel,
    responses=problem_details.responses(
        e404="There is no such job or design, or it is no linkage.",
        e409="The job has no result (yet), or PMKS+ cannot hold the design; `detail` says why.",
        e503=OTHER_DRAWINGS,
    ),
)
async def open_design_in_pmks(
    request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str
) -> PmksModel:
    """The address at which PMKS+ (https://app.pmksplus.com) opens design ``number`` of the job's result.

    PMKS+ has pins and slides and no gears. It keeps three decimals of lengths, so that the design is made larger or
    smaller by a power of ten; masses are not passed on.
    """
    job = await solved_job(desk, tenant, job_id)
    url, scale = await draw_in_turn(request, answers, tenant, open_in_pmks, job, number)
    return PmksModel(url=url, scale=scale)
