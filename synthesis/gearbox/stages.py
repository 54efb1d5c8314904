"""Tooth numbers of one stage of a machine-tool gearbox, and how stages add up to the errors of all speeds.

With equal modules all pairs of a stage have the same tooth sum. Let d = ln(driver/driven) − k x ln φ for pair k of a
stage: were the steps exact, d would be the same for all its pairs. The logarithm of a spindle speed over its nominal
value is the sum of the engaged pairs' d, less L = ln(n₁/n_input). Over all speeds these sums reach from the sum of the
least d of each stage to the sum of the greatest, so that with the middle c and half width h of each stage::

    largest |ln(n/n_nominal)| = |Σ c − L| + Σ h

A choice of teeth thus enters by c, h and its tooth sum alone. One with c', h' and no greater sum takes its place
wherever |c − c'| + h' ≤ h without making anything worse; such choices are left out, which loses no best gearbox, of one
stage or of several together.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.gearbox.structures import Group
from synthesis.planetary_train.mesh_limits import external_sound

Real = NDArray[np.float64]
Whole = NDArray[np.int64]

SAME = 1e-13
"""Middles and half widths that differ by less are equal: sums of a few logarithms, rounded."""


class StageLimits(NamedTuple):
    """Limits on the teeth of one stage; ratios are driven speed over driving speed, angles radians.

    ``cluster`` is the least difference between the largest and the next driver of three or more pairs.
    """

    teeth: tuple[int, int]
    tooth_sum: tuple[int, int]
    ratio: tuple[float, float]
    pressure_angle: float
    cluster: int


@dataclass(frozen=True)
class Options:
    """Choices worth having of one stage or several, smallest tooth sum first.

    Attributes
    ----------
    middle, half, size : ndarray, shape (n,)
        c, h and the tooth sum.
    picks : ndarray, shape (n, stages)
        For each stage the row of ``teeth`` that is taken.
    teeth : tuple of (sum, drivers) arrays
        By stage: tooth sums (m,), and teeth of the drivers (m, pairs).
    """

    middle: Real
    half: Real
    size: Whole
    picks: Whole
    teeth: tuple[tuple[Whole, Whole], ...]
    covered: int

    @property
    def count(self) -> int:
        """How many choices there are."""
        return len(self.middle)


def stage_options(group: Group, ratio: float, widest: float, limits: StageLimits) -> Options:
    """All choices worth having for one stage.

    Parameters
    ----------
    group : Group
        Its pairs and their steps.
    ratio : float
        Progression ratio φ.
    widest : float
        Largest half width that can be of use: the tolerated error.
    limits : StageLimits
        Teeth, tooth sums and ratios allowed.
    """
    step = group.characteristic * math.log(ratio)
    sums, drivers, middles, halves = [], [], [], []
    covered = 0
    for total in range(limits.tooth_sum[0], limits.tooth_sum[1] + 1):
        own = np.arange(
            max(limits.teeth[0], total - limits.teeth[1]), min(limits.teeth[1], total - limits.teeth[0]) + 1
        )
        quotient = own / np.maximum(total - own, 1)
        sound = external_sound(own.astype(np.float64), (total - own).astype(np.float64), limits.pressure_angle)
        least, most = limits.ratio[0] * (1.0 - SAME), limits.ratio[1] * (1.0 + SAME)
        own = own[(quotient >= least) & (quotient <= most) & sound]
        covered += len(own) ** group.pairs
        if not len(own):
            continue
        level = np.log(own / (total - own))
        rows = np.arange(len(own))[:, None]
        low = high = level.copy()
        for k in range(1, group.pairs):
            shifted = level - k * step
            lower, upper = np.minimum(low[:, None], shifted), np.maximum(high[:, None], shifted)
            at, new = np.nonzero(upper - lower <= 2.0 * widest + SAME)
            rows = np.concatenate((rows[at], new[:, None]), axis=1)
            low, high = lower[at, new], upper[at, new]
        chosen = own[rows]
        if group.pairs > 2 and limits.cluster:
            ordered = np.sort(chosen, axis=1)
            kept = ordered[:, -1] - ordered[:, -2] >= limits.cluster
            chosen, low, high = chosen[kept], low[kept], high[kept]
        sums.append(np.full(len(chosen), total))
        drivers.append(chosen)
        middles.append(0.5 * (low + high))
        halves.append(0.5 * (high - low))
    if not sums:
        nothing = np.zeros(0, np.int64)
        sums, drivers, middles, halves = [nothing], [np.zeros((0, group.pairs), np.int64)], [np.zeros(0)], [np.zeros(0)]
    size = np.concatenate(sums).astype(np.int64)
    teeth = ((size, np.concatenate(drivers).astype(np.int64)),)
    middle, half = np.concatenate(middles), np.concatenate(halves)
    worth = worth_having(middle, half, size)
    return Options(middle[worth], half[worth], size[worth], worth[:, None], teeth, covered)


def worth_having(middle: Real, half: Real, size: Whole) -> Whole:
    """Rows that no other row of at most their size can replace, smallest first."""
    kept = np.zeros(0, np.int64)
    for level in np.unique(size).tolist():
        own = np.flatnonzero(size == level)
        rows = np.concatenate((kept, own))
        fresh = np.concatenate((np.zeros(len(kept), np.bool_), np.ones(len(own), np.bool_)))
        # Of equals the older, then the first, stays: it comes first in the order and again last, seen from the right.
        order = np.lexsort((fresh, half[rows], middle[rows]))
        c, h, new = middle[rows][order], half[rows][order], fresh[order]
        left, right = h - c, h + c
        before = np.concatenate(([np.inf], np.minimum.accumulate(left)[:-1]))
        after = np.concatenate((np.minimum.accumulate(right[::-1])[::-1][1:], [np.inf]))
        replaced = (before <= left + SAME) | (after < right - SAME)
        kept = np.concatenate((kept, rows[order][new & ~replaced]))
    return kept


def together(one: Options, other: Options, widest: float) -> Options:
    """All choices worth having for the stages of two sets of options together."""
    parts: dict[int, list[Whole]] = {}
    levels = [np.unique(side.size).tolist() for side in (one, other)]
    rows = [
        {level: np.flatnonzero(side.size == level) for level in own}
        for side, own in zip((one, other), levels, strict=True)
    ]
    found = np.zeros((0, 2), np.int64)
    for first in levels[0]:
        for second in levels[1]:
            a, b = rows[0][first], rows[1][second]
            at, to = np.nonzero(one.half[a][:, None] + other.half[b] <= widest + SAME)
            if len(at):
                pairs = np.stack((a[at], b[to]), axis=1)
                inner = worth_having(*_sums(one, other, pairs))
                parts.setdefault(first + second, []).append(pairs[inner])
    if parts:
        found = np.concatenate([pairs for level in sorted(parts) for pairs in parts[level]])
    middle, half, size = _sums(one, other, found)
    kept = worth_having(middle, half, size)
    picks = np.concatenate((one.picks[found[kept, 0]], other.picks[found[kept, 1]]), axis=1)
    return Options(middle[kept], half[kept], size[kept], picks, (*one.teeth, *other.teeth), one.covered * other.covered)


def _sums(one: Options, other: Options, pairs: Whole) -> tuple[Real, Real, Whole]:
    a, b = pairs[:, 0], pairs[:, 1]
    return one.middle[a] + other.middle[b], one.half[a] + other.half[b], one.size[a] + other.size[b]


class Choice(NamedTuple):
    """Teeth of all stages: largest error in logarithms, tooth sum of all stages, and drivers by stage."""

    error: float
    size: int
    stages: tuple[tuple[int, tuple[int, ...]], ...]


def best_choices(one: Options, other: Options, level: float) -> list[Choice]:
    """For every total tooth sum the choice of least error, where it is less than for all smaller sums.

    ``level`` is L. For each choice of the first stages the best partner has its middle next to the one wanted: of those
    below it the one of least h − c, of those above it the one of least h + c.
    """
    best: dict[int, tuple[float, int, int]] = {}
    for size in np.unique(other.size).tolist():
        rows = np.flatnonzero(other.size <= size)
        rows = rows[np.argsort(other.middle[rows], kind="stable")]
        c, h = other.middle[rows], other.half[rows]
        wanted = level - one.middle
        at = np.searchsorted(c, wanted)
        below, above = _running_least(h - c), _running_least((h + c)[::-1])
        for partner, there in (
            (below[np.maximum(at - 1, 0)], at > 0),
            (len(c) - 1 - above[np.maximum(len(c) - 1 - at, 0)], at < len(c)),
        ):
            error = np.where(there, np.abs(c[partner] - wanted) + h[partner] + one.half, np.inf)
            total = one.size + other.size[rows[partner]]
            for k in _firsts(total, error):
                found = (float(error[k]), int(k), int(rows[partner[k]]))
                whole = int(total[k])
                if math.isfinite(found[0]) and (whole not in best or found[0] < best[whole][0] - SAME):
                    best[whole] = found
    front: list[Choice] = []
    for whole in sorted(best):
        least, first, second = best[whole]
        if not front or least < front[-1].error - SAME:
            picks = (*one.picks[first].tolist(), *other.picks[second].tolist())
            teeth = (*one.teeth, *other.teeth)
            stages = tuple(
                (int(sums[pick]), tuple(int(z) for z in drivers[pick]))
                for pick, (sums, drivers) in zip(picks, teeth, strict=True)
            )
            front.append(Choice(least, whole, stages))
    return front


def _running_least(values: Real) -> Whole:
    """For every place the place of the least value up to it."""
    least = np.minimum.accumulate(values)
    return np.asarray(np.maximum.accumulate(np.where(values <= least, np.arange(len(values)), 0)), np.int64)


def _firsts(total: Whole, error: Real) -> Whole:
    """The place of least error for each total."""
    order = np.lexsort((error, total))
    _, first = np.unique(total[order], return_index=True)
    return order[first]
