"""What goes over the wire of batches."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import to_json

from service.api.http.schemas import Label, Progress, Timestamp
from service.jobs.batches.rows import BatchRow, BatchSummary
from service.jobs.store.states import Status
from synthesis.model.answer import optional_field
from synthesis.model.problem import MAX_MAGNITUDE, Number
from synthesis.registry import KINDS

MOST_SAMPLES = 10_000
MOST_VARIED = 20
MOST_METRICS = 50

Bound = Annotated[int, Field(strict=True, ge=-MAX_MAGNITUDE, le=MAX_MAGNITUDE)] | Number
"""A whole number stays one: some fields are counts."""

EXAMPLE: dict[str, Any] = {
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
    """A field of the problem, and what it is to be: one of `values`, or numbers `from` one `to` another."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, serialize_by_alias=True,
        json_schema_extra={
            "oneOf": [{"required": ["field", "values"]}, {"required": ["field", "from", "to"]}],
        },
    )  # fmt: skip

    field: Annotated[str, Field(strict=True, min_length=2, max_length=500, pattern="^(/([^~/]|~[01])*)+$")] = Field(
        description="JSON pointer into the problem. Objects that are not stated are made, elements of lists are not.",
        examples=["/positions/1/x"],
    )
    values: Annotated[list[Any], Field(min_length=1, max_length=MOST_SAMPLES)] | None = optional_field(
        "The values, of whatever type the field has."
    )
    from_: Bound | None = optional_field(
        "The first of evenly spaced numbers, or the lower end of a range.", alias="from"
    )
    to: Bound | None = optional_field("The last of them, or the upper end.")
    count: Annotated[int, Field(strict=True, ge=1, le=MOST_SAMPLES)] | None = optional_field(
        "How many: in a grid and in a zip. Whole numbers where the ends and all between are; a count of 1 is `from`."
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        ranged = self.from_ is not None and self.to is not None
        if ranged == (self.values is not None) or (self.values is not None and self.model_fields_set & _OF_RANGES):
            raise ValueError("give values, or from and to")
        return self


_OF_RANGES = {"from_", "to", "count"}


class BatchRequest(BaseModel):
    """A problem, the fields of it that are varied, and how."""

    model_config = ConfigDict(
        title="Batch request", extra="forbid", frozen=True, json_schema_extra={"examples": [EXAMPLE]}
    )

    problem: dict[str, Any] = Field(
        description="A problem as in a job; fields that are varied may be left out.",
        json_schema_extra={"examples": [EXAMPLE["problem"]]},
    )
    vary: Annotated[list[Vary], Field(min_length=1, max_length=MOST_VARIED)]
    sampling: Literal["grid", "latin_hypercube", "zip"] = Field(
        default="grid",
        description="`grid`: all combinations, the last field varying fastest; `zip`: the first values together, the "
        "second, and so on; `latin_hypercube`: `samples` draws, of which each equal part of a range, or each value of "
        "a list, gets its share.",
    )
    samples: Annotated[int, Field(strict=True, ge=1, le=MOST_SAMPLES)] | None = Field(
        default=None, description="How many problems: of a Latin hypercube only."
    )
    seed: Annotated[int, Field(strict=True, ge=0, le=2**53 - 1)] = Field(
        default=0, description="Of the draws of a Latin hypercube."
    )
    metrics: Annotated[list[str], Field(max_length=MOST_METRICS)] | None = Field(
        default=None,
        description="Metrics of the best design that the table shows. Left out: what a front weighs up by itself, as "
        "far as the kind has it.",
    )
    reuse: Annotated[bool, Field(strict=True)] = Field(
        default=True,
        description="Whether a problem that is equal to one which this version has solved before takes its answer.",
    )
    label: Label | None = None


class BatchListItem(BaseModel):
    """A batch in a list."""

    model_config = ConfigDict(title="Batch in a list")

    id: str = Field(description="A ULID.", examples=["01K6WM2B7Q3W9Z0V5N8XJ4R1TD"])
    kind: str = Field(examples=list(KINDS))
    label: str | None
    status: Status = Field(
        description="`succeeded`: all problems have been computed, whatever came of each; `failed`: none of them has "
        "an answer."
    )
    created_at: Timestamp
    started_at: Timestamp | None
    finished_at: Timestamp | None
    total: int = Field(description="Problems of the batch.")
    done: int = Field(description="Those that have ended: succeeded and failed ones.")
    succeeded: int
    failed: int
    cached: int = Field(description="Those among the succeeded ones whose answers were taken from equal problems.")
    progress: Progress


class Batch(BatchListItem):
    """A batch and what was stated."""

    model_config = ConfigDict(title="Batch")

    problem: dict[str, Any] = Field(description="As stated.")
    fields: list[str] = Field(description="The fields that are varied.")
    metrics: list[str]
    reuse: bool


class BatchList(BaseModel):
    """A page of batches, newest first."""

    model_config = ConfigDict(title="Batch list")

    batches: list[BatchListItem]
    next_cursor: str | None = Field(description="The cursor of the next page; null on the last one.")


class BatchTable(BaseModel):
    """A row for each problem."""

    model_config = ConfigDict(title="Table of a batch")

    columns: list[str] = Field(
        description="The varied fields, `status`, `cached`, `designs` (how many passed), the metrics of the best "
        "design, `job` (its id, once it has ended) and `failure` (why it failed)."
    )
    rows: list[list[Any]]


class BatchFront(BatchTable):
    """The rows that no other beats."""

    model_config = ConfigDict(title="Front of a batch")

    least: list[str]
    greatest: list[str]


def batch_item(batch: BatchSummary) -> dict[str, Any]:
    """A batch as :class:`BatchListItem`."""
    done = batch.done
    message = f"{done} of {batch.total}" if batch.status == Status.RUNNING else batch.status.value
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


def whole_batch(batch: BatchRow) -> bytes:
    """A batch as :class:`Batch`, in JSON: its item goes on with the members of what was stated."""
    return to_json(batch_item(batch))[:-1] + b"," + batch.stated.encode()[1:]
