"""Motion generation: a linkage whose coupler carries a body through positions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import Literal

from pydantic import ConfigDict, Field

from synthesis.problems.base import Contradiction, Number, PartialPoint, Point, PositiveNumber, Statement
from synthesis.problems.linkage import LinkageProblem

LEAST_LENGTH = 1e-12
"""Positions that differ, but by less than this many length units, are refused as absurd."""

LEAST_MOTION = 1e-3
"""A motion of P below this share of the way to stated pivots does not set the size of the task."""

EQUAL_POSITIONS = 1e-9
"""Positions closer than this share of the coordinates' size, and this many radians, count as equal.

Double precision keeps about 1e-16 of the largest coordinate, so a displacement below 1e-9 of it has lost
half its digits and no residual of 1e-9 could be shown for it."""


PARALLEL = 1e-9
"""Component of a unit vector below which a line counts as parallel to an axis."""

ON_LINE = 1e-9
"""Share of the task's size by which a stated pivot may lie off a stated line: rounding."""


class Position(Statement):
    """Where the body is: its reference point P and the angle of a line fixed in it."""

    x: Number
    y: Number
    angle: Number = Field(description="Angle of the body's line, degrees, counter-clockwise from +x.")

    @property
    def point(self) -> complex:
        """The reference point as a complex number, in length units."""
        return complex(self.x, self.y)


def whole_point(point: PartialPoint | None) -> complex | None:
    """A stated point as a complex number; None where it, or one of its coordinates, is left open."""
    if point is None or point[0] is None or point[1] is None:
        return None
    return complex(point[0], point[1])


class GroundLine(Statement):
    """A straight line on which both fixed pivots lie."""

    point: Point
    angle: Number = Field(description="Direction of the line, degrees.")

    def offset(self, point: complex) -> float:
        """Signed distance of a point from the line, in length units."""
        return ((point - complex(*self.point)) * cmath.exp(-1j * math.radians(self.angle))).imag

    def foot(self, point: complex) -> complex:
        """The point of the line that is nearest to a point."""
        return point - 1j * cmath.rect(self.offset(point), math.radians(self.angle))


class CouplerVector(Statement):
    """Vector Z from the moving pivot to the body's point P in the first position; each part may be left open."""

    length: PositiveNumber | None = None
    angle: Number | None = Field(default=None, description="Angle of Z in the first position, degrees.")


class DyadChoices(Statement):
    """What the client fixes of one dyad (link and coupler side); all that is left out is searched.

    Norton's letters: ``link_angle`` is θ (output side: σ), ``coupler_vector`` is Z at φ (S at ψ), ``rotations``
    are β₂, β₃ (γ₂, γ₃).
    """

    fixed_pivot: PartialPoint | None = Field(default=None, description="null leaves a coordinate open.")
    moving_pivot: PartialPoint | None = Field(
        default=None, description="Moving pivot in the first position; null leaves a coordinate open."
    )
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
        pivots = [*(self.fixed_pivot or ()), *(self.moving_pivot or ())]
        scalars = [self.link_angle, vector.length, vector.angle, *(self.rotations or []), *pivots]
        return sum(s is not None for s in scalars)

    @property
    def one_pivot(self) -> bool:
        """Whether one whole pivot is all that is fixed."""
        pivots = whole_point(self.fixed_pivot), whole_point(self.moving_pivot)
        return self.count() == 2 and pivots.count(None) == 1


class MotionProblem(LinkageProblem):
    """Motion generation: a fourbar whose coupler carries a body through two to five positions.

    Each side of the linkage is a dyad: a link from a fixed pivot to a moving pivot on the body. n positions leave 5 − n
    free choices per dyad (Norton, Table 5-3). Choices that are not stated are searched, and the best distinct linkages
    are returned; for five positions there are six linkages at most, and all that are sound are returned.
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
    positions: list[Position] = Field(min_length=2, max_length=5)
    input_side: DyadChoices = DyadChoices()
    output_side: DyadChoices = DyadChoices()
    ground_line: GroundLine | None = Field(default=None, description="Both fixed pivots lie on this line.")
    method: Literal["auto", "exact"] = Field(default="auto", description="How positions are met: exactly.")

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
        first = self.positions[0]
        points = [] if self.ground_line is None else [self.ground_line.foot(first.point)]
        for side in (self.input_side, self.output_side):
            for pivot in (side.fixed_pivot, side.moving_pivot):
                if pivot is not None:
                    x, y = pivot
                    points.append(complex(first.x if x is None else x, first.y if y is None else y))
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
            *self._pivots_off_the_ground_line(),
            *self._pivots_outside_regions(),
            *self._impossible_class(),
        ]

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
            elif side.count() > free and not (len(self.positions) > 3 and side.one_pivot):
                found.append(
                    Contradiction(
                        f"/{name}",
                        f"states {side.count()} numbers, but {len(self.positions)} positions leave {free} free choices "
                        f"per side; leave some out{' or state one pivot' if len(self.positions) > 3 else ''}",
                    )
                )
            elif self.ground_line is not None and whole_point(side.fixed_pivot) is None and side.count() >= free:
                found.append(
                    Contradiction(
                        "/ground_line",
                        f"is one number more than the {free} free choices that {len(self.positions)} positions leave "
                        f"for {name}, which states {side.count()}",
                    )
                )
        return found

    def _pivots_outside_regions(self) -> list[Contradiction]:
        found = []
        for path, pivot in self._stated_pivots():
            region = getattr(self.constraints, f"{path.rsplit('/')[-1]}_region")
            # An open coordinate cannot lie outside: the region's own stands for it.
            if region is not None:
                x, y = (region.x[0] if pivot[0] is None else pivot[0]), (region.y[0] if pivot[1] is None else pivot[1])
                if not region.contains(complex(x, y)):
                    found.append(Contradiction(path, f"lies outside constraints.{path.rsplit('/')[-1]}_region"))
        return found

    def _stated_pivots(self) -> Iterator[tuple[str, PartialPoint]]:
        for name, side in (("input_side", self.input_side), ("output_side", self.output_side)):
            for field, pivot in (("fixed_pivot", side.fixed_pivot), ("moving_pivot", side.moving_pivot)):
                if pivot is not None:
                    yield f"/{name}/{field}", pivot

    def _pivots_off_the_ground_line(self) -> list[Contradiction]:
        line = self.ground_line
        if line is None:
            return []
        found = []
        along = cmath.rect(1.0, math.radians(line.angle))
        for path, pivot in self._stated_pivots():
            if path.endswith("/fixed_pivot"):
                whole = whole_point(pivot)
                parallel = abs(along.real if pivot[1] is None else along.imag) <= PARALLEL
                if whole is not None and abs(line.offset(whole)) > ON_LINE * self.task_size:
                    found.append(Contradiction(path, "does not lie on ground_line"))
                elif whole is None and parallel:
                    found.append(
                        Contradiction(path, "leaves open what ground_line leaves open; state the other coordinate")
                    )
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
            if whole_point(one) is not None and one == other:
                found.append(
                    Contradiction(
                        f"/output_side/{pivot}", f"equal to the input side's {pivot}; the link between is lost"
                    )
                )
        return found
