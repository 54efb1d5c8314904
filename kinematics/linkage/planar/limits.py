"""Circuits, branches, toggles and limit positions of any mechanism: the one door to them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.branches import Branch, cycle, cycle_on, dyadic_branches
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import assembly_signs, drive, drive_one, followed_to
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError
from kinematics.linkage.planar.other_driver import branches_by_other_driver
from kinematics.linkage.planar.program import program_of
from kinematics.linkage.planar.roots import find_roots, sign_changes

Real = NDArray[np.float64]

GRID = 720
"""Inputs along the branch at which limit positions are looked for."""

TOWARDS_END = 4.0 ** -np.arange(17.0, 5.0, -1.0)
"""Distances from the ends of a branch at which it is looked at too, as parts of it, from 6e-11 on: at a toggle, where
angles go with the root of the distance, rounding decides whether there is a position."""

SAME_TOGGLE = 1e-8
"""Toggles closer than this (radians, or task units along a slide) are listed once."""


def branches(mechanism: Mechanism) -> list[Branch]:
    """All branches of one design, circuit by circuit, the reference's circuit first.

    Raises
    ------
    TopologyError
        Where neither its input nor another pair of links closes the mechanism by dyads, or constraints are redundant.
    """
    if mechanism.redundant:
        raise TopologyError("constraints are redundant; circuits are known of mechanisms that have just what they need")
    if decompose(mechanism).left or mechanism.driven_by_slide:
        return branches_by_other_driver(mechanism)
    return dyadic_branches(mechanism)


def toggles(mechanism: Mechanism, branches: list[Branch]) -> list[float]:
    """Inputs of all toggles, ascending, each once: radians in [0, cycle), or positions along the input slide."""
    ends = [x for branch in branches if not branch.full for x in (branch.low, branch.high)]
    if not mechanism.driven_by_slide:
        ends = [float(np.mod(x, cycle(mechanism))) for x in ends]
    ends.sort()
    return [x for n, x in enumerate(ends) if n == 0 or x - ends[n - 1] > SAME_TOGGLE]


def holding_reference(mechanism: Mechanism, branches: list[Branch]) -> Branch | None:
    """The branch that the reference configuration lies on; None where the reference is at a toggle of several.

    Of ``branches``, the reference's circuit comes first, as in :func:`branches`.
    """
    at = float(mechanism.reference_input)
    steps = decompose(mechanism)
    period = np.inf if mechanism.driven_by_slide else cycle(mechanism)
    for branch in branches:
        length = branch.high - branch.low
        offset = at - branch.low if mechanism.driven_by_slide else float(np.mod(at - branch.low, period))
        if not -SAME_TOGGLE <= offset <= length + SAME_TOGGLE:
            continue
        if branch.signs:
            choice = [
                int(s)
                for s, step in zip(assembly_signs(mechanism, steps.steps), steps.steps, strict=True)
                if step.has_two_solutions
            ]
            if tuple(choice) == branch.signs:
                return branch
        elif branch.full and not steps.left and not mechanism.driven_by_slide:
            return branch  # nothing closes: the input alone says where every link is
        elif branch.full:
            if followed_to(mechanism, np.array([at - period, at + period])).all():
                return branch
        else:
            # More than a turn long, the branch has the reference's input more than once.
            again = np.arange(0.0, length + SAME_TOGGLE - offset, period)
            if any(_reaches_just(mechanism, low, low + length) for low in at - offset - again):
                return branch
    return None


def cycle_from_reference(mechanism: Mechanism) -> float:
    """Input rotation after which a mechanism is back in its reference configuration; with a triad its branch says that.

    Where the reference's branch is not known, or not full, that of :func:`~.branches.cycle`.
    """
    if mechanism.driven_by_slide or not decompose(mechanism).left:
        return cycle(mechanism)
    try:
        here = holding_reference(mechanism, branches(mechanism))
    except TopologyError:
        here = None
    return cycle(mechanism) if here is None or not here.full else cycle_on(mechanism, here)


def _reaches_just(mechanism: Mechanism, low: float, high: float) -> bool:
    """Whether the motion from the reference reaches nearly to both ends and not beyond."""
    hair = 1e-6 * (high - low)
    inputs = np.array([low - hair, low + hair, high - hair, high + hair])
    there = drive(mechanism, inputs, order=0).valid if mechanism.driven_by_slide else followed_to(mechanism, inputs)
    return bool(np.array_equal(there, [False, True, True, False]))


def limit_positions(
    mechanism: Mechanism, branch: Branch, links: Sequence[str], slides: Sequence[str]
) -> tuple[list[tuple[float, float] | None], list[tuple[float, float] | None]]:
    """Least and greatest angles of links, and positions of slides, on the reference's branch.

    They stand at the ends of the branch, or where a rate vanishes, found as a root. At an end the value is that
    of the nearest known position, at the distance d, and twice d times the rate there: with the root of the distance
    from a toggle the value changes so but for a part in proportion to d, and where it is smooth that is so anyway.

    Parameters
    ----------
    mechanism : Mechanism
        One design.
    branch : Branch
        The branch that holds its reference.
    links, slides : names
        Links, and slides by their names.

    Returns
    -------
    of_links, of_slides : lists
        Radians and lengths, in the order of the names; None for a link that turns through.
    """
    at = float(mechanism.reference_input)
    low = branch.low
    if not mechanism.driven_by_slide:
        low = at - float(np.mod(at - branch.low, cycle(mechanism)))
    high = low + branch.high - branch.low

    def quantities(inputs: Real, order: int) -> Real:
        """Jets of all quantities, shape (order + 1, quantities, inputs)."""
        motion = drive_one(mechanism, inputs[None], signs, order)
        return np.stack([*(motion.angles[n] for n in links), *(motion.slides[n] for n in slides)], axis=1)[:, :, 0]

    if not links and not slides:
        return [], []
    program = program_of(mechanism)
    own = program.signs or [1] * len(program.code.rows)
    signs = np.array(own, np.int64).reshape(-1, 1)
    near = (high - low) * TOWARDS_END
    grid = np.concatenate([low + near, np.linspace(low, high, GRID)[1:-1], high - near[::-1]])
    values, rate = quantities(grid, 1)
    known = np.flatnonzero(np.isfinite(rate).all(axis=0))
    ends = np.empty((len(values), 0))
    if len(known) and not branch.full:
        outer = known[[0, -1]]
        ends = values[:, outer] + 2.0 * rate[:, outer] * (np.array([low, high]) - grid[outer])
    changes = [(row, n) for row in range(len(rate)) for n in sign_changes(rate[row])]
    if changes:
        of = np.array([row for row, _ in changes]), np.arange(len(changes))
        left = np.array([grid[n] for _, n in changes])
        right = np.array([grid[n + 1] for _, n in changes])
        at_left, at_right = (np.array([rate[row][n + k] for row, n in changes]) for k in (0, 1))
        roots = find_roots(lambda inputs: quantities(inputs, 1)[1][of], left, right, at_left, at_right)[0]
        first = np.unique(np.concatenate([grid, roots]), return_index=True)[1]
        values = np.concatenate([values, quantities(roots, 0)[0]], axis=1)[:, first]
    values = np.concatenate([ends[:, :1], values[:, np.isfinite(values).all(axis=0)], ends[:, 1:]], axis=1)
    spans: list[tuple[float, float] | None] = []
    for row, value in enumerate(values):
        if row < len(links):
            value = np.unwrap(value)
            if branch.full and abs(value[-1] - value[0]) > np.pi:
                spans.append(None)
                continue
            value = value - 2.0 * np.pi * np.round(value[0] / (2.0 * np.pi))
        spans.append((float(value.min()), float(value.max())))
    return spans[: len(links)], spans[len(links) :]
