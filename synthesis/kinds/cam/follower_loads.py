"""The load that a cam moves, in one consistent set of units, and the choice of its spring if the rate is free."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from kinematics.cam.dynamics import FollowerLoad, RunningCam, WeakestContact
from kinematics.cam.motion.program import Program
from kinematics.cam.springs import Spring, SpringConstraints, find_best_spring
from synthesis.kinds.cam.problem import METRES, CamProblem
from synthesis.kinds.cam.statement.followers import FollowerDynamics, OscillatingRoller, RateRange


def get_arm_length(problem: CamProblem) -> float:
    """Return the distance from an oscillating roller's pivot to its centre; 1 for translating followers."""
    return problem.follower.arm if isinstance(problem.follower, OscillatingRoller) else 1.0


def build_follower_load(problem: CamProblem) -> tuple[FollowerLoad, float]:
    """Return the moved load, in a consistent set of units, and the speed in rad/s.

    For an oscillating follower, mass and spring at the arm's end become moments about the pivot. A free preload is
    zero here; the spring's rate must be a number (:func:`with_spring`).
    """
    dynamics = problem.dynamics
    assert dynamics is not None
    assert problem.speed_rpm is not None
    assert isinstance(dynamics.spring_rate, float)
    square = get_arm_length(problem) ** 2
    load = FollowerLoad(
        dynamics.mass * METRES[problem.length_unit] * square,
        dynamics.spring_rate * square,
        (dynamics.preload or 0.0) * get_arm_length(problem),
    )
    return load.with_damping_ratio(dynamics.damping_ratio), convert_rpm(problem.speed_rpm)


def convert_rpm(rpm: float) -> float:
    """Convert revolutions per minute to radians per second."""
    return rpm * math.pi / 30.0


def find_max_rpm(problem: CamProblem) -> float | None:
    """Return the speed up to which contact is kept from rest; None if it is kept only at the given speed."""
    dynamics = problem.dynamics
    assert dynamics is not None
    if dynamics.max_rpm is not None:
        return dynamics.max_rpm
    return None if isinstance(dynamics.spring_rate, float) else problem.speed_rpm


def find_weakest_contact(program: Program, load: FollowerLoad, top_rpm: float) -> WeakestContact:
    """Find the minimum contact force of a load from rest to a speed."""
    top = convert_rpm(top_rpm)
    return RunningCam(program, load, top).find_weakest_contact(top)


def compute_min_rate(dynamics: FollowerDynamics, length_unit: str, speed: float) -> float:
    """Return the spring rate, in the request's units, that the natural frequency requires at a speed in rad/s."""
    return dynamics.mass * METRES[length_unit] * ((dynamics.min_frequency_ratio or 0.0) * speed) ** 2


def with_spring(problem: CamProblem, program: Program) -> tuple[CamProblem, Spring | None]:
    """Return the problem with a number for its spring rate, and the spring if the rate was free.

    The chosen spring has the smallest peak contact force at the given speed among those that keep the required force
    at all speeds from 0 to the greatest, and the natural frequency; in the units of :func:`build_follower_load`.
    """
    dynamics = problem.dynamics
    if dynamics is None or isinstance(dynamics.spring_rate, float):
        return problem, None
    assert problem.speed_rpm is not None
    stated = dynamics.spring_rate
    arm, mass = get_arm_length(problem), dynamics.mass * METRES[problem.length_unit]
    least, greatest = (stated.min, stated.max) if isinstance(stated, RateRange) else (0.0, math.inf)
    speed = convert_rpm(problem.speed_rpm)
    demands = SpringConstraints(
        floor=dynamics.least_force * arm,
        speed=speed,
        top_speed=convert_rpm(dynamics.max_rpm or problem.speed_rpm),
        least_rate=max(least, compute_min_rate(dynamics, problem.length_unit, speed)) * arm**2,
        greatest_rate=greatest * arm**2,
        preload=None if dynamics.preload is None else dynamics.preload * arm,
    )
    spring = find_best_spring(program, mass * arm**2, dynamics.damping_ratio, demands)
    chosen = dynamics.model_copy(update={"spring_rate": spring.rate / arm**2})
    return problem.model_copy(update={"dynamics": chosen}), spring


@dataclass(frozen=True)
class PressedFollower:
    """A follower pressed to its cam: the problem with a number for its spring, and the running cam.

    ``least_preload`` keeps the required force, up to ``top_rpm`` if that is a number; ``spring`` is the chosen one.
    """

    problem: CamProblem
    running: RunningCam
    least_preload: float
    top_rpm: float | None
    spring: Spring | None


def press_follower(requested: CamProblem, program: Program) -> PressedFollower:
    """Press the follower to its cam: choose its spring, and the smallest sufficient preload if that is free."""
    problem, spring = with_spring(requested, program)
    dynamics = problem.dynamics
    assert dynamics is not None
    load, speed = build_follower_load(problem)
    floor, top_rpm = dynamics.least_force * get_arm_length(problem), find_max_rpm(requested)
    # Without preload, its weakest contact shows how much preload is missing.
    alone = RunningCam(program, replace(load, preload=0.0), speed)
    least = alone.compute_min_preload(floor)
    if top_rpm is not None:
        least = max(least, floor - find_weakest_contact(program, alone.load, top_rpm).force)
    # In a groove the walls hold the follower, so that a free preload stays zero.
    preload = least if dynamics.preload is None and not problem.is_form_closed else load.preload
    return PressedFollower(problem, RunningCam(program, replace(load, preload=preload), speed), least, top_rpm, spring)
