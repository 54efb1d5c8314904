"""Motion of a cam, its follower and the parts on them; the follower moves by the program, not by the contour.

The cam rotates about the origin by its angle θ in the given direction. The follower's displacement s(θ) is interpolated
in the program's table of the answer by cubics with the table's velocities; at 720 steps per turn the error is some 1e-9
of the lift.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import GROUND
from service.parts.assembly.model import Carrier, InputField, Placement
from synthesis.kinds.cam.design import ProgramTable

FULL_TURN = 2.0 * math.pi

CAM, FOLLOWER = "cam", "follower"
"""Names of the moving bodies."""


@dataclass(frozen=True)
class ShaftMotion:
    """A mechanism driven by a continuously rotating shaft; the input is the shaft's angle.

    Attributes
    ----------
    size : float
        Size, millimetres.
    """

    size: float

    @property
    def low(self) -> float:
        """Start of a turn."""
        return 0.0

    @property
    def high(self) -> float:
        """End of a turn."""
        return FULL_TURN

    @property
    def closed(self) -> bool:
        """Whether the range is one full cycle; one turn always is."""
        return True

    @property
    def reference(self) -> float:
        """Input of the reference configuration, the start of a turn."""
        return 0.0

    @property
    def input_field(self) -> InputField:
        """Request field that sets the input, which is an angle."""
        return "input_angle"

    def convert_input(self, value: float, scale: float) -> float:
        """Convert an input from a request in degrees, modulo a full turn."""
        return math.radians(value % 360.0)

    def sample_inputs(self, count: int) -> Real:
        """Return inputs spread evenly over a turn."""
        return FULL_TURN / count * np.arange(count, dtype=np.float64)

    def compute_state(self, inputs: Real) -> Real:
        """Return the inputs themselves, which are the complete state."""
        return inputs


def make_rest_placement(inputs: Real) -> Placement:
    """Return the placement of the base, which does not move."""
    return Placement(np.ones(inputs.shape, np.complex128), np.zeros(inputs.shape, np.complex128))


def make_rotation(angle: Real, about: complex = 0j) -> Placement:
    """Return the displacement by rotations about a point."""
    turn = np.exp(1j * angle)
    return Placement(turn, about * (1.0 - turn))


@dataclass(frozen=True)
class Displacement:
    """Displacement s of a follower over the cam's angle, interpolated in the answer's table.

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
    def from_program(cls, program: ProgramTable, unit: float) -> Displacement:
        """Build the displacement from the table of a motion program.

        Parameters
        ----------
        program : ProgramTable
        unit : float
            Factor by which the displacements are multiplied. Those of an arm are converted to radians, the unit of its
            velocities.
        """
        s, v = np.array(program.s), np.array(program.v)
        # Velocities of an arm are already in radians.
        return cls(np.radians(program.angle), unit * s, v if unit == math.radians(1.0) else unit * v)

    @cached_property
    def _curve(self) -> CubicHermiteSpline:
        # Close the curve over a full turn.
        at = np.concatenate([self.angle, [self.angle[0] + FULL_TURN]])
        return CubicHermiteSpline(at, np.append(self.s, self.s[0]), np.append(self.v, self.v[0]))

    def __call__(self, angle: Real) -> Real:
        """Return the displacement at any cam angles."""
        start = self.angle[0]
        return np.asarray(self._curve(start + np.mod(angle - start, FULL_TURN)))

    def compute_slope(self, angle: Real) -> Real:
        """Return its derivative by the cam's angle."""
        start = self.angle[0]
        return np.asarray(self._curve(start + np.mod(angle - start, FULL_TURN), 1))

    @property
    def extremes(self) -> tuple[float, float]:
        """Minimum and maximum displacement in the table."""
        return float(self.s.min()), float(self.s.max())


@dataclass(frozen=True)
class CamMotion(ShaftMotion):
    """A cam with a follower that slides along a direction, or swings about a pivot.

    Attributes
    ----------
    displacement : Displacement
        Millimetres along the direction, or radians about the pivot.
    sense : float
        1 for a cam that turns counter-clockwise, −1 for clockwise.
    direction : complex
        Direction of increasing displacement; for a swinging follower 1 or −1, its sense.
    pivot : complex, optional
        Pivot of a swinging follower.
    """

    displacement: Displacement
    sense: float
    direction: complex = 1.0 + 0.0j
    pivot: complex | None = None

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a carrier from cam angle 0."""
        if carrier.link == GROUND:
            return make_rest_placement(state)
        if carrier.link == CAM:
            return make_rotation(self.sense * state)
        # Parts are drawn at cam angle 0, so displacements are relative to it.
        gone = self.displacement(state) - self.displacement(np.zeros(1))
        if self.pivot is None:
            return Placement(np.ones(state.shape, np.complex128), np.asarray(self.direction * gone, np.complex128))
        return make_rotation(self.direction.real * gone, self.pivot)
