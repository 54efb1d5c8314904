"""Standard parts by nominal diameter, in millimetres, and proportional sizes for diameters without a standard.

Plain washers follow ISO 7089 (product grade A), retaining rings DIN 471: for a shaft of diameter d₁ a ring of
thickness s in a groove of diameter d₂ and width m, with n of the shaft left beyond; its ends need a diameter of
d₁ + 2 a.
"""

from __future__ import annotations

import math
from typing import NamedTuple


class Washer(NamedTuple):
    """Outer diameter and thickness of a plain washer."""

    diameter: float
    thickness: float
    standard: str = ""


class RetainingRing(NamedTuple):
    """Thickness, diameter and width of the groove, shaft length beyond it, and diameter that the ring needs."""

    thickness: float
    groove: float
    width: float
    beyond: float
    diameter: float
    standard: str = ""


WASHER_TABLE = {
    3.0: (7.0, 0.5),
    4.0: (9.0, 0.8),
    5.0: (10.0, 1.0),
    6.0: (12.0, 1.6),
    8.0: (16.0, 1.6),
    10.0: (20.0, 2.0),
    12.0: (24.0, 2.5),
    16.0: (30.0, 3.0),
    20.0: (37.0, 3.0),
}
"""ISO 7089: outer diameter and thickness, by bolt diameter."""

RING_TABLE = {
    3.0: (0.4, 2.8, 0.5, 0.3, 1.9),
    4.0: (0.4, 3.8, 0.5, 0.3, 2.2),
    5.0: (0.6, 4.8, 0.7, 0.3, 2.5),
    6.0: (0.7, 5.7, 0.8, 0.5, 2.7),
    8.0: (0.8, 7.6, 0.9, 0.6, 3.2),
    10.0: (1.0, 9.6, 1.1, 0.6, 3.3),
    12.0: (1.0, 11.5, 1.1, 0.8, 3.3),
    16.0: (1.0, 15.2, 1.1, 1.2, 3.7),
    20.0: (1.2, 19.0, 1.3, 1.5, 4.0),
}
"""DIN 471: s, d₂, m, n and a, by shaft diameter."""

PIN_DIAMETERS = (
    0.5,
    0.6,
    0.8,
    1.0,
    1.2,
    1.5,
    2.0,
    2.5,
    3.0,
    4.0,
    5.0,
    6.0,
    8.0,
    10.0,
    12.0,
    16.0,
    20.0,
    25.0,
    30.0,
    40.0,
    50.0,
)
"""Nominal diameters of round bars, ISO 2338 and EN 10278."""

SHEET_THICKNESSES = (
    0.3,
    0.4,
    0.5,
    0.6,
    0.8,
    1.0,
    1.5,
    2.0,
    3.0,
    4.0,
    5.0,
    6.0,
    8.0,
    10.0,
    12.0,
    15.0,
    20.0,
    25.0,
    30.0,
)
"""Commercial thicknesses of sheets, millimetres."""

NOMINAL_TOLERANCE = 1e-6
"""Relative tolerance for matching a nominal diameter: a given length may be converted from another unit."""


def find_nominal(diameter: float, known: tuple[float, ...]) -> float | None:
    """Return the nominal diameter that matches, or None."""
    return next((one for one in known if math.isclose(one, diameter, rel_tol=NOMINAL_TOLERANCE)), None)


def find_washer(diameter: float, widest: float) -> Washer | None:
    """Return the plain washer of a pin, or None if there is none up to the width ``widest``."""
    size = find_nominal(diameter, tuple(WASHER_TABLE))
    if size is None or WASHER_TABLE[size][0] > widest * (1.0 + NOMINAL_TOLERANCE):
        return None
    return Washer(*WASHER_TABLE[size], standard=f"ISO 7089 - {size:g}")


def find_retaining_ring(diameter: float, widest: float) -> RetainingRing:
    """Return the retaining ring of a pin.

    It is the standard ring if that is no wider than ``widest``, otherwise a ring of proportional dimensions.
    """
    size = find_nominal(diameter, tuple(RING_TABLE))
    if size is not None:
        s, groove, width, beyond, room = RING_TABLE[size]
        # The ring's ears must fit within the permitted diameter.
        if size + 2.0 * room <= widest * (1.0 + NOMINAL_TOLERANCE):
            return RetainingRing(s, groove, width, beyond, size + 2.0 * room, f"DIN 471 - {size:g} x {s:g}")
    d = diameter
    return RetainingRing(0.1 * d, 0.95 * d, 0.1125 * d, 0.075 * d, min(1.7 * d, widest))


def name_bar(diameter: float) -> str:
    """Return the designation of the bright bar for a pin; an empty string if that diameter is not sold."""
    size = find_nominal(diameter, PIN_DIAMETERS)
    return "" if size is None else f"EN 10278 - {size:g} h9"
