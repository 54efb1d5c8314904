"""A planetary train as a table: one row a gear and copy, with the unit in the header."""

from __future__ import annotations

import csv
import io

from service.render.gears.planetary_layout import placed_planetary_gears
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem


def planetary_table(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """Name, copy, teeth, circles, centre and speed of every gear, one row each."""
    unit = problem.length_unit
    lengths = ("module", "pitch_diameter", "tip_diameter", "root_diameter", "base_diameter", "centre_x", "centre_y")
    written = io.StringIO()
    table = csv.writer(written, lineterminator="\r\n")
    table.writerow(["gear", "body", "copy", "teeth", *(f"{name}_{unit}" for name in lengths), "speed_over_input"])
    for placed in placed_planetary_gears(design.mechanism):
        gear = placed.gear
        sizes = gear.pitch_radius, gear.tip_radius, gear.root_radius, gear.base_radius
        table.writerow(
            [
                placed.name,
                placed.body,
                placed.copy,
                f"{gear.teeth:g}",
                repr(gear.module),
                *(repr(2.0 * radius) for radius in sizes),
                repr(placed.centre.real),
                repr(placed.centre.imag),
                repr(design.metrics.speeds[placed.body]),
            ]
        )
    return written.getvalue()
