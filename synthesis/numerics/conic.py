"""Conic programs in Clarabel's own form, without a modelling layer, so that building one costs almost nothing.

    minimize  c·x   subject to   b − A x ∈ K,

with K a product of zero cones, nonnegative orthants and second-order cones {(t, v): t ≥ |v|}. The solution includes the
dual objective, which is a lower bound of the minimum for any program of this form. If the solver reaches only its
reduced accuracy (5·10⁻⁵ instead of 10⁻⁸) with all settings, the result is a usable minimizer but proves nothing: it
gives no lower bound, and it does not show that a program is infeasible or unbounded.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Real

Status = Literal["solved", "infeasible", "unbounded", "failed"]

STATUSES: dict[str, Status] = {
    "Solved": "solved",
    "AlmostSolved": "solved",
    "PrimalInfeasible": "infeasible",
    "DualInfeasible": "unbounded",
}
"""Status of a program by Clarabel's name for it; every other name counts as failed."""


class ConeRows(NamedTuple):
    """Rows b − A x in one cone, or in several second-order cones of ``size`` rows each."""

    cone: Literal["zero", "nonnegative", "second_order"]
    matrix: Real
    offset: Real
    size: int = 0


class Solution(NamedTuple):
    """Minimizer, minimum, and a lower bound of the minimum from the dual; valid if ``status`` is "solved".

    At reduced accuracy the bound is −∞, and a program that seems infeasible or unbounded counts as failed.
    """

    x: Real
    value: float
    dual: float
    status: Status


SOLVER_SETTINGS: tuple[dict[str, float | bool], ...] = ({}, {"equilibrate_enable": False}, {"max_step_fraction": 0.95})
"""Settings to try in turn until the solver reaches full accuracy: some programs stall with one of them, but no known
program with all."""


def solve_conic_program(cost: Real, rows: Sequence[ConeRows]) -> Solution:
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
    for route in SOLVER_SETTINGS:
        # One thread: the programs are small, and callers run several at a time.
        settings = clarabel.DefaultSettings()
        settings.verbose = False
        settings.max_threads = 1
        # Settings that differ from the defaults, one set after another.
        for name, value in route.items():
            setattr(settings, name, value)
        found = clarabel.DefaultSolver(none, cost, matrix, offset, cones, settings).solve()
        reached = str(found.status)
        # Only a solution of full accuracy has a dual value that bounds the minimum.
        dual = float(found.obj_val_dual) if reached == "Solved" else -np.inf
        solution = Solution(np.array(found.x), float(found.obj_val), dual, STATUSES.get(reached, "failed"))
        # "Infeasible" and "unbounded" are final results, too.
        if reached in STATUSES and reached != "AlmostSolved":
            return solution
        # Remember the best inaccurate result: an almost solved program is better than a failed one.
        if nearly is None or (nearly.status == "failed" and solution.status == "solved"):
            nearly = solution
    assert nearly is not None
    return nearly
