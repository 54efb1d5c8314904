"""Estimate of a gear train search's size from the problem alone, and the limit above which it is refused."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np

from kinematics.message import compose
from synthesis.kinds.gear_train.statement.stages import GEARS, RequestedStage
from synthesis.kinds.gear_train.statement.train import GearTrainBase
from synthesis.model.problem import Contradiction

MAX_HALVES = 10_000_000
"""Maximum number of choices of the drivers (or driven gears) of all stages; 0.8 GB of memory for both."""

MAX_ENUMERATED_TRAINS = 20_000_000
"""Maximum number of trains that are enumerated one by one."""

MAX_COAXIAL = 3_000_000_000
"""Maximum number of combinations of all stages but one in a search of coaxial trains, which takes a minute or two."""

MAX_FITTED = 500
"""Maximum number of tooth numbers whose pairs are fitted to a range of distances; some 10⁵ pairs."""

HALVES_LIMIT = MAX_HALVES, "gear_train-too-many-gear-choices"
COAXIAL_LIMIT = MAX_COAXIAL, "gear_train-too-many-mesh-combinations"
"""Limits with the message that a search exceeds them: for trains whose stages have distances of their own, and for
coaxial ones."""


def check_search_size(train: GearTrainBase) -> list[Contradiction]:
    """Return a contradiction if the search is too large; the lists of the train must suit its stages."""
    k = train.most_stages
    field = "/teeth" if train.teeth is not None or not _is_given(train) else "/stages"
    if train.stock is not None:
        widths, field = [len(train.count_stock())] * (2 * k), "/stock"
    else:
        widths = [high - low + 1 for low, high in train.list_position_ranges()]
    if train.shares_distance and max(widths) > MAX_FITTED:
        return [Contradiction(field, compose("gear_train-too-many-fitted", count=max(widths), limit=MAX_FITTED))]
    covered, most, excess = _estimate_extent(train, widths)
    if covered <= most:
        return []
    detail = compose(excess, covered=f"{float(covered):.0e}", stages=k, limit=f"{most:.0e}")
    return [Contradiction(field, detail)]


def _estimate_extent(train: GearTrainBase, widths: list[int]) -> tuple[int, int, str]:
    """Estimate the size of a search; return it with its maximum and the id of the message that it is exceeded.

    ``widths`` are the numbers of tooth numbers of driver and driven gear of each stage.
    """
    k = train.most_stages
    if train.stages is not None and not _has_like_stages(train, train.stages):
        most, excess = COAXIAL_LIMIT if train.reverted else HALVES_LIMIT
        return _count_unlike_stages(train, widths), most, excess
    if train.reverted:
        meshes = max(widths) * len(train.list_exact_modules())
        if not train.is_fitted and train.stages is None and not isinstance(train.teeth, list):
            return _count_shared_distances(train), *COAXIAL_LIMIT
        if not train.is_fitted:
            return 2 * meshes * math.comb(meshes + k - 2, k - 1), *COAXIAL_LIMIT
        # A given distance leaves the sums of teeth that a shift can compensate; an open one leaves all pairs.
        meshes *= max(widths) if train.shares_distance else _count_sums(train)
        return math.comb(meshes + k - 2, k - 1), *COAXIAL_LIMIT
    if isinstance(train.teeth, list):
        return max(math.prod(widths[0::2]), math.prod(widths[1::2])), *HALVES_LIMIT
    return math.comb(max(widths[:2]) + k - 1, k), *HALVES_LIMIT


def _count_shared_distances(train: GearTrainBase) -> int:
    """Count the choices of meshes for all stages but one, over the distances, if all stages have the same gears."""
    low, high = train.list_position_ranges()[0]
    numbers = train.count_stock() if train.stock is not None else range(low, high + 1)
    # Indicator of the available tooth numbers.
    present = np.zeros(max(numbers) + 1, np.int64)
    present[list(numbers)] = 1
    meshes: Counter[int] = Counter()
    # The convolution counts the pairs of each sum a + b, which with the pitch determines the distance.
    for total, pairs in enumerate(np.convolve(present, present).tolist()):
        for pitch in train.pitches() if pairs else []:
            meshes[pitch * total] += pairs
    others = train.most_stages - 1
    return sum(math.comb(count + others - 1, others) for count in meshes.values())


def _is_given(train: GearTrainBase) -> bool:
    """Return whether the stages give all of their gears."""
    return all(stage.limits(name) is not None for stage in train.stages or [] for name in GEARS)


def _has_like_stages(train: GearTrainBase, stages: list[RequestedStage]) -> bool:
    """Return whether gears may be in any of the stages, so that each choice of them is searched in one order only."""
    ranges = train.list_position_ranges()
    # Modules or distances of their own make stages unlike although their gears are alike.
    own = train.is_fitted and (train.has_own_modules or isinstance(train.centre_distance, list))
    return not own and len(set(ranges[0::2])) == len(set(ranges[1::2])) == len({s.likeness for s in stages}) == 1


def _count_unlike_stages(train: GearTrainBase, widths: list[int]) -> int:
    """Estimate the search of unlike stages: the product of every stage's own choices."""
    modules, pairs = len(train.list_exact_modules()), list(zip(widths[0::2], widths[1::2], strict=True))
    shifted = _count_sums(train) if train.is_fitted else 1
    meshes = [min(pair) * modules * shifted for pair in pairs]
    if train.shares_distance:
        meshes = [one * two * modules for one, two in pairs]
    choices = math.prod(meshes[:-1])
    if train.reverted:
        # Each distance that every stage has allows its own choices of all stages but one.
        return choices if train.is_fitted else choices * min(sum(pair) for pair in pairs) * modules
    halves = max(math.prod(widths[0::2]), math.prod(widths[1::2]))
    # Few fitted meshes are combined directly instead.
    return min(halves, MAX_HALVES) if train.is_fitted and choices <= MAX_ENUMERATED_TRAINS else halves


def _count_sums(train: GearTrainBase) -> int:
    """Return the number of sums of teeth that a fitted pair may have at one distance.

    Both gears may be shifted, and one module of distance corresponds to two teeth more in the sum.
    """
    low, high = train.shift_limits
    return math.ceil(4.0 * (high - low)) + 1
