"""Circuits, branches, toggles and limit positions of any mechanism."""

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
"""Number of inputs along the branch at which limit positions are searched."""

TOWARDS_END = 4.0 ** -np.arange(17.0, 5.0, -1.0)
"""Additional sample distances from the ends of a branch, as shares of it, from 6e-11 on: at a toggle angles go with the
root of the distance, and rounding decides whether a position exists."""

SAME_TOGGLE = 1e-8
"""Distance (radians, or task units along a slide) below which two toggles are the same."""


def branches(mechanism: Mechanism) -> list[Branch]:
    """Find all branches of one design, circuit by circuit, the reference's circuit first.

    Raises
    ------
    TopologyError
        If neither its input nor another pair of links closes the mechanism by dyads, or constraints are redundant.
    """
    if mechanism.redundant:
        raise TopologyError("the constraints are redundant; circuits are known only without redundant constraints")
    if decompose(mechanism).left or mechanism.driven_by_slide:
        return branches_by_other_driver(mechanism)
    return dyadic_branches(mechanism)


def toggles(mechanism: Mechanism, branches: list[Branch]) -> list[float]:
    """List the inputs of all toggles, ascending, each once: radians in [0, cycle), or positions along the input
    slide."""
    ends = [x for branch in branches if not branch.full for x in (branch.low, branch.high)]
    if not mechanism.driven_by_slide:
        ends = [float(np.mod(x, cycle(mechanism))) for x in ends]
    ends.sort()
    return [x for n, x in enumerate(ends) if n == 0 or x - ends[n - 1] > SAME_TOGGLE]


def holding_reference(mechanism: Mechanism, branches: list[Branch]) -> Branch | None:
    """Find the branch of the reference configuration; None if the reference is at a toggle of several branches.

    In ``branches`` the reference's circuit must come first, as in :func:`branches`.
    """
    at = float(mechanism.reference_input)
    steps = decompose(mechanism)
    period = np.inf if mechanism.driven_by_slide else cycle(mechanism)
    for branch in branches:
        length = branch.high - branch.low
        # A slide's position does not repeat, an angle does.
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
            return branch  # no closures: the input alone determines every link
        elif branch.full:
            if followed_to(mechanism, np.array([at - period, at + period])).all():
                return branch
        else:
            # A branch longer than a turn contains the reference's input more than once.
            again = np.arange(0.0, length + SAME_TOGGLE - offset, period)
            if any(_reaches_just(mechanism, low, low + length) for low in at - offset - again):
                return branch
    return None


def cycle_from_reference(mechanism: Mechanism) -> float:
    """Find the input rotation after which a mechanism returns to its reference configuration.

    With a triad it depends on the branch; if the reference's branch is unknown or not full, the result is that of
    :func:`~.branches.cycle`.
    """
    if mechanism.driven_by_slide or not decompose(mechanism).left:
        return cycle(mechanism)
    try:
        here = holding_reference(mechanism, branches(mechanism))
    except TopologyError:
        here = None
    return cycle(mechanism) if here is None or not here.full else cycle_on(mechanism, here)


def _reaches_just(mechanism: Mechanism, low: float, high: float) -> bool:
    """Return whether the motion from the reference reaches both ends of a range and not beyond them."""
    # Just inside and just outside both ends.
    hair = 1e-6 * (high - low)
    inputs = np.array([low - hair, low + hair, high - hair, high + hair])
    there = drive(mechanism, inputs, order=0).valid if mechanism.driven_by_slide else followed_to(mechanism, inputs)
    return bool(np.array_equal(there, [False, True, True, False]))


def limit_positions(
    mechanism: Mechanism, branch: Branch, links: Sequence[str], slides: Sequence[str]
) -> tuple[list[tuple[float, float] | None], list[tuple[float, float] | None]]:
    """Find the minimum and maximum angles of links, and positions of slides, on the reference's branch.

    They occur at the ends of the branch, or where a rate vanishes, found as a root. The value at an end is extrapolated
    from the nearest known position, at the distance d, by 2 d × rate: exact for a value that changes with the root of
    the distance from a toggle, up to terms proportional to d, which are negligible where the value is smooth.

    Parameters
    ----------
    mechanism : Mechanism
        One design.
    branch : Branch
        The branch that contains its reference.
    links, slides : names
        Links, and slides by their names.

    Returns
    -------
    of_links, of_slides : lists
        Radians and lengths, in the order of the names; None for a link that rotates fully.
    """
    at = float(mechanism.reference_input)
    low = branch.low
    if not mechanism.driven_by_slide:
        low = at - float(np.mod(at - branch.low, cycle(mechanism)))
    high = low + branch.high - branch.low

    def quantities(inputs: Real, order: int) -> Real:
        """Evaluate the jets of all quantities, shape (order + 1, quantities, inputs)."""
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
            # Angles are known modulo full turns only.
            value = np.unwrap(value)
            if branch.full and abs(value[-1] - value[0]) > np.pi:
                spans.append(None)
                continue
            value = value - 2.0 * np.pi * np.round(value[0] / (2.0 * np.pi))
        spans.append((float(value.min()), float(value.max())))
    return spans[: len(links)], spans[len(links) :]
