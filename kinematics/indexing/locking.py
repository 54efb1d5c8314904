"""Locking disc of a plane Geneva drive: an arc that fills the wheel's locking arcs, and the relief next to it.

While the wheel turns, its horns sweep over the disc. In the crank's frame the disc may fill, in each direction from the
crank's axis, the region that no position of the wheel reaches during the index. Rays are intersected with the exact
circles and lines of the wheel (:mod:`kinematics.indexing.wheel`), not with a polygon.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Mask, Real
from kinematics.indexing.geneva import Geneva
from kinematics.indexing.wheel import Wheel

POSITION_COUNT, RAY_COUNT = 121, 181
"""Number of positions of the index, and of directions over half a turn, at which distances are computed."""

CORNER_POSITION_COUNT = 4001
"""Number of positions for the corners of slots and arcs, which may pass between two rays."""

INWARD_OFFSET = 1e-9
"""Offset from an intersection, as a share of the center distance, at which a ray is tested for material."""

RAY_TOLERANCE = 1e-9
"""Radians below which two rays coincide."""

EDGE_ANGLE = 1e-6
"""Radians between the end of the locking arc and the beginning of its relief."""


def is_material(wheel: Wheel, points: Complex) -> Mask:
    """Return whether points in the wheel's frame lie in its material; a ring is taken as unbounded outside."""
    far = np.abs(points)
    body = far > wheel.reach if wheel.internal else far < wheel.reach
    # One slot and one locking arc represent all, by symmetry.
    slot = _fold_into_sector(points, wheel.step, 0.0)
    beyond = slot.real < wheel.slot_end if wheel.internal else slot.real > wheel.slot_end
    in_slot = (np.abs(slot.imag) < wheel.half_slot) & beyond | (np.abs(slot - wheel.slot_end) < wheel.half_slot)
    lock = _fold_into_sector(points, wheel.step, wheel.step)
    return np.asarray(body & ~in_slot & (np.abs(lock - wheel.center_distance) > wheel.lock))


def _fold_into_sector(points: Complex, step: float, axis: float) -> Complex:
    """Fold points into the sector around ``axis`` by the wheel's rotational symmetry, and rotate that sector to x."""
    turned = np.round((np.angle(points) - axis) / (2.0 * step)) * 2.0 * step + axis
    return np.asarray(points * np.exp(-1j * turned))


def sweep_rays(wheel: Wheel, drive: Geneva, directions: Real) -> tuple[Real, Real]:
    """Sweep the wheel over an index along rays from the crank's axis, within the circle of its locking arcs.

    Parameters
    ----------
    wheel : Wheel
    drive : Geneva
        The drive of that wheel, with one roller.
    directions : float, shape (k,)
        Radians in the crank's frame, counter-clockwise from the roller as seen with the crank turning that way.

    Returns
    -------
    nearest, farthest : float, shape (k,)
        Minimum and maximum distance of the wheel's material; the radius of the locking arcs and 0 if none of it comes
        closer than that.
    """
    c = wheel.center_distance
    alpha = np.linspace(-drive.half, drive.half, POSITION_COUNT)
    sense = math.copysign(1.0, drive.signed)
    turned = sense * -drive.motion(alpha).s
    # Into the wheel's frame, where the roller's slot is slot 0.
    start = (c * np.exp(-1j * turned))[:, None]
    ray = -sense * np.exp(1j * (directions[None, :] + alpha[:, None] - turned[:, None]))
    nearest, farthest = np.full(ray.shape, wheel.lock), np.zeros(ray.shape)
    within, behind = wheel.lock * (1.0 - INWARD_OFFSET), INWARD_OFFSET * c
    for found in _cut_rays(wheel, start, ray):
        # An intersection starts material if there is some just behind it, and ends it if there is some before it.
        which = np.nonzero((found > 0.0) & (found < within))
        cut, at, along = found[which], start[which[0], 0], ray[which]
        first, last = nearest[which], farthest[which]
        nearest[which] = np.where(is_material(wheel, at + (cut + behind) * along), np.minimum(first, cut), first)
        farthest[which] = np.where(is_material(wheel, at + (cut - behind) * along), np.maximum(last, cut), last)
    # A ray that starts inside the material has distance zero.
    nearest = np.where(is_material(wheel, start + 0.0 * ray), 0.0, nearest)
    farthest = np.where(is_material(wheel, start + within * (1.0 - INWARD_OFFSET) * ray), wheel.lock, farthest)
    return np.asarray(nearest.min(axis=0)), np.asarray(farthest.max(axis=0))


def sweep_corners(wheel: Wheel, drive: Geneva) -> tuple[Real, Real]:
    """Sweep the wheel's corners over an index: directions and distances in the crank's frame near it, (m,) each."""
    land = (wheel.mouth, wheel.step - wheel.lock_half)
    beside = np.array([side * angle + 2.0 * k * wheel.step for k in (-1, 0, 1) for side in (-1, 1) for angle in land])
    alpha = np.linspace(-drive.half, drive.half, CORNER_POSITION_COUNT)[:, None]
    sense = math.copysign(1.0, drive.signed)
    turned = sense * -drive.motion(alpha).s
    corners = wheel.reach * np.exp(1j * (beside + turned))
    seen = ((corners - wheel.center_distance) * -sense * np.exp(-1j * alpha)).ravel()
    # Corners outside the circle of the locking arcs cannot touch the disc.
    near = np.abs(seen) < wheel.lock * (1.0 - INWARD_OFFSET)
    return np.asarray(np.angle(seen[near])), np.asarray(np.abs(seen[near]))


def _find_adjacent_rays(angle: Real, at: Real) -> list[NDArray[np.intp]]:
    """Find the rays before and after given directions; rays ascend around a turn."""
    after = np.searchsorted(angle, np.mod(at, 2.0 * math.pi))
    return [(after - 1) % len(angle), after % len(angle)]


def _cut_rays(wheel: Wheel, start: Complex, ray: Complex) -> list[Real]:
    """Cut rays with the circles and lines of the wheel: distances along the rays, NaN without intersection."""
    found = _cut_circle(start, ray, 0j, wheel.reach)
    # Only the nearest locking arcs and slots can come within the crank's circle.
    for k in (-3, -1, 1, 3):
        found += _cut_circle(start, ray, wheel.center_distance * np.exp(1j * k * wheel.step), wheel.lock)
    for k in (-2, 0, 2):
        back = np.exp(-1j * k * wheel.step)
        at, along = start * back, ray * back
        found += _cut_circle(start, ray, wheel.slot_end / back, wheel.half_slot)
        with np.errstate(divide="ignore", invalid="ignore"):
            found += [(side * wheel.half_slot - at.imag) / along.imag for side in (-1.0, 1.0)]
    return found


def _cut_circle(start: Complex, ray: Complex, center: complex, radius: float) -> list[Real]:
    apart = start - center
    along = (apart * ray.conj()).real
    with np.errstate(invalid="ignore"):
        root = np.sqrt(along * along - np.abs(apart) ** 2 + radius * radius)
    return [-along - root, -along + root]


@dataclass(frozen=True)
class Disc:
    """The locking disc in the crank's frame: between two radii in each direction.

    Attributes
    ----------
    angle : float, shape (k,)
        Directions, ascending, radians from the first roller: over a whole turn for a disc, over its arc for a crescent.
    outer, inner : float, shape (k,)
        Radii in these directions. The inner radius is 0 for a disc about the crank's axis. The horns of an internal
        drive pass that axis and leave a crescent, which is fastened to the arm next to the wheel's plane.
    """

    angle: Real
    outer: Real
    inner: Real


def build_crescent(wheel: Wheel, drive: Geneva, gap: float, relief: float, rays: int = RAY_COUNT) -> Disc:
    """Build the locking disc of an internal drive: the crescent that the wheel's horns leave."""
    angle = np.linspace(drive.half, 2.0 * math.pi - drive.half, rays)
    farthest = sweep_rays(wheel, drive, angle)[1]
    at, distance = sweep_corners(wheel, drive)
    at = np.mod(at, 2.0 * math.pi)
    beside = (at >= angle[0]) & (at <= angle[-1])
    for ray in _find_adjacent_rays(angle, at[beside]):
        np.maximum.at(farthest, ray, distance[beside])
    arc = wheel.lock - gap
    return Disc(angle, np.full(rays, arc), np.minimum(farthest + relief, arc))


def build_disc(wheel: Wheel, drive: Geneva, rollers: int, gap: float, relief: float) -> Disc:
    """Build the locking disc of a drive.

    Parameters
    ----------
    wheel : Wheel
    drive : Geneva
    rollers : int
        Number of rollers; 1 for an internal drive.
    gap : float
        Radial clearance between the disc and the wheel's locking arcs.
    relief : float
        Minimum distance to the wheel outside the locking arc.
    """
    arc = wheel.lock - gap
    if wheel.internal:
        return build_crescent(wheel, drive, gap, relief)
    pitch = 2.0 * math.pi / rollers
    ends = np.array([drive.half, -drive.half])
    # The same rays about every roller.
    evenly = np.linspace(0.0, pitch, math.ceil(2 * RAY_COUNT / rollers), endpoint=False)
    one = np.sort(np.mod(np.concatenate([evenly, ends, ends + np.array([-EDGE_ANGLE, EDGE_ANGLE])]), pitch))
    one = one[np.append(True, np.diff(one) > RAY_TOLERANCE)]
    angle = (one + pitch * np.arange(rollers)[:, None]).ravel()
    outer = np.full(len(angle), arc)
    at, distance = sweep_corners(wheel, drive)
    from_first = sweep_rays(wheel, drive, angle)[0]
    for roller in range(rollers):
        # The rays lie alike about every roller.
        nearest = np.roll(from_first, roller * len(one))
        for ray in _find_adjacent_rays(angle, at + pitch * roller):
            np.minimum.at(nearest, ray, distance)
        # On the arc itself the wheel comes as near as the gap, by design.
        free = np.where(nearest < wheel.lock, nearest - relief, arc)
        outer = np.minimum(outer, np.maximum(free, 0.0))
    return Disc(angle, outer, np.zeros(len(angle)))
