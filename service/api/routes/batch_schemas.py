"""Schemas of batches."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import to_json

from kinematics.message import compose
from service.api.http.schemas import Label, Progress, Timestamp
from service.jobs.batches.rows import BatchRow, BatchSummary
from service.jobs.store.states import Status
from synthesis.model.answer import optional_field
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import MAX_MAGNITUDE, Number
from synthesis.registry import KINDS

MAX_SAMPLES = 10_000
MAX_VARIED_FIELDS = 20
MAX_METRICS = 50

Bound = Annotated[int, Field(strict=True, ge=-MAX_MAGNITUDE, le=MAX_MAGNITUDE)] | Number
"""End of a range; an integer stays an integer, because some fields are counts."""

EXAMPLE: JsonObject = {
    "problem": {
        "kind": "motion",
        "positions": [
            {"x": 0.0, "y": 0.0, "angle": 0.0},
            {"x": 184.0, "y": -17.0, "angle": -45.0},
            {"x": 211.0, "y": -180.0, "angle": -90.0},
        ],
        "input_side": {"fixed_pivot": [86.0, -132.0]},
        "output_side": {"fixed_pivot": [104.0, -155.0]},
    },
    "vary": [
        {"field": "/positions/1/x", "from": 170, "to": 190, "count": 5},
        {"field": "/positions/1/angle", "values": [-50, -45, -40]},
    ],
    "metrics": ["min_transmission_angle", "size"],
}


class Vary(BaseModel):
    """A varied field of the problem: its `values`, or the range of numbers `from` one `to` another."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True,
        json_schema_extra={
            "oneOf": [{"required": ["field", "values"]}, {"required": ["field", "from", "to"]}],
        },
    )  # fmt: skip

    field: Annotated[str, Field(strict=True, min_length=2, max_length=500, pattern="^(/([^~/]|~[01])*)+$")] = Field(
        description="JSON pointer into the problem. Missing objects are created, missing list elements are not.",
        examples=["/positions/1/x"],
    )
    values: Annotated[list[Any], Field(min_length=1, max_length=MAX_SAMPLES)] | None = optional_field(
        "The values, of the type of the field."
    )
    from_: Bound | None = optional_field("First of evenly spaced numbers, or lower end of a range.", alias="from")
    to: Bound | None = optional_field("Last of these numbers, or upper end.")
    count: Annotated[int, Field(strict=True, ge=1, le=MAX_SAMPLES)] | None = optional_field(
        "Number of values in a grid or a zip. They are integers if all of them are whole; a single value is `from`."
    )

    @model_validator(mode="after")
    def _check_source(self) -> Self:
        ranged = self.from_ is not None and self.to is not None
        if ranged == (self.values is not None) or (self.values is not None and self.model_fields_set & _RANGE_FIELDS):
            raise ValueError(compose("service-values-or-range"))
        return self


_RANGE_FIELDS = {"from_", "to", "count"}


class BatchRequest(BaseModel):
    """A problem, its varied fields, and the sampling."""

    model_config = ConfigDict(
        title="Batch request", extra="forbid", frozen=True, json_schema_extra={"examples": [EXAMPLE]}
    )

    problem: JsonObject = Field(
        description="A problem as in a job; varied fields may be omitted.",
        json_schema_extra={"examples": [EXAMPLE["problem"]]},
    )
    vary: Annotated[list[Vary], Field(min_length=1, max_length=MAX_VARIED_FIELDS)]
    sampling: Literal["grid", "latin_hypercube", "zip"] = Field(
        default="grid",
        description="`grid`: all combinations, the last field varying fastest; `zip`: all first values together, then "
        "all second values, and so on; `latin_hypercube`: `samples` draws, one in each of `samples` equal parts of a "
        "range, or evenly distributed over a list.",
    )
    samples: Annotated[int, Field(strict=True, ge=1, le=MAX_SAMPLES)] | None = Field(
        default=None, description="Number of problems, for a Latin hypercube only."
    )
    seed: Annotated[int, Field(strict=True, ge=0, le=2**53 - 1)] = Field(
        default=0, description="Seed of the draws of a Latin hypercube."
    )
    metrics: Annotated[list[str], Field(max_length=MAX_METRICS)] | None = Field(
        default=None,
        description="Metrics of the best design that the table shows. By default those of the default front that the "
        "kind has.",
    )
    reuse: Annotated[bool, Field(strict=True)] = Field(
        default=True,
        description="Whether to reuse the answer to an equal problem that this version has solved before.",
    )
    label: Label | None = None


class BatchListItem(BaseModel):
    """A batch in a list."""

    model_config = ConfigDict(title="Batch in a list")

    id: str = Field(description="ULID.", examples=["01K6WM2B7Q3W9Z0V5N8XJ4R1TD"])
    kind: str = Field(examples=list(KINDS))
    label: str | None
    status: Status = Field(
        description="`succeeded`: all problems have ended, and at least one has an answer; `failed`: none has an "
        "answer."
    )
    created_at: Timestamp
    started_at: Timestamp | None
    finished_at: Timestamp | None
    total: int = Field(description="Number of problems.")
    done: int = Field(description="Number of problems that have ended, succeeded or failed.")
    succeeded: int
    failed: int
    cached: int = Field(description="Number of succeeded problems that reused the answer to an equal problem.")
    progress: Progress


class Batch(BatchListItem):
    """A batch and its request."""

    model_config = ConfigDict(title="Batch")

    problem: JsonObject = Field(description="The problem as posted.")
    fields: list[str] = Field(description="JSON pointers to the varied fields.")
    metrics: list[str]
    reuse: bool


class BatchList(BaseModel):
    """A page of batches, newest first."""

    model_config = ConfigDict(title="Batch list")

    batches: list[BatchListItem]
    next_cursor: str | None = Field(description="Cursor of the next page; null on the last page.")


class BatchTable(BaseModel):
    """Table with a row for each problem."""

    model_config = ConfigDict(title="Table of a batch")

    columns: list[str] = Field(
        description="The varied fields, `status`, `cached`, `designs` (number that passed), the metrics of the best "
        "design, `job` (id, once the problem has ended) and `failure` (reason of a failure)."
    )
    rows: list[list[object]]


class BatchFront(BatchTable):
    """The Pareto front: the rows that no other row dominates."""

    model_config = ConfigDict(title="Front of a batch")

    least: list[str]
    greatest: list[str]


def describe_batch(batch: BatchSummary) -> JsonObject:
    """Return a batch as :class:`BatchListItem`."""
    done = batch.ended_count
    message = batch.status.value
    if batch.status == Status.RUNNING:
        message = compose("service-batch-progress", done=done, total=batch.total)
    return {
        "id": batch.id,
        "kind": batch.kind,
        "label": batch.label,
        "status": batch.status.value,
        "created_at": batch.created_at,
        "started_at": batch.started_at,
        "finished_at": batch.finished_at,
        "total": batch.total,
        "done": done,
        "succeeded": batch.succeeded,
        "failed": batch.failed,
        "cached": batch.cached,
        "progress": {"fraction": done / batch.total, "message": message},
    }


def dump_batch(batch: BatchRow) -> bytes:
    """Return a batch as :class:`Batch` in JSON: the members of the list item, followed by those of the request."""
    return to_json(describe_batch(batch))[:-1] + b"," + batch.stated.encode()[1:]
