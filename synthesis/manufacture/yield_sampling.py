"""Yield of a linkage: the share of manufactured linkages that are good, estimated by driven samples.

A sample is good if it can be assembled at every target, stays on its branch, and satisfies the quality at every target
as well as any tolerances of the task itself. If pins have a clearance, each sample has its own play at each target. All
designs of an answer use the same samples, so that their yields differ by the designs and not by chance.

The interval is that of Clopper and Pearson, The use of confidence or fiducial limits illustrated in the case of the
binomial, Biometrika 26 (1934) 404: it contains the true yield with at least the nominal confidence, for any true yield.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv

from kinematics.arrays import Complex, Real
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


def sample_play(product: ManufacturedLinkage, clearance: float, samples: int, seed: int, target: int) -> Real:
    """Sample the effect of clearances at a target, as changes of the dimensions, shape (samples, n).

    The centre of each pin lies anywhere in a disc of radius ``clearance`` around that of its hole, with equal
    probability, and anew at each target. At a given input, the clearances at O2 and A shift A as a shift of O2 does,
    and those at B and O4 act as a shift of O4; on a slide, the clearance at B shifts its line.
    """
    rng = np.random.default_rng((seed, target))

    def sample_pin() -> Complex:
        return np.asarray(
            clearance * np.sqrt(rng.uniform(size=samples)) * np.exp(2j * np.pi * rng.uniform(size=samples))
        )

    task = product.task
    shifts = np.zeros((samples, task.dimensions))
    crank = sample_pin() + sample_pin()
    shifts[:, 0], shifts[:, 1] = crank.real, crank.imag
    if task.slides:
        # The offset is that of O2 from the line, which moves with O2 unless the offset changes as well.
        shifts[:, 2] = ((crank - sample_pin()) * np.conj(1j * task.slide_direction)).real
    else:
        output = sample_pin() + sample_pin()
        shifts[:, 2], shifts[:, 3] = output.real, output.imag
    return shifts


def count_good(product: ManufacturedLinkage, variants: Real, clearance: float = 0.0, seed: int = 0) -> int:
    """Count the good variants (v, n) of a linkage whose pins have a clearance."""
    if clearance == 0.0:
        return int(np.count_nonzero(_mark_good(product, variants)))
    good = np.arange(len(variants))
    for target in range(len(product.task.inputs)):
        # Clearances differ from target to target, so each one is driven alone.
        moved = variants[good] + sample_play(product, clearance, len(variants), seed, target)[good]
        good = good[_mark_good(product.select_target(target), moved)]
    return len(good)


def _mark_good(product: ManufacturedLinkage, variants: Real) -> NDArray[np.bool_]:
    """Return a mask of the good variants (v, n) of a linkage."""
    # If the task gives no tolerances, the compiled maximum error as a share of its limit decides, without deviations.
    if not product.has_own_tolerances:
        return np.asarray(measure_shares(product.task, variants) <= 1.0 + LIMIT_SLACK)
    good = np.zeros(len(variants), np.bool_)
    distance, angle = np.array(product.task.units) * (1.0 + LIMIT_SLACK)
    for begin in range(0, len(variants), BATCH_SIZE):
        batch = slice(begin, begin + BATCH_SIZE)
        off = measure_deviations(product.task, variants[batch])
        kept = ((off.distances <= distance) & (off.angles <= angle)).all(axis=1)
        good[batch] = kept & product.mark_within_own_tolerances(off.offsets)
    return good


def sample_yield(product: ManufacturedLinkage, block: Exactness, seed: int) -> Yield:
    """Sample the yield of a linkage with a required quality."""
    off = list_errors(block, product.linkage.mark_pivots(guides=product.task.guides))
    share = sample_errors(block.distribution, seed, block.samples, len(off))
    count = count_good(product, product.nominal_dimensions + share * off, get_clearance(block), seed)
    low, high = compute_interval(count, block.samples)
    return Yield(value=count / block.samples, low=low, high=high, samples=block.samples)


def get_clearance(block: Exactness) -> float:
    """Return the clearance of the pins; 0 without one."""
    return 0.0 if block.tolerances is None else block.tolerances.pin_clearance


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
