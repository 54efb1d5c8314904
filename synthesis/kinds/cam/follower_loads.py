"""The follower's load in one consistent set of units, and the choice of the spring if its rate is free."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from kinematics.cam.dynamics import FollowerLoad, RunningCam, WeakestContact
from kinematics.cam.motion.program import Program
from kinematics.cam.springs import Spring, SpringConstraints, find_best_spring
from synthesis.kinds.cam.problem import METRES, CamProblem
from synthesis.kinds.cam.statement.followers import FollowerDynamics, OscillatingRoller, RateRange


def get_arm_length(problem: CamProblem) -> float:
    """Return the distance from an oscillating follower's pivot to the roller's centre; 1 for translating followers."""
    return problem.follower.arm if isinstance(problem.follower, OscillatingRoller) else 1.0


def build_follower_load(problem: CamProblem) -> tuple[FollowerLoad, float]:
    """Return the follower's load, in a consistent set of units, and the cam's speed in rad/s.

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
    if dynamics.damping is None:
        load = load.with_damping_ratio(dynamics.damping_ratio)
    else:
        load = replace(load, damping=dynamics.damping * square)
    return load, convert_rpm(problem.speed_rpm)


def convert_rpm(rpm: float) -> float:
    """Convert revolutions per minute to radians per second."""
    return rpm * math.pi / 30.0


def find_max_rpm(problem: CamProblem) -> float | None:
    """Return the speed up to which contact must be kept from rest; None if it must only be kept at the given speed."""
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
    """Return the minimum spring rate, in the request's units, for the required natural frequency; speed in rad/s."""
    return dynamics.mass * METRES[length_unit] * ((dynamics.min_frequency_ratio or 0.0) * speed) ** 2


def with_spring(problem: CamProblem, program: Program) -> tuple[CamProblem, Spring | None]:
    """Return the problem with a number for its spring rate, and the spring if the rate was free.

    The chosen spring has the smallest peak contact force at the given speed among those that keep the required force
    at all speeds from 0 to the maximum, and the natural frequency. It has the units of :func:`build_follower_load`.
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
    """A follower pressed against its cam: the problem with a number for its spring rate, and the running cam.

    ``least_preload`` is the smallest preload that keeps the required force, at all speeds up to ``top_rpm`` if that is
    a number. ``spring`` is the chosen spring, if the rate was free.
    """

    problem: CamProblem
    running: RunningCam
    least_preload: float
    top_rpm: float | None
    spring: Spring | None


def press_follower(requested: CamProblem, program: Program) -> PressedFollower:
    """Press the follower against its cam: choose the spring, and the smallest sufficient preload if it is free."""
    problem, spring = with_spring(requested, program)
    dynamics = problem.dynamics
    assert dynamics is not None
    load, speed = build_follower_load(problem)
    floor, top_rpm = dynamics.least_force * get_arm_length(problem), find_max_rpm(requested)
    # The weakest contact without preload gives the missing preload.
    alone = RunningCam(program, replace(load, preload=0.0), speed)
    least = alone.compute_min_preload(floor)
    if top_rpm is not None:
        least = max(least, floor - find_weakest_contact(program, alone.load, top_rpm).force)
    # A form-closed follower needs no preload: a free preload stays zero.
    preload = least if dynamics.preload is None and not problem.is_form_closed else load.preload
    return PressedFollower(problem, RunningCam(program, replace(load, preload=preload), speed), least, top_rpm, spring)
