"""Rotation of the bodies of a train: each rotates about its own axis, and the axes of planets rotate about another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real
from kinematics.linkage.planar.mechanism import GROUND
from service.parts.assembly.model import Carrier, Frame, InputField, Placement

GOLDEN_RATIO = 0.5 * (math.sqrt(5.0) - 1.0)
"""Reciprocal of the golden ratio. The fractional parts of its multiples are nearly evenly spread for any count. They
are irrational, so that the inputs sample every mesh in all its phases."""


class BodyRotation(NamedTuple):
    """Rotation of a body: its axis, its speed, and the speed of its axis about another axis.

    Speeds are about z and relative to that of the input.

    ``frame`` is the plane in which it rotates, if that is not the assembly's.
    """

    centre: complex
    speed: float
    orbit: float = 0.0
    about: complex = 0j
    frame: Frame | None = None


@dataclass(frozen=True)
class TrainMotion:
    """Bodies that rotate at constant ratios.

    Attributes
    ----------
    bodies : mapping of str to BodyRotation
        Bodies by the link names of their carriers.
    size : float
        Size of the train, millimetres.
    turns : int
        Turns of the input in the interference check, enough to advance every mesh by a tooth.
    """

    bodies: Mapping[str, BodyRotation]
    size: float
    turns: int = 1
    closed: bool = field(default=False, init=False)
    low: float = field(default=0.0, init=False)
    reference: float = field(default=0.0, init=False)
    input_field: InputField = field(default="input_angle", init=False)

    @property
    def high(self) -> float:
        """Input after all turns."""
        return 2.0 * math.pi * self.turns

    def sample_inputs(self, count: int) -> Real:
        """Return nearly evenly spaced inputs at different phases of every mesh; the first is the reference."""
        return np.sort(np.arange(count) * GOLDEN_RATIO % 1.0) * self.high

    def convert_input(self, value: float, scale: float) -> float:
        """Convert an input in degrees. The motion has no limits, and one input turn is not its period."""
        return math.radians(value)

    def compute_state(self, inputs: Real) -> Real:
        """Return the inputs themselves, which are the complete state."""
        return inputs

    def compute_placement(self, carrier: Carrier, state: Real) -> Placement:
        """Return the displacement of a body."""
        if carrier.link == GROUND:
            return Placement(np.ones(len(state), np.complex128), np.zeros(len(state), np.complex128))
        body = self.bodies[carrier.link]
        turn = np.exp(1j * body.speed * state)
        # Planets revolve about the carrier's axis.
        centre = body.about + (body.centre - body.about) * np.exp(1j * body.orbit * state)
        return Placement(turn, centre - turn * body.centre, body.frame)
