"""What a client says that a given linkage is to do: targets of an analysis."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from synthesis.model.answer import Answer, optional
from synthesis.model.dimension import OUTPUT, Angle, Length, Output
from synthesis.model.statement import Coordinate, Degrees, Number, Statement

MOST_TARGETS = 200


class StatedTarget(Statement):
    """A place of P with or without an angle of the body, or a place of the output at an input.

    The body stands in the reference as the mechanism's `reference_body_angle` says, which is that of the first target
    where it is left out.
    """

    x: Coordinate | None = Field(default=None, description="Of P.")
    y: Coordinate | None = Field(default=None, description="Of P.")
    angle: Degrees | None = Field(default=None, description="Absolute angle of the body.")
    output: Annotated[Number, OUTPUT] | None = Field(
        default=None,
        description="Absolute angle of the output link, degrees, or place of a slider along its line, from the foot of "
        "the fixed pivot, length units; at an input that is stated.",
    )
    input_angle: Degrees | None = Field(
        default=None, description="Where the input stands; left out, where the linkage comes nearest."
    )

    @model_validator(mode="before")
    @classmethod
    def _of_one_sort(cls, stated: Any) -> Any:
        if not isinstance(stated, dict):
            return stated
        has = {name for name in ("x", "y", "angle", "output", "input_angle") if stated.get(name) is not None}
        if "output" in has and ({"x", "y", "angle"} & has or "input_angle" not in has):
            raise ValueError("a target of the output has output and input_angle, and nothing of P or the body")
        if "output" not in has and not {"x", "y"} <= has:
            raise ValueError("give x and y of P, or output and input_angle")
        return stated

    @property
    def sort(self) -> str:
        """``poses``, ``points`` or ``outputs``."""
        return "outputs" if self.output is not None else "points" if self.angle is None else "poses"


class MetTarget(Answer):
    """A target as the linkage meets it, as it is stated."""

    index: int
    input_angle: Angle = Field(description="Absolute input angle, degrees, in one run from the first target.")
    point_residual: Length | None = optional("Distance of P from its place.")
    angle_residual: Angle | None = optional("Difference of the body's angle, degrees.")
    error: Output | None = optional("Of the output: degrees, or length units.")
