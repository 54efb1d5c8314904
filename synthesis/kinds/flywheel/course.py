"""The torque of a shaft over one cycle, from a table or from the forces in a linkage at constant speed."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.analyses.input_motion import MAX_POSITIONS, RAD_PER_S
from synthesis.analyses.linkages.cyclic_statistics import is_closed
from synthesis.analyses.linkages.dynamics import DETERMINED_STATUSES, analyze_forces
from synthesis.analyses.linkages.loaded_mechanism import build_loaded_request
from synthesis.kinds.flywheel.problem import FlywheelProblem
from synthesis.mechanisms.courses import find_period_turns
from synthesis.model.dynamics.loads import FULL_TURN

MAX_STEPS_PER_TURN = 3600
"""Maximum number of positions per turn at which a linkage's torque is computed. At the onset of a load, a cubic through
them has an error of the order of the step squared, about 1e-7 of a coefficient."""


class UnknownTorque(ValueError):
    """The torque is not known over the whole cycle; the message gives the reason."""


class TorqueCycle(NamedTuple):
    """Torque taken from a shaft over one cycle.

    Attributes
    ----------
    angle : float, shape (N + 1,)
        Angles in radians, increasing over one cycle.
    demand : float, shape (N + 1,)
        Torque taken from the shaft; negative if the shaft is driven. The last value equals the first.
    smooth : bool
        True for a periodic cubic between these points, false for straight lines.
    """

    angle: Real
    demand: Real
    smooth: bool


def compute_torque_cycle(problem: FlywheelProblem) -> TorqueCycle:
    """Compute the torque from the table's rows, or from the reactions in a linkage.

    Raises
    ------
    UnknownTorque
        If a linkage's torque is unknown at some positions, or does not repeat.
    """
    if problem.torque is None:
        return compute_machine_torque(problem, "drive", 0.0)
    rows = np.array(problem.torque.table, np.float64)
    angle, torque = np.radians(rows[:, 0]), rows[:, 1]
    cycle = 2.0 * math.pi * problem.torque.turns
    # A table that ends before a full cycle is closed with its first row; otherwise its last row repeats the first.
    if rows[-1, 0] - rows[0, 0] < FULL_TURN * problem.torque.turns:
        angle, torque = np.append(angle, angle[0] + cycle), np.append(torque, torque[0])
    else:
        torque = np.append(torque[:-1], torque[0])
    sign = 1.0 if problem.torque.side == "demand" else -1.0
    return TorqueCycle(angle, sign * torque, problem.torque.interpolation == "periodic_cubic")


def compute_machine_torque(problem: FlywheelProblem, route: str, share: float) -> TorqueCycle:
    """Compute a linkage's torque by the method ``route``, with the positions shifted by a ``share`` of a step.

    Raises
    ------
    UnknownTorque
        If the torque is unknown at some positions, or does not repeat.
    """
    assert problem.machine is not None
    request = build_loaded_request(problem.machine.mechanism, problem.machine.dynamics, problem.length_unit)
    assert request.dynamics is not None
    mechanism = request.mechanism.build_mechanism()
    turns = find_period_turns(request.dynamics, mechanism)
    # At least 36 positions per turn must fit into the maximum number.
    if not 0 < turns < MAX_POSITIONS // 36:
        raise UnknownTorque(compose("flywheel-motion-not-repeating"))
    steps = turns * min(MAX_STEPS_PER_TURN, (MAX_POSITIONS - 1) // turns)
    at = FULL_TURN * turns * (np.arange(steps + 1) + share) / steps
    # Drive the linkage at constant speed, since the fluctuation is small.
    speed = np.full(len(at), problem.speed_rpm * RAD_PER_S)
    found = analyze_forces(mechanism, request.dynamics, problem.length_unit, at, speed, 0.0)
    for status, angle in zip(found["status"], at, strict=True):
        if status not in DETERMINED_STATUSES:
            raise UnknownTorque(compose("flywheel-forces-unknown", status=status, angle=f"{angle:.4g}"))
    demand = np.array(found[route], np.float64)
    if not is_closed(mechanism, at, demand, turns):
        raise UnknownTorque(compose("flywheel-torque-not-repeating"))
    return TorqueCycle(np.radians(at), np.append(demand[:-1], demand[0]), smooth=True)
