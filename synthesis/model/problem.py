"""Parts of the statement of every problem, for all kinds.

A statement can be well-formed and still contradict itself, for example by two equal positions, or by more choices than
degrees of freedom. Each kind lists such contradictions by field (:meth:`ProblemBase.find_contradictions`).
"""

from __future__ import annotations

from typing import Annotated, Literal, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import ANGLE, LENGTH, DimensionedModel

MAX_MAGNITUDE = 1e9
"""Maximum magnitude of a number; larger ones are typing errors or attacks and are refused."""

CANCELLATION_TOLERANCE = 1e-10
"""Share of the coordinates below which a length has lost most of its digits to cancellation."""

MIN_MAGNITUDE = 1e-30
"""Magnitude below which a number is read as 0. Such numbers are rounding noise, and products of a few underflow."""


def _flush_tiny(number: object) -> object:
    return 0.0 if isinstance(number, float) and -MIN_MAGNITUDE < number < MIN_MAGNITUDE else number


Sizable = BeforeValidator(_flush_tiny)
"""Validator that replaces negligible values by 0, for numbers with bounds of their own."""

Number = Annotated[float, Field(strict=True, ge=-MAX_MAGNITUDE, le=MAX_MAGNITUDE, allow_inf_nan=False), Sizable]
NonNegative = Annotated[float, Field(strict=True, ge=0.0, le=MAX_MAGNITUDE, allow_inf_nan=False), Sizable]
PositiveNumber = Annotated[float, Field(strict=True, gt=0.0, le=MAX_MAGNITUDE, allow_inf_nan=False), Sizable]
Flag = Annotated[bool, Field(strict=True)]
Count = Annotated[int, Field(strict=True)]
PositiveLength = Annotated[PositiveNumber, LENGTH]
Coordinate = Annotated[Number, LENGTH]
Degrees = Annotated[Number, ANGLE]
Point = Annotated[tuple[Number, Number], LENGTH]


class Contradiction(NamedTuple):
    """An error in a well-formed statement: the field (JSON pointer relative to the problem) and a message."""

    path: str
    detail: str


class ContradictionError(ValueError):
    """Raised if a problem to be solved contradicts itself; carries the :class:`Contradiction`."""

    def __init__(self, contradiction: Contradiction) -> None:
        self.contradiction = contradiction
        super().__init__(f"{contradiction.path}: {contradiction.detail}")


class Statement(DimensionedModel):
    """Base of every model that a client writes: unknown fields are refused, and values are immutable."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def find_changed_fields(self) -> set[str]:
        """Return the fields that have a value other than their default.

        ``model_fields_set`` does not suffice: a job shows its problem with all defaults, and a client may post that
        problem again.
        """
        fields = type(self).model_fields
        return {name for name in self.model_fields_set if getattr(self, name) != fields[name].default}


class Range(Statement):
    """Base of ranges with a minimum, `min`, and a maximum, `max`: equal values fix a number; one may be left out."""

    @model_validator(mode="after")
    def _validate_order(self) -> Self:
        least, most = getattr(self, "min", None), getattr(self, "max", None)
        if least is None and most is None:
            raise ValueError(compose("model-range-empty"))
        if least is not None and most is not None and least > most:
            raise ValueError(compose("model-min-above-max"))
        return self


def _validate_interval(interval: tuple[float, float]) -> tuple[float, float]:
    if interval[0] >= interval[1]:
        raise ValueError(compose("model-interval-reversed"))
    return interval


def _require_coordinate(point: tuple[float | None, float | None]) -> tuple[float | None, float | None]:
    if point == (None, None):
        raise ValueError(compose("model-point-without-coordinate"))
    return point


PartialPoint = Annotated[tuple[Number | None, Number | None], LENGTH, AfterValidator(_require_coordinate)]
"""A point of which one coordinate may be left open (null)."""

Interval = Annotated[tuple[Number, Number], AfterValidator(_validate_interval)]


class ProblemBase(Statement):
    """Base of the problems: the fields that every kind has."""

    kind: str
    length_unit: Literal["mm", "cm", "m", "in"] = "mm"
    max_designs: Annotated[Count, Field(ge=1, le=200)] = 10
    include_failed: Flag = Field(default=False, description="Also return designs that break a check, after the others.")
    seed: Annotated[Count, Field(ge=0, le=2**53 - 1)] = 0

    @property
    def slides(self) -> bool:
        """Whether the output is a slider, so that outputs are lengths; otherwise they are angles."""
        return False

    @property
    def force_units(self) -> Literal["si", "consistent"] | None:
        """Units of forces, if the statement has any: N, N·m and W, or any consistent set."""
        return None

    @property
    def is_oscillating(self) -> bool:
        """Whether displacements are angles of an arm, in degrees with rates in radians; otherwise they are lengths."""
        return False

    def find_contradictions(self) -> list[Contradiction]:
        """Return contradictions that the validation of single fields cannot find."""
        return []

    def require_consistent(self) -> None:
        """Raise the first contradiction, if there is one."""
        contradictions = self.find_contradictions()
        if contradictions:
            # The first contradiction suffices for an exception.
            raise ContradictionError(contradictions[0])
