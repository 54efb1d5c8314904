"""Recompute the start points of Watt II sixbars for nine pairs: all solutions for generic complex rotations.

``python -m tools.watt_start`` takes about a quarter of an hour of processor time. It chooses a random sixbar with
complex dimensions and random rotations of its input. Two quadratic equations give each rotation of the output. All
other solutions are found by monodromy (:mod:`tools.monodromy`).

:mod:`synthesis.kinds.function.nine_pairs.continuation` reads the file. It stores the solutions in single precision, and
Newton's method restores the remaining digits.
"""

from __future__ import annotations

import argparse
from importlib import resources
from pathlib import Path

import numpy as np

from kinematics.arrays import Complex
from synthesis.kinds.function.nine_pairs.system import (
    NINE_PAIR_SYSTEM,
    PARAMETER_COUNT,
    SOLUTION_COUNT,
    UNKNOWN_COUNT,
    compute_residuals,
    is_linkage,
)
from synthesis.numerics.continuation import END_REACHED, ParameterPath, follow
from tools.monodromy import all_solutions

SEED = 9
"""Seed of the random generator for the stored file."""

SPREAD = 1.0
"""Scale of the parameters, which are the rotations minus 1, at the corners of the loops."""

FOLLOWING_TOLERANCE = 1e-3
"""Tolerance of the predictor along a loop."""

SAME, RESIDUAL = 1e-7, 1e-9
"""Relative tolerance within which two solutions are identical, and maximum residual of a solution."""

QUIET_LOOPS, MOST_LOOPS = 2, 60
"""Number of consecutive loops without a new solution after which the search ends, and maximum number of loops."""

THREADS = 2


def nine_pair_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Return a random sixbar y, shape (8,), and parameters p, shape (16,), that it satisfies: rotations minus 1."""

    def drawn(count: int) -> Complex:
        return np.asarray(rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))

    y, p = drawn(UNKNOWN_COUNT), np.empty(PARAMETER_COUNT, np.complex128)
    a, a_bar, c, c_bar, d, d_bar, e, e_bar = y
    p[:8] = drawn(8)
    for j, u in enumerate(1.0 + p[:8]):
        # The distances |1 + c q − a u|² and |1 + e w − d q|² keep their values in the first position, where u, q and w
        # are 1. The first condition gives q for the input rotation u, the second gives w for q.
        at_first = a + a_bar - c - c_bar + c * a_bar + c_bar * a
        turns = [c * (1.0 - a_bar / u), at_first - a * u - a_bar / u, c_bar * (1.0 - a * u)]
        q = np.roots(turns)[rng.integers(2)]
        at_first = d + d_bar - e - e_bar + e * d_bar + e_bar * d
        turns = [e * (1.0 - d_bar / q), at_first - d * q - d_bar / q, e_bar * (1.0 - d * q)]
        p[8 + j] = np.roots(turns)[rng.integers(2)] - 1.0
    return y, p


def solve_nine_pairs(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Find all 26,370 solutions of a random nine-pair problem.

    Returns
    -------
    tuple
        The solutions, shape (26370, 8), and the parameters that they share: the rotations minus 1.

    Raises
    ------
    RuntimeError
        If the loops do not find all solutions. Try another seed.
    """
    y, p = nine_pair_problem(rng)
    straight, across = (
        np.zeros(PARAMETER_COUNT, np.complex128),
        rng.normal(size=(UNKNOWN_COUNT, 2)) @ np.array([1.0, 1.0j]),
    )

    def followed(y: Complex, here: Complex, there: Complex) -> Complex:
        ends = follow(
            NINE_PAIR_SYSTEM,
            y,
            ParameterPath(here, there, straight),
            tolerance=FOLLOWING_TOLERANCE,
            threads=THREADS,
        )
        return np.asarray(ends.y[ends.status == END_REACHED])

    def distinct(ends: Complex) -> Complex:
        ends = ends[is_linkage(ends) & (compute_residuals(ends, p) < RESIDUAL)]
        keys = ends @ across
        order = np.lexsort((keys.imag, keys.real))
        ends, keys = ends[order], keys[order]
        apart = np.abs(np.diff(keys)) > SAME * np.abs(keys[1:])
        return np.asarray(ends[np.concatenate([[True], apart])])

    return all_solutions(
        y,
        p,
        followed,
        distinct,
        rng,
        count=SOLUTION_COUNT,
        quiet_loops=QUIET_LOOPS,
        most_loops=MOST_LOOPS,
        spread=SPREAD,
    )


def main() -> None:
    """Recompute the start points and store them."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--seed", type=int, default=SEED, help="another one than that of the stored file")
    parser.add_argument("--output", type=Path, help="left out: in place of the stored file")
    asked = parser.parse_args()
    stored = Path(str(resources.files("synthesis.kinds.function"))) / "nine_pair_start.npz"
    y, p = solve_nine_pairs(np.random.default_rng(asked.seed))
    print(f"{len(y)} solutions, largest residual: {compute_residuals(y, p).max():.1e}")
    np.savez(asked.output or stored, y=y.astype(np.complex64), p=p)


if __name__ == "__main__":
    main()
