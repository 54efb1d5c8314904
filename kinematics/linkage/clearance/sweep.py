"""Whether parts of a mechanism keep a distance at every input of a range, and how near they come.

The range is divided until each part of it decides: with the distance d in the middle, and the two outlines moving by no
more than m while the input stays in it, the distance is at least d − m there. Where a pair comes nearest, the distance
is followed to its minimum. A part of the range that is still undecided at the limit of refinement counts as not kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from kinematics.linkage.clearance.outlines import Indices, Part, Real
from kinematics.linkage.clearance.scene import Pairs, Scene
from kinematics.linkage.planar.mechanism import Mechanism

FINEST = 1e-10
"""Half of a part at the limit of refinement, as :data:`scene.FIRST`: parts move by less in it than :data:`SURE` allows,
so that what begins or ends at just the wanted distance is decided."""

ENDS = 1e-7
"""How far from its ends a range has positions, in the same units: an end may be a toggle, to rounding."""

MOST = 400_000
"""Distances of pairs that are looked at in a sweep at most; what is undecided then stays so."""

SURE = 1e-9
"""Share of the mechanism's size by which a distance may be less than asked and be kept: what rounding leaves."""

COARSE = 2e-3
"""Share of the size within which no place is nearer than where a minimum is looked for."""

SECTIONS, NARROWINGS = 9, 14
"""Parts that a bracket is divided into, of which the two beside the least place are left, and how often: to 1e-9 of the
bracket, where a minimum is known to rounding. Each time costs hardly more than one place would."""


Interval = tuple[float, float]

Nearest = Literal["each", "all", "none"]


class Swept(NamedTuple):
    """What a pair of parts does over a range.

    Attributes
    ----------
    least : float
        Least distance between the outlines; where the cores meet, less than nothing by the sum of the radii, and by a
        little more (:data:`outlines.MEETING`): links without width that cross are nearer than those that touch.
    at : float
        Input where it is so: radians, or position along the slide.
    keeps : bool
        Whether the distance is at least the wanted one at every input of the range. A proof but for rounding.
    decided : bool
        Whether that could be decided; undecided pairs do not keep it. Where there is no position at an end none is.
    """

    least: float
    at: float
    keeps: bool
    decided: bool


def swept(
    mechanism: Mechanism,
    parts: Sequence[Part],
    pairs: Pairs,
    low: float,
    high: float,
    wanted: float,
    *,
    nearest: Nearest = "each",
) -> list[Swept]:
    """How near pairs of parts come over a range of the input, and whether they keep a distance everywhere in it.

    Parameters
    ----------
    mechanism : Mechanism
        One design, of shape ().
    parts : sequence of Part
    pairs : sequence of (int, int)
        Parts by their numbers.
    low, high : float
        The range, absolute: radians, or positions along the input slide. On the reference's branch.
    wanted : float
        The distance that is to be kept, in length units; less than nothing allows outlines to overlap by as much.
    nearest : str
        Of which pairs the least distance is looked for: of ``each``, of the one that comes nearest of ``all``, or of
        ``none``. Of the others that of the places that were looked at is told, no more of them than it takes to decide.
        With ``all`` no more is decided than whether all of them keep the distance.

    Returns
    -------
    list of Swept
        In the order of ``pairs``.

    Raises
    ------
    DimensionError
        For several designs, a range that is not finite or ends before it begins, a part without points or with a
        radius below nothing, or one on a link that does not exist.
    """
    if not pairs:
        return []
    scene = Scene(mechanism, parts, pairs)
    count, slack = len(pairs), SURE * scene.size
    centre, half = scene.divided(low, high)
    pair = np.repeat(np.arange(count), len(centre))
    centre, half = np.tile(centre, count), np.tile(half, count)
    best, at = np.full(count, np.inf), np.full(count, np.nan)
    inside = min(ENDS * scene.unit, 0.5 * (high - low))
    decided = np.full(count, scene.reached(np.array([low + inside, high - inside])).all())
    near: list[tuple[Indices, Real, Real]] = []
    looked = 0
    while len(pair):
        here, bound = scene.distances(pair, centre, half)
        looked += len(pair)
        known = np.isfinite(here)
        order = np.argsort(np.where(known, -here, -np.inf), kind="stable")  # the nearest of each pair is written last
        order = order[known[order] & (here[order] < best[pair[order]])]
        best[pair[order]], at[pair[order]] = here[order], centre[order]
        least = np.where(known, np.maximum(here - bound, scene.overlaps[pair]), -np.inf)
        open_to_nearest = least < _nearer_than(nearest, best)[pair] - COARSE * scene.size
        open_to_wanted = (least < wanted - slack) & (best[pair] >= wanted - slack)
        if nearest == "all" and best.min() < wanted - slack:
            decided[pair[open_to_wanted]] = False
            open_to_wanted[:] = False
        near.append((pair[known], centre[known], here[known]))
        more = open_to_nearest | open_to_wanted | ~known
        if looked + 2 * np.count_nonzero(more) > MOST:
            decided[pair[open_to_wanted | ~known]] = False
            break
        lost = more & (half <= FINEST * scene.unit)
        decided[pair[lost & (open_to_wanted | ~known)]] = False
        pair, centre, half = _halved(pair[more & ~lost], centre[more & ~lost], half[more & ~lost])
    if nearest != "none":
        values, places = _nearest(scene, near, low, high, _nearer_than(nearest, best))
        nearer = values < best
        best[nearer], at[nearer] = values[nearer], places[nearer]
    keeps = decided & (best >= wanted - slack)
    return [
        Swept(float(best[n]), float(at[n]), bool(keeps[n]), bool(decided[n] or best[n] < wanted - slack))
        for n in range(count)
    ]


def free_inputs(
    mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs, low: float, high: float, wanted: float, fine: float
) -> list[Interval]:
    """The inputs of a range at which all pairs keep a distance, as intervals in ascending order.

    Each is proven to be free, and ends within ``fine`` (radians, or length along the slide) of where a pair is nearer,
    or of where that could not be decided. Parameters and errors otherwise as of :func:`swept`.
    """
    free: list[Interval] = [(low, high)]
    for own in free_ranges(mechanism, parts, pairs, low, high, wanted, fine):
        both = [(max(one[0], other[0]), min(one[1], other[1])) for one in free for other in own]
        free = sorted((start, end) for start, end in both if start < end)
    return free


def free_ranges(
    mechanism: Mechanism, parts: Sequence[Part], pairs: Pairs, low: float, high: float, wanted: float, fine: float
) -> list[list[Interval]]:
    """The same of each pair by itself, in the order of ``pairs``."""
    if not pairs:
        return []
    scene = Scene(mechanism, parts, pairs)
    slack = SURE * scene.size
    centre, half = scene.divided(low, high)
    pair = np.repeat(np.arange(len(pairs)), len(centre))
    centre, half = np.tile(centre, len(pairs)), np.tile(half, len(pairs))
    free: list[tuple[Indices, Real, Real]] = []
    while len(pair):
        here, bound = scene.distances(pair, centre, half)
        kept = np.maximum(here - bound, scene.overlaps[pair]) >= wanted - slack
        # Outlines that are nearer everywhere in a part of the range need no finer look.
        met = here + bound < wanted - slack
        start, end = np.clip([centre - half, centre + half], low, high)[:, kept]
        free.append((pair[kept], start, end))
        # Where the bound is coarse, as it is near a toggle, far from the wanted distance no end is near.
        coarse = (here > wanted + COARSE * scene.size) & (half > FINEST * scene.unit)
        more = ~kept & ~met & ((half > 0.5 * fine) | coarse)
        # In quarters, since few large batches take less time than many small ones; the last may be halves.
        times = 1 if half[0] <= fine else 2
        pair, centre, half = pair[more], centre[more], half[more]
        for _ in range(times):
            pair, centre, half = _halved(pair, centre, half)
    of, starts, ends = (np.concatenate(columns) for columns in zip(*free, strict=True))
    return [_merged(starts[of == n], ends[of == n], 1e-9 * scene.unit) for n in range(len(pairs))]


def _merged(starts: Real, ends: Real, near: float) -> list[Interval]:
    """Intervals that do not overlap in order, those that follow on from each other as one."""
    if not len(starts):
        return []
    starts, ends = np.sort(starts), np.sort(ends)
    apart = starts[1:] > ends[:-1] + near
    first, last = np.concatenate([[True], apart]), np.concatenate([apart, [True]])
    return list(zip(starts[first].tolist(), ends[last].tolist(), strict=True))


def _halved(pair: Indices, centre: Real, half: Real) -> tuple[Indices, Real, Real]:
    quarter = 0.5 * half
    return np.tile(pair, 2), np.concatenate([centre - quarter, centre + quarter]), np.tile(quarter, 2)


def _nearer_than(nearest: Nearest, best: Real) -> Real:
    """The distance of each pair below which it is looked for."""
    if nearest == "each":
        return best
    return np.full(len(best), best.min() if nearest == "all" else -np.inf)


def _nearest(
    scene: Scene, near: list[tuple[Indices, Real, Real]], low: float, high: float, than: Real
) -> tuple[Real, Real]:
    """The least distance of each pair, from where it is least among the places that were looked at; and its input.

    Only from places hardly farther than ``than``, shape (pairs,).
    """
    pair, centre, here = (np.concatenate(columns) for columns in zip(*near, strict=True))
    best, at = np.full(len(scene.pairs), np.inf), np.full(len(scene.pairs), np.nan)
    begins: list[tuple[int, float, float]] = []
    for n in range(len(scene.pairs)):
        own = np.flatnonzero(pair == n)
        own = own[np.argsort(centre[own])]
        values = np.concatenate([[np.inf], here[own], [np.inf]])
        # Of equal ones the first: a corner that stands still is as near all the time.
        valley = (values[1:-1] < values[:-2]) & (values[1:-1] <= values[2:])
        close = here[own] <= than[n] + COARSE * scene.size
        # Nothing is nearer than where cores meet.
        lowest = valley & close & (here[own] > scene.overlaps[n]) & (than[n] > scene.overlaps[n])
        # The neighbours that were looked at bracket the minimum, and the ends of the range.
        ends = np.concatenate([[low], centre[own], [high]])
        begins += [(n, ends[k], ends[k + 2]) for k in np.flatnonzero(lowest)]
    if not begins:
        return best, at
    of = np.array([n for n, _, _ in begins])
    left, right = (np.array([row[side] for row in begins]) for side in (1, 2))

    def value(inputs: Real) -> Real:
        flat = inputs.ravel()
        distances = scene.distances(np.tile(of, len(inputs)), flat, np.zeros(len(flat)))[0]
        return np.where(np.isfinite(distances), distances, np.inf).reshape(inputs.shape)

    shares = np.arange(1, SECTIONS)[:, None] / SECTIONS
    for _ in range(NARROWINGS):
        inside = left + shares * (right - left)
        lowest = np.argmin(value(inside), axis=0)
        step = (right - left) / SECTIONS
        left, right = left + lowest * step, left + (lowest + 2) * step
    ends = np.stack([0.5 * (left + right), np.full(len(of), low), np.full(len(of), high)])
    for inputs, distances in zip(ends, value(ends), strict=True):
        for n, place, d in zip(of, inputs, distances, strict=True):
            if d < best[n]:
                best[n], at[n] = d, place
    return best, at
