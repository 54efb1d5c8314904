"""``POST /v1/analyses`` of cams: what a profile does, cams of specified contour, several cams on one shaft."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

from kinematics.cam.dynamics import Camshaft, FollowerLoad, RunningCam
from kinematics.cam.follower import Follower, OscillatingFlat, OscillatingRoller, TranslatingFlat, TranslatingRoller
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import Cam, space_angles
from synthesis.analyses import parse_request
from synthesis.analyses.cams.cam import CamAnalysis, CamAnalysisRequest
from synthesis.analyses.cams.camshaft import CamshaftAnalysis, CamshaftAnalysisRequest
from synthesis.analyses.cams.contour_cam import ContourCamAnalysis, ContourCamAnalysisRequest
from synthesis.mechanisms import MechanismError
from tests.oracles.cam_formulas import cutter_path, largest_cutter

STATED: dict[str, tuple[Follower, dict[str, Any]]] = {
    "translating_roller": (
        TranslatingRoller(40.0, 10.0, 4.0),
        {"follower": {"type": "translating_roller", "roller_radius": 10.0, "offset": 4.0}, "prime_radius": 40.0},
    ),
    "oscillating_roller": (
        OscillatingRoller(40.0, 10.0, 60.0, 70.0, -1),
        {
            "follower": {
                "type": "oscillating_roller",
                "roller_radius": 10.0,
                "arm": 60.0,
                "pivot_distance": 70.0,
                "sense": -1,
            },
            "prime_radius": 40.0,
        },
    ),
    "translating_flat": (
        TranslatingFlat(40.0),
        {"follower": {"type": "translating_flat"}, "base_radius": 40.0},
    ),
    "oscillating_flat": (
        OscillatingFlat(40.0, 100.0, 5.0),
        {
            "follower": {"type": "oscillating_flat", "pivot_distance": 100.0, "face_offset": 5.0},
            "base_radius": 40.0,
        },
    ),
}


def cam_of(kind: str, rotation: str = "cw", rise: float = 8.0) -> tuple[Cam, dict[str, Any]]:
    follower, stated = STATED[kind]
    lift = math.radians(rise) if kind.startswith("oscillating") else rise
    program = Program(
        [
            build_law_segment(LAWS["cycloidal"], TURN / 3.0, 0.0, lift),
            build_dwell(TURN / 6.0, lift),
            build_law_segment(LAWS["polynomial_4567"], TURN / 2.0, lift, 0.0),
        ]
    )
    cam = Cam(program, follower, rotation)
    points = cam.profile(space_angles(720))
    profile = {"x": points.real.tolist(), "y": points.imag.tolist()}
    return cam, {"type": "cam", "rotation": rotation, "profile": profile, **stated}


def answer(client: Any, body: dict[str, Any]) -> dict[str, Any]:
    response = client.post("/v1/analyses", json=body)
    assert response.status_code == 200, response.text
    return response.json()


@pytest.mark.parametrize("rotation", ["ccw", "cw"])
@pytest.mark.parametrize("kind", STATED)
def test_motion_and_forces_from_the_profile_are_the_programs(kind: str, rotation: str) -> None:
    cam, mechanism = cam_of(kind, rotation)
    request = CamAnalysisRequest.model_validate(
        {
            "mechanism": mechanism,
            "motion": {"from": 0.0, "to": 360.0, "steps": 90, "speed": 12.0, "acceleration": 3.0},
            "load": {"mass": 2.0, "spring_rate": 50.0, "preload": 20.0, "damping": 0.3},
            "cutter": {"radius": 20.0},
        }
    )
    found = request.build_answer()
    CamAnalysis.model_validate_json(json.dumps(found))
    angles = np.radians(found["input_angle"])
    motion = cam.program.motion(angles)
    unit = 180.0 / math.pi if kind.startswith("oscillating") else 1.0
    assert found["follower"]["position"] == pytest.approx(motion.s * unit, abs=1e-6)
    assert found["follower"]["velocity"] == pytest.approx(12.0 * motion.v, abs=1e-3 * 12.0)
    largest = 144.0 * cam.program.peaks[2].largest
    acceleration = 144.0 * motion.a + 3.0 * motion.v
    assert found["follower"]["acceleration"] == pytest.approx(acceleration, abs=0.05 * largest)
    rate = np.array(found["follower"]["acceleration"])
    force = 2.0 * rate + 0.3 * 12.0 * motion.v + 50.0 * motion.s + 20.0
    assert found["forces"]["along"] == pytest.approx(force, abs=1e-2)
    assert found["forces"]["torque"] == pytest.approx(force * motion.v, abs=0.1)
    assert found["pressure_angle"] == pytest.approx(np.degrees(np.abs(cam.pressure_angle(angles))), abs=0.01)
    path = np.array(found["cutter_path"]["x"]) + 1j * np.array(found["cutter_path"]["y"])
    assert path == pytest.approx(cutter_path(cam, angles, 20.0), abs=2e-3)
    assert found["profile"]["cusped"] is False
    assert found["profile"]["crossings"] == []


def test_a_cutters_path_keeps_its_chords() -> None:
    cam, mechanism = cam_of("translating_roller", rise=45.0)
    body = {"mechanism": mechanism, "cutter": {"radius": 12.0, "chordal_tolerance": 0.02}}
    path = CamAnalysisRequest.model_validate(body).build_answer()["cutter_path"]
    points = np.array(path["x"]) + 1j * np.array(path["y"])
    fine = cutter_path(cam, space_angles(20_000), 12.0)
    at = np.radians([*path["angle"], 360.0])
    index = np.searchsorted(at, space_angles(20_000), side="right") - 1
    chord = np.roll(points, -1) - points
    off = np.abs(((fine - points[index]) * np.conj(chord[index])).imag / np.abs(chord[index]))
    assert 0.005 < off.max() < 0.025
    assert len(points) < 200
    assert path["gouges"] is False
    hollow = largest_cutter(cam)
    body["cutter"] = {"radius": 1.01 * hollow}
    assert CamAnalysisRequest.model_validate(body).build_answer()["cutter_path"]["gouges"] is True


def test_vibration_of_an_elastic_follower() -> None:
    _, mechanism = cam_of("translating_roller")
    train = {"mass": 1.0, "stiffness": 9000.0, "damping": 20.0, "spring_rate": 100.0, "preload": 500.0}
    body = {"mechanism": mechanism, "motion": {"steps": 360, "speed": 8.0}, "train": train}
    found = CamAnalysisRequest.model_validate(body).build_answer()["response"]
    assert found["natural_frequency"] == pytest.approx(math.sqrt(9100.0))
    assert found["too_slow"] is False
    rest = -500.0 / 9100.0
    # Late in the dwell at the top the swing has died out, and the return spring holds the mass back.
    assert found["lag"][179] == pytest.approx(rest - 100.0 * 8.0 / 9100.0, abs=0.02)
    assert found["least_contact_force"] > 0.0


def test_a_profile_that_crosses_itself_is_told() -> None:
    angles = space_angles(2000)
    bad = (30.0 + 24.0 * np.cos(3.0 * angles)) * np.exp(1j * (angles + 0.9 * np.sin(3.0 * angles)))
    mechanism = {**cam_of("translating_roller")[1], "profile": {"x": bad.real.tolist(), "y": bad.imag.tolist()}}
    found = CamAnalysisRequest.model_validate({"mechanism": mechanism}).build_answer()
    assert found["profile"]["crossings"]


def test_contour_cams_over_http(client: Any) -> None:
    example = ContourCamAnalysisRequest.get_example()
    found = answer(client, example)
    ContourCamAnalysis.model_validate(found)
    assert found["base_radius"] == 32.5
    assert found["prime_radius"] == 42.5
    assert found["follower"]["position"][0] == pytest.approx(12.5)
    assert found["follower"]["position"][180] == pytest.approx(0.0, abs=1e-9)
    assert found["max_pressure_angle"] >= max(map(abs, found["pressure_angle"]))
    by_time = np.gradient(found["follower"]["position"], math.radians(1.0) / (200.0 * math.pi / 30.0))
    assert found["follower"]["velocity"][100:150] == pytest.approx(by_time[100:150], abs=1.5)
    for contour, radius in (
        ({"shape": "eccentric_circle", "radius": 35.0, "eccentricity": 12.0}, 23.0),
        ({"shape": "tangent", "base_radius": 22.5, "nose_radius": 18.0, "nose_distance": 17.0}, 22.5),
        (
            {
                "shape": "circular_arc",
                "base_radius": 32.5,
                "nose_radius": 15.0,
                "nose_distance": 30.0,
                "half_action_angle": 75.32,
            },
            32.5,
        ),
    ):
        face = ContourCamAnalysisRequest.model_validate({"mechanism": {"type": "contour_cam", "contour": contour}})
        assert face.build_answer()["base_radius"] == radius
    body = {"mechanism": {"type": "contour_cam", "contour": {**contour, "flank_radius": 60.0}}}
    assert client.post("/v1/analyses", json=body).status_code == 422


def test_several_cams_on_one_shaft_over_http(client: Any) -> None:
    one, first = cam_of("translating_roller")
    two, second = cam_of("oscillating_flat", "ccw")
    load = {"mass": 2.0, "spring_rate": 50.0, "preload": 300.0, "damping": 0.3}
    cams = [{"cam": first, "load": load, "phase": 0.0}, {"cam": second, "load": load, "phase": 70.0}]
    body = {
        "mechanism": {"type": "camshaft", "cams": cams, "fluctuation": 0.05},
        "motion": {"steps": 360, "speed": 6.0},
    }
    found = answer(client, body)
    CamshaftAnalysis.model_validate(found)
    core = FollowerLoad(2.0, 50.0, 300.0, 0.3)
    shaft = Camshaft([RunningCam(one.program, core, 6.0), RunningCam(two.program, core, 6.0, math.radians(70.0))])
    assert found["max_torque"] == pytest.approx(shaft.torque_extremes.greatest, rel=1e-3)
    assert found["min_torque"] == pytest.approx(shaft.torque_extremes.least, rel=1e-3)
    assert found["mean_torque"] == pytest.approx(shaft.mean_torque, rel=1e-3)
    assert found["energy_fluctuation"] == pytest.approx(shaft.energy_fluctuation, rel=1e-3)
    assert found["flywheel_inertia"] == pytest.approx(shaft.compute_flywheel_inertia(0.05), rel=1e-3)
    assert np.sum(found["torques"], axis=0) == pytest.approx(found["torque"])
    jump = RunningCam(one.program, core, 1.0).find_jump_speed()
    assert found["jump_speeds"][0] == pytest.approx(jump, rel=2e-2)


def test_bad_cams_are_refused_by_field(client: Any) -> None:
    _, good = cam_of("translating_roller")
    for mechanism, path in (
        ({**good, "follower": {"type": "translating_roller"}}, "/mechanism/follower/roller_radius"),
        ({**good, "prime_radius": None}, "/mechanism/prime_radius"),
        ({**good, "prime_radius": 5.0}, "/mechanism/follower"),
        ({**good, "profile": {**good["profile"], "y": good["profile"]["y"][1:]}}, "/mechanism/profile/y"),
        ({**good, "profile": {"x": [1.0] * 30, "y": [1.0] * 30}}, "/mechanism/profile"),
    ):
        response = client.post("/v1/analyses", json={"mechanism": mechanism})
        assert response.status_code == 422, path
        assert response.json()["errors"][0]["path"] == path
    beside = {**good, "follower": {"type": "translating_roller", "roller_radius": 10.0, "offset": 39.0}}
    moved = {**beside, "profile": {axis: [0.1 * v for v in good["profile"][axis]] for axis in ("x", "y")}}
    found = CamAnalysisRequest.model_validate({"mechanism": moved}).build_answer()
    assert not any(found["valid"])
    with pytest.raises(MechanismError, match="too many points"):
        _many().build_answer()


def _many() -> CamAnalysisRequest:
    circle = 40.0 * np.exp(1j * space_angles(20_000))
    profile = {"x": circle.real.tolist(), "y": circle.imag.tolist()}
    mechanism = {"type": "cam", "follower": {"type": "translating_flat"}, "base_radius": 40.0, "profile": profile}
    return CamAnalysisRequest.model_validate({"mechanism": mechanism, "motion": {"steps": 9999}})


def test_faults_of_motions() -> None:
    cam = CamAnalysisRequest.get_example()
    shaft = CamshaftAnalysisRequest.get_example()
    train = {"mass": 1.0, "stiffness": 1.0}
    for body, path in (
        ({**cam, "motion": {"speed": 1.0, "speed_rpm": 1.0}}, "/motion/speed_rpm"),
        ({**cam, "motion": {"time": {"start": 1.0, "end": 0.0, "step": 0.1}}}, "/motion/time/end"),
        ({**cam, "motion": {"speed": -1.0}, "train": train}, "/motion/speed"),
        ({**shaft, "motion": {"speed": 0.0}}, "/motion/speed"),
        ({**shaft, "motion": {"acceleration": 1.0}}, "/motion/acceleration"),
    ):
        assert parse_request(body).find_errors()[0][0] == path


def test_the_cycle_of_a_given_cam() -> None:
    cam, mechanism = cam_of("translating_flat")
    found = CamAnalysisRequest.analyze_cycle(mechanism, 36)
    assert found["input_angle"] == [10.0 * k for k in range(37)]
    assert found["follower"]["position"] == pytest.approx(
        cam.program.motion(np.radians(found["input_angle"])).s, abs=1e-6
    )
    contour = ContourCamAnalysisRequest.get_example()["mechanism"]
    assert len(ContourCamAnalysisRequest.analyze_cycle(contour, 12)["input_angle"]) == 13
    shaft = CamshaftAnalysisRequest.get_example()["mechanism"]
    assert len(CamshaftAnalysisRequest.analyze_cycle(shaft, 12)["input_angle"]) == 13
