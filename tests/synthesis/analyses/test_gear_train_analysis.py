"""The analysis of a given gear train: energy, directions, printed values, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pydantic import ValidationError

from synthesis.analyses import parse_request
from synthesis.analyses.gears.gear_train import GearTrainAnalysis, GearTrainAnalysisRequest
from synthesis.dispatch import solve
from synthesis.registry import parse_problem
from tests.support.synthesis.gear_train_analysis import analysed

TWO = [{"driver": 14, "driven": 112, "module": 2.0}, {"driver": 16, "driven": 140, "module": 2.0}]


def test_power_is_torque_by_speed() -> None:
    found = analysed(TWO, input_torque=5.0, motion={"at": 0.0, "speed": 10.0}, mesh_efficiency=0.97)
    power = [shaft.torque * 10.0 * shaft.speed_ratio for shaft in found.shafts]
    assert power == pytest.approx([50.0, 50.0 * 0.97, 50.0 * 0.97**2])
    assert found.efficiency == pytest.approx(0.97**2)
    assert (found.ratio.numerator, found.ratio.denominator) == (70, 1)


def test_forces_carry_the_torque() -> None:
    found = analysed(TWO, input_torque=5.0, mesh_efficiency=1.0, motion={"at": 0.0, "speed": 100.0})
    first, second = found.meshes
    assert first.tangential_force == pytest.approx(5.0 / 0.014)
    assert second.tangential_force == pytest.approx(5.0 * 8.0 / 0.016)
    assert first.radial_force == pytest.approx(first.tangential_force * math.tan(math.radians(20.0)))
    assert first.pitch_line_velocity == pytest.approx(1400.0)
    assert second.pitch_line_velocity == pytest.approx(1600.0 / 8.0)
    assert found.meshes[0].tangential_force * first.pitch_line_velocity * 1e-3 == pytest.approx(500.0)


@pytest.mark.parametrize(("torque", "speed"), [(-5.0, 10.0), (5.0, -10.0)])
def test_the_output_brings_the_losses_where_it_drives(torque: float, speed: float) -> None:
    """Power that leaves at the input is less than what enters at the output, by every mesh that it passes."""
    idlers = [{"stage": 2, "teeth": 30}]
    found = analysed(TWO, idlers, input_torque=torque, motion={"at": 0.0, "speed": speed}, mesh_efficiency=0.97)
    power = [shaft.torque * speed * shaft.speed_ratio for shaft in found.shafts]
    assert power == pytest.approx([-50.0, -50.0 / 0.97, -50.0 / 0.97**3])
    assert found.efficiency == pytest.approx(power[0] / power[-1])
    # The force of a mesh is that of the gear that drives it, here the one nearer the output.
    fast, slow = 10.0 * 0.014, 10.0 / 8.0 * 0.016
    assert [mesh.tangential_force for mesh in found.meshes] == pytest.approx(
        [50.0 / 0.97 / fast, 50.0 / 0.97**2 / slow, 50.0 / 0.97**3 / slow]
    )


def test_teeth_that_lose_all_power_are_not_driven_back() -> None:
    """No torque at the output is enough; a train that drives forwards tells that nothing arrives."""
    mechanism = {"type": "gear_train", "stages": [{"driver": 3, "driven": 3}]}
    stated = {"mechanism": mechanism, "friction": 1.0, "motion": {"at": 0.0}}
    forwards = parse_request({**stated, "input_torque": 1.0})
    assert forwards.find_errors() == []
    assert forwards.build_answer()["efficiency"] == 0.0
    assert [path for path, _ in parse_request({**stated, "input_torque": -1.0}).find_errors()] == ["/friction"]


def test_an_idler_turns_the_direction_and_costs_a_mesh() -> None:
    plain = analysed([{"driver": 20, "driven": 60}], mesh_efficiency=0.98)
    idler = analysed([{"driver": 20, "driven": 60}], [{"stage": 1, "teeth": 30}], mesh_efficiency=0.98)
    assert plain.ratio.value == -3.0
    assert idler.ratio.value == 3.0
    assert idler.efficiency == pytest.approx(0.98**2)
    assert [gear.role for gear in idler.gears] == ["driver", "idler", "driven"]
    assert idler.centre_distances == [70.0]
    assert idler.meshes[1].tangential_force == pytest.approx(0.98 * idler.meshes[0].tangential_force)


def test_angles_follow_the_input() -> None:
    found = analysed(TWO, motion={"from": 0.0, "to": 720.0, "steps": 4, "speed_rpm": 60.0})
    assert found.input_angle == [0.0, 180.0, 360.0, 540.0, 720.0]
    assert found.gears[1].angle == pytest.approx([-angle / 8.0 for angle in found.input_angle])
    assert found.gears[3].omega == pytest.approx([2.0 * math.pi / 70.0] * 5)
    assert found.gears[1].angle == found.gears[2].angle


def test_mesh_geometry_of_norton_example_9_1() -> None:
    """19 and 37 teeth of p_d = 6 at 20°: path 0.798 in, contact ratio 1.62."""
    found = analysed([{"driver": 19, "driven": 37, "module": 1.0 / 6.0}], length_unit="in")
    mesh = found.meshes[0]
    assert mesh.path_of_contact == pytest.approx(0.798, abs=0.0005)
    assert mesh.contact_ratio == pytest.approx(1.62, abs=0.005)
    assert mesh.approach + mesh.recess == pytest.approx(mesh.path_of_contact)
    turned = analysed([{"driver": 37, "driven": 19, "module": 1.0 / 6.0}], length_unit="in").meshes[0]
    assert (turned.approach, turned.recess) == (mesh.recess, mesh.approach)


@pytest.mark.parametrize("shift", [0.05, 0.2])
def test_undercut_of_a_gear_is_that_of_its_mesh(shift: float) -> None:
    """At 25° the straight flank of the rack is deeper than a module: 11 teeth need a shift of 0.08."""
    small, large = {"driver": shift, "driven": 0.0}, {"driver": 0.0, "driven": shift}
    found = analysed(
        [{"driver": 11, "driven": 40, "shift": small}, {"driver": 40, "driven": 11, "shift": large}],
        given={"pressure_angle": 25.0},
    )
    assert [gear.undercut for gear in found.gears] == [shift < 0.08, False, False, shift < 0.08]
    assert [mesh.undercut for mesh in found.meshes] == [shift < 0.08] * 2


def test_friction_costs_about_a_hundredth() -> None:
    found = analysed([{"driver": 20, "driven": 60}], friction=0.06)
    assert found.efficiency is not None
    assert 0.98 < found.efficiency < 0.995
    assert analysed([{"driver": 20, "driven": 60}], friction=0.0).efficiency == 1.0


def test_over_the_cycle_is_one_turn() -> None:
    problem = parse_problem({"kind": "gear_train", "ratio": -70, "max_stages": 2, "teeth": {"min": 12, "max": 150}})
    design = solve(problem, lambda fraction, message: None).designs[0]
    mechanism = design.mechanism.model_dump(mode="json")
    assert parse_request({"mechanism": mechanism}).find_errors() == []
    found = GearTrainAnalysis.model_validate(GearTrainAnalysisRequest.analyze_cycle(mechanism, 36))
    assert found.input_angle[-1] == 360.0
    assert len(found.gears[0].angle) == 37
    assert found.gears[-1].angle[-1] == pytest.approx(-360.0 / 70.0)


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"idlers": [{"stage": 3, "teeth": 20}]}, "/mechanism/idlers/0/stage"),
        ({"ratio": {"numerator": 71, "denominator": 1, "value": 71.0}}, "/mechanism/ratio"),
    ],
)
def test_faults(change: dict[str, Any], path: str) -> None:
    request = parse_request({"mechanism": {"type": "gear_train", "stages": TWO, **change}})
    assert [fault[0] for fault in request.find_errors()] == [path]


@pytest.mark.parametrize(
    "mechanism",
    [
        {"type": "gear_train", "stages": []},
        {"type": "gear_train", "stages": [{"driver": 2, "driven": 30}]},
        {"type": "gear_train", "stages": [{"driver": 20, "driven": 30, "module": 0.0}]},
        {"type": "gear_train", "stages": TWO, "links": {}},
    ],
)
def test_ill_formed_trains_are_refused(mechanism: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        parse_request({"mechanism": mechanism})


@pytest.mark.parametrize("pressure_angle", [14.5, 17.5, 20.0, 25.0, 30.0])
@pytest.mark.parametrize("helix_angle", [0.0, 20.0])
def test_undercut_is_that_of_the_pair_at_every_angle(pressure_angle: float, helix_angle: float) -> None:
    """One rule, that of the rounded rack: 31 teeth at 14.5° are not undercut, 9 teeth at 30° are."""
    for teeth in range(8, 34):
        stage: dict[str, Any] = {"driver": teeth, "driven": 60, "module": 2.0}
        if helix_angle:
            stage |= {"type": "helical", "helix_angle": helix_angle}
        train = analysed([stage], given={"pressure_angle": pressure_angle})
        pair = {
            "type": "gear_pair",
            "teeth": [teeth, 60],
            "module": 2.0,
            "helix_angle": helix_angle,
            "pressure_angle": pressure_angle,
        }
        told = parse_request({"mechanism": pair}).build_answer()["gears"][0]["undercut"]
        assert (train.gears[0].undercut, train.meshes[0].undercut) == (told, told), teeth
        if not helix_angle and (pressure_angle, teeth) in ((14.5, 31), (30.0, 9)):
            assert told == (teeth == 9)
