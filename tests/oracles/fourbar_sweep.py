"""A fourbar swept by circles that intersect, in plain numpy: its coupler point, from the dimensions of an answer."""

from __future__ import annotations

import math

import numpy as np


def coupler_points(mechanism, degrees):
    """P of a fourbar answer at absolute input angles in degrees, in its own assembly; NaN where it does not close."""
    m = mechanism
    o2, o4 = complex(*m.fixed_pivots.input), complex(*m.fixed_pivots.output)
    a = o2 + m.links.input * np.exp(1j * np.radians(degrees))
    gap = o4 - a
    along = (m.links.coupler**2 - m.links.output**2 + np.abs(gap) ** 2) / (2.0 * np.abs(gap))
    with np.errstate(invalid="ignore"):
        across = np.sqrt(m.links.coupler**2 - along**2)
    b = a + gap / np.abs(gap) * (along + (1j if m.assembly == "open" else -1j) * across)
    return a + (b - a) / np.abs(b - a) * m.coupler_point.distance * np.exp(1j * math.radians(m.coupler_point.angle))


def least_sum_in_order(mechanism, points, samples=1440):
    """The least sum of squared distances of points from the path of a crank, in order within one turn, by brute force.

    Over samples of the whole turn, from every start and both ways; an upper bound that is close where samples are fine.
    """
    p = coupler_points(mechanism, np.arange(samples) * 360.0 / samples)
    assert np.all(np.isfinite(p))
    least = math.inf
    for way in (p, p[::-1]):
        squares = np.abs(np.asarray(points)[:, None] - way) ** 2
        wide = np.concatenate([squares, squares], axis=1)
        for start in range(0, samples, 12):
            totals = wide[0, start : start + samples].copy()
            for row in wide[1:, start : start + samples]:
                totals = np.minimum.accumulate(totals) + row
            least = min(least, float(totals.min()))
    return least
