"""Requested counterweights: the permitted links and sizes."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import DENSITY, MASS
from synthesis.model.dynamics.bodies import Name
from synthesis.model.problem import NonNegative, PositiveLength, PositiveNumber, Statement


class ForceWeights(Statement):
    """Weight of each quantity in the objective, relative to its value without counterweights."""

    shaking_force: NonNegative = 0.0
    shaking_moment: NonNegative = 0.0
    drive: NonNegative = 0.0
    joint_forces: dict[Name, NonNegative] = Field(
        default={}, max_length=20, description="Weights of the joint forces, by joint."
    )
    norm: Literal["max", "rms"] = Field(
        default="max", description="Whether a quantity counts by its peak or its root mean square over the motion."
    )

    @model_validator(mode="after")
    def _validate_weights(self) -> Self:
        if not any([self.shaking_force, self.shaking_moment, self.drive, *self.joint_forces.values()]):
            raise ValueError(compose("balancing-objective-empty"))
        return self


class ForceCaps(Statement):
    """Maximum peak of each quantity, relative to its value without counterweights."""

    shaking_force: PositiveNumber | None = None
    shaking_moment: PositiveNumber | None = None
    drive: PositiveNumber | None = None
    joint_forces: dict[Name, PositiveNumber] = Field(
        default={}, max_length=20, description="Caps of the joint forces, by joint."
    )


class Counterweights(Statement):
    """Links that may have a counterweight, and the sizes of the counterweights.

    A weight with density and thickness is a disc; without these it is a point mass.
    """

    links: list[Name] | None = Field(
        default=None,
        min_length=1,
        max_length=20,
        description="Links that may have a counterweight; by default as few as possible, those on fixed pivots first.",
    )
    radius: PositiveLength | None = Field(
        default=None,
        description="Radius of each weight from the fixed pivot of its link; the masses follow. By default the length "
        "of "
        "the link. On a link without a fixed pivot: the maximum radius, from the link's first joint.",
    )
    mass: Annotated[PositiveNumber, MASS] | None = Field(
        default=None, description="Mass of each weight; the radii follow."
    )
    density: Annotated[PositiveNumber, DENSITY] | None = None
    thickness: PositiveLength | None = None
    reach: PositiveLength | None = Field(
        default=None,
        description="For goal minimize: maximum distance of a weight from its reference joint, by default the size of "
        "the linkage.",
    )
    max_mass: Annotated[PositiveNumber, MASS] | None = Field(
        default=None, description="For goal minimize: maximum mass of each weight."
    )
    total_mass: Annotated[PositiveNumber, MASS] | None = Field(
        default=None, description="For goal minimize: maximum total mass of all weights."
    )
    max_gyration: PositiveLength | None = Field(
        default=None,
        description="For goal minimize: maximum radius of gyration of a weight about its reference joint. Without it a "
        "weight may have any useful inertia, like a wide ring.",
    )
    max_disc_radius: PositiveLength | None = Field(
        default=None, description="For goal minimize: maximum radius of a disc."
    )

    @model_validator(mode="after")
    def _validate_size(self) -> Self:
        if self.radius is not None and self.mass is not None:
            raise ValueError(compose("balancing-radius-and-mass-given"))
        if (self.density is None) != (self.thickness is None):
            raise ValueError(compose("balancing-disc-size-incomplete"))
        if self.max_disc_radius is not None and self.density is None:
            raise ValueError(compose("balancing-disc-size-missing"))
        if self.links is not None and len(set(self.links)) < len(self.links):
            raise ValueError(compose("balancing-link-named-twice"))
        return self

    def compute_inertia(self, mass: float, scale: float) -> float:
        """Return the moment of inertia of a mass about its own centre.

        ``scale`` is the length unit, expressed in the length unit of the forces.
        """
        if self.density is None or self.thickness is None:
            return 0.0
        return mass * mass / (2.0 * math.pi * self.density * scale * self.thickness)
