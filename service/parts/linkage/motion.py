"""Motion of the links of a planar linkage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.branches import compute_cycle
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose
from service.parts.assembly.model import Carrier, InputField, Placement
from service.parts.assembly.sizes import NotMade

GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)
"""Reciprocal of the golden ratio. The fractional parts of its multiples are nearly evenly spread for any count. They
are irrational, so that the inputs sample a mesh of any tooth number in all its phases."""

INPUT_TOLERANCE = 1e-9
"""Share of the range by which a requested input may lie outside it. Clients request the rounded first and last inputs
of an answer, which are the ends of the range."""


@dataclass(frozen=True)
class LinkageMotion:
    """A mechanism in millimetres with the range of inputs for which its parts were made.

    Attributes
    ----------
    low, high : float
        Radians, or millimetres along the input slide.
    closed : bool
        Whether the range is one full cycle.
    idlers : mapping of str to (complex, float)
        Axis of each idler between two gears, and its speed relative to the input's.
    """

    mechanism: Mechanism
    low: float
    high: float
    closed: bool
    idlers: Mapping[str, tuple[complex, float]] = field(default_factory=dict)

    @property
    def reference(self) -> float:
        """Input of the reference configuration."""
        return float(self.mechanism.reference_input)

    @property
    def size(self) -> float:
        """Maximum distance of two joints."""
        places = np.array([complex(z) for z in self.mechanism.joints.values()])
        return float(np.abs(places[:, None] - places).max())

    @property
    def input_field(self) -> InputField:
        """Request field that sets the input: the place of a slide, or the angle of a crank."""
        return "input_place" if self.mechanism.has_slide_input else "input_angle"

    def convert_input(self, value: float, scale: float) -> float:
        """Convert an input from a request; angles modulo a full turn, with gears modulo their cycle."""
        slides = self.mechanism.has_slide_input
        # Places are those of the design, and the assembly may be larger.
        unit = scale if slides else math.pi / 180.0
        low, high = self.low / unit, self.high / unit
        near = INPUT_TOLERANCE * (high - low)
        if not slides:
            period = high - low if self.closed else math.degrees(compute_cycle(self.mechanism))
            # Map the angle into the range, tolerating rounding at its start.
            value = low + (value - low + near) % period - near
        if self.closed:
            return float(value * unit)
        if not low - near <= value <= high + near:
            raise NotMade(
                compose("parts-input-out-of-range", low=f"{low:.5g}", high=f"{high:.5g}"), f"/query/{self.input_field}"
            )
        return float(min(max(value, low), high) * unit)

    def sample_inputs(self, count: int) -> Real:
        """Return inputs spread evenly over a full cycle, or over the interior of the range.

        With gears the inputs sample different phases of the mesh, and are nearly even.
        """
        if self.mechanism.gears:
            return self.low + np.sort(np.arange(1, count + 1) * GOLDEN_RATIO % 1.0) * (self.high - self.low)
        if self.closed:
            return np.linspace(self.low, self.high, count, endpoint=False)
        return np.linspace(self.low, self.high, count + 2)[1:-1]

    def compute_state(self, inputs: Real) -> MechanismMotion:
        """Return the mechanism at inputs."""
        return drive(self.mechanism, inputs, order=0)

    def compute_placement(self, carrier: Carrier, state: MechanismMotion) -> Placement:
        """Return the displacement of a carrier from the reference configuration."""
        if carrier.link in self.idlers:
            axis, speed = self.idlers[carrier.link]
            # An idler rotates about its own axis in proportion to the input.
            turn = np.exp(1j * speed * (state.input[0] - self.reference))
            return Placement(turn, axis * (1.0 - turn))
        turn = self._compute_turn(carrier.link, state)
        if carrier.joint is None:
            return Placement(turn, np.zeros_like(turn))
        shift = state.joints[carrier.joint][0] - turn * complex(self.mechanism.joints[carrier.joint])
        return Placement(turn, shift)

    def _compute_turn(self, link: str, state: MechanismMotion) -> Complex:
        if link == GROUND:
            return np.ones(state.valid.shape, np.complex128)
        joints = self.mechanism.links[link]
        first = joints[0]
        # The farthest joint gives the most accurate angle.
        far = max(joints, key=lambda name: abs(complex(self.mechanism.joints[name] - self.mechanism.joints[first])))
        turn = (state.joints[far][0] - state.joints[first][0]) / complex(
            self.mechanism.joints[far] - self.mechanism.joints[first]
        )
        # Remove rounding: a rotation has modulus 1.
        return np.asarray(turn / np.abs(turn))
