"""Statements of problems: what a client asks for.

These pydantic models are the API schema, the stored form and the solver's input; nothing repeats them.
Angles are degrees and lengths are numbers in the problem's ``length_unit`` here and in :mod:`synthesis.designs`;
solvers and verification turn them into radians and complex numbers when they take a statement in.

A statement can be well-formed and still contradict itself (two equal positions, more choices than there are
freedoms). Each kind lists such faults by field in ``contradictions``, so that a client is told where to look.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, NamedTuple, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator

ABSURD = 1e9
"""Numbers beyond this are typing errors or attacks, never mechanisms; they are refused."""

LEAST_LENGTH = 1e-12
"""Positions that differ, but by less than this many length units, are refused as absurd."""

LEAST_MOTION = 1e-3
"""A motion of P below this share of the way to stated pivots does not set the size of the task."""

ON_EDGE = 1e-9
"""Points this share of a region's size outside it count as inside: they were meant to lie on its edge."""

EQUAL_POSITIONS = 1e-9
"""Positions closer than this share of the coordinates' size, and this many radians, count as equal.

Double precision keeps about 1e-16 of the largest coordinate, so a displacement below 1e-9 of it has lost
half its digits and no residual of 1e-9 could be shown for it."""

LEAST_MOTION = 1e-3
"""A motion of P below this share of the way to stated pivots does not set the size of the task."""

Number = Annotated[float, Field(strict=True, ge=-ABSURD, le=ABSURD, allow_inf_nan=False)]
PositiveNumber = Annotated[float, Field(strict=True, gt=0.0, le=ABSURD, allow_inf_nan=False)]
Flag = Annotated[bool, Field(strict=True)]
Count = Annotated[int, Field(strict=True)]
Point = tuple[Number, Number]


class Contradiction(NamedTuple):
    """A fault of a well-formed statement: the field (JSON pointer below the problem) and what is wrong with it."""

    path: str
    detail: str


class ContradictionError(ValueError):
    """A problem that contradicts itself was given to a solver; carries the :class:`Contradiction`."""

    def __init__(self, contradiction: Contradiction) -> None:
        self.contradiction = contradiction
        super().__init__(f"{contradiction.path}: {contradiction.detail}")


class Statement(BaseModel):
    """Base of every model that a client writes: unknown fields are refused, values cannot change."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _ordered(interval: tuple[float, float]) -> tuple[float, float]:
    if interval[0] >= interval[1]:
        raise ValueError("the lower end must be below the upper end")
    return interval


Interval = Annotated[tuple[Number, Number], AfterValidator(_ordered)]


class Position(Statement):
    """Where the body is: its reference point P and the angle of a line fixed in it."""

    x: Number
    y: Number
    angle: Number = Field(description="Angle of the body's line, degrees, counter-clockwise from +x.")

    @property
    def point(self) -> complex:
        """The reference point as a complex number, in length units."""
        return complex(self.x, self.y)


class Region(Statement):
    """A rectangle with sides along the axes, in length units."""

    x: Interval
    y: Interval

    def contains(self, point: complex) -> bool:
        """Whether a point lies in the region, its edges (to rounding) included."""
        (left, right), (low, high) = self.x, self.y
        slack = ON_EDGE * max(abs(left), abs(right), abs(low), abs(high))
        across = left - slack <= point.real <= right + slack
        return across and low - slack <= point.imag <= high + slack


class LengthLimits(Statement):
    """Shortest and longest link allowed, in length units."""

    min: Annotated[float, Field(strict=True, ge=0.0, le=ABSURD, allow_inf_nan=False)] = 0.0
    max: PositiveNumber | None = None

    @model_validator(mode="after")
    def _min_below_max(self) -> Self:
        if self.max is not None and self.min >= self.max:
            raise ValueError("min must be below max")
        return self


class CouplerVector(Statement):
    """Vector Z from the moving pivot to the body's point P in the first position; each part may be left open."""

    length: PositiveNumber | None = None
    angle: Number | None = Field(default=None, description="Angle of Z in the first position, degrees.")


class DyadChoices(Statement):
    """What the client fixes of one dyad (link and coupler side); all that is left out is searched.

    Norton's letters: ``link_angle`` is θ (output side: σ), ``coupler_vector`` is Z at φ (S at ψ), ``rotations``
    are β₂, β₃ (γ₂, γ₃).
    """

    fixed_pivot: Point | None = None
    moving_pivot: Point | None = Field(default=None, description="Moving pivot in the first position.")
    rotations: list[Number | None] | None = Field(
        default=None,
        min_length=1,
        max_length=8,
        description="Rotation of the link from the first position to the 2nd, 3rd, ..., degrees; null leaves one open.",
    )
    link_angle: Number | None = Field(
        default=None, description="Angle of the link, fixed pivot to moving pivot, in the first position, degrees."
    )
    coupler_vector: CouplerVector | None = None

    def count(self) -> int:
        """How many numbers are fixed."""
        vector = self.coupler_vector or CouplerVector()
        scalars = [self.link_angle, vector.length, vector.angle, *(self.rotations or [])]
        return (
            2 * (self.fixed_pivot is not None)
            + 2 * (self.moving_pivot is not None)
            + sum(s is not None for s in scalars)
        )


class Constraints(Statement):
    """What a usable linkage must satisfy; everything has a default that demands nothing beyond a sound motion."""

    min_transmission_angle: Annotated[float, Field(strict=True, ge=0.0, lt=90.0)] | None = Field(
        default=None, description="Least transmission angle over the used range of the input, degrees."
    )
    grashof: Literal["any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"] = "any"
    full_rotation: Flag = Field(default=False, description="The input link must be able to turn through.")
    same_branch: Flag = Field(default=True, description="No toggle position between the targets.")
    in_order: Flag = Field(default=True, description="The input, turning one way, visits the targets in order.")
    link_length: LengthLimits | None = None
    max_link_ratio: Annotated[float, Field(strict=True, ge=1.0, le=ABSURD)] | None = Field(
        default=None, description="Longest link over shortest link, at most."
    )
    fixed_pivot_region: Region | None = None
    moving_pivot_region: Region | None = Field(default=None, description="For the moving pivots in the first position.")


class LinkageProblem(Statement):
    """Fields that all linkage problems share."""

    length_unit: Literal["mm", "cm", "m", "in"] = "mm"
    constraints: Constraints = Constraints()
    rank_by: Literal["quality", "accuracy", "size", "transmission_angle"] = "quality"
    max_designs: Annotated[Count, Field(ge=1, le=200)] = 10
    include_failed: Flag = Field(default=False, description="Also return designs that break a check, after the others.")
    seed: Annotated[Count, Field(ge=0, le=2**53 - 1)] = 0


class MotionProblem(LinkageProblem):
    """Motion generation: a fourbar whose coupler carries a body through two or three positions.

    Each side of the linkage is a dyad: a link from a fixed pivot to a moving pivot on the body. Two positions leave
    three free choices per dyad, three positions leave two (Norton, Table 5-3). Choices that are not stated are
    searched, and the best distinct linkages are returned.
    """

    model_config = ConfigDict(
        title="Motion generation",
        json_schema_extra={
            "examples": [
                {
                    "kind": "motion",
                    "positions": [
                        {"x": 0.0, "y": 0.0, "angle": 0.0},
                        {"x": 40.0, "y": 15.0, "angle": -25.0},
                        {"x": 75.0, "y": 5.0, "angle": -60.0},
                    ],
                    "constraints": {"min_transmission_angle": 35.0},
                    "max_designs": 5,
                }
            ]
        },
    )

    kind: Literal["motion"]
    positions: list[Position] = Field(min_length=2, max_length=3)
    input_side: DyadChoices = DyadChoices()
    output_side: DyadChoices = DyadChoices()
    method: Literal["auto", "exact"] = Field(
        default="auto", description="How positions are met: exactly. Up to three positions can always be."
    )

    @property
    def task_size(self) -> float:
        """The length that tolerances and free choices are measured by, in length units.

        The greatest distance between two positions of P; where P moves by less than a thousandth of the way to the
        pivots and regions that the client stated, that way; where nothing is stated either, 1.
        """
        points = [position.point for position in self.positions]
        moved = max(abs(p - q) for p in points for q in points)
        reach = max((abs(z - points[0]) for z in self._stated_points()), default=0.0)
        return max(moved, 0.0 if moved >= LEAST_MOTION * reach else reach) or 1.0

    @property
    def turns(self) -> list[float]:
        """Rotation of the body from the first position to each, radians in [−π, π]."""
        first = self.positions[0].angle
        return [math.radians(math.remainder(position.angle - first, 360.0)) for position in self.positions]

    def _stated_points(self) -> list[complex]:
        stated = [
            pivot for side in (self.input_side, self.output_side) for pivot in (side.fixed_pivot, side.moving_pivot)
        ]
        points = [complex(*pivot) for pivot in stated if pivot is not None]
        for region in (self.constraints.fixed_pivot_region, self.constraints.moving_pivot_region):
            if region is not None:
                points += [complex(x, y) for x in region.x for y in region.y]
        return points

    def contradictions(self) -> list[Contradiction]:
        """Faults that no single field shows: equal positions, too many or colliding choices."""
        return [
            *self._equal_positions(),
            *self._overstated_sides(),
            *self._coinciding_pivots(),
            *self._pivots_outside_regions(),
            *self._impossible_class(),
        ]

    def require_consistent(self) -> None:
        """Raise the first contradiction, if there is one."""
        found = self.contradictions()
        if found:
            raise ContradictionError(found[0])

    def _equal_positions(self) -> list[Contradiction]:
        size = max(max(abs(p.x), abs(p.y)) for p in self.positions)
        moved = max(abs(p.point - q.point) for p in self.positions for q in self.positions)
        if 0.0 < moved < LEAST_LENGTH:
            return [
                Contradiction("/positions", f"less than {LEAST_LENGTH} {self.length_unit} apart; take a smaller unit")
            ]
        found = []
        for k, later in enumerate(self.positions):
            for j, earlier in enumerate(self.positions[:k]):
                turn = math.remainder(later.angle - earlier.angle, 360.0)
                near = abs(later.point - earlier.point) <= EQUAL_POSITIONS * size
                if near and abs(math.radians(turn)) <= EQUAL_POSITIONS:
                    found.append(Contradiction(f"/positions/{k}", f"equal to position {j}; positions must differ"))
        return found

    def _overstated_sides(self) -> list[Contradiction]:
        free = 5 - len(self.positions)
        found = []
        for name, side in (("input_side", self.input_side), ("output_side", self.output_side)):
            if side.rotations is not None and len(side.rotations) != len(self.positions) - 1:
                found.append(
                    Contradiction(
                        f"/{name}/rotations",
                        f"expected {len(self.positions) - 1} rotations (one for each later position), "
                        f"got {len(side.rotations)}",
                    )
                )
            if side.moving_pivot is not None and side.coupler_vector is not None:
                found.append(
                    Contradiction(
                        f"/{name}/coupler_vector", "moving_pivot already states the coupler vector; give one of them"
                    )
                )
            elif side.count() > free:
                found.append(
                    Contradiction(
                        f"/{name}",
                        f"states {side.count()} numbers, but {len(self.positions)} positions leave {free} free choices "
                        "per side; leave some out",
                    )
                )
        return found

    def _pivots_outside_regions(self) -> list[Contradiction]:
        found = []
        for pivot in ("fixed_pivot", "moving_pivot"):
            region = getattr(self.constraints, f"{pivot}_region")
            for name, side in (("input_side", self.input_side), ("output_side", self.output_side)):
                point = getattr(side, pivot)
                if region is not None and point is not None and not region.contains(complex(*point)):
                    found.append(Contradiction(f"/{name}/{pivot}", f"lies outside constraints.{pivot}_region"))
        return found

    def _impossible_class(self) -> list[Contradiction]:
        demanded = self.constraints
        if demanded.full_rotation and demanded.grashof in ("double_rocker", "non_grashof"):
            detail = f"the input of a {demanded.grashof} linkage does not turn through; drop one of the demands"
            return [Contradiction("/constraints/full_rotation", detail)]
        return []

    def _coinciding_pivots(self) -> list[Contradiction]:
        found = []
        for pivot in ("fixed_pivot", "moving_pivot"):
            one, other = getattr(self.input_side, pivot), getattr(self.output_side, pivot)
            if one is not None and one == other:
                found.append(
                    Contradiction(
                        f"/output_side/{pivot}", f"equal to the input side's {pivot}; the link between is lost"
                    )
                )
        return found


Problem = MotionProblem
"""Any problem; the field ``kind`` tells which."""

PROBLEM_KINDS: dict[str, type[MotionProblem]] = {"motion": MotionProblem}


def parse_problem(statement: dict[str, Any]) -> Problem:
    """The problem of a JSON-like statement; raises pydantic's ValidationError for an ill-formed one."""
    return MotionProblem.model_validate(statement)


def example(kind: str) -> dict[str, Any]:
    """The runnable example of a problem kind, as a client would post it."""
    schema_extra = PROBLEM_KINDS[kind].model_config["json_schema_extra"]
    assert isinstance(schema_extra, dict)
    examples = schema_extra["examples"]
    assert isinstance(examples, list)
    first = examples[0]
    assert isinstance(first, dict)
    return first
