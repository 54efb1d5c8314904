"""Models of the block ``dynamics`` of a statement: masses, loads, friction and speed (docs/mechanisms/dynamics.md)."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from kinematics.message import compose
from synthesis.model.dimension import GRAVITY, INERTIA, LENGTH, ROTATIONAL_SPEED
from synthesis.model.dynamics.bodies import BodySpec, LinkShape, Name, PointMass, Shape
from synthesis.model.dynamics.loads import LoadSpec
from synthesis.model.dynamics.springs import SpringSpec
from synthesis.model.layout import LayoutSizes
from synthesis.model.problem import Degrees, NonNegative, Number, Point, PositiveLength, Statement

LengthUnit = Literal["mm", "cm", "m", "in"]

METRES_PER_UNIT: dict[str, float] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
"""Metres per length unit."""


class Gravity(Statement):
    """Acceleration of gravity."""

    magnitude: Annotated[NonNegative, GRAVITY] = Field(
        default=9.80665, description="Magnitude, m/s² or in the consistent units."
    )
    angle: Degrees = Field(default=270.0, description="Direction of gravity, degrees.")

    @property
    def vector(self) -> complex:
        """Components x + iy of the acceleration."""
        return cmath.rect(self.magnitude, math.radians(self.angle))


class DrivenSlide(Statement):
    """The driving slide, by its number in the skeleton."""

    slide: Annotated[int, Field(strict=True, ge=0, le=9)]


Coefficient = Annotated[float, Field(strict=True, ge=0.0, le=1.5, allow_inf_nan=False)]


class PinFriction(Statement):
    """Coulomb friction at a pin: coefficient and radius."""

    mu: Coefficient
    radius: PositiveLength


class FrictionSpec(Statement):
    """Coulomb friction at pins by joint, and at slides by their number in the skeleton."""

    pins: dict[Name, PinFriction] = Field(default={}, max_length=40)
    slides: dict[Annotated[str, Field(pattern="^[0-9]$")], Coefficient] = Field(default={}, max_length=10)


MIN_COEFFICIENT = 1e-6
"""Minimum coefficient of fluctuation: smaller ones are unrealistic, and would vanish in the rounding of the speed."""


class FlywheelSpec(Statement):
    """Permitted fluctuation of speed for which to size a flywheel on the input shaft."""

    coefficient: Annotated[float, Field(strict=True, ge=MIN_COEFFICIENT, le=1.0, allow_inf_nan=False)] = Field(
        description="Maximum coefficient of fluctuation, (ω_max − ω_min)/ω_mean."
    )
    existing_inertia: Annotated[NonNegative, INERTIA] = Field(
        default=0.0, description="Moment of inertia that the shaft already has."
    )


ForceQuantity = Literal["drive_torque", "joint_force", "shaking_force", "shaking_moment", "power", "joint_force_index"]
"""Quantities of a linkage's forces that can be limited (docs/mechanisms/dynamics.md)."""

Reported = Literal["joint_forces", "drive", "shaking", "flywheel", "joint_force_index", "harmonics"]

ALWAYS_REPORTED: tuple[Reported, ...] = ("joint_forces", "drive", "shaking")
"""Results that are reported if the request does not list any."""


class LoadedLinkage(Statement):
    """Masses and loads of a linkage."""

    units: Literal["si", "consistent"] = Field(
        default="si",
        description="`si`: kg, N, N·m, kg·m², s; places, widths and diameters in the length unit. "
        "`consistent`: nothing is converted.",
    )
    gravity: Gravity | None = None
    bodies: dict[Name, BodySpec] = Field(default={}, max_length=20, description="Masses by moving link.")
    point_masses: list[PointMass] = Field(default=[], max_length=40)
    loads: list[LoadSpec] = Field(default=[], max_length=50)
    springs: list[SpringSpec] = Field(default=[], max_length=50, description="Springs and dampers between two links.")
    friction: FrictionSpec | None = None
    moment_about: Point | None = Field(
        default=None, description="Reference point of the shaking moment; by default the first fixed pivot."
    )

    @model_validator(mode="after")
    def _validate_materials(self) -> Self:
        if self.units != "si" and any(shape.material is not None for shape in self._list_shapes()):
            raise ValueError(compose("model-materials-need-si"))
        return self

    def _list_shapes(self) -> list[Shape | LinkShape]:
        return [stated.shape for stated in self.bodies.values() if stated.shape is not None]

    def scale(self, unit: LengthUnit) -> float:
        """Return the factor from the length unit to that of the forces: metres per length unit for SI, otherwise 1."""
        return METRES_PER_UNIT[unit] if self.units == "si" else 1.0


class DynamicsBlock(LoadedLinkage):
    """Masses and loads of a linkage, and the forces to report."""

    drive: Literal["torque"] | DrivenSlide | None = Field(
        default=None, description="The drive; it must agree with the input of the mechanism."
    )
    minimum_norm: bool = Field(
        default=False,
        strict=True,
        description="If redundant constraints make joint forces ambiguous, report the forces with the minimum sum of "
        "squares.",
    )
    flywheel: FlywheelSpec | None = Field(default=None, description="Size a flywheel on the input shaft.")
    report: list[Reported] | None = Field(
        default=None,
        min_length=1,
        max_length=6,
        description="Results to report; by default joint forces, drive, and shaking force and moment. "
        "`joint_force_index` refers to the first load.",
    )

    def is_reported(self, name: Reported) -> bool:
        """Return whether a part of the answer is requested."""
        stated = name in (ALWAYS_REPORTED if self.report is None else self.report)
        return stated or (name == "flywheel" and self.flywheel is not None)


class DesignDynamics(LoadedLinkage):
    """Masses and loads of every design of a problem, and its input speed."""

    links: LinkShape | None = Field(
        default=None,
        description="Shape of each moving link that `bodies` does not name. If left out, width and thickness are those "
        "of the problem's `layout`.",
    )
    speed_rpm: Annotated[Number, ROTATIONAL_SPEED] | None = Field(
        default=None, description="Speed of a rotating input, revolutions per minute."
    )
    speed: Annotated[Number, LENGTH] | None = Field(
        default=None, description="Speed of a sliding input, length units per second."
    )

    _plate: Shape | None = PrivateAttr(default=None)

    def _list_shapes(self) -> list[Shape | LinkShape]:
        return [*super()._list_shapes(), *([] if self.links is None else [self.links])]

    @property
    def plate(self) -> Shape | None:
        """Shape of the links with all sizes; None if there is no shape or a size is unknown."""
        return self._plate

    def fill_from_layout(self, layout: LayoutSizes | None) -> str | None:
        """Take missing sizes of the links from a layout; return an error message if one is still missing, else None."""
        if self.links is None:
            return None
        width, thickness = (None, None) if layout is None else (layout.link_width, layout.thickness)
        try:
            self._plate = self.links.fill_sizes(width, thickness)
        except ValidationError as error:
            reason = error.errors(include_url=False)[0]["msg"].removeprefix("Value error, ")
            return reason if layout is not None else compose("model-sizes-or-layout", reason=reason)
        return None

    @model_validator(mode="after")
    def _validate_sizes(self) -> Self:
        """Complete the shape of the links if all sizes are given; a layout may complete it later."""
        self.fill_from_layout(None)
        return self

    @model_validator(mode="after")
    def _validate_drive(self) -> Self:
        if self.speed_rpm is None and self.speed is None:
            raise ValueError(compose("model-speed-missing"))
        return self


class DesignForcesBlock(DesignDynamics, DynamicsBlock):
    """Masses and loads of one design, its input speed, and the forces to report."""


class DesignForcesRequest(Statement):
    """Request for the forces of one design."""

    dynamics: DesignForcesBlock
