"""All dyads that satisfy linear conditions, as the intersections of a linear space with the variety of dyads.

Write a dyad with fixed pivot o/o₀ and moving pivot a/a₀ (homogeneous, so that either may lie at infinity) as the point

    x = (p, A, O, d + ie) = (o₀a₀, o₀a, a₀o, conj(o)a)          (seven real coordinates, up to a factor).

These points are exactly those with

    p · (d + ie) = conj(O) A,                                    (two quadrics; a variety of dimension 4 and degree 4)

and the condition that the link keeps its length from position 1 to k (:mod:`synthesis.kinds.motion.dyads.equations`) is
linear in x,

    p|c|²/2 + Re(conj(c) r A) − Re(conj(c) O) − Re((r − 1)(d + ie)) = 0.

The following are linear too: a coordinate of a pivot, the angle of the link, the angle of the coupler vector, a whole
pivot (O = O* p and d + ie = conj(O*) A), and a rotation of the link (p c + r A − O = e^{iβ}(A − O)). Four conditions
leave a plane, which intersects the two quadrics in four points: Burmester's four dyads of five positions, counted with
multiplicity and including complex ones. Three conditions leave a three-dimensional space, in which the quadrics meet in
a curve: Burmester's curve of four positions (:mod:`synthesis.kinds.motion.dyads.burmester`). A given length of the
coupler vector is a third quadric.

p = 0 represents a slider: with O ≠ 0 the fixed pivot is at infinity, and A moves on a straight line (PR); with A ≠ 0
the moving pivot is at infinity, and a line of the body passes through O (RP). Sliders are regular solutions in these
coordinates, so dyads that approach infinity are not lost.

The seven coordinates are those of planar kinematic mapping without its two isotropic ones (Bottema & Roth,
*Theoretical Kinematics*, ch. 11; McCarthy, *Geometric Design of Linkages*, ch. 5). Burmester's cubic curves share the
two isotropic points at infinity in addition to the four dyads.
"""

from __future__ import annotations

import math
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.motion.dyads.equations import (
    MAX_PIVOT_DISTANCE,
    RANK_TOLERANCE,
    REPETITION_TOLERANCE,
    DyadConditions,
    Dyads,
    check_directions,
)
from synthesis.kinds.motion.task.positions import MotionTask
from synthesis.numerics.quadrics import find_common_points

ZERO_FORM_TOLERANCE = 1e-10
"""Norm of a quadric restricted to the linear space, below which it vanishes there; the full matrix has unit norm."""

ROW_ERROR = 2e-15
"""Error of a unit row: a few rounding errors."""

MAX_SPACE_ERROR = 1e-10
"""Maximum error of the solution space; beyond it nothing can be proved about the points in it."""

SPACE_TOLERANCE = 1e-13
"""Distance up to which a point at infinity lies in the solution space: rounding. The error of the space is added."""

INFINITY_TOLERANCE = 1e-5
"""Distance, between unit points x, up to which a solution counts as one at infinity. Conditions on the coupler's length
have double solutions there, which keep half of their digits, and triple ones, which keep a third."""

MIN_PIVOT_NORM = 1e-6
"""Minimum norm of A and O in a unit point x; below it both pivots are at infinity, and the point is no dyad. At a
double solution, as for a given coupler length, rounding leaves a zero only half of its digits."""


class SliderDyad(NamedTuple):
    """A dyad with a pivot at infinity, in task coordinates.

    PR: the body point ``point`` (first position) moves on a line with unit normal ``normal``. RP: the line of the body
    that passes through ``point`` with unit normal ``normal`` in the first position passes through it in all positions.
    """

    kind: Literal["PR", "RP"]
    point: complex
    normal: complex


class Section(NamedTuple):
    """Dyads that satisfy linear conditions.

    Attributes
    ----------
    dyads : Dyads
        Dyads with both pivots within reach, shape (k,), task coordinates.
    double : bool, shape (k,)
        Two or more dyads coincide here, to rounding.
    sliders : tuple of SliderDyad
        Dyads with a pivot at infinity, to rounding.
    far : int
        Number of dyads with a finite pivot farther away than
        :data:`~synthesis.kinds.motion.dyads.equations.MAX_PIVOT_DISTANCE`; they are not returned.
    finite : bool
        False if a whole family of dyads satisfies the conditions; then none is returned.
    proved : bool
        Whether ``dyads`` is proved complete: all solutions are accounted for, including complex ones and those at
        infinity. False if a dyad is far, or if the conditions leave too few digits to decide.
    """

    dyads: Dyads
    double: np.ndarray
    sliders: tuple[SliderDyad, ...]
    far: int
    finite: bool
    proved: bool


def build_pose_rows(task: MotionTask) -> Real:
    """Return the conditions that the link has the same length in each later position: unit rows (n − 1, 7)."""
    r = task.turns[1:]
    c = task.points[1:] - r * task.points[0]
    forward = np.conj(r) * c
    # Compute 1 − cos of a small angle from its sine, which keeps all digits.
    fall = np.where(r.real > 0.0, r.imag**2 / (1.0 + np.abs(r.real)), 1.0 - r.real)
    return _normalize_rows(
        np.stack([np.abs(c) ** 2 / 2.0, forward.real, forward.imag, -c.real, -c.imag, fall, r.imag], axis=1)
    )


def build_condition_rows(task: MotionTask, conditions: DyadConditions) -> Real:
    """Return the given linear conditions as unit rows (count, 7); a coupler length is not linear and is left out."""
    rows: list[Real] = []

    def add(p: complex, a: complex, o: complex, de: complex = 0.0) -> None:
        """Append the row of Re(p) p + Re(conj(a) A) + Re(conj(o) O) + Re(conj(de) (d + ie)) = 0."""
        rows.append(np.array([p.real, a.real, a.imag, o.real, o.imag, de.real, de.imag]))

    for k, rotation in enumerate(conditions.rotations, start=1):
        if rotation is not None:
            r, spin = complex(task.turns[k]), complex(np.exp(1j * rotation))
            c = complex(task.points[k]) - r * complex(task.points[0])
            for u in (1.0, 1j):  # real and imaginary part
                add((np.conj(u) * c).real, np.conj(r - spin) * u, np.conj(spin - 1.0) * u)
    for line in conditions.fixed_lines:
        add(complex(-line.offset), 0.0, line.normal)
    for line in conditions.moving_lines:
        add(complex(-line.offset), line.normal, 0.0)
    if conditions.fixed_pivot is not None:
        pivot = complex(conditions.fixed_pivot)
        for u in (1.0, 1j):
            add(-(np.conj(u) * pivot).real, 0.0, u)
            add(0.0, -pivot * u, 0.0, u)
    if conditions.moving_pivot is not None:
        pivot = complex(conditions.moving_pivot)
        for u in (1.0, 1j):
            add(-(np.conj(u) * pivot).real, u, 0.0)
            add(0.0, 0.0, -pivot * np.conj(u), u)
    if conditions.link_angle is not None:
        normal = 1j * complex(np.exp(1j * conditions.link_angle))
        add(0.0, normal, -normal)
    if conditions.coupler_angle is not None:
        normal = 1j * complex(np.exp(1j * conditions.coupler_angle))
        add((np.conj(normal) * complex(task.points[0])).real, -normal, 0.0)
    return _normalize_rows(np.array(rows)) if rows else np.empty((0, 7))


def find_null_space(rows: Real) -> Real:
    """Return orthonormal columns (7, m) that span the null space of the rows."""
    return _solve_space(rows).basis


def restrict_variety(basis: Real) -> Real:
    """Restrict the quadrics p(d + ie) = conj(O)A (real and imaginary part) to the space of ``basis``: (2, m, m)."""
    forms: Real = np.einsum("im,qij,jn->qmn", basis, VARIETY_FORMS, basis)
    return forms


def find_section(task: MotionTask, conditions: DyadConditions) -> Section:
    """Find all dyads that satisfy at least as many conditions as a dyad has freedoms.

    Parameters
    ----------
    task : MotionTask
        n positions.
    conditions : DyadConditions
        Scalars, not arrays. At least 5 − n of them; at most one is a coupler length.
    """
    space = _solve_space(np.concatenate([build_pose_rows(task), build_condition_rows(task, conditions)]))
    basis, sharp = space.basis, space.error <= MAX_SPACE_ERROR
    m = basis.shape[1]
    nobody = Dyads(np.empty(0, np.complex128), np.empty(0, np.complex128))
    none = Section(nobody, np.empty(0, np.bool_), (), 0, True, sharp)
    if m == 0:
        return none
    forms = list(restrict_variety(basis))
    if conditions.coupler_length is not None:
        forms.append(basis.T @ _build_length_form(task, float(conditions.coupler_length)) @ basis)
    independent = _select_independent(forms)
    # m homogeneous coordinates need m − 1 equations; with fewer the solutions form a family.
    if len(independent) < m - 1:
        return none._replace(finite=False, proved=False)
    if m == 1:
        # A single point remains; it is a dyad only if every quadric vanishes on it.
        met = len(independent) == 0
        return _sort_solutions(task, conditions, space, basis.T, np.zeros(1, np.bool_), sharp) if met else none
    solved = find_common_points(independent[: m - 1], space.error)
    if not solved.finite:
        return none._replace(finite=False, proved=False)
    # Surplus quadrics did not take part in the intersection: they filter its points.
    met = np.abs(np.einsum("qij,ki,kj->kq", independent[m - 1 :], solved.real, solved.real)).max(axis=1, initial=0.0)
    kept = met <= RANK_TOLERANCE
    proved = sharp and bool(np.all(_is_at_infinity(space, solved.unproved)))
    return _sort_solutions(task, conditions, space, solved.real[kept] @ basis.T, solved.double[kept], proved)


class _Space(NamedTuple):
    """Solution space of linear conditions: orthonormal columns (7, m), and their approximate rounding error."""

    basis: Real
    error: float


def _solve_space(rows: Real) -> _Space:
    _, s, vh = np.linalg.svd(rows)
    rank = int(np.sum(s > RANK_TOLERANCE))
    # A condition that repeats the others except for a few digits is dropped, so the space is wholly uncertain.
    least = float(s[rank - 1]) if rank else 1.0
    error = math.inf if np.any(s[rank:] > REPETITION_TOLERANCE) else ROW_ERROR / least
    return _Space(vh[rank:].T, error)


def _is_at_infinity(space: _Space, points: np.ndarray) -> np.ndarray:
    """Return a mask of the points of a space, given by unit vectors in it (k, m), that have a pivot at infinity.

    All points with p = A = 0 or p = O = 0 lie on the variety. The space has such points if the three rows of its basis
    for p and A (or p and O) are dependent.
    """
    met = np.zeros(len(points), np.bool_)
    for rows in ([0, 1, 2], [0, 3, 4]):
        _, s, vh = np.linalg.svd(space.basis[rows])
        depends = np.ones(space.basis.shape[1], np.bool_)
        depends[: len(s)] = s <= SPACE_TOLERANCE + space.error
        off = points - (points @ vh[depends].T) @ vh[depends]
        met |= np.linalg.norm(off, axis=1) <= INFINITY_TOLERANCE
    return met


def _split_points(points: Real) -> tuple[Dyads, np.ndarray, np.ndarray]:
    """Return the dyads of real points x (k, 7) within reach, the mask of these points, and of those with one pivot."""
    p = points[:, 0]
    moving, fixed = points[:, 1] + 1j * points[:, 2], points[:, 3] + 1j * points[:, 4]
    reach = np.maximum(np.abs(moving), np.abs(fixed))
    near = (reach < MAX_PIVOT_DISTANCE * np.abs(p)) & (reach > MIN_PIVOT_NORM)
    scale = p[near].astype(np.complex128)
    return Dyads(fixed[near] / scale, moving[near] / scale), near, ~near & (reach > MIN_PIVOT_NORM)


def _convert_sliders(points: Real) -> tuple[SliderDyad, ...]:
    """Convert points x with a pivot at infinity to sliders."""
    sliders: list[SliderDyad] = []
    moving, fixed = points[:, 1] + 1j * points[:, 2], points[:, 3] + 1j * points[:, 4]
    for a, o, de in zip(moving, fixed, points[:, 5] + 1j * points[:, 6], strict=True):
        # With p = 0 one of O and A vanishes; the other is the direction of the normal.
        if abs(o) > abs(a):
            sliders.append(SliderDyad("PR", complex(de * o) / abs(o) ** 2, complex(o / abs(o))))
        else:
            sliders.append(SliderDyad("RP", complex(np.conj(de) * a) / abs(a) ** 2, complex(a / abs(a))))
    return tuple(sliders)


def _sort_solutions(
    task: MotionTask, conditions: DyadConditions, space: _Space, points: Real, double: np.ndarray, proved: bool
) -> Section:
    dyads, near, single = _split_points(points)
    good = check_directions(task, conditions, dyads)
    infinite = _is_at_infinity(space, points @ space.basis)
    sliders, far = _convert_sliders(points[single & infinite]), int(np.sum(~near & ~infinite))
    kept = Dyads(dyads.fixed[good], dyads.moving[good])
    return Section(kept, double[near][good], sliders, far, True, proved and not far)


def _normalize_rows(rows: Real) -> Real:
    unit: Real = rows / np.linalg.norm(rows, axis=-1, keepdims=True)
    return unit


def _select_independent(forms: list[Real]) -> Real:
    """Return independent combinations of the forms, of unit norm, that span the same space."""
    m = forms[0].shape[-1]
    _, s, vh = np.linalg.svd(np.array(forms).reshape(len(forms), m * m), full_matrices=False)
    kept: Real = vh[s > ZERO_FORM_TOLERANCE].reshape(-1, m, m)
    return kept


def _build_length_form(task: MotionTask, length: float) -> Real:
    """Return |A − P₁ p|² = z² p² as a symmetric matrix of unit norm."""
    point = complex(task.points[0])
    form = np.zeros((7, 7))
    form[0, 0] = abs(point) ** 2 - length**2
    form[0, 1:3] = form[1:3, 0] = -point.real, -point.imag
    form[1, 1] = form[2, 2] = 1.0
    unit: Real = form / np.linalg.norm(form)
    return unit


def _build_variety() -> Real:
    p, ar, ai, or_, oi, d, e = range(7)
    forms = np.zeros((2, 7, 7))
    for form, terms in zip(
        forms,
        (((p, d, 1.0), (or_, ar, -1.0), (oi, ai, -1.0)), ((p, e, 1.0), (or_, ai, -1.0), (oi, ar, 1.0))),
        strict=True,
    ):
        for i, j, value in terms:
            form[i, j] = form[j, i] = value / 2.0
    return forms


VARIETY_FORMS = _build_variety()
"""The two quadrics as symmetric matrices, shape (2, 7, 7)."""
