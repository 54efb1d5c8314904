"""Extremes of quantities along a motion, refined between its positions by looking there again."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Samples = dict[str, Real]

FINER = 17
"""Places at which a peak is looked for between the neighbours of the highest position."""


class Peak(NamedTuple):
    """A greatest value and the input at which it stands; NaN where there is none."""

    value: float
    at: float


def peaks(
    positions: Real, speeds: Real, samples: Samples, measure: Callable[[Real, Real], Samples], closed: bool
) -> dict[str, Peak]:
    """The greatest value of each quantity.

    Parameters
    ----------
    positions, speeds : float, shape (N,)
        Inputs of the motion; between neighbours they follow the parabola through three of them, which is exact for
        equal steps of the input and for a run of constant acceleration.
    samples : dict of str to float, shape (N,)
        Quantities there; NaN where there are none.
    measure : callable
        The quantities at other inputs and speeds.
    closed : bool
        Whether the motion closes, so that a peak may lie beyond its end.
    """
    found = {name: Peak(np.nan, np.nan) for name in samples}
    looked = {name: int(np.nanargmax(values)) for name, values in samples.items() if np.isfinite(values).any()}
    if len(positions) < 3 or not looked:
        return found | {name: Peak(float(samples[name][k]), float(positions[k])) for name, k in looked.items()}
    last = len(positions) - 1
    shares = np.linspace(-1.0, 1.0, FINER)
    inputs, rates = [], []
    for k in looked.values():
        middle = min(max(k, 1), last - 1)
        share = shares + (k - middle)
        if not closed:
            share = np.clip(share, -1.0, 1.0)
        near = slice(middle - 1, middle + 2)
        inputs.append(_between(positions[near], share))
        rates.append(_between(speeds[near], share))
    finer = measure(np.concatenate(inputs), np.concatenate(rates))
    for n, name in enumerate(looked):
        found[name] = _vertex(inputs[n], finer[name][n * FINER : (n + 1) * FINER])
        at_first = Peak(float(samples[name][looked[name]]), float(positions[looked[name]]))
        if not found[name].value >= at_first.value:
            found[name] = at_first
    return found


def _between(three: Real, share: Real) -> Real:
    """The parabola through three values at −1, 0 and 1."""
    before, middle, after = three
    return np.asarray(middle + 0.5 * share * (after - before) + 0.5 * share**2 * (after - 2.0 * middle + before))


def _vertex(at: Real, values: Real) -> Peak:
    """The top of the parabola through the highest value and its neighbours."""
    if not np.isfinite(values).any():
        return Peak(np.nan, np.nan)
    k = int(np.nanargmax(values))
    # At an end of a motion that does not close the places are one and the same: nothing lies beyond.
    if not 0 < k < len(at) - 1 or at[k] in (at[k - 1], at[k + 1]):
        return Peak(float(values[k]), float(at[k]))
    before, top, after = (float(values[n]) for n in (k - 1, k, k + 1))
    bend = after - 2.0 * top + before
    step = float(at[k + 1] - at[k - 1]) / 2.0
    share = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    # At a corner, or beside a position without value, the parabola tells nothing: the highest value stands.
    if not abs(share) <= 1.0:
        return Peak(top, float(at[k]))
    return Peak(top + 0.25 * (after - before) * share, float(at[k]) + share * step)
