"""Minimum error of a gearbox for every tooth sum, by combining stages in runs with a growing error bound.

Only three numbers of a choice of teeth for a stage matter: its middle c, half width h and tooth sum
(:mod:`synthesis.kinds.gearbox.stages`). All stages but one or two are combined. The best partner of each combination
among the remaining stages is found by bisection.

Most combinations have an error far above the minimum, because gearboxes with large tooth sums come much closer than the
tolerance requires. The first run therefore admits only a small share of the tolerated error. The errors that it finds,
one for each tooth sum, are upper bounds for the next run, which admits a larger share. The last run admits the whole
tolerance. Each run is exact within its bounds, and the last one admits everything that could be better.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Integers, Real
from synthesis.kinds.gearbox.stages import EQUALITY_TOLERANCE, Options, select_undominated

TOLERANCE_DIVISORS = (256.0, 128.0, 64.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0)
"""Divisors of the tolerated error, one for each run."""

MAX_COMBINED_STAGES = 4
"""Maximum number of stages of which all but one are combined; with more, all but two."""

MAX_GATHERED = 1_000_000
"""Number of combinations that are gathered before the dominated ones are removed."""


class Choice(NamedTuple):
    """Teeth of all stages: largest error in logarithms, tooth sum of all stages, and drivers by stage."""

    error: float
    size: int
    stages: tuple[tuple[int, tuple[int, ...]], ...]


class _Remainder(NamedTuple):
    """Bounds of the contribution of the stages that are not yet combined."""

    half: float
    size: int
    low: float
    high: float


def find_best_choices(
    stages: list[Options], level: float, widest: float, progress: Callable[[float], None]
) -> list[Choice]:
    """Find for every total tooth sum the choice of minimum error, if it is smaller than for all smaller sums.

    Parameters
    ----------
    stages : list of Options
        The choices of each stage.
    level : float
        L, the logarithm of the lowest speed over the input's.
    widest : float
        Maximum tolerated error.
    progress : callable
        Receives the approximate share that is done.
    """
    if not all(stage.count for stage in stages):
        return []
    most = sum(int(stage.size.max()) for stage in stages)
    front: list[Choice] = []
    for run, part in enumerate(TOLERANCE_DIVISORS):
        bound = np.full(most + 1, widest / part)
        # A smaller gearbox with this error makes the same error at a larger sum useless.
        for choice in front:
            bound[choice.size :] = np.minimum(bound[choice.size :], choice.error)
        front = _search_front(
            stages,
            _SearchBounds(level, bound),
            _scale_progress(progress, run / len(TOLERANCE_DIVISORS), (run + 1) / len(TOLERANCE_DIVISORS)),
        )
    return front


class _SearchBounds(NamedTuple):
    """L, and the largest useful error by total tooth sum, which does not rise with it."""

    level: float
    bound: Real

    def mark_feasible(self, middle: Real, half: Real, size: Integers, rest: _Remainder) -> NDArray[np.bool_]:
        """Return the choices that can stay within the bounds, with the best contribution of the other stages."""
        # |Σ c − L| + Σ h ≤ bound, with the extreme middles of the remaining stages.
        room = self.bound[size + rest.size] - half - rest.half + EQUALITY_TOLERANCE
        short = middle - self.level
        return np.asarray((room >= 0.0) & (short + rest.low <= room) & (short + rest.high >= -room), np.bool_)


def _scale_progress(progress: Callable[[float], None], start: float, end: float) -> Callable[[float], None]:
    """Return a progress callback for a part of the work."""

    def report_share(share: float) -> None:
        progress(start + share * (end - start))

    return report_share


def _search_front(stages: list[Options], wanted: _SearchBounds, progress: Callable[[float], None]) -> list[Choice]:
    """Compute the front within the bounds, exactly."""
    for k, stage in enumerate(stages):
        others = _bound_remainder([*stages[:k], *stages[k + 1 :]])
        stages = [*stages[:k], _filter_options(stage, wanted, others), *stages[k + 1 :]]
        if not stages[k].count:
            return []
    # The stage with the most choices is never multiplied out: its partners are found by bisection.
    order = sorted(range(len(stages)), key=lambda k: stages[k].count)
    split = len(stages) - 1 - (len(stages) > MAX_COMBINED_STAGES)
    parts = [[stages[k] for k in order[:split]], [stages[k] for k in order[split:]]]
    joined = []
    for part, beyond in (parts, parts[::-1]):
        whole = part[0] if part else _make_empty()
        for k in range(1, len(part)):
            whole = _combine_options(whole, part[k], wanted, _bound_remainder([*part[k + 1 :], *beyond]), progress)
        if not whole.count:
            return []
        joined.append(whole)
    return [
        choice._replace(stages=tuple(choice.stages[order.index(k)] for k in range(len(stages))))
        for choice in _match_halves(joined[0], joined[1], wanted)
    ]


def _bound_remainder(stages: list[Options]) -> _Remainder:
    return _Remainder(
        sum(float(stage.half.min()) for stage in stages),
        sum(int(stage.size.min()) for stage in stages),
        sum(float(stage.middle.min()) for stage in stages),
        sum(float(stage.middle.max()) for stage in stages),
    )


def _make_empty() -> Options:
    """Return the single choice of no stage at all."""
    zero = np.zeros(1)
    return Options(zero, zero, np.zeros(1, np.int64), np.zeros((1, 0), np.int64), (), 1)


def _filter_options(stage: Options, wanted: _SearchBounds, rest: _Remainder) -> Options:
    kept = wanted.mark_feasible(stage.middle, stage.half, stage.size, rest)
    return Options(
        stage.middle[kept], stage.half[kept], stage.size[kept], stage.picks[kept], stage.teeth, stage.covered
    )


def _combine_options(
    one: Options, other: Options, wanted: _SearchBounds, rest: _Remainder, progress: Callable[[float], None]
) -> Options:
    """Combine the undominated choices of two sets of options."""
    pairs = np.zeros((0, 2), np.int64)
    gathered, held = [pairs], 0
    step = max(1, MAX_GATHERED // other.count)
    for start in range(0, one.count, step):
        progress(start / one.count)
        rows = np.arange(start, min(start + step, one.count))
        # Middles and half widths of independent stages add up.
        c, h = one.middle[rows, None] + other.middle, one.half[rows, None] + other.half
        at, to = np.nonzero(wanted.mark_feasible(c, h, one.size[rows, None] + other.size, rest))
        gathered.append(np.stack((rows[at], to), axis=1))
        held += len(at)
        if held > MAX_GATHERED:
            gathered = [_select_pairs(one, other, np.concatenate(gathered))]
            held = len(gathered[0])
    pairs = _select_pairs(one, other, np.concatenate(gathered))
    middle, half, size = _add_pairs(one, other, pairs)
    picks = np.concatenate((one.picks[pairs[:, 0]], other.picks[pairs[:, 1]]), axis=1)
    return Options(middle, half, size, picks, (*one.teeth, *other.teeth), one.covered * other.covered)


def _select_pairs(one: Options, other: Options, pairs: Integers) -> Integers:
    return np.asarray(pairs[select_undominated(*_add_pairs(one, other, pairs))])


def _add_pairs(one: Options, other: Options, pairs: Integers) -> tuple[Real, Real, Integers]:
    a, b = pairs[:, 0], pairs[:, 1]
    return one.middle[a] + other.middle[b], one.half[a] + other.half[b], one.size[a] + other.size[b]


def _match_halves(one: Options, other: Options, wanted: _SearchBounds) -> list[Choice]:
    """Find the best choice of every total tooth sum.

    For each choice of the first stages, the best partner of one tooth sum is one of two choices: the one with the
    minimum h − c among those with a middle below the required one, or that with the minimum h + c above it.
    """
    best: dict[int, tuple[float, int, int]] = {}
    for size in np.unique(other.size).tolist():
        rows = np.flatnonzero(other.size == size)
        rows = rows[np.argsort(other.middle[rows], kind="stable")]
        c, h = other.middle[rows], other.half[rows]
        level = _Remainder(float(h.min()), size, float(c[0]), float(c[-1]))
        firsts = np.flatnonzero(wanted.mark_feasible(one.middle, one.half, one.size, level))
        # The middle that the partner should have for zero error.
        needed = wanted.level - one.middle[firsts]
        at = np.searchsorted(c, needed)
        # Running minima from both ends answer "the best partner below/above" for every position at once.
        below, above = _find_running_minimum(h - c), _find_running_minimum((h + c)[::-1])
        for partner, there in (
            (below[np.maximum(at - 1, 0)], at > 0),
            (len(c) - 1 - above[np.maximum(len(c) - 1 - at, 0)], at < len(c)),
        ):
            error = np.where(there, np.abs(c[partner] - needed) + h[partner] + one.half[firsts], np.inf)
            total = one.size[firsts] + size
            error[error > wanted.bound[total] + EQUALITY_TOLERANCE] = np.inf
            for k in _find_first_of_total(total, error):
                candidate = (float(error[k]), int(firsts[k]), int(rows[partner[k]]))
                whole = int(total[k])
                if math.isfinite(candidate[0]) and (
                    whole not in best or candidate[0] < best[whole][0] - EQUALITY_TOLERANCE
                ):
                    best[whole] = candidate
    front: list[Choice] = []
    for whole in sorted(best):
        least, first, second = best[whole]
        if not front or least < front[-1].error - EQUALITY_TOLERANCE:
            picks = (*one.picks[first].tolist(), *other.picks[second].tolist())
            teeth = (*one.teeth, *other.teeth)
            stages = tuple(
                (int(sums[pick]), tuple(int(z) for z in drivers[pick]))
                for pick, (sums, drivers) in zip(picks, teeth, strict=True)
            )
            front.append(Choice(least, whole, stages))
    return front


def _find_running_minimum(values: Real) -> Integers:
    """Return, for every index, the index of the minimum of the values up to it."""
    least = np.minimum.accumulate(values)
    return np.asarray(np.maximum.accumulate(np.where(values <= least, np.arange(len(values)), 0)), np.int64)


def _find_first_of_total(total: Integers, error: Real) -> Integers:
    """Return the index of the minimum error for each total."""
    order = np.lexsort((error, total))
    _, first = np.unique(total[order], return_index=True)
    return order[first]
