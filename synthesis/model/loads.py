"""Loads on a linkage as a client states them: forces at points of links and at joints, torques on links. Data alone."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from synthesis.model.bodies import Name, Place
from synthesis.model.dimension import FORCE, TORQUE
from synthesis.model.statement import Number, Statement


class ForceCourse(Statement):
    """What a force is over the motion."""

    constant: Annotated[tuple[Number, Number], FORCE]


class TorqueCourse(Statement):
    """What a torque is over the motion; counter-clockwise positive."""

    constant: Annotated[Number, TORQUE]


class StatedLoad(Statement):
    """A force at a `point` of a `link` or at a `joint`, or a torque on a `link`."""

    link: Name | None = None
    joint: Name | None = None
    point: Place | None = Field(default=None, description="Of the link, in the reference configuration.")
    frame: Literal["global", "link"] = Field(
        default="global",
        description="`link`: the force's components are those in the reference and turn with the link.",
    )
    force: ForceCourse | None = None
    torque: TorqueCourse | None = None

    @model_validator(mode="after")
    def _where(self) -> Self:
        if (self.link is None) == (self.joint is None):
            raise ValueError("a load acts on a link or on a joint; name one of them")
        if (self.force is None) == (self.torque is None):
            raise ValueError("a load is a force or a torque; give one of them")
        if self.torque is not None and self.link is None:
            raise ValueError("a torque acts on a link, not on a joint")
        if (self.point is not None) != (self.link is not None and self.force is not None):
            raise ValueError("a force on a link needs its point; a torque and a joint have none")
        if self.frame == "link" and self.point is None:
            raise ValueError("only a force on a link can turn with it")
        return self
