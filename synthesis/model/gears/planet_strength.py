"""Loads of the meshes of a planetary train: load sharing of the planets, and reversed bending of teeth.

Stresses are computed as for any pair (:mod:`synthesis.model.gears.strength`). Each mesh exists once per planet, and the
most loaded copy carries an equal share of the torque multiplied by the load sharing factor. Relative to the carrier,
the mesh is an ordinary pair that transmits its rolling power.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated, NamedTuple

from pydantic import Field

from kinematics.gear.arrangements import Arrangement
from kinematics.gear.flanks import Contact
from kinematics.gear.teeth import Gear, Mesh
from kinematics.message import compose
from synthesis.model.gears.strength import CarriedPower, LoadedPair, StrengthMethod, describe_strength
from synthesis.model.json_object import JsonObject
from synthesis.model.problem import Statement

MAX_EQUAL_PLANETS = 3
"""Maximum number of planets that share the load equally with a floating member."""

SHARING_FACTORS = {4: 1.2, 5: 1.3}
"""Load sharing factors of four and five planets, by the rules of the American Bureau of Shipping."""

MAX_SHARING_FACTOR = 1.4
"""Load sharing factor of six and more planets, by the same rules."""

MIN_LOAD_SHARE = 1e-9
"""Share of the largest mesh torque up to which a torque counts as 0, because it is rounding."""

PAIRS_NOTE = (
    "Pairs are for the first and the second gear of every mesh, in the order of the arrangement: sun before planet, "
    "planet before planet, planet before ring. Bending of a ring is not checked unless its tooth factor is given: "
    "`form` (Lewis) or `bending_geometry` (AGMA)."
)


class PlanetSharing(Statement):
    """Load sharing of the planets."""

    load_sharing: Annotated[float, Field(strict=True, ge=1.0, le=12.0)] | None = Field(
        default=None,
        description="Load on the most loaded planet over an equal share. By default 1 for up to 3 planets, 1.2 for 4, "
        "1.3 for 5, 1.4 for more (rules of the American Bureau of Shipping for gears).",
    )

    def get_sharing_factor(self, planets: int) -> float:
        """Return the given load sharing factor, or the default for a number of planets."""
        if self.load_sharing is not None:
            return self.load_sharing
        return 1.0 if planets <= MAX_EQUAL_PLANETS else SHARING_FACTORS.get(planets, MAX_SHARING_FACTOR)

    def find_planet_errors(self, planets: int) -> list[tuple[str, str]]:
        """Return errors of the load sharing factor for a number of planets."""
        if self.load_sharing is None or self.load_sharing <= planets:
            return []
        return [("/load_sharing", compose("model-load-sharing-too-large", planets=planets))]


class PlanetStrength(PlanetSharing, StrengthMethod):
    """Strength method, its factors, allowable stresses, and load sharing of the planets."""


class PlanetPower(PlanetSharing, CarriedPower):
    """Power that a planetary train has to carry."""


class MeshLoad(NamedTuple):
    """Load of a mesh with all its copies.

    Attributes
    ----------
    torques : pair of float
        Torques on both gears, N·m, with signs as seen from one side of the train.
    speed : float
        Speed of the first gear relative to the carrier, rad/s.
    """

    torques: tuple[float, float]
    speed: float


def build_planetary_contact(gears: tuple[Gear, Gear]) -> Contact:
    """Build a contact for the strength formulas, which do not need the ends of the involutes."""
    return Contact(Mesh(*gears), (-math.inf, math.inf if gears[1].internal else -math.inf))


def convert_to_millimetres(gear: Gear, unit: float) -> Gear:
    """Convert a gear to millimetres; ``unit`` is the length unit of its module in millimetres."""
    return replace(gear, module=gear.module * unit)


def mark_bent_both_ways(arrangement: Arrangement, loads: Sequence[MeshLoad]) -> list[tuple[bool, bool]]:
    """Return for each mesh whether its gears are bent in both directions, because torques of both signs load them.

    The sign of a torque determines the loaded flank. Both flanks of a simple planet are loaded. A gear of a stepped
    planet with a single mesh is always loaded on the same flank.
    """
    least = MIN_LOAD_SHARE * max((abs(torque) for load in loads for torque in load.torques), default=0.0)
    senses: dict[str, set[bool]] = {}
    for pair, load in zip(arrangement.meshes, loads, strict=True):
        for gear, torque in zip(pair, load.torques, strict=True):
            if abs(torque) > least:
                senses.setdefault(gear, set()).add(torque > 0.0)
    return [(len(senses.get(one, ())) > 1, len(senses.get(other, ())) > 1) for one, other in arrangement.meshes]


def compute_powers(loads: Sequence[MeshLoad], teeth: Sequence[tuple[int, int]], share: float) -> list[float]:
    """Compute the power that one copy of each mesh carries relative to its carrier, W; 0 for an unloaded mesh.

    Parameters
    ----------
    loads : sequence of MeshLoad
        Loads of the meshes.
    teeth : sequence of pairs
        Tooth numbers of the meshes.
    share : float
        Load sharing factor over the number of planets.
    """
    least = MIN_LOAD_SHARE * max((abs(torque) for load in loads for torque in load.torques), default=0.0)
    found = []
    for (first, second), load in zip(teeth, loads, strict=True):
        # With losses, the force is larger on the driving gear.
        force = max(abs(load.torques[0]) / first, abs(load.torques[1]) / second)
        loaded = max(abs(torque) for torque in load.torques) > least
        found.append(share * force * first * abs(load.speed) if loaded else 0.0)
    return found


def find_plane(arrangement: Arrangement, mesh: tuple[str, str]) -> int:
    """Return the plane of a mesh, counted from 0; all gears of a plane have the same face width."""
    return min(set(arrangement.places[mesh[0]].planes) & set(arrangement.places[mesh[1]].planes)) - 1


def count_planes(arrangement: Arrangement) -> int:
    """Return the number of planes with meshes in an arrangement of spur gears."""
    return 1 + max(find_plane(arrangement, mesh) for mesh in arrangement.meshes)


def describe_strengths(
    arrangement: Arrangement,
    gears: Mapping[str, Gear],
    loads: Sequence[MeshLoad],
    planets: int,
    method: PlanetStrength | PlanetPower,
    faces: Sequence[float | None] | None,
    unit: float,
) -> list[JsonObject | None]:
    """Describe the strength of every mesh by the fields of ``PairStrength``; None for an unloaded mesh.

    Parameters
    ----------
    arrangement : Arrangement
        The gears and their meshes.
    gears : mapping
        The gears by name, in the problem's unit of length.
    loads : sequence of MeshLoad
        Loads of the meshes.
    planets : int
        Number of planets.
    method : PlanetStrength or PlanetPower
        Strength method, factors, allowable stresses and load sharing.
    faces : sequence of float or None, or None
        Face widths of the planes; None for the minimum that each mesh needs.
    unit : float
        Millimetres per unit of length.
    """
    sharing = method.get_sharing_factor(planets)
    teeth = [(int(gears[one].teeth), int(gears[other].teeth)) for one, other in arrangement.meshes]
    carried = compute_powers(loads, teeth, sharing / planets)
    bent = mark_bent_both_ways(arrangement, loads)
    found: list[JsonObject | None] = []
    for mesh, load, power, ways in zip(arrangement.meshes, loads, carried, bent, strict=True):
        if power == 0.0:
            found.append(None)
            continue
        contact = build_planetary_contact(
            (convert_to_millimetres(gears[mesh[0]], unit), convert_to_millimetres(gears[mesh[1]], unit))
        )
        loaded = LoadedPair(contact, power, abs(load.speed), ways, spares_rings=True)
        width = None if faces is None else faces[find_plane(arrangement, mesh)]
        found.append({**describe_strength(loaded, method, width, unit), "load_sharing": sharing})
    return found
