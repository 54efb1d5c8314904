"""Assembly of planetary arrangements: coaxiality, phases of the teeth, clearance between gears.

Lengths are in modules; positions around the train are exact fractions of a turn.

Phases. A planet whose pin is at θ turns, itself rotated by α, meshes there only if a tooth meets a space. With
β = θ − α and the first planet at θ = α = 0, a gear of z teeth on the planet requires (all modulo 1)::

    z β ≡ −S θ    against a sun of S teeth (or the near side of a bevel differential)
    z β ≡ +R θ    against a ring of R teeth (or the far side)
    z₁ β₁ + z₂ β₂ ≡ 0    against another planet

One β must serve all gears of a body: that is the assembly condition, (S + R) θ whole for a simple set (Norton, Sec.
9.8; Müller, Die Umlaufgetriebe, 2nd ed. 1998, Sec. 35, for stepped planets).
"""

from __future__ import annotations

import cmath
import itertools
import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from kinematics.gear.arrangements import Arrangement
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM


class Gap(NamedTuple):
    """Clearance between two gears of one plane that do not mesh, in modules; negative if they overlap."""

    one: str
    other: str
    room: float


def compute_pin_distances(arrangement: Arrangement, teeth: Mapping[str, int]) -> dict[str, list[Fraction]]:
    """Compute for each planet the distances from the axis that its suns and rings require of its pin, in modules.

    The gears are coaxial if all distances of each planet agree. For a bevel differential they are the pitch radii of
    the side gears.
    """
    distances: dict[str, list[Fraction]] = {planet: [] for planet in arrangement.carriers}
    for planet, own, central in _list_central_meshes(arrangement):
        if arrangement.bevel:
            twice = teeth[central]
        elif arrangement.places[central].internal:
            # Twice the distance, to stay in integers: inside a ring the planet's radius is subtracted.
            twice = teeth[central] - teeth[own]
        else:
            twice = teeth[central] + teeth[own]
        distances[planet].append(Fraction(twice, 2))
    return distances


def is_coaxial(arrangement: Arrangement, teeth: Mapping[str, int]) -> bool:
    """Return whether every pin has a single positive distance from the axis and meshing planets reach each other."""
    return place_pins(arrangement, teeth) is not None


def place_pins(arrangement: Arrangement, teeth: Mapping[str, int]) -> dict[str, complex] | None:
    """Place the pins of the first copy of every planet, in modules; the first of each set on the positive real axis.

    Return None if the gears are not coaxial or two meshing planets cannot reach each other.
    """
    distances = {planet: set(asked) for planet, asked in compute_pin_distances(arrangement, teeth).items()}
    if any(len(asked) != 1 or min(asked) <= 0 for asked in distances.values()):
        return None
    radius = {planet: float(min(asked)) for planet, asked in distances.items()}
    placed: dict[str, complex] = {}
    for members in arrangement.planet_sets:
        placed[members[0]] = complex(radius[members[0]])
        for planet in members[1:]:
            pin = _place_meshing_pin(arrangement, teeth, radius, placed, planet)
            if pin is None:
                return None
            placed[planet] = pin
    return placed


def _place_meshing_pin(
    arrangement: Arrangement,
    teeth: Mapping[str, int],
    radius: Mapping[str, float],
    placed: Mapping[str, complex],
    planet: str,
) -> complex | None:
    """Place the pin of a planet that meshes with one already placed, ahead of it around the axis."""
    for first, second in arrangement.meshes:
        bodies = {arrangement.places[gear].body: gear for gear in (first, second)}
        neighbour = next((body for body in bodies if body in placed and planet in bodies), None)
        if neighbour is not None:
            # Law of cosines in the triangle of the axis and both pins.
            apart = 0.5 * (teeth[first] + teeth[second])
            near, far = radius[neighbour], radius[planet]
            cosine = (near * near + far * far - apart * apart) / (2.0 * near * far)
            if abs(cosine) > 1.0:
                return None
            return cmath.rect(far, cmath.phase(placed[neighbour]) + math.acos(cosine))
    raise AssertionError("the planets of a set hang together by meshes")


def has_fit_at(arrangement: Arrangement, teeth: Mapping[str, int], members: Sequence[str], turn: Fraction) -> bool:
    """Return whether another copy of a planet set fits between the gears, ``turn`` of a full turn after the first.

    Every tooth of every planet is tried, in exact arithmetic.
    """
    demands: dict[str, list[tuple[int, Fraction]]] = {planet: [] for planet in members}
    for planet, own, central in _list_central_meshes(arrangement):
        if planet in demands:
            sense = arrangement.sense(own, central)
            # External: −S θ, internal: +R θ; the sense carries the sign.
            demands[planet].append((teeth[own], sense * teeth[central] * turn))
    between = [
        (arrangement.places[one].body, teeth[one], arrangement.places[other].body, teeth[other])
        for one, other in arrangement.meshes
        if {arrangement.places[one].body, arrangement.places[other].body} <= set(members)
    ]
    carried = [gear.body for gear in arrangement.gears]
    choices = []
    for planet in members:
        (count, phase), *others = demands[planet]
        # A planet with a single gear is the same after a turn by one tooth, so one tooth is enough.
        tried = count if carried.count(planet) > 1 else 1
        # Each solution of z β ≡ phase, one per tooth.
        turned = [(phase + tooth) / count for tooth in range(tried)]
        choices.append([beta for beta in turned if all(_is_whole(z * beta - demand) for z, demand in others)])
    # Without meshes between planets each planet is independent of the others.
    if not between:
        return all(choices)
    for combination in itertools.product(*choices):
        beta = dict(zip(members, combination, strict=True))
        if all(_is_whole(z_one * beta[one] + z_two * beta[two]) for one, z_one, two, z_two in between):
            return True
    return False


def _is_whole(value: Fraction) -> bool:
    return value.denominator == 1


def measure_gaps(
    arrangement: Arrangement,
    teeth: Mapping[str, int],
    turns: Mapping[str, Sequence[Fraction]],
    addendum: float = FULL_DEPTH_ADDENDUM,
) -> list[Gap]:
    """Measure the clearance between all gears of a plane that do not mesh, copies of planets included, in modules.

    Parameters
    ----------
    arrangement, teeth
        Coaxial gears.
    turns : mapping
        Positions of the copies of each planet's set, in turns from the first.
    addendum : float
        Distance of the tip circles from the pitch circles, modules; also used for rings whose teeth are shorter.

    Returns
    -------
    list of Gap
        The minimum clearance for each pair of gear names; empty if no gears can touch.
    """
    placed = place_pins(arrangement, teeth)
    assert placed is not None
    if arrangement.bevel:
        return _measure_bevel_gaps(arrangement, teeth, turns, addendum)
    rooms: dict[tuple[str, str], float] = {}

    def note_gap(one: str, other: str, room: float) -> None:
        rooms[one, other] = min(room, rooms.get((one, other), math.inf))

    tip = {gear: 0.5 * teeth[gear] + addendum for gear in arrangement.gear_names}
    moving = [gear for gear in arrangement.gear_names if arrangement.is_planet(gear)]
    for k, one in enumerate(moving):
        body = arrangement.places[one].body
        for central in arrangement.gear_names:
            if (
                central in moving
                or not _share_a_plane(arrangement, one, central)
                or one in arrangement.list_mates(central)
            ):
                continue
            # The tips of a ring point inwards.
            ring_tip = 0.5 * teeth[central] - addendum
            reach = abs(placed[body]) + tip[one]
            internal = arrangement.places[central].internal
            note_gap(one, central, ring_tip - reach if internal else abs(placed[body]) - tip[one] - tip[central])
        for other in moving[k:]:
            if not _share_a_plane(arrangement, one, other):
                continue
            mate = arrangement.places[other].body
            for here, there in itertools.product(turns[body], turns[mate]):
                # Planets of one copy that mesh do touch, by design.
                same_copy = here == there
                if same_copy and (body == mate or one in arrangement.list_mates(other)):
                    continue
                ahead = cmath.exp(2j * math.pi * float(there - here))
                note_gap(one, other, abs(placed[mate] * ahead - placed[body]) - tip[one] - tip[other])
    return [Gap(*pair, room) for pair, room in rooms.items()]


def _measure_bevel_gaps(
    arrangement: Arrangement, teeth: Mapping[str, int], turns: Mapping[str, Sequence[Fraction]], addendum: float
) -> list[Gap]:
    """Measure the clearance between bevel planets at their large ends, in the planes midway between their pins.

    The pitch circle of a planet's large end lies at the side gear's pitch radius from the axis.
    """
    gaps = []
    for planet, side, *_ in ((own, central) for _, own, central in _list_central_meshes(arrangement)):
        # Pitch cone of the planet, for axes at a right angle.
        cone = math.atan2(teeth[planet], teeth[side])
        places = sorted(turns[arrangement.places[planet].body])
        between = [float(b - a) for a, b in zip(places, [*places[1:], places[0] + 1], strict=True) if len(places) > 1]
        for share in between:
            # Pins half a turn or more apart have the axis between them: no bisecting plane to cross.
            if share < 0.5:
                half = 0.5 * teeth[side] * math.tan(math.pi * share)
                gaps.append(Gap(planet, planet, 2.0 * (half - 0.5 * teeth[planet] - addendum * math.cos(cone))))
        # Both side gears give the same planets.
        break
    return gaps


def _list_central_meshes(arrangement: Arrangement) -> list[tuple[str, str, str]]:
    """List (planet, its gear, the sun or ring) for every mesh between a planet and a gear about the axis."""
    return [(planet, *pair) for planet in arrangement.carriers for pair in arrangement.list_central_meshes(planet)]


def _share_a_plane(arrangement: Arrangement, first: str, second: str) -> bool:
    return bool(set(arrangement.places[first].planes) & set(arrangement.places[second].planes))
