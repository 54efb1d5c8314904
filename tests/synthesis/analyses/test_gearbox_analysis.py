"""Analyses of gearboxes: designs as they are, the meshes of the engaged pairs as another route, faults by field."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from kinematics.gear.planetary import GROUND, Mesh, Train, solve_speeds
from synthesis.analyses import get_family, parse_request
from synthesis.analyses.gears.gearbox import GearboxAnalysis, GearboxAnalysisRequest, LayshaftAnalysisRequest
from synthesis.registry import get_first_example, parse_problem
from tests.support.answers import solve


def stated_example(request: Any) -> dict[str, Any]:
    found: dict[str, Any] = request.model_config["json_schema_extra"]["examples"][0]
    return found


def analysis(stated: dict[str, Any]) -> GearboxAnalysis:
    request = parse_request(stated)
    assert request.find_errors() == []
    return GearboxAnalysis.model_validate(request.build_answer())


@pytest.mark.parametrize("kind", ["gearbox", "layshaft_gearbox"])
def test_designs_turn_as_they_are(kind: str) -> None:
    design: Any = solve(parse_problem(get_first_example(kind))).designs[0]
    mechanism = design.mechanism.model_dump(mode="json")
    found = GearboxAnalysis.model_validate(get_family(mechanism).request.analyze_cycle(mechanism, 4))
    assert len(found.input_angle) == 5
    output = found.shafts[-1]
    assert output.angle == pytest.approx([output.speed_ratio * angle for angle in found.input_angle])
    if kind == "gearbox":
        reached = [abs(row.speed_ratio) * mechanism["input_speed"] for row in found.speeds]
        assert reached == pytest.approx([row.speed for row in design.metrics.speeds])
    else:
        ratios = [gear.ratio.value for gear in design.mechanism.gears] + [design.mechanism.reverse.ratio.value]
        assert {row.engaged[0]: 1.0 / row.speed_ratio for row in found.speeds} == pytest.approx(dict(enumerate(ratios)))


def test_directions_by_the_meshes() -> None:
    """Every external mesh turns the direction round; so does the idler once more."""
    stated = stated_example(GearboxAnalysisRequest)
    found = analysis(stated)
    train = Train((Mesh("a", "b", GROUND, 80, 40), Mesh("b", "c", GROUND, 30, 60)))
    rates = solve_speeds(train, {"a": 1}).values
    assert [Fraction(shaft.speed_ratio) for shaft in found.shafts] == [rates["a"], rates["b"], rates["c"]]
    box = stated_example(LayshaftAnalysisRequest)
    back = analysis(box | {"gear": "reverse"})
    meshes = (
        Mesh("in", "lay", GROUND, 24, 36),
        Mesh("lay", "idler", GROUND, 15, 14),
        Mesh("idler", "out", GROUND, 14, 33),
    )
    rates = solve_speeds(Train(meshes), {"in": 1}).values
    assert [shaft.speed_ratio for shaft in back.shafts] == pytest.approx([float(rate or 0) for rate in rates.values()])
    assert analysis(box | {"gear": 3}).shafts[-1].speed_ratio == 1.0


@pytest.mark.parametrize(
    ("kind", "changed", "path"),
    [
        (GearboxAnalysisRequest, {"engaged": [0]}, "/engaged"),
        (GearboxAnalysisRequest, {"engaged": [0, 5]}, "/engaged/1"),
        (GearboxAnalysisRequest, {"motion": {"at": 0.0, "speed": 1.0, "speed_rpm": 1.0}}, "/motion/speed_rpm"),
        (LayshaftAnalysisRequest, {"gear": 9}, "/gear"),
    ],
)
def test_faults_name_their_field(kind: Any, changed: dict[str, Any], path: str) -> None:
    stated = stated_example(kind) | changed
    assert [where for where, _ in parse_request(stated).find_errors()] == [path]
