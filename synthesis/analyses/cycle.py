"""The cycle of a linkage: the range of inputs that shows all of its motion, and the effort of following it."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.branches import Branch, cycle, cycle_on, most_turns
from kinematics.linkage.planar.limits import branches, holding_reference
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError

MAX_EFFORT = 200
"""Greatest effort of an answer that a client waits for: some seconds."""


def effort(mechanism: Mechanism) -> int:
    """The effort of listing the circuits of a mechanism: closures × assemblies × turns of a cycle.

    A dyad closes two links, or one link and a slide, and has two assemblies. The turns are those of the fastest link
    that gears tie to the input. An eightbar has an effort of 24.
    """
    dyads = max(len(mechanism.links) - 2 + len(mechanism.slides) - len(mechanism.gears), 0) // 2
    return dyads * (1 << dyads) * round(most_turns(mechanism))


def listed_branches(mechanism: Mechanism) -> list[Branch]:
    """All branches of a mechanism, the reference's circuit first.

    Raises
    ------
    TopologyError
        Where they cannot be listed, or not while a client waits.
    """
    if effort(mechanism) > MAX_EFFORT:
        raise TopologyError("too many assemblies, or too many turns until the motion repeats, to list all circuits")
    return branches(mechanism)


def branch_of(mechanism: Mechanism) -> Branch | None:
    """The branch of the reference; None where it stands at a toggle of several, or the circuits cannot be listed."""
    try:
        return holding_reference(mechanism, listed_branches(mechanism))
    except TopologyError:
        return None


def cycle_of(mechanism: Mechanism) -> tuple[float, float]:
    """First and last input of the cycle, radians, or lengths along the input slide; see :func:`cycle_along`."""
    return cycle_along(mechanism, branch_of(mechanism))


def cycle_along(mechanism: Mechanism, here: Branch | None) -> tuple[float, float]:
    """First and last input of the cycle on the reference's branch, radians, or lengths along the input slide.

    From the reference through a full turn (or as many as gears or a triad need) where the input is a crank, else from
    toggle to toggle of the reference's branch. Where the branch is not known a full turn too, and as far as the
    mechanism is wide where a slider drives it: ``valid`` then tells where the mechanism exists.
    """
    at = float(mechanism.reference_input)
    if (here is None or here.full) and mechanism.driven_by_slide:
        places = np.array([complex(joint) for joint in mechanism.joints.values()])
        half = 0.5 * float(np.abs(places[:, None] - places).max())
        return at - half, at + half
    if here is None or here.full:
        return at, at + (cycle(mechanism) if here is None else cycle_on(mechanism, here))
    low = here.low
    if not mechanism.driven_by_slide:
        # Branches are known to full turns, and the turn counts: the reference lies on it.
        low = at - float(np.mod(at - here.low, cycle(mechanism)))
    return low, low + here.high - here.low
