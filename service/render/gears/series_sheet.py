"""The sheet of trains in series: a panel for each unit or each of its planes, to individual scales, and tables."""

from __future__ import annotations

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.checks import checks, verdict
from service.render.gears.placed import box_around
from service.render.gears.planetary_layout import placed_planetary_gears
from service.render.gears.planetary_sheet import around, planetary_panel
from service.render.gears.train_layout import placed_gears
from service.render.gears.train_sheet import train_panel
from service.render.outline import entries
from service.render.page import blocks
from service.render.page.numbers import length
from service.render.page.sheet import EDGE, TOP, beside, caption, fitted, sheet, stacked
from service.render.page.svg import Box, Element, Viewport
from synthesis.kinds.planetary_train.design import PlanetaryMechanism
from synthesis.kinds.train_series.design import TrainSeriesDesign, UnitMechanism
from synthesis.kinds.train_series.problem import TrainSeriesProblem

HEIGHT, HEIGHTS, APART = 360.0, (220.0, 420.0), 10.0
"""Panel height of a planetary unit, minimum and maximum panel height of ordinary gears, and space between panels,
pixels.
"""

MARGIN, FOOT = 24.0, 26.0
"""Margins in a panel around the content, and additional space below, pixels."""


def series_sheet(design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str) -> str:
    """Draw trains in series as a complete SVG document."""
    parts: list[Element] = []
    low = TOP
    for k, unit in enumerate(design.mechanism.units):
        drawn, low = _unit(unit, problem, k, low)
        parts += drawn
    tables, y = stacked(_tables(design, problem))
    described = "; ".join(f"unit {k}: {_gears(unit)}" for k, unit in enumerate(design.mechanism.units, 1))
    return sheet(
        title or "Trains in series",
        _words(design),
        f"Pitch circles of trains in series, each unit to a scale of its own, {described}.",
        [*parts, *tables],
        max(low, y),
    )


def _unit(unit: UnitMechanism, problem: TrainSeriesProblem, number: int, low: float) -> tuple[list[Element], float]:
    """Draw the panels of a unit below ``low``; return them and the y below."""
    name, length_unit = f"unit {number + 1}", problem.length_unit
    if not isinstance(unit, PlanetaryMechanism):
        gears = placed_gears(unit, problem.units[number].reverted)
        view = fitted(box_around(gears), beside(), HEIGHTS, MARGIN, FOOT)
        # The fitted panel starts at the top: move it below the previous ones.
        panel = Box(view.panel.left, low, view.panel.right, low + view.panel.height)
        shown = Viewport.fit(box_around(gears), panel, MARGIN, FOOT)
        typed = problem.units[number].stages is not None
        drawn = train_panel(gears, shown, length_unit, name, typed)
        drawn.add(caption(panel, name))
        return [drawn], panel.high + APART
    placed = placed_planetary_gears(unit)
    panels = []
    planes = sorted({plane for one in placed for plane in one.planes})
    for plane in planes:
        panel = Box(EDGE, low, EDGE + beside(), low + HEIGHT)
        view = Viewport.fit(around(placed), panel, MARGIN, MARGIN)
        heading = f"{name}, plane {plane}" if len(planes) > 1 else name
        panels.append(planetary_panel(unit, view, [one for one in placed if plane in one.planes], heading, length_unit))
        low += HEIGHT + APART
    return panels, low


def _words(design: TrainSeriesDesign) -> str:
    ratio = design.mechanism.ratio
    fraction = f"{ratio.numerator}/{ratio.denominator} = {length(ratio.value, digits=9)}"
    count = len(design.mechanism.units)
    return f"Series of {count} trains, ratio {fraction}; {verdict(design.verification)}".replace("-", "−")


def _gears(unit: UnitMechanism) -> str:
    """Describe the gears and the members of a unit in words."""
    if isinstance(unit, PlanetaryMechanism):
        gears = ", ".join(f"{name} {teeth}" for name, teeth in unit.teeth.items())
        members = f"{unit.input} to {unit.output}, {unit.fixed} fixed"
        return f"{ARRANGEMENTS[unit.arrangement].title}, {gears}; {members}".replace("_", " ")
    idlers = "".join(f", idler {idler.teeth} in stage {idler.stage}" for idler in unit.idlers)
    return f"gears {', '.join(f'{stage.driver}:{stage.driven}' for stage in unit.stages)}{idlers}"


def _tables(design: TrainSeriesDesign, problem: TrainSeriesProblem) -> list[blocks.Block]:
    unit, tables = problem.length_unit, []
    for k, (made, measured) in enumerate(zip(design.mechanism.units, design.metrics.units, strict=True), 1):
        rows = [("ratio", length(made.ratio.value, digits=9))]
        if isinstance(made, PlanetaryMechanism):
            rows += [(name.replace("_", " "), f"{teeth} teeth") for name, teeth in made.teeth.items()]
            members = f"{made.input} to {made.output}, {made.fixed} fixed".replace("_", " ")
            rows += [("members", members), ("planets", f"{made.planets}"), ("module", f"{length(made.module)} {unit}")]
            left_out = {"speeds", "error", "self_locking"}
        else:
            for number, stage in enumerate(made.stages, 1):
                kind = f"{stage.type}, " if stage.type else ""
                words = f"{kind}{stage.driver} drives {stage.driven}, module {length(stage.module)} {unit}"
                rows.append((f"stage {number}", words))
                if stage.shift is not None:
                    shifts = f"{stage.shift.driver:.5f}, {stage.shift.driven:.5f}".replace("-", "−")
                    rows.append((f"stage {number} shifts", shifts))
            rows += [(f"idler of stage {idler.stage}", f"{idler.teeth} teeth") for idler in made.idlers]
            left_out = {"error", "relative_error", "hunting_tooth", "shafts"}
        tables.append(blocks.rows(f"Unit {k}", [*rows, *entries(measured, problem, left_out)]))
    tables.append(checks(design.verification, problem))
    tables.append(blocks.rows("Metrics", entries(design.metrics, problem, {"units"}, {"error": "relative error"})))
    return tables
