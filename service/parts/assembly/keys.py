"""Parallel keys of DIN 6885-1, and bores and shafts with their seats; lengths in millimetres.

A key has width b and height h; its seat in the shaft is t₁ deep, the keyway in the hub t₂.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from service.parts.geometry.regions import Loop


class Key(NamedTuple):
    """Width, height, depths in shaft and hub, and the designation of the key; empty if the table has none."""

    width: float
    height: float
    in_shaft: float
    in_hub: float
    standard: str = ""


KEY_TABLE = (
    (6.0, 2.0, 2.0, 1.2, 1.0),
    (8.0, 3.0, 3.0, 1.8, 1.4),
    (10.0, 4.0, 4.0, 2.5, 1.8),
    (12.0, 5.0, 5.0, 3.0, 2.3),
    (17.0, 6.0, 6.0, 3.5, 2.8),
    (22.0, 8.0, 7.0, 4.0, 3.3),
    (30.0, 10.0, 8.0, 5.0, 3.3),
    (38.0, 12.0, 8.0, 5.0, 3.3),
    (44.0, 14.0, 9.0, 5.5, 3.8),
    (50.0, 16.0, 10.0, 6.0, 4.3),
    (58.0, 18.0, 11.0, 7.0, 4.4),
    (65.0, 20.0, 12.0, 7.5, 4.9),
    (75.0, 22.0, 14.0, 9.0, 5.4),
    (85.0, 25.0, 14.0, 9.0, 5.4),
    (95.0, 28.0, 16.0, 10.0, 6.4),
    (110.0, 32.0, 18.0, 11.0, 7.4),
    (130.0, 36.0, 20.0, 12.0, 8.4),
    (150.0, 40.0, 22.0, 13.0, 9.4),
    (170.0, 45.0, 25.0, 15.0, 10.4),
)
"""DIN 6885-1: the diameter above which the row applies, up to the next row's; b, h, t₁ and t₂."""

MAX_DIAMETER = 200.0
"""Maximum diameter in the table."""

PROPORTIONAL_SIZES = (0.3, 0.3, 0.18, 0.14)
"""b, h, t₁ and t₂ as shares of a diameter outside the table."""


def find_key(diameter: float) -> Key:
    """Return the key of a shaft: the standard one, or one in proportion."""
    # The last row below the diameter applies.
    rows = [row for row in KEY_TABLE if row[0] < diameter <= MAX_DIAMETER]
    if not rows:
        b, h, t1, t2 = (share * diameter for share in PROPORTIONAL_SIZES)
        return Key(b, h, t1, t2)
    _, b, h, t1, t2 = rows[-1]
    return Key(b, h, t1, t2, f"DIN 6885 - {b:g} x {h:g}")


def make_bore(centre: complex, diameter: float, key: Key, clearance: float, towards: complex = 1.0) -> Loop:
    """Return the bore of a hub, with a clearance around shaft and key; the keyway points ``towards``."""
    radius, half = 0.5 * diameter + clearance, 0.5 * key.width + clearance
    far = 0.5 * diameter + key.in_hub + clearance
    a = math.asin(half / radius)
    near = math.sqrt(radius**2 - half**2)
    corners = (far - 1j * half, far + 1j * half, near + 1j * half, near - 1j * half)
    return Loop(tuple(centre + towards * z for z in corners), (0.0, 0.0, math.tan(0.5 * (math.pi - a)), 0.0))


def make_shaft_section(centre: complex, diameter: float, key: Key, towards: complex = 1.0) -> Loop:
    """Return the section of a shaft through the seat of its key."""
    radius, half = 0.5 * diameter, 0.5 * key.width
    a = math.asin(half / radius)
    near, floor = math.sqrt(radius**2 - half**2), radius - key.in_shaft
    corners = (near + 1j * half, near - 1j * half, floor - 1j * half, floor + 1j * half)
    return Loop(tuple(centre + towards * z for z in corners), (math.tan(0.5 * (math.pi - a)), 0.0, 0.0, 0.0))


def make_key_section(centre: complex, diameter: float, key: Key, towards: complex = 1.0) -> Loop:
    """Return the section of a key in its seat, seen along the shaft."""
    half, floor = 0.5 * key.width, 0.5 * diameter - key.in_shaft
    top = floor + key.height
    corners = (floor - 1j * half, top - 1j * half, top + 1j * half, floor + 1j * half)
    return Loop(tuple(centre + towards * z for z in corners), (0.0,) * 4)
