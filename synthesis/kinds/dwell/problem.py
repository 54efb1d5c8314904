"""Dwells: a sixbar whose output rests, once or twice in a turn, while its crank turns on."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import ConfigDict, Discriminator, Field, Tag

from synthesis.model.dimension import ANGLE, OUTPUT
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import (
    ROUNDED_OFF,
    Contradiction,
    Count,
    Point,
    PositiveLength,
    PositiveNumber,
    Sizable,
    Statement,
)

DEFAULT_TOLERANCE = 0.01
"""How far the output may move during a dwell, as a share of its swing or stroke, where nothing is stated."""

DEFAULT_CRANK = 10.0
"""Length of the crank, in length units, where nothing gives the linkage a size."""


class RockerOutput(Statement):
    """The output swings about a fixed pivot."""

    type: Literal["rocker"] = "rocker"
    swing: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=180.0), Sizable] = Field(description="Degrees.")


class SliderOutput(Statement):
    """The output slides to and fro."""

    type: Literal["slider"]
    stroke: PositiveLength = Field(description="In length units.")


def _tag(statement: Any) -> str | None:
    kind = statement.get("type", "rocker") if isinstance(statement, dict) else getattr(statement, "type", None)
    return f"<{kind}>" if kind in ("rocker", "slider") else None


Output = Annotated[
    Annotated[RockerOutput, Tag("<rocker>")] | Annotated[SliderOutput, Tag("<slider>")],
    Discriminator(_tag, custom_error_type="unknown_output", custom_error_message="type must be one of: rocker, slider"),
]
"""The output of a dwell mechanism; the field ``type`` tells which, a rocker where it is left out."""


class DwellProblem(LinkageProblem):
    """Dwell: a sixbar whose output swings or slides by a stated way and rests at one end of it, or at both.

    A fourbar's coupler point goes along a circular arc, and a link of the arc's radius leaves the output at rest
    (`pseudo_arc`); or it goes along a straight line in a slot of the output (`straight_slot`). For two dwells there are
    two arcs of one radius, or two lines. Swing, dwells and accelerations are measured over the whole turn.
    """

    model_config = ConfigDict(
        title="Dwell",
        json_schema_extra={
            "examples": [
                {
                    "kind": "dwell",
                    "dwell_angle": 60.0,
                    "output": {"type": "rocker", "swing": 90.0},
                    "count": 1,
                    "mechanism": "pseudo_arc",
                    "max_designs": 3,
                },
                {
                    "kind": "dwell",
                    "dwell_angle": 40.0,
                    "output": {"type": "rocker", "swing": 50.0},
                    "count": 2,
                    "mechanism": "straight_slot",
                    "tolerance": 2.0,
                    "max_designs": 2,
                },
            ]
        },
    )

    kind: Literal["dwell"]
    dwell_angle: Annotated[float, ANGLE, Field(strict=True, gt=0.0, lt=360.0), Sizable] = Field(
        description="Rotation of the crank during a dwell, degrees; of each of two."
    )
    output: Output = Field(description="What the output is, and how far it goes.")
    count: Annotated[Count, Field(ge=1, le=2)] = Field(default=1, description="Dwells in a turn of the crank.")
    mechanism: Literal["auto", "pseudo_arc", "straight_slot"] = Field(
        default="auto", description="How the output is kept at rest; `auto` compares both for a rocker."
    )
    tolerance: Annotated[PositiveNumber, OUTPUT] | None = Field(
        default=None,
        description="Most that the output may move during a dwell: degrees, or length units of a slider. By default a "
        "hundredth of the swing or stroke.",
    )
    crank: PositiveLength | None = Field(
        default=None, description="Length of the crank of a linkage with a rocker, in length units; 10 by default."
    )
    pivot: Point | None = Field(
        default=None,
        description="Where the crank's fixed pivot lies. Left out it is (0, 0); where regions or limits of length want "
        "it, the linkage is put elsewhere, turned and, with a rocker and no `crank`, made larger or smaller.",
    )

    @property
    def way(self) -> float:
        """Swing, degrees, or stroke."""
        return self.output.swing if isinstance(self.output, RockerOutput) else self.output.stroke

    @property
    def allowed(self) -> float:
        """How far the output may move during a dwell, in units of the way."""
        return DEFAULT_TOLERANCE * self.way if self.tolerance is None else self.tolerance

    @property
    def slides(self) -> bool:
        """Whether the output is a slider."""
        return self.output.type == "slider"

    @property
    def types(self) -> tuple[Literal["pseudo_arc", "straight_slot"], ...]:
        """The types that are to be tried."""
        if self.mechanism != "auto":
            return (self.mechanism,)
        return ("pseudo_arc", "straight_slot") if self.output.type == "rocker" else ("pseudo_arc",)

    def contradictions(self) -> list[Contradiction]:
        """Demands that exclude one another."""
        found = list(self.contradicting_demands())
        if self.count * self.dwell_angle >= 360.0:
            detail = f"{self.count} dwells of {self.dwell_angle:g}° leave nothing of a turn to move in"
            found.append(Contradiction("/dwell_angle", detail))
        if self.output.type == "slider" and self.mechanism == "straight_slot":
            found.append(Contradiction("/mechanism", "a slotted output swings; take pseudo_arc or a rocker"))
        if self.output.type == "slider" and self.crank is not None:
            found.append(Contradiction("/crank", "the stroke gives the size; leave the crank out"))
        size, field = (
            (self.way, "/output/stroke") if self.output.type == "slider" else (self.crank or DEFAULT_CRANK, "/crank")
        )
        if self.pivot is not None and size < ROUNDED_OFF * max(map(abs, self.pivot)):
            found.append(Contradiction(field, "too short beside the coordinates of the pivot; move the origin nearer"))
        if self.tolerance is not None and self.tolerance >= self.way:
            found.append(Contradiction("/tolerance", "as far as the output goes; nothing would have to rest"))
        reason = "the crank turns through: only crank-rockers are searched"
        return [*found, *self.constraints.of_another_class(("crank_rocker",), reason)]
