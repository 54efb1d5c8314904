"""The yield of a linkage: how many of those that a shop makes are good, by samples driven in compiled batches.

A sample is good where it can be assembled at every target, stays on its branch, and keeps the quality at every target;
where the task has tolerances of its own, those too. The samples of all designs of an answer are the same ones, so that
yields differ by their designs and not by chance.

The interval is that of Clopper and Pearson, The use of confidence or fiducial limits illustrated in the case of the
binomial, Biometrika 26 (1934) 404: it holds the true yield with at least the stated confidence, whatever that is.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from kinematics.linkage.variation import deviations, shares
from synthesis.manufacture.linkage import LIMIT_SLACK, Product
from synthesis.model.manufacture import CONFIDENCE, Exactness
from synthesis.model.manufacture_answer import Yield

Real = NDArray[np.float64]

BATCH = 8192
"""Samples that are driven at once where their deviations are looked at."""


def offs(stated: Exactness, pivots: NDArray[np.bool_]) -> Real:
    """How far each dimension may be off, by whether it is a place of a fixed pivot; shape (n,)."""
    tolerances = stated.tolerances
    assert tolerances is not None
    return np.where(pivots, tolerances.pivot, tolerances.length)


@lru_cache(maxsize=4)
def drawn(distribution: str, seed: int, samples: int, dimensions: int) -> Real:
    """Shares of its tolerance by which each dimension of each sample is off, shape (samples, dimensions); read-only."""
    rng = np.random.default_rng(seed)
    shape = samples, dimensions
    share = rng.uniform(-1.0, 1.0, shape) if distribution == "uniform" else rng.standard_normal(shape) / 3.0
    share.flags.writeable = False
    return share


def good(product: Product, variants: Real) -> int:
    """How many variants (v, n) of a linkage are good."""
    if not product.held_apart:
        return int(np.count_nonzero(shares(product.task, variants) <= 1.0 + LIMIT_SLACK))
    count = 0
    distance, angle = np.array(product.task.units) * (1.0 + LIMIT_SLACK)
    for begin in range(0, len(variants), BATCH):
        off = deviations(product.task, variants[begin : begin + BATCH])
        kept = ((off.distances <= distance) & (off.angles <= angle)).all(axis=1)
        count += int(np.count_nonzero(kept & product.keeps_own(off.offsets)))
    return count


def sampled_yield(product: Product, stated: Exactness, seed: int) -> Yield:
    """Sample the yield of a linkage with a required quality."""
    off = offs(stated, product.linkage.pivots(guides=product.task.guides))
    share = drawn(stated.distribution, seed, stated.samples, len(off))
    count = good(product, product.nominal + share * off)
    low, high = interval(count, stated.samples)
    return Yield(value=count / stated.samples, low=low, high=high, samples=stated.samples)


def interval(count: int, samples: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """The interval of a share of which ``count`` of ``samples`` were met (Clopper and Pearson 1934).

    >>> low, high = interval(0, 10, 0.95)
    >>> low, round(high, 4)
    (0.0, 0.3085)
    """
    tail = 0.5 * (1.0 - confidence)
    low = 0.0 if count == 0 else float(betaincinv(count, samples - count + 1, tail))
    high = 1.0 if count == samples else float(betaincinv(count + 1, samples - count, 1.0 - tail))
    return low, high
