"""Schemas of the API other than those of problems and results, which are the models of :mod:`synthesis`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Union

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import from_json, to_json

from kinematics.message import SOURCE_LANGUAGE, compose, get_language
from service.api.http.problem_details import ProblemDetails
from service.jobs.store.progress_message import read_progress
from service.jobs.store.schema import JobRow, JobSummary, SampleRow
from service.jobs.store.states import Status
from service.requests import fill_defaults
from synthesis.model.answer import Result, optional_field
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import Group
from synthesis.model.text_messages import translate_answer
from synthesis.registry import KINDS, Problem, get_first_example

if TYPE_CHECKING:
    AnyResult = Result[Any]
else:
    AnyResult = Union[tuple(kind.result for kind in KINDS.values())]  # noqa: UP007  (made of a list)
    """The answer to a problem of any kind; the job has the kind."""

Timestamp = Annotated[str, Field(json_schema_extra={"format": "date-time"}, examples=["2026-01-31T12:00:00.000000Z"])]


def _check_printable(label: str) -> str:
    if "\0" in label or any("\ud800" <= character <= "\udfff" for character in label):
        # PostgreSQL cannot store NUL, and UTF-8 cannot encode surrogates.
        raise ValueError(compose("service-label-unprintable"))
    return label


Label = Annotated[str, Field(strict=True, max_length=200), AfterValidator(_check_printable)]


class JobRequest(BaseModel):
    """A problem to solve, with an optional label for the job."""

    model_config = ConfigDict(
        title="Job request",
        extra="forbid",
        frozen=True,
        json_schema_extra={"examples": [{"problem": get_first_example(kind), "label": "first try"} for kind in KINDS]},
    )

    problem: Problem
    label: Label | None = None


class Progress(BaseModel):
    """Progress of a job."""

    fraction: float = Field(ge=0.0, le=1.0, description="Completed share of the work.")
    message: str = Field(description="Present step of the work.")


class JobListItem(BaseModel):
    """A job in a list: without its problem, result and error, which the job itself has."""

    model_config = ConfigDict(title="Job in a list")

    id: str = Field(description="ULID; ids sort by time of creation.", examples=["01K6WM2B7Q3W9Z0V5N8XJ4R1TD"])
    kind: str = Field(description="Kind of the problem.", examples=list(KINDS))
    label: str | None
    status: Status
    created_at: Timestamp
    started_at: Timestamp | None = Field(description="Start of the present attempt.")
    finished_at: Timestamp | None
    progress: Progress


class Job(JobListItem):
    """A job and its answer.

    ``succeeded`` means that the computation ended with a reliable answer, which may be that no design exists.
    """

    # The service sends jobs without validating them; its start would wait for the validator of all answers.
    model_config = ConfigDict(title="Job", defer_build=True)

    problem: Problem = Field(description="The problem with all defaults; posted again it counts as the same problem.")
    result: AnyResult | None = Field(description="Answer of a job that has succeeded.")
    error: ProblemDetails | None = Field(description="Reason why the job failed.")
    batch: str | None = optional_field("Id of the batch if the job is one of its problems; otherwise omitted.")
    cached: bool | None = optional_field(
        "Whether the answer to an equal problem was reused, if the job is a problem of a batch; otherwise omitted."
    )


class JobList(BaseModel):
    """A page of jobs, newest first."""

    model_config = ConfigDict(title="Job list")

    jobs: list[JobListItem]
    next_cursor: str | None = Field(description="Cursor of the next page; null on the last page.")


class ExampleName(BaseModel):
    """Name of an example of a kind of problem."""

    model_config = ConfigDict(title="Example name")

    name: str = Field(examples=["Hatch lid"])
    group: Group = Field(description="Field of application.")
    line: str = Field(description="Content of the example in a sentence.")


class ProblemKind(BaseModel):
    """A kind of problem that the service solves."""

    model_config = ConfigDict(title="Problem kind")

    kind: str = Field(examples=list(KINDS))
    title: str
    description: str
    schema_: JsonObject = Field(
        alias="schema",
        description="JSON schema of the problem. `x-dimension` gives the dimension of a number: a length in the "
        "problem's unit, an angle in degrees, ...; pure numbers have none.",
    )
    example: JsonObject = Field(description="A problem of this kind that can be posted as it is.")
    examples: list[ExampleName] = Field(
        description="Names of the `examples` of the schema, in the same order; the first one is `example`."
    )
    measures: dict[str, str] = Field(
        description="Dimensions of the numbers of its designs, by their names in `metrics` and `mechanism`: a length "
        "in the problem's unit, an angle in degrees, ...; pure numbers are omitted."
    )
    files: dict[str, list[str]] = Field(
        description="File formats of its designs by type of mechanism: drawings (svg, gif, dxf), a table (csv), and "
        "simulations (mjcf, urdf, mo, sim.py)."
    )


class ProblemKinds(BaseModel):
    """All kinds of problems."""

    model_config = ConfigDict(title="Problem kinds")

    problems: list[ProblemKind]
    solids: bool = Field(
        description="Whether parts of designs are also available as solids: printed, milled, as STEP and glTF. Without "
        "the extra `cad` only outlines are available."
    )
    parts: list[str] = Field(
        description="Types of mechanism whose designs are available as parts, in addition to those with a `skeleton`."
    )


class Health(BaseModel):
    """A sign of life."""

    status: str = Field(examples=["ok"])


class Kernels(BaseModel):
    """Progress of the compilation of numerical kernels, which each kind of problem needs.

    A job that arrives before its kernels are compiled compiles them itself and takes seconds longer.
    """

    compiled: int = Field(ge=0, description="Number of compiled parts.")
    total: int = Field(ge=0, description="Number of all parts.")


class Readiness(Health):
    """Readiness of the service."""

    kernels: Kernels | None = Field(description="Null while unknown, in the first second after the start.")


def describe_job(job: JobSummary) -> JsonObject:
    """Return a job as :class:`JobListItem`."""
    return {
        "id": job.id,
        "kind": job.kind,
        "label": job.label,
        "status": job.status.value,
        "created_at": job.created_at,
        "started_at": job.started_at,
        "finished_at": job.finished_at,
        "progress": describe_progress(job),
    }


def describe_progress(job: JobSummary) -> JsonObject:
    """Return the progress of a job as :class:`Progress`."""
    return {"fraction": job.progress_fraction, "message": read_progress(job.progress_message)}


def dump_job(job: JobRow) -> bytes:
    """Return a job as :class:`Job` in JSON. Result and error are stored in English and sent without parsing them."""
    problem = fill_defaults(job.kind, job.problem)
    result, error = (translate_stored(answer or "null") for answer in (job.result, job.error))
    stored = f'"problem":{problem},"result":{result},"error":{error}'
    if isinstance(job, SampleRow):
        stored += f',"batch":"{job.batch}","cached":{"true" if job.cached else "false"}'
    return to_json(describe_job(job))[:-1] + b"," + stored.encode() + b"}"


def translate_stored(answer: str) -> str:
    """Return a stored answer or error in the language of the request."""
    if get_language() == SOURCE_LANGUAGE:
        return answer
    read = from_json(answer)
    if read is None:
        return answer
    translate_answer(read, get_language())
    return to_json(read).decode()
