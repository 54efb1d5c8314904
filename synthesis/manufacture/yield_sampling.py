"""Yield of a linkage: the share of manufactured linkages that are good, estimated by driven samples.

A sample is good if it can be assembled at every target, stays on its branch, and satisfies the quality at every target
as well as any tolerances of the task itself. All designs of an answer use the same samples, so that their yields differ
by the designs and not by chance.

The interval is that of Clopper and Pearson, The use of confidence or fiducial limits illustrated in the case of the
binomial, Biometrika 26 (1934) 404: it contains the true yield with at least the nominal confidence, for any true yield.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from kinematics.arrays import Real
from kinematics.linkage.variation import measure_deviations, measure_shares
from synthesis.manufacture.linkage import LIMIT_SLACK, ManufacturedLinkage
from synthesis.model.manufacture.answer import Yield
from synthesis.model.manufacture.request import CONFIDENCE_LEVEL, Exactness

BATCH_SIZE = 8192
"""Number of samples driven at once if their deviations are needed; it limits the memory."""


def list_errors(requested: Exactness, pivots: NDArray[np.bool_]) -> Real:
    """Return the tolerance of each dimension, shape (n,): that of pivots where ``pivots`` is True, else of lengths."""
    tolerances = requested.tolerances
    assert tolerances is not None
    return np.where(pivots, tolerances.pivot, tolerances.length)


# Designs of one answer share the samples; the cache holds those of a few requests.
@lru_cache(maxsize=4)
def sample_errors(distribution: str, seed: int, samples: int, dimensions: int) -> Real:
    """Sample the errors of each dimension as shares of its tolerance.

    The result, shape (samples, dimensions), is read-only.
    """
    rng = np.random.default_rng(seed)
    shape = samples, dimensions
    # The tolerance is three standard deviations of a normal distribution.
    share = rng.uniform(-1.0, 1.0, shape) if distribution == "uniform" else rng.standard_normal(shape) / 3.0
    # Callers share the cached array, so it must not be changed.
    share.flags.writeable = False
    return share


def count_good(product: ManufacturedLinkage, variants: Real) -> int:
    """Count the good variants (v, n) of a linkage."""
    # If the task gives no tolerances, the compiled maximum error as a share of its limit decides, without deviations.
    if not product.has_own_tolerances:
        return int(np.count_nonzero(measure_shares(product.task, variants) <= 1.0 + LIMIT_SLACK))
    count = 0
    distance, angle = np.array(product.task.units) * (1.0 + LIMIT_SLACK)
    for begin in range(0, len(variants), BATCH_SIZE):
        off = measure_deviations(product.task, variants[begin : begin + BATCH_SIZE])
        kept = ((off.distances <= distance) & (off.angles <= angle)).all(axis=1)
        count += int(np.count_nonzero(kept & product.mark_within_own_tolerances(off.offsets)))
    return count


def sample_yield(product: ManufacturedLinkage, block: Exactness, seed: int) -> Yield:
    """Sample the yield of a linkage with a required quality."""
    off = list_errors(block, product.linkage.mark_pivots(guides=product.task.guides))
    share = sample_errors(block.distribution, seed, block.samples, len(off))
    count = count_good(product, product.nominal_dimensions + share * off)
    low, high = compute_interval(count, block.samples)
    return Yield(value=count / block.samples, low=low, high=high, samples=block.samples)


def compute_interval(count: int, samples: int, confidence: float = CONFIDENCE_LEVEL) -> tuple[float, float]:
    """Compute the confidence interval of a share of which ``count`` of ``samples`` were counted (Clopper and Pearson).

    >>> low, high = compute_interval(0, 10, 0.95)
    >>> low, round(high, 4)
    (0.0, 0.3085)
    """
    tail = 0.5 * (1.0 - confidence)
    # For a count of none or all, the beta distribution has no such quantile, and the interval ends at 0 or 1.
    low = 0.0 if count == 0 else float(betaincinv(count, samples - count + 1, tail))
    high = 1.0 if count == samples else float(betaincinv(count + 1, samples - count, 1.0 - tail))
    return low, high
