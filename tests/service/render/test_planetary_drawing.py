"""Files of planetary trains and gearboxes: teeth in mesh, scaled circles, true ray diagrams, whole tables."""

from __future__ import annotations

import cmath
import csv
import io
import math
import xml.etree.ElementTree as ElementTree
from typing import Any

import ezdxf
import pytest

from kinematics.gear.arrangements import ARRANGEMENTS
from service.render import export_design
from service.render.gears.planetary_layout import PlanetaryGear, place_planetary_gears
from synthesis.registry import get_first_example, parse_problem
from tests.support.answers import solve

TRAINS: list[dict[str, Any]] = [
    {"ratio": 5.0, "arrangement": "simple", "input": "sun", "output": "carrier", "planets": 4},
    {"ratio": 7.3, "arrangement": "stepped", "input": "sun", "output": "carrier", "teeth": {"max": 40}},
    {"ratio": -1.8, "arrangement": "double_planet", "teeth": {"max": 26, "ring_max": 80}},
    {"ratio": 2.8, "arrangement": "ravigneaux", "input": "sun_small", "teeth": {"max": 40, "ring_max": 90}},
    {"ratio": 60.0, "arrangement": "wolfrom", "input": "sun", "output": "ring_2", "teeth": {"max": 40, "ring_max": 90}},
    {"ratio": 20.0, "arrangement": "two_stage", "input": "sun_1", "teeth": {"max": 40, "ring_max": 100}},
    {"ratio": 3.2, "arrangement": "simple", "planets": 5, "spacing": "nearest", "teeth": {"max": 30, "ring_max": 80}},
]


def solved(**stated: Any) -> tuple[Any, Any]:
    problem = parse_problem({"kind": "planetary_train", **stated})
    return solve(problem).designs[0], problem


@pytest.mark.parametrize(
    "stated", TRAINS, ids=lambda stated: f"{stated['arrangement']}-{stated.get('spacing', 'equal')}"
)
def test_teeth_of_all_copies_stand_in_spaces(stated: dict[str, Any]) -> None:
    """At every contact of every copy the tooth of one gear faces the middle of a space of the other."""
    design, _ = solved(**stated)
    arrangement = ARRANGEMENTS[design.mechanism.arrangement]
    placed = place_planetary_gears(design.mechanism)
    by_name: dict[str, list[PlanetaryGear]] = {}
    for gear in placed:
        by_name.setdefault(gear.name, []).append(gear)
    contacts = 0
    for one_name, other_name in arrangement.meshes:
        for one in by_name[one_name]:
            for other in by_name[other_name]:
                both = arrangement.is_planet(one_name) and arrangement.is_planet(other_name)
                if both and one.copy != other.copy:
                    continue
                contacts += 1
                internal = one.gear.internal or other.gear.internal
                apart = abs(one.centre - other.centre)
                radii = one.gear.pitch_radius, other.gear.pitch_radius
                assert apart == pytest.approx(abs(radii[0] - radii[1]) if internal else sum(radii))
                ahead = cmath.phase((one.centre or other.centre) if internal else other.centre - one.centre)
                back = ahead if internal else ahead + math.pi
                past = (one.tooth_at - ahead) * radii[0]
                space = (other.tooth_at - back) * radii[1] * (1.0 if internal else -1.0)
                pitch = math.pi * design.mechanism.module
                assert math.remainder(past - space - 0.5 * pitch, pitch) == pytest.approx(0.0, abs=1e-6 * pitch)
    assert contacts >= len(arrangement.meshes) * design.mechanism.planets


@pytest.mark.slow
def test_sheet_dxf_and_table_of_a_planetary_train() -> None:
    design, problem = solved(**TRAINS[0])
    drawn = ElementTree.fromstring(export_design(design, problem, "A & <b>", "svg"))
    circles = [node for node in drawn.iter() if node.get("data-gear")]
    assert len(circles) == 2 + design.mechanism.planets
    radii = {node.get("data-gear"): float(list(node)[1].get("r", "0")) for node in circles}
    teeth = design.mechanism.teeth
    assert radii["ring"] / radii["sun"] == pytest.approx(teeth["ring"] / teeth["sun"], rel=1e-3)
    text = export_design(design, problem, "Train", "dxf")
    assert text == export_design(design, problem, "Train", "dxf")
    document = ezdxf.read(io.StringIO(text))
    assert not document.audit().errors
    pitch = [entity.dxf.radius for entity in document.modelspace().query("CIRCLE")]
    assert max(pitch) == pytest.approx(0.5 * teeth["ring"])
    assert len(document.modelspace().query("LWPOLYLINE")) == 2 + design.mechanism.planets
    rows = list(csv.DictReader(io.StringIO(export_design(design, problem, "Train", "csv"))))
    assert len(rows) == 2 + design.mechanism.planets
    assert {row["gear"]: int(row["teeth"]) for row in rows} == teeth


def test_bevel_differential_is_drawn() -> None:
    design, problem = solved(ratio=2, arrangement="bevel_differential")
    for form in ("svg", "dxf", "csv"):
        assert export_design(design, problem, "Differential", form)


@pytest.mark.parametrize("kind", ["gearbox", "layshaft_gearbox"])
def test_ray_diagrams_and_tables(kind: str) -> None:
    problem = parse_problem(get_first_example(kind))
    design: Any = solve(problem).designs[0]
    drawn = ElementTree.fromstring(export_design(design, problem, "Box", "svg"))
    rays = [tuple(map(float, node.get("data-ray", "").split())) for node in drawn.iter() if node.get("data-ray")]
    nodes = [node.get("data-node", "").split() for node in drawn.iter() if node.get("data-node")]
    rows = list(csv.reader(io.StringIO(export_design(design, problem, "Box", "csv"))))
    if kind == "gearbox":
        assert len(rays) == 3 + 3 * 2
        spindle = sorted(float(speed) for shaft, speed in nodes if shaft == "3")
        assert spindle == pytest.approx([25.0, 50.0, 100.0, 200.0, 400.0, 800.0])
        assert sorted(end for _, end in rays)[-1] == pytest.approx(800.0)
        assert len(rows) == 7
    else:
        assert len(rays) == 1 + 3 + 1
        assert len(rows) == 1 + 1 + 4 + 1
