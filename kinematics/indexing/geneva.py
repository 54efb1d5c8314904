"""Geneva drives in closed form: motion of the wheel while a roller of the crank is in one of its slots.

Glossary:

station         a rest position of the wheel; n of them, spaced by 2π/n, with n slots;
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

from kinematics.arrays import Real

Drive = Literal["geneva_external", "geneva_internal", "geneva_spherical"]

ENTRY_TOLERANCE = 1e-12
"""Rounding of angles: radians past the end of an index at which the roller still counts as in the slot, and share of
the angle between entries within which an angle just before an entry counts as that entry."""


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
        Number of stations, at least 3.
    ratio : float
        Crank radius over center distance, from sin(π/n) to below 1; for a spherical drive the tangent of the roller's
        cone about the crank's axis, at least tan(π/n). A smaller crank does not reach the slots.
    """

    drive: Drive
    stations: int
    ratio: float

    @classmethod
    def shock_free(cls, drive: Drive, stations: int) -> Geneva:
        """Make the drive whose roller enters along the slot."""
        step = math.pi / stations
        return cls(drive, stations, math.tan(step) if drive == "geneva_spherical" else math.sin(step))

    @property
    def signed(self) -> float:
        """The ratio, negative for an internal drive, so that φ = ± arg(1 − λ e^{iα}) holds for both plane drives."""
        return -self.ratio if self.drive == "geneva_internal" else self.ratio

    @property
    def half(self) -> float:
        """Half the crank angle of an index, radians: there the roller enters the slot of the resting wheel."""
        step = math.pi / self.stations
        if self.drive == "geneva_spherical":
            return math.asin(min(1.0, math.tan(step) / self.ratio))
        # Law of sines; rounding may exceed 1 for a shock-free ratio.
        crossing = math.asin(min(1.0, math.sin(step) / self.ratio))
        return crossing - step if self.drive == "geneva_external" else crossing + step

    def motion(self, angle: Real) -> Motion:
        """Return the motion of the wheel during an index.

        Parameters
        ----------
        angle : float, any shape
            α, radians from the middle of the index, within ± ``half``.

        Returns
        -------
        Motion
            φ and its derivatives, positive in the sense in which the wheel turns.
        """
        sine, cosine = np.sin(angle), np.cos(angle)
        if self.drive == "geneva_spherical":
            return _evaluate_spherical(sine, cosine, self.ratio)
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
        """Crank angle α ≥ 0 of the maximum magnitude of the wheel's acceleration, which occurs at ± this angle.

        External: cos α = √(k² + 2) − k with k = (1 + λ²)/4λ (Norton, §3.10); spherical: the root of a quadratic in
        sin² α. If the stationary point lies outside the index, as in every internal drive, it is the index's end.
        """
        half, ratio = self.half, self.ratio
        if self.drive == "geneva_internal":
            return half
        if self.drive == "geneva_spherical":
            square = ratio * ratio
            lead = 1.0 + 2.0 * square
            root = 3.0 * (lead + 1.0)
            # The smaller root of the quadratic, in the form without cancellation.
            sine_squared = 2.0 * lead / (root + math.sqrt(root * root - 4.0 * lead)) / square
            return half if sine_squared >= math.sin(half) ** 2 else math.asin(math.sqrt(sine_squared))
        k = (1.0 + ratio * ratio) / (4.0 * ratio)
        return min(half, math.acos(math.sqrt(k * k + 2.0) - k))

    def is_engaged(self, angle: Real, rollers: int = 1) -> NDArray[np.bool_]:
        """Return whether a roller is in a slot at crank angles counted from an entry."""
        return np.asarray(self._count_entries(angle, rollers)[1] <= 2.0 * self.half + ENTRY_TOLERANCE)

    def _count_entries(self, angle: Real, rollers: int) -> tuple[Real, Real]:
        """Count the rollers that have entered since the first entry, and return the angle since the last one."""
        pitch = 2.0 * math.pi / rollers
        # The tolerance assigns an angle at an entry to the new roller.
        count = np.floor(angle / pitch + ENTRY_TOLERANCE)
        return count, angle - count * pitch

    def wheel_motion(self, angle: Real, rollers: int = 1) -> Motion:
        """Return the motion of the wheel over any crank angle, dwells included, counted from an entry.

        Parameters
        ----------
        angle : float, any shape
            Radians.
        rollers : int
            Number of rollers on the crank, equally spaced.

        Returns
        -------
        Motion
            Angle since the entry; at rest all derivatives are 0.
        """
        step = 2.0 * math.pi / self.stations
        count, within = self._count_entries(angle, rollers)
        moves = self.is_engaged(angle, rollers)
        motion = self.motion(np.clip(within, 0.0, 2.0 * self.half) - self.half)
        rates = (np.where(moves, rate, 0.0) for rate in motion[1:])
        # The index is measured from its middle; shift it to start at the entry.
        return Motion(np.where(moves, motion.s + 0.5 * step, step) + count * step, *rates)


def _evaluate_spherical(sine: Real, cosine: Real, tangent: float) -> Motion:
    """Differentiate tan φ = t sin α."""
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
