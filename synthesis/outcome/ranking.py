"""Which of several sound designs to offer first, and which to leave out because they are nearly the same.

``quality`` weighs what a designer looks at before anything else: how well force is transmitted, whether the linkage is
small for its task, and whether its links can be built together. docs/ranking.md explains the numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synthesis.model.linkage_answer import LinkageDesign

Ranked = TypeVar("Ranked", bound=LinkageDesign)

BULKY = 3.0
"""A reach of this many task sizes halves the quality: such a linkage is large for what it does."""

UNEVEN = 8.0
"""A link ratio of this halves the quality; practice keeps link ratios below about 10."""


@njit(cache=True, nogil=True)
def quality(transmission_sine: float, reach: float, link_ratio: float) -> float:
    """Quality between 0 and 1.

    Parameters
    ----------
    transmission_sine : float
        Sine of the least transmission angle over the used range.
    reach : float
        Longest link or coupler side, in task sizes.
    link_ratio : float
        Longest link over shortest.
    """
    return transmission_sine / ((1.0 + (reach / BULKY) ** 2) * (1.0 + (link_ratio / UNEVEN) ** 2))


def distinct(joints: NDArray[np.complex128], count: int, apart: float) -> list[int]:
    """Greedy choice of candidates that differ: each has some joint ``apart`` from where every one before has it.

    Parameters
    ----------
    joints : complex, shape (candidates, joints)
        Joints in the first position, best candidate first.
    count : int
        How many to choose at most.
    apart : float
        Least distance, in the unit of ``joints``.

    Returns
    -------
    list of int
        Chosen rows, best first.
    """
    return [int(k) for k in _distinct(np.ascontiguousarray(joints), count, apart)]


@njit(cache=True, nogil=True)
def _distinct(joints: NDArray[np.complex128], count: int, apart: float) -> NDArray[np.int64]:
    chosen = np.empty(min(count, len(joints)), np.int64)
    found = 0
    for i in range(len(joints)):
        if found == len(chosen):
            break
        differs = True
        for j in chosen[:found]:
            gap = 0.0
            for k in range(joints.shape[1]):
                gap = max(gap, abs(joints[i, k] - joints[j, k]))
            if gap < apart:
                differs = False
                break
        if differs:
            chosen[found] = i
            found += 1
    return chosen[:found]


_KEYS: dict[str, Callable[[LinkageDesign], float]] = {
    "quality": lambda design: -design.metrics.quality,
    "accuracy": lambda design: max(target.residual for target in design.targets),
    "size": lambda design: design.metrics.size,
    "transmission_angle": lambda design: -design.metrics.min_transmission_angle,
}


def ranked(designs: Sequence[Ranked], rank_by: str) -> list[Ranked]:
    """Designs in the order asked for, those that break a check after all others; ties by quality."""

    def key(design: Ranked) -> tuple[bool, float, float]:
        value = _KEYS[rank_by](design)
        if rank_by == "accuracy":
            value = math.floor(math.log10(max(value, 1e-12)))  # residuals at rounding level are all alike
        return (not design.verification.passed, value, -design.metrics.quality)

    return sorted(designs, key=key)
