"""Extremes of quantities along a motion, refined between its positions.

Near a toggle, a force can rise and fall between two positions. Wherever the bend (second derivative) of a quantity
permits a value above the highest known one, the motion is sampled more closely, in a few rounds. If there are many such
intervals, those with the highest possible values are refined first.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Real

Samples = dict[str, Real]

INTERVAL_PARTS, MAX_ROUNDS = 8, 5
"""Number of parts into which an interval is divided that may contain a higher value, and maximum number of rounds."""

MAX_BEND_FACTOR = 4.0
"""Assumed maximum bend between two positions, as a multiple of the larger of the neighbouring second differences."""

PEAK_TOLERANCE = 1e-5
"""Possible excess over the highest known value, as a share of it, up to which an interval is not refined further."""

MAX_ADDED_POSITIONS = 4096
"""Maximum number of positions added in a round."""


class Peak(NamedTuple):
    """A maximum and the input at which it occurs; NaN if there is none."""

    value: float
    at: float


def find_peaks(
    positions: Real, speeds: Real, samples: Samples, measure: Callable[[Real, Real], Samples], closed: bool
) -> dict[str, Peak]:
    """Find the maximum of each quantity.

    Parameters
    ----------
    positions, speeds : float, shape (N,)
        Inputs of the motion; between neighbours they follow the parabola through three of them, which is exact for
        equal steps of the input and for a run of constant acceleration.
    samples : dict of str to float, shape (N,)
        Quantities at these inputs; NaN where they are unknown.
    measure : callable
        Computes the quantities at other inputs and speeds.
    closed : bool
        Whether the motion is closed, so that a peak may lie beyond its end.
    """
    known = {name: values for name, values in samples.items() if np.isfinite(values).any()}
    found = {name: Peak(np.nan, np.nan) for name in samples}
    if len(positions) < 3 or not known:
        at = {name: int(np.nanargmax(values)) for name, values in known.items()}
        return found | {name: Peak(float(samples[name][k]), float(positions[k])) for name, k in at.items()}
    places = np.arange(len(positions), dtype=np.float64)
    for _ in range(MAX_ROUNDS):
        fresh = _find_doubtful_places(places, known)
        if not len(fresh):
            break
        more = measure(_interpolate(positions, fresh), _interpolate(speeds, fresh))
        order = np.argsort(np.concatenate([places, fresh]), kind="stable")
        places = np.concatenate([places, fresh])[order]
        known = {name: np.concatenate([values, more[name]])[order] for name, values in known.items()}
    return found | {name: _find_vertex(positions, places, values, closed) for name, values in known.items()}


def _find_doubtful_places(places: Real, known: Samples) -> Real:
    """Find places between those of ``places`` at which some quantity may exceed its highest value.

    Places are indices of the original positions, with fractions between them.
    """
    steps = np.diff(places)
    above = np.zeros(len(steps))
    for values in known.values():
        slopes = np.diff(values) / steps
        bends = np.abs(np.nan_to_num(2.0 * np.diff(slopes) / (steps[1:] + steps[:-1])))
        bend = np.maximum(np.concatenate([bends[:1], bends]), np.concatenate([bends, bends[-1:]]))
        # A parabola of this bend rises above the higher end of an interval h by at most bend · h² / 8.
        highest = np.nanmax(values)
        reached = np.maximum(values[:-1], values[1:]) + MAX_BEND_FACTOR * bend * steps**2 / 8.0
        excess = np.nan_to_num(reached - highest) / (np.nanmax(np.abs(values)) or 1.0)
        above = np.maximum(above, np.where(reached > highest + PEAK_TOLERANCE * abs(highest), excess, 0.0))
    highest_first = np.argsort(-above, kind="stable")[
        : min(MAX_ADDED_POSITIONS // (INTERVAL_PARTS - 1), np.count_nonzero(above))
    ]
    chosen = np.sort(highest_first)
    shares = np.arange(1, INTERVAL_PARTS) / INTERVAL_PARTS
    return np.asarray((places[chosen, None] + steps[chosen, None] * shares).ravel())


def _interpolate(values: Real, places: Real) -> Real:
    """Interpolate values, given at integer places, by the parabola through the nearest three."""
    middle = np.clip(np.rint(places).astype(int), 1, len(values) - 2)
    share = places - middle
    before, at, after = values[middle - 1], values[middle], values[middle + 1]
    return np.asarray(at + 0.5 * share * (after - before) + 0.5 * share**2 * (after - 2.0 * at + before))


def _find_vertex(positions: Real, places: Real, values: Real, closed: bool) -> Peak:
    """Find the vertex of the parabola through the highest value and its neighbours."""
    k, last = int(np.nanargmax(values)), len(values) - 1
    place, top = places[k], float(values[k])
    stands = Peak(top, float(_interpolate(positions, places[k : k + 1])[0]))
    if 0 < k < last:
        sides = (k - 1, k + 1)
        reach = (place - places[k - 1], places[k + 1] - place)
    elif closed:  # the first and the last position are one
        sides = (last - 1, 1)
        reach = (places[last] - places[last - 1], places[1] - places[0])
    else:
        return stands
    left, right = ((top - float(values[side])) / far for side, far in zip(sides, reach, strict=True))
    # At a corner, or next to a position without a value, the parabola is meaningless, so keep the highest value.
    bend = (left + right) / (reach[0] + reach[1])
    slope = (left * reach[1] - right * reach[0]) / (reach[0] + reach[1])
    if not bend > 0.0:
        return stands
    off = float(slope / (2.0 * bend))
    if not -reach[0] <= off <= reach[1]:
        return stands
    at = float(_interpolate(positions, np.array([place + off]))[0])
    return Peak(top + float(slope) * off - float(bend) * off**2, at)
