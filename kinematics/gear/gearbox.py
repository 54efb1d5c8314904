"""Gearboxes of several speeds on fixed shafts: analysis of given tooth numbers.

A machine-tool gearbox is a row of shafts; between each two neighbours one of several gear pairs is engaged. The number
of spindle speeds is the product of the numbers of pairs of all stages (Rao, Sec. 8.5). A layshaft gearbox of
a vehicle has a head pair that always turns the layshaft, a pair from there to the main shaft for every gear, and an
idler in the reverse gear.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from kinematics.errors import DimensionError

R40 = (
    100, 106, 112, 118, 125, 132, 140, 150, 160, 170, 180, 190, 200, 212, 224, 236, 250, 265, 280, 300,
    315, 335, 355, 375, 400, 425, 450, 475, 500, 530, 560, 600, 630, 670, 710, 750, 800, 850, 900, 950,
)  # fmt: skip
"""Preferred numbers of the series R40 from 100 to 950 (ISO 3); R20, R10 and R5 are every 2nd, 4th and 8th of them."""

SERIES_STRIDES = {"R40": 1, "R20": 2, "R10": 4, "R5": 8}
"""Steps in R40 from one number of a series to the next."""


class SpindleSpeed(NamedTuple):
    """A speed of the last shaft and the pair that is engaged in each stage."""

    speed: Fraction
    engaged: tuple[int, ...]


def list_spindle_speeds(input_speed: Fraction | int, stages: Sequence[Sequence[tuple[int, int]]]) -> list[SpindleSpeed]:
    """List every speed of the spindle, slowest first: input × Π driver/driven over the engaged pairs.

    Parameters
    ----------
    input_speed : Fraction
        Speed of the first shaft.
    stages : sequence of sequences of (driver, driven)
        Tooth numbers of the pairs between each two shafts.

    Raises
    ------
    DimensionError
        For a stage without pairs or a tooth number below 1.

    Examples
    --------
    Rao, Solved Problem 8.8.

    >>> box = [[(24, 96), (80, 40)], [(30, 60), (45, 45), (60, 30)]]
    >>> [int(found.speed) for found in list_spindle_speeds(200, box)]
    [25, 50, 100, 200, 400, 800]
    """
    for pairs in stages:
        if not pairs:
            raise DimensionError("stages", "kinematics-stages-of-gear-pairs", pairs)
        for driver, driven in pairs:
            if min(driver, driven) < 1:
                raise DimensionError("teeth", "kinematics-count-at-least", (driver, driven), least=1)
    speeds = []
    for engaged in itertools.product(*(range(len(pairs)) for pairs in stages)):
        # Exact fractions, so that equal speeds compare equal.
        speed = Fraction(input_speed)
        for pairs, choice in zip(stages, engaged, strict=True):
            speed *= Fraction(*pairs[choice])
        speeds.append(SpindleSpeed(speed, engaged))
    return sorted(speeds)


def compute_progression(lowest: float, highest: float, count: int) -> tuple[float, list[float]]:
    """Compute the ratio φ = (n_max/n_min)^(1/(z − 1)) and the z speeds of a geometric progression (Rao, eq. 8.5).

    Raises
    ------
    DimensionError
        For fewer than two speeds, or limits that are not positive and rising.
    """
    if count < 2:
        raise DimensionError("count", "kinematics-at-least", count, least=2)
    if not 0.0 < lowest < highest:
        raise DimensionError("speeds", "kinematics-rising-speeds", (lowest, highest))
    ratio = (highest / lowest) ** (1.0 / (count - 1))
    return ratio, [lowest * ratio**k for k in range(count)]


def series_ratio(series: str, step: int = 1) -> float:
    """Return the progression ratio of every ``step``-th number of a series: 10^(step/r) for r numbers in a decade."""
    return float(10.0 ** (step * SERIES_STRIDES[series] / len(R40)))


def list_preferred_numbers(series: str, start: float, count: int, step: int = 1) -> list[float] | None:
    """List every ``step``-th preferred number (rounded by ISO 3) from ``start`` on; None if ``start`` is not one."""
    # Bring the start into the tabulated decade; the tolerance absorbs binary rounding of decimal input.
    decade = 0
    value = start
    while value >= 1000.0 * (1.0 - 1e-9):
        value, decade = value / 10.0, decade + 1
    while value < 100.0 * (1.0 - 1e-9):
        value, decade = value * 10.0, decade - 1
    stride = SERIES_STRIDES[series]
    place = next((k for k, number in enumerate(R40) if abs(value - number) <= 1e-6 * number), None)
    # Not in this series, though perhaps in a finer one.
    if place is None or place % stride:
        return None
    places = (place + k * step * stride for k in range(count))
    # A decimal quotient: 31.5 and not 31.499999999999996.
    return [float(Fraction(R40[at % len(R40)]) * Fraction(10) ** (decade + at // len(R40))) for at in places]


class LayshaftRatios(NamedTuple):
    """Ratios input over output of a layshaft gearbox: the forward gears, and reverse (negative) if it exists."""

    forward: list[Fraction]
    reverse: Fraction | None


def compute_layshaft_ratios(
    head: tuple[int, int],
    gears: Sequence[tuple[int, int] | None],
    reverse: tuple[int, int, int] | None = None,
) -> LayshaftRatios:
    """Compute the ratios of a layshaft gearbox: (b/a)(d/c) for the head pair a, b and the pair c, d of a gear.

    Parameters
    ----------
    head : (int, int)
        Teeth on the input shaft and on the layshaft.
    gears : sequence of (int, int) or None
        Teeth on layshaft and main shaft; None for direct drive, input and main shaft joined.
    reverse : (int, int, int), optional
        Teeth on layshaft, idler and main shaft; the idler turns the direction round and cancels out.
    """
    # Every gear but direct drive passes through the head pair.
    turned = Fraction(head[1], head[0])
    forward = [Fraction(1) if pair is None else turned * Fraction(pair[1], pair[0]) for pair in gears]
    back = None if reverse is None else -turned * Fraction(reverse[2], reverse[0])
    return LayshaftRatios(forward, back)
