"""Draw random linkages whose curves are compared with a target: evenly spread shapes of one family.

Shapes are drawn by the logarithms of lengths relative to the crank, from Sobol's sequence, with O2 at the origin and
the ground line or slide along the real axis. Each comes with the range of crank angles over which it moves.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.stats import qmc

from kinematics.arrays import Real
from synthesis.fit.chart import CRANK_ROCKER, DOUBLE_CRANK, FOURBAR, SLIDER_CRANK, SLIDER_ROCKER, UNKNOWNS

MAX_CYCLE_TURNS = 60
"""Maximum number of crank turns followed for a geared fivebar; gear ratios with larger denominators close later than
this."""

RATIO_TOLERANCE = 1e-9
"""Maximum difference of a gear ratio from a fraction to which it counts as equal."""

SWEEP_SHARE = 0.999
"""Share of the range between two toggles that is swept: at the toggles themselves the derivatives are unbounded."""


class RandomLinkages(NamedTuple):
    """Candidates of one family: unknowns at unit crank, signs, and the crank's range (begin, end), shape (n,)."""

    x: Real
    sign: Real
    begin: Real
    end: Real


def draw_linkages(family: int, count: int, ratio: float, seed: int) -> RandomLinkages:
    """Draw linkages of a family with O2 at the origin and shapes spread evenly in the logarithms of their lengths."""
    m = UNKNOWNS[family]
    # Sobol's points are evenly spread only in powers of two.
    u = qmc.Sobol(m, seed=seed).random_base2(max(0, math.ceil(math.log2(count))))[:count]
    x = np.zeros((count, m))
    begin, end = np.zeros(count), np.full(count, 2.0 * math.pi)
    sign = np.ones(count)
    if family in (CRANK_ROCKER, DOUBLE_CRANK):
        # Unknowns 4 to 6 are logarithms of the slack by which the shortest link stays shortest: the crank turns by
        # construction.
        x[:, 4:7] = np.log(0.05) + u[:, 2:5] * np.log(12.0 / 0.05)
        coupler = 1.0 + 0.5 * (np.exp(x[:, 4]) + np.exp(x[:, 5]))
        _place_coupler_points(x, u, coupler)
    elif family == FOURBAR:
        x[:, 3:7] = np.log(0.2) + u[:, 2:6] * np.log(5.0 / 0.2)
        lengths = np.exp(x[:, 3:7])
        _place_coupler_points(x, u, lengths[:, 2])
        begin, end = _compute_fourbar_range(lengths)
    elif family == SLIDER_CRANK:
        x[:, 4] = np.log(0.05) + u[:, 2] * np.log(12.0 / 0.05)
        # Offset of the slide, from −1.5 to 1.5 times the slack of the coupler over the crank.
        x[:, 5] = 3.0 * (u[:, 3] - 0.5)
        _place_coupler_points(x, u, 1.0 + np.exp(x[:, 4]))
    elif family == SLIDER_ROCKER:
        x[:, 4] = np.log(0.2) + u[:, 2] * np.log(5.0 / 0.2)
        x[:, 5] = 4.0 * (u[:, 3] - 0.5)
        _place_coupler_points(x, u, np.exp(x[:, 4]))
        begin, end = _compute_slider_range(np.exp(x[:, 4]), x[:, 5])
    else:
        x[:, 4:8] = np.log(0.3) + u[:, 2:6] * np.log(8.0 / 0.3)
        # Lengths are relative to the first crank, of unit length.
        x[:, 4] = 0.0
        distance = np.exp(np.log(0.2) + u[:, 6] * np.log(8.0 / 0.2))
        x[:, 2] = distance
        # Phase of the second crank.
        x[:, 8] = 2.0 * math.pi * u[:, 7]
        _place_coupler_points(x, u, np.exp(x[:, 5]))
        end = np.full(count, compute_cycle(ratio))
    return RandomLinkages(x, sign, begin, end)


def compute_cycle(ratio: float) -> float:
    """Return the crank's rotation after which a geared fivebar repeats itself, radians; one turn for other linkages."""
    turns = 1
    while turns < MAX_CYCLE_TURNS and abs(ratio * turns - round(ratio * turns)) > RATIO_TOLERANCE:
        turns += 1
    return 2.0 * math.pi * turns


def _place_coupler_points(x: Real, u: Real, coupler: Real) -> None:
    """Place coupler points around the coupler's middle, most within a few coupler lengths of it, in place."""
    reach = coupler * np.exp(np.log(0.03) + u[:, 0] * np.log(4.0 / 0.03))
    point = 0.5 * coupler + reach * np.exp(2j * math.pi * u[:, 1])
    x[:, -2], x[:, -1] = point.real, point.imag


def _compute_fourbar_range(lengths: Real) -> tuple[Real, Real]:
    """Return the crank's range, measured from the ground line (γ = 0).

    It is a full turn, or the range from toggle to toggle on the upper side of the ground line.
    """
    d, a, b, c = lengths.T
    most = (a * a + d * d - (b + c) ** 2) / (2.0 * a * d)
    least = (a * a + d * d - (b - c) ** 2) / (2.0 * a * d)
    # The crank turns where cos θ lies between: |A O4| between |b − c| and b + c.
    low, high = np.arccos(np.clip(least, -1.0, 1.0)), np.arccos(np.clip(most, -1.0, 1.0))
    turns = (most <= -1.0) & (least >= 1.0)
    # A crank that cannot turn through swings across the ground line on one of its two sides.
    through_zero, through_pi = (least >= 1.0) & ~turns, (most <= -1.0) & ~turns
    begin = np.where(turns, 0.0, np.where(through_zero, -high, low))
    end = np.where(turns, 2.0 * np.pi, np.where(through_pi, 2.0 * np.pi - low, high))
    middle, half = 0.5 * (begin + end), 0.5 * SWEEP_SHARE * (end - begin)
    return np.where(turns, 0.0, middle - half), np.where(turns, 2.0 * np.pi, middle + half)


def _compute_slider_range(coupler: Real, offset: Real) -> tuple[Real, Real]:
    """Return the crank's range from the slide's direction (σ = 0, crank of length one)."""
    low, high = offset - coupler, offset + coupler
    turns = (low <= -1.0) & (high >= 1.0)
    bottom, top = np.arcsin(np.clip(low, -1.0, 1.0)), np.arcsin(np.clip(high, -1.0, 1.0))
    begin = np.where(high >= 1.0, bottom, np.where(low <= -1.0, np.pi - top, bottom))
    end = np.where(high >= 1.0, np.pi - bottom, np.where(low <= -1.0, 2.0 * np.pi + top, top))
    middle, half = 0.5 * (begin + end), 0.5 * SWEEP_SHARE * (end - begin)
    return np.where(turns, 0.0, middle - half), np.where(turns, 2.0 * np.pi, middle + half)
