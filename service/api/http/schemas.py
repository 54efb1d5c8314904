"""What goes over the wire besides problems and results, which are the models of :mod:`synthesis`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Union

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import to_json

from service.api.http.problem_details import ProblemDetails
from service.jobs.store.schema import JobRow, JobSummary, SampleRow
from service.jobs.store.states import Status
from service.requests import filled_in
from synthesis.model.answer import Result, optional_field
from synthesis.model.kind import Group
from synthesis.registry import KINDS, Problem, get_first_example

if TYPE_CHECKING:
    AnyResult = Result[Any]
else:
    AnyResult = Union[tuple(kind.result for kind in KINDS.values())]  # noqa: UP007  (made of a list)
    """The answer to any problem; which kind it is, the job tells."""

Timestamp = Annotated[str, Field(json_schema_extra={"format": "date-time"}, examples=["2026-01-31T12:00:00.000000Z"])]


def _printable(label: str) -> str:
    if "\0" in label or any("\ud800" <= character <= "\udfff" for character in label):
        raise ValueError("the label must not contain NUL or lone surrogates")
    return label


Label = Annotated[str, Field(strict=True, max_length=200), AfterValidator(_printable)]


class JobRequest(BaseModel):
    """A problem to solve, with an optional label to recognize the job by."""

    model_config = ConfigDict(
        title="Job request",
        extra="forbid",
        frozen=True,
        json_schema_extra={"examples": [{"problem": get_first_example(kind), "label": "first try"} for kind in KINDS]},
    )

    problem: Problem
    label: Label | None = None


class Progress(BaseModel):
    """How far a job is."""

    fraction: float = Field(ge=0.0, le=1.0, description="Share of the work that is done.")
    message: str = Field(description="What is being done.")


class JobListItem(BaseModel):
    """A job in a list: everything but its problem, its result and its error, which the job itself has."""

    model_config = ConfigDict(title="Job in a list")

    id: str = Field(description="A ULID; ids sort by time of creation.", examples=["01K6WM2B7Q3W9Z0V5N8XJ4R1TD"])
    kind: str = Field(description="The kind of the problem.", examples=list(KINDS))
    label: str | None
    status: Status
    created_at: Timestamp
    started_at: Timestamp | None = Field(description="When the present attempt began.")
    finished_at: Timestamp | None
    progress: Progress


class Job(JobListItem):
    """A job and its answer.

    ``succeeded`` means that the computation ended and its answer can be relied on; it may be that no design exists.
    """

    model_config = ConfigDict(title="Job")

    problem: Problem = Field(description="The problem as stated, defaults filled in; posted again it is the same one.")
    result: AnyResult | None = Field(description="The answer of a job that has succeeded.")
    error: ProblemDetails | None = Field(description="Why a job has failed.")
    batch: str | None = optional_field("Of a problem of a batch, the id of that; otherwise left out.")
    cached: bool | None = optional_field(
        "Of a problem of a batch: an equal problem had been answered; otherwise left out."
    )


class JobList(BaseModel):
    """A page of jobs, newest first."""

    model_config = ConfigDict(title="Job list")

    jobs: list[JobListItem]
    next_cursor: str | None = Field(description="The cursor of the next page; null on the last one.")


class ExampleName(BaseModel):
    """An example of a kind of problem, as a person looks for it."""

    model_config = ConfigDict(title="Example name")

    name: str = Field(examples=["Hatch lid"])
    group: Group = Field(description="What it is for.")
    line: str = Field(description="What it shows, in a sentence.")


class ProblemKind(BaseModel):
    """A kind of problem that the service solves."""

    model_config = ConfigDict(title="Problem kind")

    kind: str = Field(examples=list(KINDS))
    title: str
    description: str
    schema_: dict[str, Any] = Field(
        alias="schema",
        description="JSON schema of the problem. `x-dimension` says what a number measures: a length in the problem's "
        "unit, an angle in degrees, ...; pure numbers have none.",
    )
    example: dict[str, Any] = Field(description="A problem of this kind that runs as it is.")
    examples: list[ExampleName] = Field(
        description="What the `examples` of the schema are, in their order; the first of them is `example`."
    )
    measures: dict[str, str] = Field(
        description="What the numbers of its designs measure, by their names in `metrics` and `mechanism`: a length in "
        "the problem's unit, an angle in degrees, ...; pure numbers are not in it."
    )
    files: dict[str, list[str]] = Field(
        description="By the type of mechanism, the files that there are of its designs: drawings (svg, gif, dxf), a "
        "table (csv), and simulations (mjcf, urdf, mo, sim.py)."
    )


class ProblemKinds(BaseModel):
    """All kinds of problems."""

    model_config = ConfigDict(title="Problem kinds")

    problems: list[ProblemKind]
    solids: bool = Field(
        description="Whether parts of designs are had as solids too: printed, milled, as STEP and glTF. Without the "
        "extra `cad` there are outlines alone."
    )
    parts: list[str] = Field(
        description="Types of mechanism, beside those that have a `skeleton`, whose designs are had as parts."
    )


class Health(BaseModel):
    """A sign of life."""

    status: str = Field(examples=["ok"])


class Kernels(BaseModel):
    """How far the compilation of numeric kernels is, which each kind of problem has some of.

    A job that comes before its kernels are compiled compiles them itself, and takes seconds longer.
    """

    compiled: int = Field(ge=0, description="Parts that are compiled.")
    total: int = Field(ge=0, description="All parts that there are.")


class Readiness(Health):
    """What the service is ready for."""

    kernels: Kernels | None = Field(description="Null as long as it is not known, a second after the start.")


def list_item(job: JobSummary) -> dict[str, Any]:
    """A job as :class:`JobListItem`."""
    return {
        "id": job.id,
        "kind": job.kind,
        "label": job.label,
        "status": job.status.value,
        "created_at": job.created_at,
        "started_at": job.started_at,
        "finished_at": job.finished_at,
        "progress": progress(job),
    }


def progress(job: JobSummary) -> dict[str, Any]:
    """How far a job is, as :class:`Progress`."""
    return {"fraction": job.progress_fraction, "message": job.progress_message}


def whole_job(job: JobRow) -> bytes:
    """A job as :class:`Job`, in JSON; result and error go out as the models wrote them into the store."""
    stored = (
        f'"problem":{filled_in(job.kind, job.problem)},"result":{job.result or "null"},"error":{job.error or "null"}'
    )
    if isinstance(job, SampleRow):
        stored += f',"batch":"{job.batch}","cached":{"true" if job.cached else "false"}'
    return to_json(list_item(job))[:-1] + b"," + stored.encode() + b"}"
