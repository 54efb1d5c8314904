"""The groove of a barrel cam as a solid: the envelope of the roller, at every radius of the barrel.

In the barrel's frame the roller's axis is a radius at the angle ψ and the height s(ψ) along the barrel's axis. A point
of the roller at the distance ρ along its axis, in the direction β about it, moves relative to the barrel by ρ e_ψ + s′
e_y per radian. If that is tangent to its surface, cos β ρ + sin β s′ = 0, the point touches the wall:

    p(ψ, ρ) = ρ e_r + s e_y ± g (−s′ e_ψ + ρ e_y) / √(ρ² + s′²),

where g is the radius of the roller with its clearance. The distance of such a point from the barrel's axis is
√(ρ² + g² s′²/(ρ² + s′²)), which determines the ρ at which a wall meets a cylinder about the axis.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from service.parts.geometry.solids import Mesh

MIN_COLUMNS, MAX_COLUMNS = 180, 1440
"""Minimum and maximum number of places around the barrel at which the groove is sampled."""

WALL_STEPS = 2
"""Number of facets of a wall from the floor to the barrel's surface, and of each half of the floor."""

FULL_TURN = 2.0 * np.pi


class Wall(NamedTuple):
    """Intersection of a wall with a cylinder: angles about the axis, and heights along it."""

    angle: Real
    height: Real


@dataclass(frozen=True)
class Groove:
    """A groove around a barrel.

    Attributes
    ----------
    course : callable
        s and ds/dψ at angles ψ of the barrel's frame, millimetres.
    half : float
        Radius of the roller with its clearance.
    floor, surface : float
        Radii of the groove's floor and of the barrel.
    """

    course: Callable[[Real], tuple[Real, Real]]
    half: float
    floor: float
    surface: float

    def compute_wall(self, at: Real, radius: float, side: int) -> Wall:
        """Compute the upper (1) or lower (−1) wall on a cylinder of a radius about the axis."""
        s, v = self.course(at)
        whole = radius**2
        # Positive root of the quadratic equation for ρ².
        square = 0.5 * (whole - v**2 + np.sqrt((whole + v**2) ** 2 - 4.0 * (self.half * v) ** 2))
        rho, length = np.sqrt(square), np.sqrt(square + v**2)
        return Wall(at + np.arctan2(-side * self.half * v / length, rho), s + side * self.half * rho / length)

    def is_sound(self, columns: int = MAX_COLUMNS) -> bool:
        """Return whether the roller cuts away no part of a wall elsewhere: the walls' angles increase monotonically."""
        at = np.linspace(0.0, FULL_TURN, columns, endpoint=False)
        walls = (self.compute_wall(at, radius, side) for radius in (self.floor, self.surface) for side in (-1, 1))
        return all(bool((np.diff(wall.angle, append=wall.angle[0] + FULL_TURN) > 0.0).all()) for wall in walls)

    def choose_columns(self, off: float) -> int:
        """Return the number of places around the barrel for chords of both walls that deviate by at most ``off``."""
        count = MIN_COLUMNS
        while count < MAX_COLUMNS:
            at = np.linspace(0.0, FULL_TURN, 2 * count + 1)
            sags = []
            for side in (-1, 1):
                wall = self.compute_wall(at, self.surface, side)
                places = self.surface * np.exp(1j * wall.angle)
                ends = 0.5 * (places[:-1:2] + places[2::2]), 0.5 * (wall.height[:-1:2] + wall.height[2::2])
                sags.append(np.hypot(np.abs(places[1::2] - ends[0]), wall.height[1::2] - ends[1]).max())
            if max(sags) <= off:
                break
            count *= 2
        return count

    def make_barrel(self, low: float, high: float, bore: NDArray[np.complex128], off: float) -> Mesh:
        """Make the barrel from one height to another, with its bore.

        Parameters
        ----------
        bore : complex array
            Corners of the bore, counter-clockwise and star-shaped about the axis.
        off : float
            Maximum distance of chords from the groove.
        """
        at = np.linspace(0.0, FULL_TURN, self.choose_columns(off), endpoint=False)
        radii = np.linspace(self.floor, self.surface, WALL_STEPS + 1)
        lower = [self.compute_wall(at, radius, -1) for radius in radii[::-1]]
        upper = [self.compute_wall(at, radius, 1) for radius in radii]
        across = [
            Wall(*(a + share * (b - a) for a, b in zip(lower[-1], upper[0], strict=True)))
            for share in np.linspace(0.0, 1.0, 2 * WALL_STEPS + 1)[1:-1]
        ]
        lines = [(radius, wall) for radius, wall in zip(radii[::-1], lower, strict=True)]
        lines += [(self.floor, wall) for wall in across]
        lines += [(radius, wall) for radius, wall in zip(radii, upper, strict=True)]
        ends = (self.surface, Wall(lower[0].angle, np.full(len(at), low))), (
            self.surface, Wall(upper[-1].angle, np.full(len(at), high)),
        )  # fmt: skip
        rings = [_place_wall(radius, wall) for radius, wall in (ends[0], *lines, ends[1])]
        holes = [np.column_stack([bore.real, bore.imag, np.full(len(bore), z)]) for z in (high, low)]
        around = [*rings, *holes]
        # Index of each line's first corner in the mesh.
        starts = np.cumsum([0, *(len(line) for line in around)])
        triangles = []
        for one in range(len(around)):
            # Consecutive lines close the surface from the bore around the groove and back.
            other = (one + 1) % len(around)
            triangles.append(_strip(around[one], around[other], int(starts[one]), int(starts[other])))
        return Mesh(np.concatenate(around), np.concatenate(triangles))


def _place_wall(radius: float, wall: Wall) -> Real:
    return np.column_stack([radius * np.cos(wall.angle), radius * np.sin(wall.angle), wall.height])


def _strip(one: Real, other: Real, first: int, second: int) -> NDArray[np.int64]:
    """Return triangles that join two closed lines around the axis, whose corners are in the order of their angles."""
    if len(one) == len(other):
        k = np.arange(len(one))
        ahead = (k + 1) % len(one)
        a, b, c, d = first + k, first + ahead, second + ahead, second + k
        return np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    angles = [np.unwrap(np.arctan2(line[:, 1], line[:, 0])) for line in (one, other)]
    # Both start at the corner with the smallest angle.
    begin = [int(np.argmin(np.mod(each, FULL_TURN))) for each in angles]
    turned = [np.mod(np.roll(each, -k), FULL_TURN) for each, k in zip(angles, begin, strict=True)]
    i = j = 0
    n, m = len(one), len(other)
    found = []
    while i < n or j < m:
        here, there = first + (begin[0] + i) % n, second + (begin[1] + j) % m
        ahead_one = turned[0][i + 1] if i + 1 < n else FULL_TURN + turned[0][0] if i < n else np.inf
        ahead_other = turned[1][j + 1] if j + 1 < m else FULL_TURN + turned[1][0] if j < m else np.inf
        # Advance on the line whose next corner has the smaller angle.
        if ahead_one <= ahead_other:
            found.append((here, first + (begin[0] + i + 1) % n, there))
            i += 1
        else:
            found.append((here, second + (begin[1] + j + 1) % m, there))
            j += 1
    return np.array(found)
