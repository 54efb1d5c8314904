"""Joining of open curves that meet at their ends, such as a rectangle of four lines or a slot of lines and arcs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from kinematics.arrays import Complex
from kinematics.message import Message
from service.outlines.curves import Curve, reverse_curve

FREE_END, BRANCH_END = -1, -2
"""Markers in place of a partner: the end meets no other end, or more than one."""


@dataclass(frozen=True)
class Chain:
    """A chain of open curves, each of which starts where the previous one ends.

    If ``closed``, the first curve starts where the last one ends. ``branching`` means that the chain ends at a place
    where more than two ends meet, or that such a place prevents it from being closed.
    """

    members: list[Curve]
    closed: bool
    branching: bool = False


def find_chains(curves: Sequence[Curve], reach: float) -> list[Chain]:
    """Chain open curves whose ends lie within ``reach`` of exactly one other end."""
    partner = _find_partners(curves, reach)
    seen: set[int] = set()
    found = []
    # Start at free ends: the curves that remain afterwards form rings.
    for begin in sorted(range(2 * len(curves)), key=lambda end: partner[end] >= 0):
        if begin // 2 in seen:
            continue
        # The end 2k is where curve k starts, 2k + 1 where it ends.
        members, end = [], begin
        while end >= 0 and end // 2 not in seen:
            seen.add(end // 2)
            one = curves[end // 2]
            # Entering a curve at its end means traversing it backwards.
            members.append(one if end % 2 == 0 else reverse_curve(one))
            # end ^ 1 is the other end of the same curve.
            end = int(partner[end ^ 1])
        closed = bool(partner[begin] >= 0)
        found.append(Chain(members, closed, branching=not closed and BRANCH_END in (partner[begin], end)))
    return found


def join_curves(curves: Sequence[Curve], reach: float) -> tuple[list[list[Curve]], list[tuple[Curve, Message]]]:
    """Return the closed chains of open curves, and the remaining curves with the reason."""
    rings, alone = [], []
    for chain in find_chains(curves, reach):
        if chain.closed:
            rings.append(chain.members)
        else:
            alone += [(one, _describe_gap(chain)) for one in chain.members]
    return rings, alone


def _find_partners(curves: Sequence[Curve], reach: float) -> NDArray[np.int64]:
    """Return for each end the number of the end that it meets, or ``FREE_END``, or ``BRANCH_END``."""
    if not curves:
        return np.empty(0, np.int64)
    places = np.array([place for one in curves for place in (one.start, one.end)])
    # One of the three nearest ends is the end itself. If all three are near, the end is at a branch.
    looked = _select_up_to_three(places)
    pairs = np.stack([places[looked].real, places[looked].imag], axis=1)
    away, near = cKDTree(pairs).query(pairs, k=3, distance_upper_bound=reach * (1.0 + 1e-9))
    count = np.isfinite(away).sum(axis=1)
    other = np.where(near[:, 0] == np.arange(len(looked)), near[:, 1], near[:, 0])
    partner = np.full(len(places), BRANCH_END)
    partner[looked] = np.where(
        count == 1, FREE_END, np.where(count == 2, looked[np.where(count == 2, other, 0)], BRANCH_END)
    )
    # An end with one neighbour whose neighbour has two is at the edge of a branch.
    mutual = (partner >= 0) & (partner[np.maximum(partner, 0)] == np.arange(len(places)))
    return np.asarray(np.where((partner >= 0) & ~mutual, BRANCH_END, partner))


def _select_up_to_three(places: Complex) -> NDArray[np.int64]:
    """Return the indices of the points without the fourth and later copies of equal points, which are branches anyway.

    A k-d tree with thousands of equal points would visit all of them for each query.
    """
    _, place = np.unique(places, return_inverse=True)
    order = np.argsort(place, kind="stable")
    ranked = place[order]
    fourth = np.zeros(len(places), np.bool_)
    fourth[3:] = ranked[3:] == ranked[:-3]
    return np.asarray(np.sort(order[~fourth]))


def _describe_gap(chain: Chain) -> Message:
    if chain.branching:
        return Message("outlines-branching-ends", {})
    members = chain.members
    gap = abs(members[-1].end - members[0].start)
    if len(members) == 1:
        return Message("outlines-open-ends", {"gap": f"{gap:.4g}"})
    return Message("outlines-open-chain", {"count": len(members) - 1, "gap": f"{gap:.4g}"})
