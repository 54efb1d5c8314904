"""All fourbars whose coupler point goes through nine points: every one of the 1442 cognate triples, real and complex.

The orbits of the start are followed to the problem's points (:mod:`synthesis.kinds.path.exact.nine_point_system`). The
end points are checked as a whole: their residuals are small, no two paths end in one orbit (one of them would have
jumped), and the complex conjugate of every orbit is present, as real points require. Lost paths, mostly to linkages of
10⁴ or more times the size of the data, are followed again in smaller steps, in higher precision and from the other
members of their orbit. Orbits still missing are searched along other parameter paths, on which every orbit ends
elsewhere. The result reports orbits that were not found, and is complete only with all 1442.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from kinematics.arrays import Complex, Mask
from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start
from synthesis.kinds.path.exact.nine_point_system import (
    NINE_POINT_SYSTEM,
    ORBIT_COUNT,
    PARAMETER_COUNT,
    PRECISE_NINE_POINT_SYSTEM,
    compute_conditions,
    compute_orbit_keys,
    compute_residuals,
    construct_cognates,
    is_linkage,
)
from synthesis.numerics.continuation import (
    CONVERGENCE_TOLERANCE,
    END_REACHED,
    ParameterPath,
    estimate_progress,
    follow,
    refine,
)
from synthesis.numerics.point_set import KnownPoints

MAX_RESIDUAL = 1e-8
"""Maximum residual of a solution, with points of unit mean distance from the first one."""

ORBIT_TOLERANCE = 1e-4
"""Relative difference of keys below which two orbits are the same. A distant end point has lost many digits, but two of
1442 keys of three complex numbers are hardly ever this close."""

REAL_TOLERANCE = 1e-6
"""A solution whose vectors differ by less than this share from conjugate pairs may be real; Newton's method then
decides, starting from exact pairs."""

BEND_SIZE = 0.5
"""Size of the random bend of the parameters' path, relative to points of unit distance."""

MAX_RUNS = 4
"""Maximum number of runs; in general problems the first finds all 1442 orbits, or all but some."""

MAX_LOST_SHARE = 0.1
"""Maximum share of lost paths for another run. If more are lost, the points are special (for example on a conic) and
have fewer solutions, and another run would find the same ones."""

MAX_CONDITION, MAX_SINGULAR_SHARE = 1e10, 0.01
"""For general points at most one solution in a thousand has a condition above 1e10. If more than a hundredth have, the
points are special, and the numbers of solutions and of real ones depend on their last digits."""

FIRST_STEP_TOLERANCE, RETRY_STEP_TOLERANCE, LAST_STEP_TOLERANCE = 5e-3, 1e-3, 1e-5
"""Maximum relative prediction error of a step: in the first run, from each of three cognates, and from them again."""

PORTION_SIZE = 96
"""Number of paths between two progress reports."""

MAX_STEPS = 2000
"""Maximum number of steps of a path. Almost all need less than 300; lost ones are better followed from a cognate."""


class TripleSolutions(NamedTuple):
    """The fourbars found through nine points.

    Attributes
    ----------
    y, low : complex, shape (found, 16)
        One solution of each orbit found, and its low-order part, which rounding removes. Points are relative to the
        first one and have unit mean square distance from it.
    p : complex, shape (16,)
        The points, relative and scaled, and their conjugates.
    real : complex, shape (triples, 3, 4)
        Fixed and moving pivot of the first dyad, fixed and moving pivot of the second, in the first position and in the
        problem's own coordinates: three cognates for each real orbit.
    lost : int
        Number of orbits missing from 1442.
    retried : int
        Number of paths that had to be followed again.
    largest_residual : float
        Maximum residual of all orbits found.
    self_conjugate : bool
        Whether the conjugate of every orbit is among them.
    nearly_singular : int
        Number of orbits whose condition exceeds :data:`MAX_CONDITION`.
    """

    y: Complex
    low: Complex
    p: Complex
    real: Complex
    lost: int
    retried: int
    largest_residual: float
    self_conjugate: bool
    nearly_singular: int

    @property
    def complete(self) -> bool:
        """Whether all triples are found, and would be found if the points' last digits changed."""
        return self.lost == 0 and self.self_conjugate and self.nearly_singular <= MAX_SINGULAR_SHARE * ORBIT_COUNT


def compute_triples(
    points: Complex, rng: np.random.Generator, progress: Callable[[float], None], threads: int = 1
) -> TripleSolutions:
    """Compute all cognate triples of fourbars through nine points.

    Parameters
    ----------
    points : complex, shape (9,)
        The points, distinct.
    rng : Generator
        Source of the random parameter paths.
    progress : callable
        Receives the share of the paths followed.
    threads : int
        Number of paths followed in parallel.

    Returns
    -------
    TripleSolutions
        ``lost`` is 0 if all 1442 were found.
    """
    moved = np.asarray(points[1:] - points[0], np.complex128)
    size = float(np.sqrt(np.mean(np.abs(moved) ** 2)))
    p = np.asarray(np.concatenate([moved, moved.conj()]) / size, np.complex128)
    orbits = _OrbitSet(p)
    retried = 0
    for way in range(MAX_RUNS):
        bend = BEND_SIZE * (rng.normal(size=(PARAMETER_COUNT, 2)) @ np.array([1.0, 1.0j]))
        # Another random bend of the same start: orbits lost on one path usually arrive on another.
        retried += _run_paths(orbits, bend, threads, _scale_progress(progress, way))
        # Special points have fewer solutions, which another run cannot add.
        if orbits.missing == 0 or orbits.missing > MAX_LOST_SHARE * ORBIT_COUNT:
            break
    progress(1.0)
    return TripleSolutions(
        orbits.y,
        orbits.low,
        p,
        _extract_real_linkages(orbits) * size + points[0],
        orbits.missing,
        retried,
        float(compute_residuals(orbits.y, p, orbits.low).max(initial=0.0)),
        orbits.holds(compute_conjugates(orbits.y)),
        int(np.count_nonzero(compute_conditions(orbits.y, p) > MAX_CONDITION)),
    )


def _scale_progress(progress: Callable[[float], None], way: int) -> Callable[[float], None]:
    return lambda share: progress(estimate_progress(way, share))


def compute_conjugates(y: Complex) -> Complex:
    """Return the complex conjugates of solutions for real points: the parts of each vector are exchanged."""
    s = y[..., 8:].conj()
    return np.concatenate([_swap_conjugates(y), -s / (1.0 + s)], axis=-1)


def _swap_conjugates(y: Complex) -> Complex:
    return np.asarray(y[..., [1, 0, 3, 2, 5, 4, 7, 6]].conj())


class _OrbitSet:
    """The set of distinct orbits found."""

    def __init__(self, p: Complex) -> None:
        self.p = p
        self.y, self.low = np.empty((2, 0, 16), np.complex128)
        self._known = KnownPoints(3, ORBIT_TOLERANCE)
        self._on_way = KnownPoints(3, ORBIT_TOLERANCE)

    @property
    def missing(self) -> int:
        return ORBIT_COUNT - len(self.y)

    def begin_run(self) -> None:
        """Start a new run: its ends are compared with one another afresh."""
        self._on_way = KnownPoints(3, ORBIT_TOLERANCE)

    def add(self, y: Complex, low: Complex) -> Mask:
        """Add the sound ends of a run; return their mask, true only for the first of several in one orbit."""
        sound = self._check_soundness(y, low)
        # Two paths of one run in one orbit: one of them has jumped, and its own orbit is still missing.
        sound[sound] = self._on_way.add(compute_orbit_keys(y[sound], self.p, low[sound]))
        self._join(y[sound], low[sound])
        return sound

    def _check_soundness(self, y: Complex, low: Complex) -> Mask:
        keys = compute_orbit_keys(y, self.p, low)
        return np.asarray(
            np.isfinite(keys).all(axis=-1) & is_linkage(y) & (compute_residuals(y, self.p, low) <= MAX_RESIDUAL)
        )

    def _join(self, y: Complex, low: Complex) -> None:
        new = self._known.add(compute_orbit_keys(y, self.p, low))
        self.y, self.low = np.concatenate([self.y, y[new]]), np.concatenate([self.low, low[new]])

    def holds(self, y: Complex) -> bool:
        """Return whether all the given solutions are known."""
        return bool(self._known.mark_known(compute_orbit_keys(y, self.p)).all())

    def add_conjugates(self) -> None:
        """Add the missing conjugates of known orbits."""
        mirrored = compute_conjugates(self.y)
        alone = ~self._known.mark_known(compute_orbit_keys(mirrored, self.p))
        if alone.any():
            low = np.concatenate([_swap_conjugates(self.low[alone]), np.zeros((np.count_nonzero(alone), 8))], axis=-1)
            # The conjugate of an inaccurate end need not satisfy the equations to rounding.
            y, low, moved = refine(PRECISE_NINE_POINT_SYSTEM, mirrored[alone], low, self.p)
            kept = (moved < CONVERGENCE_TOLERANCE) & self._check_soundness(y, low)
            self._join(y[kept], low[kept])


def _run_paths(orbits: _OrbitSet, bend: Complex, threads: int, progress: Callable[[float], None]) -> int:
    """Follow all orbits along one parameter path and add the ends; return the number that had to be followed again."""
    begun = load_nine_point_start()
    orbits.begin_run()
    lost: list[int] = []
    for first in range(0, ORBIT_COUNT, PORTION_SIZE):
        some = np.arange(first, min(first + PORTION_SIZE, ORBIT_COUNT))
        sound = _follow_paths(orbits, begun.y[some], begun.p, bend, FIRST_STEP_TOLERANCE, threads)
        lost += [int(n) for n in some[~sound]]
        progress(0.8 * (first + len(some)) / ORBIT_COUNT)
        # Give up early on special points; half a portion of slack avoids a decision on too few paths.
        if len(lost) > 0.5 * PORTION_SIZE + MAX_LOST_SHARE * ORBIT_COUNT:
            return len(lost)
    orbits.add_conjugates()
    for attempt in range(6):
        if orbits.missing == 0:
            break
        # Another cognate of the same orbit takes another, often easier path.
        members = construct_cognates(begun.y[lost], begun.p)[:, attempt % 3]
        tolerance = RETRY_STEP_TOLERANCE if attempt < 3 else LAST_STEP_TOLERANCE
        _follow_paths(orbits, members, begun.p, bend, tolerance, threads, again=True)
        orbits.add_conjugates()
        progress(0.8 + 0.03 * attempt)
    return len(lost)


def _follow_paths(
    orbits: _OrbitSet, y: Complex, begun: Complex, bend: Complex, tolerance: float, threads: int, *, again: bool = False
) -> Mask:
    """Follow solutions of the start to the problem; return the mask of those that have a sound end of their own.

    Lost paths (``again``) are followed in twice the precision.
    """
    ends = follow(
        PRECISE_NINE_POINT_SYSTEM if again else NINE_POINT_SYSTEM,
        y,
        ParameterPath(begun, orbits.p, bend),
        tolerance=tolerance,
        most_steps=MAX_STEPS,
        threads=threads,
        precise=again,
    )
    sound = np.asarray((ends.status == END_REACHED) & np.isfinite(ends.y).all(axis=-1))
    # Refine, so that the keys of ill-conditioned solutions have enough digits to distinguish them.
    y, low, _ = refine(PRECISE_NINE_POINT_SYSTEM, ends.y[sound], ends.low[sound], orbits.p)
    sound[sound] = orbits.add(y, low)
    return sound


def _extract_real_linkages(orbits: _OrbitSet) -> Complex:
    """Return the pivots of the real orbits' three cognates, in scaled coordinates: shape (triples, 3, 4)."""
    y = orbits.y
    if not len(y):
        return np.empty((0, 3, 4), np.complex128)
    apart = np.abs(y[:, :8:2] - y[:, 1:8:2].conj()).max(axis=-1)
    near = y[apart <= REAL_TOLERANCE * np.abs(y[:, :8]).max(axis=-1)].copy()
    # Project onto conjugate pairs; Newton's method stays among them if a real solution is near.
    near[:, :8:2] = 0.5 * (near[:, :8:2] + near[:, 1:8:2].conj())
    near[:, 1:8:2] = near[:, :8:2].conj()
    near, low, moved = refine(PRECISE_NINE_POINT_SYSTEM, near, np.zeros_like(near), orbits.p)
    real = (moved < CONVERGENCE_TOLERANCE) & (compute_residuals(near, orbits.p, low) <= MAX_RESIDUAL)
    members = construct_cognates(near[real], orbits.p)
    x_1, r_1, x_2, r_2 = (members[..., k] for k in (0, 2, 4, 6))
    return np.stack([x_1 - r_1, x_1, x_2 - r_2, x_2], axis=-1)
