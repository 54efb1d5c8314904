"""Conic programs in the form that Clarabel takes, without a modelling layer: building one costs as good as nothing.

    minimize  c·x   subject to   b − A x ∈ K,

K the product of zero cones, nonnegative orthants and second-order cones {(t, v): t ≥ |v|}. The dual objective is told
too: of any program of this form it is a lower bound of the least value. What the solver reaches to its reduced accuracy
alone (5·10⁻⁵ instead of 10⁻⁸), on every route, is a minimizer, but no proof: neither a bound nor that there is none.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]


Status = Literal["solved", "infeasible", "unbounded", "failed"]

STATUSES: dict[str, Status] = {
    "Solved": "solved",
    "AlmostSolved": "solved",
    "PrimalInfeasible": "infeasible",
    "DualInfeasible": "unbounded",
}
"""What is known by what Clarabel says of a program; all else has failed."""


class Rows(NamedTuple):
    """Rows b − A x in one cone, or of second-order cones in many of ``size`` rows each."""

    cone: Literal["zero", "nonnegative", "second_order"]
    matrix: Real
    offset: Real
    size: int = 0


class Solution(NamedTuple):
    """The minimizer, its value and a lower bound of it by the dual; ``status`` tells whether there is one.

    At reduced accuracy the bound is −∞; what seems to be infeasible or unbounded has failed.
    """

    x: Real
    value: float
    dual: float
    status: Status


ROUTES: tuple[dict[str, float | bool], ...] = ({}, {"equilibrate_enable": False}, {"max_step_fraction": 0.95})
"""Settings that are tried in turn until the solver reaches its accuracy: some programs stall with one, not with all."""


def minimized(cost: Real, rows: Sequence[Rows]) -> Solution:
    """Solve a conic program by Clarabel's interior-point method."""
    clarabel, sparse = import_module("clarabel"), import_module("scipy.sparse")
    cones = []
    for part in rows:
        if part.cone == "second_order":
            cones += [clarabel.SecondOrderConeT(part.size)] * (len(part.offset) // part.size)
        else:
            make = clarabel.ZeroConeT if part.cone == "zero" else clarabel.NonnegativeConeT
            cones.append(make(len(part.offset)))
    matrix = sparse.csc_matrix(np.concatenate([part.matrix for part in rows]))
    offset = np.concatenate([part.offset for part in rows])
    none = sparse.csc_matrix((len(cost), len(cost)))
    nearly = None
    for route in ROUTES:
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1
        for name, value in route.items():
            setattr(settings, name, value)
        found = clarabel.DefaultSolver(none, cost, matrix, offset, cones, settings).solve()
        reached = str(found.status)
        dual = float(found.obj_val_dual) if reached == "Solved" else -np.inf
        solution = Solution(np.array(found.x), float(found.obj_val), dual, STATUSES.get(reached, "failed"))
        if reached in STATUSES and reached != "AlmostSolved":
            return solution
        if nearly is None or (nearly.status == "failed" and solution.status == "solved"):
            nearly = solution
    assert nearly is not None
    return nearly
