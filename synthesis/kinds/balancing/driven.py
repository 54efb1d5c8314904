"""A linkage with its masses over the motion for which it is balanced."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.dynamics.friction import Friction
from kinematics.dynamics.machine import Machine
from kinematics.dynamics.places import Places
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from synthesis.analyses.cycle import cycle_of
from synthesis.analyses.weighed import weighed_request
from synthesis.kinds.balancing.problem import BalancingProblem
from synthesis.mechanisms.machine import machine_of
from synthesis.model.motions import FULL_TURN

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

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


def task_of(problem: BalancingProblem) -> Task:
    """The machine of a consistent problem, and its motion."""
    assert problem.mechanism is not None
    assert problem.dynamics is not None
    request = weighed_request(problem.mechanism, problem.dynamics, problem.length_unit)
    mechanism = request.mechanism.mechanism()
    machine, _ = machine_of(problem.dynamics, mechanism, problem.length_unit)
    motion = problem.motion
    if mechanism.driven_by_slide:
        first, last = cycle_of(mechanism)
        start, end = (first if motion.start is None else motion.start), (last if motion.end is None else motion.end)
    else:
        ends = motion.start or 0.0, FULL_TURN if motion.end is None else motion.end
        start, end = (float(np.radians(angle)) for angle in ends)
    return Task(machine, start, end, motion.rate, motion.acceleration)


def inertial(machine: Machine) -> Machine:
    """The same with its masses alone: no weight, loads or friction."""
    return replace(machine, gravity=0j, loads=(), friction=Friction())


def placed(machine: Machine, at: Real, speed: float = 1.0, acceleration: float = 0.0) -> Places:
    """A machine at inputs that go with a speed and an acceleration."""
    mechanism = machine.mechanism
    motion = drive(mechanism, at, speed=np.full(len(at), speed), acceleration=acceleration, order=2)
    return Places(mechanism, motion, machine.scale)


def moving(mechanism: Mechanism) -> list[str]:
    """The links that move."""
    return [link for link in mechanism.links if link != GROUND]


def pivot(mechanism: Mechanism, link: str) -> str:
    """The joint from which a weight on a link is told: its fixed pivot, or its first joint."""
    fixed = [joint for joint in mechanism.links[link] if joint in mechanism.links[GROUND]]
    return fixed[0] if fixed else mechanism.link_line(link)[0]


def on_fixed_pivot(mechanism: Mechanism, link: str) -> bool:
    """Whether a link turns about a fixed pivot."""
    return pivot(mechanism, link) in mechanism.links[GROUND]
