"""Parts of a planar mechanism: plates that lie in planes, and pins that join them.

* The *plate* of a link is the hull of its joints, including the coupler point, widened by half the link width.
* A *pin* is placed at every joint of two or more links; the ground counts as one, so its joints are pivots.
* On a *slide* a block runs in a slot of the link with the line, in the plane of its plate, and turns on a pin at the
  joint. The plate includes the slot, over the travel of the joint along the line, and the pin joins it like the other
  links of the joint. A slide on the ground is a slot in the base.
* A *gear* is a disc of its pitch radius about the pivot of its link: a separate plate, keyed to the link by the shaft.
  Gears with the same sense of rotation have an idler between them, as large as the smaller of the two.
* Coincident joints of one link share a pin, and coincident fixed pivots share a shaft.
* A *divided* link is two plates, one on either side of a base, on the shaft of its fixed pivot.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from kinematics.linkage.clearance import Part
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.mechanism import GROUND, GearPair, Mechanism, TopologyError

GRID_SIZE = 1441
"""Number of inputs at which the ends of slots are searched: spaced by a quarter of a degree over a full turn."""

COINCIDENCE_TOLERANCE = 1e-9
"""Distance, as a share of the mechanism's size, below which joints coincide and share a pin."""


class Division(NamedTuple):
    """A link made of two plates, both keyed to its shaft, which turns in a base between them.

    Attributes
    ----------
    link : str
        The link, which has a fixed pivot of its own.
    pivot : str
        The joint of the shaft.
    lower, upper : frozenset of str
        Joints of each plate, including those of blocks in its slots; the pivot belongs to both.
    inside : frozenset of str
        The other links that lie below that base.
    """

    link: str
    pivot: str
    lower: frozenset[str]
    upper: frozenset[str]
    inside: frozenset[str]


class Piece(NamedTuple):
    """A link, or one of the two plates of a divided one; ``joints`` are its own and those of blocks in its slots."""

    name: str
    link: str
    joints: frozenset[str]


class Plate(NamedTuple):
    """A part that lies in one plane: a link, or a gear that turns with it."""

    name: str
    link: str
    outline: Part


class Pin(NamedTuple):
    """A pin at a joint, or a shaft at a fixed pivot.

    Attributes
    ----------
    joint : str
        Joint of the pin; the first one if several coincide.
    plates : frozenset of int
        The plates that it joins.
    grounded : bool
        Whether the pin stands on the base, either fixed or on a block in a slot.
    outline : Part
        Disc of the pin.
    """

    joint: str
    plates: frozenset[int]
    grounded: bool
    outline: Part

    @property
    def name(self) -> str:
        """Name used in answers."""
        return f"pin {self.joint}"


class GearDisc(NamedTuple):
    """Pitch circle of a gear that couples links; ``joint`` is that of its shaft, None for an idler."""

    joint: str | None
    name: str
    link: str
    centre: complex
    radius: float


class Parts(NamedTuple):
    """Plates and pins; ``meshes`` are the gears that lie in one plane, as numbers of plates."""

    plates: tuple[Plate, ...]
    pins: tuple[Pin, ...]
    meshes: tuple[tuple[int, ...], ...]


def build_parts(
    mechanism: Mechanism,
    link_width: float,
    pin_diameter: float,
    low: float,
    high: float,
    slot_ends: float = 0.0,
    addendum: float = 0.0,
    division: Division | None = None,
) -> Parts:
    """Build the parts of one design.

    Parameters
    ----------
    mechanism : Mechanism
        A single design, of shape ().
    link_width, pin_diameter : float
        Width and diameter in length units; the pin is not wider than the link.
    low, high : float
        Minimum and maximum input of the motion, radians or positions along the input slide; they determine the length
        of slots.
    slot_ends : float
        Length by which a link's slot extends beyond the travel of its joint at either end.
    addendum : float
        Height of gear teeth beyond their pitch circles.
    division : Division, optional
        Division of a link into two plates.

    Raises
    ------
    TopologyError
        For gears on a link that is not pinned to the ground, of the ratio 0, or on one shaft.
    """
    travel = _find_travel(mechanism, low, high)
    # Scale of the tolerance for coincident joints.
    size = max(abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2))
    moving = [link for link in mechanism.links if link != GROUND]
    own = list_pieces(mechanism, division)
    plates = []
    for name, link, joints in own:
        points = [complex(mechanism.joints[joint]) for joint in mechanism.links[link] if joint in joints]
        for slide, ends in zip(mechanism.slides, travel, strict=True):
            if slide.link == link and slide.joint in joints:
                reach = ends[0] - slot_ends, ends[1] + slot_ends
                points += [complex(slide.point) + end * complex(np.exp(1j * slide.angle)) for end in reach]
        plates.append(Plate(name, link, Part(link, _find_hull(points, COINCIDENCE_TOLERANCE * size), 0.5 * link_width)))
    pins = []
    shafts: dict[str, set[int]] = {}
    meshes = []
    for n, gear in enumerate(mechanism.gears):
        number = f" {n + 1}" if len(mechanism.gears) > 1 else ""
        mesh = []
        for joint, name, link, centre, radius in list_gear_discs(mechanism, gear):
            disc = Part(GROUND, np.array([centre]), radius + addendum)
            mesh.append(len(plates))
            if joint is None:
                pins.append(
                    Pin(f"{name}{number}", frozenset(mesh[-1:]), True, disc._replace(radius=0.5 * pin_diameter))
                )
            else:
                shafts.setdefault(joint, set()).add(len(plates))
            plates.append(Plate(f"{name}{number}", link, disc))
        meshes.append(tuple(mesh))
    ground = list_joints(mechanism, GROUND)
    for place in group_joints(mechanism):
        joined = {n for n, piece in enumerate(own) if piece.joints & place}
        joined |= {plate for joint in place for plate in shafts.get(joint, ())}
        grounded = bool(ground & place)
        # A joint of a single plate, such as a coupler point, needs no pin.
        if joined and len(joined) + grounded > 1:
            joint = next(name for name in mechanism.joints if name in place)
            carrier = next(link for link in (GROUND, *moving) if joint in mechanism.links.get(link, ()))
            disc = Part(carrier, np.array([complex(mechanism.joints[joint])]), 0.5 * pin_diameter)
            pins.append(Pin(joint, frozenset(joined), grounded, disc))
    return Parts(tuple(plates), tuple(pins), tuple(meshes))


def _find_travel(mechanism: Mechanism, low: float, high: float) -> list[tuple[float, float]]:
    """Find the minimum and maximum travel of each slide on a grid, refined by a parabola through three neighbours."""
    if not mechanism.slides:
        return []
    motion = drive(mechanism, np.linspace(low, high, GRID_SIZE), order=0)
    return [
        (_find_minimum(motion.slides[name][0]), -_find_minimum(-motion.slides[name][0]))
        for name in mechanism.slide_names
    ]


def _find_minimum(values: Real) -> float:
    """Find the minimum of samples on a grid, refined by a parabola."""
    k = int(np.nanargmin(values))
    if not 0 < k < len(values) - 1:
        return float(values[k])
    before, at, after = values[k - 1 : k + 2]
    # Vertex of the parabola through three equally spaced samples.
    bend = before - 2.0 * at + after
    return float(at - 0.125 * (after - before) ** 2 / bend) if bend > 0.0 else float(at)


def list_joints(mechanism: Mechanism, link: str) -> frozenset[str]:
    """List the joints of a link, and of the blocks in its slots."""
    return frozenset(mechanism.links[link]) | {slide.joint for slide in mechanism.slides if slide.link == link}


def list_pieces(mechanism: Mechanism, division: Division | None = None) -> list[Piece]:
    """List the plates of the moving links: one each, two for a divided link."""
    found = []
    for link in mechanism.links:
        if division is not None and link == division.link:
            found += [
                Piece(name, link, own)
                for name, own in zip(name_halves(link), (division.lower, division.upper), strict=True)
            ]
        elif link != GROUND:
            found.append(Piece(link, link, list_joints(mechanism, link)))
    return found


def name_halves(link: str) -> tuple[str, str]:
    """Return the names of the two plates of a divided link."""
    return f"lower {link}", f"upper {link}"


def group_joints(mechanism: Mechanism) -> list[set[str]]:
    """Group the joints into possible places of pins: coincident joints of one link belong together."""
    near = COINCIDENCE_TOLERANCE * max(
        abs(complex(z) - complex(w)) for z, w in combinations(mechanism.joints.values(), 2)
    )
    found = [{joint} for joint in mechanism.joints]
    for listed in mechanism.links.values():
        for one, other in combinations(listed, 2):
            if abs(complex(mechanism.joints[one]) - complex(mechanism.joints[other])) <= near:
                first, second = (next(place for place in found if joint in place) for joint in (one, other))
                if first is not second:
                    found.remove(second)
                    first |= second
    return found


def list_gear_discs(mechanism: Mechanism, gear: GearPair) -> list[GearDisc]:
    """List the gears that couple two links by a ratio: first, second, and an idler if both turn the same way.

    With radii in the ratio |λ| to 1 the discs touch on the line of the pivots: r + |λ| r = d, or with an idler as large
    as the smaller one between them r + |λ| r + 2 min(r, |λ| r) = d.

    Raises
    ------
    TopologyError
        For a link that is not pinned to the ground, the ratio 0, or one shaft for both.
    """
    first, second, ratio = gear
    pivots = []
    for link in (first, second):
        shared = [joint for joint in mechanism.links[link] if joint in mechanism.links[GROUND]]
        if not shared:
            raise TopologyError("kinematics-gear-without-shaft", link=repr(link))
        pivots.append(shared[0])
    o, q = (complex(mechanism.joints[joint]) for joint in pivots)
    if ratio == 0.0 or o == q:
        raise TopologyError("kinematics-gears-need-ratio-and-shafts", first=repr(first), second=repr(second))
    # Equal sense of rotation requires an idler.
    idled = 2.0 * min(1.0, abs(ratio)) if ratio > 0.0 else 0.0
    unit = abs(q - o) / (1.0 + abs(ratio) + idled)
    found = [
        GearDisc(pivots[0], f"gear of {first}", first, o, abs(ratio) * unit),
        GearDisc(pivots[1], f"gear of {second}", second, q, unit),
    ]
    if idled:
        share = (abs(ratio) + 0.5 * idled) / (1.0 + abs(ratio) + idled)
        found.append(GearDisc(None, "idler", GROUND, o + share * (q - o), 0.5 * idled * unit))
    return found


def _find_hull(points: Sequence[complex], near: float) -> Complex:
    """Find the corners of the convex hull, counter-clockwise (Andrew's monotone chain); one or two if collinear."""
    listed: list[complex] = []
    for point in sorted(points, key=lambda z: (z.real, z.imag)):
        # Nearly coincident points would create degenerate edges.
        if all(abs(point - other) > near for other in listed):
            listed.append(point)
    if len(listed) < 3:
        return np.array(listed)
    along = max((b - a for a, b in combinations(listed, 2)), key=abs)
    off = [((z - listed[0]) * along.conjugate()).imag / abs(along) for z in listed]
    if max(off) - min(off) <= near:
        shares = [(z * along.conjugate()).real for z in listed]
        return np.array([listed[shares.index(min(shares))], listed[shares.index(max(shares))]])
    half: list[list[complex]] = []
    for ordered in (listed, listed[::-1]):
        chain: list[complex] = []
        for z in ordered:
            while len(chain) > 1 and ((chain[-1] - chain[-2]).conjugate() * (z - chain[-2])).imag <= 0.0:
                chain.pop()
            chain.append(z)
        half.append(chain[:-1])
    return np.array(half[0] + half[1])
