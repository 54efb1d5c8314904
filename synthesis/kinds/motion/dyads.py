"""Dyads that carry the body through its positions, from as many conditions as a dyad has freedoms.

A dyad is a link from a fixed pivot O to a moving pivot A on the body; O and A (in the first position) are its four
unknown numbers. With A_k = c_k + r_k A the image of A in position k (r_k = e^{iα_k}, c_k = P_k − r_k P_1) the link
keeps its length when |A_k − O|² = |A − O|². The squares of A and of O cancel,

    Re(conj(c_k) r_k A) − Re(conj(O) (A_k − A)) + |c_k|²/2 = 0,

which is bilinear: linear in A for a given O and the reverse. It is the condition behind the standard form
W(e^{iβ_k} − 1) + Z(e^{iα_k} − 1) = δ_k (Norton 5.35) with the rotation β_k eliminated. A rotation that is given
replaces it by A_k − O = e^{iβ_k}(A − O), which is linear. Every other choice of Norton's is linear too, but for the
length z of the coupler vector:

    fixed pivot        O = O*, or one coordinate of it: Re(conj(n) O) = s
    moving pivot       A = A*, or one coordinate of it
    link angle θ       Im(e^{−iθ}(A − O)) = 0
    coupler angle φ    Im(e^{−iφ}(P_1 − A)) = 0
    coupler length z   |P_1 − A|² = z²

Four rows make a square system, and Newton's method solves a batch of them at once: in one step where all rows are
linear, in two where a pivot is given (the first step puts that pivot in its place, the second solves the rest exactly).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.task import Complex, MotionTask, Real

NEWTON_STEPS = 40
"""Steps at most; linear conditions need two, the others converge quadratically after a few."""

CONVERGED = 1e-14
"""Largest residual row, relative to the square of the dyad's size, at which Newton's method has arrived: some tens of
roundings of the terms in it."""

SINGULAR = 1e-12
"""Determinant, relative to the product of the row norms, below which a Newton step is not taken: it would be longer
than the farthest pivot allowed."""

LOST = 1e-13
"""The same at which it repeats them to rounding: between the two it may be one of its own, of which too few digits are
left to tell."""

DEPENDENT = 1e-9
"""Singular value, relative to the largest, below which a linear condition counts as a repetition of the others; and the
misfit below which it then counts as met. Half of the digits of the data stand behind either."""

RIDGE = 1e-14
"""Share of its trace that is added to a normal matrix, so that a singular one (at a pole) is no error."""

FAR = 1e5
"""A pivot farther than this many task sizes away stands for a slider: its residual could not be held to 1e-9."""


class Line(NamedTuple):
    """The line of points z with Re(conj(normal) z) = offset; the normal has unit length."""

    normal: complex
    offset: float


@dataclass(frozen=True)
class DyadConditions:
    """Conditions on a batch of dyads, in task coordinates and radians; each a scalar, an array (batch,) or None.

    ``fixed_lines`` and ``moving_lines`` are lines that a pivot lies on.
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
        """How many numbers are fixed."""
        scalars = (self.link_angle, self.coupler_length, self.coupler_angle, *self.rotations)
        pivots = (self.fixed_pivot, self.moving_pivot)
        lines = len(self.fixed_lines) + len(self.moving_lines)
        return 2 * sum(p is not None for p in pivots) + lines + sum(s is not None for s in scalars)

    @property
    def linear(self) -> bool:
        """Whether what is left to find is a linear system: a pivot or all rotations are given, and no bare length z."""
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
        False where the system is singular or has no real solution near, where a pivot lies at infinity (a slider would
        be needed), or where the link or the stated direction is met with a negative length only.
    """
    fixed, moving = start.fixed.astype(np.complex128), start.moving.astype(np.complex128)
    done = np.zeros(fixed.shape, np.bool_)
    active = np.arange(len(fixed))
    for _ in range(NEWTON_STEPS):
        o, a = fixed[active], moving[active]
        values, jacobian = _rows(task, _taken(conditions, active), o, a)
        size = 1.0 + np.abs(o) + np.abs(a)
        arrived = np.abs(values).max(axis=-1) <= CONVERGED * size * size
        done[active[arrived]] = True
        norms = np.sqrt((jacobian * jacobian).sum(axis=-1))
        norms[norms == 0.0] = 1.0
        jacobian = jacobian / norms[..., None]
        going = ~arrived & (size < 10.0 * FAR) & (np.abs(np.linalg.det(jacobian)) > SINGULAR)
        active = active[going]
        if not len(active):
            break
        step = np.linalg.solve(jacobian[going], -(values / norms)[going][..., None])[..., 0]
        fixed[active] += step[:, 0] + 1j * step[:, 1]
        moving[active] += step[:, 2] + 1j * step[:, 3]
    dyads = Dyads(fixed, moving)
    near = (np.abs(fixed) < FAR) & (np.abs(moving) < FAR)
    return dyads, done & near & directions_hold(task, conditions, dyads)


def settled(task: MotionTask, dyads: Dyads) -> Dyads:
    """Dyads that nearly carry the body through the positions, moved least so that they do; shape (batch,).

    Two steps of Gauss and Newton's method: what is meant are errors of a few digits beyond rounding.
    """
    fixed, moving = dyads
    conditions = DyadConditions(rotations=(None,) * (len(task.points) - 1))
    for _ in range(2):
        values, jacobian = _rows(task, conditions, fixed, moving)
        transposed = jacobian.swapaxes(-1, -2)
        square = jacobian @ transposed
        square += RIDGE * np.trace(square, axis1=-2, axis2=-1)[..., None, None] * np.eye(values.shape[-1])
        step = -(transposed @ np.linalg.solve(square, values[..., None]))[..., 0]
        fixed = fixed + (step[:, 0] + 1j * step[:, 1])
        moving = moving + (step[:, 2] + 1j * step[:, 3])
    return Dyads(fixed, moving)


def _taken(conditions: DyadConditions, rows: NDArray[np.int64]) -> DyadConditions:
    """The conditions of some dyads of the batch."""

    def taken(value: Any) -> Any:
        return value if value is None or np.ndim(value) == 0 else value[rows]

    return DyadConditions(
        taken(conditions.fixed_pivot),
        taken(conditions.moving_pivot),
        conditions.fixed_lines,
        conditions.moving_lines,
        tuple(taken(rotation) for rotation in conditions.rotations),
        taken(conditions.link_angle),
        taken(conditions.coupler_length),
        taken(conditions.coupler_angle),
    )


class Family(NamedTuple):
    """The solutions of linear conditions: a dyad, and the directions in which it may be moved; none if it is unique.

    ``dyad`` is None where the conditions contradict each other. ``directions`` are rows (Re O, Im O, Re A, Im A) of
    unit length. ``proved`` is False where the conditions have too few digits to tell whether they repeat one another.
    """

    dyad: Dyads | None
    directions: Real
    proved: bool


def linear_family(task: MotionTask, conditions: DyadConditions) -> Family:
    """All dyads of conditions that are :attr:`DyadConditions.linear`.

    Where a pivot is a pole of the motion, or conditions repeat one another, there is a whole family of dyads.
    """
    fixed = np.atleast_1d(np.asarray(0j if conditions.fixed_pivot is None else conditions.fixed_pivot, np.complex128))
    moving = np.atleast_1d(
        np.asarray(0j if conditions.moving_pivot is None else conditions.moving_pivot, np.complex128)
    )
    # A pivot that is given stays where it is; the conditions are linear in the coordinates that are left.
    first, last = (2, 4) if conditions.fixed_pivot is not None else (0, 2 if conditions.moving_pivot is not None else 4)
    values, jacobian = _rows(task, conditions, fixed, moving)
    value, matrix = values[0], jacobian[0][:, first:last]
    u, s, vh = np.linalg.svd(matrix, full_matrices=True)
    largest = max(float(s[0]), DEPENDENT)
    rank = int(np.sum(s > DEPENDENT * largest))
    proved = not np.any(s[rank:] > LOST * largest)
    step = np.zeros(4)
    step[first:last] = -(vh[:rank].T / s[:rank]) @ (u[:, :rank].T @ value)
    size = 1.0 + float(np.abs(step).max() + np.abs(fixed[0]) + np.abs(moving[0]))
    if np.abs(value + matrix @ step[first:last]).max() > DEPENDENT * size * size:
        return Family(None, np.empty((0, 4)), proved)
    directions = np.zeros((last - first - rank, 4))
    directions[:, first:last] = vh[rank:]
    return Family(Dyads(fixed + (step[0] + 1j * step[1]), moving + (step[2] + 1j * step[3])), directions, proved)


def _rows(task: MotionTask, conditions: DyadConditions, fixed: Complex, moving: Complex) -> tuple[Real, Real]:
    """Residuals (batch, rows) and their Jacobian (batch, rows, 4) with respect to (Re O, Im O, Re A, Im A)."""
    count = len(conditions.rotations) + conditions.count()
    values = np.empty((*fixed.shape, count))
    gradients = np.zeros((*fixed.shape, count, 2), np.complex128)
    row = 0

    def add(value: Real, by_fixed: Complex | complex, by_moving: Complex | complex) -> None:
        """A row; a gradient g stands for Re(conj(g) dz)."""
        nonlocal row
        values[..., row] = value
        gradients[..., row, 0] = by_fixed
        gradients[..., row, 1] = by_moving
        row += 1

    images = task.images(moving)
    for k, rotation in enumerate(conditions.rotations, start=1):
        image, turn = images[:, k], task.turns[k]
        if rotation is None:
            shift = task.points[k] - turn * task.points[0]
            half_square = abs(shift) ** 2 / 2.0
            value = (np.conj(shift) * turn * moving).real - (np.conj(fixed) * (image - moving)).real + half_square
            add(value, moving - image, np.conj(turn) * shift - (np.conj(turn) - 1.0) * fixed)
        else:
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


def directions_hold(task: MotionTask, conditions: DyadConditions, dyads: Dyads) -> NDArray[np.bool_]:
    """Whether stated directions are met forwards, not backwards."""
    good = np.ones(dyads.fixed.shape, np.bool_)
    if conditions.link_angle is not None:
        good &= (np.exp(-1j * conditions.link_angle) * (dyads.moving - dyads.fixed)).real > 0.0
    if conditions.coupler_angle is not None:
        good &= (np.exp(-1j * conditions.coupler_angle) * (task.points[0] - dyads.moving)).real > 0.0
    return good
