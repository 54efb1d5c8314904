"""Geneva drives in closed form: how the wheel turns while a roller of the crank is in one of its slots.

Glossary:

station         where the wheel rests; n of them, 2π/n apart, and as many slots;
index           the turn of the wheel from one station to the next, and the crank's turn meanwhile;
shock-free      the roller enters along the slot, so that the wheel begins at rest.

With the crank's angle α from the middle of the index and λ the ratio of crank radius to center distance, the wheel has
turned by φ from the middle (Bickford, *Mechanisms for Intermittent Motion*, 1972, ch. 5 to 7; Norton, *Design of
Machinery*, §3.10; Johnson, Product Engineering 27 (1956) for the internal drive):

=========  ==================================  ==============================  ===============
drive      tan φ                               shock-free                      half the index
=========  ==================================  ==============================  ===============
external   λ sin α/(1 − λ cos α)               λ = sin(π/n)                    π/2 − π/n
internal   λ sin α/(1 + λ cos α)               λ = sin(π/n)                    π/2 + π/n
spherical  tan β sin α, β the roller's cone    β = π/n                         π/2
=========  ==================================  ==============================  ===============

The axes of the spherical drive cross at a right angle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]

Drive = Literal["geneva_external", "geneva_internal", "geneva_spherical"]

ENTRY = 1e-12
"""Angle before the end of an index within which the roller is still in the slot: rounding."""


class Motion(NamedTuple):
    """The wheel's angle (radians) and its first three derivatives by the crank's angle."""

    s: Real
    v: Real
    a: Real
    j: Real


@dataclass(frozen=True)
class Geneva:
    """A Geneva drive by its proportions.

    Attributes
    ----------
    drive : {"geneva_external", "geneva_internal", "geneva_spherical"}
    stations : int
        From 3 on.
    ratio : float
        Crank radius over center distance; of a spherical drive the tangent of the roller's cone about the crank's axis.
        From sin(π/n) on, below 1 (spherical: tan(π/n), any): a smaller crank does not reach the slots.
    """

    drive: Drive
    stations: int
    ratio: float

    @classmethod
    def shock_free(cls, drive: Drive, stations: int) -> Geneva:
        """The drive whose roller enters along the slot."""
        step = math.pi / stations
        return cls(drive, stations, math.tan(step) if drive == "geneva_spherical" else math.sin(step))

    @property
    def signed(self) -> float:
        """The ratio, negative of an internal drive: in the plane φ = ± arg(1 − λ e^{iα}) with it."""
        return -self.ratio if self.drive == "geneva_internal" else self.ratio

    @property
    def half(self) -> float:
        """Half of the crank's angle of an index, radians: where the roller crosses the slot of a resting wheel."""
        step = math.pi / self.stations
        if self.drive == "geneva_spherical":
            return math.asin(min(1.0, math.tan(step) / self.ratio))
        crossing = math.asin(min(1.0, math.sin(step) / self.ratio))
        return crossing - step if self.drive == "geneva_external" else crossing + step

    def motion(self, angle: Real) -> Motion:
        """The wheel during an index.

        Parameters
        ----------
        angle : float, any shape
            α, radians from the middle of the index, within ± ``half``.

        Returns
        -------
        Motion
            φ and its derivatives, each positive the way the wheel turns.
        """
        sine, cosine = np.sin(angle), np.cos(angle)
        if self.drive == "geneva_spherical":
            return _spherical(sine, cosine, self.ratio)
        ratio = self.signed
        sign = math.copysign(1.0, ratio)
        square = 1.0 - 2.0 * ratio * cosine + ratio * ratio
        bend = sign * ratio * (1.0 - ratio * ratio)
        return Motion(
            sign * np.arctan2(ratio * sine, 1.0 - ratio * cosine),
            sign * ratio * (cosine - ratio) / square,
            -bend * sine / square**2,
            -bend * (cosine * square - 4.0 * ratio * sine * sine) / square**3,
        )

    @property
    def peak_angle(self) -> float:
        """The crank's angle α ≥ 0 at which the wheel's acceleration is greatest in magnitude: at ± this angle.

        External: cos α = √(k² + 2) − k with k = (1 + λ²)/4λ (Norton, §3.10); spherical: the root of a quadratic in
        sin² α; where the stationary point lies outside the index, as in every internal drive, the index's end.
        """
        half, ratio = self.half, self.ratio
        if self.drive == "geneva_internal":
            return half
        if self.drive == "geneva_spherical":
            square = ratio * ratio
            lead = 1.0 + 2.0 * square
            root = 3.0 * (lead + 1.0)
            sine_squared = 2.0 * lead / (root + math.sqrt(root * root - 4.0 * lead)) / square
            return half if sine_squared >= math.sin(half) ** 2 else math.asin(math.sqrt(sine_squared))
        k = (1.0 + ratio * ratio) / (4.0 * ratio)
        return min(half, math.acos(math.sqrt(k * k + 2.0) - k))

    def engaged(self, angle: Real, rollers: int = 1) -> NDArray[np.bool_]:
        """Whether a roller is in a slot at angles of the crank, counted from where one enters."""
        return np.asarray(self._counted(angle, rollers)[1] <= 2.0 * self.half + ENTRY)

    def _counted(self, angle: Real, rollers: int) -> tuple[Real, Real]:
        """How many rollers have entered since, and the angle since the last one did."""
        pitch = 2.0 * math.pi / rollers
        count = np.floor(angle / pitch + ENTRY)
        return count, angle - count * pitch

    def turned(self, angle: Real, rollers: int = 1) -> Motion:
        """The wheel over any angle of the crank, dwells included, counted from where a roller enters.

        Parameters
        ----------
        angle : float, any shape
            Radians.
        rollers : int
            On the crank, in equal steps.

        Returns
        -------
        Motion
            The angle turned since the entry; at rest all derivatives are 0.
        """
        step = 2.0 * math.pi / self.stations
        count, within = self._counted(angle, rollers)
        moves = self.engaged(angle, rollers)
        motion = self.motion(np.clip(within, 0.0, 2.0 * self.half) - self.half)
        rates = (np.where(moves, rate, 0.0) for rate in motion[1:])
        return Motion(np.where(moves, motion.s + 0.5 * step, step) + count * step, *rates)


def _spherical(sine: Real, cosine: Real, tangent: float) -> Motion:
    """tan φ = t sin α, differentiated."""
    square = tangent * tangent
    denominator = 1.0 + square * sine * sine
    lead = 1.0 + 2.0 * square
    numerator = sine * (lead - square * sine * sine)
    slope = cosine * (lead - 3.0 * square * sine * sine)
    fall = 4.0 * square * sine * cosine
    return Motion(
        np.arctan(tangent * sine),
        tangent * cosine / denominator,
        -tangent * numerator / denominator**2,
        -tangent * (slope * denominator - fall * numerator) / denominator**3,
    )
