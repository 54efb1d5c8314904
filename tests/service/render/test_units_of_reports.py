"""Every number of a report, and of the checks on a sheet, has the value of the answer and the unit of its field."""

import re
from functools import cache
from html.parser import HTMLParser
from xml.etree import ElementTree

import pytest
from pydantic import BaseModel

from service.render import NoSuchExport, export_design
from service.render.outline import MAX_NUMBERS, format_name, format_value
from service.render.page.numbers import format_angle, format_length
from service.render.report import ReportedJob, report
from service.units import list_symbols
from synthesis.model.dimension import (
    ACCELERATION,
    ANGLE,
    FORCE,
    GRADE,
    JERK,
    LENGTH,
    MASS,
    OUTPUT,
    PERCENT,
    SPEED,
    TORQUE,
    VELOCITY,
    collect_dimensions,
)
from synthesis.registry import KINDS, list_examples, parse_problem
from tests.support.answers import solve

OCCASION = ReportedJob("01K6WM2B7Q3W9Z0V5N8XJ4R1TD", "", None, "2026-01-31T12:00:00.000000Z", None, "1.2.3")

# The example of each kind that is solved at once; the others take longer.
QUICK = {"motion": 3, "path": 1, "function": 1, "cam": 0, "straight_line": 1, "quick_return": 0}

# Kinds whose quickest examples take longer than a second; the campaign has them.
SLOW = ("path", "dwell")

# What the checks measure that compare in a unit; the others are shares, residuals, ratios and counts, which have none.
MEASURING = {
    "transmission_angle": ANGLE,
    "contact_force": FORCE,
    "grade": GRADE,
    "total_mass": MASS,
    "mass": MASS,
    "reach": LENGTH,
    "gyration": LENGTH,
    "disc_radius": LENGTH,
    "shortest_link": LENGTH,
    "fixed_pivot_region": LENGTH,
    "driver_pivot_region": LENGTH,
    "moving_pivot_region": LENGTH,
    "longest_link": LENGTH,
    "swing": ANGLE,
    "steering_error": ANGLE,
    "steers_correctly": ANGLE,
    "deviation": LENGTH,
    "velocity_variation": PERCENT,
    "dwell_1": OUTPUT,
    "dwell_2": OUTPUT,
    "coaxial": LENGTH,
    "clearance": LENGTH,
    "pressure_angle": ANGLE,
    "pressure_angle_fall": ANGLE,
    "min_radius": LENGTH,
    "face_width": LENGTH,
    "clears_pivot": LENGTH,
    "hub_radius": LENGTH,
    "size": LENGTH,
    "peak_velocity": VELOCITY,
    "peak_acceleration": ACCELERATION,
    "peak_jerk": JERK,
    "table_velocity": VELOCITY,
    "table_acceleration": ACCELERATION,
    "table_jerk": JERK,
    "radius": LENGTH,
    "min_thickness": LENGTH,
    "max_thickness": LENGTH,
    "wall": LENGTH,
    "rim_speed": SPEED,
    "fires_at_top": ANGLE,
    "even_firing": ANGLE,
    "roller_in_slot": LENGTH,
    "tooth_thickness": LENGTH,
    "locking_angle": ANGLE,
    "locking_as_told": ANGLE,
    "transmission_as_told": ANGLE,
    "web": LENGTH,
    "play": ANGLE,
    "roller_clears_wheel": LENGTH,
    "locking_disc": LENGTH,
    "ring": LENGTH,
    "crescent": LENGTH,
    "lift_as_told": ANGLE,
    "overtravel_as_told": ANGLE,
    "bore": LENGTH,
    "crank_shaft": LENGTH,
    "pin_force": FORCE,
    "drive_torque": TORQUE,
}


class Tables(HTMLParser):
    """The tables of a page, each with the heading above it: rows of cells, and a head of its own where it is a list."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.headings, self.tables, self.cell = ["", ""], [], None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        if tag == "table":
            self.tables.append({"under": tuple(self.headings), "caption": "", "rows": []})
        elif tag == "tr":
            self.tables[-1]["rows"].append([])
        elif tag in ("h2", "h3", "caption", "td", "th"):
            self.cell = ""

    def handle_endtag(self, tag):
        if self.cell is None or tag not in ("h2", "h3", "caption", "td", "th"):
            return
        if tag in ("h2", "h3"):
            self.headings = [self.cell, ""] if tag == "h2" else [self.headings[0], self.cell]
        elif tag == "caption":
            self.tables[-1]["caption"] = self.cell
        else:
            self.tables[-1]["rows"][-1].append(self.cell)
        self.cell = None

    def handle_data(self, data):
        if self.cell is not None:
            self.cell += data

    def under(self, *headings):
        return [table for table in self.tables if table["under"] == headings]


def numbers(model, path=()):
    """Every field of a model, and of the models in it, that holds numbers: the path to it, what it holds, its unit."""
    for name in type(model).model_fields:
        value, here = getattr(model, name), (*path, name)
        for key, member in value.items() if isinstance(value, dict) else [(None, value)]:
            there = here if key is None else (*here, key)
            if isinstance(member, BaseModel):
                yield from numbers(member, there)
            elif isinstance(member, list) and member and isinstance(member[0], BaseModel):
                for k, entry in enumerate(member):
                    yield from numbers(entry, (*there, k))
            elif holds_floats(member):
                yield there, member, collect_dimensions(type(model)).get(name)


def holds_floats(value):
    return any(map(holds_floats, value)) if isinstance(value, list | tuple) else isinstance(value, float)


def check_written(tables, model, units, leave_out=()):
    """Each number of a model stands in a table under its name, with its value and its unit."""
    seen = 0
    for path, value, dimension in numbers(model):
        if path[0] in leave_out:
            continue
        unit = "" if dimension is None else units[dimension]
        members = [k for k, part in enumerate(path) if isinstance(part, int)]
        long = isinstance(value, list) and len(value) > MAX_NUMBERS
        if members:
            # In a list of models: a row for each of them, where there are not too many, and a column for the field.
            k = members[0]
            if len(members) > 1 or not shown_in_list(tables, path, k, f"{len(value)} values" if long else value, unit):
                continue
        elif long and shown_as_column(tables, path, value, unit):
            pass
        else:
            name = format_name(": ".join(part.replace("_", " ") for part in path))
            text = f"{len(value)} values" if long else format_value(value)
            rows = [row[:3] for table in tables for row in table["rows"] if not table["caption"]]
            assert [name.lower(), text, unit] in [[row[0].lower(), *row[1:]] for row in rows], path
        seen += 1
    return seen


def head(name, unit):
    return (format_name(name) + (f" ({unit})" if unit else "")).lower()


def shown_in_list(tables, path, k, value, unit):
    caption, name = format_name(": ".join(path[:k])), " ".join(map(str, path[k + 1 :]))
    (table,) = [t for t in tables if t["caption"].lower() == caption.lower()]
    heads = [cell.lower() for cell in table["rows"][0]]
    if head(name, unit) not in heads:
        # More columns than a page is wide: the last ones are in the JSON only, whatever their units.
        assert len(heads) == 10
        assert not any(re.fullmatch(rf"{re.escape(format_name(name).lower())}( \(.*\))?", h) for h in heads)
        return False
    if len(table["rows"]) - 1 <= path[k]:
        return False
    listed = [row[heads.index(head(name, unit))] for row in table["rows"][1:]]
    text = value if isinstance(value, str) else format_value(value)
    assert text in listed if len(listed) == 40 else listed[path[k]] == text, path
    return True


def shown_as_column(tables, path, value, unit):
    for table in tables:
        heads = [cell.lower() for cell in table["rows"][0]] if table["rows"] else []
        if table["caption"].lower() == format_name(": ".join(path[:-1])).lower() and head(path[-1], unit) in heads:
            column = [row[heads.index(head(path[-1], unit))] for row in table["rows"][1:]]
            assert (column[0], column[-1]) == (format_value(value[0]), format_value(value[-1])), path
            return True
    return False


@cache
def solved(kind, n):
    problem = parse_problem(list_examples(kind)[n])
    return problem, solve(problem)


EXAMPLES = [
    pytest.param(kind, n, marks=pytest.mark.campaign if n != QUICK.get(kind, 0) or kind in SLOW else pytest.mark.slow)
    for kind in KINDS
    for n in range(len(list_examples(kind)))
]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "n"), EXAMPLES)
def test_numbers_of_a_report_are_those_of_the_answer_with_their_units(kind, n):
    problem, result = solved(kind, n)
    units = list_symbols(problem)
    page = Tables(report(problem, result, OCCASION, len(result.designs)))
    check_written(page.under("Problem", ""), problem, units)
    check_written(page.under("Search", ""), result.search, units)
    for number, design in enumerate(result.designs, 1):
        section = f"Design {number}: {format_name(design.mechanism.type)}"
        (checks,) = page.under(section, "Checks")
        for row, check in zip(checks["rows"][1:], design.verification.checks, strict=True):
            symbol = "" if check.dimension is None else units[check.dimension]
            unit = symbol if symbol in ("", "°") else f" {symbol}"
            stated = ["" if value is None else f"{format_length(value)}{unit}" for value in (check.value, check.limit)]
            assert row == [format_name(check.name), "✓ passed" if check.passed else "✗ failed", *stated]
        assert check_written(page.under(section, "Dimensions"), design.mechanism, units, {"skeleton"}) or kind in (
            "layshaft_gearbox",
            "balancing",  # a linkage has its skeleton alone
            "spring_balancing",
        )
        assert check_written(page.under(section, "Quantities"), design.metrics, units)
        rest = page.under(section, "Verified motion")
        check_written(rest, design, units, {"mechanism", "metrics", "verification"})


@pytest.mark.parametrize(("kind", "n"), EXAMPLES)
def test_checks_say_what_they_measure(kind, n):
    _, result = solved(kind, n)
    for design in result.designs:
        for check in design.verification.checks:
            compares = check.value is not None or check.limit is not None
            name = re.sub(r"^unit_\d_", "", check.name)
            assert check.dimension == (MEASURING.get(name) if compares else None), check.name


@pytest.mark.parametrize(("kind", "n"), EXAMPLES)
def test_checks_on_a_sheet_are_those_of_the_answer_with_their_units(kind, n):
    problem, result = solved(kind, n)
    units = list_symbols(problem)
    for design in result.designs:
        try:
            drawing = ElementTree.fromstring(export_design(design, problem, "sheet", "svg"))
        except NoSuchExport:
            continue
        rows = [group for group in drawing.iter() if group.get("data-check")]
        assert [row.get("data-check") for row in rows] == [check.name for check in design.verification.checks]
        for row, check in zip(rows, design.verification.checks, strict=True):
            unit = "" if check.dimension is None else units[check.dimension]
            texts = [part.text or "" for part in row.iter() if part.tag.endswith("text")]
            amounts = re.findall(r"([−\d.e]+) ?([^\s()]*)", texts[-1].replace("limit", "")) if len(texts) > 1 else []
            if check.value is None:
                assert not amounts, check.name
                continue
            stated = [value for value in (check.value, check.limit) if value is not None]
            assert [symbol for _, symbol in amounts] == [unit] * len(stated), (check.name, texts)
            for (digits, _), value in zip(amounts, stated, strict=True):
                assert float(digits.replace("−", "-")) == pytest.approx(value, rel=0.06), check.name


LEFT_OUT = {
    "GearTrainMetrics": {"error"},  # stands as the relative error
    "SteeringMetrics": {"correct_at"},  # a list
}
"""Numbers of metrics that a sheet does not write as they are."""


@pytest.mark.parametrize(("kind", "n"), EXAMPLES)
def test_quantities_on_a_sheet_are_those_of_the_answer_with_their_units(kind, n):
    problem, result = solved(kind, n)
    units = list_symbols(problem)
    for design in result.designs:
        drawing = ElementTree.fromstring(export_design(design, problem, "sheet", "svg"))
        blocks = [group for group in drawing.iter() if group.get("data-block") == "metrics"]
        assert len(blocks) == (0 if kind in ("gearbox", "layshaft_gearbox") else 1)
        shown = [part.text for block in blocks for part in block.iter() if part.tag.endswith("text")]
        metrics = type(design.metrics)
        for name, value in design.metrics if blocks else ():
            if isinstance(value, float) and name not in LEFT_OUT.get(metrics.__name__, ()):
                dimension = collect_dimensions(metrics).get(name)
                unit = "" if dimension is None else units[dimension]
                blank = "" if unit in ("", "°") else " "
                assert f"{format_value(value)}{blank}{unit}" in shown, name


@pytest.mark.parametrize(
    ("degrees", "decimals", "told"),
    [(0.0, 0, "0°"), (30.0, 0, "30°"), (-100.2, 0, "−100°"), (30.0, 3, "30°"), (0.25, 3, "0.25°")],
)
def test_angles_keep_their_own_zeros(degrees: float, decimals: int, told: str) -> None:
    assert format_angle(degrees, decimals) == told
