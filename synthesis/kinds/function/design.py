"""Results of function generation: the linkage, its dials, and its measured structural error."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field

from synthesis.model.answer import Answer, Verification
from synthesis.model.dimension import Angle, Output
from synthesis.model.dynamics.peak_forces import DesignForces
from synthesis.model.linkage.answer import (
    EXACT_FIELD,
    LAYOUT_FIELD,
    PEAKS_FIELD,
    EightbarMechanism,
    ExactDesign,
    FourbarMechanism,
    Layout,
    LinkageMetrics,
    LinkageResult,
    SixbarMechanism,
    SliderCrankMechanism,
)
from synthesis.model.manufacture.answer import MANUFACTURE_FIELD, ManufactureReport

FunctionMechanism = Annotated[
    FourbarMechanism | SliderCrankMechanism | SixbarMechanism | EightbarMechanism, Discriminator("type")
]


class InputDial(Answer):
    """Dial of the input: the link's angle at one value, and its rotation per unit of the value.

    The link's absolute angle is ``place`` + ``scale`` · (value − ``at``), degrees.
    """

    at: float
    place: Angle
    scale: Angle


class OutputDial(Answer):
    """Dial of the output: an absolute angle, degrees, or a slider's position.

    A slider's position is measured along its line, from the foot of the fixed pivot.
    """

    at: float
    place: Output
    scale: Output


class Dials(Answer):
    """Dials of input and output. Their values are those of the pairs, or the function's x and y."""

    input: InputDial
    output: OutputDial


class FunctionTarget(Answer):
    """A pair, a precision point, or a sample of an approximation, as measured on the driven linkage."""

    index: int
    input: float = Field(description="Value of the input: that of the pair, or x.")
    output: float = Field(description="Target value of the output: that of the pair, or y.")
    input_angle: Angle = Field(description="Absolute angle of the input link, degrees.")
    output_place: Output = Field(
        description="Position of the output: absolute angle, degrees, or the slider's position."
    )
    error: Output = Field(description="Structural error here: degrees, or length units.")
    residual: float = Field(description="Absolute structural error in radians, or as a share of the slider's range.")


class ErrorExtreme(Answer):
    """A maximum or minimum of the structural error, or its value at an end of the range."""

    input: float
    input_angle: Angle
    error: Output


class ErrorCurve(Answer):
    """Structural error over the range."""

    input: list[float]
    input_angle: list[Angle]
    error: list[Output]


class StructuralError(Answer):
    """Difference between the output of the driven linkage and the target, over the whole range or at the pairs.

    ``alternations`` counts the extremes of alternating sign that reach the maximum error to within 0.1 %. A minimax
    error with n free parameters has n + 1 of them, as a rule.
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
    output_range: Output = Field(
        description="Motion of the output from the first value to the last: degrees, or length units."
    )


class FunctionDesign(Answer):
    """A function generator with its verification and measured structural error."""

    mechanism: FunctionMechanism
    dials: Dials
    targets: list[FunctionTarget]
    verification: Verification
    metrics: FunctionMetrics
    structural_error: StructuralError
    layout: Layout | None = LAYOUT_FIELD
    forces: DesignForces | None = PEAKS_FIELD
    manufacture: ManufactureReport | None = MANUFACTURE_FIELD
    exact: ExactDesign | None = EXACT_FIELD


class FunctionResult(LinkageResult[FunctionDesign]):
    """Linkages whose output follows the input."""
