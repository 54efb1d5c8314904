"""The block ``dynamics`` of a statement: masses and loads (docs/dynamics.md). Data alone."""

from __future__ import annotations

import cmath
import math
from typing import Annotated, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from synthesis.model.bodies import LinkShape, Name, PointMass, Shape, StatedBody
from synthesis.model.dimension import GRAVITY, INERTIA, LENGTH, ROTATIONAL_SPEED
from synthesis.model.layout import LayoutSizes
from synthesis.model.loads import StatedLoad
from synthesis.model.springs import StatedSpring
from synthesis.model.statement import Degrees, NonNegative, Number, Point, PositiveLength, Statement

LengthUnit = Literal["mm", "cm", "m", "in"]

METRES: dict[str, float] = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254}
"""Length units in metres."""


class Gravity(Statement):
    """Acceleration of gravity."""

    magnitude: Annotated[NonNegative, GRAVITY] = Field(default=9.80665, description="m/s², or in the consistent units.")
    angle: Degrees = Field(default=270.0, description="Direction in which it pulls.")

    @property
    def vector(self) -> complex:
        """Its components."""
        return cmath.rect(self.magnitude, math.radians(self.angle))


class DrivenSlide(Statement):
    """The slide that drives, by its number."""

    slide: Annotated[int, Field(strict=True, ge=0, le=9)]


Coefficient = Annotated[float, Field(strict=True, ge=0.0, le=1.5, allow_inf_nan=False)]


class PinFriction(Statement):
    """Coulomb friction at a pin: coefficient and radius."""

    mu: Coefficient
    radius: PositiveLength


class StatedFriction(Statement):
    """Coulomb friction at pins by joint, and at slides by their number in the skeleton."""

    pins: dict[Name, PinFriction] = Field(default={}, max_length=40)
    slides: dict[Annotated[str, Field(pattern="^[0-9]$")], Coefficient] = Field(default={}, max_length=10)


LEAST_COEFFICIENT = 1e-6
"""Coefficients of fluctuation below this are no shaft's: they would be lost in the rounding of its speed."""


class StatedFlywheel(Statement):
    """The fluctuation of speed that a flywheel on the input shaft is to leave."""

    coefficient: Annotated[float, Field(strict=True, ge=LEAST_COEFFICIENT, le=1.0, allow_inf_nan=False)] = Field(
        description="(ω_max − ω_min)/ω_mean."
    )
    existing_inertia: Annotated[NonNegative, INERTIA] = Field(
        default=0.0, description="Moment of inertia that the shaft has already."
    )


Reported = Literal["joint_forces", "drive", "shaking", "flywheel", "joint_force_index", "harmonics"]

ALWAYS: tuple[Reported, ...] = ("joint_forces", "drive", "shaking")
"""What is reported where a statement does not say."""


class WeighedLinkage(Statement):
    """What a linkage weighs and carries."""

    units: Literal["si", "consistent"] = Field(
        default="si",
        description="`si`: kg, N, N·m, kg·m², s; places, widths and diameters in the length unit. "
        "`consistent`: nothing is converted.",
    )
    gravity: Gravity | None = None
    bodies: dict[Name, StatedBody] = Field(default={}, max_length=20, description="By moving link.")
    point_masses: list[PointMass] = Field(default=[], max_length=40)
    loads: list[StatedLoad] = Field(default=[], max_length=50)
    springs: list[StatedSpring] = Field(default=[], max_length=50, description="Springs and dampers between two links.")
    friction: StatedFriction | None = None
    moment_about: Point | None = Field(
        default=None, description="Point about which the shaking moment is taken; by default the first fixed pivot."
    )

    @model_validator(mode="after")
    def _materials(self) -> Self:
        shapes = [*(stated.shape for stated in self.bodies.values()), getattr(self, "links", None)]
        if self.units != "si" and any(shape is not None and shape.material is not None for shape in shapes):
            raise ValueError("materials are in SI units; state densities in the consistent ones")
        return self

    def scale(self, unit: LengthUnit) -> float:
        """The length unit in the unit of forces over stiffnesses: metres, or as it is."""
        return METRES[unit] if self.units == "si" else 1.0


class DynamicsBlock(WeighedLinkage):
    """What a linkage weighs and carries, and which forces are wanted."""

    drive: Literal["torque"] | DrivenSlide | None = Field(
        default=None, description="What drives; it must be what the mechanism states."
    )
    minimum_norm: bool = Field(
        default=False,
        strict=True,
        description="Where constraints are redundant, and forces in joints not unique: give those of the least sum of "
        "squares.",
    )
    flywheel: StatedFlywheel | None = Field(default=None, description="Size a flywheel on the input shaft.")
    report: list[Reported] | None = Field(
        default=None,
        min_length=1,
        max_length=6,
        description="What is reported; by default forces in the joints, the drive and what shakes the frame. "
        "`joint_force_index` is that of the first of the loads.",
    )

    def reports(self, name: Reported) -> bool:
        """Whether a part of the answer is wanted."""
        stated = name in (ALWAYS if self.report is None else self.report)
        return stated or (name == "flywheel" and self.flywheel is not None)


class DesignDynamics(WeighedLinkage):
    """What every design of a problem weighs and carries, and how fast it is driven."""

    links: LinkShape | None = Field(
        default=None,
        description="The shape of each moving link that `bodies` does not name, whatever it is called. Width and "
        "thickness are those of the problem's `layout` where they are left out.",
    )
    speed_rpm: Annotated[Number, ROTATIONAL_SPEED] | None = Field(default=None, description="Of an input that turns.")
    speed: Annotated[Number, LENGTH] | None = Field(
        default=None, description="Of an input that slides, length units a second."
    )

    _plate: Shape | None = PrivateAttr(default=None)

    @property
    def plate(self) -> Shape | None:
        """The shape of the links with its sizes; None where there is none, or these are not known."""
        return self._plate

    def laid_out(self, layout: LayoutSizes | None) -> str | None:
        """Take sizes of links that are not stated from a layout; what is then missing, or None."""
        if self.links is None:
            return None
        width, thickness = (None, None) if layout is None else (layout.link_width, layout.thickness)
        try:
            self._plate = self.links.filled(width, thickness)
        except ValidationError as error:
            reason = error.errors(include_url=False)[0]["msg"].removeprefix("Value error, ")
            return reason if layout is not None else f"{reason}; or state a layout, whose plates they then are"
        return None

    @model_validator(mode="after")
    def _known_alone(self) -> Self:
        """Sizes that are all stated need no layout."""
        self.laid_out(None)
        return self

    @model_validator(mode="after")
    def _driven(self) -> Self:
        if self.speed_rpm is None and self.speed is None:
            raise ValueError("state speed_rpm, or speed where the input slides; 0 is statics")
        return self


class DesignForcesBlock(DesignDynamics, DynamicsBlock):
    """What one design weighs and carries, how fast it is driven, and which of its forces are wanted."""


class DesignForcesRequest(Statement):
    """A call for the forces of one design."""

    dynamics: DesignForcesBlock
