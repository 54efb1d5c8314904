"""The sheet and the CAD file of trains whose shafts are not parallel: words that stand in nobody's way."""

from __future__ import annotations

import io
import itertools
import xml.etree.ElementTree as ET
from typing import Any

import ezdxf
import numpy as np
import pytest

from service.render import export_design
from service.render.gears.train_layout import place_gears
from service.render.page.svg import Box, estimate_text_width
from synthesis.dispatch import solve
from synthesis.kinds.gear_train.design import GearTrainDesign, GearTrainResult
from synthesis.kinds.gear_train.problem import GearTrainProblem
from synthesis.registry import parse_problem
from tests.support.service.gear_drawing import SVG

BEVEL: dict[str, Any] = {"type": "bevel", "driver": 20, "driven": 20}
TASKS: dict[str, dict[str, Any]] = {
    "worm_beside_a_low_bevel": {
        "ratio": "72",
        "module": [3.0, 4.0, 2.5],
        "stages": [
            {"type": "bevel", "driver": 20, "driven": 30, "shaft_angle": 110.0},
            {"type": "worm", "driver": 2, "driven": 48},
            {"type": "external", "driver": 18, "driven": 36},
        ],
    },
    "small_bevels": {
        "ratio": "40",
        "module": [1.0, 1.0, 1.0, 3.0],
        "stages": [BEVEL, BEVEL, BEVEL, {"type": "worm", "driver": 1, "driven": 40}],
    },
}


@pytest.fixture(scope="module", params=TASKS.values(), ids=TASKS.keys())
def task(request: pytest.FixtureRequest) -> tuple[GearTrainDesign, GearTrainProblem]:
    problem = parse_problem({"kind": "gear_train", "max_designs": 1, **request.param})
    assert isinstance(problem, GearTrainProblem)
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, GearTrainResult)
    return result.designs[0], problem


def around(polygon: ET.Element) -> Box:
    points = [complex(*map(float, pair.split(","))) for pair in polygon.get("points", "").split()]
    return Box.enclose(np.array(points))


def words_of(sheet: ET.Element) -> dict[str, Box]:
    """Captions of the views, by what they say."""
    found = {}
    for node in sheet.iter(f"{SVG}text"):
        words = node.text or ""
        if words.startswith("stage ") and ": " in words:
            x, y, size = (float(node.get(name, "nan")) for name in ("x", "y", "font-size"))
            found[words] = Box(x, y - 0.75 * size, x + estimate_text_width(words, size), y + 0.2 * size)
    return found


def test_captions_stand_beside_gears_and_one_another(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    sheet = ET.fromstring(export_design(*task, "train", "svg"))
    captions = words_of(sheet)
    assert len(captions) == len(task[0].mechanism.stages)
    for one, other in itertools.combinations(captions.values(), 2):
        assert not one.overlaps(other)
    frame = next(node for node in sheet.iter(f"{SVG}rect") if float(node.get("width", "0")) > 300.0)
    bottom = float(frame.get("y", "nan")) + float(frame.get("height", "nan"))
    bar = next(node for node in sheet.iter(f"{SVG}g") if "data-scale-bar" in node.attrib).find(f"{SVG}rect")
    assert bar is not None
    for words, box in captions.items():
        assert box.high < float(bar.get("y", "nan")) < bottom
        for node in sheet.iter(f"{SVG}polygon"):
            assert not box.overlaps(around(node)), words
        for node in sheet.iter(f"{SVG}circle"):
            x, y, radius = (float(node.get(name, "nan")) for name in ("cx", "cy", "r"))
            nearest = complex(max(box.left, min(x, box.right)), max(box.low, min(y, box.high)))
            assert abs(nearest - complex(x, y)) > radius, words


def test_tooth_numbers_leave_a_worm_in_sight(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    sheet = ET.fromstring(export_design(*task, "train", "svg"))
    worm = next(stage for stage in task[0].mechanism.stages if stage.type == "worm")
    body = next(
        polygon
        for group in sheet.iter(f"{SVG}g")
        if group.get("data-teeth") == str(worm.driver) and (polygon := group.find(f"{SVG}polygon")) is not None
    )
    number = next(group for group in sheet.iter(f"{SVG}g") if group.get("data-label") == str(worm.driven))
    frame = number.find(f"{SVG}rect")
    assert frame is not None
    x, y, width, height = (float(frame.get(name, "nan")) for name in ("x", "y", "width", "height"))
    assert not Box(x, y, x + width, y + height).overlaps(around(body))


def test_tables_say_threads_and_no_distance_of_shafts_that_meet(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    stages = task[0].mechanism.stages
    worm = next(stage for stage in stages if stage.type == "worm")
    words = [node.text or "" for node in ET.fromstring(export_design(*task, "train", "svg")).iter(f"{SVG}text")]
    said = "1 thread," if worm.driver == 1 else f"{worm.driver} threads,"
    assert [one for one in words if "thread" in one and one.startswith(said)]
    assert words.count("shaft distance") == sum(stage.type != "bevel" for stage in stages)


def test_captions_of_the_cad_file_stand_above_all_views(task: tuple[GearTrainDesign, GearTrainProblem]) -> None:
    """Letters as wide as they are high."""
    space = ezdxf.read(io.StringIO(export_design(*task, "train", "dxf"))).modelspace()
    top = max(float(gear.get_corners().imag.max()) for gear in place_gears(task[0].mechanism, task[1].reverted))
    boxes = []
    for entity in space.query("TEXT"):
        words, height = entity.dxf.text, entity.dxf.height
        if words.startswith("stage ") and words.split(": ")[1][:2] != "z=":
            at = entity.dxf.align_point
            half = 0.5 * height * len(words)
            boxes.append(Box(at.x - half, at.y - 0.5 * height, at.x + half, at.y + 0.5 * height))
    assert len(boxes) == len(task[0].mechanism.stages)
    assert min(box.low for box in boxes) > top
    for one, other in itertools.combinations(boxes, 2):
        assert not one.overlaps(other)
