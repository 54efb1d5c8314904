"""Return springs against springs that are tried one by one, and contact over speeds against grids of both."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics.cam.dynamics import FollowerLoad, RunningCam
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import build_law_segment
from kinematics.cam.springs import SpringConstraints, find_best_spring
from kinematics.errors import DimensionError
from tests.kinematics.cam.sampling import random_program

MASS, SPEED = 0.02, 90.0

GRID = np.linspace(0.0, TURN, 1441)


def program_of(seed: int) -> Program:
    return random_program(np.random.default_rng(seed), 12.0)


def tried(program: Program, ratio: float, demands: SpringConstraints, rate: float) -> tuple[float, float]:
    """Greatest force at the speed, and the preload that a rate needs, on a grid of angles and speeds."""
    load, motion = FollowerLoad(MASS, rate).with_damping_ratio(ratio), program.motion(GRID)
    speeds = np.linspace(0.0, demands.top_speed, 41)[:, None]
    needed = max(0.0, demands.floor - float(load.force(motion, speeds).min()))
    return float(load.force(motion, demands.speed).max()), needed


@pytest.mark.parametrize("ratio", [0.0, 0.08, 0.6])
@pytest.mark.parametrize("seed", range(4))
def test_no_spring_that_is_tried_beats_the_bound(seed: int, ratio: float) -> None:
    program, demands = program_of(seed), SpringConstraints(40.0, SPEED, 1.3 * SPEED)
    best = find_best_spring(program, MASS, ratio, demands)
    assert best.bound is not None
    assert best.bound <= best.greatest_force <= best.bound * (1.0 + 1e-9)
    greatest, needed = tried(program, ratio, demands, best.rate)
    # A grid of angles sees a little less than there is.
    assert needed == pytest.approx(best.preload, rel=1e-3)
    assert greatest + best.preload == pytest.approx(best.greatest_force, rel=1e-3)
    for rate in [*np.linspace(0.0, 4.0 * best.rate, 60), *(best.rate * np.linspace(0.97, 1.03, 21))]:
        greatest, needed = tried(program, ratio, demands, float(rate))
        assert greatest + needed >= best.bound * (1.0 - 1e-3)


@pytest.mark.parametrize("ratio", [0.0, 0.2])
def test_a_stated_preload_leaves_the_rate(ratio: float) -> None:
    program = program_of(1)
    free = find_best_spring(program, MASS, ratio, SpringConstraints(40.0, SPEED, SPEED))
    demands = SpringConstraints(40.0, SPEED, SPEED, preload=1.4 * free.preload)
    best = find_best_spring(program, MASS, ratio, demands)
    assert best.bound is not None
    assert free.greatest_force < best.greatest_force
    for rate in np.linspace(0.0, 4.0 * best.rate, 80):
        greatest, needed = tried(program, ratio, demands, float(rate))
        assert needed > best.preload or greatest + best.preload >= best.bound * (1.0 - 1e-3)


def test_rates_between_two_and_above_one() -> None:
    program = program_of(2)
    free = find_best_spring(program, MASS, 0.0, SpringConstraints(10.0, SPEED, SPEED))
    softer = find_best_spring(program, MASS, 0.0, SpringConstraints(10.0, SPEED, SPEED, greatest_rate=0.5 * free.rate))
    stiffer = find_best_spring(program, MASS, 0.0, SpringConstraints(10.0, SPEED, SPEED, least_rate=2.0 * free.rate))
    assert (softer.rate, stiffer.rate) == (0.5 * free.rate, 2.0 * free.rate)
    assert min(softer.greatest_force, stiffer.greatest_force) > free.greatest_force


def test_no_rate_makes_up_for_a_preload_that_is_too_small() -> None:
    """At rest in the lower dwell the spring pushes with nothing but its preload."""
    best = find_best_spring(program_of(3), MASS, 0.0, SpringConstraints(40.0, SPEED, SPEED, preload=20.0))
    assert best.bound is None
    assert best.preload == 20.0
    load = FollowerLoad(MASS, best.rate, 20.0)
    assert RunningCam(program_of(3), load, SPEED).find_weakest_contact(SPEED).force == pytest.approx(20.0)


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.4, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_contact_is_weakest_where_a_grid_of_angles_and_speeds_says(seed: int, damping: float) -> None:
    running = RunningCam(program_of(seed), FollowerLoad(MASS, 30.0, 100.0, damping), SPEED)
    weakest = running.find_weakest_contact(120.0)
    speeds = np.linspace(0.0, 120.0, 241)[:, None]
    angles = np.linspace(0.0, TURN, 7201)
    force = running.load.force(running.program.motion(angles), speeds)
    scale = float(np.abs(force).max())
    assert weakest.force <= force.min() + 1e-9 * scale
    assert weakest.force == pytest.approx(force.min(), abs=1e-4 * scale)
    at = float(replace(running, speed=max(weakest.speed, 1e-12)).force(weakest.angle))
    assert at == pytest.approx(weakest.force, abs=1e-6 * scale)


def test_with_damping_the_worst_speed_of_an_angle_lies_between() -> None:
    """At the end of a fall brake and inertia are against each other."""
    load, motion = FollowerLoad(1.0, 20.0, 1.0, 4.0), program_of(0).motion(GRID)
    speeds = np.linspace(0.0, 6.0, 2401)[:, None]
    force = load.force(motion, speeds)
    worst = load.find_weakest_speed(motion, 6.0)
    inside = (worst > 0.01) & (worst < 5.99)
    assert inside.sum() > 20
    assert load.force(motion, worst) == pytest.approx(force.min(axis=0), abs=1e-3)
    assert (load.force(motion, worst) <= force.min(axis=0) + 1e-9).all()
    assert worst[inside] == pytest.approx(speeds[force.argmin(axis=0)[inside], 0], abs=0.01)


@pytest.mark.parametrize("demands", [(1.0, 2.0, 1.0, 0.0, 1.0), (1.0, 1.0, 1.0, 2.0, 1.0), (1.0, 0.0, 1.0, 0.0, 1.0)])
def test_demands_that_contradict_one_another_are_refused(demands: tuple[float, ...]) -> None:
    with pytest.raises(DimensionError):
        SpringConstraints(*demands)


def test_without_a_stiffness_that_is_needed_a_load_alone_presses() -> None:
    """Where the follower is pressed most at the bottom, a spring would only press more at the top."""
    fall = build_law_segment(LAWS["cycloidal"], math.pi, 0.0, -1.0)
    program = Program([fall, build_law_segment(LAWS["cycloidal"], math.pi, -1.0, 0.0)])
    best = find_best_spring(program, 1e-6, 0.0, SpringConstraints(5.0, 1.0, 1.0))
    assert best.greatest_force == pytest.approx(5.0, rel=1e-5)
    assert best.rate == pytest.approx(0.0, abs=1e-4)
