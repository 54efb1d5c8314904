"""Whether the meshes of an assembly, as its files have them, share room while it moves: boxes first, then manifold3d.

The triangles are those of STL and 3MF files, and every part goes where the motion takes it. Of each pair of parts the
second is moved as the first sees it; places that come again are looked at once, and so are parts that go together. A
round part is the same solid however it has turned about its axis, so that a pin in a hole is looked at once.

What two meshes share is judged by its *layer*, its volume V over its surface S: the rounding of a face that rests on
another is a layer of no thickness, however wide it is. Parts that move against each other have a clearance that is more
than the deflection d of the meshes, or faces at one height: they share nothing but rounding.

Parts that go together or roll on each other may have one surface, whose chords differ in the two meshes. A mesh is
at most d off the surface of its solid. What two of them share whose solids do not overlap is outside of one of the
solids, and so within d of the surface of its mesh: V is at most d S. Where they overlap by a depth t,
V / S is t / 2 of a wide layer and t / 5 of a square corner: an overlap is told from chords where it is a few d deep.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from service.parts.assembly.model import Assembly, Part
from service.parts.export import cad
from service.parts.geometry.regions import Disc
from service.parts.geometry.solids import Prism

if TYPE_CHECKING:
    from manifold3d import Manifold


ROUNDING = 1e-9
"""Share of the assembly's size by which places may differ that are one, and a layer is thick that is none."""


class Shared(NamedTuple):
    """What two meshes share where its layer is the thickest, millimetres, and how thick it may be."""

    parts: tuple[str, str]
    at: float
    layer: float
    bound: float


class Looked(NamedTuple):
    """How many places pairs of parts come to, how many of them were intersected, and what any two share there."""

    stood: int
    tried: int
    shared: list[Shared]

    @property
    def overlaps(self) -> list[Shared]:
        """What is more than chords and rounding."""
        return [one for one in self.shared if one.layer > one.bound]


def meshed(solids: Sequence[Any]) -> list[Manifold]:
    """The meshes of solids as they are exported, each of them closed."""
    from manifold3d import Error, Manifold, Mesh64

    made = []
    for solid in solids:
        corners, triangles = cad.triangulate(solid)
        mesh = Manifold(Mesh64(np.ascontiguousarray(corners), np.ascontiguousarray(triangles, np.uint64)))
        assert mesh.status() == Error.NoError, (solid.label, mesh.status())
        assert mesh.volume() > 0.0, solid.label
        made.append(mesh)
    return made


def places(whole: Assembly, part: Part, inputs: Real) -> Real:
    """Where the motion takes a part from the reference configuration, shape (n, 4, 4)."""
    at = whole.motion.compute_placement(part.carrier, whole.motion.compute_state(inputs))
    plane = np.zeros((len(inputs), 4, 4))
    plane[:, 0, 0] = plane[:, 1, 1] = at.turn.real
    plane[:, 1, 0], plane[:, 0, 1] = at.turn.imag, -at.turn.imag
    plane[:, 0, 3], plane[:, 1, 3] = at.shift.real, at.shift.imag
    plane[:, 2, 2] = plane[:, 3, 3] = 1.0
    if at.frame is None:
        return plane
    standing = np.zeros((len(inputs), 4, 4))
    standing[:, :3, :3], standing[:, :3, 3], standing[:, 3, 3] = at.frame.axes, at.frame.origin, 1.0
    return standing @ plane


def looked_through(whole: Assembly, meshes: Sequence[Manifold], inputs: Real) -> Looked:
    """All pairs of parts at all inputs."""
    moved = [places(whole, part, inputs) for part in whole.parts]
    boxes = [_box(mesh) for mesh in meshes]
    tried = stood = 0
    found: list[Shared] = []
    for (n, one), (m, other) in combinations(enumerate(whole.parts), 2):
        towards = np.linalg.inv(moved[n]) @ moved[m]
        rounding = ROUNDING * whole.size
        apart = len(_different(towards, rounding))
        together = apart == 1
        stood += apart
        towards = _unturned(one, other, towards)
        different = _different(towards, rounding)
        one_surface = together or frozenset((one.name, other.name)) in whole.touching
        worst: Shared | None = None
        for k in different[_near(boxes[n], boxes[m], towards[different])]:
            second = meshes[m].transform(np.ascontiguousarray(towards[k, :3]))
            if not _meet(boxes[n], _box(second)):
                continue
            back = np.ascontiguousarray(np.linalg.inv(towards[k])[:3])
            if not _meet(_box(meshes[n].transform(back)), boxes[m]):
                continue
            tried += 1
            common = meshes[n] ^ second
            if (volume := common.volume()) > 0.0:
                layer = volume / common.surface_area()
                if worst is None or layer > worst.layer:
                    bound = cad.DEFLECTION if one_surface else rounding
                    worst = Shared((one.name, other.name), float(inputs[k]), layer, bound)
        if worst is not None:
            found.append(worst)
    return Looked(stood, tried, found)


def _unturned(one: Part, other: Part, towards: Real) -> Real:
    """Places of the second part as the first sees it, turned back about the axis of either, if that is round."""
    before, after = _axis(other), _axis(one)
    axis = after if before is None else before
    level = (np.abs(towards[:, 2, :3] - np.eye(3)[2]) < ROUNDING).all()
    if axis is None or not level:
        return towards
    turn = towards[:, 0, 0] + 1j * towards[:, 1, 0]
    shift = towards[:, 0, 3] + 1j * towards[:, 1, 3]
    # A turn back about the axis comes before z -> turn z + shift, or after it.
    shift = axis + (shift - axis) / turn if before is None else shift + turn * axis - axis
    back = np.tile(np.eye(4), (len(towards), 1, 1))
    back[:, 0, 3], back[:, 1, 3], back[:, 2, 3] = shift.real, shift.imag, towards[:, 2, 3]
    return back


def _axis(part: Part) -> complex | None:
    """The axis of a part that consists of discs and rings about it."""
    if not all(isinstance(body, Prism) for body in part.bodies):
        return None
    outlines = [outline for body in part.bodies for outline in (body.region.outer, *body.region.holes)]
    centres = {outline.centre if isinstance(outline, Disc) else None for outline in outlines}
    return centres.pop() if len(centres) == 1 else None


def _different(towards: Real, rounding: float) -> Real:
    """The first of each of the places that differ."""
    _, first = np.unique(np.round(towards[:, :3] / rounding), axis=0, return_index=True)
    return first


def _near(one: Real, other: Real, towards: Real) -> NDArray[np.bool_]:
    """Return at which places the box of the first meets the one about the box of the second where it is moved to."""
    middles = towards[:, :3, :3] @ other.mean(axis=0) + towards[:, :3, 3]
    halves = np.abs(towards[:, :3, :3]) @ (0.5 * (other[1] - other[0]))
    return ((middles - halves < one[1]) & (one[0] < middles + halves)).all(axis=1)


def _box(mesh: Manifold) -> Real:
    """Its least and greatest coordinates, shape (2, 3)."""
    return np.array(mesh.bounding_box()).reshape(2, 3)


def _meet(one: Real, other: Real) -> bool:
    return bool(((other[0] < one[1]) & (one[0] < other[1])).all())
