"""The firing orders of an engine as the answer reports them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.engine.firing import ANGLE_TOLERANCE, compute_unevenness, list_firing_choices
from synthesis.kinds.engine.arrangement import Cylinders
from synthesis.kinds.engine.design import EngineFiring, FiringOrder
from synthesis.kinds.engine.problem import EngineProblem

MAX_ORDERS = 64
"""Maximum number of listed firing orders."""


def find_firing(problem: EngineProblem, cylinders: Cylinders) -> EngineFiring:
    """Find the most even firing orders; if requested, those with the fewest neighbours in succession come first."""
    found = list_firing_choices(cylinders.top, problem.stroke_cycle)
    orders: dict[tuple[int, ...], FiringOrder] = {}
    for angles in found.angles:
        listed = _build_order(angles, cylinders)
        # An order and its reverse count as one. The order that names the higher cylinder first represents both.
        known = orders.get(tuple(listed.reversed))
        if known is None or known.order < listed.order:
            orders.pop(tuple(listed.reversed), None)
            orders.setdefault(tuple(listed.order), listed)
    ranked = sorted(
        orders.values(), key=lambda one: (one.adjacent if problem.avoid_adjacent else 0, [-k for k in one.order[::-1]])
    )
    return EngineFiring(
        unevenness=found.unevenness,
        orders=ranked[:MAX_ORDERS],
        even_choices=len(found.angles),
        choices=found.choices,
        stated_unevenness=_measure_requested_unevenness(problem),
    )


def _measure_requested_unevenness(problem: EngineProblem) -> float | None:
    if problem.firing_angles is None:
        return None
    return float(compute_unevenness(np.array(problem.firing_angles), problem.cycle))


def _build_order(angles: Real, cylinders: Cylinders) -> FiringOrder:
    number = np.lexsort((np.arange(len(angles)), np.round(angles, 6)))
    order = [int(k) + 1 for k in number]
    return FiringOrder(
        order=order,
        reversed=[order[0], *order[:0:-1]],
        angles=[float(angles[k]) for k in number],
        adjacent=_count_adjacent(number, cylinders),
    )


def _count_adjacent(number: NDArray[np.int64], cylinders: Cylinders) -> int:
    """Count how often neighbours of a bank fire in succession, over the whole cycle."""
    if len(number) < 3:
        return 0
    following = np.roll(number, -1)
    same = np.abs(cylinders.axis[number] - cylinders.axis[following]) <= ANGLE_TOLERANCE
    # The rank of a cylinder in its bank is the number of distinct places before it.
    rows = [np.unique(cylinders.place[np.abs(cylinders.axis - axis) <= ANGLE_TOLERANCE]) for axis in cylinders.axis]
    rank = np.array([int((row < place).sum()) for row, place in zip(rows, cylinders.place, strict=True)])
    return int((same & (np.abs(rank[number] - rank[following]) == 1)).sum())


def list_firing_angles(firing: EngineFiring) -> Real:
    """Return the firing angles by cylinder, of the first listed order."""
    first = firing.orders[0]
    at = np.empty(len(first.order))
    at[np.array(first.order) - 1] = first.angles
    return at
