"""A machine over the motion that a problem states: its positions, and what is driven along them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.linkage.planar.drive import drive
from synthesis.analyses.cycle import cycle_of
from synthesis.analyses.weighed import weighed_request
from synthesis.mechanisms.machine import machine_of
from synthesis.model.dynamics import DynamicsBlock, LengthUnit
from synthesis.model.motions import FULL_TURN, Sweep

Real = NDArray[np.float64]

ONCE = 1e-9
"""Share of a turn by which a range may miss whole turns and be closed: rounding."""


class Task(NamedTuple):
    """A machine, and the range of its input (radians, or lengths along the slide) with its speed and acceleration."""

    machine: Machine
    start: float
    end: float
    speed: float
    acceleration: float

    @property
    def closed(self) -> bool:
        """Whether the range is whole turns, of which the last position is the first again."""
        turns = abs(self.end - self.start) / (2.0 * np.pi)
        return (
            not self.machine.mechanism.driven_by_slide
            and round(turns) >= 1
            and abs(turns - round(turns)) < ONCE * turns
        )

    def positions(self, count: int) -> Real:
        """So many positions of the input, at equal distances."""
        return np.asarray(np.linspace(self.start, self.end, count, endpoint=not self.closed))


def driven_task(stated: dict[str, Any], dynamics: DynamicsBlock, unit: LengthUnit, motion: Sweep) -> Task:
    """The machine of a consistent statement, and its motion."""
    request = weighed_request(stated, dynamics, unit)
    mechanism = request.mechanism.mechanism()
    machine, _ = machine_of(dynamics, mechanism, unit)
    if mechanism.driven_by_slide:
        first, last = cycle_of(mechanism)
        start, end = (first if motion.start is None else motion.start), (last if motion.end is None else motion.end)
    else:
        ends = motion.start or 0.0, FULL_TURN if motion.end is None else motion.end
        start, end = (float(np.radians(angle)) for angle in ends)
    return Task(machine, start, end, motion.rate, motion.acceleration)


def placed(machine: Machine, at: Real, speed: float = 1.0, acceleration: float = 0.0) -> Places:
    """A machine at inputs that go with a speed and an acceleration."""
    mechanism = machine.mechanism
    motion = drive(mechanism, at, speed=np.full(len(at), speed), acceleration=acceleration, order=2)
    return Places(mechanism, motion, machine.scale)


def paced(machine: Machine, at: Real) -> Places:
    """A machine at inputs that go with a speed of 1 in the unit of its forces, by which work is told."""
    return placed(machine, at, 1.0 / machine.scale if machine.mechanism.driven_by_slide else 1.0)
