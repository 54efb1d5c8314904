"""Models of the springs and dampers of a linkage."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from kinematics.message import compose
from synthesis.model.dimension import FORCE, LENGTH, STIFFNESS, TORSION_STIFFNESS
from synthesis.model.dynamics.bodies import Name, Place
from synthesis.model.problem import Degrees, NonNegative, Number, Statement


class SpringEnd(Statement):
    """Attachment point of a spring on a link or on the `ground`."""

    link: Name
    point: Place = Field(description="Attachment point in the reference configuration.")


class SpringSpec(Statement):
    """A spring, a damper or both: between two points, the `ends`, or between two `links` with a `torsion` rate."""

    ends: tuple[SpringEnd, SpringEnd] | None = None
    rate: Annotated[NonNegative, STIFFNESS] = Field(
        default=0.0, description="Spring rate, N/m or in the consistent units."
    )
    free_length: Annotated[NonNegative, LENGTH] = 0.0
    preload: Annotated[Number, FORCE] = Field(default=0.0, description="Tension at the free length.")
    one_sided: Literal["pull", "push"] | Literal[False] = Field(
        default=False, description="Bears tension only (`pull`) or compression only (`push`)."
    )
    torsion: Annotated[NonNegative, TORSION_STIFFNESS] | None = Field(
        default=None, description="Torsion rate, N·m/rad or in the consistent units."
    )
    links: tuple[Name, Name] | None = Field(default=None, description="The two links that a torsion spring connects.")
    free_angle: Degrees = Field(
        default=0.0,
        description="Rotation of the second link relative to the first, counted from the reference, without torque.",
    )
    damping: NonNegative = Field(default=0.0, description="Damping coefficient, N·s/m; N·m·s/rad for a torsion spring.")

    @model_validator(mode="after")
    def _validate_form(self) -> Self:
        changed = self.find_changed_fields()
        linear = {"ends", "rate", "free_length", "preload", "one_sided"} & changed
        turning = {"torsion", "links", "free_angle"} & changed
        if (self.ends is None) == (self.torsion is None):
            raise ValueError(compose("model-spring-form"))
        if linear and turning:
            mixed = turning if self.torsion is None else linear
            raise ValueError(compose("model-spring-fields-mixed", fields=", ".join(sorted(mixed))))
        if self.torsion is not None and self.links is None:
            raise ValueError(compose("model-torsion-spring-needs-links"))
        return self
