"""Models of the loads on a linkage: forces at points of links and at joints, and torques on links.

A load has one of four forms: constant, given by a table over the input, against the motion, or gas pressure.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import FORCE, TORQUE
from synthesis.model.dynamics.bodies import Name, Place
from synthesis.model.problem import Count, Degrees, NonNegative, Number, PositiveLength, Statement

MAX_ROWS = 2000
"""Maximum number of rows of a table."""

FULL_TURN = 360.0

Interpolation = Literal["linear", "periodic_cubic"]

Turns = Annotated[Count, Field(ge=1, le=100)]


def _validate_ascending(rows: list[tuple[float, ...]]) -> list[tuple[float, ...]]:
    for n, (row, following) in enumerate(pairwise(rows)):
        if not row[0] < following[0]:
            raise ValueError(compose("model-rows-not-increasing", row=str(n + 1), previous=str(n)))
    return rows


ForceRows = Annotated[
    list[tuple[Number, Number, Number]], Field(min_length=2, max_length=MAX_ROWS), AfterValidator(_validate_ascending)
]
PairRows = Annotated[
    list[tuple[Number, Number]], Field(min_length=2, max_length=MAX_ROWS), AfterValidator(_validate_ascending)
]


CLOSURE_TOLERANCE = 1e-9
"""Maximum difference with which the first and the last row of a periodic table count as equal, as a share of the
largest value in the table."""


def find_period_error(rows: Sequence[tuple[float, ...]], period: float) -> str | None:
    """Return an error message if a periodic table exceeds its period or has contradictory ends; otherwise None."""
    first, last = rows[0], rows[-1]
    span = last[0] - first[0]
    if span > period:
        return compose("model-table-exceeds-period", span=f"{span:g}", period=f"{period:g}")
    apart = max(abs(end - start) for start, end in zip(first[1:], last[1:], strict=True))
    if span == period and apart > CLOSURE_TOLERANCE * max(abs(value) for row in rows for value in row[1:]):
        return compose("model-table-ends-differ")
    return None


class AgainstMotion(Statement):
    """A force or torque against the motion: magnitude for forward and for backward motion; 0 at rest.

    Forward is the direction of the ground slide that carries the joint; without such a slide it is the motion for a
    positive motion of the input. For a link, forward is counter-clockwise.
    """

    forward: NonNegative
    backward: NonNegative


class GasPressure(Statement):
    """Gas force on a piston: gauge pressure times the area of the bore, from top dead centre towards the crank."""

    cycle: Literal[360, 720] = Field(
        default=360, description="Cycle in degrees of the crank; 720 for a four-stroke engine."
    )
    bore: PositiveLength = Field(description="Diameter of the bore.")
    pressure: PairRows = Field(
        description="Crank angle after top dead centre in the sense of rotation (°) and gauge pressure (Pa, or in the "
        "consistent units)."
    )
    interpolation: Interpolation = "linear"
    phase: Degrees = Field(
        default=0.0, description="Angle of the cycle at the top dead centre within the first turn of the input."
    )


class _LoadCurve(Statement):
    """Common fields of loads over the input; the magnitudes are fields of the subclasses."""

    by: Literal["input_angle", "input_position"] = Field(
        default="input_angle",
        description="First column of the table: absolute input angle, degrees, or the position of the driving slide.",
    )
    interpolation: Interpolation = Field(
        default="linear",
        description="Interpolation of the table over the cycle. A table over a slide's position is `linear` and "
        "constant beyond its ends.",
    )
    turns: Turns | None = Field(
        default=None,
        description="Turns of the input after which a table repeats; by default the period of the mechanism.",
    )
    against_motion: AgainstMotion | None = None

    def _validate_form(self, *forms: str) -> None:
        given = [name for name in forms if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(compose("model-load-forms", fields=", ".join(forms)))
        stated = (self.by, self.interpolation, self.turns) != ("input_angle", "linear", None)
        if given != ["table"] and stated:
            raise ValueError(compose("model-table-fields-without-table"))


class ForceCurve(_LoadCurve):
    """Force over the motion: constant, table, against the motion, or gas pressure."""

    constant: Annotated[tuple[Number, Number], FORCE] | None = None
    table: ForceRows | None = Field(default=None, description="Rows of the input and the force's x and y.")
    gas: GasPressure | None = None

    @model_validator(mode="after")
    def _validate_strength(self) -> Self:
        self._validate_form("constant", "table", "against_motion", "gas")
        return self


class TorqueCurve(_LoadCurve):
    """Torque over the motion, counter-clockwise positive: constant, table, or against the motion."""

    constant: Annotated[Number, TORQUE] | None = None
    table: PairRows | None = Field(default=None, description="Rows of the input and the torque.")

    @model_validator(mode="after")
    def _validate_strength(self) -> Self:
        self._validate_form("constant", "table", "against_motion")
        return self


class LoadSpec(Statement):
    """A force at a `point` of a `link` or at a `joint`, or a torque on a `link`."""

    link: Name | None = None
    joint: Name | None = None
    point: Place | None = Field(default=None, description="Point of the link in the reference configuration.")
    frame: Literal["global", "link"] = Field(
        default="global",
        description="`link`: the force is given in the reference configuration and rotates with the link.",
    )
    force: ForceCurve | None = None
    torque: TorqueCurve | None = None

    @property
    def is_constant(self) -> bool:
        """Whether the force or torque is the same throughout the motion."""
        strength = self.force or self.torque
        return strength is not None and strength.constant is not None

    @model_validator(mode="after")
    def _validate_place(self) -> Self:
        if (self.link is None) == (self.joint is None):
            raise ValueError(compose("model-load-needs-place"))
        if (self.force is None) == (self.torque is None):
            raise ValueError(compose("model-load-needs-sort"))
        if self.torque is not None and self.link is None:
            raise ValueError(compose("model-torque-on-joint"))
        if (self.point is not None) != (self.link is not None and self.force is not None):
            raise ValueError(compose("model-load-point-misplaced"))
        if self.frame == "link" and self.point is None:
            raise ValueError(compose("model-load-frame-without-point"))
        if self.force is not None and self.joint is None:
            for form in ("against_motion", "gas"):
                if getattr(self.force, form) is not None:
                    raise ValueError(compose("model-force-needs-joint", form=form))
        return self
