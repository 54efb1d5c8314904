"""Springs and dampers between two links: along the line between two points, or against the links' relative rotation.

For the reactions a spring is a pair of forces (or couples) that follow from its length and its rate of lengthening;
for the balance of energy its tension is multiplied by the lengthening per unit of the input, which needs no direction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.dynamics.loads import Effort
from kinematics.dynamics.places import Places, dot
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

MIN_LENGTH = 1e-12
"""Length of a spring, as a share of the mechanism's size, below which rounding determines its direction."""

STEPS_PER_TURN = 720
"""Positions per turn at which a rotation is followed: between neighbours no link turns by π, except at a toggle."""

TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Spring:
    """A spring with a parallel damper between two points (in the reference) of two links.

    Its tension is ``rate`` (L − ``free_length``) + ``preload`` + ``damping`` dL/dt. A one-sided spring that pulls (or
    pushes) has no force where the spring alone would push (pull), and its damper never reverses the force.
    """

    links: tuple[str, str]
    places: tuple[Complex, Complex]
    rate: float
    free_length: float = 0.0
    preload: float = 0.0
    damping: float = 0.0
    one_sided: Literal["pull", "push"] | None = None

    def _measure_span(self, places: Places) -> tuple[Complex, Complex]:
        """Return the vector from the first end to the second, and its rate."""
        first, second = (places.point(link, place) for link, place in zip(self.links, self.places, strict=True))
        return np.asarray(second[0] - first[0]), np.asarray(second[1] - first[1])

    def _compute_tension(self, length: Real, lengthening: Real) -> Real:
        """Compute the tension from the length and its rate."""
        spring = self.rate * (length - self.free_length) + self.preload
        total = spring + self.damping * lengthening
        if self.one_sided == "pull":
            return np.where(spring > 0.0, np.maximum(total, 0.0), 0.0)
        if self.one_sided == "push":
            return np.where(spring < 0.0, np.minimum(total, 0.0), 0.0)
        return np.asarray(total)

    @property
    def _has_limit_at_zero(self) -> bool:
        """Whether the force has a limit where both ends meet: rate × span, from every direction."""
        return self.free_length == 0.0 and self.preload == 0.0 and self.damping == 0.0

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`kinematics.dynamics.loads.Load`; NaN where both ends meet and the force has no direction."""
        span, rate = self._measure_span(now)
        length = np.abs(span)
        # Where the ends meet the direction is undefined, except for a spring whose force vanishes there.
        met = length <= MIN_LENGTH * now.size
        with np.errstate(invalid="ignore"):  # complex NaN, where the mechanism cannot be assembled
            unit = np.where(met, 0.0 if self._has_limit_at_zero else np.nan, span / np.where(met, 1.0, length))
        pull = np.asarray(self._compute_tension(length, dot(unit, rate)) * unit, np.complex128)
        none = np.zeros(())
        return [
            Effort(link, "", now.point(link, place)[0], sense * pull, none)
            for link, place, sense in zip(self.links, self.places, (1.0, -1.0), strict=True)
        ]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`kinematics.dynamics.loads.Load`: −tension × the lengthening, L' = (L²)' / 2 L."""
        length = np.abs(self._measure_span(now)[0])
        span, by_input = self._measure_span(paced)
        # At zero length the numerator vanishes as well.
        safe = np.where(length > 0.0, length, 1.0)
        lengthening = (span.real * by_input.real + span.imag * by_input.imag) / safe
        return np.asarray(-self._compute_tension(length, lengthening * now.input[1]) * lengthening)


@dataclass(frozen=True)
class TorsionSpring:
    """A torsion spring and damper between two links: torque −``rate`` (rotation − ``free``) − ``damping`` × its rate.

    The rotation is that of the second link relative to the first, from the reference, radians; the torque acts on the
    second link, its opposite on the first. ``near`` returns the rotation at an input to within half a turn, for
    rotations that may exceed that; without it the rotation of links known only by sine and cosine lies in −π to π.
    """

    links: tuple[str, str]
    rate: float
    free: float = 0.0
    damping: float = 0.0
    near: Callable[[Real], Real] | None = None

    def rotation(self, now: Places) -> Real:
        """Return the rotation over positions, shape S + (N,)."""
        first, second = (now.spins[link] for link in self.links)
        rotation = second[0] - first[0]
        if self.near is not None:
            # Select the turn closest to the followed rotation.
            rotation = rotation + TURN * np.round((self.near(now.input[0]) - rotation) / TURN)
        return np.asarray(rotation)

    def _compute_torque(self, now: Places) -> Real:
        first, second = (now.spins[link] for link in self.links)
        return np.asarray(-self.rate * (self.rotation(now) - self.free) - self.damping * (second[1] - first[1]))

    def efforts(self, now: Places) -> list[Effort]:
        """See :class:`kinematics.dynamics.loads.Load`."""
        torque, nowhere = self._compute_torque(now), np.zeros((), np.complex128)
        return [
            Effort(link, "", nowhere, nowhere, sense * torque)
            for link, sense in zip(self.links, (-1.0, 1.0), strict=True)
        ]

    def work(self, now: Places, paced: Places) -> Real:
        """See :class:`kinematics.dynamics.loads.Load`."""
        first, second = (paced.spins[link] for link in self.links)
        return np.asarray(self._compute_torque(now) * (second[1] - first[1]))


def follow_rotation(mechanism: Mechanism, links: tuple[str, str], period: float) -> Callable[[Real], Real]:
    """Follow the rotation of one link relative to another, from the reference over the input, for one design.

    Parameters
    ----------
    mechanism : Mechanism
        One design that a link drives, or a slide.
    links : tuple of str
        First and second link.
    period : float
        Input after which the mechanism repeats, radians; infinite where a slide drives.

    Returns
    -------
    callable
        Rotation by input, to within half a turn. Where the mechanism cannot be assembled, the value of the nearest
        input towards the reference is used.
    """
    start = float(mechanism.reference_input)
    if not np.isfinite(period):
        # A link driven by a slide between toggles only swings; a rotation beyond ±π could not be detected anyway.
        return lambda input: np.zeros(input.shape)
    count = round(STEPS_PER_TURN * period / TURN)
    at = start + np.linspace(-period, period, 2 * count + 1)
    angles = drive(mechanism, at, order=0).angles
    turned = {
        link: np.zeros(len(at)) if link == GROUND else angles[link][0] - float(mechanism.link_angle(link))
        for link in links
    }
    rotation = turned[links[1]] - turned[links[0]]
    # Unwrap from the reference outwards on both sides; open positions (NaN) keep the last value.
    for side in (rotation[count:], rotation[count::-1]):
        step = np.diff(side, prepend=0.0)
        step -= TURN * np.round(step / TURN)
        side[:] = np.cumsum(np.where(np.isnan(step), 0.0, step))
    # Net rotation after one period forward and backward; it need not be zero.
    wound = rotation[-1], rotation[0]

    def interpolate_rotation(input: Real) -> Real:
        periods = np.trunc((input - start) / period)
        within = np.interp(input - periods * period, at, rotation)
        return np.asarray(within + np.where(periods > 0.0, periods * wound[0], -periods * wound[1]))

    return interpolate_rotation
