"""Circuits, branches, toggles and limit positions of any mechanism."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.linkage.planar.branches import Branch, compute_cycle, compute_cycle_on_branch, find_dyadic_branches
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import drive, drive_one, find_assembly_signs, is_reachable
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError
from kinematics.linkage.planar.other_driver import find_branches_by_other_driver
from kinematics.linkage.planar.program import build_program
from kinematics.linkage.planar.roots import find_roots, find_sign_changes

GRID_SIZE = 720
"""Number of inputs along the branch at which limit positions are searched."""

END_OFFSETS = 4.0 ** -np.arange(17.0, 5.0, -1.0)
"""Distances of additional samples from the ends of a branch, as shares of its length, from 6e-11 on. Near a toggle
angles go with the root of the distance, and rounding decides whether a position exists at the toggle itself."""

SMOOTH_END_INDICES = 8, 11
"""Indices into :data:`END_OFFSETS` of two samples, at 4e-6 and 2e-4 of the length. Towards a toggle rates grow with the
inverse root of the distance, by 8 between these; towards a change point they stay nearly equal, and samples nearer than
the first are dominated by rounding."""

MAX_RATE_GROWTH = 3.0
"""Growth of the rates between these two samples up to which an end is a change point and not a toggle."""

MIN_RATE = 1e-9
"""Share of the largest rate below which a rate counts as zero."""

TOGGLE_TOLERANCE = 1e-8
"""Distance (radians, or task units along a slide) below which two toggles are the same."""


def find_branches(mechanism: Mechanism) -> list[Branch]:
    """Find all branches of one design, circuit by circuit, the reference's circuit first.

    Raises
    ------
    TopologyError
        If neither the input nor another pair of links closes the mechanism by dyads, or if constraints are redundant.
    """
    if mechanism.redundant:
        raise TopologyError("kinematics-circuits-unknown-if-redundant")
    if decompose(mechanism).left or mechanism.has_slide_input:
        return find_branches_by_other_driver(mechanism)
    return find_dyadic_branches(mechanism)


def list_toggles(mechanism: Mechanism, branches: list[Branch]) -> list[float]:
    """List the inputs of all toggles, ascending, each once: radians in [0, cycle), or positions along the input
    slide."""
    ends = [x for branch in branches if not branch.full for x in (branch.low, branch.high)]
    if not mechanism.has_slide_input:
        ends = [float(np.mod(x, compute_cycle(mechanism))) for x in ends]
    ends.sort()
    return [x for n, x in enumerate(ends) if n == 0 or x - ends[n - 1] > TOGGLE_TOLERANCE]


def find_reference_branch(mechanism: Mechanism, branches: list[Branch]) -> Branch | None:
    """Find the branch of the reference configuration; None if the reference is at a toggle of several branches.

    In ``branches`` the reference's circuit must come first, as in :func:`find_branches`.
    """
    at = float(mechanism.reference_input)
    steps = decompose(mechanism)
    period = np.inf if mechanism.has_slide_input else compute_cycle(mechanism)
    for branch in branches:
        length = branch.high - branch.low
        # A slide's position does not repeat, an angle does.
        offset = at - branch.low if mechanism.has_slide_input else float(np.mod(at - branch.low, period))
        if not -TOGGLE_TOLERANCE <= offset <= length + TOGGLE_TOLERANCE:
            continue
        if branch.signs:
            choice = [
                int(s)
                for s, step in zip(find_assembly_signs(mechanism, steps.steps), steps.steps, strict=True)
                if step.has_two_solutions
            ]
            if tuple(choice) == branch.signs:
                return branch
        elif branch.full and not steps.left and not mechanism.has_slide_input:
            return branch  # no closures: the input alone determines every link
        elif branch.full:
            if is_reachable(mechanism, np.array([at - period, at + period])).all():
                return branch
        else:
            # A branch longer than a turn contains the reference's input more than once.
            again = np.arange(0.0, length + TOGGLE_TOLERANCE - offset, period)
            if any(_is_exact_range(mechanism, low, low + length) for low in at - offset - again):
                return branch
    return None


def find_cycle_from_reference(mechanism: Mechanism) -> float:
    """Find the input rotation after which a mechanism returns to its reference configuration.

    With a triad it depends on the branch. If the reference's branch is unknown or not full, the result is that of
    :func:`~.branches.compute_cycle`.
    """
    if mechanism.has_slide_input or not decompose(mechanism).left:
        return compute_cycle(mechanism)
    try:
        here = find_reference_branch(mechanism, find_branches(mechanism))
    except TopologyError:
        here = None
    return compute_cycle(mechanism) if here is None or not here.full else compute_cycle_on_branch(mechanism, here)


def _is_exact_range(mechanism: Mechanism, low: float, high: float) -> bool:
    """Return whether the motion from the reference reaches both ends of a range and not beyond them."""
    # Just inside and just outside both ends.
    hair = 1e-6 * (high - low)
    inputs = np.array([low - hair, low + hair, high - hair, high + hair])
    there = drive(mechanism, inputs, order=0).valid if mechanism.has_slide_input else is_reachable(mechanism, inputs)
    return bool(np.array_equal(there, [False, True, True, False]))


def find_limit_positions(
    mechanism: Mechanism, branch: Branch, links: Sequence[str], slides: Sequence[str]
) -> tuple[list[tuple[float, float] | None], list[tuple[float, float] | None]]:
    """Find the minimum and maximum angles of links, and positions of slides, on the reference's branch.

    They occur at the ends of the branch, or where a rate vanishes, which is found as a root. A value at an end is
    extrapolated from the nearest known position, at the distance d, by 2 d × rate. This is exact for a value that
    changes with the root of the distance from a toggle, up to terms proportional to d, which are negligible where the
    value is smooth. At a change point all values are smooth, but rounding spoils the nearest positions: there a farther
    one is extrapolated by d × rate.

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
    if not mechanism.has_slide_input:
        low = at - float(np.mod(at - branch.low, compute_cycle(mechanism)))
    high = low + branch.high - branch.low

    def evaluate_quantities(inputs: Real, order: int) -> Real:
        """Evaluate the jets of all quantities, shape (order + 1, quantities, inputs)."""
        motion = drive_one(mechanism, inputs[None], signs, order)
        return np.stack([*(motion.angles[n] for n in links), *(motion.slides[n] for n in slides)], axis=1)[:, :, 0]

    if not links and not slides:
        return [], []
    program = build_program(mechanism)
    own = program.signs or [1] * len(program.code.rows)
    signs = np.array(own, np.int64).reshape(-1, 1)
    near = (high - low) * END_OFFSETS
    grid = np.concatenate([low + near, np.linspace(low, high, GRID_SIZE)[1:-1], high - near[::-1]])
    values, rate = evaluate_quantities(grid, 1)
    known = np.flatnonzero(np.isfinite(rate).all(axis=0))
    ends = np.empty((len(values), 0))
    if len(known) and not branch.full:
        smooth = _find_smooth_ends(rate)
        outer, power = known[[0, -1]], np.where(smooth, 1.0, 2.0)
        nearest = SMOOTH_END_INDICES[0]
        outer = np.where(smooth, [nearest, len(grid) - 1 - nearest], outer)
        ends = values[:, outer] + power * rate[:, outer] * (np.array([low, high]) - grid[outer])
        if smooth.any():
            kept = slice(nearest if smooth[0] else 0, len(grid) - nearest if smooth[1] else len(grid))
            grid, values, rate = grid[kept], values[:, kept], rate[:, kept]
    changes = [(row, n) for row in range(len(rate)) for n in find_sign_changes(rate[row])]
    if changes:
        of = np.array([row for row, _ in changes]), np.arange(len(changes))
        left = np.array([grid[n] for _, n in changes])
        right = np.array([grid[n + 1] for _, n in changes])
        at_left, at_right = (np.array([rate[row][n + k] for row, n in changes]) for k in (0, 1))
        roots = find_roots(lambda inputs: evaluate_quantities(inputs, 1)[1][of], left, right, at_left, at_right)[0]
        first = np.unique(np.concatenate([grid, roots]), return_index=True)[1]
        values = np.concatenate([values, evaluate_quantities(roots, 0)[0]], axis=1)[:, first]
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


def _find_smooth_ends(rate: Real) -> NDArray[np.bool_]:
    """Return whether all rates, shape (quantities, inputs), are smooth towards the first and the last input."""
    near, far = (np.abs(rate[:, [k, -1 - k]]) for k in SMOOTH_END_INDICES)
    # Values that do not change have rates of rounding only.
    scale = np.nanmax(np.abs(rate), axis=1, initial=0.0)[:, None]
    growing = near > MAX_RATE_GROWTH * np.maximum(far, MIN_RATE * scale)
    return np.asarray(np.isfinite(near).all(axis=0) & ~growing.any(axis=0))
