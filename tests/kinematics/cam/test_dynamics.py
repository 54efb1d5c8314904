"""Forces at a speed against printed numbers and other routes: force, spring, jump, torque, flywheel, vibration."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from kinematics.cam.dynamics import Camshaft, FollowerLoad, RunningCam
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_dwell, build_law_segment
from kinematics.cam.profile import space_angles
from kinematics.cam.response import FollowerTrain, Response
from kinematics.errors import DimensionError
from tests.cases import Case, cases
from tests.kinematics.cam.sampling import random_program
from tests.kinematics.cam.stating import program_of
from tests.oracles.cam_formulas import damped_frequency
from tests.support.kinematics.cam.profile import double_dwell


def running(x: dict[str, Any], design: dict[str, Any]) -> RunningCam:
    load = FollowerLoad(x["mass"], x["k"], design["preload"]).with_damping_ratio(x["zeta"])
    return RunningCam(program_of(design["segments"]), load, x["omega_rad_s"])


@pytest.mark.parametrize("case", cases("dyn", "cam"))
def test_follower_dynamics(case: Case) -> None:
    x = case.inputs
    cam = running(x, x)
    force = cam.force_extremes.least, cam.force_extremes.greatest
    if "step_deg" in x:
        sampled = cam.force(np.radians(np.arange(0.0, 360.0, x["step_deg"])))
        force = sampled.min(), sampled.max()
    case.check(
        c=cam.load.damping,
        F_min=force[0],
        F_max=force[1],
        wn=cam.load.natural_frequency,
        wd=damped_frequency(cam.load),
        jump=cam.force_extremes.least <= 0.0,
        T_max=cam.torque_extremes.greatest,
    )


@pytest.mark.parametrize("case", cases("dyn_compare", "cam"))
def test_designs_compared(case: Case) -> None:
    first, last = (running(case.inputs, design) for design in case.inputs["designs"])
    force = 1.0 - last.force_extremes.greatest / first.force_extremes.greatest
    torque = 1.0 - last.torque_extremes.greatest / first.torque_extremes.greatest
    case.check(force_reduction_percent=100.0 * force, torque_reduction_percent=100.0 * torque)


def some_cam(seed: int) -> RunningCam:
    rng = np.random.default_rng(seed)
    load = FollowerLoad(rng.uniform(0.5, 2.0), rng.uniform(1.0, 50.0), rng.uniform(1.0, 20.0), rng.uniform(0.0, 1.0))
    return RunningCam(random_program(rng, 1.0), load, rng.uniform(0.5, 3.0))


@pytest.mark.parametrize("seed", range(6))
def test_least_preload_just_holds_the_floor(seed: int) -> None:
    cam, floor = some_cam(seed), 3.0
    preload = cam.compute_min_preload(floor)
    held = replace(cam, load=replace(cam.load, preload=preload)).force_extremes.least
    assert held == pytest.approx(floor) if preload > 0.0 else held >= floor


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.0, 0.4])
@pytest.mark.parametrize("seed", range(4))
def test_the_jump_speed_is_the_first_at_which_contact_is_lost(seed: int, damping: float) -> None:
    cam = some_cam(seed)
    cam = replace(cam, load=replace(cam.load, damping=damping))
    speed = cam.find_jump_speed()
    at = replace(cam, speed=speed).force_extremes
    assert at.least == pytest.approx(0.0, abs=1e-6 * at.greatest)
    for share in np.linspace(0.05, 0.99, 12):
        assert replace(cam, speed=share * speed).force_extremes.least > 0.0


def test_jump_speeds_without_a_jump() -> None:
    rest = Program([build_dwell(TURN, 0.0)])
    assert RunningCam(rest, FollowerLoad(1.0, 1.0, 1.0), 1.0).find_jump_speed() == math.inf
    assert RunningCam(rest, FollowerLoad(1.0, 1.0, 1.0), 1.0).find_jump_speed(2.0) == 0.0
    assert RunningCam(double_dwell(), FollowerLoad(1.0, 1.0, 0.0), 1.0).find_jump_speed() == 0.0
    assert RunningCam(double_dwell(), FollowerLoad(1.0, 1.0, 0.0, 0.1), 1.0).find_jump_speed() == 0.0


def test_a_form_closed_follower_changes_walls() -> None:
    cam = RunningCam(double_dwell(), FollowerLoad(2.0), 10.0)
    assert cam.force_extremes.least <= 0.0
    assert cam.find_reversals() == pytest.approx([TURN / 8.0, 5.0 * TURN / 8.0])
    parabolic = RunningCam(double_dwell(law="constant_acceleration"), FollowerLoad(2.0), 10.0)
    assert parabolic.find_reversals() == pytest.approx([TURN / 8.0, 5.0 * TURN / 8.0])


def test_a_force_that_comes_to_zero_changes_no_walls() -> None:
    """A spring and the inertia are gone where the follower comes to rest at the bottom, and rounding is left of them.

    Of a rise and a fall under a spring the force is negative in the second half of the rise and the first of the fall.
    """
    fall = build_law_segment(LAWS["polynomial_4567"], math.radians(99.231), 17.538, 0.0)
    rise = build_law_segment(LAWS["polynomial_4567"], math.radians(83.06), 0.0, 17.538)
    rests = [
        build_dwell(math.radians(120.64), 17.538),
        build_dwell(TURN - rise.angle - fall.angle - math.radians(120.64), 0.0),
    ]
    load = FollowerLoad(2.838720768024683e-3, 0.8649565934885397)
    cam = RunningCam(Program([rise, rests[0], fall, rests[1]]), load, 315.9850877302169 * TURN / 60.0)
    assert np.degrees(cam.find_reversals()) == pytest.approx([42.004297502, 79.690055086, 208.601572308, 252.497784357])


def test_a_follower_changes_walls_where_a_rest_without_force_ends() -> None:
    """Braked at the end of the rise, it is pressed to the other wall by the next rise; after the fall as before it."""
    rise, rest = build_law_segment(LAWS["cycloidal"], 1.0, 0.0, 1.0), build_dwell(1.0, 1.0)
    again, fall = (
        build_law_segment(LAWS["cycloidal"], 1.0, 1.0, 2.0),
        build_law_segment(LAWS["cycloidal"], 2.0, 2.0, 0.0),
    )
    cam = RunningCam(Program([rise, rest, again, fall, build_dwell(TURN - 5.0, 0.0)]), FollowerLoad(2.0), 10.0)
    assert cam.find_reversals() == pytest.approx([0.5, 2.0, 2.5, 4.0])


def test_torque_does_the_work_of_friction() -> None:
    cam = some_cam(3)
    shaft = Camshaft([cam])
    at = space_angles(20_000)
    lost = (cam.load.damping * cam.speed * cam.program.motion(at).v ** 2).mean()
    assert shaft.mean_torque == pytest.approx(lost, rel=1e-6)
    assert shaft.torque_extremes.greatest == pytest.approx(cam.torque_extremes.greatest)


def test_several_cams_on_one_shaft() -> None:
    cams = [replace(some_cam(k), speed=2.0, phase=0.7 * k) for k in range(3)]
    shaft = Camshaft(cams)
    at = space_angles(100_000)
    torque = shaft.torque(at)
    assert torque == pytest.approx(sum(cam.torque(at - cam.phase) for cam in cams))
    assert shaft.torque_extremes.greatest == pytest.approx(torque.max(), rel=1e-6)
    assert shaft.torque_extremes.least == pytest.approx(torque.min(), rel=1e-6)
    energy = np.cumsum(torque - torque.mean()) * TURN / len(at)
    assert shaft.energy_fluctuation == pytest.approx(energy.max() - energy.min(), rel=1e-3)
    assert shaft.compute_flywheel_inertia(0.05) == pytest.approx(shaft.energy_fluctuation / (0.05 * 4.0))


def test_energy_of_a_mass_is_its_kinetic_energy() -> None:
    """A mass alone takes m ω² v²/2 from the shaft and gives it back; its peak is the fluctuation."""
    cam = RunningCam(double_dwell(), FollowerLoad(3.0), 5.0)
    v = cam.program.peaks[1].largest
    shaft = Camshaft([cam])
    assert shaft.mean_torque == pytest.approx(0.0, abs=1e-9)
    assert shaft.energy_fluctuation == pytest.approx(0.5 * 3.0 * 25.0 * v**2, rel=1e-9)
    opposed = Camshaft([cam, replace(cam, phase=TURN / 4.0)])
    assert opposed.energy_fluctuation < 1.01 * shaft.energy_fluctuation


def test_loads_that_are_none_are_refused() -> None:
    for make in (
        lambda: FollowerLoad(0.0),
        lambda: FollowerLoad(1.0, -1.0),
        lambda: FollowerLoad(1.0, 1.0, math.nan),
        lambda: FollowerLoad(1.0, 1.0).with_damping_ratio(-0.1),
        lambda: RunningCam(double_dwell(), FollowerLoad(1.0), 0.0),
        lambda: RunningCam(double_dwell(), FollowerLoad(1.0), 1.0, math.nan),
        lambda: Camshaft([]),
        lambda: Camshaft([some_cam(1), some_cam(2)]),
        lambda: Camshaft([some_cam(1)]).compute_flywheel_inertia(0.0),
        lambda: FollowerTrain(1.0, 0.0),
        lambda: Response(double_dwell(), FollowerTrain(1.0, 1.0), 0.0),
        lambda: Response(double_dwell(), FollowerTrain(1.0, 1.0, 2.0), 1.0),
    ):
        with pytest.raises(DimensionError):
            make()


def harmonic(lift: float) -> Program:
    half = TURN / 2.0
    law = LAWS["simple_harmonic"]
    return Program([build_law_segment(law, half, 0.0, lift), build_law_segment(law, half, lift, 0.0)])


@pytest.mark.campaign
def test_response_to_a_harmonic_is_the_transfer_function() -> None:
    """s = (1 − cos θ)/2 is one harmonic: x follows by the base-excited oscillator's transfer function."""
    train, speed = FollowerTrain(2.0, 800.0, 12.0), 7.0
    response = Response(harmonic(1.0), train, speed)
    k, c, m = train.stiffness, train.damping, train.mass
    transfer = (k + 1j * c * speed) / (k - m * speed**2 + 1j * c * speed)
    expected = 0.5 - 0.5 * (transfer * np.exp(1j * response.angle)).real
    assert response.displacement == pytest.approx(expected, abs=1e-9)
    assert response.acceleration == pytest.approx(0.5 * (transfer * np.exp(1j * response.angle)).real, abs=1e-6)


def runge_kutta(response: Response, turns: int, steps: int) -> np.ndarray:
    """The mass integrated from rest for many turns; the last turn's x at equal angles."""
    train, speed, program = response.train, response.speed, response.program

    def rates(angle: float, x: float, v: float) -> tuple[float, float]:
        s, ds, _, _ = program.motion(angle)
        force = train.stiffness * (s - x) + train.damping * speed * (ds - v) - train.spring_rate * x - train.preload
        return v, float(force) / (train.mass * speed**2)

    h, x, v, found = TURN / steps, 0.0, 0.0, []
    for n in range(turns * steps):
        angle = n * h
        if n >= (turns - 1) * steps:
            found.append(x)
        k1 = rates(angle, x, v)
        k2 = rates(angle + 0.5 * h, x + 0.5 * h * k1[0], v + 0.5 * h * k1[1])
        k3 = rates(angle + 0.5 * h, x + 0.5 * h * k2[0], v + 0.5 * h * k2[1])
        k4 = rates(angle + h, x + h * k3[0], v + h * k3[1])
        x += h * (k1[0] + 2.0 * k2[0] + 2.0 * k3[0] + k4[0]) / 6.0
        v += h * (k1[1] + 2.0 * k2[1] + 2.0 * k3[1] + k4[1]) / 6.0
    return np.array(found)


def test_response_is_what_integration_settles_to() -> None:
    train = FollowerTrain(1.0, 300.0, 9.0, spring_rate=40.0, preload=5.0)
    response = Response(double_dwell(), train, 3.0)
    steps = 720
    expected = runge_kutta(response, 6, steps)
    found = np.interp(space_angles(steps), response.angle, response.displacement)
    assert found == pytest.approx(expected, abs=2e-5)


def test_force_of_a_stiff_train_is_the_rigid_one() -> None:
    program = double_dwell(law="polynomial_4567")
    train = FollowerTrain(1.5, 1e8, 2.0 * 0.1 * math.sqrt(1.5e8), spring_rate=50.0, preload=30.0)
    response = Response(program, train, 4.0)
    rigid = FollowerLoad(1.5, 50.0, 30.0).force(program.motion(response.angle), 4.0)
    assert response.contact_force == pytest.approx(rigid, abs=2e-3 * np.abs(rigid).max())
    assert not response.too_slow
    assert Response(program, FollowerTrain(1.0, 100.0), 3.0).too_slow


def test_residual_vibration_is_the_swing_in_the_dwell() -> None:
    response = Response(double_dwell(), FollowerTrain(1.0, 200.0, 0.4, spring_rate=10.0), 2.0)
    first, last = np.searchsorted(response.angle, response.program.joints[1:3])
    y = response.state[0, first:last] + 10.0 * 1.0 / 210.0
    decay = np.exp(response.train.damping_ratio * response.frequency_ratio * (response.angle[first:last] - TURN / 4.0))
    assert np.abs(y * decay).max() == pytest.approx(response.residual()[1], rel=2e-3)


def test_resonance_has_no_steady_motion() -> None:
    response = Response(double_dwell(), FollowerTrain(1.0, 16.0), 1.0)
    assert response.frequency_ratio == 4.0
    assert response.resonant
    assert not Response(double_dwell(), FollowerTrain(1.0, 16.0, 0.1), 1.0).resonant
