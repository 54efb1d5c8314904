"""Estimate of a gear train search's size from the problem alone, and the limit above which it is refused."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from synthesis.kinds.gear_train.stated_stages import GEARS, StatedStage
from synthesis.kinds.gear_train.stated_train import StatedTrain
from synthesis.model.statement import Contradiction

MOST_HALVES = 10_000_000
"""Maximum number of choices of the drivers (or driven gears) of all stages; 0.8 GB of memory for both."""

FEW_TRAINS = 20_000_000
"""Maximum number of trains that are enumerated one by one."""

MOST_COAXIAL = 3_000_000_000
"""Maximum number of combinations of all stages but one in a search of coaxial trains; a minute or two."""

MOST_FITTED = 500
"""Maximum number of tooth numbers whose pairs are fitted to a range of distances; some 10⁵ pairs."""

HALVES = MOST_HALVES, "choices of drivers or driven gears"
COAXIAL = MOST_COAXIAL, "combinations of meshes"
"""Limits with their units: for trains whose stages have distances of their own, and for coaxial ones."""


def beyond_search(stated: StatedTrain) -> list[Contradiction]:
    """Return a contradiction if the search is too large; the lists of the train must suit its stages."""
    k = stated.most_stages
    field = "/teeth" if stated.teeth is not None or not _is_given(stated) else "/stages"
    if stated.stock is not None:
        widths, field = [len(stated.stocked())] * (2 * k), "/stock"
    else:
        widths = [high - low + 1 for low, high in stated.position_ranges()]
    if stated.shares_distance and max(widths) > MOST_FITTED:
        detail = f"{max(widths)} tooth numbers are given; at most {MOST_FITTED} can be fitted in pairs"
        return [Contradiction(field, f"{detail} to an open distance; narrow the range or give the distance")]
    covered, most, what = _extent(stated, widths)
    if covered <= most:
        return []
    detail = f"about {float(covered):.0e} {what} in {k} stages exceed the limit of {most:.0e}"
    return [Contradiction(field, f"{detail}; narrow the tooth numbers or allow fewer stages")]


def _extent(stated: StatedTrain, widths: list[int]) -> tuple[int, int, str]:
    """Estimate the size of a search; return it with its maximum and its unit.

    ``widths`` are the numbers of tooth numbers of driver and driven gear of each stage.
    """
    k = stated.most_stages
    if stated.stages is not None and not _are_alike(stated, stated.stages):
        most, what = COAXIAL if stated.reverted else HALVES
        return _of_unlike_stages(stated, widths), most, what
    if stated.reverted:
        meshes = max(widths) * len(stated.exact_modules())
        if not stated.is_fitted and stated.stages is None and not isinstance(stated.teeth, list):
            return _of_shared_distances(stated), *COAXIAL
        if not stated.is_fitted:
            return 2 * meshes * math.comb(meshes + k - 2, k - 1), *COAXIAL
        # A given distance leaves the sums of teeth that a shift can compensate; an open one leaves all pairs.
        meshes *= max(widths) if stated.shares_distance else _sums(stated)
        return math.comb(meshes + k - 2, k - 1), *COAXIAL
    if isinstance(stated.teeth, list):
        return max(math.prod(widths[0::2]), math.prod(widths[1::2])), *HALVES
    return math.comb(max(widths[:2]) + k - 1, k), *HALVES


def _of_shared_distances(stated: StatedTrain) -> int:
    """Count the choices of meshes for all stages but one, over the distances, if all stages have the same gears."""
    low, high = stated.position_ranges()[0]
    numbers = stated.stocked() if stated.stock is not None else range(low, high + 1)
    # Indicator of the available tooth numbers.
    present = np.zeros(max(numbers) + 1, np.int64)
    present[list(numbers)] = 1
    meshes: Counter[int] = Counter()
    # The convolution counts the pairs of each sum a + b, which with the pitch determines the distance.
    for total, pairs in enumerate(np.convolve(present, present).tolist()):
        for pitch in stated.pitches() if pairs else []:
            meshes[pitch * total] += pairs
    others = stated.most_stages - 1
    return sum(math.comb(count + others - 1, others) for count in meshes.values())


def _is_given(stated: StatedTrain) -> bool:
    """Return whether the stages give all of their gears."""
    return all(stage.limits(name) is not None for stage in stated.stages or [] for name in GEARS)


def _are_alike(stated: StatedTrain, stages: list[StatedStage]) -> bool:
    """Return whether gears may be in any of the stages, so that each choice of them is searched in one order only."""
    ranges = stated.position_ranges()
    # Modules or distances of their own make stages unlike although their gears are alike.
    own = stated.is_fitted and (stated.has_own_modules or isinstance(stated.centre_distance, list))
    return not own and len(set(ranges[0::2])) == len(set(ranges[1::2])) == len({s.likeness for s in stages}) == 1


def _of_unlike_stages(stated: StatedTrain, widths: list[int]) -> int:
    """Estimate the search of unlike stages: the product of every stage's own choices."""
    modules, pairs = len(stated.exact_modules()), list(zip(widths[0::2], widths[1::2], strict=True))
    shifted = _sums(stated) if stated.is_fitted else 1
    meshes = [min(pair) * modules * shifted for pair in pairs]
    if stated.shares_distance:
        meshes = [one * two * modules for one, two in pairs]
    choices = math.prod(meshes[:-1])
    if stated.reverted:
        # Each distance that every stage has allows its own choices of all stages but one.
        return choices if stated.is_fitted else choices * min(sum(pair) for pair in pairs) * modules
    halves = max(math.prod(widths[0::2]), math.prod(widths[1::2]))
    # Few fitted meshes are combined directly instead.
    return min(halves, MOST_HALVES) if stated.is_fitted and choices <= FEW_TRAINS else halves


def _sums(stated: StatedTrain) -> int:
    """Return the number of sums of teeth that a fitted pair may have at one distance.

    Both gears may be shifted, and one module of distance corresponds to two teeth more in the sum.
    """
    low, high = stated.shift_limits
    return math.ceil(4.0 * (high - low)) + 1
