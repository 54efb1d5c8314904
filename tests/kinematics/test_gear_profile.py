"""Outlines of gears: against a rack rolled along in small steps, against a mate, against unwound strings."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from kinematics.errors import DimensionError
from kinematics.gear.helical import HelicalGear
from kinematics.gear.profile import draw_half_space, draw_outline
from kinematics.gear.teeth import Gear, Mesh, compute_corner_rounding

GEARS = [
    Gear(30, 2.0),
    Gear(12, 1.0),
    Gear(8, 1.0),
    Gear(14, 1.0, math.radians(25.0)),
    Gear(10, 1.0, shift=0.45),
    Gear(90, 1.0),
]


@pytest.mark.parametrize("gear", GEARS, ids=lambda g: f"{g.teeth}")
def test_outline_is_what_a_rack_leaves(gear: Gear) -> None:
    """No point of the outline is ever inside the rack's tooth, and every point below the tip is touched by it."""
    phi, m = gear.pressure_angle, gear.module
    points = draw_half_space(gear)
    points = points[np.abs(points) < _tip_of(points) - 1e-9]
    least = np.full(points.shape, np.inf)
    reach = 4.0 * m / math.tan(phi) + 2.0 * m
    for moved in np.linspace(-reach, reach, 4001):
        rack = points * np.exp(1j * moved / gear.pitch_radius) - 1j * moved
        depth = gear.pitch_radius - rack.real
        # Both flanks of the rack's tooth and its tip line; the rounded corner lies inside of them.
        from_axis = np.abs(rack.imag)
        flank = (from_axis - 0.25 * math.pi * m) * math.cos(phi) + (depth + gear.shift * m) * math.sin(phi)
        tip = depth - m * (gear.dedendum - gear.shift)
        distance = _rounded(gear, from_axis, depth + gear.shift * m, flank, tip)
        least = np.minimum(least, distance)
    assert least.min() > -1e-5 * m
    # A step of the rack is about 0.002 modules: touching means within its square.
    assert least.max() < 2e-3 * m


def _tip_of(points: np.ndarray) -> float:
    return float(np.abs(points).max())


def _rounded(gear: Gear, side: np.ndarray, depth: np.ndarray, flank: np.ndarray, tip: np.ndarray) -> np.ndarray:
    """Distance from the rack's tooth with its rounded corner, negative inside; ``depth`` from the rack's own line."""
    phi, m = gear.pressure_angle, gear.module
    wide = 0.25 * math.pi - gear.dedendum * math.tan(phi)
    radius = m * min(0.38, wide * math.cos(phi) / (1.0 - math.sin(phi)))
    centre_depth = m * gear.dedendum - radius
    centre_side = 0.25 * math.pi * m - centre_depth * math.tan(phi) - radius / math.cos(phi)
    from_centre = np.hypot(side - centre_side, depth - centre_depth)
    angle = np.arctan2(side - centre_side, depth - centre_depth)
    corner = (angle > 0.0) & (angle < 0.5 * math.pi - phi)
    return np.where(corner, from_centre - radius, np.maximum(flank, tip))


@pytest.mark.parametrize(("pinion", "gear"), [(20, 40), (18, 19), (25, 90)])
def test_two_outlines_touch_and_do_not_overlap(pinion: int, gear: int) -> None:
    mesh = Mesh(Gear(pinion, 1.0), Gear(gear, 1.0))
    first = draw_outline(mesh.pinion, 0.0)
    second = draw_outline(mesh.gear, math.pi + math.pi / gear)
    for turned in np.linspace(0.0, 2.0 * math.pi / pinion, 7):
        driver = first * np.exp(1j * turned)
        driven = second * np.exp(-1j * turned * pinion / gear) + mesh.centre_distance
        near = driver[(driver.real > mesh.pinion.root_radius - 1.0) & (np.abs(driver.imag) < 4.0)]
        gap = min(_signed_distance(point, driven, mesh.centre_distance) for point in near)
        assert -2e-3 < gap < 2e-3


def _signed_distance(point: complex, closed: np.ndarray, centre: complex) -> float:
    """Distance from a polygon, negative inside; by crossings of a ray and the nearest edge."""
    near = np.abs(closed - point) < 1.5
    ends = np.roll(closed, -1)
    start, end = closed[near], ends[near]
    if not len(start):
        return math.inf
    along = np.clip(((point - start) / (end - start)).real, 0.0, 1.0)
    distance = float(np.abs(start + along * (end - start) - point).min())
    turn = np.angle((ends - point) / (closed - point))
    return -distance if abs(turn.sum()) > math.pi else distance


def test_flanks_are_unwound_strings() -> None:
    gear = Gear(40, 1.5, shift=0.2)
    points = draw_half_space(gear)
    flank = points[(np.abs(points) > 29.0) & (np.abs(points) < gear.tip_radius * (1.0 - 1e-12))]
    roll = np.sqrt((np.abs(flank) / gear.base_radius) ** 2 - 1.0)
    unwound = gear.base_radius * (1.0 - 1j * roll) * np.exp(1j * roll)
    assert np.ptp(np.angle(flank / unwound)) < 1e-12


def test_outline_closes_once_round() -> None:
    closed = draw_outline(Gear(17, 1.0), 0.3)
    steps = np.angle(np.roll(closed, -1) / closed)
    assert steps.sum() == pytest.approx(2.0 * math.pi)
    assert (steps > -0.02).all()
    tips = np.abs(closed) > 9.5 - 1e-9
    assert np.angle(closed[tips] * np.exp(-0.3j) * 1.0).min() < 0.0


def test_internal_outline_fits_round_the_pinion() -> None:
    mesh = Mesh(Gear(30, 1.0), Gear(60, 1.0, addendum=0.8, internal=True))
    # With the full addendum the ring's tips would reach below the involute that a rack leaves on the pinion.
    ring = draw_outline(mesh.gear, math.pi / 60)
    pinion = draw_outline(mesh.pinion, 0.0) + mesh.centre_distance
    near = pinion[pinion.real > mesh.gear.tip_radius - 0.5]
    gaps = [-_signed_distance(point, ring, 0.0) for point in near]
    assert -2e-3 < min(gaps) < 2e-3


def test_a_pointed_tooth_ends_where_its_flanks_meet() -> None:
    gear = Gear(10, 1.0, shift=1.2)
    assert gear.is_pointed
    tip = draw_half_space(gear)[-1]
    assert abs(tip) < gear.tip_radius
    assert np.angle(tip) == pytest.approx(math.pi / 10)


def test_a_rack_that_comes_to_a_point_is_refused() -> None:
    with pytest.raises(DimensionError):
        draw_half_space(Gear(20, 1.0, math.radians(34.0)))


@pytest.mark.parametrize("helix", [0.0, 15.0, 30.0, -42.0])
@pytest.mark.parametrize(("teeth", "shift"), [(8, 0.0), (20, 0.0), (20, 0.4), (41, -0.3)])
def test_a_rack_that_rolls_past_touches_the_outline_and_cuts_nothing_of_it(
    teeth: int, shift: float, helix: float
) -> None:
    """The rack of the normal plane, stretched into the plane of rotation: no point of flank or fillet is ever inside
    its tooth, and every one is once on its edge. Nothing of the formula of the trochoid is used."""
    beta = math.radians(helix)
    plain = HelicalGear(teeth, 1.0, beta).transverse_gear
    gear = replace(plain, shift=shift * math.cos(beta))
    points = draw_half_space(gear, beta)
    radii = np.abs(points)
    inside = (radii > gear.root_radius * (1 + 1e-9)) & (radii < gear.tip_radius * (1 - 1e-9))
    points = points[inside]
    phi, depth, stretch = math.radians(20.0), 1.25 - shift, 1.0 / math.cos(beta)
    rounding = compute_corner_rounding(phi, 1.25)
    centre = depth - rounding
    half_tip = 0.25 * math.pi - 1.25 * math.tan(phi) + rounding * (math.tan(phi) - 1.0 / math.cos(phi))

    def overlap(rolled: np.ndarray) -> np.ndarray:
        """How far points lie within the rack's tooth when it has rolled so far: half its width less their distance."""
        turned = points[:, None] * np.exp(1j * rolled / gear.pitch_radius)
        below = gear.pitch_radius - turned.real
        beside = np.abs(turned.imag - rolled)
        straight = 0.25 * math.pi - (below + shift) * math.tan(phi)
        corner = half_tip + np.sqrt(np.maximum(rounding**2 - np.maximum(below - centre, 0.0) ** 2, 0.0))
        wide = np.where(below <= centre + rounding * math.sin(phi), straight, np.where(below < depth, corner, -np.inf))
        return np.asarray(stretch * wide - beside)

    at = np.linspace(-6.0, 6.0, 4001)[None, :]
    deepest = overlap(at)
    best = deepest.argmax(axis=1)
    near = at[0][best][:, None] + np.linspace(-0.003, 0.003, 4001)[None, :]
    most = np.maximum(deepest.max(axis=1), overlap(near).max(axis=1))
    assert np.abs(most).max() < 2e-6
