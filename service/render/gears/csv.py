"""Gear trains and gearboxes as tables: one row per gear or speed, with units in the header."""

from __future__ import annotations

import math

from kinematics.gear.teeth import Gear
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.series_layout import arrange_series
from service.render.gears.train_layout import TrainGear, place_gears
from service.render.page.table import Cell, write_table
from synthesis.kinds.gear_train.design import GearTrainDesign
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.kinds.gearbox.design import GearboxDesign
from synthesis.kinds.gearbox.problem import GearboxProblem
from synthesis.kinds.layshaft_gearbox.design import LayshaftDesign
from synthesis.kinds.layshaft_gearbox.problem import LayshaftProblem
from synthesis.kinds.planetary_train.design import PlanetaryDesign
from synthesis.kinds.planetary_train.problem import PlanetaryProblem
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem


def write_gear_train_table(design: GearTrainDesign, problem: GearTrainProblem, title: str) -> str:
    """Write stage, role, teeth, module, circles, centre and speed of every gear; profile shifts of fitted gears."""
    fitted = ["profile_shift"] if problem.is_fitted else []
    typed = ["type", "helix_angle_deg"] if problem.stages is not None else []
    return write_table(
        ["stage", "role", "teeth", *_list_heads("outside", problem.length_unit), "speed_over_input", *fitted, *typed],
        (
            [
                placed.stage,
                placed.role,
                placed.count,
                *_train_sizes(placed, design),
                # Exact speeds are written as fractions.
                f"{placed.speed.numerator}/{placed.speed.denominator}",
                *([placed.gear.shift / math.cos(placed.helix_angle)] if fitted else []),
                *(_list_type_cells(placed, design) if typed else []),
            ]
            for placed in place_gears(design.mechanism, problem.reverted)
        ),
    )


def _train_sizes(placed: TrainGear, design: GearTrainDesign) -> list[Cell]:
    """Return the sizes of :func:`_list_sizes` with the module as given in the design.

    Gears that are drawn in axial section have no base circle.
    """
    module, *diameters, x, y = _list_sizes(placed.gear, placed.centre)
    if placed.section is not None:
        return [module, *diameters[:-1], "", x, y]
    return [design.mechanism.stages[placed.stage - 1].module, *diameters, x, y]


def _list_type_cells(placed: TrainGear, design: GearTrainDesign) -> list[Cell]:
    """Return the type of the stage, and the helix angle of the gear, positive for a right-handed one."""
    stage = design.mechanism.stages[placed.stage - 1]
    angle = 0.0 if stage.helix_angle is None else stage.helix_angle
    # External helical gears have opposite hands; 0.0 - angle avoids -0.
    return [stage.type or "", angle if placed.role == "driver" else 0.0 - angle]


def write_planetary_table(design: PlanetaryDesign, problem: PlanetaryProblem, title: str) -> str:
    """Write name, copy, teeth, circles, centre and speed of every gear, one row per gear and copy."""
    return write_table(
        ["gear", "body", "copy", "teeth", *_list_heads("tip", problem.length_unit), "speed_over_input"],
        (
            [
                placed.name,
                placed.body,
                placed.copy,
                f"{placed.gear.teeth:g}",
                *_list_sizes(placed.gear, placed.centre),
                design.metrics.speeds[placed.body],
            ]
            for placed in place_planetary_gears(design.mechanism)
        ),
    )


def write_series_table(design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str) -> str:
    """Write unit, name, copy, teeth, circles, shift, centre and speed of every gear, one row per gear and copy."""
    return write_table(
        [
            "unit",
            "gear",
            "copy",
            "teeth",
            *_list_heads("tip", problem.length_unit),
            "profile_shift",
            "speed_over_input",
        ],
        (
            [
                gear.unit,
                gear.name,
                gear.copy,
                f"{gear.placed.gear.teeth:g}",
                *_list_sizes(gear.placed.gear, gear.placed.centre),
                gear.placed.gear.shift,
                gear.speed,
            ]
            for gear in arrange_series(design, problem)
        ),
    )


def _list_heads(outer: str, unit: str) -> list[str]:
    """Return the column heads of :func:`_list_sizes`; ``outer`` is the kind's word for the tip circle."""
    names = ("module", "pitch_diameter", f"{outer}_diameter", "root_diameter", "base_diameter", "centre_x", "centre_y")
    return [f"{name}_{unit}" for name in names]


def _list_sizes(gear: Gear, centre: complex) -> list[float]:
    radii = gear.pitch_radius, gear.tip_radius, gear.root_radius, gear.base_radius
    return [gear.module, *(2.0 * radius for radius in radii), centre.real, centre.imag]


def write_gearbox_table(design: GearboxDesign, problem: GearboxProblem, title: str) -> str:
    """Write every spindle speed with its nominal value, deviation and engaged pairs."""
    stages = design.mechanism.stages
    rows: list[list[Cell]] = []
    for row in design.metrics.speeds:
        pairs = [stage.pairs[at] for stage, at in zip(stages, row.engaged, strict=True)]
        engaged = [f"{pair.driver}/{pair.driven}" for pair in pairs]
        rows.append([row.speed, row.nominal, row.standard, row.error, *engaged])
    names = [f"stage_{k}_driver_driven" for k in range(1, len(stages) + 1)]
    return write_table(["speed_rpm", "nominal_rpm", "standard_rpm", "error", *names], rows)


def write_layshaft_table(design: LayshaftDesign, problem: LayshaftProblem, title: str) -> str:
    """Write every gear with its teeth, its ratio and the ratio's error; the head pair comes first."""
    mechanism, errors = design.mechanism, design.metrics.errors
    rows: list[list[Cell]] = [["head", mechanism.head.driven, "", mechanism.head.driver, "", ""]]
    for k, (gear, error) in enumerate(zip(mechanism.gears, errors, strict=False), 1):
        # Direct drive has no pair of its own.
        teeth = (gear.layshaft, gear.mainshaft) if gear.layshaft is not None else ("", "")
        rows.append([k, teeth[0], "", teeth[1], gear.ratio.value, error])
    if mechanism.reverse is not None:
        back = mechanism.reverse
        rows.append(["reverse", back.layshaft, back.idler, back.mainshaft, back.ratio.value, errors[-1]])
    return write_table(["gear", "layshaft", "idler", "mainshaft", "ratio", "error"], rows)
