"""Springs and dampers of a linkage as a client states them. Data alone."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from synthesis.model.bodies import Name, Place
from synthesis.model.dimension import FORCE, LENGTH, STIFFNESS, TORSION_STIFFNESS
from synthesis.model.statement import Degrees, NonNegative, Number, Statement


class SpringEnd(Statement):
    """Where a spring holds: a point of a link, or of the `ground`."""

    link: Name
    point: Place = Field(description="In the reference configuration.")


class StatedSpring(Statement):
    """A spring, a damper or both: between two points by `ends`, or by a `torsion` rate between two `links`."""

    ends: tuple[SpringEnd, SpringEnd] | None = None
    rate: Annotated[NonNegative, STIFFNESS] = Field(default=0.0, description="N/m, or in the consistent units.")
    free_length: Annotated[NonNegative, LENGTH] = 0.0
    preload: Annotated[Number, FORCE] = Field(default=0.0, description="Tension at the free length.")
    one_sided: Literal["pull", "push"] | Literal[False] = Field(
        default=False, description="Bears tension only (`pull`) or compression only (`push`)."
    )
    torsion: Annotated[NonNegative, TORSION_STIFFNESS] | None = Field(
        default=None, description="Rate, N·m/rad, or in the consistent units."
    )
    links: tuple[Name, Name] | None = Field(default=None, description="Between which a torsion spring acts.")
    free_angle: Degrees = Field(
        default=0.0, description="Rotation of the second link against the first from the reference, without torque."
    )
    damping: NonNegative = Field(default=0.0, description="N·s/m, or N·m·s/rad of a torsion spring.")

    @model_validator(mode="after")
    def _one_form(self) -> Self:
        linear = {"ends", "rate", "free_length", "preload", "one_sided"} & self.model_fields_set
        turning = {"torsion", "links", "free_angle"} & self.model_fields_set
        if (self.ends is None) == (self.torsion is None):
            raise ValueError("give the ends of a spring, or the torsion rate and links of one that turns")
        if linear and turning:
            mixed = turning if self.torsion is None else linear
            raise ValueError(f"{', '.join(sorted(mixed))} is of the other sort of spring")
        if self.torsion is not None and self.links is None:
            raise ValueError("a torsion spring acts between two links")
        return self
