"""Pre-filter: evaluate force limits in closed form for many fourbars that carry a body.

A rejected fourbar exceeds a limit at one of the sampled positions; an accepted one is verified by the general equations
of motion before it is returned.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics.fourbar import (
    DRIVE,
    JOINT,
    POWER,
    SHAKING_FORCE,
    SHAKING_MOMENT,
    Fourbars,
    Weights,
    compute_peaks,
)
from synthesis.kinds.motion.exact.input_rotation import measure_input_rotation
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.mechanisms.fourbar_weights import build_fourbars, build_weights, is_closed_form
from synthesis.model.dynamics.request import DesignDynamics
from synthesis.model.linkage.conversion import FOURBAR_LINKS
from synthesis.results.forces import STEP_COUNT, apply_link_shape

PEAK_COLUMNS = {
    "drive_torque": DRIVE,
    "joint_force": JOINT,
    "shaking_force": SHAKING_FORCE,
    "shaking_moment": SHAKING_MOMENT,
    "power": POWER,
}
"""Columns of the peak values, by limited quantity; the joint force index needs a separate evaluation."""


def can_check_forces(problem: MotionProblem) -> bool:
    """Return whether the problem limits forces that the closed form covers."""
    stated = problem.dynamics
    # The closed form needs a rotating input at a given speed.
    if stated is None or not problem.constraints.force_limits or stated.speed_rpm is None:
        return False
    return is_closed_form(stated)


def check_force_limits(problem: MotionProblem, task: MotionTask, joints: Complex) -> NDArray[np.bool_]:
    """Return a mask of the fourbars that satisfy the force limits at the sampled positions.

    Parameters
    ----------
    problem : MotionProblem
        A problem for which :func:`can_check_forces` is true.
    task : MotionTask
        Its positions.
    joints : complex, shape (n, 4)
        O2, A, B, O4 at the first target, in task coordinates; fourbars that meet the targets.
    """
    assert problem.dynamics is not None
    placed = np.full((len(joints), 5), complex(task.origin))
    placed[:, :4] += task.size * joints
    stated = apply_link_shape(problem.dynamics, FOURBAR_LINKS)
    scale = stated.scale(problem.length_unit)
    linkages = build_fourbars(placed, _measure_span(task, placed), scale)
    carried = build_weights(stated, placed, problem.length_unit)
    speed = (stated.speed_rpm or 0.0) * math.tau / 60.0
    found = compute_peaks(linkages, carried, speed, STEP_COUNT + 1)
    kept = np.ones(len(joints), np.bool_)
    for name, limit in problem.constraints.force_limits.items():
        value = (
            _compute_force_index(stated, linkages, carried)
            if name == "joint_force_index"
            else found[:, PEAK_COLUMNS[name]]
        )
        # NaN fails the comparison, hence the linkage.
        kept &= value <= limit
    return kept


def _measure_span(task: MotionTask, joints: Complex) -> Real:
    """Return the input rotations, radians: a full turn for Grashof cranks, else from the first target to the last."""
    o2, a, b, o4 = joints[:, :4].T
    lengths = np.abs(np.stack([a - o2, b - a, b - o4, o4 - o2], axis=1))
    # Grashof, with the ground or the input shortest: the input rotates fully.
    turns = 2.0 * (lengths.min(axis=1) + lengths.max(axis=1)) < lengths.sum(axis=1)
    turns &= np.minimum(lengths[:, 0], lengths[:, 3]) == lengths.min(axis=1)
    return np.where(turns, math.tau, measure_input_rotation(task, o2, a))


def _compute_force_index(dynamics: DesignDynamics, linkages: Fourbars, carried: Weights) -> Real:
    """Return the largest pin force divided by the first load, without masses (the joint force index)."""
    first = dynamics.loads[0]
    # The index is a static ratio: keep only the first load, force or torque, and drop masses and gravity.
    couples = np.zeros(3)
    if first.force is None:
        couples = np.array([1.0 if first.link == link else 0.0 for link in ("input", "coupler", "output")])
    acts = slice(0, 1 if first.force is not None else 0)
    nothing = np.zeros_like(carried.mass)
    alone = carried._replace(
        mass=nothing,
        inertia=nothing,
        pins=nothing,
        gravity=0j,
        on=carried.on[acts],
        arm=np.ascontiguousarray(carried.arm[:, acts]),
        force=np.ascontiguousarray(carried.force[:, acts]),
        turning=carried.turning[acts],
        couples=couples,
    )
    # A zero load has no ratio; dividing by 1 leaves 0.
    strength = 1.0 if first.force is None else abs(complex(*(first.force.constant or (1.0, 0.0))))
    return compute_peaks(linkages, alone, 0.0, STEP_COUNT + 1)[:, JOINT] / (strength or 1.0)
