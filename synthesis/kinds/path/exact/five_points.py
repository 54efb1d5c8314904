"""All fourbars on two given fixed pivots whose coupler point goes through five points.

The 36 solutions of general complex parameters are followed to the points and pivots of the problem
(:mod:`synthesis.kinds.path.exact.five_point_system`). If 36 distinct solutions arrive, with the complex conjugate of
each and none nearly singular, there are no others. Cognates have other fixed pivots and are not solutions here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex
from synthesis.kinds.path.exact.continuation_starts import load_five_point_start
from synthesis.kinds.path.exact.five_point_system import (
    FIVE_POINT_SYSTEM,
    PARAMETER_COUNT,
    SOLUTION_COUNT,
    UNKNOWN_COUNT,
    compute_conditions,
    compute_residuals,
)
from synthesis.model.linkage.conversion import FourbarConfiguration
from synthesis.numerics.continuation import CONVERGENCE_TOLERANCE, END_REACHED, ParameterPath, follow, refine

BEND_SIZE = 2.0
"""Size of the random bend of the parameters' path, in sizes of the problem."""

FIRST_STEP_TOLERANCE, LATER_STEP_TOLERANCE = 5e-3, 1e-3
"""Maximum relative prediction error of a step: in the first run, and in later runs, after a path was lost."""

MAX_RUNS = 4
"""Maximum number of runs, each along another path of the parameters, until all solutions have arrived."""

MAX_RESIDUAL = 1e-9
"""Maximum residual of the equations at an accepted end point, in squares of the problem's size."""

DUPLICATE_TOLERANCE, REAL_TOLERANCE = 1e-6, 1e-6
"""Relative difference below which two solutions are the same, and below which one is real (compared with its
conjugate)."""

MAX_CONDITION = 1e9
"""Condition number above which the last digits of the points decide how many solutions are real, so that some may be
missed."""


class FivePointSolutions(NamedTuple):
    """The fourbars through five points.

    Attributes
    ----------
    found : int
        Number of solutions, real and complex; 36 for general points.
    linkages : list of FourbarConfiguration
        The real ones, in the first position.
    complete : bool
        Whether all solutions are known.
    largest_residual : float
        Maximum residual of all solutions.
    """

    found: int
    linkages: list[FourbarConfiguration]
    complete: bool
    largest_residual: float


def solve_five_points(points: Complex, o2: complex, o4: complex, rng: np.random.Generator) -> FivePointSolutions:
    """Compute all fourbars on O2 and O4 through five points.

    Parameters
    ----------
    points : complex, shape (5,)
        Distinct points.
    o2, o4 : complex
        The fixed pivots, distinct.
    rng : Generator
        Source of the random parameter paths.
    """
    moved = np.asarray(points[1:] - points[0], np.complex128)
    pivots = np.array([o2, o4]) - points[0]
    # Unit size keeps residuals and tolerances independent of the client's units.
    size = float(np.sqrt(np.mean(np.abs(np.concatenate([moved, pivots])) ** 2)))
    moved, pivots = moved / size, pivots / size
    p = np.concatenate([moved, moved.conj(), np.stack([pivots, pivots.conj()], axis=1).ravel()])
    begun = load_five_point_start()
    y = np.empty((0, UNKNOWN_COUNT), np.complex128)
    for way in range(MAX_RUNS):
        bend = BEND_SIZE * (rng.normal(size=(PARAMETER_COUNT, 2)) @ np.array([1.0, 1.0j]))
        tolerance = FIRST_STEP_TOLERANCE if way == 0 else LATER_STEP_TOLERANCE
        ends = follow(FIVE_POINT_SYSTEM, begun.y, ParameterPath(begun.p, p, bend), tolerance=tolerance)
        arrived = ends.y[(ends.status == END_REACHED) & np.isfinite(ends.y).all(axis=1)]
        arrived = arrived[
            compute_residuals(arrived, p) <= MAX_RESIDUAL * np.maximum(1.0, np.abs(arrived[:, :4]).max(axis=1)) ** 2
        ]
        # Conjugates of solutions for real points are solutions too, so that one of a pair suffices.
        y = _select_distinct(np.concatenate([y, arrived, _compute_conjugates(arrived)]), p)
        if len(y) >= SOLUTION_COUNT:
            break
    linkages = [
        FourbarConfiguration(o2, points[0] + size * complex(x), points[0] + size * complex(z), o4, complex(points[0]))
        for x, z in _extract_real(y, p)
    ]
    # A nearly double solution may hide a pair of real ones.
    sound = len(y) == SOLUTION_COUNT and bool((compute_conditions(y, p) < MAX_CONDITION).all())
    return FivePointSolutions(len(y), linkages, sound, float(compute_residuals(y, p).max(initial=0.0)))


def _compute_conjugates(y: Complex) -> Complex:
    """Return the complex conjugates of solutions for real points: the parts of each vector are exchanged."""
    s = y[..., 4:].conj()
    return np.concatenate([y[..., [1, 0, 3, 2]].conj(), -s / (1.0 + s)], axis=-1)


def _select_distinct(y: Complex, p: Complex) -> Complex:
    """Return each solution of the system once; conjugates that are no solutions are dropped."""
    good = y[compute_residuals(y, p) <= MAX_RESIDUAL * np.maximum(1.0, np.abs(y[:, :4]).max(axis=1, initial=0.0)) ** 2]
    kept: list[int] = []
    for n in range(len(good)):
        apart = np.abs(good[kept] - good[n])
        scale = np.maximum(np.abs(good[n]), np.abs(good[n]).max() * DUPLICATE_TOLERANCE)
        if not kept or (apart > DUPLICATE_TOLERANCE * scale).any(axis=1).all():
            kept.append(n)
    return np.asarray(good[kept])


def _extract_real(y: Complex, p: Complex) -> list[tuple[complex, complex]]:
    """Return the moving pivots x₁, x₂ of the real solutions, refined as real ones."""
    apart = np.abs(y - _compute_conjugates(y)).max(axis=1)
    near = y[apart <= REAL_TOLERANCE * np.abs(y).max(axis=1)].copy()
    # Project onto the real solutions, so that Newton's method stays among them if one is near.
    near = 0.5 * (near + _compute_conjugates(near))
    near, _, moved = refine(FIVE_POINT_SYSTEM, near, np.zeros_like(near), p)
    near = near[moved < CONVERGENCE_TOLERANCE]
    still = np.abs(near - _compute_conjugates(near)).max(axis=1) <= REAL_TOLERANCE * np.abs(near).max(axis=1)
    return [(complex(solution[0]), complex(solution[2])) for solution in near[still]]
