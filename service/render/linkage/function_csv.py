"""The structural error of a function generator as a table: one row a place of the range, with units in the header."""

from __future__ import annotations

from service.render.page import table
from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem


def function_table(design: FunctionDesign, problem: FunctionProblem, title: str) -> str:
    """Value of the input, angle of the input link, and structural error there."""
    curve = design.structural_error.curve
    unit = "deg" if design.structural_error.unit == "degrees" else problem.length_unit
    rows = zip(curve.input, curve.input_angle, curve.error, strict=True)
    return table.table(["input", "input_angle_deg", f"structural_error_{unit}"], rows)
