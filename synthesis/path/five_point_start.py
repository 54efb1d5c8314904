"""The start of every five-point problem on given pivots: all solutions for one set of general complex parameters.

Run as a program (``python -m synthesis.path.five_point_start``) it solves one random complex linkage's own parameters,
follows the solution around random loops of the parameters until there are 36 solutions and more loops find none (Duff
et al. 2019, doi:10.1093/imanum/dry017), and writes them beside this file.
"""

from __future__ import annotations

import argparse
import sys
from functools import cache
from importlib import resources
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.numerics.continuation import REACHED, follow
from synthesis.path.five_point_system import (
    GROUPS,
    PARAMETERS,
    SCRATCH,
    SOLUTIONS,
    UNKNOWNS,
    five_point_system,
    residuals,
)

Complex = NDArray[np.complex128]

FILE = "five_point_start.npz"

SEED = 5

SAME = 1e-8
"""Solutions that agree to this share are one: at the start all are well conditioned."""

QUIET_LOOPS, MOST_LOOPS = 12, 80
"""Loops without a new solution before the search ends, and loops at most."""


class Start(NamedTuple):
    """All solutions, shape (36, 8), for the parameters, shape (12,)."""

    y: Complex
    p: Complex


@cache
def start() -> Start:
    """The stored solutions."""
    with resources.files(__package__).joinpath(FILE).open("rb") as file, np.load(file) as stored:
        return Start(stored["y"], stored["p"])


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
    found, quiet = y[None], 0
    straight = np.zeros(PARAMETERS, np.complex128)
    for loop in range(MOST_LOOPS):
        corners = [p, *(rng.normal(size=(2, PARAMETERS, 2)) @ np.array([1.0, 1.0j])), p]
        moved = found
        for here, there in pairwise(corners):
            ends = follow(five_point_system, GROUPS, SCRATCH, moved, here, there, straight, tolerance=1e-3)
            moved = ends.y[ends.status == REACHED]
        moved = moved[residuals(moved, p) < SAME]
        before = len(found)
        found = distinct(np.concatenate([found, moved]))
        sys.stdout.write(f"loop {loop + 1}: {len(found)} solutions\n")
        quiet = quiet + 1 if len(found) == before else 0
        if len(found) == SOLUTIONS and quiet == QUIET_LOOPS:
            return Start(found, p)
    raise RuntimeError(f"{len(found)} solutions after {MOST_LOOPS} loops; {SOLUTIONS} are expected")


def main() -> None:
    """Make the start anew and store it."""
    parser = argparse.ArgumentParser(prog="python -m synthesis.path.five_point_start", description=main.__doc__)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--output", type=Path, default=Path(__file__).with_name(FILE))
    arguments = parser.parse_args()
    made = solve_by_monodromy(np.random.default_rng(arguments.seed))
    sys.stdout.write(f"largest residual: {residuals(made.y, made.p).max():.1e}\n")
    np.savez(arguments.output, y=made.y, p=made.p)


if __name__ == "__main__":
    main()
