"""Proof that parts of a mechanism keep a distance at every input of a range, and their minimum distance.

The range is divided until each part is decided: with the distance d in the middle, and the two outlines moving by at
most m while the input stays in the part, the distance is at least d − m there. The minimum distance of a pair is then
refined. A part of the range that is still undecided at the limit of refinement counts as a violation.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Integers, Real
from kinematics.linkage.clearance.outlines import Part
from kinematics.linkage.clearance.scene import Pairs, Scene
from kinematics.linkage.planar.mechanism import Mechanism

MIN_HALF_WIDTH = 1e-10
"""Minimum half-width of a part, in the units of :data:`scene.INITIAL_HALF_WIDTH`: within it parts move by less than
:data:`DISTANCE_TOLERANCE`, so that a pair that only just reaches the required distance is decided."""

END_OFFSET = 1e-7
"""Offset from the ends of a range at which it must have positions, in the same units: an end may be a toggle."""

MAX_DISTANCES = 400_000
"""Maximum number of distances computed in a sweep; pairs undecided by then stay undecided."""

DISTANCE_TOLERANCE = 1e-9
"""Share of the mechanism's size by which a distance may fall short of the required one: rounding."""

SEARCH_MARGIN = 2e-3
"""Share of the size by which a sample may exceed the smallest one and still start a search for the minimum."""

SECTION_COUNT, NARROWING_STEPS = 9, 14
"""Number of sections of a bracket, of which the two next to the minimum are kept, and number of repetitions. They
shrink the bracket to 1e-9, where a minimum is known to rounding. One batch costs hardly more than one evaluation."""


Interval = tuple[float, float]

Nearest = Literal["each", "all", "none"]


class SweepResult(NamedTuple):
    """Result for a pair of parts over a range.

    Attributes
    ----------
    least : float
        Minimum distance between the outlines. If the cores intersect it is minus the sum of the radii and a little
        more (:data:`outlines.OVERLAP_DEPTH`), so that crossing links without width rank below touching ones.
    at : float
        Input of the minimum: radians, or position along the slide.
    keeps : bool
        Whether the distance is at least the required one at every input of the range: a proof, except for rounding.
    decided : bool
        Whether that could be decided; undecided pairs have ``keeps`` False. Without a position at an end of the range
        no pair is decided.
    """

    least: float
    at: float
    keeps: bool
    decided: bool


def sweep_pairs(
    mechanism: Mechanism,
    parts: Sequence[Part],
    pairs: Pairs,
    low: float,
    high: float,
    wanted: float,
    *,
    nearest: Nearest = "each",
) -> list[SweepResult]:
    """Sweep pairs of parts over a range of the input: minimum distance, and whether a distance is kept throughout.

    Parameters
    ----------
    mechanism : Mechanism
        One design, of shape ().
    parts : sequence of Part
    pairs : sequence of (int, int)
        Pairs of indices into ``parts``.
    low, high : float
        The range of absolute inputs, radians or positions along the input slide, on the reference's branch.
    wanted : float
        Required distance, in length units; a negative one allows outlines to overlap by that amount.
    nearest : str
        Pairs whose minimum distance is refined: ``each``, the nearest of ``all``, or ``none``. For the others the
        minimum over the samples needed for the decision is returned. With ``all`` only the question whether all pairs
        keep the distance is decided.

    Returns
    -------
    list of SweepResult
        In the order of ``pairs``.

    Raises
    ------
    DimensionError
        For several designs, a range that is not finite or ends before it begins, a part without points or with a
        negative radius, or a part on an unknown link.
    """
    if not pairs:
        return []
    scene = Scene(mechanism, parts, pairs)
    count, slack = len(pairs), DISTANCE_TOLERANCE * scene.size
    centre, half = scene.divide_range(low, high)
    pair = np.repeat(np.arange(count), len(centre))
    centre, half = np.tile(centre, count), np.tile(half, count)
    best, at = np.full(count, np.inf), np.full(count, np.nan)
    inside = min(END_OFFSET * scene.unit, 0.5 * (high - low))
    decided = np.full(count, scene.has_position(np.array([low + inside, high - inside])).all())
    near: list[tuple[Integers, Real, Real]] = []
    looked = 0
    while len(pair):
        here, bound = scene.distances(pair, centre, half)
        looked += len(pair)
        # Unknown positions keep their part of the range undecided.
        known = np.isfinite(here)
        order = np.argsort(np.where(known, -here, -np.inf), kind="stable")  # the nearest of each pair is written last
        order = order[known[order] & (here[order] < best[pair[order]])]
        best[pair[order]], at[pair[order]] = here[order], centre[order]
        # Lower bound of the distance in each part; intersecting cores have a fixed lowest value.
        least = np.where(known, np.maximum(here - bound, scene.overlaps[pair]), -np.inf)
        open_to_nearest = least < _get_search_limit(nearest, best)[pair] - SEARCH_MARGIN * scene.size
        open_to_wanted = (least < wanted - slack) & (best[pair] >= wanted - slack)
        # One violation decides the question for all pairs.
        if nearest == "all" and best.min() < wanted - slack:
            decided[pair[open_to_wanted]] = False
            open_to_wanted[:] = False
        near.append((pair[known], centre[known], here[known]))
        more = open_to_nearest | open_to_wanted | ~known
        if looked + 2 * np.count_nonzero(more) > MAX_DISTANCES:
            decided[pair[open_to_wanted | ~known]] = False
            break
        # Parts at the limit of refinement stay undecided.
        lost = more & (half <= MIN_HALF_WIDTH * scene.unit)
        decided[pair[lost & (open_to_wanted | ~known)]] = False
        pair, centre, half = _split_halves(pair[more & ~lost], centre[more & ~lost], half[more & ~lost])
    if nearest != "none":
        values, places = _find_nearest(scene, near, low, high, _get_search_limit(nearest, best))
        nearer = values < best
        best[nearer], at[nearer] = values[nearer], places[nearer]
    keeps = decided & (best >= wanted - slack)
    return [
        SweepResult(float(best[n]), float(at[n]), bool(keeps[n]), bool(decided[n] or best[n] < wanted - slack))
        for n in range(count)
    ]


def find_free_inputs(
    mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs, low: float, high: float, wanted: float, fine: float
) -> list[Interval]:
    """Find the inputs of a range at which all pairs keep a distance, as ascending intervals.

    Each interval is proved to be free, and ends within ``fine`` (radians, or length along the slide) of an input at
    which a pair is closer or undecided. Other parameters and errors as for :func:`sweep_pairs`.
    """
    free: list[Interval] = [(low, high)]
    for own in find_free_ranges(mechanism, parts, pairs, low, high, wanted, fine):
        both = [(max(one[0], other[0]), min(one[1], other[1])) for one in free for other in own]
        free = sorted((start, end) for start, end in both if start < end)
    return free


def find_free_ranges(
    mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs, low: float, high: float, wanted: float, fine: float
) -> list[list[Interval]]:
    """Find the free intervals of each pair separately, in the order of ``pairs``; see :func:`find_free_inputs`."""
    if not pairs:
        return []
    scene = Scene(mechanism, parts, pairs)
    slack = DISTANCE_TOLERANCE * scene.size
    centre, half = scene.divide_range(low, high)
    pair = np.repeat(np.arange(len(pairs)), len(centre))
    centre, half = np.tile(centre, len(pairs)), np.tile(half, len(pairs))
    free: list[tuple[Integers, Real, Real]] = []
    while len(pair):
        here, bound = scene.distances(pair, centre, half)
        kept = np.maximum(here - bound, scene.overlaps[pair]) >= wanted - slack
        # Parts in which the outlines are too close everywhere need no refinement.
        met = here + bound < wanted - slack
        start, end = np.clip([centre - half, centre + half], low, high)[:, kept]
        free.append((pair[kept], start, end))
        # Near a toggle the bound is coarse: keep refining where the distance itself is clearly sufficient.
        coarse = (here > wanted + SEARCH_MARGIN * scene.size) & (half > MIN_HALF_WIDTH * scene.unit)
        more = ~kept & ~met & ((half > 0.5 * fine) | coarse)
        # Divide into quarters, since few large batches are faster than many small ones; the last may be halves.
        times = 1 if half[0] <= fine else 2
        pair, centre, half = pair[more], centre[more], half[more]
        for _ in range(times):
            pair, centre, half = _split_halves(pair, centre, half)
    of, starts, ends = (np.concatenate(columns) for columns in zip(*free, strict=True))
    return [_merge_intervals(starts[of == n], ends[of == n], 1e-9 * scene.unit) for n in range(len(pairs))]


def _merge_intervals(starts: Real, ends: Real, near: float) -> list[Interval]:
    """Merge adjacent intervals into one; the given ones do not overlap."""
    if not len(starts):
        return []
    starts, ends = np.sort(starts), np.sort(ends)
    apart = starts[1:] > ends[:-1] + near
    first, last = np.concatenate([[True], apart]), np.concatenate([apart, [True]])
    return list(zip(starts[first].tolist(), ends[last].tolist(), strict=True))


def _split_halves(pair: Integers, centre: Real, half: Real) -> tuple[Integers, Real, Real]:
    quarter = 0.5 * half
    return np.tile(pair, 2), np.concatenate([centre - quarter, centre + quarter]), np.tile(quarter, 2)


def _get_search_limit(nearest: Nearest, best: Real) -> Real:
    """Return the distance of each pair below which its minimum is searched."""
    if nearest == "each":
        return best
    return np.full(len(best), best.min() if nearest == "all" else -np.inf)


def _find_nearest(
    scene: Scene, near: list[tuple[Integers, Real, Real]], low: float, high: float, than: Real
) -> tuple[Real, Real]:
    """Refine the minimum distance of each pair from its smallest samples; return distances and inputs.

    Only samples close to ``than``, shape (pairs,), start a search.
    """
    pair, centre, here = (np.concatenate(columns) for columns in zip(*near, strict=True))
    best, at = np.full(len(scene.pairs), np.inf), np.full(len(scene.pairs), np.nan)
    begins: list[tuple[int, float, float]] = []
    for n in range(len(scene.pairs)):
        own = np.flatnonzero(pair == n)
        own = own[np.argsort(centre[own])]
        values = np.concatenate([[np.inf], here[own], [np.inf]])
        # Of equal samples take the first: the distance of a fixed corner is constant.
        valley = (values[1:-1] < values[:-2]) & (values[1:-1] <= values[2:])
        close = here[own] <= than[n] + SEARCH_MARGIN * scene.size
        # Intersecting cores already have the lowest possible value.
        lowest = valley & close & (here[own] > scene.overlaps[n]) & (than[n] > scene.overlaps[n])
        # The neighbouring samples, or the ends of the range, bracket the minimum.
        ends = np.concatenate([[low], centre[own], [high]])
        begins += [(n, ends[k], ends[k + 2]) for k in np.flatnonzero(lowest)]
    if not begins:
        return best, at
    of = np.array([n for n, _, _ in begins])
    left, right = (np.array([row[side] for row in begins]) for side in (1, 2))

    def measure_value(inputs: Real) -> Real:
        flat = inputs.ravel()
        distances = scene.distances(np.tile(of, len(inputs)), flat, np.zeros(len(flat)))[0]
        return np.where(np.isfinite(distances), distances, np.inf).reshape(inputs.shape)

    shares = np.arange(1, SECTION_COUNT)[:, None] / SECTION_COUNT
    for _ in range(NARROWING_STEPS):
        inside = left + shares * (right - left)
        lowest = np.argmin(measure_value(inside), axis=0)
        step = (right - left) / SECTION_COUNT
        left, right = left + lowest * step, left + (lowest + 2) * step
    ends = np.stack([0.5 * (left + right), np.full(len(of), low), np.full(len(of), high)])
    for inputs, distances in zip(ends, measure_value(ends), strict=True):
        for n, place, d in zip(of, inputs, distances, strict=True):
            if d < best[n]:
                best[n], at[n] = d, place
    return best, at
