"""All solutions of a system for one set of general parameters, found from a single one.

While the parameters go around a closed loop, the solutions change places: one that is known comes back as another one
of the same parameters. All that are known are followed around random triangles, and what is new at their ends joins
them, until there are as many as theory says and some more loops have found none (monodromy: Duff et al. 2019,
doi:10.1093/imanum/dry017). That takes seconds to minutes and is done once; what it finds is where every problem of the
same sort begins (:mod:`synthesis.numerics.continuation`).
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
    """All solutions for the parameters ``p``.

    Parameters
    ----------
    y, p
        One solution, shape (unknowns,), and its parameters, shape (parameters,).
    followed : callable
        Of solutions, parameters and other parameters: the solutions for those that were reached.
    distinct : callable
        Of ends of paths for ``p``: those that are solutions, each once and in their order.
    count, quiet_loops, most_loops : int
        How many there are; loops without a new one before the search ends; loops at most.
    spread : float
        Size of the parameters at the corners of the loops.

    Raises
    ------
    RuntimeError
        When the loops do not come to ``count`` solutions; another seed will do.
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
