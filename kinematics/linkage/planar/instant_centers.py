"""Instant centres of any planar mechanism: the points that have the same velocity on two links.

A link that turns at ω and moves a point z at velocity v moves every point p at v + iω(p − z). The velocities of two
links agree at

    p = z + i (v − w) / (ω − σ),   w = velocity of z as a point of the other link, which turns at σ,

if their angular velocities differ (Norton, Sec. 6.3; Kennedy's theorem follows). If they are equal the centre lies at
infinity, normal to v − w.
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.linkage.planar.drive import MechanismMotion
from kinematics.linkage.planar.mechanism import GROUND, Mechanism

PARALLEL_TOLERANCE = 1e-9
"""Difference of angular velocities, as a share of the fastest link's, below which two links only translate."""


class InstantCenter(NamedTuple):
    """Instant centre of two links; ``finite`` is False, and the point NaN, where they only translate relatively."""

    point: Complex
    finite: NDArray[np.bool_]


def find_instant_centers(mechanism: Mechanism, motion: MechanismMotion) -> dict[tuple[str, str], InstantCenter]:
    """Find all n(n − 1)/2 instant centres of a mechanism in motion, by pairs of links in the mechanism's order.

    Parameters
    ----------
    mechanism : Mechanism
        Designs of shape S.
    motion : MechanismMotion
        Its motion with at least one derivative; arrays of shape S + (N,).

    Returns
    -------
    dict
        Points in the mechanism's coordinates, shape S + (N,); NaN at toggles and where the mechanism cannot be
        assembled.
    """
    still = np.zeros_like(motion.input[1])
    spins: dict[str, Real] = {name: motion.angles[name][1] if name != GROUND else still for name in mechanism.links}
    # Scale of the angular velocities, so that the test is relative.
    fastest = np.max(np.abs(np.stack(list(spins.values()))), axis=0)
    centers = {}
    for first, second in combinations(mechanism.links, 2):
        z, velocity = (motion.joints[mechanism.links[first][0]][k] for k in (0, 1))
        base, base_velocity = (motion.joints[mechanism.links[second][0]][k] for k in (0, 1))
        carried = base_velocity + 1j * spins[second] * (z - base)
        gap = spins[first] - spins[second]
        with np.errstate(divide="ignore", invalid="ignore"):
            finite = np.abs(gap) > PARALLEL_TOLERANCE * fastest
            point = np.where(finite, z + 1j * (velocity - carried) / gap, np.complex128(complex(np.nan, np.nan)))
        centers[(first, second)] = InstantCenter(point, finite & motion.smooth)
    return centers
