"""The start of every five-point problem on given pivots: all solutions for one set of general complex parameters.

Run as a program (``python -m synthesis.kinds.path.five_point_start``) it solves one random complex linkage's own
parameters, finds the other 35 solutions by monodromy (:mod:`synthesis.numerics.monodromy`), and writes them beside this
file.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.five_point_system import (
    GROUPS,
    PARAMETERS,
    SCRATCH,
    SOLUTIONS,
    UNKNOWNS,
    five_point_system,
    residuals,
)
from synthesis.numerics.continuation import REACHED, follow
from synthesis.numerics.monodromy import Start, all_solutions, remake, stored

Complex = NDArray[np.complex128]

FILE = "five_point_start.npz"

SEED = 5

SAME = 1e-8
"""Solutions that agree to this share are one: at the start all are well conditioned."""

QUIET_LOOPS, MOST_LOOPS = 12, 80
"""Loops without a new solution before the search ends, and loops at most."""


@cache
def start() -> Start:
    """The stored solutions, shape (36, 8), and their parameters, shape (12,)."""
    return stored(resources.files(__package__).joinpath(FILE))


def distinct(y: Complex) -> Complex:
    """The solutions without those that have been met before in the list."""
    kept: list[int] = []
    for n in range(len(y)):
        if not kept or (np.abs(y[kept] - y[n]).max(axis=1) > SAME * np.abs(y[n]).max()).all():
            kept.append(n)
    return y[kept]


def random_problem(rng: np.random.Generator) -> tuple[Complex, Complex]:
    """Random unknowns and pivots, and the points for which they are a solution, by Newton's method point by point."""

    def drawn(count: int) -> Complex:
        return np.asarray(rng.normal(size=(count, 2)) @ np.array([1.0, 1.0j]))

    y, p = drawn(UNKNOWNS), drawn(PARAMETERS)
    for j in range(4):
        s = y[4 + j]
        s_back = -s / (1.0 + s)
        for _ in range(60):
            gaps, slopes = np.empty(2, np.complex128), np.empty((2, 2), np.complex128)
            for dyad in range(2):
                x, x_bar, a, a_bar = y[2 * dyad], y[2 * dyad + 1], p[8 + 2 * dyad], p[9 + 2 * dyad]
                alpha, beta = p[j] + x * s, p[4 + j] + x_bar * s_back
                gaps[dyad] = alpha * beta + (x - a) * beta + (x_bar - a_bar) * alpha
                slopes[dyad] = beta + x_bar - a_bar, alpha + x - a
            p[[j, 4 + j]] -= np.linalg.solve(slopes, gaps)
    return y, p


def solve_by_monodromy(rng: np.random.Generator) -> Start:
    """All solutions of a random problem.

    Raises
    ------
    RuntimeError
        When the loops do not come to 36 solutions; another seed will do.
    """
    y, p = random_problem(rng)
    straight = np.zeros(PARAMETERS, np.complex128)

    def followed(y: Complex, here: Complex, there: Complex) -> Complex:
        ends = follow(five_point_system, GROUPS, SCRATCH, y, here, there, straight, tolerance=1e-3)
        return np.asarray(ends.y[ends.status == REACHED])

    return all_solutions(
        y,
        p,
        followed,
        lambda ends: distinct(ends[residuals(ends, p) < SAME]),
        rng,
        count=SOLUTIONS,
        quiet_loops=QUIET_LOOPS,
        most_loops=MOST_LOOPS,
    )


if __name__ == "__main__":
    remake(solve_by_monodromy, residuals, Path(__file__).with_name(FILE), SEED)
