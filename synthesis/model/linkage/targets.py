"""Requested targets for the analysis of a given linkage."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from kinematics.message import compose
from synthesis.model.answer import Answer, optional_field
from synthesis.model.dimension import OUTPUT, Angle, Length, Output
from synthesis.model.problem import Coordinate, Degrees, Number, Statement

MAX_TARGETS = 200
"""Maximum number of targets of one analysis."""


class TargetSpec(Statement):
    """Position of P with or without an angle of the body, or position of the output at a given input.

    The angle of the body in the reference is the mechanism's `reference_body_angle`, by default the angle of the first
    target.
    """

    x: Coordinate | None = Field(default=None, description="Coordinate x of P.")
    y: Coordinate | None = Field(default=None, description="Coordinate y of P.")
    angle: Degrees | None = Field(default=None, description="Absolute angle of the body.")
    output: Annotated[Number, OUTPUT] | None = Field(
        default=None,
        description="Absolute angle of the output link, degrees, or position of a slider along its line, from the foot "
        "of the fixed pivot, length units; needs `input_angle`.",
    )
    input_angle: Degrees | None = Field(
        default=None, description="Input angle of the target; by default the angle at which the linkage comes nearest."
    )

    @model_validator(mode="before")
    @classmethod
    def _validate_sort(cls, fields: object) -> object:
        # For a wrong type, pydantic's own message is better.
        if not isinstance(fields, dict):
            return fields
        has = {name for name in ("x", "y", "angle", "output", "input_angle") if fields.get(name) is not None}
        if "output" in has and ({"x", "y", "angle"} & has or "input_angle" not in has):
            raise ValueError(compose("model-output-target-fields"))
        if "output" not in has and not {"x", "y"} <= has:
            raise ValueError(compose("model-target-incomplete"))
        return fields

    @property
    def sort(self) -> str:
        """Sort of target: ``poses``, ``points`` or ``outputs``."""
        return "outputs" if self.output is not None else "points" if self.angle is None else "poses"


class MetTarget(Answer):
    """Input and errors of the given linkage at a target."""

    index: int
    input_angle: Angle = Field(description="Absolute input angle, degrees, continuous from the first target.")
    point_residual: Length | None = optional_field("Distance of P from the target.")
    angle_residual: Angle | None = optional_field(
        "Difference between the body's angle and that of the target, degrees."
    )
    error: Output | None = optional_field("Error of the output, degrees or length units.")
