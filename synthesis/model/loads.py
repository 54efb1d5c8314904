"""Loads on a linkage as a client states them: forces at points of links and at joints, torques on links. Data alone.

Loads are a closed list of forms: constant, by a table over the input, against the motion, and gas pressure.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from synthesis.model.bodies import Name, Place
from synthesis.model.dimension import FORCE, TORQUE
from synthesis.model.statement import Count, Degrees, NonNegative, Number, PositiveLength, Statement

MOST_ROWS = 2000
"""Rows of a table at most."""

FULL_TURN = 360.0

Interpolation = Literal["linear", "periodic_cubic"]

Turns = Annotated[Count, Field(ge=1, le=100)]


def _ascending(rows: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    for n, (row, following) in enumerate(pairwise(rows)):
        if not row[0] < following[0]:
            raise ValueError(f"the first column must increase from row to row; row {n + 1} does not lie after row {n}")
    return rows


ForceRows = Annotated[
    list[tuple[Number, Number, Number]], Field(min_length=2, max_length=MOST_ROWS), AfterValidator(_ascending)
]
PairRows = Annotated[list[tuple[Number, Number]], Field(min_length=2, max_length=MOST_ROWS), AfterValidator(_ascending)]


CLOSES = 1e-9
"""Share of a table's largest value by which its first and last rows may differ and be one."""


def period_fault(rows: Sequence[tuple[float, ...]], period: float) -> str | None:
    """What is wrong with a table over an angle that repeats: longer than its period, or ends that contradict."""
    first, last = rows[0], rows[-1]
    span = last[0] - first[0]
    if span > period:
        return f"the rows span {span:g}°, more than the {period:g}° after which they repeat"
    apart = max(abs(end - start) for start, end in zip(first[1:], last[1:], strict=True))
    if span == period and apart > CLOSES * max(abs(value) for row in rows for value in row[1:]):
        return "the last row is the first one a cycle on, and must be equal to it"
    return None


class AgainstMotion(Statement):
    """A force (or torque) against the motion: its magnitude forward and backward; nothing at rest.

    Forward is along the direction of a slide on the ground that carries the joint, else as the input moves positively;
    of a link, counter-clockwise.
    """

    forward: NonNegative
    backward: NonNegative


class GasPressure(Statement):
    """Gas on a piston: gauge pressure times the area of the bore, from top dead centre towards the crank."""

    cycle: Literal[360, 720] = Field(default=360, description="Degrees of the crank; 720 of a four-stroke engine.")
    bore: PositiveLength = Field(description="Diameter.")
    pressure: PairRows = Field(
        description="Crank angle after top dead centre in the sense of rotation (°) and gauge pressure (Pa, or in the "
        "consistent units)."
    )
    interpolation: Interpolation = "linear"
    phase: Degrees = Field(
        default=0.0, description="Angle of the cycle at the top dead centre that lies in the first turn of the input."
    )


class _Course(Statement):
    """What a load may be over the input by a table; the strength itself is a field of each."""

    by: Literal["input_angle", "input_position"] = Field(
        default="input_angle",
        description="First column of the table: absolute input angle, degrees, or the place of the slide that drives.",
    )
    interpolation: Interpolation = Field(
        default="linear",
        description="Round the cycle; by the place of a slide `linear`, and as at its ends beyond them.",
    )
    turns: Turns | None = Field(
        default=None, description="Turns of the input after which a table repeats; by default as the mechanism does."
    )
    against_motion: AgainstMotion | None = None

    def _one_of(self, *forms: str) -> None:
        given = [name for name in forms if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of {', '.join(forms)}")
        stated = (self.by, self.interpolation, self.turns) != ("input_angle", "linear", None)
        if given != ["table"] and stated:
            raise ValueError("by, interpolation and turns are those of a table")


class ForceCourse(_Course):
    """What a force is over the motion."""

    constant: Annotated[tuple[Number, Number], FORCE] | None = None
    table: ForceRows | None = Field(default=None, description="Rows of the input and the force's x and y.")
    gas: GasPressure | None = None

    @model_validator(mode="after")
    def _form(self) -> Self:
        self._one_of("constant", "table", "against_motion", "gas")
        return self


class TorqueCourse(_Course):
    """What a torque is over the motion; counter-clockwise positive."""

    constant: Annotated[Number, TORQUE] | None = None
    table: PairRows | None = Field(default=None, description="Rows of the input and the torque.")

    @model_validator(mode="after")
    def _form(self) -> Self:
        self._one_of("constant", "table", "against_motion")
        return self


class StatedLoad(Statement):
    """A force at a `point` of a `link` or at a `joint`, or a torque on a `link`."""

    link: Name | None = None
    joint: Name | None = None
    point: Place | None = Field(default=None, description="Of the link, in the reference configuration.")
    frame: Literal["global", "link"] = Field(
        default="global",
        description="`link`: the force's components are those in the reference and turn with the link.",
    )
    force: ForceCourse | None = None
    torque: TorqueCourse | None = None

    @model_validator(mode="after")
    def _where(self) -> Self:
        if (self.link is None) == (self.joint is None):
            raise ValueError("a load acts on a link or on a joint; name one of them")
        if (self.force is None) == (self.torque is None):
            raise ValueError("a load is a force or a torque; give one of them")
        if self.torque is not None and self.link is None:
            raise ValueError("a torque acts on a link, not on a joint")
        if (self.point is not None) != (self.link is not None and self.force is not None):
            raise ValueError("a force on a link needs its point; a torque and a joint have none")
        if self.frame == "link" and self.point is None:
            raise ValueError("only a force on a link can turn with it")
        if self.force is not None and self.joint is None:
            for form in ("against_motion", "gas"):
                if getattr(self.force, form) is not None:
                    raise ValueError(f"a force by {form} acts on a joint")
        return self
