"""Clearances of a finished spherical drive, measured in space between the wheel's edges and the cap of the crank.

The crank's axis is x, the wheel's z; in the middle of an index the roller is above x, at the angle of its cone.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.indexing.design import SphericalGenevaMechanism
from synthesis.kinds.indexing.polygons import measure_play

MOVING_POSITIONS, RESTING_POSITIONS, POINTS_PER_EDGE = 173, 61, 97
"""Number of positions of an index and of a rest, and of points of each edge of the wheel."""

PASSING_POSITIONS = 721
"""Number of positions of a rest at which the distance of the roller from the wheel is measured."""

TRIAL_ANGLE = 0.005
"""Angle, radians, by which a resting wheel is turned beyond its play to test whether the cap holds it."""


def measure_on_sphere(mechanism: SphericalGenevaMechanism) -> dict[str, float]:
    """Measure the quantities of :class:`synthesis.kinds.indexing.clearance.MeasuredDrive`, by name."""
    radius, cone = mechanism.sphere_radius, math.radians(mechanism.cone_angle)
    half_slot, step = 0.5 * mechanism.slot_width, math.pi / mechanism.stations
    edges = _list_edges(mechanism)
    alpha = np.linspace(-0.5 * math.pi, 0.5 * math.pi, MOVING_POSITIONS)
    roller = np.stack(
        [np.full(MOVING_POSITIONS, math.cos(cone)), math.sin(cone) * np.sin(alpha), math.sin(cone) * np.cos(alpha)], -1
    )
    # The slot follows the roller: its azimuth about the wheel's axis.
    turn = np.arctan2(roller[:, 1], roller[:, 0])
    rest = np.linspace(0.5 * math.pi, 1.5 * math.pi, RESTING_POSITIONS)
    still = np.full(RESTING_POSITIONS, turn[-1])
    cap = math.radians(mechanism.cap_angle)
    offset = mechanism.cap_offset / radius

    def measure_depth(crank: Real, wheel: Real) -> Real:
        return _measure_depth(edges, crank, wheel, cap, offset)

    middle = float(rest[RESTING_POSITIONS // 2])
    play = measure_play(lambda by: measure_depth(np.full_like(by, middle), still[0] + by), step)
    tried = TRIAL_ANGLE + play
    held = (measure_depth(rest, still + tried) > 0.0) & (measure_depth(rest, still - tried) > 0.0)
    apart = max(float(measure_depth(alpha, turn).max()), float(measure_depth(rest, still).max()), 0.0)
    locked = float(held.mean())
    end = math.radians(mechanism.slot_end_angle)
    # The roller is a cylinder about a radius: it runs in the middle of the slot, and stops before its end.
    above = radius * math.tan(end - float(np.arcsin(roller[:, 2]).max())) + half_slot
    middles = radius * np.array([[math.cos(end) * math.cos(k), math.cos(end) * math.sin(k)] for k in (0.0, 2.0 * step)])
    hollows = radius * _draw_hollow(mechanism, 0)
    rim = np.linspace(0.0, 2.0 * math.pi, POINTS_PER_EDGE)
    seen = np.hypot(mechanism.profile.x, mechanism.profile.y)
    floor = radius * math.cos(end) - half_slot * math.sin(end) * np.cos(rim)
    return {
        "roller": min(half_slot, above),
        "passing": _measure_passing(mechanism, float(turn[-1])),
        "overlap": apart * radius,
        "locked": locked,
        "play": math.degrees(play),
        "locked_angle": locked * 180.0,
        "wall": float(np.abs(hollows[:, 1]).min()) - half_slot,
        "web": float(np.hypot(*(middles[1] - middles[0]))) - 2.0 * half_slot,
        "inmost": min(float(np.hypot(floor, half_slot * np.sin(rim)).min()), float(seen.min())),
        "outmost": float(seen.max()),
        "neck": 0.0,
        "size": 2.0 * radius,
    }


def _measure_passing(mechanism: SphericalGenevaMechanism, wheel: float) -> float:
    """Return the minimum distance of the roller's axis from the resting wheel, up to the roller's diameter.

    The roller is a cylinder about a radius that goes below the plane of the rim. Edges are seen along its axis.
    """
    radius, cone = mechanism.sphere_radius, math.radians(mechanism.cone_angle)
    alpha = np.linspace(0.5 * math.pi, 1.5 * math.pi, PASSING_POSITIONS)
    # The wheel is above the plane of its rim: a roller lower than its own diameter is near nothing.
    alpha = alpha[-radius * math.sin(cone) * np.cos(alpha) < mechanism.roller_diameter]
    axis = np.stack(
        [np.full(len(alpha), math.cos(cone)), math.sin(cone) * np.sin(alpha), math.sin(cone) * np.cos(alpha)], -1
    )
    up = np.stack(
        [-math.sin(cone) * np.ones(len(alpha)), math.cos(cone) * np.sin(alpha), math.cos(cone) * np.cos(alpha)], -1
    )
    beside = np.cross(axis, up)
    least = mechanism.roller_diameter
    # The slots that the roller leaves and reaches lie on the two sides of one hollow.
    for line in _list_lines(mechanism, (0, -1, 1)):
        x = line[:, 0] * math.cos(wheel) - line[:, 1] * math.sin(wheel)
        y = line[:, 0] * math.sin(wheel) + line[:, 1] * math.cos(wheel)
        places = radius * np.stack([x, y, line[:, 2]])
        # Points on the other half of the sphere are behind the roller, not next to it.
        before = axis @ places > 0.0
        least = min(least, _find_nearest(up @ places + 1j * (beside @ places), before[:, 1:] & before[:, :-1]))
    return least


def _find_nearest(lines: NDArray[np.complex128], counted: NDArray[np.bool_]) -> float:
    """Return the minimum distance of the origin from polylines, shape (m, n), of which only some pieces count."""
    start, piece = lines[:, :-1], np.diff(lines, axis=1)
    length = np.abs(piece) ** 2
    along = np.clip((-start * piece.conj()).real / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    return float(np.abs(start + along * piece)[counted].min(initial=math.inf))


def _draw_hollow(mechanism: SphericalGenevaMechanism, station: int) -> Real:
    """Return the edge of the hollow after a slot as unit vectors above the rim in the wheel's frame, shape (n, 3)."""
    angle = math.radians(mechanism.locking_arc_angle)
    around = np.linspace(0.0, math.pi, POINTS_PER_EDGE)
    axis = math.pi * (2 * station + 1) / mechanism.stations
    x, y, z = math.cos(angle), math.sin(angle) * np.cos(around), math.sin(angle) * np.sin(around)
    turned = [x * math.cos(axis) - y * math.sin(axis), x * math.sin(axis) + y * math.cos(axis), z]
    return np.stack(turned, -1)


def _list_edges(mechanism: SphericalGenevaMechanism) -> Real:
    """Return points of the wheel's edges on the sphere: hollows, the sides of slots, the rim between; unit vectors."""
    return np.concatenate(_list_lines(mechanism, range(mechanism.stations)))


def _list_lines(mechanism: SphericalGenevaMechanism, stations: Iterable[int]) -> list[Real]:
    """List the edges at some slots, each in its order."""
    half_slot = 0.5 * mechanism.slot_width / mechanism.sphere_radius
    up = np.linspace(0.0, math.radians(mechanism.slot_end_angle), POINTS_PER_EDGE)
    listed = []
    step, hollow = math.pi / mechanism.stations, math.radians(mechanism.locking_arc_angle)
    for k in stations:
        listed.append(_draw_hollow(mechanism, k))
        for side in (-1.0, 1.0):
            x, y = np.sqrt(np.maximum(np.cos(up) ** 2 - half_slot**2, 0.0)), np.full(POINTS_PER_EDGE, side * half_slot)
            rim = side * np.linspace(math.asin(half_slot), step - hollow, POINTS_PER_EDGE)
            at = 2.0 * step * k
            across, along = x * math.sin(at) + y * math.cos(at), x * math.cos(at) - y * math.sin(at)
            listed.append(np.stack([along, across, np.sin(up)], -1))
            listed.append(np.stack([np.cos(rim + at), np.sin(rim + at), np.zeros(POINTS_PER_EDGE)], -1))
    return listed


def _measure_depth(edges: Real, crank: Real, wheel: Real, cap: float, offset: float) -> Real:
    """Return the maximum depth, radians, of the wheel's edges in the cap at each position; negative if separate."""
    cosine, sine = np.cos(wheel)[:, None], np.sin(wheel)[:, None]
    x, y = cosine * edges[:, 0] - sine * edges[:, 1], sine * edges[:, 0] + cosine * edges[:, 1]
    from_axis = np.arccos(np.clip(x, -1.0, 1.0))
    # The roller is at (sin α, cos α) of (y, z); the cap is on the other side, beyond its plane.
    towards = np.sin(crank)[:, None] * y + np.cos(crank)[:, None] * edges[:, 2]
    return np.asarray(np.minimum(cap - from_axis, -towards - offset).max(axis=1))
