"""A design over its cycle: which inputs it is driven to, and the analysis there."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import TypeAdapter

from kinematics.linkage.branches import cycle
from kinematics.linkage.limits import branches, holding_reference
from kinematics.linkage.mechanism import Mechanism, TopologyError
from synthesis.analyses import analysis
from synthesis.mechanisms import GivenMechanism

MOST_EFFORT = 200
"""The most that is done in an answer that a client waits for; some seconds."""

_GIVEN: TypeAdapter[GivenMechanism] = TypeAdapter(GivenMechanism)


def over_the_cycle(mechanism: dict[str, Any], steps: int) -> dict[str, Any]:
    """The answer of an analysis of a design's mechanism (as JSON has it) over its cycle, with the input at speed 1.

    Raises
    ------
    MechanismError
        For a mechanism that does not exist, which no design is.
    """
    given = _GIVEN.validate_python(mechanism).mechanism()
    low, high = cycle_of(given)
    at = np.linspace(low, high, steps + 1)
    return {"time": None, **analysis(given, _stated(given, at), np.ones(steps + 1), 0.0)}


def effort(mechanism: Mechanism) -> int:
    """A measure of the work that the circuits of a mechanism are: closures × assemblies × turns of a cycle.

    A dyad closes two links, or one link and a slide, and has two assemblies. An eightbar has an effort of 24.
    """
    dyads = max(len(mechanism.links) - 2 + len(mechanism.slides) - len(mechanism.gears), 0) // 2
    return dyads * (1 << dyads) * round(cycle(mechanism) / (2.0 * math.pi))


def cycle_of(mechanism: Mechanism) -> tuple[float, float]:
    """First and last input of the cycle, radians, or lengths along the input slide.

    From the reference through a full turn (or as many as the gears need) where the input is a crank, else from toggle
    to toggle of the reference's branch. Where the branch is not known (its reference is at a toggle of several, or the
    circuits cannot be listed) a full turn too: ``valid`` then tells where the mechanism exists.
    """
    at = float(mechanism.reference_input)
    try:
        here = holding_reference(mechanism, branches(mechanism))
    except TopologyError:
        here = None
    if here is None or here.full:
        return at, at + cycle(mechanism)
    low = here.low
    if not mechanism.driven_by_slide:
        # Branches are known to full turns, and the turn counts: the reference lies on it.
        low = at - float(np.mod(at - here.low, cycle(mechanism)))
    return low, low + here.high - here.low


def _stated(mechanism: Mechanism, at: NDArray[np.float64]) -> NDArray[np.float64]:
    return at if mechanism.driven_by_slide else np.degrees(at)
