"""The sheet of trains in series: a panel for each unit or each of its planes, to individual scales, and tables."""

from __future__ import annotations

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render.checks import describe_verdict, make_checks_block
from service.render.gears.placement import enclose_gears
from service.render.gears.planetary_layout import place_planetary_gears
from service.render.gears.planetary_sheet import draw_planetary_panel, enclose_train
from service.render.gears.train_layout import place_gears
from service.render.gears.train_sheet import draw_train_panel
from service.render.outline import list_entries
from service.render.page import blocks
from service.render.page.numbers import format_length
from service.render.page.sheet import BORDER, TOP, draw_caption, fit_panel, get_drawing_width, stack_blocks, write_sheet
from service.render.page.svg import Box, Element, Viewport
from synthesis.kinds.planetary_train.design import PlanetaryMechanism
from synthesis.kinds.train_series.design import TrainSeriesDesign, UnitMechanism
from synthesis.kinds.train_series.problem import TrainSeriesProblem

PLANETARY_HEIGHT, ORDINARY_HEIGHTS, PANEL_GAP = 360.0, (220.0, 420.0), 10.0
"""Panel height of a planetary unit, minimum and maximum panel height of ordinary gears, and space between panels,
pixels.
"""

MARGIN, MARGIN_BELOW = 24.0, 26.0
"""Margins in a panel around the content, and additional space below, pixels."""


def draw_series_sheet(design: TrainSeriesDesign, problem: TrainSeriesProblem, title: str) -> str:
    """Draw trains in series as a complete SVG document."""
    parts: list[Element] = []
    low = TOP
    for k, unit in enumerate(design.mechanism.units):
        drawn, low = _draw_unit(unit, problem, k, low)
        parts += drawn
    tables, y = stack_blocks(_make_tables(design, problem))
    described = "; ".join(f"unit {k}: {_describe_unit(unit)}" for k, unit in enumerate(design.mechanism.units, 1))
    return write_sheet(
        title or "Trains in series",
        _describe_series(design),
        f"Pitch circles of trains in series, each unit to a scale of its own, {described}.",
        [*parts, *tables],
        max(low, y),
    )


def _draw_unit(
    unit: UnitMechanism, problem: TrainSeriesProblem, number: int, low: float
) -> tuple[list[Element], float]:
    """Draw the panels of a unit below ``low``; return them and the y below."""
    name, length_unit = f"unit {number + 1}", problem.length_unit
    if not isinstance(unit, PlanetaryMechanism):
        gears = place_gears(unit, problem.units[number].reverted)
        view = fit_panel(enclose_gears(gears), get_drawing_width(), ORDINARY_HEIGHTS, MARGIN, MARGIN_BELOW)
        # The fitted panel starts at the top: move it below the previous ones.
        panel = Box(view.panel.left, low, view.panel.right, low + view.panel.height)
        shown = Viewport.fit(enclose_gears(gears), panel, MARGIN, MARGIN_BELOW)
        typed = problem.units[number].stages is not None
        drawn = draw_train_panel(gears, shown, length_unit, name, typed)
        drawn.add(draw_caption(panel, name))
        return [drawn], panel.high + PANEL_GAP
    placed = place_planetary_gears(unit)
    panels = []
    planes = sorted({plane for one in placed for plane in one.planes})
    for plane in planes:
        panel = Box(BORDER, low, BORDER + get_drawing_width(), low + PLANETARY_HEIGHT)
        view = Viewport.fit(enclose_train(placed), panel, MARGIN, MARGIN)
        heading = f"{name}, plane {plane}" if len(planes) > 1 else name
        panels.append(
            draw_planetary_panel(unit, view, [one for one in placed if plane in one.planes], heading, length_unit)
        )
        low += PLANETARY_HEIGHT + PANEL_GAP
    return panels, low


def _describe_series(design: TrainSeriesDesign) -> str:
    ratio = design.mechanism.ratio
    fraction = f"{ratio.numerator}/{ratio.denominator} = {format_length(ratio.value, digits=9)}"
    count = len(design.mechanism.units)
    return f"Series of {count} trains, ratio {fraction}; {describe_verdict(design.verification)}".replace("-", "−")


def _describe_unit(unit: UnitMechanism) -> str:
    """Describe the gears and the members of a unit in words."""
    if isinstance(unit, PlanetaryMechanism):
        gears = ", ".join(f"{name} {teeth}" for name, teeth in unit.teeth.items())
        members = f"{unit.input} to {unit.output}, {unit.fixed} fixed"
        return f"{ARRANGEMENTS[unit.arrangement].title}, {gears}; {members}".replace("_", " ")
    idlers = "".join(f", idler {idler.teeth} in stage {idler.stage}" for idler in unit.idlers)
    return f"gears {', '.join(f'{stage.driver}:{stage.driven}' for stage in unit.stages)}{idlers}"


def _make_tables(design: TrainSeriesDesign, problem: TrainSeriesProblem) -> list[blocks.Block]:
    unit, tables = problem.length_unit, []
    for k, (made, measured) in enumerate(zip(design.mechanism.units, design.metrics.units, strict=True), 1):
        rows = [("ratio", format_length(made.ratio.value, digits=9))]
        if isinstance(made, PlanetaryMechanism):
            rows += [(name.replace("_", " "), f"{teeth} teeth") for name, teeth in made.teeth.items()]
            members = f"{made.input} to {made.output}, {made.fixed} fixed".replace("_", " ")
            rows += [
                ("members", members),
                ("planets", f"{made.planets}"),
                ("module", f"{format_length(made.module)} {unit}"),
            ]
            left_out = {"speeds", "error", "self_locking"}
        else:
            for number, stage in enumerate(made.stages, 1):
                kind = f"{stage.type}, " if stage.type else ""
                words = f"{kind}{stage.driver} drives {stage.driven}, module {format_length(stage.module)} {unit}"
                rows.append((f"stage {number}", words))
                if stage.shift is not None:
                    shifts = f"{stage.shift.driver:.5f}, {stage.shift.driven:.5f}".replace("-", "−")
                    rows.append((f"stage {number} shifts", shifts))
            rows += [(f"idler of stage {idler.stage}", f"{idler.teeth} teeth") for idler in made.idlers]
            left_out = {"error", "relative_error", "hunting_tooth", "shafts"}
        tables.append(blocks.make_rows(f"Unit {k}", [*rows, *list_entries(measured, problem, left_out)]))
    tables.append(make_checks_block(design.verification, problem))
    tables.append(
        blocks.make_rows("Metrics", list_entries(design.metrics, problem, {"units"}, {"error": "relative error"}))
    )
    return tables
