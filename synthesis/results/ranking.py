"""Ranking of designs by the keys of their kind, and selection of candidates that differ from one another.

All sorting of designs is done here. docs/methods/ranking.md explains the orders.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.compiling import njit
from synthesis.model.protocols import VerifiedDesign

Ranked = TypeVar("Ranked", bound=VerifiedDesign)


def select_distinct(joints: ArrayLike, count: int, apart: float) -> list[int]:
    """Select different candidates greedily, best first.

    A candidate differs from another if some joint is at least ``apart`` from the same joint of the other.

    Parameters
    ----------
    joints : complex, shape (candidates, joints)
        Joints in the first position, best candidate first; there may be no candidates.
    count : int
        Maximum number of candidates to select.
    apart : float
        Minimum distance, in the unit of ``joints``.

    Returns
    -------
    list of int
        Selected rows, best first.
    """
    table = np.ascontiguousarray(joints, np.complex128)
    # The kernel cannot be compiled for an empty table of unknown width.
    return [int(k) for k in _select_distinct(table, count, apart)] if len(table) else []


def select_most_distinct(joints: NDArray[np.complex128], count: int, aparts: Iterable[float]) -> list[int]:
    """Select different candidates as :func:`select_distinct`, with the first distance that gives ``count`` of them.

    The distances ``aparts`` are tried in order. If none gives enough candidates, the result of the last one is
    returned.
    """
    chosen: list[int] = []
    for apart in aparts:
        chosen = select_distinct(joints, count, float(apart))
        # There are enough, or all that exist; a smaller distance would only add near duplicates.
        if len(chosen) >= min(count, len(joints)):
            break
    return chosen


@njit(cache=True, nogil=True)
def _select_distinct(joints: NDArray[np.complex128], count: int, apart: float) -> NDArray[np.int64]:
    chosen = np.empty(min(count, len(joints)), np.int64)
    taken = 0
    for i in range(len(joints)):
        if taken == len(chosen):
            break
        differs = True
        for j in chosen[:taken]:
            gap = 0.0
            # Two candidates differ if any of their joints differs.
            for k in range(joints.shape[1]):
                gap = max(gap, abs(joints[i, k] - joints[j, k]))
            # This candidate is too close to a better one, which is already selected.
            if gap < apart:
                differs = False
                break
        if differs:
            chosen[taken] = i
            taken += 1
    return chosen[:taken]


RESIDUAL_ROUNDING = 1e-12
"""Residual, as a share of the task's size, up to which it is rounding."""


def _compute_decade(residual: float) -> float:
    """Return the order of magnitude of a residual; residuals of one decade, or at rounding level, count as equal."""
    # Differences within a decade do not matter in practice; other keys then decide.
    return math.floor(math.log10(max(residual, RESIDUAL_ROUNDING)))


def get_quality_key(design: Any) -> float:
    """Return the sort key that puts designs of higher quality first."""
    return -float(design.metrics.quality)


Key = Callable[[Any], float]

SORT_KEYS: Mapping[str, Key] = {
    "quality": get_quality_key,
    "accuracy": lambda design: _compute_decade(max(target.residual for target in design.targets)),
    "size": lambda design: design.metrics.size,
    "transmission_angle": lambda design: -design.metrics.min_transmission_angle,
}
"""Sort key by value of ``rank_by``, smallest first. A kind has its own keys if it measures other quantities."""


def rank_designs(
    designs: Sequence[Ranked],
    rank_by: str,
    own: Mapping[str, Callable[[Ranked], float]] | None = None,
    *,
    group: Callable[[Ranked], float] | None = None,
    ties: Callable[[Ranked], float] = get_quality_key,
) -> list[Ranked]:
    """Sort designs in the requested order; designs that fail a check come last.

    Parameters
    ----------
    designs : sequence
        Verified designs.
    rank_by : str
        Name of the sort key.
    own : mapping, optional
        Sort keys of the kind, which replace or extend :data:`SORT_KEYS`.
    group : callable, optional
        Key that precedes the requested order: designs with a smaller value always come first.
    ties : callable
        Key that decides between designs that are equal in the requested order; by default the quality.
    """
    key = {**SORT_KEYS, **(own or {})}[rank_by]
    return sort_designs(designs, *([group] if group else []), key, ties)


def sort_designs(designs: Iterable[Ranked], *keys: Callable[[Ranked], float]) -> list[Ranked]:
    """Sort designs by several keys, in order of precedence, smallest first; designs that fail a check come last.

    Equal designs keep their order.
    """
    return sorted(designs, key=lambda design: (not design.verification.passed, *_list_values(design, keys)))


def select_best(designs: Iterable[Ranked], *keys: Callable[[Ranked], float]) -> Ranked:
    """Return the design with the smallest keys, in order of precedence, whether or not it passed."""
    return min(designs, key=lambda design: _list_values(design, keys))


def _list_values(design: Ranked, keys: Iterable[Callable[[Ranked], float]]) -> list[float]:
    return [key(design) for key in keys]


def move_to_front(first: Sequence[Ranked], designs: Sequence[Ranked]) -> list[Ranked]:
    """Return the designs with ``first`` moved to the front."""
    # Compare by identity: designs with equal values are still different entries.
    chosen = {id(design) for design in first}
    return [*first, *(design for design in designs if id(design) not in chosen)]
