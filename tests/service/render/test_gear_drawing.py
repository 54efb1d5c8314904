"""Files of gear trains: what the drawing shows is the train that was designed."""

from __future__ import annotations

import csv
import io
import itertools
import math
import xml.etree.ElementTree as ET
from fractions import Fraction
from typing import Any

import ezdxf
import numpy as np
import pytest

from service.render import export_design
from service.render.gears.train_layout import TrainGear, place_gears
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainDesign, GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.service.gear_drawing import SVG, assert_involute

TASKS: dict[str, dict[str, Any]] = {
    "two_stages": {"ratio": "pi", "max_stages": 2, "teeth": {"min": 15, "max": 100}},
    "idler": {
        "ratio": -70,
        "max_stages": 2,
        "teeth": {"min": 18, "max": 180},
        "module": [1.5, 2.0],
        "length_unit": "cm",
    },
    "reverted": {"ratio": 12, "max_stages": 2, "teeth": {"min": 18, "max": 90}, "reverted": True, "tolerance": 0},
    "triangle": {
        "ratio": -70,
        "max_stages": 3,
        "teeth": {"min": 18, "max": 150},
        "reverted": True,
        "diametral_pitch": 10,
    },
    "one_stage": {"ratio": 3, "max_stages": 1, "length_unit": "in"},
}
QUICK = [TASKS["reverted"], TASKS["one_stage"]]


@pytest.fixture(scope="module", params=further(TASKS.values(), QUICK), ids=TASKS.keys())
def task(request: pytest.FixtureRequest) -> tuple[GearTrainDesign, GearTrainProblem]:
    problem = parse_problem({"kind": "gear_train", **request.param})
    assert isinstance(problem, GearTrainProblem)
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    return result.designs[0], problem


def drawn(task: tuple[GearTrainDesign, GearTrainProblem]) -> list[TrainGear]:
    return place_gears(task[0].mechanism, task[1].reverted)


def test_meshing_pitch_circles_touch(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    gears = drawn(task)
    for one, other in itertools.pairwise(gears):
        apart = abs(other.centre - one.centre)
        if other.role == "driver":
            assert apart < 1e-9
            assert other.speed == one.speed
        else:
            assert apart == pytest.approx(one.pitch_radius + other.pitch_radius)
            assert other.speed == -one.speed * one.gear.teeth / other.gear.teeth
    assert 1 / gears[-1].speed == Fraction(task[0].mechanism.ratio.numerator, task[0].mechanism.ratio.denominator)
    if task[1].reverted:
        assert abs(gears[-1].centre - gears[0].centre) < 1e-9 * gears[-1].pitch_radius


def test_meshing_teeth_stand_in_spaces(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    """At the point of contact of the pitch circles tooth and space alternate: their arcs differ by half a pitch."""
    gears = drawn(task)
    for one, other in itertools.pairwise(gears):
        if other.role == "driver":
            continue
        ahead = math.atan2((other.centre - one.centre).imag, (other.centre - one.centre).real)
        pitch = one.gear.circular_pitch
        first = one.pitch_radius * math.remainder(one.tooth_at - ahead, 2.0 * math.pi / one.gear.teeth)
        back = math.remainder(other.tooth_at - ahead - math.pi, 2.0 * math.pi / other.gear.teeth)
        # Both as arcs in the same direction along the common tangent.
        assert math.remainder(first + other.pitch_radius * back - 0.5 * pitch, pitch) == pytest.approx(
            0.0, abs=1e-9 * pitch
        )


def test_svg_shows_every_gear_to_scale(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    design, problem = task
    sheet = ET.fromstring(export_design(design, problem, "A <train> & more", "svg"))
    groups = [group for group in sheet.iter(f"{SVG}g") if "data-gear" in group.attrib]
    gears = drawn(task)
    assert [int(group.get("data-teeth", "0")) for group in groups] == [placed.gear.teeth for placed in gears]
    scales = [
        float(group.findall(f"{SVG}circle")[1].get("r", "nan")) / placed.pitch_radius
        for group, placed in zip(groups, gears, strict=True)
    ]
    assert max(scales) / min(scales) == pytest.approx(1.0, rel=2e-3)
    labels = [group.get("data-label") for group in sheet.iter(f"{SVG}g") if "data-label" in group.attrib]
    assert labels == [str(placed.gear.teeth) for placed in gears]
    assert sheet.find(f"{SVG}title").text == "A <train> & more"
    assert not [node for node in sheet.iter() if "id" in node.attrib]
    width, height = float(sheet.get("width", "0")), float(sheet.get("height", "0"))
    for circle in sheet.iter(f"{SVG}circle"):
        x, y, r = (float(circle.get(name, "nan")) for name in ("cx", "cy", "r"))
        assert r <= x <= width - r
        assert r <= y <= height - r


@pytest.mark.slow  # reading the file back takes seconds
def test_dxf_has_pitch_circles_and_involute_teeth(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    design, problem = task
    text = export_design(design, problem, "train", "dxf")
    assert text == export_design(design, problem, "train", "dxf")
    document = ezdxf.read(io.StringIO(text))
    assert not document.audit().has_errors
    assert document.units == {"mm": 4, "cm": 5, "m": 6, "in": 1}[problem.length_unit]
    space = document.modelspace()
    gears = drawn(task)
    circles, outlines = space.query("CIRCLE"), space.query("LWPOLYLINE")
    assert len(circles) == len(outlines) == len(gears)
    for placed, circle, polyline in zip(gears, circles, outlines, strict=True):
        assert circle.dxf.layer == f"STAGE_{placed.stage}_PITCH"
        assert circle.dxf.radius == pytest.approx(placed.pitch_radius)
        assert polyline.closed
        points = np.array([complex(x, y) for x, y in polyline.get_points("xy")]) - placed.centre
        assert_involute(placed.gear, points)


def test_csv_lists_every_gear(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    design, problem = task
    rows = list(csv.DictReader(io.StringIO(export_design(design, problem, "train", "csv"))))
    gears = drawn(task)
    assert [int(row["teeth"]) for row in rows] == [placed.gear.teeth for placed in gears]
    for row, placed in zip(rows, gears, strict=True):
        assert float(row[f"pitch_diameter_{problem.length_unit}"]) == 2.0 * placed.pitch_radius
        assert Fraction(row["speed_over_input"]) == placed.speed


def test_numbers_of_the_table_by_hand() -> None:
    """Full-depth gears of two stages: circles from teeth and module, shafts apart by half the teeth, exact speeds."""
    stated = {"kind": "gear_train", "ratio": "35/6", "max_stages": 2, "teeth": {"min": 20, "max": 60}, "tolerance": 0.0}
    problem = parse_problem({**stated, "module": 2.5, "pressure_angle": 25.0})
    assert isinstance(problem, GearTrainProblem)
    design = solve(problem, lambda fraction, message: None).designs[0]
    rows = list(csv.DictReader(io.StringIO(export_design(design, problem, "train", "csv"))))
    stages = design.mechanism.stages
    teeth = [n for stage in stages for n in (stage.driver, stage.driven)]
    assert len(teeth) == 4
    assert [(row["stage"], row["role"]) for row in rows] == [
        ("1", "driver"), ("1", "driven"), ("2", "driver"), ("2", "driven"),
    ]  # fmt: skip
    for row, z in zip(rows, teeth, strict=True):
        assert int(row["teeth"]) == z
        circles = {"module": 2.5, "pitch_diameter": 2.5 * z, "outside_diameter": 2.5 * (z + 2.0)}
        circles |= {"root_diameter": 2.5 * (z - 2.5), "base_diameter": 2.5 * z * math.cos(math.radians(25.0))}
        for name, value in circles.items():
            assert float(row[f"{name}_mm"]) == pytest.approx(value, rel=1e-12), name
    centres = [complex(float(row["centre_x_mm"]), float(row["centre_y_mm"])) for row in rows]
    assert centres[1] == centres[2]
    for k in (0, 2):
        assert abs(centres[k + 1] - centres[k]) == pytest.approx(1.25 * (teeth[k] + teeth[k + 1]))
    second = -Fraction(teeth[0], teeth[1])
    assert [Fraction(row["speed_over_input"]) for row in rows] == [1, second, second, Fraction(6, 35)]
