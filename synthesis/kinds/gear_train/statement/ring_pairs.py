"""Pairs of a pinion and a ring that run together.

The teeth of the ring are shortened to clear the pinion's fillet. A pinion runs in the ring if the tips of both still
pass each other, if the pinion does not reach the ring's own fillet, and if at least one pair of teeth is always in
contact. The cutter that shapes the ring must pass its tips as well, so that it does not trim them.
"""

from __future__ import annotations

import numpy as np

from kinematics.arrays import Mask, Real
from synthesis.kinds.gear_train.statement.stages import RequestedStage
from synthesis.model.gears import mesh_limits

MIN_CONTACT_RATIO = 1.0
"""Minimum contact ratio of a ring with its pinion: below it there are moments without contact."""

MIN_RING_ADDENDUM = 0.3
"""Minimum addendum of a ring's shortened teeth, modules."""


def find_running_pairs(pinion: Real, ring: Real, angle: float) -> Mask:
    """Return which pinions run in which rings, by their teeth; ``angle`` is the pressure angle, radians."""
    found = np.zeros(pinion.shape, np.bool_)
    inside = (pinion > 0) & (ring > pinion)
    one, two = pinion[inside], ring[inside]
    # Invalid pairs would only produce warnings and NaN.
    with np.errstate(invalid="ignore", divide="ignore"):
        short = mesh_limits.compute_ring_addendum(one, two, angle, fillets=True)
        sound = (short >= MIN_RING_ADDENDUM) & mesh_limits.has_clear_tips(one, two, short, angle)
        sound &= mesh_limits.compute_internal_contact_ratio(one, two, short, angle) >= MIN_CONTACT_RATIO
        sound &= mesh_limits.has_clear_ring_fillet(one, two, angle)
        sound &= mesh_limits.is_ring_untrimmed(two, short, angle)
    found[inside] = sound
    return found


def has_no_running_ring(stage: RequestedStage, angle: float) -> bool:
    """Return whether none of the given rings of an internal stage runs with a given pinion."""
    pairs = np.array(stage.list_given_pairs(), np.float64)
    if not len(pairs):
        return False
    pinion, ring = pairs.T[::-1] if stage.ring == "driver" else pairs.T
    return not find_running_pairs(pinion, ring, angle).any()
