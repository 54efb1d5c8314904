"""Makes the start of Watt II sixbars through nine pairs anew: all for one set of general complex turns, by monodromy.

``python -m tools.watt_start`` takes a quarter of an hour of a processor. A sixbar with complex dimensions is drawn with
turns of its input, and the turns of its output follow from two quadratic equations each; all others are met on ways
around loops (:mod:`tools.monodromy`). :mod:`synthesis.kinds.function.nine_pairs.continuation` reads the file, which has
the solutions in single precision: Newton's method brings the other digits back.
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
"""Of the stored file."""

SPREAD = 1.0
"""Size of turns, less 1, at the corners of loops."""

FOLLOWING_TOLERANCE = 1e-3
"""Of the prediction on the way around a loop."""

SAME, RESIDUAL = 1e-7, 1e-9
"""Solutions that agree to this share are one; residual of a solution at most."""

QUIET_LOOPS, MOST_LOOPS = 2, 60
"""Loops without a new solution before the search ends, and loops at most."""

THREADS = 2


def nine_pair_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """A sixbar that was drawn and turns that it meets: y, shape (8,), and p, shape (16,)."""

    def drawn(count: int) -> Complex:
        return np.asarray(rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))

    y, p = drawn(UNKNOWN_COUNT), np.empty(PARAMETER_COUNT, np.complex128)
    a, a_bar, c, c_bar, d, d_bar, e, e_bar = y
    p[:8] = drawn(8)
    for j, u in enumerate(1.0 + p[:8]):
        # |1 + c q − a u|² and then |1 + e w − d q|² are as in the first place, where q and w are 1.
        at_first = a + a_bar - c - c_bar + c * a_bar + c_bar * a
        turns = [c * (1.0 - a_bar / u), at_first - a * u - a_bar / u, c_bar * (1.0 - a * u)]
        q = np.roots(turns)[rng.integers(2)]
        at_first = d + d_bar - e - e_bar + e * d_bar + e_bar * d
        turns = [e * (1.0 - d_bar / q), at_first - d * q - d_bar / q, e_bar * (1.0 - d * q)]
        p[8 + j] = np.roots(turns)[rng.integers(2)] - 1.0
    return y, p


def solve_nine_pairs(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """All solutions of a random problem of nine pairs, shape (26 370, 8), and its turns.

    Raises
    ------
    RuntimeError
        When the loops do not come to as many; another seed will do.
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
    """Make the start anew and store it."""
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
