"""Positions and speeds of the gears of trains in series: units side by side, each arranged as its kind requires."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.gears.placement import PlacedGear, enclose_gears
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.train_layout import place_gears
from synthesis.kinds.planetary_train.design import PlanetaryMechanism, PlanetaryMetrics
from synthesis.kinds.train_series.design import TrainSeriesDesign
from synthesis.kinds.train_series.problem import TrainSeriesProblem

UNIT_GAP = 0.15
"""Space between two units, as a share of the wider one."""


@dataclass(frozen=True)
class SeriesGear:
    """A gear of a unit.

    ``speed`` and ``orbit`` are its own speed and that of its carrier about ``axis``, relative to the input speed of the
    series. ``layers`` are the names of its layers in a DXF drawing. ``line`` is the number of the text line of its
    caption, which keeps captions at one centre apart.
    """

    placed: PlacedGear
    unit: int
    name: str
    copy: int
    layers: tuple[str, ...]
    speed: float
    orbit: float
    axis: complex
    line: int
    toothed: bool


def arrange_series(design: TrainSeriesDesign, problem: TrainSeriesProblem) -> list[SeriesGear]:
    """Arrange all gears from the input on, the first unit's axis at the origin."""
    layout: list[SeriesGear] = []
    right = 0.0
    for k in range(len(design.mechanism.units)):
        gears = arrange_unit(design, problem, k)
        if not gears:
            continue
        box = enclose_gears(gear.placed for gear in gears)
        # Place the unit to the right of the previous one.
        aside = 0j if not layout else complex(right + UNIT_GAP * box.width - box.left)
        right = box.right + aside.real
        layout += [
            replace(gear, placed=replace(gear.placed, centre=gear.placed.centre + aside), axis=gear.axis + aside)
            for gear in gears
        ]
    return layout


def arrange_unit(design: TrainSeriesDesign, problem: TrainSeriesProblem, number: int) -> Sequence[SeriesGear]:
    """Arrange the gears of one unit, counted from 0, about its own origin."""
    unit, metrics = design.mechanism.units[number], design.metrics.units[number]
    share = design.metrics.speeds[number]
    name = f"UNIT_{number + 1}"
    if isinstance(unit, PlanetaryMechanism):
        assert isinstance(metrics, PlanetaryMetrics)
        arrangement = ARRANGEMENTS[unit.arrangement]
        names = list(unit.teeth)
        return [
            SeriesGear(
                placed,
                number + 1,
                placed.name.replace("_", " "),
                placed.copy,
                tuple(f"{name}_PLANE_{plane}" for plane in placed.planes),
                # Adding 0 turns -0.0 into 0.0.
                share * metrics.speeds[placed.body] + 0.0,
                share * metrics.speeds.get(arrangement.carriers.get(placed.body, ""), 0.0),
                0j,
                names.index(placed.name),
                not arrangement.bevel,
            )
            for placed in place_planetary_gears(unit)
        ]
    gears = place_gears(unit, problem.units[number].reverted)
    return [
        SeriesGear(
            placed,
            number + 1,
            f"stage {placed.stage} {placed.role}",
            0,
            (f"{name}_STAGE_{placed.stage}",),
            share * float(placed.speed),
            0.0,
            0j,
            2 * placed.stage + (placed.role == "driven"),
            True,
        )
        for placed in gears
    ]
