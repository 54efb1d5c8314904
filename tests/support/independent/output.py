"""The output of a driven linkage, and how fast it goes."""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Real
from tests.support.independent.drive import Drive

SWINGS = {
    "fourbar": ("O4", "B"),
    "drag_link_rocker": ("O6", "C"),
    "dwell_rocker": ("O6", "D"),
    "dwell_watt_rocker": ("O6", "D"),
    "dwell_slot": ("O6", "C"),
    "dwell_stephenson_2": ("O4", "E"),
}
"""Pivot and pin of outputs that turn."""


class Output:
    """The output of a driven linkage: an angle, radians, or a place along its slide from the line's point."""

    def __init__(self, drive: Drive, kind: str) -> None:
        self.drive, self.turns = drive, kind in SWINGS
        if self.turns:
            self.pins = tuple(drive.names.index(pin) for pin in SWINGS[kind])
        else:
            self.joint, _, self.point, self.along = next(s for s in drive.slides if s[1] == "ground")

    def at(self, turns: Real) -> Real:
        """The output at turns that follow each other closely, continuous."""
        z = self.drive.at(turns)
        if not self.turns:
            return np.asarray(((z[:, self.joint] - self.point) * np.conj(self.along)).real)
        pivot, pin = self.pins
        # Angles go on from those of the nodes along which the linkage was followed.
        nodes = np.unwrap(np.angle(self.drive.places[:, pin] - self.drive.places[:, pivot]))
        near = nodes[np.clip(np.searchsorted(self.drive.nodes, turns), 0, len(nodes) - 1)]
        return np.asarray(near + np.angle((z[:, pin] - z[:, pivot]) * np.exp(-1j * near)))

    def rate(self, turns: Real) -> Real:
        """Its derivative by the input."""
        z, rates = self.drive.at(turns), self.drive.rates_at(turns)
        if not self.turns:
            return np.asarray((rates[:, self.joint] * np.conj(self.along)).real)
        pivot, pin = self.pins
        return np.asarray((rates[:, pin] / (z[:, pin] - z[:, pivot])).imag)

    def acceleration(self, turns: Real, step: float = 2e-3) -> Real:
        """Its second derivative: differences of the first over two steps, extrapolated twice."""
        first, second, third = (
            (self.rate(turns + h) - self.rate(turns - h)) / (2.0 * h) for h in (step, 0.5 * step, 0.25 * step)
        )
        finer, finest = second + (second - first) / 3.0, third + (third - second) / 3.0
        return finest + (finest - finer) / 15.0
