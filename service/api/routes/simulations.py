"""``/v1/jobs/{id}/designs/{n}.mjcf``, ``.urdf``, ``.mo`` and ``.sim.py``: a design as a simulation model."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.answers.simulations import open_in_pmks, simulate_design
from service.api.http import problem_details
from service.api.http.auth import GuardedRoute, Tenant
from service.api.http.computation import draw_in_turn
from service.api.http.dependencies import Answers, Desk
from service.api.routes.designs import OTHER_DRAWINGS, get_solved_job
from service.api.routes.jobs import TAG
from service.observability.telemetry import measure_span
from service.simulation.query import Form, SimulationQuery

router = APIRouter(prefix="/v1/jobs", tags=[TAG["name"]], route_class=GuardedRoute)


class Simulation(NamedTuple):
    """A format of simulation models, with its description in the API."""

    media_type: str
    operation_id: str
    summary: str
    description: str


_MOTION_NOTE = (
    " The model is in SI units: metres, kilograms, radians, seconds. A fully rotating input turns once at constant "
    "speed; any other input moves over the range of the verification. Masses are those of the problem's `dynamics`, or "
    "of plates. Linkages and gear trains have simulations."
)

SIMULATIONS: dict[Form, Simulation] = {
    "mjcf": Simulation(
        "application/xml",
        "export_design_mjcf",
        "Export a design to MuJoCo",
        "Return design ``number`` of the job's result as a MuJoCo model, with closed loops and a driven input."
        + _MOTION_NOTE,
    ),
    "urdf": Simulation(
        "application/xml",
        "export_design_urdf",
        "Export a design as URDF",
        "Return design ``number`` of the job's result as URDF, a tree whose loops are closed by SDF joints in the "
        "block `gazebo`." + _MOTION_NOTE,
    ),
    "mo": Simulation(
        "text/plain; charset=utf-8",
        "export_design_modelica",
        "Export a design to Modelica",
        "Return design ``number`` of the job's result as a model of Modelica.Mechanics.MultiBody." + _MOTION_NOTE,
    ),
    "sim.py": Simulation(
        "text/x-python; charset=utf-8",
        "export_design_script",
        "Export a design as a script that simulates it",
        "Return design ``number`` of the job's result as a Python script that runs it in MuJoCo and compares its joint "
        "angles with those of the analysis, which the script contains." + _MOTION_NOTE,
    ),
}


def _add_route(form: Form, export: Simulation) -> None:
    """Add the operation that returns the models of one format."""

    async def send_file(
        request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str,
        query: Annotated[SimulationQuery, Query()],
    ) -> Response:  # fmt: skip
        job = await get_solved_job(desk, tenant, job_id)
        with measure_span("simulation"):
            n, content = await draw_in_turn(request, answers, tenant, simulate_design, job, number, form, query)
        headers = {
            # A download: browsers must neither show nor execute it.
            "X-Content-Type-Options": "nosniff",
            "Content-Disposition": f'attachment; filename="{job.kind}-{n + 1}.{form}"',
        }
        return Response(content, media_type=export.media_type, headers=headers)

    router.add_api_route(
        f"/{{job_id}}/designs/{{number}}.{form}",
        send_file,
        operation_id=export.operation_id,
        summary=export.summary,
        description=export.description,
        response_class=Response,
        responses={
            200: {"description": "The file.", "content": {export.media_type: {"schema": {"type": "string"}}}},
            **problem_details.describe_responses(
                e404="No such job or design, or its type of mechanism has no simulation.",
                e409="The job has no result (yet), or the design cannot be simulated; `detail` has the reason.",
                e422="A parameter is not valid or does not fit the design; `errors` names it.",
                e503=OTHER_DRAWINGS,
            ),
        },
    )


for _form, _export in SIMULATIONS.items():
    _add_route(_form, _export)


class PmksModel(BaseModel):
    """A design for PMKS+, which stores a model in its URL."""

    model_config = ConfigDict(title="Model of PMKS+")

    url: str = Field(description="URL that opens the design in PMKS+. The service itself sends nothing there.")
    scale: float = Field(description="Length units of PMKS+ per unit of the design; the first joint is at the origin.")


@router.get(
    "/{job_id}/designs/{number}/pmks",
    operation_id="open_design_in_pmks",
    summary="Open a design in PMKS+",
    response_model=PmksModel,
    responses=problem_details.describe_responses(
        e404="No such job or design, or the design is not a linkage.",
        e409="The job has no result (yet), or PMKS+ cannot represent the design; `detail` has the reason.",
        e503=OTHER_DRAWINGS,
    ),
)
async def open_design_in_pmks(
    request: Request, desk: Desk, answers: Answers, tenant: Tenant, job_id: str, number: str
) -> PmksModel:
    """Return the URL at which PMKS+ (https://app.pmksplus.com) opens design ``number`` of the job's result.

    PMKS+ has pins and slides but no gears. It keeps three decimals of lengths, so the design is scaled by a power of
    ten. Masses are not included.
    """
    job = await get_solved_job(desk, tenant, job_id)
    url, scale = await draw_in_turn(request, answers, tenant, open_in_pmks, job, number)
    return PmksModel(url=url, scale=scale)
