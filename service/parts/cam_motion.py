"""How a cam, its follower and what they carry move: the follower by the program of the answer, not by the contour.

The cam turns about the origin by its angle θ, the way its rotation says. The follower's displacement s(θ) is read from
the answer's table of the program, between whose angles a cubic runs with the table's own velocities; at 720 steps of a
turn that is some 1e-9 of the lift away from the motion law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from kinematics.linkage.planar.mechanism import GROUND
from service.parts.model import Carrier, InputField, Placed, Real

TURN = 2.0 * math.pi

CAM, FOLLOWER = "cam", "follower"
"""Names of what moves."""


@dataclass(frozen=True)
class Turning:
    """Something that is driven by a shaft which turns on and on: its input is the shaft's angle.

    Attributes
    ----------
    size : float
        How large it is, millimetres.
    """

    size: float

    @property
    def low(self) -> float:
        """Where a turn begins."""
        return 0.0

    @property
    def high(self) -> float:
        """Where it ends."""
        return TURN

    @property
    def closed(self) -> bool:
        """One turn is a cycle of what is looked at."""
        return True

    @property
    def reference(self) -> float:
        """The parts are drawn where a turn begins."""
        return 0.0

    @property
    def input_field(self) -> InputField:
        """A shaft drives."""
        return "input_angle"

    def stated(self, value: float, scale: float) -> float:
        """The input that a request states in degrees, without whole turns."""
        return math.radians(value % 360.0)

    def inputs(self, count: int) -> Real:
        """So many inputs, spread evenly over a turn."""
        return TURN / count * np.arange(count, dtype=np.float64)

    def at(self, inputs: Real) -> Real:
        """The inputs themselves say all."""
        return inputs


def still(inputs: Real) -> Placed:
    """Where the base is."""
    return Placed(np.ones(inputs.shape, np.complex128), np.zeros(inputs.shape, np.complex128))


def turned(angle: Real, about: complex = 0j) -> Placed:
    """What has turned by angles about a point."""
    turn = np.exp(1j * angle)
    return Placed(turn, about * (1.0 - turn))


@dataclass(frozen=True)
class Displacement:
    """s over the cam's angle, from the answer's table.

    Attributes
    ----------
    angle : Real
        Cam angles of the table, radians, ascending within a turn, shape (n,).
    s, v : Real
        The displacement, and its derivative by the cam's angle.
    """

    angle: Real
    s: Real
    v: Real

    @classmethod
    def of(cls, program: Any, unit: float) -> Displacement:
        """That of a program's table.

        Parameters
        ----------
        program : ProgramTable
        unit : float
            By which its displacements are multiplied. Those of an arm become radians, as its velocities are.
        """
        s, v = np.array(program.s), np.array(program.v)
        return cls(np.radians(program.angle), unit * s, v if unit == math.radians(1.0) else unit * v)

    @cached_property
    def _curve(self) -> CubicHermiteSpline:
        at = np.concatenate([self.angle, [self.angle[0] + TURN]])
        return CubicHermiteSpline(at, np.append(self.s, self.s[0]), np.append(self.v, self.v[0]))

    def __call__(self, angle: Real) -> Real:
        """The displacement at any cam angles."""
        start = self.angle[0]
        return np.asarray(self._curve(start + np.mod(angle - start, TURN)))

    def slope(self, angle: Real) -> Real:
        """Its derivative by the cam's angle."""
        start = self.angle[0]
        return np.asarray(self._curve(start + np.mod(angle - start, TURN), 1))

    @property
    def extremes(self) -> tuple[float, float]:
        """The least and the greatest in the table."""
        return float(self.s.min()), float(self.s.max())


@dataclass(frozen=True)
class CamMotion(Turning):
    """A cam and a follower that slides along a direction, or swings about a pivot.

    Attributes
    ----------
    displacement : Displacement
        Millimetres along the direction, or radians about the pivot.
    sense : float
        1 for a cam that turns counter-clockwise, −1 for clockwise.
    direction : complex
        In which the follower slides for a displacement that grows; or 1 or −1, the way it swings.
    pivot : complex, optional
        Of a follower that swings.
    """

    displacement: Displacement
    sense: float
    direction: complex = 1.0 + 0.0j
    pivot: complex | None = None

    def placed(self, carrier: Carrier, state: Real) -> Placed:
        """How what a carrier carries has moved from the cam angle 0."""
        if carrier.link == GROUND:
            return still(state)
        if carrier.link == CAM:
            return turned(self.sense * state)
        gone = self.displacement(state) - self.displacement(np.zeros(1))
        if self.pivot is None:
            return Placed(np.ones(state.shape, np.complex128), np.asarray(self.direction * gone, np.complex128))
        return turned(self.direction.real * gone, self.pivot)
