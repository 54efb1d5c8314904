"""Spherical Geneva drives: dimensions for a given sphere radius, and the constraints that determine its minimum.

The wheel's axis is z and its rim lies in the plane z = 0; the crank's axis is a direction of that plane. Slots lie on
meridians, from the rim up to the latitude that the roller reaches, π/n plus a clearance. A locking hollow is cut by a
cone about the crank's axis; its edge lies in a plane, which seen along z is a chord of the rim.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Complex
from synthesis.kinds.indexing.design import Profile, SphericalGenevaMechanism
from synthesis.kinds.indexing.problem import IndexingProblem

RIM_POSITIONS = 4001
"""Number of positions of half an index at which the reach of the rim is evaluated."""

MIN_CAP_SHARE = 0.15
"""Minimum distance of the cap's end as a share of its radius, so that it locks over a rest except at its ends."""

STEP_COUNT = 12
"""Number of outline steps over half a slot's end, and over a land."""


@dataclass(frozen=True)
class Hemisphere:
    """The wheel by its dimensions: lengths in one unit, angles in radians.

    Attributes
    ----------
    stations : int
    radius, half_slot : float
    slot_end : float
        Latitude of the center of a slot's end.
    lock : float
        Angle from the crank's axis to the edge of a locking hollow; NaN if the wall leaves none.
    """

    stations: int
    radius: float
    half_slot: float
    slot_end: float
    lock: float

    @property
    def step(self) -> float:
        """Half the angle from slot to slot."""
        return math.pi / self.stations

    @property
    def wall(self) -> float:
        """Distance from a hollow to the side of a slot: they are nearest at the rim."""
        return self.radius * math.sin(self.step - self.lock) - self.half_slot

    @property
    def web(self) -> float:
        """Distance between the ends of neighbouring slots."""
        return 2.0 * (self.radius * math.cos(self.slot_end) * math.sin(self.step) - self.half_slot)

    @property
    def rim_passes(self) -> float:
        """Reach of the rim into the half of a cap opposite the roller, from the crank's axis.

        Before the middle of an index the corner between rim and hollow, at the azimuth η, reaches sin η sin(−α).
        """
        alpha = np.linspace(-0.5 * math.pi, 0.0, RIM_POSITIONS)
        # Azimuth of the corner while the slot follows the roller.
        corner = np.arctan(math.tan(self.step) * np.sin(alpha)) + self.step - self.lock
        return self.radius * max(0.0, float((-np.sin(alpha) * np.sin(corner)).max()))

    @property
    def inmost(self) -> float:
        """Minimum distance of a slot from the wheel's axis."""
        return self.radius * math.cos(self.slot_end) - self.half_slot * math.sin(self.slot_end)

    @property
    def outline(self) -> Complex:
        """The wheel seen along its axis, slot 0 along x; a closed polygon without a repeated point."""
        turn = np.linspace(0.0, 0.5 * math.pi, STEP_COUNT + 1)
        flat = math.sin(self.slot_end)
        middle = self.radius * math.cos(self.slot_end)
        end = middle + self.half_slot * (-flat * np.cos(turn) + 1j * np.sin(turn))
        mouth = math.asin(self.half_slot / self.radius)
        land = self.radius * np.exp(1j * np.linspace(mouth, self.step - self.lock, STEP_COUNT))
        chord = self.radius * math.cos(self.lock) * np.exp(1j * self.step)
        half = np.concatenate([end, land, [chord]])
        sector = np.concatenate([half[::-1].conj(), half[1:-1]])
        return np.asarray((np.exp(2j * self.step * np.arange(self.stations))[:, None] * sector).ravel())


def build_hemisphere(problem: IndexingProblem, radius: float) -> Hemisphere:
    """Build the wheel of a sphere's radius."""
    step, half_slot = math.pi / problem.stations, 0.5 * (problem.roller + problem.clearances.slot)
    apart = (half_slot + problem.wall) / radius
    lock = step - math.asin(apart) if apart < 1.0 else math.nan
    return Hemisphere(problem.stations, radius, half_slot, step + problem.slot_room / radius, lock)


def compute_margins(problem: IndexingProblem, radius: float) -> dict[str, float]:
    """Compute by how much a sphere exceeds each of its wall constraints; NaN or negative if it is too small."""
    wheel = build_hemisphere(problem, radius)
    cap = wheel.lock - problem.clearances.locking / radius
    return {
        "locking_disc": MIN_CAP_SHARE * radius * math.sin(cap) - wheel.rim_passes - problem.relief,
        "web": wheel.web - problem.wall,
        "bore": wheel.inmost - 0.5 * problem.wheel_shaft_diameter - problem.wall,
    }


def is_drawable(problem: IndexingProblem, wheel: Hemisphere) -> bool:
    """Return whether the outline exists."""
    gap = problem.clearances.locking / wheel.radius
    return (
        wheel.lock > gap
        and wheel.half_slot < wheel.radius
        and wheel.inmost > 0.0
        and wheel.web > 0.0
        and wheel.slot_end < 0.5 * math.pi
    )


def build_mechanism(problem: IndexingProblem, wheel: Hemisphere) -> SphericalGenevaMechanism:
    """Build all dimensions and the outline of a drive that can be drawn."""
    outline = wheel.outline
    return SphericalGenevaMechanism(
        stations=problem.stations,
        rollers=1,
        sphere_radius=wheel.radius,
        cone_angle=math.degrees(wheel.step),
        roller_diameter=problem.roller,
        slot_width=2.0 * wheel.half_slot,
        slot_end_angle=math.degrees(wheel.slot_end),
        cap_angle=math.degrees(wheel.lock - problem.clearances.locking / wheel.radius),
        cap_offset=wheel.rim_passes + problem.relief,
        locking_arc_angle=math.degrees(wheel.lock),
        bore=problem.wheel_shaft_diameter,
        profile=Profile(x=outline.real.tolist(), y=outline.imag.tolist()),
    )
