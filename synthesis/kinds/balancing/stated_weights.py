"""Counterweights as a client states them: on which links, and of what size."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from synthesis.model.bodies import Name
from synthesis.model.dimension import DENSITY, MASS
from synthesis.model.statement import PositiveLength, PositiveNumber, Statement


class Counterweights(Statement):
    """Which links may have a counterweight, and of what size they are.

    A weight of stated density and thickness is a disc; without these it is a point mass.
    """

    links: list[Name] | None = Field(
        default=None,
        min_length=1,
        max_length=20,
        description="Links that may have one; by default the fewest that serve, those on fixed pivots first.",
    )
    radius: PositiveLength | None = Field(
        default=None,
        description="Of each weight, from the fixed pivot of its link; the masses follow. By default the length of the "
        "link. On a link without one it is the greatest, from the link's first joint.",
    )
    mass: Annotated[PositiveNumber, MASS] | None = Field(default=None, description="Of each weight; the radii follow.")
    density: Annotated[PositiveNumber, DENSITY] | None = None
    thickness: PositiveLength | None = None

    @model_validator(mode="after")
    def _one_size(self) -> Self:
        if self.radius is not None and self.mass is not None:
            raise ValueError("give the radius or the mass; the other follows")
        if (self.density is None) != (self.thickness is None):
            raise ValueError("a disc has a density and a thickness; give both or none")
        if self.links is not None and len(set(self.links)) < len(self.links):
            raise ValueError("name each link once")
        return self

    def inertia(self, mass: float, scale: float) -> float:
        """Moment of inertia of a weight about its own centre; ``scale`` is the length unit in that of the forces."""
        if self.density is None or self.thickness is None:
            return 0.0
        return mass * mass / (2.0 * math.pi * self.density * scale * self.thickness)
