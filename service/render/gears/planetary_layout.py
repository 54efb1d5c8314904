"""Positions of the gears of a planetary train: centres, planes, and rotations in which all teeth mesh."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from kinematics.gear.arrangements import ARRANGEMENTS, Arrangement
from kinematics.gear.assembly import place_pins
from kinematics.gear.teeth import Gear
from service.render.gears.placement import PlacedGear, align_mate
from synthesis.kinds.planetary_train.design import PlanetaryMechanism


@dataclass(frozen=True)
class PlanetaryGear(PlacedGear):
    """A gear of a planetary train; ``copy`` counts the copies of a planet."""

    name: str
    body: str
    copy: int
    planes: tuple[int, ...]


def place_planetary_gears(mechanism: PlanetaryMechanism) -> list[PlanetaryGear]:
    """Return all gears with the axis at 0 and the first planet of each set on the positive real axis.

    Bevel gears are shown spread out in one plane, without meshing teeth.
    """
    arrangement = ARRANGEMENTS[mechanism.arrangement]
    placed = place_pins(arrangement, mechanism.teeth)
    if placed is None:
        return []
    gears = {
        name: Gear(
            mechanism.teeth[name],
            mechanism.module,
            math.radians(mechanism.pressure_angle),
            mechanism.addendum[name],
            internal=arrangement.places[name].internal,
        )
        for name in arrangement.gear_names
    }
    # Pins are computed for module 1.
    centres = {planet: mechanism.module * pin for planet, pin in placed.items()}
    first = _align_first_copies(arrangement, gears, centres)
    layout = []
    for place in arrangement.gears:
        carried = place.body in arrangement.carriers
        copies = [] if carried else [(0j, 0.0)]
        if carried:
            places = mechanism.places[place.body]
            for step in places.steps:
                turn = 2.0 * math.pi * step / places.divisions
                turned = _find_copy_rotation(arrangement, gears, centres, first, place.body, turn)
                copies.append((centres[place.body] * cmath.exp(1j * turn), turned))
        for copy, (centre, turned) in enumerate(copies):
            at = first[place.name] + turned
            layout.append(PlanetaryGear(gears[place.name], centre, at, place.name, place.body, copy, place.planes))
    return layout


def _align_first_copies(
    arrangement: Arrangement, gears: dict[str, Gear], centres: dict[str, complex]
) -> dict[str, float]:
    """Return the angle of a tooth of every gear with the first copies of the planets in mesh."""
    turned: dict[str, float] = {}
    for start in arrangement.gear_names:
        if start in turned:
            continue
        turned[start] = 0.0
        waiting = [start]
        # Propagate the rotation from gear to gear; each gear is fixed when it is first reached.
        while waiting:
            known = waiting.pop()
            for mate in arrangement.list_mates(known):
                if mate not in turned:
                    ahead = _find_contact_direction(arrangement, centres, known, mate)
                    turned[mate] = align_mate(gears[known], turned[known], gears[mate], ahead)
                    waiting.append(mate)
    return turned


def _find_contact_direction(arrangement: Arrangement, centres: dict[str, complex], own: str, mate: str) -> float:
    """Return the angle from the centre of ``own`` to its contact with ``mate``."""
    here, there = (centres.get(arrangement.places[gear].body, 0j) for gear in (own, mate))
    # In internal mesh both centres lie on the same side of the contact.
    if arrangement.places[own].internal or arrangement.places[mate].internal:
        return cmath.phase(here or there)
    return cmath.phase(there - here)


def _find_copy_rotation(
    arrangement: Arrangement,
    gears: dict[str, Gear],
    centres: dict[str, complex],
    first: dict[str, float],
    planet: str,
    turn: float,
) -> float:
    """Return the rotation of a planet's copy about its own axis with which all its gears mesh.

    The copy is ``turn`` radians ahead of the first copy on the carrier. Its first gear determines the rotation up to
    whole teeth. Among these rotations the one that fits the other gears best is chosen.
    """
    (own, central), *others = arrangement.list_central_meshes(planet)
    ahead = cmath.phase(centres[planet]) + turn
    base = _find_tooth_angle(gears, first, central, own, ahead) - first[own]
    # Rotations by whole teeth of the first gear leave its own mesh unchanged.
    pitch = 2.0 * math.pi / gears[own].teeth

    def measure_misfit(turned: float) -> float:
        return sum(
            abs(
                math.remainder(
                    first[gear] + turned - _find_tooth_angle(gears, first, mate, gear, ahead),
                    2.0 * math.pi / gears[gear].teeth,
                )
            )
            for gear, mate in others
        )

    return min((base + pitch * k for k in range(int(gears[own].teeth))), key=measure_misfit)


def _find_tooth_angle(gears: dict[str, Gear], first: dict[str, float], central: str, own: str, ahead: float) -> float:
    """Return the angle of a tooth of a planet gear that meshes with a sun or ring, its pin in direction ``ahead``."""
    return align_mate(gears[central], first[central], gears[own], ahead)
