"""Pinions that run in rings.

A pinion runs in a ring under these conditions: the ring, its teeth shortened to clear the pinion's fillet, still passes
the pinion's tips, is not reached in its own fillet, and keeps a pair of teeth in contact; and the cutter that shapes
the ring also passes its tips, so that it does not trim them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.gear_train.stated_stages import StatedStage
from synthesis.model import mesh_limits
from synthesis.model.mesh_limits import Real

Pairs = NDArray[np.bool_]

LEAST_CONTACT = 1.0
"""Contact ratio of a ring with its pinion: with less there are moments without contact."""

SHORTEST = 0.3
"""Minimum addendum of a ring's shortened teeth, modules."""


def run_in_rings(pinion: Real, ring: Real, angle: float) -> Pairs:
    """Return which pinions run in which rings, by their teeth; ``angle`` is the pressure angle, radians."""
    found = np.zeros(pinion.shape, np.bool_)
    inside = (pinion > 0) & (ring > pinion)
    one, two = pinion[inside], ring[inside]
    # Invalid pairs would only produce warnings and NaN.
    with np.errstate(invalid="ignore", divide="ignore"):
        short = mesh_limits.ring_addendum(one, two, angle, fillets=True)
        sound = (short >= SHORTEST) & mesh_limits.tips_clear(one, two, short, angle)
        sound &= mesh_limits.internal_contact(one, two, short, angle) >= LEAST_CONTACT
        sound &= mesh_limits.ring_fillet_clear(one, two, angle)
        sound &= mesh_limits.ring_untrimmed(two, short, angle)
    found[inside] = sound
    return found


def no_ring_runs(stage: StatedStage, angle: float) -> bool:
    """Return whether none of the given rings of an internal stage runs with a given pinion."""
    pairs = np.array(stage.given_pairs(), np.float64)
    if not len(pairs):
        return False
    pinion, ring = pairs.T[::-1] if stage.ring == "driver" else pairs.T
    return not run_in_rings(pinion, ring, angle).any()
