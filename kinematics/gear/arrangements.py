"""Planetary arrangements as data: the gears, the bodies they belong to, and the meshes between them.

A new arrangement is one more row of :data:`ARRANGEMENTS`; its speeds, coaxiality, assembly, synthesis and drawing all
follow from that row. Names of gears are the keys of ``teeth`` everywhere.

Glossary:

sun, ring     gears about the train's own axis, with external or internal teeth;
planet        a body on a pin of a carrier, with one gear (simple) or several (stepped);
planet set    planets of one carrier connected by meshes; a train has ``planets`` copies of each set around its axis;
plane         gears of one plane must not touch unless they mesh;
far side      in a bevel differential the side gear beyond the planets, which turns against the near one.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from kinematics.errors import DimensionError
from kinematics.gear.planetary import EXTERNAL, INTERNAL, Mesh, Train


@dataclass(frozen=True)
class GearPlace:
    """A gear of an arrangement: its body, the planes that it spans, and the kind of its teeth."""

    name: str
    body: str
    planes: tuple[int, ...] = (1,)
    internal: bool = False
    far: bool = False


@dataclass(frozen=True, eq=False)
class Arrangement:
    """A planetary arrangement.

    Attributes
    ----------
    gears : tuple of GearPlace
        The gears, in the order in which tooth numbers are listed.
    meshes : tuple of pairs of gear names
        Gears in mesh.
    carriers : mapping
        The carrier of every planet.
    bevel : bool
        Whether the planets' axes cross the train's axis at a right angle.
    """

    name: str
    title: str
    gears: tuple[GearPlace, ...]
    meshes: tuple[tuple[str, str], ...]
    carriers: Mapping[str, str]
    bevel: bool = False
    places: dict[str, GearPlace] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", {gear.name: gear for gear in self.gears})

    @cached_property
    def gear_names(self) -> tuple[str, ...]:
        """Names of the gears."""
        return tuple(self.places)

    @cached_property
    def members(self) -> tuple[str, ...]:
        """Bodies about the train's axis, which can be input, output or fixed; carriers last."""
        central = [gear.body for gear in self.gears if gear.body not in self.carriers]
        return tuple(dict.fromkeys([*central, *self.carriers.values()]))

    @cached_property
    def planet_sets(self) -> tuple[tuple[str, ...], ...]:
        """Planets connected by meshes between them, set by set."""
        sets = [[planet] for planet in self.carriers]
        for one, other in self.meshes:
            bodies = {self.places[one].body, self.places[other].body}
            if bodies <= self.carriers.keys():
                # Union of the sets that this mesh connects.
                joined = [members for members in sets if bodies & set(members)]
                sets = [members for members in sets if members not in joined]
                sets.append([planet for members in joined for planet in members])
        return tuple(tuple(members) for members in sets)

    def is_planet(self, gear: str) -> bool:
        """Return whether a gear is a planet."""
        return self.places[gear].body in self.carriers

    def sense(self, one: str, other: str) -> int:
        """Return the sense of a mesh: internal teeth, and the far side of a bevel differential, turn the same way."""
        gears = self.places[one], self.places[other]
        return INTERNAL if any(gear.internal or gear.far for gear in gears) else EXTERNAL

    def list_mates(self, gear: str) -> tuple[str, ...]:
        """List the gears that mesh with a gear."""
        return tuple(two if gear == one else one for one, two in self.meshes if gear in (one, two))

    def list_central_meshes(self, planet: str) -> tuple[tuple[str, str], ...]:
        """List (gear of a planet, sun or ring) for every such mesh of one planet."""
        pairs = [pair for one, other in self.meshes for pair in ((one, other), (other, one))]
        return tuple((own, mate) for own, mate in pairs if self.places[own].body == planet and not self.is_planet(mate))

    def list_independent_gears(self, planets: tuple[str, ...]) -> tuple[str, ...]:
        """List the gears of a planet set whose teeth can be chosen; coaxiality then determines the other suns and
        rings.

        Suns and rings come first, in the order of planets with the most of them: these have the most conditions.
        """
        # The most constrained planets first, so that a search fails early.
        order = sorted(planets, key=lambda body: -len(self.list_central_meshes(body)))
        central = [self.list_central_meshes(planet)[0][1] for planet in order]
        return (*central, *(gear.name for planet in order for gear in self.gears if gear.body == planet))

    def build_train(self, teeth: Mapping[str, int]) -> Train:
        """Build the speed equations for given tooth numbers.

        Raises
        ------
        DimensionError
            If ``teeth`` does not name exactly the gears of the arrangement.
        """
        if set(teeth) != set(self.places):
            raise DimensionError("teeth", "kinematics-teeth-of-gears", sorted(teeth), gears=", ".join(self.places))
        meshes = []
        for one, other in self.meshes:
            bodies = self.places[one].body, self.places[other].body
            # Every mesh of a planetary train contains at least one planet.
            carrier = next(self.carriers[body] for body in bodies if body in self.carriers)
            meshes.append(Mesh(*bodies, carrier, teeth[one], teeth[other], self.sense(one, other)))
        return Train(tuple(meshes), frozenset(self.carriers))


def _make_sun(name: str, plane: int = 1, body: str | None = None) -> GearPlace:
    return GearPlace(name, body or name, (plane,))


def _make_ring(name: str, plane: int = 1, body: str | None = None) -> GearPlace:
    return GearPlace(name, body or name, (plane,), internal=True)


def _make_planet(name: str, *planes: int, body: str | None = None) -> GearPlace:
    return GearPlace(name, body or name, planes or (1,))


def _make_stepped(name: str, description: str, first: GearPlace, second: GearPlace) -> Arrangement:
    """Make stepped planets on one carrier, between a sun or ring in the first plane and another in the second."""
    planets = _make_planet("planet_1", 1, body="planet"), _make_planet("planet_2", 2, body="planet")
    # The smaller gear of a mesh comes first, the ring second.
    near = ("planet_1", first.name) if first.internal else (first.name, "planet_1")
    return Arrangement(
        name, description, (first, *planets, second), (near, ("planet_2", second.name)), {"planet": "carrier"}
    )


ARRANGEMENTS: dict[str, Arrangement] = {
    row.name: row
    for row in (
        Arrangement(
            "simple",
            "sun, planets and ring in one plane",
            (_make_sun("sun"), _make_planet("planet"), _make_ring("ring")),
            (("sun", "planet"), ("planet", "ring")),
            {"planet": "carrier"},
        ),
        Arrangement(
            "double_planet",
            "sun and ring joined by pairs of planets, so that both turn the same way past the carrier",
            (_make_sun("sun"), _make_planet("planet_1"), _make_planet("planet_2"), _make_ring("ring")),
            (("sun", "planet_1"), ("planet_1", "planet_2"), ("planet_2", "ring")),
            {"planet_1": "carrier", "planet_2": "carrier"},
        ),
        _make_stepped("stepped", "stepped planets between a sun and a ring", _make_sun("sun"), _make_ring("ring", 2)),
        _make_stepped("stepped_suns", "stepped planets between two suns", _make_sun("sun_1"), _make_sun("sun_2", 2)),
        _make_stepped(
            "stepped_rings", "stepped planets between two rings", _make_ring("ring_1"), _make_ring("ring_2", 2)
        ),
        Arrangement(
            "wolfrom",
            "a simple set whose planets are stepped to drive a second ring; the carrier is free",
            (
                _make_sun("sun"),
                _make_planet("planet_1", 1, body="planet"),
                _make_ring("ring_1"),
                _make_planet("planet_2", 2, body="planet"),
                _make_ring("ring_2", 2),
            ),
            (("sun", "planet_1"), ("planet_1", "ring_1"), ("planet_2", "ring_2")),
            {"planet": "carrier"},
        ),
        Arrangement(
            "ravigneaux",
            "two suns and a ring on one carrier: the small sun drives short planets, the large one long planets",
            (
                _make_sun("sun_small", 1),
                _make_planet("planet_short", 1),
                _make_planet("planet_long", 1, 2),
                _make_sun("sun_large", 2),
                _make_ring("ring", 2),
            ),
            (
                ("sun_small", "planet_short"),
                ("planet_short", "planet_long"),
                ("sun_large", "planet_long"),
                ("planet_long", "ring"),
            ),
            {"planet_short": "carrier", "planet_long": "carrier"},
        ),
        Arrangement(
            "two_stage",
            "two simple sets in line: the first carrier is the second sun, and the rings are one body",
            (
                _make_sun("sun_1"),
                _make_planet("planet_1"),
                _make_ring("ring_1", 1, "ring"),
                _make_sun("sun_2", 2, "carrier_1"),
                _make_planet("planet_2", 2),
                _make_ring("ring_2", 2, "ring"),
            ),
            (("sun_1", "planet_1"), ("planet_1", "ring_1"), ("sun_2", "planet_2"), ("planet_2", "ring_2")),
            {"planet_1": "carrier_1", "planet_2": "carrier_2"},
        ),
        Arrangement(
            "simpson",
            "two simple sets with a common sun; the first carrier and the second ring are one body",
            (
                _make_sun("sun_1", 1, "sun"),
                _make_planet("planet_1"),
                _make_ring("ring_1"),
                _make_sun("sun_2", 2, "sun"),
                _make_planet("planet_2", 2),
                _make_ring("ring_2", 2, "carrier_1"),
            ),
            (("sun_1", "planet_1"), ("planet_1", "ring_1"), ("sun_2", "planet_2"), ("planet_2", "ring_2")),
            {"planet_1": "carrier_1", "planet_2": "carrier_2"},
        ),
        Arrangement(
            "bevel_differential",
            "two side gears and bevel planets between them",
            (
                GearPlace("side_1", "side_1", (1,)),
                GearPlace("planet", "planet", (2,)),
                GearPlace("side_2", "side_2", (3,), far=True),
            ),
            (("side_1", "planet"), ("planet", "side_2")),
            {"planet": "carrier"},
            bevel=True,
        ),
    )
}
"""Every known arrangement by its name."""
