"""Criteria of a motion program: the peak or root mean square of a derivative or a torque, or the peak contact force."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.pieces import Motion, Pieces
from kinematics.cam.motion.program import TURN, Program
from synthesis.kinds.cam.follower_loads import (
    build_follower_load,
    find_max_rpm,
    find_weakest_contact,
    get_arm_length,
    with_spring,
)
from synthesis.kinds.cam.problem import CamProblem

DERIVATIVE_ORDERS = {"velocity": 1, "acceleration": 2, "jerk": 3}
"""Orders of the derivatives by their names in criteria and limits."""


def evaluate_criterion(problem: CamProblem, program: Program) -> float:
    """Return the criterion's exact value over the whole program; NaN for the size, which the sizing determines."""
    name = problem.minimize
    kind, _, of = name.partition("_")
    if name == "size":
        return math.nan
    if name == "peak_contact_force":
        top_rpm = find_max_rpm(problem)
        problem, _ = with_spring(problem, program)
        load, speed = build_follower_load(problem)
        force = find_extremes(lambda at: load.force(program.pieces.motion(at), speed), program.breaks)
        least = force.least
        if top_rpm is not None:
            least = min(least, find_weakest_contact(program, load, top_rpm).force)
        # A free preload raises the force at all angles by the same amount, until the minimum equals the
        # required force.
        return force.greatest + compute_extra_preload(problem, least)
    if kind == "peak":
        if of == "torque":
            return find_extremes(lambda at: multiply_rates(program.pieces.motion(at)), program.breaks).largest
        return program.peaks[DERIVATIVE_ORDERS[of]].largest
    if of == "torque":
        return compute_root_mean_square(program, lambda motion: motion.v * motion.a)
    return compute_root_mean_square(program, lambda motion: motion[DERIVATIVE_ORDERS[of]])


def compute_root_mean_square(program: Program, function: Callable[[Motion], np.ndarray]) -> float:
    """Return the root mean square of a function of the motion over the whole turn."""
    return math.sqrt(integrate_square(program.pieces, function) / TURN)


def integrate_square(pieces: Pieces, function: Callable[[Motion], np.ndarray]) -> float:
    """Return ∫ f² by Gauss quadrature on every piece: exact for polynomials, accurate to rounding for sinusoids."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    half = 0.5 * np.diff(pieces.start)
    values = function(pieces.motion(pieces.start[:-1, None] + half[:, None] * (nodes + 1.0)))
    return max(float(half @ (values**2 @ weights)), 0.0)


def scale_least_force(problem: CamProblem) -> float:
    """Return the required minimum contact force; for an arm, its torque about the pivot."""
    assert problem.dynamics is not None
    return problem.dynamics.least_force * get_arm_length(problem)


def scale_preload(problem: CamProblem) -> float | None:
    """Return the given preload, for an arm its torque about the pivot; None if the preload is free."""
    assert problem.dynamics is not None
    return None if problem.dynamics.preload is None else problem.dynamics.preload * get_arm_length(problem)


def compute_extra_preload(problem: CamProblem, least: float) -> float:
    """Return the non-negative amount by which a free preload raises a force with the minimum ``least``."""
    return max(scale_least_force(problem) - least, 0.0) if scale_preload(problem) is None else 0.0


def multiply_rates(motion: Motion) -> np.ndarray:
    """Return v a, to which the torque of an inertia is proportional."""
    return np.asarray(motion.v * motion.a)
