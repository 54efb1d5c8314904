"""How deep tips dig: against polygons cut out of a blank by a rack, and rolled."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
import shapely
from shapely.affinity import affine_transform

from kinematics.gear.cut_space import measure_tip_depth
from kinematics.gear.teeth import Gear, Mesh

ANGLE = math.radians(20.0)


def moved(shape: shapely.Geometry, turn: float, to: complex) -> shapely.Geometry:
    """Turned about the origin, then moved."""
    c, s = math.cos(turn), math.sin(turn)
    return affine_transform(shape, [c, -s, s, c, to.real, to.imag])


def cut_planet(teeth: int) -> shapely.Geometry:
    """A blank of module 1 around the space on the positive real axis, after 500 positions of the rack."""
    r = 0.5 * teeth
    slope, wide = math.tan(ANGLE), 0.25 * math.pi
    tool = shapely.Polygon([(2.0, wide + 2.0 * slope), (-1.25, wide - 1.25 * slope),
                            (-1.25, 1.25 * slope - wide), (2.0, -wide - 2.0 * slope)])  # fmt: skip
    tool = tool.buffer(-0.38).buffer(0.38, quad_segs=64).union(tool.intersection(shapely.box(0.0, -9.0, 9.0, 9.0)))
    turns = np.linspace(-5.0, 5.0, 500) / r
    places = [moved(tool, -turn, (r + 1j * r * turn) * cmath.exp(-1j * turn)) for turn in turns]
    blank = shapely.Point(0.0, 0.0).buffer(r + 1.0, quad_segs=4000).intersection(
        shapely.Polygon([(0.0, 0.0), (2.0 * r, -1.2 * math.pi), (2.0 * r, 1.2 * math.pi)])
    )  # fmt: skip
    return blank.difference(shapely.unary_union(places))


@pytest.mark.parametrize(("planet", "ring", "addendum"), [(18, 54, 0.9), (30, 90, 1.0), (30, 90, 0.914276)])
def test_tips_of_a_ring_against_polygons(planet: int, ring: int, addendum: float) -> None:
    cut, rim = cut_planet(planet), Gear(ring, 1.0, addendum=addendum, internal=True)
    apart, half = 0.5 * (ring - planet), rim.thickness_at(rim.tip_radius) / (2.0 * rim.tip_radius)
    deepest = 0.0
    for turn in np.linspace(-0.5, 0.5, 800) * 10.0 / ring:
        at = (rim.tip_radius * cmath.exp(1j * (turn + half)) - apart) * cmath.exp(-1j * turn * ring / planet)
        corner = shapely.Point(at.real, at.imag)
        if cut.contains(corner):
            deepest = max(deepest, cut.exterior.distance(corner))
    told = measure_tip_depth(Mesh(Gear(planet, 1.0), rim), 20)
    assert told == pytest.approx(deepest, abs=2e-4)
    assert (told > 1e-3) == (addendum > 0.914276 or planet == 18)


@pytest.mark.parametrize(("teeth", "addendum", "depth"), [((200, 260), 0.8, 1.0), ((50, 54), 0.9, 1.0)])
def test_tips_that_foul_or_reach_a_ring_are_found(teeth: tuple[int, int], addendum: float, depth: float) -> None:
    """Planets of many teeth in the fillets of a ring, and of few teeth of difference beside the line of action."""
    mesh = Mesh(Gear(teeth[0], 1.0), Gear(teeth[1], 1.0, addendum=addendum, internal=True))
    assert 1e-5 < measure_tip_depth(mesh, 20) < depth
