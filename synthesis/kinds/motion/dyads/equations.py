"""Dyads that carry the body through its positions, determined by as many conditions as a dyad has freedoms.

A dyad is a link from a fixed pivot O to a moving pivot A on the body; O and A (in the first position) are its four
unknown numbers. With A_k = c_k + r_k A the image of A in position k (r_k = e^{iα_k}, c_k = P_k − r_k P_1) the link
keeps its length when |A_k − O|² = |A − O|². The squares of A and of O cancel,

    Re(conj(c_k) r_k A) − Re(conj(O) (A_k − A)) + |c_k|²/2 = 0,

which is bilinear: linear in A for a given O and the reverse. It is the condition behind the standard form
W(e^{iβ_k} − 1) + Z(e^{iα_k} − 1) = δ_k (Norton 5.35) with the rotation β_k eliminated. If the rotation is given, the
condition is A_k − O = e^{iβ_k}(A − O) instead, which is linear. All other choices of Norton's are linear too, except
the length z of the coupler vector:

    fixed pivot        O = O*, or one coordinate of it: Re(conj(n) O) = s
    moving pivot       A = A*, or one coordinate of it
    link angle θ       Im(e^{−iθ}(A − O)) = 0
    coupler angle φ    Im(e^{−iφ}(P_1 − A)) = 0
    coupler length z   |P_1 − A|² = z²

Four rows make a square system, and Newton's method solves a batch of them at once: in one step if all rows are linear,
in two if a pivot is given (the first step places that pivot, the second solves the rest exactly).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from synthesis.kinds.motion.task.positions import MotionTask

NEWTON_STEPS = 40
"""Maximum number of Newton steps; linear conditions need two, the others converge quadratically after a few."""

CONVERGENCE_TOLERANCE = 1e-14
"""Convergence tolerance: the largest residual row, relative to the square of the dyad's size. It covers a few dozen
rounding errors of the terms."""

MIN_DETERMINANT = 1e-12
"""Minimum determinant for a Newton step, relative to the product of the row norms; below it the step would exceed the
maximum distance of a pivot."""

REPETITION_TOLERANCE = 1e-13
"""Singular value, relative to the largest, below which a condition repeats the others to rounding. Between this value
and :data:`RANK_TOLERANCE` it may be independent, but too few digits remain to decide."""

RANK_TOLERANCE = 1e-9
"""Singular value, relative to the largest, below which a linear condition counts as a repetition of the others, and the
misfit below which it then counts as satisfied. Both leave half of the digits of the data as a margin."""

RIDGE_SHARE = 1e-14
"""Ridge added to a normal matrix, as a share of its trace, so that a singular one (at a pole) can be solved."""

MAX_PIVOT_DISTANCE = 1e5
"""Maximum distance of a pivot, in task sizes. Farther pivots are treated as sliders: their residuals could not be kept
below 1e-9."""


Values = TypeVar("Values", Complex | None, Real | None)
"""One condition of a batch of dyads, if given."""


class Line(NamedTuple):
    """The line of points z with Re(conj(normal) z) = offset; the normal has unit length."""

    normal: complex
    offset: float


@dataclass(frozen=True)
class DyadConditions:
    """Conditions on a batch of dyads, in task coordinates and radians; each a scalar, an array (batch,) or None.

    ``fixed_lines`` and ``moving_lines`` are lines that must contain the pivot.
    """

    fixed_pivot: Complex | None = None
    moving_pivot: Complex | None = None
    fixed_lines: tuple[Line, ...] = ()
    moving_lines: tuple[Line, ...] = ()
    rotations: tuple[Real | None, ...] = ()
    link_angle: Real | None = None
    coupler_length: Real | None = None
    coupler_angle: Real | None = None

    def count(self) -> int:
        """Return the number of fixed scalars."""
        scalars = (self.link_angle, self.coupler_length, self.coupler_angle, *self.rotations)
        pivots = (self.fixed_pivot, self.moving_pivot)
        lines = len(self.fixed_lines) + len(self.moving_lines)
        return 2 * sum(p is not None for p in pivots) + lines + sum(s is not None for s in scalars)

    @property
    def is_linear(self) -> bool:
        """Whether the remaining system is linear: a pivot or all rotations are given, and no coupler length z alone."""
        pivot = self.fixed_pivot is not None or self.moving_pivot is not None
        return self.coupler_length is None and (pivot or None not in self.rotations)


class Dyads(NamedTuple):
    """Fixed pivots O and moving pivots A in the first position; complex, shape (batch,), task coordinates."""

    fixed: Complex
    moving: Complex


def solve_dyads(task: MotionTask, conditions: DyadConditions, start: Dyads) -> tuple[Dyads, NDArray[np.bool_]]:
    """Solve a batch of square systems by Newton's method.

    Parameters
    ----------
    task : MotionTask
        n positions.
    conditions : DyadConditions
        Exactly 5 − n numbers; arrays of shape (batch,) or scalars.
    start : Dyads
        Shape (batch,).

    Returns
    -------
    dyads : Dyads
        Shape (batch,).
    found : bool, shape (batch,)
        False if the system is singular or has no real solution nearby, if a pivot lies at infinity (a slider would be
        needed), or if a given direction is met only with a negative length.
    """
    fixed, moving = start.fixed.astype(np.complex128), start.moving.astype(np.complex128)
    done = np.zeros(fixed.shape, np.bool_)
    active = np.arange(len(fixed))
    for _ in range(NEWTON_STEPS):
        o, a = fixed[active], moving[active]
        values, jacobian = _evaluate_rows(task, _select_conditions(conditions, active), o, a)
        # The rows are quadratic in the pivots' coordinates, so their rounding grows with the square of the size.
        size = 1.0 + np.abs(o) + np.abs(a)
        arrived = np.abs(values).max(axis=-1) <= CONVERGENCE_TOLERANCE * size * size
        done[active[arrived]] = True
        norms = np.sqrt((jacobian * jacobian).sum(axis=-1))
        # A row without gradient (all zero) would divide by zero; its determinant is zero, so the dyad is dropped
        # below.
        norms[norms == 0.0] = 1.0
        # Unit rows make the determinant a measure of independence; dyads that run off to infinity are dropped.
        jacobian = jacobian / norms[..., None]
        # Ten times the maximum distance, because a dyad may pass far away before it converges.
        going = ~arrived & (size < 10.0 * MAX_PIVOT_DISTANCE) & (np.abs(np.linalg.det(jacobian)) > MIN_DETERMINANT)
        active = active[going]
        if not len(active):
            break
        step = np.linalg.solve(jacobian[going], -(values / norms)[going][..., None])[..., 0]
        fixed[active] += step[:, 0] + 1j * step[:, 1]
        moving[active] += step[:, 2] + 1j * step[:, 3]
    dyads = Dyads(fixed, moving)
    # Dyads beyond the maximum distance are solutions, but count as sliders.
    near = (np.abs(fixed) < MAX_PIVOT_DISTANCE) & (np.abs(moving) < MAX_PIVOT_DISTANCE)
    return dyads, done & near & check_directions(task, conditions, dyads)


def refine_dyads(task: MotionTask, dyads: Dyads) -> Dyads:
    """Project dyads that nearly meet the positions onto the nearest exact ones, shape (batch,).

    Two Gauss-Newton steps of minimum norm suffice, because the errors are only a few digits above rounding.
    """
    fixed, moving = dyads
    conditions = DyadConditions(rotations=(None,) * (len(task.points) - 1))
    for _ in range(2):
        values, jacobian = _evaluate_rows(task, conditions, fixed, moving)
        transposed = jacobian.swapaxes(-1, -2)
        square = jacobian @ transposed
        # At a pole the rows are dependent; the ridge turns the step into the regularised minimum-norm solution.
        square += RIDGE_SHARE * np.trace(square, axis1=-2, axis2=-1)[..., None, None] * np.eye(values.shape[-1])
        step = -(transposed @ np.linalg.solve(square, values[..., None]))[..., 0]
        fixed = fixed + (step[:, 0] + 1j * step[:, 1])
        moving = moving + (step[:, 2] + 1j * step[:, 3])
    return Dyads(fixed, moving)


def _select_conditions(conditions: DyadConditions, rows: NDArray[np.int64]) -> DyadConditions:
    """Return the conditions of selected dyads of the batch."""

    def select(value: Values) -> Values:
        return value if value is None or np.ndim(value) == 0 else value[rows]

    return DyadConditions(
        select(conditions.fixed_pivot),
        select(conditions.moving_pivot),
        conditions.fixed_lines,
        conditions.moving_lines,
        tuple(select(rotation) for rotation in conditions.rotations),
        select(conditions.link_angle),
        select(conditions.coupler_length),
        select(conditions.coupler_angle),
    )


class Family(NamedTuple):
    """The solutions of linear conditions: one dyad, and the directions in which it can move (none if it is unique).

    ``dyad`` is None if the conditions contradict each other. ``directions`` are rows (Re O, Im O, Re A, Im A) of unit
    length. ``proved`` is False if the conditions have too few digits to decide whether they repeat one another.
    """

    dyad: Dyads | None
    directions: Real
    proved: bool


def solve_linear_family(task: MotionTask, conditions: DyadConditions) -> Family:
    """Return all dyads that satisfy conditions which are :attr:`DyadConditions.is_linear`.

    If a pivot is a pole of the motion, or conditions repeat one another, there is a whole family of dyads.
    """
    fixed = np.atleast_1d(np.asarray(0j if conditions.fixed_pivot is None else conditions.fixed_pivot, np.complex128))
    moving = np.atleast_1d(
        np.asarray(0j if conditions.moving_pivot is None else conditions.moving_pivot, np.complex128)
    )
    # A given pivot stays in place; the conditions are linear in the remaining coordinates.
    # A pivot is given as a whole; its coordinates must not take part in the least-norm step.
    first, last = (2, 4) if conditions.fixed_pivot is not None else (0, 2 if conditions.moving_pivot is not None else 4)
    values, jacobian = _evaluate_rows(task, conditions, fixed, moving)
    value, matrix = values[0], jacobian[0][:, first:last]
    u, s, vh = np.linalg.svd(matrix, full_matrices=True)
    # The floor avoids a rank from rounding if all rows vanish.
    largest = max(float(s[0]), RANK_TOLERANCE)
    rank = int(np.sum(s > RANK_TOLERANCE * largest))
    proved = not np.any(s[rank:] > REPETITION_TOLERANCE * largest)
    step = np.zeros(4)
    step[first:last] = -(vh[:rank].T / s[:rank]) @ (u[:, :rank].T @ value)
    size = 1.0 + float(np.abs(step).max() + np.abs(fixed[0]) + np.abs(moving[0]))
    # The minimum-norm solution of a rank-deficient system solves all rows only if they do not contradict each other.
    if np.abs(value + matrix @ step[first:last]).max() > RANK_TOLERANCE * size * size:
        return Family(None, np.empty((0, 4)), proved)
    directions = np.zeros((last - first - rank, 4))
    directions[:, first:last] = vh[rank:]
    return Family(Dyads(fixed + (step[0] + 1j * step[1]), moving + (step[2] + 1j * step[3])), directions, proved)


def _evaluate_rows(task: MotionTask, conditions: DyadConditions, fixed: Complex, moving: Complex) -> tuple[Real, Real]:
    """Return residuals (batch, rows) and their Jacobian (batch, rows, 4) with respect to (Re O, Im O, Re A, Im A)."""
    count = len(conditions.rotations) + conditions.count()
    values = np.empty((*fixed.shape, count))
    gradients = np.zeros((*fixed.shape, count, 2), np.complex128)
    row = 0

    def add(value: Real, by_fixed: Complex | complex, by_moving: Complex | complex) -> None:
        """Append a row; a complex gradient g stands for the differential Re(conj(g) dz)."""
        nonlocal row
        values[..., row] = value
        gradients[..., row, 0] = by_fixed
        gradients[..., row, 1] = by_moving
        row += 1

    images = task.images(moving)
    for k, rotation in enumerate(conditions.rotations, start=1):
        image, turn = images[:, k], task.turns[k]
        if rotation is None:
            # |A_k − O|² = |A − O|² with A_k = turn A + shift, after the squares of A and O have cancelled.
            shift = task.points[k] - turn * task.points[0]
            half_square = abs(shift) ** 2 / 2.0
            value = (np.conj(shift) * turn * moving).real - (np.conj(fixed) * (image - moving)).real + half_square
            add(value, moving - image, np.conj(turn) * shift - (np.conj(turn) - 1.0) * fixed)
        else:
            # A given rotation fixes the image of the moving pivot completely: two real rows.
            spin = np.exp(1j * rotation)
            gap = image - fixed - spin * (moving - fixed)
            add(gap.real, np.conj(spin - 1.0), np.conj(turn - spin))
            add(gap.imag, 1j * np.conj(spin - 1.0), 1j * np.conj(turn - spin))
    if conditions.fixed_pivot is not None:
        gap = fixed - conditions.fixed_pivot
        add(gap.real, 1.0, 0.0)
        add(gap.imag, 1j, 0.0)
    if conditions.moving_pivot is not None:
        gap = moving - conditions.moving_pivot
        add(gap.real, 0.0, 1.0)
        add(gap.imag, 0.0, 1j)
    for line in conditions.fixed_lines:
        add((np.conj(line.normal) * fixed).real - line.offset, line.normal, 0.0)
    for line in conditions.moving_lines:
        add((np.conj(line.normal) * moving).real - line.offset, 0.0, line.normal)
    if conditions.link_angle is not None:
        direction = np.exp(1j * conditions.link_angle)
        add((np.conj(direction) * (moving - fixed)).imag, -1j * direction, 1j * direction)
    if conditions.coupler_angle is not None:
        direction = np.exp(1j * conditions.coupler_angle)
        add((np.conj(direction) * (task.points[0] - moving)).imag, 0.0, -1j * direction)
    if conditions.coupler_length is not None:
        vector = moving - task.points[0]
        add(np.abs(vector) ** 2 - conditions.coupler_length**2, 0.0, 2.0 * vector)
    return values, gradients.view(np.float64).reshape(*fixed.shape, count, 4)


def check_directions(task: MotionTask, conditions: DyadConditions, dyads: Dyads) -> NDArray[np.bool_]:
    """Return a mask of the dyads that meet given directions with positive, not negative, lengths; shape (batch,)."""
    good = np.ones(dyads.fixed.shape, np.bool_)
    if conditions.link_angle is not None:
        good &= (np.exp(-1j * conditions.link_angle) * (dyads.moving - dyads.fixed)).real > 0.0
    if conditions.coupler_angle is not None:
        good &= (np.exp(-1j * conditions.coupler_angle) * (task.points[0] - dyads.moving)).real > 0.0
    return good
