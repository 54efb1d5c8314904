"""A machine and the motion that a problem requests: positions of the input, and the machine driven to them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.linkage.planar.drive import drive
from synthesis.analyses.linkages.cycle import find_cycle
from synthesis.analyses.linkages.loaded_mechanism import build_loaded_request
from synthesis.mechanisms.machine import build_machine
from synthesis.model.dynamics.request import DynamicsBlock, LengthUnit
from synthesis.model.json_object import JsonObject
from synthesis.model.linkage.input_motion import FULL_TURN, Sweep

CYCLE_TOLERANCE = 1e-9
"""Tolerance with which a range counts as whole turns, as a share of the range, for rounding."""


class Task(NamedTuple):
    """A machine, and the range of its input (radians, or lengths along the slide) with its speed and acceleration."""

    machine: Machine
    start: float
    end: float
    speed: float
    acceleration: float

    @property
    def is_closed(self) -> bool:
        """Whether the range is whole turns, so that the last position repeats the first."""
        turns = abs(self.end - self.start) / (2.0 * np.pi)
        return (
            not self.machine.mechanism.has_slide_input
            and round(turns) >= 1
            and abs(turns - round(turns)) < CYCLE_TOLERANCE * turns
        )

    def list_positions(self, count: int) -> Real:
        """Return ``count`` equally spaced positions of the input; a closed range is listed without its end."""
        return np.asarray(np.linspace(self.start, self.end, count, endpoint=not self.is_closed))


def build_task(statement: JsonObject, dynamics: DynamicsBlock, unit: LengthUnit, motion: Sweep) -> Task:
    """Build the machine and the motion of a consistent problem."""
    request = build_loaded_request(statement, dynamics, unit)
    mechanism = request.mechanism.build_mechanism()
    machine, _ = build_machine(dynamics, mechanism, unit)
    if mechanism.has_slide_input:
        first, last = find_cycle(mechanism)
        start, end = (first if motion.start is None else motion.start), (last if motion.end is None else motion.end)
    else:
        ends = motion.start or 0.0, FULL_TURN if motion.end is None else motion.end
        start, end = (float(np.radians(angle)) for angle in ends)
    return Task(machine, start, end, motion.rate, motion.acceleration)


def place_machine(machine: Machine, at: Real, speed: float = 1.0, acceleration: float = 0.0) -> Places:
    """Drive a machine to inputs (radians or lengths) with a constant speed and acceleration."""
    mechanism = machine.mechanism
    motion = drive(mechanism, at, speed=np.full(len(at), speed), acceleration=acceleration, order=2)
    return Places(mechanism, motion, machine.scale)


def pace_machine(machine: Machine, at: Real) -> Places:
    """Drive a machine to inputs with speed 1 in the length unit of its forces, in which work is computed."""
    return place_machine(machine, at, 1.0 / machine.scale if machine.mechanism.has_slide_input else 1.0)
