"""Answers to problems of function generation: the linkage, its dials, and its structural error as measured."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.answer import Answer, Verification
from synthesis.model.dimension import Angle, Output
from synthesis.model.forces_answer import DesignForces
from synthesis.model.linkage_answer import (
    EXACT,
    LAYOUT,
    PEAKS,
    ExactDesign,
    FourbarMechanism,
    Layout,
    LinkageMetrics,
    LinkageResult,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.model.manufacture_answer import MANUFACTURE, Manufactured

FunctionMechanism = Annotated[FourbarMechanism | SliderCrankMechanism | SixbarMechanism, Discriminator("type")]


class InputDial(Answer):
    """How a value is read off the input: where the link stands at one value, and how far it turns for a unit of it.

    The link stands at ``place`` + ``scale`` · (value − ``at``), an absolute angle, degrees.
    """

    at: float
    place: Angle
    scale: Angle


class OutputDial(Answer):
    """The same of the output: an absolute angle, degrees, or a slider's position.

    A slider's position is along its line, from the foot of the fixed pivot.
    """

    at: float
    place: Output
    scale: Output


class Dials(Answer):
    """Dials of input and output. Their values are those of the pairs, or x and y of the function."""

    input: InputDial
    output: OutputDial


class FunctionTarget(Answer):
    """A pair, a precision point, or a place at which an approximation is shown, as the driven linkage meets it."""

    index: int
    input: float = Field(description="Value of the input: of the pair, or x.")
    output: float = Field(description="The demanded value of the output: of the pair, or y.")
    input_angle: Angle = Field(description="Absolute angle of the input link, degrees.")
    output_place: Output = Field(
        description="Where the output stands: absolute angle, degrees, or the slider's position."
    )
    error: Output = Field(description="Structural error here: degrees, or length units.")
    residual: float = Field(description="Its size in radians, or as a share of the slider's range.")


class ErrorExtreme(Answer):
    """A greatest or least structural error, or that at an end of the range."""

    input: float
    input_angle: Angle
    error: Output


class ErrorCurve(Answer):
    """Structural error over the range."""

    input: list[float]
    input_angle: list[Angle]
    error: list[Output]


class StructuralError(Answer):
    """How far the output of the driven linkage is from the demanded one, over the whole range or at the pairs.

    ``alternations`` counts the extremes of changing sign that reach the greatest error to a thousandth of it. A least
    greatest error with n free numbers has n + 1 of them, as a rule.
    """

    unit: Literal["degrees", "length"]
    max: Output
    rms: Output
    alternations: int
    extremes: list[ErrorExtreme]
    curve: ErrorCurve


class FunctionMetrics(LinkageMetrics):
    """Measured properties of a function generator; ``rms_residual`` is over the targets."""

    max_structural_error: Output
    rms_structural_error: Output
    output_range: Output = Field(description="From the first value to the last: degrees, or length units.")


class FunctionDesign(Answer):
    """A linkage with the proof of what it does."""

    mechanism: FunctionMechanism
    dials: Dials
    targets: list[FunctionTarget]
    verification: Verification
    metrics: FunctionMetrics
    structural_error: StructuralError
    layout: Layout | None = LAYOUT
    forces: DesignForces | None = PEAKS
    manufacture: Manufactured | None = MANUFACTURE
    exact: ExactDesign | None = EXACT


class FunctionResult(LinkageResult[FunctionDesign]):
    """Linkages whose output follows the input."""
