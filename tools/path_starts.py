"""Recompute the start points of path problems: all solutions for generic complex parameters, by monodromy.

``python -m tools.path_starts nine`` chooses a random fourbar with complex dimensions and nine points on its coupler
curve, and finds one solution of each of the other 1441 orbits in about a minute.
``python -m tools.path_starts five`` does the same for five points with given fixed pivots, which have 36 solutions, in
seconds. :mod:`synthesis.kinds.path.exact.continuation_starts` reads the files.
"""

from __future__ import annotations

import argparse
from importlib import resources
from pathlib import Path

import numpy as np

from kinematics.arrays import Complex
from synthesis.kinds.path.exact import five_point_system as five
from synthesis.kinds.path.exact import nine_point_system as nine
from synthesis.kinds.path.exact.continuation_starts import StoredStart
from synthesis.kinds.path.exact.nine_point_system import is_linkage
from synthesis.numerics.continuation import END_REACHED, ParameterPath, follow
from tools.monodromy import all_solutions

NINE_SEED, FIVE_SEED = 9, 5
"""Seeds of the random generator for the stored files."""

SAME_ORBIT = 1e-7
"""Relative tolerance within which two keys belong to one orbit, and maximum residual of a solution. It can be this
small because all solutions are well conditioned for generic parameters."""

SAME_SOLUTION = 1e-8
"""Relative tolerance within which two solutions are identical, and maximum residual of a solution. It can be this small
because all solutions are well conditioned for generic parameters."""

FOLLOWING_TOLERANCE = 1e-3
"""Tolerance of the predictor along a loop. It may be coarse, because the solutions are refined at the corners."""

NINE_QUIET_LOOPS, NINE_MOST_LOOPS = 2, 60
FIVE_QUIET_LOOPS, FIVE_MOST_LOOPS = 12, 80
"""Number of consecutive loops without a new solution after which the search ends, and maximum number of loops."""

THREADS = 2

NEWTON_STEPS = 60
"""Number of Newton iterations, far more than needed from a random point to a solution of two equations."""


def solve_nine_points(rng: np.random.Generator) -> StoredStart:
    """Find one solution of each orbit of a random nine-point problem.

    Raises
    ------
    RuntimeError
        If the loops do not find all 1442 orbits. Try another seed.
    """
    y, p = nine_point_problem(rng)
    straight = np.zeros(nine.PARAMETER_COUNT, np.complex128)

    def followed(y: Complex, here: Complex, there: Complex) -> Complex:
        ends = follow(
            nine.NINE_POINT_SYSTEM,
            y,
            ParameterPath(here, there, straight),
            tolerance=FOLLOWING_TOLERANCE,
            threads=THREADS,
        )
        return np.asarray(ends.y[ends.status == END_REACHED])

    def distinct(ends: Complex) -> Complex:
        return _distinct_orbits(ends[is_linkage(ends) & (nine.compute_residuals(ends, p) < SAME_ORBIT)], p)

    y, p = all_solutions(
        y,
        p,
        followed,
        distinct,
        rng,
        count=nine.ORBIT_COUNT,
        quiet_loops=NINE_QUIET_LOOPS,
        most_loops=NINE_MOST_LOOPS,
        spread=float(np.abs(p).mean()),
    )
    return StoredStart(_smallest_member(y, p), p)


def solve_five_points(rng: np.random.Generator) -> StoredStart:
    """Find all solutions of a random problem of five points with given fixed pivots.

    Raises
    ------
    RuntimeError
        If the loops do not find all 36 solutions. Try another seed.
    """
    y, p = five_point_problem(rng)
    straight = np.zeros(five.PARAMETER_COUNT, np.complex128)

    def followed(y: Complex, here: Complex, there: Complex) -> Complex:
        ends = follow(
            five.FIVE_POINT_SYSTEM,
            y,
            ParameterPath(here, there, straight),
            tolerance=FOLLOWING_TOLERANCE,
        )
        return np.asarray(ends.y[ends.status == END_REACHED])

    return all_solutions(
        y,
        p,
        followed,
        lambda ends: _distinct(ends[five.compute_residuals(ends, p) < SAME_SOLUTION]),
        rng,
        count=five.SOLUTION_COUNT,
        quiet_loops=FIVE_QUIET_LOOPS,
        most_loops=FIVE_MOST_LOOPS,
    )


def nine_point_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Return a random solution y of the nine-point system and parameters p that it solves, shape (16,) each.

    For given dyads and a given rotation, both equations of a point are bilinear in (δ, δ̄) with the same quadratic
    term. Their difference is linear, which leaves one quadratic equation for δ.
    """

    def drawn() -> Complex:
        return np.asarray((rng.normal(size=8) + 1j * rng.normal(size=8)) * np.sqrt(0.5))

    vectors, turned = drawn(), drawn() * np.sqrt(2.0) - 1.0
    p = np.empty(nine.PARAMETER_COUNT, np.complex128)
    for j, s in enumerate(turned):
        s_back = -s / (1.0 + s)
        by_delta, by_conj, rest = [], [], []
        for dyad in (0, 4):
            x, x_conj, r, r_conj = vectors[dyad : dyad + 4]
            by_delta.append(x_conj * s_back + r_conj)
            by_conj.append(x * s + r)
            rest.append(x * s * x_conj * s_back + r * x_conj * s_back + r_conj * x * s)
        slope = -(by_delta[0] - by_delta[1]) / (by_conj[0] - by_conj[1])
        offset = -(rest[0] - rest[1]) / (by_conj[0] - by_conj[1])
        quadratic = [slope, offset + by_delta[0] + by_conj[0] * slope, by_conj[0] * offset + rest[0]]
        p[j] = np.roots(quadratic)[rng.integers(2)]
        p[8 + j] = slope * p[j] + offset
    return np.concatenate([vectors, turned]), p


def five_point_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Return random unknowns, and parameters with random pivots that these unknowns solve.

    Newton's method determines each point separately from the unknowns and the pivots.
    """

    def drawn(count: int) -> Complex:
        return np.asarray(rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))

    y, p = drawn(five.UNKNOWN_COUNT), drawn(five.PARAMETER_COUNT)
    for j in range(4):
        s = y[4 + j]
        s_back = -s / (1.0 + s)
        for _ in range(NEWTON_STEPS):
            gaps, slopes = np.empty(2, np.complex128), np.empty((2, 2), np.complex128)
            for dyad in range(2):
                x, x_bar, a, a_bar = y[2 * dyad], y[2 * dyad + 1], p[8 + 2 * dyad], p[9 + 2 * dyad]
                alpha, beta = p[j] + x * s, p[4 + j] + x_bar * s_back
                gaps[dyad] = alpha * beta + (x - a) * beta + (x_bar - a_bar) * alpha
                slopes[dyad] = beta + x_bar - a_bar, alpha + x - a
            p[[j, 4 + j]] -= np.linalg.solve(slopes, gaps)
    return y, p


def _smallest_member(y: Complex, p: Complex) -> Complex:
    """Return the cognate of each solution with the shortest vectors, which minimizes rounding errors.

    The result has shape (orbits, 16).
    """
    members = nine.construct_cognates(y, p)
    size = np.abs(members[..., :8]).max(axis=-1)
    members = members[np.arange(len(y)), np.where(np.isfinite(size), size, np.inf).argmin(axis=-1)]
    return np.asarray(members)


def _distinct_orbits(y: Complex, p: Complex) -> Complex:
    """Return the first solution of each orbit, in the given order."""
    keys = nine.compute_orbit_keys(y, p)
    size = np.abs(keys).max(axis=-1)
    kept: list[int] = []
    for n in range(len(y)):
        if not kept or (np.abs(keys[kept] - keys[n]).max(axis=-1) > SAME_ORBIT * size[n]).all():
            kept.append(n)
    return y[kept]


def _distinct(y: Complex) -> Complex:
    """Return the solutions without duplicates, in the given order."""
    kept: list[int] = []
    for n in range(len(y)):
        if not kept or (np.abs(y[kept] - y[n]).max(axis=1) > SAME_SOLUTION * np.abs(y[n]).max()).all():
            kept.append(n)
    return y[kept]


def main() -> None:
    """Recompute the start points of one problem and store them."""
    made_by = {
        "nine": (solve_nine_points, nine.compute_residuals, NINE_SEED),
        "five": (solve_five_points, five.compute_residuals, FIVE_SEED),
    }
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("points", choices=list(made_by))
    parser.add_argument("--seed", type=int, help="another one than that of the stored file")
    parser.add_argument("--output", type=Path, help="left out: in place of the stored file")
    arguments = parser.parse_args()
    solve, residuals, seed = made_by[arguments.points]
    stored = Path(str(resources.files("synthesis.kinds.path"))) / f"{arguments.points}_point_start.npz"
    start = solve(np.random.default_rng(seed if arguments.seed is None else arguments.seed))
    print(f"{len(start.y)} solutions, largest residual: {residuals(start.y, start.p).max():.1e}")
    np.savez(arguments.output or stored, y=start.y, p=start.p)


if __name__ == "__main__":
    main()
