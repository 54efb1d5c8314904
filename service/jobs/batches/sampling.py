"""The values that the fields of a batch have: lists, ranges, and samples of a Latin hypercube."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from service.loading import IMPORTS


@dataclass(frozen=True)
class Span:
    """All numbers from one to another."""

    begin: float
    end: float


Varied = Sequence[Any] | Span


def evenly(begin: float, end: float, count: int) -> list[float]:
    """So many numbers from one to another, both among them; whole ones where the ends and all between are whole.

    >>> evenly(10, 30, 3), evenly(0, 1, 3)
    ([10, 20, 30], [0, 0.5, 1])
    """
    if count == 1:
        return [begin]
    if isinstance(begin, int) and isinstance(end, int) and (end - begin) % (count - 1) == 0:
        step = (end - begin) // (count - 1)
        return [begin + step * k for k in range(count)]
    return [begin, *(begin + (end - begin) * (k / (count - 1)) for k in range(1, count - 1)), end]


def latin_hypercube(varied: Sequence[Varied], samples: int, seed: int) -> list[list[Any]]:
    """Values of each field, drawn so that each of ``samples`` equal parts of its range, or of its list, has one.

    SciPy's Latin hypercube (McKay, Beckman & Conover 1979, DOI 10.2307/1268522), with the seed.
    """
    with IMPORTS:
        from scipy.stats import qmc
    shares = qmc.LatinHypercube(d=len(varied), rng=seed).random(samples)
    return [[_at(values, float(share)) for share in column] for values, column in zip(varied, shares.T, strict=True)]


def _at(values: Varied, share: float) -> Any:
    if isinstance(values, Span):
        return values.begin + (values.end - values.begin) * share
    return values[min(int(share * len(values)), len(values) - 1)]
