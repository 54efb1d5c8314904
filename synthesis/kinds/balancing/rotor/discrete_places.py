"""The best choice among places on a circle: holes to drill with their depths, or weights to fix.

Every place of a plane contributes one of a few vectors, or nothing. For each number of places used, the search finds
the choices whose sum is nearest to a target. The places are split into two halves, and all sums of each half are
listed. For every sum of one half, the nearest partner in the other half is looked up in a tree. This is the method of
two lists of Horowitz and Sahni (subset sums, J. ACM 21, 1974), applied to the plane. It covers (10⁵)² choices exactly.
The search branches on further places. A branch is pruned if its continuous optimum, the distance to the zonotope of
all sums of its places, is no better than the best choice found.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from kinematics.arrays import Complex, Real

DIRECTIONS = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False))
"""Unit vectors of the directions along which sums are bounded."""

MAX_GROUP_SUMS = 100_000
"""Maximum number of sums listed for one half."""

MAX_QUERIES = 3_000_000
"""Maximum number of look-ups, which take some seconds; beyond it the result is not proven to be the best."""


BRANCH_COST = 50
"""Cost of one branch node, as an equivalent number of look-ups."""


MIN_REACH_SHARE = 1e-9
"""Maximum possible sum of the places, as a share of the target, below which every choice leaves the same residual."""


class Choice(NamedTuple):
    """The places used, each with the index of its contribution, and the difference of their sum from the target."""

    picks: dict[int, int]
    residual: complex


class ChoiceFront(NamedTuple):
    """The best choices, each with more places and a smaller residual than the one before, and the proven bound."""

    choices: list[Choice]
    bound: float
    proved: bool


class _Sums(NamedTuple):
    """All sums of a group of places, with the number of places used and each choice encoded in a mixed base."""

    values: Complex
    used: NDArray[np.int64]
    codes: NDArray[np.int64]


def find_best_choices(target: complex, places: Sequence[Complex], most: int) -> ChoiceFront:
    """Find, for every number of places used, the choice with the sum nearest to a target.

    Parameters
    ----------
    target : complex
        The required sum.
    places : sequence of complex arrays
        The possible contributions of each place besides nothing.
    most : int
        Maximum number of places used.
    """
    if sum(float(np.abs(contributions).max()) for contributions in places) <= MIN_REACH_SHARE * abs(target):
        # All sums are negligible in comparison with the target.
        return ChoiceFront([Choice({}, target)], _measure_distance(target, _compute_support(places)), proved=False)
    first, second, rest = _split_places(range(len(places)), places, most)
    if rest:
        # Not all places can be listed: list those with the largest component along the target.
        reach = [float((target.conjugate() * place).real.max()) for place in places]
        first, second, rest = _split_places(sorted(range(len(places)), key=lambda n: -reach[n]), places, most)
    # For each sum of one half, the target minus this sum is looked up among the sums of the other half.
    head, tail = _list_sums([places[n] for n in first], most), _list_sums([places[n] for n in second], most)
    trees = {
        used: (cKDTree(np.stack([tail.values.real, tail.values.imag], axis=1)[at]), at)
        for used in np.unique(tail.used).tolist()
        if len(at := np.flatnonzero(tail.used == used))
    }
    groups = [(used, np.flatnonzero(head.used == used)) for used in np.unique(head.used).tolist()]
    best: dict[int, Choice] = {}
    support = _compute_support([places[n] for n in (*first, *second)])
    query_count, complete = 0, True
    for branch in _list_branches([len(places[n]) for n in rest], most):
        picked = {n: pick - 1 for n, pick in zip(rest, branch, strict=True) if pick}
        left = target - sum((complex(places[n][pick]) for n, pick in picked.items()), 0j)
        # A branch uses at least the picked places: prune it if a choice of no more places is nearer than its bound.
        few = [abs(choice.residual) for count, choice in best.items() if count <= len(picked)]
        if query_count > MAX_QUERIES:
            complete = False
            break
        query_count += BRANCH_COST if rest else 0
        if rest and few and _measure_distance(left, support) >= min(few):
            continue
        for used, at in groups:
            if len(picked) + used > most:
                break
            wanted = left - head.values[at]
            points = np.stack([wanted.real, wanted.imag], axis=1)
            for more, (tree, among) in trees.items():
                count = len(picked) + used + more
                if count > most:
                    continue
                distance, index = tree.query(points)
                query_count += len(points)
                n = int(np.argmin(distance))
                if count not in best or distance[n] < abs(best[count].residual):
                    # Recompute the residual from the picks in a fixed order, without the accumulated rounding of
                    # the sums.
                    picks = picked | _decode_picks(first, places, int(head.codes[at[n]]))
                    picks |= _decode_picks(second, places, int(tail.codes[among[index[n]]]))
                    reached = sum(complex(places[k][pick]) for k, pick in sorted(picks.items()))
                    best[count] = Choice(picks, target - reached)
    front: list[Choice] = []
    for count in sorted(best):
        if not front or abs(best[count].residual) < abs(front[-1].residual):
            front.append(best[count])
    bound = abs(front[-1].residual) if complete else _bound_distance(target, places)
    return ChoiceFront(front, bound, complete)


def _split_places(order: Sequence[int], places: Sequence[Complex], most: int) -> tuple[list[int], list[int], list[int]]:
    """Split the places into two halves and the rest; each place joins the smaller half while its sums fit."""
    halves: tuple[list[int], list[int]] = ([], [])
    rest: list[int] = []
    for n in order:
        for half in sorted(halves, key=len):
            if _count_choices([len(places[k]) for k in (*half, n)], most) <= MAX_GROUP_SUMS:
                half.append(n)
                break
        else:
            rest.append(n)
    return *halves, rest


def _list_branches(sizes: Sequence[int], most: int) -> Iterator[tuple[int, ...]]:
    """Yield the contribution of each place, 0 for none, with at most ``most`` places used; the last varies fastest."""
    if not sizes:
        yield ()
        return
    for pick in range(sizes[0] + 1 if most else 1):
        for later in _list_branches(sizes[1:], most - (pick > 0)):
            yield (pick, *later)


def _count_choices(sizes: Sequence[int], most: int) -> int:
    """Count the choices of at most ``most`` places, given each place's number of contributions."""
    counts = [1]
    for size in sizes:
        counts = [
            (counts[k] if k < len(counts) else 0) + (size * counts[k - 1] if k else 0)
            for k in range(min(len(counts), most) + 1)
        ]
    return sum(counts)


def _list_sums(places: Sequence[Complex], most: int) -> _Sums:
    values, used, codes = np.zeros(1, np.complex128), np.zeros(1, np.int64), np.zeros(1, np.int64)
    for contributions in places:
        levels = np.concatenate([[0.0], contributions])
        taken = used[:, None] + (np.arange(len(levels)) > 0)
        kept = taken <= most
        values = (values[:, None] + levels)[kept]
        codes = (codes[:, None] * len(levels) + np.arange(len(levels)))[kept]
        used = taken[kept]
    return _Sums(values, used, codes)


def _decode_picks(group: Sequence[int], places: Sequence[Complex], code: int) -> dict[int, int]:
    picks = {}
    for n in reversed(group):
        code, pick = divmod(code, len(places[n]) + 1)
        if pick:
            picks[n] = pick - 1
    return picks


def _bound_distance(target: complex, places: Sequence[Complex]) -> float:
    """Return a lower bound of the distance from a target to every sum of the places.

    The bound refers to the convex hull of all sums: the largest distance along any direction is a lower bound. For a
    zonotope of segments from 0, the directions normal to its sides give the exact distance, except at its corners.
    """
    return _measure_distance(target, _compute_support(places))


def _compute_support(places: Sequence[Complex]) -> Real:
    """Return the maximum of the sums along each of :data:`DIRECTIONS` (the support function)."""
    support = np.zeros(len(DIRECTIONS))
    for contributions in places:
        support += np.maximum(0.0, (np.conj(DIRECTIONS)[:, None] * contributions).real.max(axis=1))
    return support


def _measure_distance(target: complex, support: Real) -> float:
    return max(0.0, float(((np.conj(DIRECTIONS) * target).real - support).max()))
