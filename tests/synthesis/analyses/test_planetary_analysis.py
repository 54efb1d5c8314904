"""Analyses of planetary trains: printed speeds, torques and efficiencies as a client asks for them."""

from __future__ import annotations

from typing import Any

import pytest

from synthesis.analyses import parse_request
from synthesis.analyses.gears.planetary_train import PlanetaryAnalysis, PlanetaryAnalysisRequest
from synthesis.registry import get_first_example, parse_problem
from tests.support.answers import solve

SIMPLE: dict[str, Any] = {
    "type": "planetary_train",
    "arrangement": "simple",
    "teeth": {"sun": 40, "planet": 20, "ring": 80},
}


def analysis(**stated: Any) -> PlanetaryAnalysis:
    request = parse_request(stated)
    assert isinstance(request, PlanetaryAnalysisRequest)
    assert request.find_errors() == []
    return PlanetaryAnalysis.model_validate(request.build_answer())


def faults(**stated: Any) -> list[str]:
    return [path for path, _ in parse_request(stated).find_errors()]


def test_norton_example_9_5() -> None:
    found = analysis(mechanism=SIMPLE, speeds={"carrier": -200.0, "sun": -100.0})
    speeds = {body.name: body.speed for body in found.bodies}
    assert speeds == {"sun": -100.0, "planet": -400.0, "carrier": -200.0, "ring": -250.0}
    assert (found.freedom, found.open_speeds, found.contradiction) == (2, 0, None)


def test_rao_problem_8_10_by_its_meshes() -> None:
    """A train of the client's own: stepped planet, annulus held, 100 N m on the carrier."""
    meshes = [
        {"first": "A", "second": "P", "carrier": "C", "first_teeth": 52, "second_teeth": 15},
        {"first": "P", "second": "B", "carrier": "C", "first_teeth": 25, "second_teeth": 92, "internal": True},
    ]
    mechanism = {"type": "planetary_train", "meshes": meshes, "planet_bodies": ["P"], "input": "C", "output": "A"}
    found = analysis(mechanism=mechanism, speeds={"C": 200.0, "B": 0.0}, torques={"C": 100.0}, mesh_efficiency=1.0)
    torques = {body.name: body.torque for body in found.bodies}
    assert torques["A"] == pytest.approx(-48.5, abs=0.05)
    assert torques["B"] == pytest.approx(-51.5, abs=0.05)
    assert torques["P"] is None
    assert found.efficiency == 1.0
    assert found.ratio == pytest.approx(1.0 / 2.06154, rel=1e-5)


def test_efficiency_and_motion_of_a_driven_train() -> None:
    """sun to carrier, ring held: (s + η² r)/(s + r); angles follow the input's."""
    mechanism = SIMPLE | {"input": "sun", "output": "carrier", "fixed": "ring"}
    found = analysis(
        mechanism=mechanism, motion={"from": 0.0, "to": 360.0, "steps": 4, "speed": 6.0}, mesh_efficiency=0.98
    )
    assert found.exact_ratio == "3"
    assert found.efficiency == pytest.approx((40.0 + 0.98**2 * 80.0) / 120.0, rel=1e-12)
    carrier = next(body for body in found.bodies if body.name == "carrier")
    assert carrier.angle == pytest.approx([0.0, 30.0, 60.0, 90.0, 120.0])
    assert carrier.speed == pytest.approx(2.0)
    powers = sum(body.power for body in found.bodies if body.power is not None)
    assert powers == pytest.approx(sum(mesh.loss for mesh in found.meshes if mesh.loss is not None))
    assert not found.circulating_power


def test_what_does_not_follow_is_told() -> None:
    free = analysis(mechanism=SIMPLE, speeds={"sun": 1.0})
    assert (free.open_speeds, free.valid[0], free.efficiency) == (1, False, None)
    over = analysis(mechanism=SIMPLE, speeds={"sun": 1.0, "carrier": 1.0, "ring": 2.0})
    assert over.contradiction == "ring"
    joined = analysis(mechanism=SIMPLE, speeds={"sun": 5.0}, locked=[["sun", "ring"]])
    assert {body.speed for body in joined.bodies} == {5.0}
    assert joined.efficiency is None


def test_designs_are_analysed_as_they_are() -> None:
    result = solve(parse_problem(get_first_example("planetary_train")))
    design = result.designs[0]
    found = PlanetaryAnalysis.model_validate(PlanetaryAnalysisRequest.analyze_cycle(design.mechanism.model_dump(), 8))
    assert found.ratio == design.mechanism.ratio.value
    assert found.efficiency == pytest.approx(design.metrics.efficiency)
    assert len(found.input_angle) == 9


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"mechanism": SIMPLE | {"arrangement": "moon"}}, "/mechanism/arrangement"),
        ({"mechanism": SIMPLE | {"teeth": {"sun": 40}}}, "/mechanism/teeth"),
        ({"mechanism": SIMPLE, "speeds": {"moon": 1.0}}, "/speeds/moon"),
        ({"mechanism": SIMPLE, "speeds": {"sun": 1.0}, "torques": {"planet": 1.0}}, "/torques/planet"),
        ({"mechanism": SIMPLE, "speeds": {"sun": 1.0}, "loads": ["moon"]}, "/loads/0"),
        ({"mechanism": SIMPLE, "speeds": {"sun": 1.0}, "locked": [["sun", "moon"]]}, "/locked/0"),
        ({"mechanism": SIMPLE}, "/speeds"),
        ({"mechanism": SIMPLE | {"input": "moon"}}, "/mechanism/input"),
        (
            {"mechanism": SIMPLE | {"input": "sun"}, "motion": {"at": 0.0, "speed": 1.0, "speed_rpm": 1.0}},
            "/motion/speed_rpm",
        ),
    ],
)
def test_faults_name_their_field(stated: dict[str, Any], path: str) -> None:
    assert faults(**stated) == [path]
