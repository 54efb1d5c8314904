"""The start of every nine-point problem: all solutions for one set of general parameters, found by monodromy.

Run as a program (``python -m synthesis.path.nine_point_start``) it draws a fourbar with complex dimensions and
parameters that it solves, follows the solution around random loops of the parameters, which lead to other solutions of
the same parameters, and does so with all that are known until there are 1442 orbits and two more loops find none
(Duff et al. 2019, doi:10.1093/imanum/dry017). What it writes beside this file is read by :func:`start`.
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
from synthesis.path.nine_point_system import (
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


class Start(NamedTuple):
    """One solution of each orbit, shape (1442, 16), for the parameters, shape (16,)."""

    y: Complex
    p: Complex


@cache
def start() -> Start:
    """The stored solutions."""
    with resources.files(__package__).joinpath(FILE).open("rb") as file, np.load(file) as stored:
        return Start(stored["y"], stored["p"])


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
    found, quiet, threads = y[None], 0, 2
    straight = np.zeros(PARAMETERS, np.complex128)
    for loop in range(MOST_LOOPS):
        corners = [p, *(np.abs(p).mean() * (rng.normal(size=(2, PARAMETERS, 2)) @ [1.0, 1.0j])), p]
        moved = found
        for here, there in pairwise(corners):
            ends = follow(
                nine_point_system, GROUPS, SCRATCH, moved, here, there, straight, tolerance=1e-3, threads=threads
            )
            moved = ends.y[ends.status == REACHED]
        moved = moved[is_linkage(moved) & (residuals(moved, p) < SAME_ORBIT)]
        before = len(found)
        found = distinct_orbits(np.concatenate([found, moved]), p)
        sys.stdout.write(f"loop {loop + 1}: {len(found)} orbits\n")
        quiet = quiet + 1 if len(found) == before else 0
        if len(found) == ORBITS and quiet == QUIET_LOOPS:
            return Start(smallest_member(found, p), p)
    raise RuntimeError(f"{len(found)} orbits after {MOST_LOOPS} loops; {ORBITS} are expected")


def main() -> None:
    """Make the start anew and store it."""
    parser = argparse.ArgumentParser(prog="python -m synthesis.path.nine_point_start", description=main.__doc__)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--output", type=Path, default=Path(__file__).with_name(FILE))
    arguments = parser.parse_args()
    made = solve_by_monodromy(np.random.default_rng(arguments.seed))
    sys.stdout.write(f"largest residual: {residuals(made.y, made.p).max():.1e}\n")
    np.savez(arguments.output, y=made.y, p=made.p)


if __name__ == "__main__":
    main()
