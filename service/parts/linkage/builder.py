"""Builds the assembly of a mechanism from the planes of its links.

The upper face of plane k is at k pitches, its lower face one thickness below; the base is plane 0. A pin carries, from
below: its head or a retaining ring, the plates that it joins with washers or a spacer in every gap, and a cap or
another ring. A second base, if any, is above all planes, or between them if a link is divided: the two plates of that
link, and the input between the bases, are keyed to their shafts.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from kinematics.linkage.layout import Division, Piece, list_pieces
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from kinematics.message import compose, join_messages
from service.parts.assembly.colours import BASE_COLOUR, BLOCK_COLOUR, LINK_COLOURS
from service.parts.assembly.descriptions import describe_identifier, describe_name, name_material
from service.parts.assembly.fasteners import FASTENER_COLOUR, MATERIALS, PinShape, make_fillers, make_pin
from service.parts.assembly.keys import find_key, make_bore, make_key_section, make_shaft_section
from service.parts.assembly.model import Assembly, Carrier, Part, simplify_name
from service.parts.assembly.plate_stack import STUB_LENGTH
from service.parts.assembly.sizes import MIN_WALL_PER_PIN, Sizes
from service.parts.gears.teeth import make_teeth
from service.parts.geometry.regions import Disc, Loop, Outline, Region, make_ring, widen_hull
from service.parts.geometry.solids import Prism
from service.parts.linkage.gears import PairWheel
from service.parts.linkage.motion import LinkageMotion

COINCIDENCE_TOLERANCE = 1e-9
"""Distance, as a share of the mechanism's size, below which joints of one link coincide."""

REACH_INPUTS = 361
"""Number of inputs at which the reach of the links is measured, to place posts outside it."""


class Planes(NamedTuple):
    """Planes of plates and pins.

    Attributes
    ----------
    plates : mapping of str to int
        Planes of links, of the two plates of a divided link, and of gears, from 1.
    pins : mapping of str to pair of int
        The lowest and the highest plane of each pin, by joint.
    bases : tuple of int
        Plane 0, and that of the second base if there is one.
    division : Division, optional
        Division of a link into two plates on either side of the second base.
    """

    plates: Mapping[str, int]
    pins: Mapping[str, tuple[int, int]]
    bases: tuple[int, ...]
    division: Division | None = None

    @property
    def moving(self) -> int:
        """Number of planes with moving links."""
        return len({*self.plates.values()})


class Cut(NamedTuple):
    """A hole in a plate: for a pin, or the slot of a slide."""

    outline: Outline
    name: str


class Slot(NamedTuple):
    """A slot of a link: the block's joint, the direction of its line, and the ends of the joint's travel."""

    joint: str
    link: str
    direction: complex
    ends: tuple[complex, complex]


def build_assembly(
    motion: LinkageMotion, planes: Planes, slots: Sequence[Slot], wheels: Sequence[PairWheel], sizes: Sizes,
    unit: float, scale: float,
) -> Assembly:  # fmt: skip
    """Build the assembly of a mechanism.

    Parameters
    ----------
    motion : LinkageMotion
        Motion in millimetres.
    planes : Planes
    slots : sequence of Slot
        Slot of each slide.
    wheels : sequence of PairWheel
        Gears, and possibly an idler between them.
    sizes : Sizes
    unit, scale : float
        Fields of the assembly.
    """
    builder = _Builder(motion.mechanism, planes, slots, wheels, sizes)
    parts = (
        *builder.make_plates(), *builder.make_gears(), *builder.make_blocks(), *builder.make_bases(motion),
        *builder.make_pins(),
    )  # fmt: skip
    notes = (*_list_notes(wheels), *builder.list_notes())
    return Assembly(parts, motion, planes.moving, len(planes.bases), unit, scale, notes)


def _list_notes(wheels: Sequence[PairWheel]) -> tuple[str, ...]:
    if not wheels:
        return ()
    teeth = join_messages(
        [
            compose("parts-teeth-of-wheel", teeth=round(wheel.gear.teeth), wheel=describe_name(wheel.name))
            for wheel in wheels
        ],
        ", ",
    )
    return (
        compose("parts-linkage-gear-teeth", teeth=teeth, module=f"{wheels[0].gear.module:.6g}"),
        compose("parts-linkage-gears-keyed"),
    )


def measure_keyway_reach(sizes: Sizes) -> float:
    """Return the distance from the axis of a keyed hole to the corners of its keyway."""
    key = find_key(sizes.pin)
    return math.hypot(0.5 * sizes.pin + key.in_hub + sizes.clearance, 0.5 * key.width + sizes.clearance)


class _Builder:
    def __init__(
        self, mechanism: Mechanism, planes: Planes, slots: Sequence[Slot], wheels: Sequence[PairWheel], sizes: Sizes
    ) -> None:
        self._mechanism, self._planes, self._slots, self._sizes = mechanism, planes, slots, sizes
        self._wheels = wheels
        self._pieces = list_pieces(mechanism, planes.division)
        self._shafts = {wheel.joint: wheel.link for wheel in wheels if wheel.joint is not None}
        if planes.division is not None:
            self._shafts[planes.division.pivot] = planes.division.link
        self._at = {name: complex(z) for name, z in mechanism.joints.items()}
        self._at |= {wheel.name: wheel.centre for wheel in wheels if wheel.joint is None}
        size = max(abs(z - w) for z, w in combinations(self._at.values(), 2))
        self._key = find_key(sizes.pin)
        self._near = COINCIDENCE_TOLERANCE * size
        self._groups = {joint: self._group_joints(joint) for joint in planes.pins}
        self._posts: dict[str, complex] = {}
        self._across = 1.0 + 0.0j
        self._driven = self._find_input_shaft()
        if self._driven is not None:
            self._shafts[self._driven] = mechanism.input

    def _find_input_shaft(self) -> str | None:
        """Return the joint of the input's shaft, if the input is alone on it and inaccessible between bases."""
        division, mechanism = self._planes.division, self._mechanism
        if division is None or mechanism.input not in division.inside:
            return None
        pivots = [joint for joint in mechanism.links[mechanism.input] if joint in mechanism.links[GROUND]]
        alone = [
            joint
            for joint, group in self._groups.items()
            if group & {*pivots} and sum(bool(piece.joints & group) for piece in self._pieces) == 1
        ]
        return next((joint for joint in alone if self._planes.pins[joint][0] == 0), None)

    def list_notes(self) -> list[str]:
        """Return the assembly notes of a divided link and its drive."""
        division = self._planes.division
        if division is None:
            return []
        notes = [compose("parts-divided-link", link=division.link, pivot=division.pivot)]
        if self._driven is not None:
            notes.append(compose("parts-input-on-shaft", pivot=self._driven))
        return notes

    def _group_joints(self, joint: str) -> set[str]:
        """Return the joints that share one pin with this joint: joints of one link in the same place."""
        found, grown = {joint}, True
        while grown:
            # Coincidence is transitive over links: repeat until no joint is added.
            more = {
                other
                for listed in self._mechanism.links.values()
                for one in found & set(listed)
                for other in listed
                if abs(self._at[other] - self._at[one]) <= self._near
            }
            grown = not more <= found
            found |= more
        return found

    def _get_level(self, plane: int) -> tuple[float, float]:
        top = plane * self._sizes.pitch
        return top - self._sizes.thickness, top

    # Plates

    def make_plates(self) -> list[Part]:
        """Make the moving links, the input first."""
        moving = [link for link in self._mechanism.links if link != GROUND]
        # The input comes first and gets the first colour.
        moving.sort(key=lambda link: link != self._mechanism.input)
        colours = {link: LINK_COLOURS[n % len(LINK_COLOURS)] for n, link in enumerate(moving)}
        ordered = sorted(self._pieces, key=lambda piece: moving.index(piece.link))
        return [self._make_link(piece, colours[piece.link]) for piece in ordered]

    def _make_link(self, piece: Piece, colour: str) -> Part:
        listed = [joint for joint in self._mechanism.links[piece.link] if joint in piece.joints]
        slots = [slot for slot in self._slots if slot.link == piece.link and slot.joint in piece.joints]
        points = [self._at[joint] for joint in listed]
        reached = points[1:]
        for slot in slots:
            points += self._find_slot_ends(slot)
        outer = widen_hull(points, 0.5 * self._sizes.width)
        region = Region(outer, tuple(cut.outline for cut in self.list_cuts(piece)))
        # The length of a plate is measured towards its farthest joint.
        direction = max((z - points[0] for z in reached or points), key=abs)
        plane = self._planes.plates[piece.name]
        return Part(
            name=f"link_{simplify_name(piece.name)}",
            described=describe_identifier(piece.name),
            sort="link",
            carrier=Carrier(piece.link, self._mechanism.links[piece.link][0]),
            bodies=(Prism(region, *self._get_level(plane)),),
            along=direction / abs(direction),
            planes=(plane, plane),
            material=name_material(MATERIALS[self._sizes.process][0]),
            colour=colour,
        )

    def list_cuts(self, piece: Piece) -> list[Cut]:
        """Return the holes of a plate for pins and for free points, and its slots."""
        radius = 0.5 * self._sizes.hole
        own = {joint for joint in self._mechanism.links[piece.link] if joint in piece.joints}
        cuts = [
            Cut(self._make_hole(self._at[next(iter(own & group))], self._find_keyed_link(joint) is not None), joint)
            for joint, group in self._groups.items()
            if own & group
        ]
        for slot in self._slots:
            if slot.link == piece.link and slot.joint in piece.joints:
                wide = 0.5 * self._sizes.block[1] + self._sizes.clearance
                cuts.append(Cut(widen_hull(self._find_slot_ends(slot), wide), slot.joint))
        pinned = {joint for group in self._groups.values() for joint in group}
        # Free points get a hole only where enough wall remains.
        spare = radius + MIN_WALL_PER_PIN * self._sizes.pin
        for joint in self._mechanism.links[piece.link]:
            if joint in own and joint not in pinned:
                place = self._at[joint]
                if all(_estimate_distance(place, cut.outline) >= spare for cut in cuts):
                    cuts.append(Cut(Disc(place, radius), joint))
        return cuts

    def _make_hole(self, place: complex, keyed: bool) -> Outline:
        """Return the hole for a pin, or the bore with keyway for a keyed shaft."""
        if keyed:
            return make_bore(place, self._sizes.pin, self._key, self._sizes.clearance)
        return Disc(place, 0.5 * self._sizes.hole)

    def _find_keyed_link(self, joint: str) -> str | None:
        """Return the link keyed to the pin at a joint: next to a gear, divided, or driven by it; None without a key."""
        return next((self._shafts[one] for one in self._groups[joint] if one in self._shafts), None)

    def make_gears(self) -> list[Part]:
        """Make the gears of links, and an idler on its own pin."""
        found = []
        for n, wheel in enumerate(self._wheels, len(self._mechanism.links) - 1):
            teeth = make_teeth(wheel.gear, wheel.centre, wheel.tooth_at, play=0.5 * self._sizes.clearance)
            plane = self._planes.plates[wheel.name]
            found.append(
                Part(
                    name=simplify_name(wheel.name),
                    described=compose(
                        "parts-wheel-with-teeth",
                        wheel=describe_identifier(wheel.name),
                        teeth=f"{round(wheel.gear.teeth)}",
                    ),
                    sort="gear",
                    carrier=Carrier(wheel.name if wheel.joint is None else wheel.link, wheel.joint),
                    bodies=(
                        Prism(
                            Region(teeth, (self._make_hole(wheel.centre, wheel.joint is not None),)),
                            *self._get_level(plane),
                        ),
                    ),
                    along=1.0 + 0.0j,
                    planes=(plane, plane),
                    material=name_material(MATERIALS[self._sizes.process][0]),
                    colour=LINK_COLOURS[n % len(LINK_COLOURS)],
                )
            )
        return found

    def _find_slot_ends(self, slot: Slot) -> list[complex]:
        """Return the centres of a slot's round ends."""
        length, width = self._sizes.block
        beyond = 0.5 * (length - width) * slot.direction
        # The block's round ends reach beyond its joint.
        return [slot.ends[0] - beyond, slot.ends[1] + beyond]

    def make_blocks(self) -> list[Part]:
        """Make the blocks that run in slots."""
        length, width = self._sizes.block
        found = []
        placed = [(slot, plane) for slot in self._slots for plane in self._find_block_planes(slot)]
        for n, (slot, plane) in enumerate(placed):
            place = self._at[slot.joint]
            half = 0.5 * (length - width) * slot.direction
            outer = widen_hull([place - half, place + half], 0.5 * width)
            found.append(
                Part(
                    name=f"block_{simplify_name(slot.joint)}{'' if len(placed) == 1 else f'_{n + 1}'}",
                    described=compose("parts-block", joint=slot.joint),
                    sort="block",
                    carrier=Carrier(slot.link, slot.joint),
                    bodies=(Prism(Region(outer, (Disc(place, 0.5 * self._sizes.hole),)), *self._get_level(plane)),),
                    along=slot.direction,
                    planes=(plane, plane),
                    material=name_material({"print": "PETG", "laser": "sheet", "mill": "bronze"}[self._sizes.process]),
                    colour=BLOCK_COLOUR,
                )
            )
        return found

    def _find_block_planes(self, slot: Slot) -> list[int]:
        """Return the planes with a block at a joint: that of the slotted link, or those of the bases in reach."""
        if slot.link != GROUND:
            return [
                self._planes.plates[piece.name]
                for piece in self._pieces
                if piece.link == slot.link and slot.joint in piece.joints
            ]
        reach = next(reach for joint, reach in self._planes.pins.items() if slot.joint in self._groups[joint])
        return [plane for plane in self._planes.bases if plane in reach]

    # Bases

    def make_bases(self, motion: LinkageMotion) -> list[Part]:
        """Make the base, and the second one with posts."""
        if len(self._planes.bases) == 2:
            self._posts = self._place_posts(motion)
        names = dict(zip(self._planes.bases, ("base", "second_base"), strict=False))
        return [self._make_base(name, plane) for plane, name in names.items()]

    def _place_posts(self, motion: LinkageMotion) -> dict[str, complex]:
        """Return positions of four posts outside everything that moves between the bases.

        They are aligned with a slot of the second base that is used from above, on either side of it.
        """
        driven = motion.compute_state(motion.sample_inputs(REACH_INPUTS))
        second = self._planes.bases[1]
        swept = []
        for piece in self._pieces:
            if self._planes.plates[piece.name] < second:
                points = [self._at[joint] for joint in self._mechanism.links[piece.link] if joint in piece.joints]
                slots = [slot for slot in self._slots if slot.link == piece.link and slot.joint in piece.joints]
                points += [end for slot in slots for end in self._find_slot_ends(slot)]
                placed = motion.compute_placement(Carrier(piece.link, self._mechanism.links[piece.link][0]), driven)
                swept += [placed.turn * z + placed.shift for z in points]
        above = {one for joint, group in self._groups.items() if self._planes.pins[joint][0] == second for one in group}
        still = [self._at[joint] for joint in self._mechanism.links[GROUND] if joint not in above]
        for slot in self._slots:
            if slot.link == GROUND and slot.joint not in above:
                still += self._find_slot_ends(slot)
            elif slot.link == GROUND:
                self._across = slot.direction
        places = np.concatenate([*swept, np.array(still)]) / self._across
        places = places[np.isfinite(places)]
        # Half a plate, half a post, a block that protrudes from its plate, and twice the minimum distance of parts.
        room = 0.5 * (self._sizes.width + self._sizes.collar) + self._sizes.block[0] + 2.0 * self._sizes.min_gap
        left, right = float(places.real.min()) - room, float(places.real.max()) + room
        low, high = float(places.imag.min()) - room, float(places.imag.max()) + room
        corners = (complex(left, low), complex(right, low), complex(right, high), complex(left, high))
        return {f"post_{n + 1}": self._across * place for n, place in enumerate(corners)}

    def _is_ground_slide(self, joint: str) -> bool:
        return any(slot.link == GROUND and slot.joint in self._groups[joint] for slot in self._slots)

    def _find_base_holes(self, plane: int) -> list[complex]:
        """Return the centres of the holes in a base."""
        shafts = [
            self._at[joint]
            for joint, (low, high) in self._planes.pins.items()
            if low <= plane <= high and not self._is_ground_slide(joint)
        ]
        return [*shafts, *self._posts.values()]

    def _make_base(self, name: str, plane: int) -> Part:
        _, width = self._sizes.block
        holes = self._find_base_holes(plane)
        slots = [slot for slot in self._slots if slot.link == GROUND and plane in self._find_block_planes(slot)]
        points = holes + [end for slot in slots for end in self._find_slot_ends(slot)]
        outer = widen_hull(points, 0.5 * self._sizes.width)
        cuts: list[Outline] = [Disc(place, 0.5 * self._sizes.hole) for place in holes]
        cuts += [widen_hull(self._find_slot_ends(slot), 0.5 * width + self._sizes.clearance) for slot in slots]
        low, high = self._get_level(plane)
        prisms = [Prism(Region(outer, tuple(cuts)), low, high)]
        if self._sizes.process == "print":
            prisms += self._make_bosses(plane, low, high)
        return Part(
            name=name,
            described=describe_identifier(name),
            sort="base",
            carrier=Carrier(GROUND, None),
            bodies=tuple(prisms),
            along=_find_longest_direction(points) if len(self._planes.bases) == 1 else self._across,
            planes=(plane, plane),
            material=name_material(MATERIALS[self._sizes.process][0]),
            colour=BASE_COLOUR,
        )

    def _make_bosses(self, plane: int, low: float, high: float) -> list[Prism]:
        """Return the bosses of a printed base around its shafts.

        They extend up to the nearest plate, or down to it from an upper base.
        """
        prisms = []
        for joint in self._planes.pins:
            levels = self._find_levels(joint)
            if self._is_ground_slide(joint) or plane not in levels:
                continue
            boss = make_ring(self._at[joint], 0.5 * self._sizes.collar, 0.5 * self._sizes.hole)
            for lower, upper in pairwise(levels):
                if lower == plane:
                    prisms.append(Prism(boss, high, self._get_level(upper)[0] - self._sizes.play))
                elif upper == plane and self._is_boss_gap(lower, upper):
                    prisms.append(Prism(boss, self._get_level(lower)[1] + self._sizes.play, low))
        return prisms

    def _is_boss_gap(self, lower: int, upper: int) -> bool:
        """Return whether a boss of a printed base fills the gap between two planes, on one side of each base."""
        hanging = upper in self._planes.bases and upper > max(self._planes.plates.values())
        return lower in self._planes.bases or hanging

    # Parts on pins

    def _find_levels(self, joint: str) -> list[int]:
        """Return the planes that a pin joins, including bases and blocks, from below."""
        group = self._groups[joint]
        low, high = self._planes.pins[joint]
        levels = {self._planes.plates[piece.name] for piece in self._pieces if piece.joints & group}
        levels |= self._find_gear_planes(joint)
        levels |= {plane for plane in self._planes.bases if low <= plane <= high}
        return sorted(levels)

    def _find_gear_planes(self, joint: str) -> set[int]:
        """Return the planes of gears on the pin at a joint."""
        group = self._groups[joint]
        return {self._planes.plates[wheel.name] for wheel in self._wheels if (wheel.joint or wheel.name) in group}

    def make_pins(self) -> list[Part]:
        """Make pins with their fasteners and distance pieces."""
        parts: list[Part] = []
        for joint in self._planes.pins:
            levels = self._find_levels(joint)
            spans = list(pairwise(levels))
            if self._sizes.process == "print" and not self._is_ground_slide(joint):
                # A printed base has bosses in these gaps.
                spans = [span for span in spans if not self._is_boss_gap(*span)]
            link = self._find_keyed_link(joint)
            if link is None:
                carrier = Carrier(GROUND, None if joint not in self._mechanism.joints else joint)
                parts += self._make_pin(
                    simplify_name(joint), compose("parts-pin", name=joint), carrier, self._at[joint], levels, spans
                )
                continue
            own = {self._planes.plates[piece.name] for piece in self._pieces if piece.link == link}
            keyed = sorted(own | self._find_gear_planes(joint))
            parts += self._make_pin(
                simplify_name(joint),
                compose("parts-shaft-at-joint", joint=joint),
                Carrier(link, joint),
                self._at[joint],
                levels,
                spans,
                keyed,
                driven=joint == self._driven,
            )
        for name, place in self._posts.items():
            levels = [*self._planes.bases]
            spans = [(levels[0], levels[1])]
            parts += self._make_pin(name, describe_identifier(name), Carrier(GROUND, None), place, levels, spans)
        return parts

    def _make_pin(
        self, name: str, described: str, carrier: Carrier, place: complex, levels: Sequence[int],
        spans: Sequence[tuple[int, int]], keyed: Sequence[int] = (), *, driven: bool = False,
    ) -> list[Part]:  # fmt: skip
        """Make a pin through its planes, distance pieces in the gaps, and keys in the planes that rotate with it."""
        ends = self._get_level(levels[0])[0], self._get_level(levels[-1])[1]
        section = Region(make_shaft_section(place, self._sizes.pin, self._key))
        # The shaft has a keyway at every plate that rotates with it.
        seats = [Prism(section, *self._get_level(plane)) for plane in keyed]
        parts = make_pin(
            name, described, carrier, place, ends, (levels[0], levels[-1]), self._sizes,
            PinShape(seats, STUB_LENGTH * self._sizes.pin if driven else 0.0, driven),
        )  # fmt: skip
        parts += [self._make_key(name, carrier, place, plane) for plane in keyed]
        for span in spans:
            gap = self._get_level(span[0])[1], self._get_level(span[1])[0]
            parts += make_fillers(name, carrier, place, gap, span, self._sizes)
        return parts

    def _make_key(self, name: str, carrier: Carrier, place: complex, plane: int) -> Part:
        bodies = (Prism(Region(make_key_section(place, self._sizes.pin, self._key)), *self._get_level(plane)),)
        designation = self._key.standard and f"{self._key.standard} x {self._sizes.thickness:g}"
        return Part(
            f"key_{name}_{plane}", compose("parts-key"), "key", carrier, bodies, 1.0 + 0.0j, (plane, plane),
            name_material(MATERIALS[self._sizes.process][1]), FASTENER_COLOUR, designation,
        )  # fmt: skip


def _estimate_distance(place: complex, outline: Outline) -> float:
    """Estimate the distance of a point from an outline that does not contain it."""
    if isinstance(outline, Disc):
        return abs(place - outline.centre) - outline.radius
    assert isinstance(outline, Loop)
    least = math.inf
    for start, end, _ in outline.iterate_edges():
        along = end - start
        # Foot of the perpendicular, limited to the edge.
        share = min(max(((place - start) * along.conjugate()).real / abs(along) ** 2, 0.0), 1.0)
        least = min(least, abs(place - start - share * along))
    return least


def _find_longest_direction(points: Sequence[complex]) -> complex:
    """Return the direction of the largest distance between points."""
    away = max((b - a for a, b in combinations(points, 2)), key=abs, default=1.0 + 0.0j)
    return away / abs(away) if abs(away) > 0.0 else 1.0 + 0.0j
