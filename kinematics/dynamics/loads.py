"""Loads: forces at points of links and at joints, and torques on links, constant or over the input.

A load is described in two ways, so that both methods stay independent: by its forces and couples on links and joints,
for the reactions, and by its work per unit of the input's motion, for the balance of power.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.dynamics.places import Places, dot

Course = Callable[[Real], NDArray[np.complex128] | NDArray[np.float64]]
"""Strength of a load as a function of the input jet (absolute value in radians or a length along the input slide,
speed, acceleration), shape (3,) + S + (N,); the strengths have shape S + (N,)."""


class Effort(NamedTuple):
    """A force on a link (or, if ``joint`` is set, on the pin of that joint) at a point, and a couple on the link."""

    link: str
    joint: str
    at: Complex
    force: Complex
    couple: Real


class Load(Protocol):
    """A load on the mechanism in addition to its weight and inertia."""

    def efforts(self, now: Places) -> list[Effort]:
        """Return the forces and couples at all positions, arrays of shape S + (N,)."""

    def work(self, now: Places, paced: Places) -> Real:
        """Return the work per unit of the input's motion, shape S + (N,); ``paced`` moves at an input speed of 1."""


@dataclass(frozen=True)
class PointForce:
    """A force at a point of a link, given in the reference; if ``turning``, its components turn with the link."""

    link: str
    place: Complex
    course: Course
    turning: bool = False

    def _compute_force(self, now: Places) -> Complex:
        force = np.asarray(self.course(now.input), np.complex128)
        # Rotate components given in the link's frame into the ground's.
        return force * now.turns[self.link][0] if self.turning else force

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`Load`."""
        return [Effort(self.link, "", now.point(self.link, self.place)[0], self._compute_force(now), np.zeros(()))]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`Load`."""
        return dot(self._compute_force(now), paced.point(self.link, self.place)[1])


@dataclass(frozen=True)
class JointForce:
    """A force on the pin of a joint."""

    joint: str
    course: Course

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`Load`."""
        force = np.asarray(self.course(now.input), np.complex128)
        return [Effort("", self.joint, now.joints[self.joint][0], force, np.zeros(()))]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`Load`."""
        return dot(np.asarray(self.course(now.input), np.complex128), paced.joints[self.joint][1])


@dataclass(frozen=True)
class Torque:
    """A torque on a link."""

    link: str
    course: Course

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`Load`."""
        torque = np.asarray(self.course(now.input), np.float64)
        return [Effort(self.link, "", np.zeros((), np.complex128), np.zeros((), np.complex128), torque)]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`Load`."""
        return np.asarray(self.course(now.input) * paced.spins[self.link][1], np.float64)


def make_constant(strength: complex) -> Course:
    """Make the course of a constant load."""
    return lambda input: np.full(input.shape[1:], strength)


@dataclass(frozen=True)
class Resistance:
    """A force on the pin of a joint against its motion: along its path, or along a slide of the ground.

    Its size is ``forward`` where the joint moves along the slide's direction or, without a slide, where the input moves
    in its positive sense; ``backward`` otherwise, and zero at rest.
    """

    joint: str
    forward: float
    backward: float
    slide: int | None = None

    def _compute_force(self, now: Places) -> Complex:
        velocity = now.joints[self.joint][1]
        # At a dead centre the direction of motion would be decided by rounding.
        moves = np.abs(velocity) > now.rest
        velocity = np.where(moves, velocity, 0.0)
        if self.slide is None:
            # Without a slide the input's sense distinguishes forward from backward.
            ahead = now.input[1] > 0.0
            along = velocity / np.where(moves, np.abs(velocity), 1.0)
        else:
            direction = now.direction(self.slide)[0]
            ahead = dot(direction, velocity) > 0.0
            along = np.where(ahead, direction, -direction)
        return np.where(moves, -np.where(ahead, self.forward, self.backward) * along, 0.0)

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`Load`."""
        return [Effort("", self.joint, now.joints[self.joint][0], self._compute_force(now), np.zeros(()))]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`Load`."""
        return dot(self._compute_force(now), paced.joints[self.joint][1])


@dataclass(frozen=True)
class TurningResistance:
    """A torque on a link against its rotation: ``forward`` where it turns counter-clockwise, ``backward`` where it
    turns clockwise, and zero at rest."""

    link: str
    forward: float
    backward: float

    def _compute_torque(self, now: Places) -> Real:
        spin = now.spins[self.link][1]
        # Rounding must not decide the sign of a resistance at rest.
        still = np.abs(spin) <= now.turning_rest
        return np.where(still, 0.0, np.where(spin > 0.0, -self.forward, self.backward))

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`Load`."""
        return [
            Effort(self.link, "", np.zeros((), np.complex128), np.zeros((), np.complex128), self._compute_torque(now))
        ]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`Load`."""
        return np.asarray(self._compute_torque(now) * paced.spins[self.link][1])
