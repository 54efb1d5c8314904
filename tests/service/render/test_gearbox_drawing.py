"""DXF of gearboxes: true teeth in mesh at true distances, sound files, through HTTP too."""

from __future__ import annotations

import io
import itertools
import math
from typing import Any

import ezdxf
import numpy as np
import pytest

from service.render import export_design
from service.render.gears.gearbox_layout import BoxGear, BoxLayout, arrange_gearbox, arrange_layshaft
from synthesis.registry import get_first_example, parse_problem
from tests.campaign import further
from tests.support.answers import solve
from tests.support.service.gear_drawing import assert_involute

TASKS: dict[str, dict[str, Any]] = {
    "six_speeds": get_first_example("gearbox"),
    "three_stages": {
        "kind": "gearbox",
        "input_speed": 300.0,
        "speeds": {"min": 80.0, "series": "R10", "count": 8},
        "structure": [2, 1, 2, 2],
        "tooth_sum": {"min": 50, "max": 60},
        "tolerance": 0.05,
        "module": 2.5,
    },
    "layshaft": get_first_example("layshaft_gearbox"),
    "inches": {
        "kind": "layshaft_gearbox",
        "ratios": [2.5, 1.6, 1.0, 0.8],
        "reverse": 2.4,
        "direct": False,
        "tooth_sum": {"min": 50, "max": 64},
        "module": 0.125,
        "length_unit": "in",
    },
    "no_reverse": {"kind": "layshaft_gearbox", "ratios": [3.0, 1.7, 1.0], "tooth_sum": {"min": 60, "max": 70}},
}
QUICK = [TASKS["no_reverse"]]


@pytest.fixture(scope="module", params=further(TASKS.values(), QUICK), ids=TASKS.keys())
def task(request: pytest.FixtureRequest) -> tuple[Any, Any]:
    problem = parse_problem(request.param)
    return solve(problem).designs[0], problem


def layout_of(design: Any) -> BoxLayout:
    lay = arrange_gearbox if design.mechanism.type == "gearbox" else arrange_layshaft
    return lay(design.mechanism)


def pairs_of(layout: BoxLayout) -> list[list[BoxGear]]:
    return [list(gears) for _, gears in itertools.groupby(layout.gears, key=lambda gear: gear.pair)]


def test_every_pair_meshes(task: tuple[Any, Any]) -> None:
    """Pitch circles touch, and where they do a tooth of one faces the middle of a space of the other."""
    layout = layout_of(task[0])
    meshes = 0
    for gears in pairs_of(layout):
        for one, other in itertools.pairwise(gears):
            radii = one.gear.pitch_radius, other.gear.pitch_radius
            line = other.centre - one.centre
            assert abs(line) == pytest.approx(sum(radii))
            ahead = math.atan2(line.imag, line.real)
            pitch = one.gear.circular_pitch
            arc = radii[0] * math.remainder(one.tooth_at - ahead, 2.0 * math.pi / one.gear.teeth)
            back = radii[1] * math.remainder(other.tooth_at - ahead - math.pi, 2.0 * math.pi / other.gear.teeth)
            assert math.remainder(arc + back - 0.5 * pitch, pitch) == pytest.approx(0.0, abs=1e-9 * pitch)
            meshes += 1
    assert meshes == len(layout.gears) - len(pairs_of(layout))
    for gear in layout.gears:
        assert gear.centre == layout.shafts[gear.shaft].centre
        low, high = layout.shafts[gear.shaft].slots
        assert low <= gear.slot <= high


def test_the_teeth_are_those_of_the_design(task: tuple[Any, Any]) -> None:
    mechanism = task[0].mechanism
    drawn = [[round(gear.gear.teeth) for gear in gears] for gears in pairs_of(layout_of(task[0]))]
    if mechanism.type == "gearbox":
        stated = [[pair.driver, pair.driven] for stage in mechanism.stages for pair in stage.pairs]
        # Driver and driven gear of a stage stand on shafts of all its pairs' distance.
        for k, stage in enumerate(mechanism.stages):
            shafts = layout_of(task[0]).shafts
            assert abs(shafts[k + 1].centre - shafts[k].centre) == pytest.approx(stage.centre_distance)
    else:
        stated = [[mechanism.head.driver, mechanism.head.driven]]
        stated += [[gear.layshaft, gear.mainshaft] for gear in mechanism.gears[::-1] if gear.layshaft]
        if mechanism.reverse is not None:
            back = mechanism.reverse
            stated.append([back.layshaft, back.idler, back.mainshaft])
    assert drawn == stated


@pytest.mark.slow  # reading the files back takes seconds
def test_dxf_is_sound_and_true(task: tuple[Any, Any]) -> None:
    design, problem = task
    text = export_design(design, problem, "Box", "dxf")
    assert text == export_design(design, problem, "Box", "dxf")
    document = ezdxf.read(io.StringIO(text))
    audit = document.audit()
    assert not audit.errors
    assert not audit.fixes
    assert document.units == {"mm": 4, "in": 1}[problem.length_unit]
    space, layout = document.modelspace(), layout_of(design)
    circles = space.query("CIRCLE")
    outlines = [line for line in space.query("LWPOLYLINE") if line.dxf.layer.endswith("_TEETH")]
    boxes = [line for line in space.query("LWPOLYLINE") if line.dxf.layer.endswith("_DEVELOPED")]
    assert len(circles) == len(outlines) == len(boxes) == len(layout.gears)
    for placed, circle, polyline, box in zip(layout.gears, circles, outlines, boxes, strict=True):
        assert circle.dxf.layer == f"{placed.pair}_PITCH"
        assert polyline.dxf.layer == f"{placed.pair}_TEETH"
        assert circle.dxf.radius == pytest.approx(placed.gear.pitch_radius)
        points = np.array([complex(x, y) for x, y in polyline.get_points("xy")]) - placed.centre
        assert_involute(placed.gear, points)
        corners = np.array([complex(x, y) for x, y in box.get_points("xy")])
        assert np.ptp(corners.imag) == pytest.approx(2.0 * placed.gear.tip_radius)
    # In the developed view gears of one pair overlap by their working depth; gears of other pairs never.
    spans = [np.array(box.get_points("xy")) for box in boxes]
    for (one, first), (other, second) in itertools.combinations(zip(layout.gears, spans, strict=True), 2):
        apart = first[:, 0].max() <= second[:, 0].min() or second[:, 0].max() <= first[:, 0].min()
        assert apart == (one.slot != other.slot)
    named = {words.dxf.text for words in space.query("TEXT")}
    assert {shaft.name for shaft in layout.shafts} <= named
    assert {f"z={gear.gear.teeth}" for gear in layout.gears} <= named


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["gearbox", "layshaft_gearbox"])
def test_files_of_gearboxes_through_http(client: Any, kind: str) -> None:
    job = client.post("/v1/jobs", json={"problem": get_first_example(kind)}, headers={"Prefer": "wait=30"})
    assert job.status_code == 200, job.text
    body = job.json()
    assert body["status"] == "succeeded"
    for form, media in (("svg", "image/svg+xml"), ("dxf", "image/vnd.dxf"), ("csv", "text/csv")):
        answer = client.get(f"/v1/jobs/{body['id']}/designs/0.{form}")
        assert answer.status_code == 200, answer.text
        assert answer.headers["content-type"].startswith(media)
    document = ezdxf.read(io.StringIO(client.get(f"/v1/jobs/{body['id']}/designs/0.dxf").text))
    assert not document.audit().errors
    assert document.modelspace().query("LWPOLYLINE")
