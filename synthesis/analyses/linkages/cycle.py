"""Cycle of a linkage, the range of inputs that contains its whole motion, and the effort of computing it."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from kinematics.linkage.planar.branches import Branch, compute_cycle, compute_cycle_on_branch, count_fastest_turns
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError
from kinematics.message import compose
from synthesis.model.linkage.answer import UsedRange

MAX_EFFORT = 200
"""Maximum effort of an analysis for which a client waits: a few seconds."""


def estimate_effort(mechanism: Mechanism) -> int:
    """Estimate the effort of listing the circuits of a mechanism: closures × assemblies × turns of a cycle.

    A dyad consists of two links, or of a link and a slide, and has two assemblies. The turns are those of the fastest
    link that is geared to the input. An eightbar has an effort of 24.
    """
    dyads = max(len(mechanism.links) - 2 + len(mechanism.slides) - len(mechanism.gears), 0) // 2
    return dyads * (1 << dyads) * round(count_fastest_turns(mechanism))


def list_branches(mechanism: Mechanism) -> list[Branch]:
    """List all branches of a mechanism, the reference's circuit first.

    Raises
    ------
    TopologyError
        If they cannot be listed, or if this takes too long for a waiting client.
    """
    if estimate_effort(mechanism) > MAX_EFFORT:
        raise TopologyError(compose("analyses-too-many-circuits"))
    return find_branches(mechanism)


def find_branch(mechanism: Mechanism) -> Branch | None:
    """Find the branch of the reference; None at a toggle of several branches, or if circuits cannot be listed."""
    try:
        return find_reference_branch(mechanism, list_branches(mechanism))
    except TopologyError:
        return None


def find_built_range(
    mechanism: Mechanism, used: tuple[float, float] | None, over: Literal["used", "cycle"] | None = None
) -> tuple[float, float] | None:
    """Find the range of the input that a built linkage must move through without interference, in ascending order.

    Parameters
    ----------
    mechanism : Mechanism
        One design, in its reference configuration.
    used : pair of float or None
        The range over which it was verified, radians or positions along the input slide.
    over : str, optional
        Whether the used range or the full cycle counts. Default: the cycle of an input that turns fully, and of a
        linkage without a used range.

    Returns
    -------
    pair of float or None
        None if ``over`` requests a used range that does not exist.
    """
    branch = find_branch(mechanism)
    turns = not mechanism.has_slide_input and branch is not None and branch.full
    if over == "cycle" or (over is None and (turns or used is None)):
        used = find_cycle_along(mechanism, branch)
    return None if used is None else (min(used), max(used))


def get_used_range(metrics: object) -> tuple[float, float] | None:
    """Return the range over which a design was verified, radians or positions along the input slide, by its metrics.

    It is None for metrics without such a range.
    """
    if not isinstance(metrics, UsedRange):
        return None
    if metrics.used_range is not None:
        return math.radians(metrics.used_range[0]), math.radians(metrics.used_range[1])
    return metrics.used_stroke


def find_cycle(mechanism: Mechanism) -> tuple[float, float]:
    """Find the first and the last input of the cycle; see :func:`find_cycle_along`."""
    return find_cycle_along(mechanism, find_branch(mechanism))


def find_cycle_along(mechanism: Mechanism, here: Branch | None) -> tuple[float, float]:
    """Find the first and the last input of the cycle on a branch, radians, or lengths along the input slide.

    For a crank the cycle is a full turn from the reference, or as many turns as gears or a triad need. For any other
    input it extends from toggle to toggle of the branch of the reference, ``here``. If the branch is unknown (None), it
    is a full turn, or for a driving slider a range as wide as the mechanism; ``valid`` in the answer then shows where
    the mechanism can be assembled.
    """
    at = float(mechanism.reference_input)
    if (here is None or here.full) and mechanism.has_slide_input:
        places = np.array([complex(joint) for joint in mechanism.joints.values()])
        half = 0.5 * float(np.abs(places[:, None] - places).max())
        return at - half, at + half
    if here is None or here.full:
        return at, at + (compute_cycle(mechanism) if here is None else compute_cycle_on_branch(mechanism, here))
    low = here.low
    if not mechanism.has_slide_input:
        # The ends of a branch are known up to whole cycles: shift them so that the reference lies between them.
        low = at - float(np.mod(at - here.low, compute_cycle(mechanism)))
    return low, low + here.high - here.low
