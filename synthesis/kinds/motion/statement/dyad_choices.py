"""Optional choices that fix parts of the linkage: numbers of its two dyads, a ground line, and a driver dyad."""

from __future__ import annotations

import cmath
import math
from typing import Literal

from pydantic import Field

from synthesis.model.linkage.problem import Region
from synthesis.model.problem import Degrees, PartialPoint, Point, PositiveLength, Statement


def to_complete_point(point: PartialPoint | None) -> complex | None:
    """Return a given point as a complex number; None if the point or one of its coordinates is open."""
    if point is None or point[0] is None or point[1] is None:
        return None
    return complex(point[0], point[1])


class GroundLine(Statement):
    """A straight line on which both fixed pivots lie."""

    point: Point
    angle: Degrees = Field(description="Direction of the line, degrees.")

    def offset(self, point: complex) -> float:
        """Return the signed distance of a point from the line, in length units (positive on its left)."""
        return ((point - complex(*self.point)) * cmath.exp(-1j * math.radians(self.angle))).imag

    def project_point(self, point: complex) -> complex:
        """Return the point of the line that is nearest to a given point."""
        return point - 1j * cmath.rect(self.offset(point), math.radians(self.angle))


class CouplerVector(Statement):
    """Vector Z from the moving pivot to the body's point P in the first position; length or angle may be left open."""

    length: PositiveLength | None = None
    angle: Degrees | None = Field(default=None, description="Angle of Z in the first position, degrees.")


class DyadChoices(Statement):
    """Given values of one dyad (link and coupler side); values that are left out are searched.

    Norton's letters: ``link_angle`` is θ (output side: σ), ``coupler_vector`` is Z at φ (S at ψ), ``rotations``
    are β₂, β₃ (γ₂, γ₃).
    """

    dyad: Literal["any", "RR", "PR", "RP"] = Field(
        default="any",
        description="Type of the joint between body and ground. RR: a link with two pins. PR: a pin of the body slides "
        "on a line of the ground. RP: a line of the body slides through a block that is pinned to the ground. any: "
        "RR, or a slider if no RR dyad is feasible.",
    )
    fixed_pivot: PartialPoint | None = Field(default=None, description="Fixed pivot; a coordinate may be left open.")
    moving_pivot: PartialPoint | None = Field(
        default=None, description="Moving pivot in the first position; a coordinate may be left open."
    )
    rotations: list[Degrees | None] | None = Field(
        default=None,
        min_length=1,
        max_length=8,
        description="Rotation of the link from the first position to the 2nd, 3rd, ..., degrees; any may be left open.",
    )
    link_angle: Degrees | None = Field(
        default=None, description="Angle of the link, fixed pivot to moving pivot, in the first position, degrees."
    )
    coupler_vector: CouplerVector | None = None
    slide_angle: Degrees | None = Field(
        default=None,
        description="For PR: angle of the slide's line, degrees. For RP: of the body's line in the first position.",
    )

    def count(self) -> int:
        """Return the number of fixed scalars."""
        vector = self.coupler_vector or CouplerVector()
        pivots = [*(self.fixed_pivot or ()), *(self.moving_pivot or ())]
        scalars = [self.link_angle, self.slide_angle, vector.length, vector.angle, *(self.rotations or []), *pivots]
        return sum(s is not None for s in scalars)

    @property
    def has_only_pivots(self) -> bool:
        """Whether only pivots, or coordinates of pivots, are fixed."""
        vector = self.coupler_vector
        whole = vector is None or (vector.length is not None and vector.angle is not None)
        return whole and self.link_angle is None and not any(b is not None for b in self.rotations or [])

    @property
    def has_partial_moving_pivot(self) -> bool:
        """Whether one coordinate of the moving pivot is fixed and the other is open."""
        return self.moving_pivot is not None and to_complete_point(self.moving_pivot) is None

    @property
    def is_one_pivot(self) -> bool:
        """Whether exactly one pivot, with both coordinates, is fixed and no other number."""
        pivots = to_complete_point(self.fixed_pivot), to_complete_point(self.moving_pivot)
        return self.count() == 2 and pivots.count(None) == 1


class DriverDyad(Statement):
    """A crank and a link added to drive the linkage between its end positions."""

    link: Literal["any", "input", "output", "coupler"] = Field(
        default="any",
        description="The link to drive. any: input or output, or the coupler if neither can be driven well.",
    )
    pivot_region: Region | None = Field(default=None, description="Region that must contain the crank's fixed pivot.")
