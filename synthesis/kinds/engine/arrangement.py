"""The cylinders of an engine: axis, throw, phase and place of each, from a layout and the phases of its throws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.engine.problem import BANK_COUNTS, EngineLayout


class Cylinders(NamedTuple):
    """Cylinders in the order of their numbers; angles in degrees, places along the shaft in cylinder spacings.

    ``throw`` is the index of each cylinder's throw, counted from 0. ``axis`` is the cylinder's direction from the
    engine's own axis, positive to the left. ``phase`` is the lag of its throw.
    """

    throw: NDArray[np.int64]
    axis: Real
    phase: Real
    place: Real

    @property
    def top(self) -> Real:
        """Crank angles of the top dead centres."""
        return np.asarray(self.phase + self.axis)


def list_axes(layout: EngineLayout, cylinders: int) -> list[list[float]]:
    """List the axes of the cylinders on each throw, the first bank first."""
    if layout.type == "radial":
        return [[360.0 * n / cylinders for n in range(cylinders)]]
    banks = BANK_COUNTS[layout.type]
    # Banks are spread symmetrically about the engine's own axis.
    half = 90.0 if layout.type == "opposed" else 0.5 * (banks - 1) * (layout.vee_angle or 0.0)
    step = 0.0 if banks == 1 else 2.0 * half / (banks - 1)
    # List the banks from left to right.
    row = [half - step * n for n in range(banks)]
    if layout.first_bank == "right":
        row.reverse()
    count = layout.count_throws(cylinders)
    assert count is not None, "a layout without faults"
    if layout.pins == "own":
        return [[row[n % banks]] for n in range(count)]
    return [row] * count


def arrange_cylinders(layout: EngineLayout, cylinders: int, throws: Sequence[float]) -> Cylinders:
    """Arrange the cylinders of an engine for the given phases of its throws, degrees."""
    axes = list_axes(layout, cylinders)
    places = layout.positions or [float(n) for n in range(len(throws))]
    listed = [(n, axis, throws[n], places[n]) for n, row in enumerate(axes) for axis in row]
    if layout.numbering == "by_bank" and layout.type != "radial":
        order = list(dict.fromkeys(axis for _, axis, _, _ in listed))
        listed.sort(key=lambda cylinder: order.index(cylinder[1]))
    throw, axis, phase, place = zip(*listed, strict=True)
    return Cylinders(np.array(throw), np.array(axis), np.array(phase, np.float64), np.array(place, np.float64))


def compute_middle(places: Real) -> float:
    """Return the middle of the cylinders along the shaft."""
    return 0.5 * float(places.min() + places.max())
