"""Values of the varied fields of a batch: lists, ranges and Latin hypercube samples."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from service.jobs.batches.values import PickedValues, Values
from service.loading import IMPORTS


@dataclass(frozen=True)
class Span:
    """A closed interval of numbers."""

    begin: float
    end: float


Varied = Values | Span


def sample_evenly(begin: float, end: float, count: int) -> Sequence[float]:
    """Return ``count`` evenly spaced numbers including both ends; integers if all of them are whole.

    >>> sample_evenly(10, 30, 3), sample_evenly(0, 1, 3)
    ([10, 20, 30], array('d', [0.0, 0.5, 1.0]))
    """
    if count == 1:
        return [begin]
    if isinstance(begin, int) and isinstance(end, int) and (end - begin) % (count - 1) == 0:
        step = (end - begin) // (count - 1)
        return [begin + step * k for k in range(count)]
    # Both ends are copied, not computed: rounding must not move them.
    between = (begin + (end - begin) * (k / (count - 1)) for k in range(1, count - 1))
    return array("d", [begin, *between, end])


def sample_latin_hypercube(varied: Sequence[Varied], samples: int, seed: int) -> list[Values]:
    """Draw values of each field, one from each of ``samples`` equal parts of its range or of its list.

    Uses SciPy's Latin hypercube (McKay, Beckman & Conover 1979, DOI 10.2307/1268522) with the given seed.
    """
    with IMPORTS:
        from scipy.stats import qmc
    shares = qmc.LatinHypercube(d=len(varied), rng=seed).random(samples)
    return [_map_shares(values, column.tolist()) for values, column in zip(varied, shares.T, strict=True)]


def _map_shares(values: Varied, shares: Sequence[float]) -> Values:
    if isinstance(values, Span):
        return array("d", [values.begin + (values.end - values.begin) * share for share in shares])
    count = len(values)
    # Rounding may give a share of exactly 1, which belongs to the last element.
    return PickedValues(values, array("H", [min(int(share * count), count - 1) for share in shares]))
