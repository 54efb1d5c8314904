"""Circuits, branches, toggles and limit positions of any mechanism: the one door to them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.branches import GRID, Branch, cycle, dyadic_branches, roots_of_rate
from kinematics.linkage.closures import decompose
from kinematics.linkage.drive import MechanismMotion, assembly_signs, drive
from kinematics.linkage.mechanism import Mechanism
from kinematics.linkage.other_driver import branches_by_other_driver

Real = NDArray[np.float64]

SAME_TOGGLE = 1e-8
"""Toggles closer than this (radians, or task units along a slide) are listed once."""


def branches(mechanism: Mechanism) -> list[Branch]:
    """All branches of one design, circuit by circuit, the reference's circuit first.

    Raises
    ------
    TopologyError
        Where neither its input nor another pair of links closes the mechanism by dyads.
    """
    if decompose(mechanism).left or mechanism.driven_by_slide:
        return branches_by_other_driver(mechanism)
    return dyadic_branches(mechanism)


def toggles(mechanism: Mechanism, found: list[Branch]) -> list[float]:
    """Inputs of all toggles, ascending, each once: radians in [0, cycle), or positions along the input slide."""
    ends = [x for branch in found if not branch.full for x in (branch.low, branch.high)]
    if not mechanism.driven_by_slide:
        ends = [float(np.mod(x, cycle(mechanism))) for x in ends]
    ends.sort()
    return [x for n, x in enumerate(ends) if n == 0 or x - ends[n - 1] > SAME_TOGGLE]


def stationary(
    mechanism: Mechanism, quantity: Callable[[MechanismMotion], Real], low: float, high: float
) -> list[float]:
    """Inputs between low and high, on the reference's branch, where a quantity stands still: its limit positions.

    ``quantity`` takes a motion and returns a real jet, shape (n, N), e.g. a link's angle.
    """
    grid = np.linspace(low, high, GRID)
    rate = quantity(drive(mechanism, grid, order=1))[1]

    def jet(at: Real) -> tuple[Real, Real]:
        found = quantity(drive(mechanism, at, order=2))
        return found[1], found[2]

    return [float(x) for x in roots_of_rate(jet, grid, rate)]


def holding_reference(mechanism: Mechanism, found: list[Branch]) -> Branch | None:
    """The branch that the reference configuration lies on; None where the reference is at a toggle of several."""
    at = float(mechanism.reference_input)
    steps = decompose(mechanism)
    period = np.inf if mechanism.driven_by_slide else cycle(mechanism)
    for branch in found:
        offset = at - branch.low if mechanism.driven_by_slide else float(np.mod(at - branch.low, period))
        if not -SAME_TOGGLE <= offset <= branch.high - branch.low + SAME_TOGGLE:
            continue
        if branch.signs:
            choice = [
                int(s)
                for s, step in zip(assembly_signs(mechanism, steps.steps), steps.steps, strict=True)
                if step.has_two_solutions
            ]
            if tuple(choice) == branch.signs:
                return branch
        elif branch.full or _reaches_just(mechanism, at - offset, at - offset + branch.high - branch.low):
            return branch
    return None


def _reaches_just(mechanism: Mechanism, low: float, high: float) -> bool:
    """Whether the motion from the reference reaches nearly to both ends and not beyond."""
    hair = 1e-6 * (high - low)
    valid = drive(mechanism, np.array([low - hair, low + hair, high - hair, high + hair]), order=0).valid
    return bool(np.array_equal(valid, [False, True, True, False]))


def limit_positions(
    mechanism: Mechanism, branch: Branch, quantity: Callable[[MechanismMotion], Real], *, turns: bool
) -> tuple[float, float] | None:
    """Least and greatest value of a quantity on the reference's branch; None for an angle that turns through.

    Parameters
    ----------
    mechanism : Mechanism
        One design.
    branch : Branch
        The branch that holds its reference.
    quantity : callable
        Takes a motion, returns a real jet of shape (n, N).
    turns : bool
        Whether the quantity is an angle, known to full turns only.
    """
    at = float(mechanism.reference_input)
    low = branch.low
    if not mechanism.driven_by_slide:
        low = at - float(np.mod(at - branch.low, cycle(mechanism)))
    high = low + branch.high - branch.low
    grid = np.linspace(low, high, GRID)
    inputs = np.unique(np.concatenate([grid, stationary(mechanism, quantity, low, high)]))
    value = quantity(drive(mechanism, inputs, order=0))[0]
    value = value[np.isfinite(value)]
    if not len(value):
        return None
    if turns:
        value = np.unwrap(value)
        if branch.full and abs(value[-1] - value[0]) > np.pi:
            return None
        value = value - 2.0 * np.pi * np.round(value[0] / (2.0 * np.pi))
    return float(value.min()), float(value.max())
