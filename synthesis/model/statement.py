"""What every statement of a problem is made of, whatever its kind.

A statement can be well-formed and still contradict itself (two equal positions, more choices than there are
freedoms). Each kind lists such faults by field in ``contradictions``, so that a client is told where to look.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, model_validator

from synthesis.model.dimension import ANGLE, LENGTH, Measured

ABSURD = 1e9
"""Numbers beyond this are typing errors or attacks, never mechanisms; they are refused."""

ROUNDED_OFF = 1e-10
"""Lengths below this share of the coordinates that they lie at have lost most of their digits there."""

TINY = 1e-30
"""Numbers nearer to 0 are read as 0: they are what rounding has left of it, and a few of them multiplied are 0."""


def _sizable(number: Any) -> Any:
    return 0.0 if isinstance(number, float) and -TINY < number < TINY else number


Sizable = BeforeValidator(_sizable)
"""Of numbers that have bounds of their own: what is so near to 0 that it makes no difference is 0."""

Number = Annotated[float, Field(strict=True, ge=-ABSURD, le=ABSURD, allow_inf_nan=False), Sizable]
NonNegative = Annotated[float, Field(strict=True, ge=0.0, le=ABSURD, allow_inf_nan=False), Sizable]
PositiveNumber = Annotated[float, Field(strict=True, gt=0.0, le=ABSURD, allow_inf_nan=False), Sizable]
Flag = Annotated[bool, Field(strict=True)]
Count = Annotated[int, Field(strict=True)]
PositiveLength = Annotated[PositiveNumber, LENGTH]
Coordinate = Annotated[Number, LENGTH]
Degrees = Annotated[Number, ANGLE]
Point = Annotated[tuple[Number, Number], LENGTH]


class Contradiction(NamedTuple):
    """A fault of a well-formed statement: the field (JSON pointer below the problem) and what is wrong with it."""

    path: str
    detail: str


class ContradictionError(ValueError):
    """A problem that contradicts itself was given to a solver; carries the :class:`Contradiction`."""

    def __init__(self, contradiction: Contradiction) -> None:
        self.contradiction = contradiction
        super().__init__(f"{contradiction.path}: {contradiction.detail}")


class Statement(Measured):
    """Base of every model that a client writes: unknown fields are refused, values cannot change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Range(Statement):
    """Base of what has a least and a greatest value, `min` and `max`: equal to fix it, and one of them may be open."""

    @model_validator(mode="after")
    def _min_to_max(self) -> Self:
        least, most = getattr(self, "min", None), getattr(self, "max", None)
        if least is None and most is None:
            raise ValueError("give min, max or both")
        if least is not None and most is not None and least > most:
            raise ValueError("min must not be above max")
        return self


def _ordered(interval: tuple[float, float]) -> tuple[float, float]:
    if interval[0] >= interval[1]:
        raise ValueError("the lower end must be below the upper end")
    return interval


def _somewhere(point: tuple[float | None, float | None]) -> tuple[float | None, float | None]:
    if point == (None, None):
        raise ValueError("state one coordinate at least, or leave the point out")
    return point


PartialPoint = Annotated[tuple[Number | None, Number | None], LENGTH, AfterValidator(_somewhere)]
"""A point of which one coordinate may be left open (null)."""

Interval = Annotated[tuple[Number, Number], AfterValidator(_ordered)]


class StatedProblem(Statement):
    """Base of the problems: the fields that every kind has."""

    kind: str
    length_unit: Literal["mm", "cm", "m", "in"] = "mm"
    max_designs: Annotated[Count, Field(ge=1, le=200)] = 10
    include_failed: Flag = Field(default=False, description="Also return designs that break a check, after the others.")
    seed: Annotated[Count, Field(ge=0, le=2**53 - 1)] = 0

    @property
    def slides(self) -> bool:
        """Whether the output is a slider: what measures an output is a length then, otherwise an angle."""
        return False

    @property
    def force_units(self) -> Literal["si", "consistent"] | None:
        """What forces are in where the statement has units for them: N, N·m and W, or any consistent set."""
        return None

    @property
    def oscillating(self) -> bool:
        """Whether a displacement is that of an arm, in degrees, with rates in radians; otherwise it is a length."""
        return False

    def contradictions(self) -> list[Contradiction]:
        """Faults that no single field shows."""
        return []

    def require_consistent(self) -> None:
        """Raise the first contradiction, if there is one."""
        contradictions = self.contradictions()
        if contradictions:
            raise ContradictionError(contradictions[0])
