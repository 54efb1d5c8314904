"""Where a linkage is put whose place is free: with its pivots in their regions and its links within their limits."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from synthesis.model.linkage_statement import Constraints, Region
from synthesis.numerics.placing import Boxes, Placing, placed


def placement(
    constraints: Constraints,
    fixed: Sequence[complex],
    moving: Sequence[complex],
    lengths: Sequence[float] | None,
    preferred: complex,
    *,
    turned: bool = True,
) -> Placing:
    """The similarity that brings a linkage from its own frame to its place.

    Parameters
    ----------
    constraints : Constraints
        Whose regions and limits of length are to be kept.
    fixed, moving : sequence of complex
        Fixed pivots, and moving pivots in the first position.
    lengths : sequence of float or None
        Of the links; None where the size is given, which is then that of ``preferred``.
    preferred : complex
        Size and direction that are taken where they fit.
    turned : bool
        Whether the direction may be another one.
    """
    limits = constraints.link_length
    if limits is None and constraints.fixed_pivot_region is None and constraints.moving_pivot_region is None:
        return Placing(0j, preferred, True)
    least, most = 0.0, math.inf
    if lengths is None:
        least = most = abs(preferred)
    elif limits is not None:
        least = limits.min / min(lengths)
        most = math.inf if limits.max is None else limits.max / max(lengths)
    regions = [constraints.fixed_pivot_region] * len(fixed) + [constraints.moving_pivot_region] * len(moving)
    points = np.array([*fixed, *moving], np.complex128)
    return placed(points, boxes(regions), least, most, preferred, turned=turned)


def boxes(regions: Sequence[Region | None]) -> Boxes:
    """Regions of joints as numbers; infinite where there is none."""
    table = np.array(
        [(-math.inf, math.inf) * 2 if region is None else (*region.x, *region.y) for region in regions]
    ).reshape(-1, 4)
    return Boxes(*table.T)
