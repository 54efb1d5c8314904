"""The motion of a linkage as CSV: every joint and link over the cycle, with derivatives by the input.

Derivatives are by the input, whose unit is the radian for a crank and the length unit for a driven slider. Multiplied
by the input's speed (or its square) they are velocities (accelerations) at constant speed. Cells are empty where the
linkage cannot be assembled. Lines that begin with ``#`` describe the table.
"""

from __future__ import annotations

import numpy as np

from service.render.linkage.motion import DrivenLinkage
from service.render.page import table
from synthesis.kinds.function.design import FunctionDesign
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.model.design_interface import AnyDesign
from synthesis.model.problem import ProblemBase

STEP_COUNT = 360
"""Number of steps of the cycle."""


def write_linkage_table(design: AnyDesign, problem: ProblemBase, title: str) -> str:
    """Write the motion of a linkage design; numbers in full precision, cells empty where it cannot be assembled."""
    linkage, unit = DrivenLinkage.from_design(design), problem.length_unit
    slide = linkage.mechanism.has_slide_input
    inputs = np.linspace(*linkage.cycle, STEP_COUNT + 1)
    motion = linkage.drive_over(inputs, order=2)
    # Derivatives are by the input, whose unit depends on the drive.
    by = unit if slide else "rad"
    columns = {f"input [{unit}]" if slide else "input_angle [deg]": inputs if slide else np.degrees(inputs)}
    for name, turned in motion.angles.items():
        columns[f"link_{name}_angle [deg]"] = np.degrees(turned[0])
        columns[f"link_{name}_omega [rad/{by}]"] = turned[1]
        columns[f"link_{name}_alpha [rad/{by}^2]"] = turned[2]
    for name, point in motion.joints.items():
        for order, (letter, per) in enumerate((("", ""), ("v", f"/{by}"), ("a", f"/{by}^2"))):
            columns[f"{name}_{letter}x [{unit}{per}]"] = point[order].real
            columns[f"{name}_{letter}y [{unit}{per}]"] = point[order].imag
    for name, sine in motion.sines.items():
        # Rounding may push the sine slightly beyond 1.
        columns[f"{name}_transmission_angle [deg]"] = np.degrees(np.arcsin(np.minimum(np.abs(sine), 1.0)))
    remark = f"{design.mechanism.type}; rates are derivatives by the input, in {by}"
    return table.write_number_table([title or "Linkage", remark], columns)


def write_function_table(design: FunctionDesign, problem: FunctionProblem, title: str) -> str:
    """Write the input value, input angle and structural error of a function generator."""
    curve = design.structural_error.curve
    unit = "deg" if design.structural_error.unit == "degrees" else problem.length_unit
    rows = zip(curve.input, curve.input_angle, curve.error, strict=True)
    return table.write_table(["input", "input_angle_deg", f"structural_error_{unit}"], rows)
