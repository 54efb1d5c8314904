"""The start of every nine-point problem: all solutions for one set of general parameters, found by monodromy.

Run as a program (``python -m synthesis.kinds.path.nine_point_start``) it draws a fourbar with complex dimensions and
parameters that it solves, and finds one solution of each of the other 1441 orbits by monodromy
(:mod:`synthesis.numerics.monodromy`). What it writes beside this file is read by :func:`start`.
"""

from __future__ import annotations

from functools import cache
from importlib import resources
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.path.nine_point_system import (
    GROUPS,
    ORBITS,
    PARAMETERS,
    SCRATCH,
    cognates,
    nine_point_system,
    orbit_keys,
    random_problem,
    residuals,
)
from synthesis.numerics.continuation import REACHED, follow
from synthesis.numerics.monodromy import Start, all_solutions, remake, stored

Complex = NDArray[np.complex128]

FILE = "nine_point_start.npz"

SEED = 9
SAME_ORBIT = 1e-7
"""Orbits whose keys agree to this share are the same: at the start all solutions are well conditioned."""

APART = 1e-9
"""Dyads closer than this share of their size are one and the same: no linkage, and not counted among the 1442."""

QUIET_LOOPS = 2
"""Loops without a new orbit before the search ends."""

MOST_LOOPS = 60

THREADS = 2


@cache
def start() -> Start:
    """The stored solutions, one of each orbit: shape (1442, 16), for parameters of shape (16,)."""
    return stored(resources.files(__package__).joinpath(FILE))


def is_linkage(y: Complex) -> NDArray[np.bool_]:
    """Whether the two dyads of a solution differ: shape (...), for y of shape (..., 16).

    They must differ in both isotropic coordinates. Where they agree in one the system has whole curves of solutions, to
    which paths come that have lost their way.
    """
    differ = np.ones(y.shape[:-1], np.bool_)
    for half in ([0, 2], [1, 3]):
        first, second = y[..., half], y[..., [k + 4 for k in half]]
        size = np.maximum(np.abs(first), np.abs(second)).max(axis=-1)
        differ &= np.abs(first - second).max(axis=-1) > APART * size
    return differ


def smallest_member(y: Complex, p: Complex) -> Complex:
    """Of each orbit the solution with the shortest vectors, which rounding treats best: shape (orbits, 16)."""
    members = cognates(y, p)
    size = np.abs(members[..., :8]).max(axis=-1)
    members = members[np.arange(len(y)), np.where(np.isfinite(size), size, np.inf).argmin(axis=-1)]
    return np.asarray(members)


def distinct_orbits(y: Complex, p: Complex) -> Complex:
    """The solutions without those whose orbit has been met before in the list."""
    keys = orbit_keys(y, p)
    size = np.abs(keys).max(axis=-1)
    kept: list[int] = []
    for n in range(len(y)):
        if not kept or (np.abs(keys[kept] - keys[n]).max(axis=-1) > SAME_ORBIT * size[n]).all():
            kept.append(n)
    return y[kept]


def solve_by_monodromy(rng: np.random.Generator) -> Start:
    """All orbits of a random problem.

    Raises
    ------
    RuntimeError
        When the loops do not come to 1442 orbits; another seed will do.
    """
    y, p = random_problem(rng)
    straight = np.zeros(PARAMETERS, np.complex128)

    def followed(y: Complex, here: Complex, there: Complex) -> Complex:
        ends = follow(nine_point_system, GROUPS, SCRATCH, y, here, there, straight, tolerance=1e-3, threads=THREADS)
        return np.asarray(ends.y[ends.status == REACHED])

    def distinct(ends: Complex) -> Complex:
        return distinct_orbits(ends[is_linkage(ends) & (residuals(ends, p) < SAME_ORBIT)], p)

    found = all_solutions(
        y,
        p,
        followed,
        distinct,
        rng,
        count=ORBITS,
        quiet_loops=QUIET_LOOPS,
        most_loops=MOST_LOOPS,
        spread=float(np.abs(p).mean()),
    )
    return Start(smallest_member(found.y, p), p)


if __name__ == "__main__":
    remake(solve_by_monodromy, residuals, Path(__file__).with_name(FILE), SEED)
