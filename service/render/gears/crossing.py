"""Drawings of stages with non-parallel shafts in section: bevel gears, and a worm with its gear.

A bevel stage is cut by the plane of its shafts: the apex is the origin, the driver's shaft points to the left. Its
gears are the bodies between two cone distances, with the taper of full-depth teeth, viewed from the side. A worm is cut
by the middle plane of its gear, which is at the origin with the worm above: there the worm is a rack, whose other side
is offset by half a lead.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from kinematics.gear.bevel import BevelCones
from kinematics.gear.teeth import FULL_DEPTH_ADDENDUM, FULL_DEPTH_DEDENDUM
from kinematics.gear.worm import WormDrive

FACE_SHARE = 1.0 / 3.0
"""Drawn face width of a bevel gear as a share of the cone distance."""

WORM_PITCH_COUNT = 7
"""Drawn length of a worm in axial pitches."""

SHAFT_LENGTH = 1.25
"""Length of a shaft from the apex, in cone distances."""


class Section(NamedTuple):
    """A closed outline, its pitch lines, the axis from end to end, and the place for words."""

    outline: Complex
    pitch_lines: tuple[Complex, ...]
    axis: Complex
    words: complex


def make_bevel_sections(pair: BevelCones) -> tuple[Section, Section]:
    """Return driver and driven gear about the apex."""
    # Directions of both shafts, away from the apex.
    away = -1.0 + 0j, -complex(np.exp(-1j * pair.shaft_angle))
    one, two = (_make_bevel(pair, cone, way) for cone, way in zip(pair.cones, away, strict=True))
    return one, two


def _make_bevel(pair: BevelCones, cone: float, away: complex) -> Section:
    far, near = pair.cone_distance, (1.0 - FACE_SHARE) * pair.cone_distance
    along, up = complex(math.cos(cone), math.sin(cone)), complex(-math.sin(cone), math.cos(cone))
    # Drawn teeth have full depth at the large end.
    tip, root = FULL_DEPTH_ADDENDUM * pair.module, -FULL_DEPTH_DEDENDUM * pair.module
    # All lines of the teeth run towards the apex.
    upper = [near * along + near / far * tip * up, far * along + tip * up, far * along + root * up]
    half = np.array(upper, np.complex128)
    # Mirror the half section in the axis.
    outline = np.concatenate([half, half[::-1].conj()]) * away
    lines = tuple(np.array([0.0, far * side]) * away for side in (along, along.conjugate()))
    return Section(outline, lines, np.array([0.0, SHAFT_LENGTH * far]) * away, far * math.cos(cone) * away)


def make_worm_section(worm: WormDrive, moved: float = 0.0) -> Section:
    """Return the worm about its own middle, its axis along x, its gear below; shifted by ``moved`` along the axis."""
    pitch, phi = math.pi * worm.module, worm.axial_pressure_angle
    radius, half = 0.5 * worm.dimensions.worm_diameter, 0.5 * WORM_PITCH_COUNT * pitch
    below = _make_rack(worm.module, pitch, phi, half, moved)
    other = _make_rack(worm.module, pitch, phi, half, moved + 0.5 * worm.dimensions.lead)
    # The opposite side of a worm is offset by half a lead.
    outline = np.concatenate([below - 1j * radius, (other.conj() + 1j * radius)[::-1]])
    lines = tuple(np.array([-half, half]) + side * 1j * radius for side in (-1.0, 1.0))
    return Section(outline, lines, np.array([-half - pitch, half + pitch], np.complex128), 0j)


def _make_rack(module: float, pitch: float, phi: float, half: float, moved: float) -> Complex:
    """Return a rack from −half to half, teeth downwards, with one tooth centred at ``moved``."""
    tip, root = FULL_DEPTH_ADDENDUM * module, FULL_DEPTH_DEDENDUM * module
    # Half widths of a rack tooth at its tip and at its root.
    thin, wide = 0.25 * pitch - tip * math.tan(phi), 0.25 * pitch + root * math.tan(phi)
    # Start one tooth before the visible range, so that both ends can be interpolated.
    first = math.floor((-half - moved) / pitch) - 1
    corners = [
        complex(moved + k * pitch + x, y)
        for k in range(first, first + WORM_PITCH_COUNT + 4)
        for x, y in ((-wide, root), (-thin, -tip), (thin, -tip), (wide, root))
    ]
    x, y = np.real(corners), np.imag(corners)
    inside = np.abs(x) < half
    ends = np.interp([-half, half], x, y)
    return np.concatenate([[complex(-half, ends[0])], np.array(corners)[inside], [complex(half, ends[1])]])
