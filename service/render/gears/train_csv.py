"""A gear train as a table: one row a gear, with the unit in the header."""

from __future__ import annotations

import csv
import io

from service.render.gears.train_layout import placed_gears
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem


def gear_train_table(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """Stage, role, teeth, module, circles, shaft centre and speed of every gear."""
    unit = problem.length_unit
    lengths = ("module", "pitch_diameter", "outside_diameter", "root_diameter", "base_diameter", "centre_x", "centre_y")
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\r\n")
    table.writerow(["stage", "role", "teeth", *(f"{name}_{unit}" for name in lengths), "speed_over_input"])
    for placed in placed_gears(design, problem.reverted):
        gear = placed.gear
        sizes = gear.pitch_radius, gear.tip_radius, gear.root_radius, gear.base_radius
        table.writerow(
            [
                placed.stage,
                placed.role,
                gear.teeth,
                repr(gear.module),
                *(repr(2.0 * radius) for radius in sizes),
                repr(placed.centre.real),
                repr(placed.centre.imag),
                f"{placed.speed.numerator}/{placed.speed.denominator}",
            ]
        )
    return text.getvalue()
