"""How the bodies of a train turn: each about an axis of its own, planets with their axes about another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from kinematics.linkage.planar.mechanism import GROUND
from service.parts.model import Carrier, Frame, InputField, Placed, Real

GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
"""The ratio that no number of teeth divides: steps of it see every mesh in all its phases."""


class Turning(NamedTuple):
    """A body: its axis, its speed, and the speed of its axis about another; speeds over the input's, about z.

    ``frame`` is the plane in which it turns where that is not the assembly's.
    """

    centre: complex
    speed: float
    orbit: float = 0.0
    about: complex = 0j
    frame: Frame | None = None


@dataclass(frozen=True)
class TrainMotion:
    """Bodies that turn at constant ratios.

    Attributes
    ----------
    bodies : mapping of str to Turning
        By the names that carriers have as their links.
    size : float
        How large the train is, millimetres.
    turns : int
        Of the input, over which the train is looked at: enough for every mesh to go from tooth to tooth.
    """

    bodies: Mapping[str, Turning]
    size: float
    turns: int = 1
    closed: bool = field(default=False, init=False)
    low: float = field(default=0.0, init=False)
    reference: float = field(default=0.0, init=False)
    input_field: InputField = field(default="input_angle", init=False)

    @property
    def high(self) -> float:
        """After all turns."""
        return 2.0 * math.pi * self.turns

    def inputs(self, count: int) -> Real:
        """So many inputs, nearly evenly spread and at different phases of every mesh; the first is the reference."""
        return np.sort(np.arange(count) * GOLDEN % 1.0) * self.high

    def stated(self, value: float, scale: float) -> float:
        """Any angle is one of the train's; a whole turn of the input is none of the output."""
        return math.radians(value)

    def at(self, inputs: Real) -> Real:
        """The inputs say all."""
        return inputs

    def placed(self, carrier: Carrier, state: Real) -> Placed:
        """How what a body carries has moved."""
        if carrier.link == GROUND:
            return Placed(np.ones(len(state), np.complex128), np.zeros(len(state), np.complex128))
        body = self.bodies[carrier.link]
        turn = np.exp(1j * body.speed * state)
        centre = body.about + (body.centre - body.about) * np.exp(1j * body.orbit * state)
        return Placed(turn, centre - turn * body.centre, body.frame)
