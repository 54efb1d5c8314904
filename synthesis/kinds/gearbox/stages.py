"""Tooth numbers of one stage of a machine-tool gearbox, and the sum of stages in the errors of all speeds.

With equal modules all pairs of a stage have the same tooth sum. Let d = ln(driver/driven) − k x ln φ for pair k of a
stage: with exact steps d would be the same for all its pairs. The logarithm of a spindle speed over its nominal
value is the sum of the engaged pairs' d, minus L = ln(n₁/n_input). Over all speeds these sums range from the sum of the
stages' minimum d to the sum of their maximum d, so that with the middle c and half width h of each stage::

    largest |ln(n/n_nominal)| = |Σ c − L| + Σ h

Only c, h and the tooth sum of a choice of teeth matter. Whatever the other stages are, it is dominated by a choice c',
h' of the same or a smaller tooth sum if |c − c'| + h' ≤ h. Removing dominated choices never loses the best gearbox.

For a given tooth sum of one stage, only few choices are needed. Let δ be the minimum d of a choice. Taking for each
pair the smallest d that is not below δ gives a choice with an interval of d within that of the original choice, which
it therefore dominates. It suffices to let δ run through the d of all drivers and pairs.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from synthesis.kinds.gearbox.structures import Group
from synthesis.model.gears.mesh_limits import has_no_external_interference

EQUALITY_TOLERANCE = 1e-13
"""Difference below which middles and half widths are equal: sums of a few rounded logarithms."""


class StageLimits(NamedTuple):
    """Limits on the teeth of one stage; ratios are driven speed over driving speed, angles radians.

    ``cluster`` is the minimum difference between the largest and the next driver of three or more pairs.
    """

    teeth: tuple[int, int]
    tooth_sum: tuple[int, int]
    ratio: tuple[float, float]
    pressure_angle: float
    cluster: int


@dataclass(frozen=True)
class Options:
    """Undominated choices of one or several stages, smallest tooth sum first.

    Attributes
    ----------
    middle, half, size : ndarray, shape (n,)
        c, h and the tooth sum.
    picks : ndarray, shape (n, stages)
        The chosen row of ``teeth`` for each stage.
    teeth : tuple of (sum, drivers) arrays
        By stage: tooth sums (m,), and teeth of the drivers (m, pairs).
    """

    middle: Real
    half: Real
    size: Integers
    picks: Integers
    teeth: tuple[tuple[Integers, Integers], ...]
    covered: int

    @property
    def count(self) -> int:
        """Number of choices."""
        return len(self.middle)


def list_stage_options(group: Group, ratio: float, widest: float, limits: StageLimits) -> Options:
    """List all undominated choices for one stage.

    Parameters
    ----------
    group : Group
        Its pairs and their steps.
    ratio : float
        Progression ratio φ.
    widest : float
        Largest useful half width, below half a step: the tolerated error.
    limits : StageLimits
        Teeth, tooth sums and ratios allowed.
    """
    step = group.characteristic * math.log(ratio)
    options = [
        (np.zeros(0), np.zeros(0), np.zeros(0, np.int64), np.zeros((0, group.pairs), np.int64)),
    ]
    covered = 0
    for total in range(limits.tooth_sum[0], limits.tooth_sum[1] + 1):
        own = find_sound_drivers(total, limits)
        covered += math.comb(len(own), group.pairs)
        if len(own) < group.pairs:
            continue
        low, high, drivers = _find_narrowest(own, np.log(own / (total - own)), step, group.pairs, limits.cluster)
        kept = high - low <= 2.0 * widest + EQUALITY_TOLERANCE
        c, h, drivers = 0.5 * (low + high)[kept], 0.5 * (high - low)[kept], drivers[kept]
        worth = select_undominated(c, h, np.zeros(len(c), np.int64))
        options.append((c[worth], h[worth], np.full(len(worth), total), drivers[worth]))
    middle, half, size, drivers = (np.concatenate(part) for part in zip(*options, strict=True))
    worth = select_undominated(middle, half, size)
    return Options(middle[worth], half[worth], size[worth], worth[:, None], ((size, drivers),), covered)


def find_sound_drivers(total: int, limits: StageLimits) -> Integers:
    """Return the teeth of the drivers of sound pairs with this tooth sum, in rising order."""
    own = np.arange(max(limits.teeth[0], total - limits.teeth[1]), min(limits.teeth[1], total - limits.teeth[0]) + 1)
    quotient = own / np.maximum(total - own, 1)
    # Interference is decided for standard teeth.
    sound = has_no_external_interference(
        own.astype(np.float64), (total - own).astype(np.float64), limits.pressure_angle
    )
    least, most = limits.ratio[0] * (1.0 - EQUALITY_TOLERANCE), limits.ratio[1] * (1.0 + EQUALITY_TOLERANCE)
    return np.asarray(own[(quotient >= least) & (quotient <= most) & sound], np.int64)


def _find_narrowest(own: Integers, level: Real, step: float, pairs: int, cluster: int) -> tuple[Real, Real, Integers]:
    """Find the narrowest choice for every possible minimum d.

    Return the minimum and the maximum d of each choice, shape (n,), and its drivers, shape (n, pairs). If a minimum
    difference between the two largest drivers is required, the largest is moved up if necessary. It and the next
    driver are then still the smallest possible.
    """
    # Every d of a driver in the place of any pair is tried as the minimum.
    least = np.concatenate([level - k * step for k in range(pairs)])
    places = [np.searchsorted(level, least + (k * step - EQUALITY_TOLERANCE)) for k in range(pairs)]
    if pairs > 2 and cluster:
        below = own[np.minimum(places[-2], len(own) - 1)]
        places[-1] = np.maximum(places[-1], np.searchsorted(own, below + cluster))
    at = np.stack(places, axis=1)
    at = at[(at < len(own)).all(axis=1)]
    values = level[at] - step * np.arange(pairs)
    return values.min(axis=1), values.max(axis=1), own[at]


def select_undominated(middle: Real, half: Real, size: Integers) -> Integers:
    """Select the rows that no other row of at most their size dominates, smallest first."""
    order = np.lexsort((half, middle, size))
    ends = np.flatnonzero(np.diff(size[order], append=np.iinfo(np.int64).max)) + 1
    # The rows kept so far, by rising middle, for the sizes up to here.
    kept, c, h = np.zeros(0, np.int64), np.zeros(0), np.zeros(0)
    chosen = [kept]
    for own in np.split(order, ends[:-1]):
        if not len(own):
            break
        left, right = half[own] - middle[own], half[own] + middle[own]
        # The first of several equal rows is kept.
        replaced = (_minimum_before(left) <= left + EQUALITY_TOLERANCE) | (
            _minimum_after(right) < right - EQUALITY_TOLERANCE
        )
        if len(kept):
            at = np.searchsorted(c, middle[own], side="right")
            # Dominated by a smaller size: |c − c'| + h' ≤ h, split into c' ≤ c and c' > c.
            replaced |= np.append(_minimum_before(h - c), (h - c).min())[at] <= left + EQUALITY_TOLERANCE
            replaced |= np.append(np.minimum.accumulate((h + c)[::-1])[::-1], np.inf)[at] <= right + EQUALITY_TOLERANCE
        new = own[~replaced]
        chosen.append(new)
        kept = np.concatenate((kept, new))
        kept = kept[np.argsort(middle[kept], kind="stable")]
        c, h = middle[kept], half[kept]
    return np.concatenate(chosen)


def _minimum_before(values: Real) -> Real:
    """Return for every place the minimum of the values before it; infinite for the first."""
    return np.concatenate(([np.inf], np.minimum.accumulate(values)[:-1]))


def _minimum_after(values: Real) -> Real:
    """Return for every place the minimum of the values after it; infinite for the last."""
    return _minimum_before(values[::-1])[::-1]
