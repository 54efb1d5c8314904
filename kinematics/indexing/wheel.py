"""Outline of a plane Geneva wheel: slots, locking arcs and the lands between them.

The wheel's axis is the origin and slot 0 lies along x; the axes of the locking arcs are half a step from the slots, at
the center distance c. The wheel is symmetric about the axes of slots and of locking arcs, so half a sector, from the
slot's axis to that of the locking arc, describes it completely. The wheel of an internal drive is a
ring with its slots and arcs inside; its outside is a circle of its own.

The wheel reaches to ρ = √(R² + r_r²), where a roller of radius r_r touches the slot's side as it enters at R
(Bickford, *Mechanisms for Intermittent Motion*, 1972, ch. 6).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics.arrays import Complex

QUARTER_STEPS, LAND_STEPS, LOCK_STEPS = 10, 4, 18
"""Steps of the outline over a quarter of a slot's end, over a land, and over half a locking arc."""


@dataclass(frozen=True)
class Wheel:
    """A plane Geneva wheel by its dimensions, in any one unit of length.

    Attributes
    ----------
    internal : bool
        Whether it is a ring about the crank.
    stations : int
    center_distance : float
    reach : float
        Radius of its boundary towards the crank: outer radius, or inner radius of a ring.
    half_slot : float
        Half the width of a slot.
    slot_end : float
        Distance from the axis to the center of a slot's rounded end.
    lock : float
        Radius of the locking arcs.
    """

    internal: bool
    stations: int
    center_distance: float
    reach: float
    half_slot: float
    slot_end: float
    lock: float

    @property
    def step(self) -> float:
        """Half the angle from slot to slot."""
        return math.pi / self.stations

    @property
    def lock_half(self) -> float:
        """Half the angle, about the wheel's axis, that a locking arc cuts from its circle; NaN if it does not."""
        c, reach, lock = self.center_distance, self.reach, self.lock
        cosine = (reach * reach + c * c - lock * lock) / (2.0 * reach * c)
        return math.acos(cosine) if abs(cosine) <= 1.0 else math.nan

    @property
    def mouth(self) -> float:
        """Angle of a slot's corner from the slot's axis; NaN if the slot is wider than the wheel."""
        return math.asin(self.half_slot / self.reach) if self.half_slot < self.reach else math.nan

    @property
    def land(self) -> float:
        """Angle of the wheel's circle between a slot and a locking arc; negative or NaN if nothing remains."""
        return self.step - self.mouth - self.lock_half

    @property
    def wall(self) -> float:
        """Minimum thickness between a slot and a locking arc; NaN if the arc does not cut the wheel.

        It occurs at the corner of the locking arc, or at the foot of the perpendicular from the crank's axis if that
        lies in the wheel.
        """
        foot = self.center_distance * math.sin(self.step) - self.half_slot - self.lock
        corner = self.reach * math.sin(self.step - self.lock_half) - self.half_slot
        inside = math.hypot(self.center_distance * math.cos(self.step), foot + self.half_slot) <= self.reach
        return foot if inside != self.internal else corner

    @property
    def web(self) -> float:
        """Minimum distance between neighbouring slots; negative if they overlap."""
        if self.internal:
            return 2.0 * self.reach * math.sin(self.step - self.mouth)
        return 2.0 * (self.slot_end * math.sin(self.step) - self.half_slot)

    @cached_property
    def half_sector(self) -> Complex:
        """Outline from the end of slot 0 to the middle of the next locking arc, shape (m,)."""
        turn = np.linspace(0.0, 0.5 * math.pi, QUARTER_STEPS + 1)
        # Include the point nearest to the next slot, so that the polygon shows the exact web.
        turn = np.unique(np.append(turn, 0.5 * math.pi - self.step))
        outward = -1.0 if not self.internal else 1.0
        end = self.slot_end + self.half_slot * (outward * np.cos(turn) + 1j * np.sin(turn))
        first = self.mouth
        land = self.reach * np.exp(1j * np.linspace(first, self.step - self.lock_half, LAND_STEPS + 1))
        center = self.center_distance * np.exp(1j * self.step)
        # Angles about the crank's axis, from the land's corner to the arc's own axis.
        corner = np.angle((land[-1] - center) * np.exp(-1j * self.step))
        if self.internal:
            # Include the foot of the perpendicular to the slot, where the wall is thinnest.
            foot = -(0.5 * math.pi + self.step)
            before = np.linspace(corner, foot, LOCK_STEPS // 2 + 1)[:-1] if corner < foot else np.empty(0)
            turned = np.concatenate([before, np.linspace(max(corner, foot), 0.0, LOCK_STEPS + 1)])
        else:
            turned = np.linspace(corner % (2.0 * math.pi), math.pi, LOCK_STEPS + 1)
        arc = center + self.lock * np.exp(1j * (turned + self.step))
        return np.asarray(np.concatenate([end, land, arc[1:]]), np.complex128)

    @cached_property
    def outline(self) -> Complex:
        """Complete outline, counter-clockwise from the middle of the locking arc before slot 0, closed."""
        half = self.half_sector
        sector = np.concatenate([half[::-1].conj(), half[1:-1]])
        turns = np.exp(2j * self.step * np.arange(self.stations))
        return np.asarray((turns[:, None] * sector).ravel())
