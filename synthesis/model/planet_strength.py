"""What the meshes of a planetary train carry: the shares of its planets, and which of their teeth are bent both ways.

The stresses are those of any pair (:mod:`synthesis.model.gear_strength`). A mesh stands on the train as many times as
there are planets, and each copy has an equal share of its torque, raised by how unevenly planets share. Relative to the
carrier it is an ordinary pair: what it carries there is its rolling power, and its pitch-line speed is the one there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from kinematics.gear.arrangements import Arrangement
from kinematics.gear.flanks import Contact
from kinematics.gear.teeth import Gear, Mesh
from synthesis.model.gear_strength import CarriedPower, Loaded, StrengthMethod, told
from synthesis.model.statement import Statement

SHARED_EQUALLY = 3
"""Planets up to which a member that floats lets all of them carry alike."""

SHARING = {4: 1.2, 5: 1.3}
"""Load sharing factor of more planets by the rules of the American Bureau of Shipping."""

SHARING_OF_MANY = 1.4
"""The same of six planets and more."""

UNLOADED = 1e-9
"""Share of the greatest mesh torque below which a torque is what rounding has left of none."""

PAIRS = (
    "Pairs are of the first gear of every mesh and the second, as the arrangement has them: sun before planet, planet "
    "before planet, planet before ring. Bending of a ring is not judged unless the factor of its teeth is stated: "
    "`form` (Lewis) or `bending_geometry` (AGMA)."
)


class SharedByPlanets(Statement):
    """How evenly the planets share the load."""

    load_sharing: Annotated[float, Field(strict=True, ge=1.0, le=12.0)] | None = Field(
        default=None,
        description="Load on the most loaded planet over an equal share. Left out: 1 of up to 3 planets, 1.2 of 4, 1.3 "
        "of 5, 1.4 of more (rules of the American Bureau of Shipping for gears).",
    )

    def sharing(self, planets: int) -> float:
        """The factor of so many planets."""
        if self.load_sharing is not None:
            return self.load_sharing
        return 1.0 if planets <= SHARED_EQUALLY else SHARING.get(planets, SHARING_OF_MANY)

    def faults_of_planets(self, planets: int) -> list[tuple[str, str]]:
        """What is wrong with so many planets."""
        if self.load_sharing is None or self.load_sharing <= planets:
            return []
        return [("/load_sharing", f"one of {planets} planets carries at most all, {planets} times an equal share")]


class PlanetStrength(SharedByPlanets, StrengthMethod):
    """The method, its factors, what the material may bear, and how evenly planets share."""


class PlanetPower(SharedByPlanets, CarriedPower):
    """What a planetary train that is looked for has to carry."""


class MeshLoad(NamedTuple):
    """What a mesh carries with all its copies: torques on both gears, and the first one's speed past the carrier.

    Torques are signed, seen from one side of the train.
    """

    torques: tuple[float, float]
    speed: float


def planetary_contact(gears: tuple[Gear, Gear]) -> Contact:
    """A mesh as the formulas of strength take it: they look at no end of an involute, so that none is found here."""
    return Contact(Mesh(*gears), (-math.inf, math.inf if gears[1].internal else -math.inf))


def in_millimetres(gear: Gear, unit: float) -> Gear:
    """A gear whose module is in a unit of so many millimetres."""
    return replace(gear, module=gear.module * unit)


def both_ways(arrangement: Arrangement, loads: Sequence[MeshLoad]) -> list[tuple[bool, bool]]:
    """Which gears of each mesh are bent both ways: those that meshes turn one way and the other.

    The sign of a torque tells the flank that is pressed, so that of a simple planet both are, and of a stepped one with
    one mesh a gear the same one always.
    """
    least = UNLOADED * max((abs(torque) for load in loads for torque in load.torques), default=0.0)
    senses: dict[str, set[bool]] = {}
    for pair, load in zip(arrangement.meshes, loads, strict=True):
        for gear, torque in zip(pair, load.torques, strict=True):
            if abs(torque) > least:
                senses.setdefault(gear, set()).add(torque > 0.0)
    return [(len(senses.get(one, ())) > 1, len(senses.get(other, ())) > 1) for one, other in arrangement.meshes]


def powers(loads: Sequence[MeshLoad], teeth: Sequence[tuple[int, int]], share: float) -> list[float]:
    """Power that one copy of each mesh carries past its carrier, W; 0 of a mesh that carries nothing.

    Parameters
    ----------
    teeth : sequence of pairs
        Of each mesh.
    share : float
        Load sharing factor over the number of planets.
    """
    least = UNLOADED * max((abs(torque) for load in loads for torque in load.torques), default=0.0)
    found = []
    for (first, second), load in zip(teeth, loads, strict=True):
        # With losses the gear that drives has the greater force.
        force = max(abs(load.torques[0]) / first, abs(load.torques[1]) / second)
        loaded = max(abs(torque) for torque in load.torques) > least
        found.append(share * force * first * abs(load.speed) if loaded else 0.0)
    return found


def plane_of(arrangement: Arrangement, mesh: tuple[str, str]) -> int:
    """The plane in which a mesh lies, counted from 0; gears of one plane have one face."""
    return min(set(arrangement.places[mesh[0]].planes) & set(arrangement.places[mesh[1]].planes)) - 1


def planes_of(arrangement: Arrangement) -> int:
    """In how many planes an arrangement of spur gears has meshes."""
    return 1 + max(plane_of(arrangement, mesh) for mesh in arrangement.meshes)


def strengths(
    arrangement: Arrangement,
    gears: Mapping[str, Gear],
    loads: Sequence[MeshLoad],
    planets: int,
    stated: PlanetStrength | PlanetPower,
    faces: Sequence[float | None] | None,
    unit: float,
) -> list[dict[str, Any] | None]:
    """The strength of every mesh in the shape of ``PairStrength``; None of one that carries nothing.

    Parameters
    ----------
    gears : mapping
        The gears by name, in the problem's unit of length.
    loads : sequence of MeshLoad
        Of each mesh, N m and rad/s.
    faces : sequence of float or None, or None
        Widths of the planes; None, of one or of all: the least that each mesh needs.
    unit : float
        Millimetres in the unit of length.
    """
    sharing = stated.sharing(planets)
    teeth = [(int(gears[one].teeth), int(gears[other].teeth)) for one, other in arrangement.meshes]
    carried = powers(loads, teeth, sharing / planets)
    bent = both_ways(arrangement, loads)
    found: list[dict[str, Any] | None] = []
    for mesh, load, power, ways in zip(arrangement.meshes, loads, carried, bent, strict=True):
        if power == 0.0:
            found.append(None)
            continue
        contact = planetary_contact((in_millimetres(gears[mesh[0]], unit), in_millimetres(gears[mesh[1]], unit)))
        loaded = Loaded(contact, power, abs(load.speed), ways, spares_rings=True)
        width = None if faces is None else faces[plane_of(arrangement, mesh)]
        found.append({**told(loaded, stated, width, unit), "load_sharing": sharing})
    return found
