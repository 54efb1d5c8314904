"""Forces of bevel, helical and worm stages against statics: balance, friction on the flank, shaft torques."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.gear.worm import WormDrive
from synthesis.analyses import parse_request
from synthesis.analyses.gears.gear_train import GearTrainAnalysis, GearTrainAnalysisRequest
from tests.support.synthesis.gear_train_analysis import analysed

Statement = dict[str, Any]

WORM: Statement = {"type": "worm", "driver": 4, "driven": 40, "module": 2.0, "friction": 0.05}
HELD: Statement = {**WORM, "driver": 6, "diameter_quotient": 4.0, "friction": 1.0}
LOCKING: Statement = {**WORM, "driver": 1, "friction": 0.3}
BEVEL: Statement = {"type": "bevel", "driver": 20, "driven": 30}
SPUR: Statement = {"driver": 20, "driven": 40, "module": 2.0}


def faults(*stages: Statement, **fields: Any) -> list[str]:
    request = parse_request({"mechanism": {"type": "gear_train", "stages": list(stages)}, **fields})
    return [path for path, _ in request.find_errors()]


@pytest.mark.parametrize("torque", [10.0, -10.0])
@pytest.mark.parametrize("efficiency", [None, 0.5])
def test_the_flank_of_a_worm_is_in_balance(torque: float, efficiency: float | None) -> None:
    """The forces turn both shafts as told; across the thread they are the flank's pressure, along it its friction."""
    told = analysed([SPUR, WORM], input_torque=torque, mesh_efficiency=efficiency)
    mesh, (_, driving, driven) = told.meshes[1], told.shafts
    assert mesh.axial_force is not None
    axial, around, apart = mesh.tangential_force, mesh.axial_force.driven, mesh.radial_force
    assert around * 0.010 == pytest.approx(abs(driving.torque), rel=1e-12)
    assert axial * 0.040 == pytest.approx(abs(driven.torque), rel=1e-12)
    lead, phi = math.atan(0.4), math.radians(20.0)
    along, across = (math.cos(lead), math.sin(lead)), (-math.sin(lead), math.cos(lead))
    pressure = apart / math.sin(phi)
    assert np.dot(across, (-around, axial)) == pytest.approx(pressure * math.cos(phi), rel=1e-12)
    # Friction is along the thread, against what drives.
    assert np.dot(along, (around, -axial)) == pytest.approx(math.copysign(0.05 * pressure, torque), rel=1e-12)
    power = [shaft.torque * shaft.speed_ratio for shaft in (driving, driven)]
    assert mesh.efficiency == pytest.approx(min(power[1] / power[0], power[0] / power[1]), rel=1e-12)


def test_a_stated_efficiency_is_that_of_the_other_meshes() -> None:
    stated, plain = (analysed([SPUR, WORM], mesh_efficiency=share) for share in (0.5, None))
    assert stated.meshes[0].efficiency == 0.5
    assert stated.meshes[1].efficiency == plain.meshes[1].efficiency
    assert faults(WORM, mesh_efficiency=0.5) == ["/mesh_efficiency"]


def test_a_stated_efficiency_unlocks_no_worm() -> None:
    assert faults(SPUR, LOCKING, input_torque=-10.0, mesh_efficiency=0.9) == ["/mechanism/stages/1/friction"]
    assert faults(SPUR, LOCKING, input_torque=10.0, mesh_efficiency=0.9) == []


def test_a_torque_on_a_worm_that_friction_holds_is_refused() -> None:
    """So steep a thread is held when the worm drives; its gear drives it."""
    assert faults(SPUR, HELD, input_torque=10.0) == ["/mechanism/stages/1/friction"]
    assert faults(SPUR, HELD, input_torque=-10.0) == []
    mesh = analysed([SPUR, HELD], input_torque=0.0).meshes[1]
    assert (mesh.efficiency, mesh.tangential_force, mesh.radial_force) == (0.0, 0.0, 0.0)
    mechanism = {"type": "gear_train", "stages": [HELD]}
    cycle = GearTrainAnalysis.model_validate(GearTrainAnalysisRequest.analyze_cycle(mechanism, 4))
    assert cycle.gears[1].angle[-1] == pytest.approx(360.0 * 6 / 40)
    assert cycle.meshes[0].tangential_force == 0.0
    for worm, friction in ((WormDrive(6, 40, 2.0, 4.0), 1.0), (WormDrive(1, 40, 2.0, 10.0), -0.3)):
        with pytest.raises(DimensionError):
            worm.forces(10.0, friction)


@pytest.mark.parametrize(("unit", "torque"), [(LOCKING, -1.0), (HELD, 1.0)])
def test_a_series_refuses_a_worm_that_friction_holds(unit: Statement, torque: float) -> None:
    """At the stage of its unit; the other way round the locking worm drives."""
    units = [{"type": "gear_train", "stages": [stage]} for stage in (SPUR, unit)]
    series = {"mechanism": {"type": "train_series", "units": units}, "motion": {"at": 0.0}}
    request = parse_request({**series, "input_torque": torque})
    assert [path for path, _ in request.find_errors()] == ["/mechanism/units/1/stages/0/friction"]
    free = parse_request({**series, "input_torque": 1.0})
    if unit is LOCKING:
        assert free.find_errors() == []
        assert free.build_answer()["efficiency"] == pytest.approx(0.99 * WormDrive(1, 40, 2.0, 10.0).efficiency(0.3))


@pytest.mark.parametrize("shaft_angle", [60.0, 90.0, 110.0])
@pytest.mark.parametrize(("driver", "driven"), [(20, 30), (30, 20), (25, 25)])
def test_forces_of_bevel_gears_are_each_others_reaction(shaft_angle: float, driver: int, driven: int) -> None:
    """In the plane of the shafts what pushes one gear off its apex and to its axis pushes the other one back."""
    stage = {**BEVEL, "driver": driver, "driven": driven, "shaft_angle": shaft_angle, "face_width": 3.0}
    mesh = analysed([stage], input_torque=10.0).meshes[0]
    assert mesh.axial_force is not None
    assert mesh.radial_forces is not None
    assert mesh.radial_force == mesh.radial_forces.driver
    # From the apex outwards: the driver's axis along 1, the driven one at the shaft angle; contact lies between.
    axis = np.exp(1j * math.radians(shaft_angle))
    on_driver = mesh.axial_force.driver - 1j * mesh.radial_forces.driver
    on_driven = axis * (mesh.axial_force.driven + 1j * mesh.radial_forces.driven)
    assert abs(on_driver + on_driven) < 1e-9 * mesh.tangential_force
    assert abs(on_driven) == pytest.approx(mesh.tangential_force * math.tan(math.radians(20.0)), rel=1e-12)


@pytest.mark.parametrize("angle", [15.0, -15.0])
@pytest.mark.parametrize("speed", [10.0, -10.0])
def test_axial_force_of_helical_gears_is_along_the_axis_of_their_shaft(angle: float, speed: float) -> None:
    """Behind a left-handed worm: a flank pushes across its teeth, against the way of the gear that drives."""
    helical = {"type": "helical", "driver": 20, "driven": 30, "module": 2.0, "helix_angle": angle}
    motion = {"at": 0.0, "speed": speed}
    told = analysed([{**WORM, "hand": "left"}, helical], input_torque=math.copysign(10.0, speed), motion=motion)
    shaft, mesh = told.shafts[1], told.meshes[1]
    assert shaft.axis is not None
    assert mesh.axial_force is not None
    assert shaft.speed_ratio < 0.0
    axis = np.array(shaft.axis)
    outwards = np.cross(axis, [0.6, 0.64, 0.48])
    outwards /= np.linalg.norm(outwards)
    around = np.cross(axis, outwards)
    tooth = math.cos(math.radians(angle)) * axis + math.sin(math.radians(angle)) * around
    push = np.cross(outwards, tooth)
    # Against the way of the driver's teeth.
    push *= -math.copysign(mesh.tangential_force, shaft.speed_ratio * speed) / float(push @ around)
    positive = math.copysign(1.0, speed) * axis
    assert mesh.axial_force.driver == pytest.approx(float(push @ positive), rel=1e-12)
    assert mesh.axial_force.driven == -mesh.axial_force.driver


def test_a_face_of_bevel_gears_ends_before_the_apex() -> None:
    """20 and 30 teeth of module 1: the cones are √(10² + 15²) long."""
    far = math.hypot(10.0, 15.0)
    for face in (far * (1.0 + 1e-12), 500.0):
        assert faults(SPUR, {**BEVEL, "face_width": face}) == ["/mechanism/stages/1/face_width"]
    mesh = analysed([{**BEVEL, "face_width": 0.999 * far}]).meshes[0]
    assert mesh.tangential_force == pytest.approx(1000.0 / (10.0 * (1.0 - 0.4995)))
