"""Allocation of the widest tolerances with which a linkage still has the required yield.

The cost of a tolerance t is assumed to be proportional to 1/t (Chase and Greenwood, Design issues in mechanical
tolerance analysis, Manufacturing Review 1 (1988) 50). To first order, the squares of all errors add up to Σ s t², with
s from the exact derivatives. For a given sum, the cheapest tolerances have t ∝ s^(−1/3) if each dimension has its own
tolerance, and t ∝ (n/s)^(1/3) if n dimensions share one. This gives the proportions of the tolerances. Their common
factor, the width, is found by bisection with driven samples, as for the yield. The result is verified by all samples.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.manufacture.linkage import ManufacturedLinkage
from synthesis.manufacture.yield_sampling import compute_interval, count_good, get_clearance, sample_errors
from synthesis.model.manufacture.answer import Allocation, Yield
from synthesis.model.manufacture.request import Exactness

MAX_WIDENING = 10.0
"""Maximum widening of a given tolerance, as a factor: a larger one would be unrealistic for that shop."""

MAX_ROUGH_SAMPLES = 10_000
"""Maximum number of samples in the search for the width."""

BISECTION_COUNT = 9
"""Number of bisections of a factor of two; they determine the width to a seventh of a per cent."""

MAX_DOUBLINGS = 8
"""Maximum number of doublings or halvings in the search for the width."""

NARROWING_FACTOR, MAX_TRIES = 0.98, 25
"""Factor by which the width is reduced if all samples together do not prove the required yield, and maximum number of
tries."""


def find_widest_tolerances(
    made: ManufacturedLinkage, block: Exactness, seed: int, squares: Real, off: Real
) -> list[Allocation]:
    """Find the widest tolerances with the required yield, cheapest allocation first.

    Parameters
    ----------
    made : ManufacturedLinkage
        The linkage with its targets.
    block : Exactness
        The block of the request, with a quality and a required yield.
    seed : int
        Seed of the samples.
    squares : float, shape (n,)
        Contribution of each dimension to the sum of squares of all errors, per square of its tolerance.
    off : float, shape (n,)
        Given tolerances; those of 0 remain 0.

    Returns
    -------
    list of Allocation
        Empty if no tolerances give the required yield.
    """
    assert block.quality is not None
    demanded = block.quality.yield_
    open_ones = off > 0.0
    if demanded is None or not open_ones.any():
        return []
    pivots = made.linkage.mark_pivots(guides=made.task.guides)
    found = []
    for by, shape in (
        ("dimension", _allocate_by_dimension(squares, open_ones)),
        ("sort", _allocate_by_sort(squares, open_ones, pivots)),
        ("scale", off),
    ):
        scaled = _scale_tolerances(made, block, seed, demanded, shape, off)
        if scaled is None:
            continue
        tolerances, share = scaled
        # The mean cost 1/t, relative to that of the given tolerances.
        cost = float(np.mean(off[open_ones] / tolerances[open_ones]))
        named = {name: float(t) for name, t in zip(made.list_names, tolerances, strict=True)}
        found.append(Allocation(by=by, tolerances=named, cost=cost, yield_=share))
    return sorted(found, key=lambda one: one.cost)


def _allocate_by_dimension(squares: Real, open_ones: NDArray[np.bool_]) -> Real:
    known = np.where(squares > 0.0, squares, np.nan)
    # A dimension without influence would get an infinite tolerance. It gets that of the least influential dimension.
    least = float(np.nanmin(known)) if np.isfinite(known).any() else 1.0
    return np.where(open_ones, np.where(squares > 0.0, squares, least) ** (-1.0 / 3.0), 0.0)


def _allocate_by_sort(squares: Real, open_ones: NDArray[np.bool_], pivots: NDArray[np.bool_]) -> Real:
    shape = np.zeros(len(squares))
    for sort in (open_ones & pivots, open_ones & ~pivots):
        if sort.any():
            # The floor avoids a division by 0 if no dimension of the sort has any influence.
            shape[sort] = (np.count_nonzero(sort) / max(float(squares[sort].sum()), 1e-300)) ** (1.0 / 3.0)
    return shape


def _scale_tolerances(
    made: ManufacturedLinkage, block: Exactness, seed: int, demanded: float, shape: Real, off: Real
) -> tuple[Real, Yield] | None:
    """Find the widest tolerances of a given proportion, and their yield; None if even the smallest are too wide."""
    rough = min(block.samples, MAX_ROUGH_SAMPLES)
    # Scale the proportions to the given tolerances, so that a width of 1 is a sensible start.
    unit = shape * float(np.median(off[off > 0.0] / shape[off > 0.0]))

    def compute_tolerances(width: float) -> Real:
        return np.minimum(width * unit, MAX_WIDENING * off)

    def count(width: float, samples: int) -> int:
        # Every width uses the same samples, so that the yield is nearly monotonic in the width.
        share = sample_errors(block.distribution, seed, samples, len(off))
        variants = made.nominal_dimensions + share * compute_tolerances(width)
        return count_good(made, variants, get_clearance(block), seed)

    def has_required_yield(width: float) -> bool:
        # Fewer samples suffice for the search; the final check uses all of them.
        return count(width, rough) >= demanded * rough

    # Bracket the width by factors of two, up or down from the given tolerances.
    low = high = 1.0
    if has_required_yield(low):
        for _ in range(MAX_DOUBLINGS):
            high *= 2.0
            if not has_required_yield(high):
                break
            low = high
    else:
        for _ in range(MAX_DOUBLINGS):
            high, low = low, 0.5 * low
            if has_required_yield(low):
                break
        # Even the smallest width fails, because the nominal design itself is too close to its limits.
        else:
            return None
    for _ in range(BISECTION_COUNT):
        # The width is a factor, so bisect by the geometric mean.
        middle = math.sqrt(low * high)
        low, high = (middle, high) if has_required_yield(middle) else (low, middle)
    for _ in range(MAX_TRIES):
        kept = count(low, block.samples)
        ends = compute_interval(kept, block.samples)
        # The lower end of the confidence interval must satisfy the requirement, not only the estimate.
        if ends[0] >= demanded:
            value = kept / block.samples
            return compute_tolerances(low), Yield(value=value, low=ends[0], high=ends[1], samples=block.samples)
        low *= NARROWING_FACTOR
    return None
