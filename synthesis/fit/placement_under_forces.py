"""Placement of a fourbar with free direction and size within limits on its forces.

The weight of a linkage grows with its size, and the pin forces due to a torque decrease with it; gravity has a
direction. Sizes and directions are evaluated on a grid, all at once.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from synthesis.fit.fourbar_forces import compute_min_margins
from synthesis.fit.placement_in_workspace import MovingFourbar
from synthesis.numerics.box_placement import Placement

SIZE_COUNT, TURN_COUNT = 49, 12
"""Numbers of sizes and directions of the grid."""

MAX_SIZE_FACTOR = 10.0
"""Maximum ratio of a size to the preferred one, or of the preferred one to a size, unless a limit of length is
narrower."""

TURN_WEIGHT = 0.05
"""Weight of a rotation by one radian relative to the logarithm of a size, in the distance between placements."""


def place_under_forces(
    forces: Real, linkage: MovingFourbar, sizes: tuple[float, float], preferred: Placement
) -> Placement:
    """Find the placement nearest to a preferred one within the limits, or the one with the smallest violation.

    Parameters
    ----------
    forces : float, shape (m,)
        Limits packed by :func:`synthesis.fit.fourbar_forces.pack_forces` with the origin 0 and one length unit as the
        size.
    linkage : MovingFourbar
        The fourbar, without a coupler point.
    sizes : pair of float
        Minimum and maximum length of the ground link.
    preferred : Placement
        A placement that ignores the limits: returned if it satisfies them.
    """
    size, direction = abs(preferred.along), float(np.angle(preferred.along))
    low, high = max(sizes[0], size / MAX_SIZE_FACTOR), min(sizes[1], size * MAX_SIZE_FACTOR)
    # min and max keep the preferred size in the grid even if it is outside the limits.
    logs = np.linspace(math.log(min(low, size) / size), math.log(max(high, size) / size), SIZE_COUNT)
    turns = math.tau / TURN_COUNT * np.arange(TURN_COUNT)
    # The preferred size itself is always a grid point, so that the unchanged placement comes first.
    grown, turned = (each.ravel() for each in np.meshgrid(np.append(logs, 0.0), turns))
    away = np.abs(grown) + TURN_WEIGHT * np.abs(np.remainder(turned + math.pi, math.tau) - math.pi)
    # Sort by distance from the preferred placement: the first feasible one is then the nearest.
    nearest = np.argsort(away, kind="stable")
    grown, turned = grown[nearest], turned[nearest]
    charts = np.zeros((len(grown), 9))
    charts[:, 0], charts[:, 1] = preferred.origin.real, preferred.origin.imag
    charts[:, 2] = direction + turned
    lengths = size * np.exp(grown)[:, None] * linkage.lengths
    # The kernels expect the end at the first target first.
    first, last = linkage.ends if linkage.first == linkage.ends[0] else linkage.ends[::-1]
    ends = np.tile([first, last], (len(grown), 1))
    # Evaluate the preferred placement alone first; in most cases it suffices.
    margins = compute_min_margins(charts[:1], lengths[:1], linkage.sign, ends[:1], forces)
    if margins[0] < 0.0:
        margins = compute_min_margins(charts, lengths, linkage.sign, ends, forces)
    kept = np.flatnonzero(margins >= 0.0)
    # If no placement is feasible, take the one with the smallest violation.
    best = int(kept[0]) if len(kept) else int(np.argmax(margins))
    along = size * math.exp(grown[best]) * complex(math.cos(charts[best, 2]), math.sin(charts[best, 2]))
    return preferred._replace(along=along)
