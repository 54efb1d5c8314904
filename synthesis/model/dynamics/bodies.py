"""Models of the masses of a linkage's links, given by mass properties or by shape."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from kinematics.message import compose
from synthesis.model.dimension import DENSITY, INERTIA, LENGTH, MASS
from synthesis.model.problem import Degrees, NonNegative, Point, PositiveLength, PositiveNumber, Statement

MAX_CORNERS = 500
"""Maximum number of corners of a polygon."""

Name = Annotated[str, Field(min_length=1, max_length=50)]

Material = Literal["steel", "aluminium", "PETG"]

_MISSING_SIZES = {"prism": "model-prism-needs-sizes", "cylinder": "model-cylinder-needs-diameter"}
"""Messages for a part without the sizes of its form."""

DENSITIES: dict[Material, float] = {"steel": 7850.0, "aluminium": 2700.0, "PETG": 1270.0}
"""Densities of materials, kg/m³."""


class PolarPoint(Statement):
    """A point of a link: distance from the link's first joint, and angle from the line to its second joint, degrees."""

    distance: Annotated[NonNegative, LENGTH]
    angle: Degrees = 0.0

    @property
    def vector(self) -> complex:
        """The point in the link's frame, complex, length units."""
        return cmath.rect(self.distance, math.radians(self.angle))


Place = Annotated[
    Annotated[Point, Tag("<point>")] | Annotated[PolarPoint, Tag("<polar>")],
    Discriminator(lambda stated: "<polar>" if isinstance(stated, dict | PolarPoint) else "<point>"),
]
"""A point of a link in the reference configuration, in coordinates of the plane or relative to the link's joints."""


class Part(Statement):
    """A prism or a (hollow) cylinder that is part of a link."""

    form: Literal["prism", "cylinder"]
    at: Place = Field(description="Centre of the part in the reference configuration.")
    length: PositiveLength = Field(description="Length of a prism in the plane, or of a cylinder along its axis.")
    width: PositiveLength | None = Field(default=None, description="Width of a prism in the plane.")
    thickness: PositiveLength | None = Field(default=None, description="Height of a prism, perpendicular to the plane.")
    diameter: PositiveLength | None = Field(default=None, description="Diameter of a cylinder.")
    bore: Annotated[NonNegative, LENGTH] = Field(default=0.0, description="Inner diameter of a cylinder.")
    axis: Literal["normal", "in_plane"] = Field(
        default="normal", description="Direction of a cylinder's axis: normal to the plane, or in it."
    )
    density: Annotated[PositiveNumber, DENSITY] | None = Field(
        default=None, description="Density of the part; by default that of the shape."
    )

    @model_validator(mode="after")
    def _validate_sizes(self) -> Self:
        needed = {"prism": ("width", "thickness"), "cylinder": ("diameter",)}
        for form, names in needed.items():
            for name in names:
                if (getattr(self, name) is None) == (form == self.form):
                    raise ValueError(compose(_MISSING_SIZES[self.form]))
        if self.bore > 0.0 and self.bore >= (self.diameter or 0.0):
            raise ValueError(compose("model-bore-without-cylinder"))
        return self


class Shape(Statement):
    """Shape of a link: a bar or the hull of its joints given by a `width`, a `polygon`, or `parts`.

    Without a polygon a link with two joints is a bar. A link with more joints is the convex hull of its joints, widened
    by half the width on all sides.
    """

    density: Annotated[PositiveNumber, DENSITY] | None = None
    material: Material | None = Field(
        default=None,
        description="Material, instead of a density; SI units only: steel 7850, aluminium 2700, PETG 1270 kg/m³.",
    )
    thickness: PositiveLength | None = Field(default=None, description="Thickness of the plate, not of parts.")
    width: PositiveLength | None = None
    ends: Literal["round", "square"] = Field(default="round", description="Ends of a bar with two joints.")
    overhang: Annotated[NonNegative, LENGTH] = Field(
        default=0.0, description="Length by which a bar with square ends extends beyond its joints."
    )
    polygon: list[Place] | None = Field(
        default=None,
        min_length=3,
        max_length=MAX_CORNERS,
        description="Corners of the plate in order, in the reference configuration.",
    )
    holes: dict[Name, PositiveLength] = Field(
        default={}, max_length=20, description="Diameters of holes by joint; each hole is removed from the plate."
    )
    parts: list[Part] = Field(default=[], max_length=50, description="Prisms and cylinders added to the plate.")

    @property
    def material_density(self) -> float:
        """Density of the shape or of its material."""
        return DENSITIES[self.material] if self.density is None and self.material is not None else self.density or 0.0

    @model_validator(mode="after")
    def _require_form(self) -> Self:
        if (self.density is None) == (self.material is None):
            raise ValueError(compose("model-density-or-material"))
        return self

    @model_validator(mode="after")
    def _validate_plate(self) -> Self:
        if self.width is not None and self.polygon is not None:
            raise ValueError(compose("model-width-and-polygon"))
        plate = self.width is not None or self.polygon is not None
        if not plate and not self.parts:
            raise ValueError(compose("model-shape-empty"))
        if plate != (self.thickness is not None):
            raise ValueError(compose("model-plate-needs-thickness"))
        if not plate and self.holes:
            raise ValueError(compose("model-holes-without-plate"))
        if self.ends == "square" and self.width is None:
            raise ValueError(compose("model-square-ends-without-width"))
        if self.overhang > 0.0 and self.ends != "square":
            raise ValueError(compose("model-overhang-without-square-ends"))
        return self


class LinkShape(Shape):
    """Shape of all links; if left out, `width` and `thickness` are those of the problem's `layout`."""

    @model_validator(mode="after")
    def _validate_plate(self) -> Self:
        """Postpone the validation of the plate until the layout is known: :meth:`fill_sizes`."""
        return self

    def fill_sizes(self, width: float | None, thickness: float | None) -> Shape:
        """Return the shape, with missing sizes taken from a layout (length units) if there is one.

        Raises
        ------
        pydantic.ValidationError
            If the result is not a valid shape.
        """
        stated = {name: value for name, value in self.model_dump(exclude_unset=True).items() if value is not None}
        if self.polygon is None and not self.parts and width is not None:
            stated.setdefault("width", width)
        if ("width" in stated or "polygon" in stated) and thickness is not None:
            stated.setdefault("thickness", thickness)
        return Shape.model_validate(stated)


class BodySpec(Statement):
    """Mass of a moving link: mass, centre of gravity and moment of inertia, or a shape from which they follow."""

    mass: Annotated[NonNegative, MASS] | None = None
    cg: Place | None = Field(default=None, description="Centre of gravity in the reference configuration.")
    inertia: Annotated[NonNegative, INERTIA] | None = Field(
        default=None, description="Moment of inertia about the centre of gravity."
    )
    shape: Shape | None = None

    @model_validator(mode="after")
    def _validate_form(self) -> Self:
        given: list[object] = [self.mass, self.cg, self.inertia]
        if self.shape is not None:
            if given != [None, None, None]:
                raise ValueError(compose("model-mass-and-shape"))
            return self
        if self.mass is None:
            raise ValueError(compose("model-mass-or-shape"))
        if self.mass > 0.0 and self.cg is None:
            raise ValueError(compose("model-mass-without-cg"))
        return self


class PointMass(Statement):
    """A mass at a joint, such as a piston."""

    joint: Name
    mass: Annotated[NonNegative, MASS]
