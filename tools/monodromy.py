"""Computation of all solutions of a parametrized polynomial system from one known solution, by monodromy.

As the parameters move around a closed loop, the solutions are permuted, so a known solution generally returns as
another solution for the same parameters. All known solutions are tracked around random triangles in parameter space,
and new end points are added to them. The search ends when the number of solutions known from theory has been found and
several further loops have added none (Duff et al. 2019, doi:10.1093/imanum/dry017).

The computation takes seconds to minutes and is done once. Its solutions are the start points from which homotopy
continuation solves every problem of the same type (:mod:`synthesis.numerics.continuation`).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from kinematics.arrays import Complex
from synthesis.kinds.path.exact.continuation_starts import StoredStart


def all_solutions(
    y: Complex,
    p: Complex,
    followed: Callable[[Complex, Complex, Complex], Complex],
    distinct: Callable[[Complex], Complex],
    rng: np.random.Generator,
    *,
    count: int,
    quiet_loops: int,
    most_loops: int,
    spread: float = 1.0,
) -> StoredStart:
    """Find all solutions for the parameters ``p``.

    Parameters
    ----------
    y : complex, shape (unknowns,)
        One known solution for ``p``.
    p : complex, shape (parameters,)
        Parameters of the system.
    followed : callable
        Takes solutions, their parameters and the target parameters; returns the solutions for the target parameters
        whose paths were tracked to the end.
    distinct : callable
        Takes end points of paths for ``p``; returns those that are solutions, without duplicates, in a fixed order.
    count : int
        Number of solutions known from theory.
    quiet_loops : int
        Number of consecutive loops without a new solution after which the search ends.
    most_loops : int
        Maximum number of loops.
    spread : float
        Scale of the random parameters at the corners of the loops.

    Raises
    ------
    RuntimeError
        If ``count`` solutions are not found within ``most_loops`` loops. Try another seed.
    """
    found, quiet = y[None], 0
    for loop in range(most_loops):
        corners = [p, *(spread * (rng.normal(size=(2, len(p), 2)) @ np.array([1.0, 1.0j]))), p]
        moved = found
        for here, there in pairwise(corners):
            moved = followed(moved, here, there)
        before = len(found)
        found = distinct(np.concatenate([found, moved]))
        print(f"loop {loop + 1}: {len(found)} solutions")
        quiet = quiet + 1 if len(found) == before else 0
        if len(found) == count and quiet == quiet_loops:
            return StoredStart(found, p)
    raise RuntimeError(f"{len(found)} solutions after {most_loops} loops; {count} are expected")
