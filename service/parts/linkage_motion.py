"""How the links of a planar linkage move."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from kinematics.linkage.planar.branches import cycle
from kinematics.linkage.planar.drive import MechanismMotion, drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from service.parts.model import Carrier, Complex, InputField, Placed, Real
from service.parts.sizes import NotMade

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
"""The ratio that no number of teeth divides: steps of it see a mesh in all its phases."""

ROUNDED = 1e-9
"""Share of its range by which a stated input may lie outside: an answer's own first and last are at its ends."""


@dataclass(frozen=True)
class LinkageMotion:
    """A mechanism in millimetres, the range of inputs that its parts were made for, and where it then is.

    Attributes
    ----------
    low, high : float
        Radians, or millimetres along the input slide.
    closed : bool
        Whether the range is one whole cycle.
    idlers : mapping of str to (complex, float)
        Axis of each idler between two gears, and its speed over that of the input.
    """

    mechanism: Mechanism
    low: float
    high: float
    closed: bool
    idlers: Mapping[str, tuple[complex, float]] = field(default_factory=dict)

    @property
    def reference(self) -> float:
        """The input in which the joints are stated."""
        return float(self.mechanism.reference_input)

    @property
    def size(self) -> float:
        """The greatest distance of two joints."""
        places = np.array([complex(z) for z in self.mechanism.joints.values()])
        return float(np.abs(places[:, None] - places).max())

    @property
    def input_field(self) -> InputField:
        """A slide drives by its place."""
        return "input_place" if self.mechanism.driven_by_slide else "input_angle"

    def stated(self, value: float, scale: float) -> float:
        """The input that a request states, as a motion has it; angles by whole turns, with gears by their cycle."""
        slides = self.mechanism.driven_by_slide
        # Places are of the design, and the assembly may be larger.
        unit = scale if slides else math.pi / 180.0
        low, high = self.low / unit, self.high / unit
        near = ROUNDED * (high - low)
        if not slides:
            period = high - low if self.closed else math.degrees(cycle(self.mechanism))
            value = low + (value - low + near) % period - near
        if self.closed:
            return float(value * unit)
        if not low - near <= value <= high + near:
            raise NotMade(f"The input goes from {low:.5g} to {high:.5g}.", f"/query/{self.input_field}")
        return float(min(max(value, low), high) * unit)

    def inputs(self, count: int) -> Real:
        """So many inputs, spread evenly over a whole cycle, or between the ends of the range and short of them.

        Gears are seen at different phases of their mesh, and nearly evenly.
        """
        if self.mechanism.gears:
            return self.low + np.sort(np.arange(1, count + 1) * GOLDEN % 1.0) * (self.high - self.low)
        if self.closed:
            return np.linspace(self.low, self.high, count, endpoint=False)
        return np.linspace(self.low, self.high, count + 2)[1:-1]

    def at(self, inputs: Real) -> MechanismMotion:
        """The mechanism at inputs."""
        return drive(self.mechanism, inputs, order=0)

    def placed(self, carrier: Carrier, state: MechanismMotion) -> Placed:
        """How what a carrier carries has moved from the reference configuration."""
        if carrier.link in self.idlers:
            axis, speed = self.idlers[carrier.link]
            turn = np.exp(1j * speed * (state.input[0] - self.reference))
            return Placed(turn, axis * (1.0 - turn))
        turn = self._turn(carrier.link, state)
        if carrier.joint is None:
            return Placed(turn, np.zeros_like(turn))
        shift = state.joints[carrier.joint][0] - turn * complex(self.mechanism.joints[carrier.joint])
        return Placed(turn, shift)

    def _turn(self, link: str, state: MechanismMotion) -> Complex:
        if link == GROUND:
            return np.ones(state.valid.shape, np.complex128)
        joints = self.mechanism.links[link]
        first = joints[0]
        far = max(joints, key=lambda name: abs(complex(self.mechanism.joints[name] - self.mechanism.joints[first])))
        turn = (state.joints[far][0] - state.joints[first][0]) / complex(
            self.mechanism.joints[far] - self.mechanism.joints[first]
        )
        return np.asarray(turn / np.abs(turn))
