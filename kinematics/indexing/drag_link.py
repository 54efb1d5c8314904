"""A drag link ahead of a Geneva drive: its output is the crank, which then turns slowly where the wheel is fast.

The loop a e^{iθ} + b e^{iχ} = 1 + c e^{iψ}, the ground being 1 and the shortest link, is differentiated three times:
each order gives a linear equation i (b X e^{iχ} − c Y e^{iψ}) = R for the highest derivatives X of χ and Y of ψ.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.indexing.geneva import Geneva, Motion

MAX_NEWTON_STEPS = 30
"""Maximum number of Newton steps to the input angle of an output angle; about five are usual."""


@dataclass(frozen=True)
class DragLink:
    """A drag link by its lengths relative to the ground link, which is the shortest; arrays broadcast over designs.

    Attributes
    ----------
    input, coupler, output : float or float array
    """

    input: float | Real
    coupler: float | Real
    output: float | Real

    def output_motion(self, angle: Real) -> Motion:
        """Return the output's angle ψ from the ground line and its derivatives by the input angle; NaN if not closed.

        The joint lies on the left of the line from the input's pin to the output's pivot, and ψ grows by a turn with
        each turn of the input.
        """
        a, b, c = self.input, self.coupler, self.output
        pin = a * np.exp(1j * angle)
        diagonal = 1.0 - pin
        square = np.abs(diagonal) ** 2
        along = 0.5 * (square + b * b - c * c) / square
        # NaN where the drag link cannot be assembled.
        with np.errstate(invalid="ignore"):
            aside = np.sqrt(b * b / square - along * along)
        joint = pin + (along + 1j * aside) * diagonal
        u, v = (joint - pin) / b, (joint - 1.0) / c
        sine = (v * u.conj()).imag

        def solve_highest(right: Complex) -> tuple[Real, Real]:
            turned = -1j * right
            return -(turned * v.conj()).imag / (b * sine), -(turned * u.conj()).imag / (c * sine)

        x1, y1 = solve_highest(-1j * pin)
        x2, y2 = solve_highest(pin + b * x1**2 * u - c * y1**2 * v)
        _, y3 = solve_highest(1j * pin + b * u * (3.0 * x1 * x2 + 1j * x1**3) - c * v * (3.0 * y1 * y2 + 1j * y1**3))
        # Output and input never differ by half a turn, so the input's angle selects the turn of ψ.
        psi = angle + np.angle(v * np.exp(-1j * angle))
        return Motion(psi, y1, y2, y3)

    @property
    def transmission_angle(self) -> Real:
        """Minimum transmission angle, radians: it occurs with the input's pin on the ground line."""
        a, b, c = self.input, self.coupler, self.output
        cosines = [(b * b + c * c - (1.0 + side * a) ** 2) / (2.0 * b * c) for side in (-1.0, 1.0)]
        worst = np.maximum(np.abs(cosines[0]), np.abs(cosines[1]))
        return np.asarray(np.arccos(np.minimum(worst, 1.0)))

    def find_input_angle(self, output: float) -> float:
        """Find the input angle at which the output is at an angle ψ, radians."""
        angle = output
        for _ in range(MAX_NEWTON_STEPS):
            motion = self.output_motion(np.array(angle))
            step = float((motion.s - output) / motion.v)
            angle -= step
            # At rounding level; further steps would only alternate.
            if abs(step) < 1e-15 * max(1.0, abs(angle)):
                break
        return angle


@dataclass(frozen=True)
class CrankCourse:
    """A Geneva drive whose crank is the input, or the output of a drag link.

    Attributes
    ----------
    geneva : Geneva
    link : DragLink, optional
    phase : float
        ψ of the output in the middle of the index, radians.
    """

    geneva: Geneva
    link: DragLink | None = None
    phase: float = 0.0

    @property
    def start(self) -> float:
        """Input angle at which the roller enters."""
        half = self.geneva.half
        return -half if self.link is None else self.link.find_input_angle(self.phase - half)

    @property
    def end(self) -> float:
        """Input angle at which the roller leaves."""
        half = self.geneva.half
        return half if self.link is None else self.link.find_input_angle(self.phase + half)

    def is_engaged(self, angle: Real, rollers: int = 1) -> NDArray[np.bool_]:
        """Return whether a roller is in a slot at input angles counted from an entry."""
        if self.link is None:
            return self.geneva.is_engaged(angle, rollers)
        return self.geneva.is_engaged(self.from_entry(angle).s, rollers)

    def from_entry(self, angle: Real) -> Motion:
        """Return the crank's angle since an entry, and its derivatives, at input angles since that entry."""
        if self.link is None:
            one = np.ones_like(angle)
            return Motion(angle, one, 0.0 * one, 0.0 * one)
        turned = self.crank(self.start + angle)
        return Motion(turned.s + self.geneva.half, *turned[1:])

    def wheel_motion(self, angle: Real, rollers: int = 1) -> Motion:
        """Return the motion of the wheel over any input angle since an entry; see :meth:`Geneva.wheel_motion`."""
        if self.link is None:
            return self.geneva.wheel_motion(angle, rollers)
        crank = self.from_entry(angle)
        return _apply_chain_rule(self.geneva.wheel_motion(crank.s, rollers), crank)

    def crank(self, angle: Real) -> Motion:
        """Return the crank's angle from the middle of the index, and its derivatives by the input angle."""
        if self.link is None:
            one = np.ones_like(angle)
            return Motion(angle, one, 0.0 * one, 0.0 * one)
        turned = self.link.output_motion(angle)
        return Motion(turned.s - self.phase, *turned[1:])

    def motion(self, angle: Real) -> Motion:
        """Return the wheel's angle from the middle of the index, and its derivatives by the input angle."""
        if self.link is None:
            return self.geneva.motion(angle)
        crank = self.crank(angle)
        half = self.geneva.half
        # Rounding at entry and exit must not leave the index.
        wheel = self.geneva.motion(np.clip(crank.s, -half, half))
        return _apply_chain_rule(wheel, crank)


def _apply_chain_rule(wheel: Motion, crank: Motion) -> Motion:
    """Convert derivatives by the crank into derivatives by the input (chain rule)."""
    return Motion(
        wheel.s,
        wheel.v * crank.v,
        wheel.a * crank.v**2 + wheel.v * crank.a,
        wheel.j * crank.v**3 + 3.0 * wheel.a * crank.v * crank.a + wheel.v * crank.j,
    )


STEADY_SPEED_SHARE = 0.9
"""Share of the maximum speed above which the wheel counts as steady."""


def compute_steady_share(speed: Real) -> float:
    """Compute the share of equal steps in which the speed exceeds nine tenths of its maximum."""
    return float(np.mean(speed >= STEADY_SPEED_SHARE * speed.max()))
