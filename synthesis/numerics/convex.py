"""Convex programs in cvxpy, solved by Clarabel."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from importlib import import_module
from types import ModuleType


def import_cvxpy() -> ModuleType:
    """Import cvxpy and return it. The import takes a second, so that only callers that solve a program pay for it."""
    return import_module("cvxpy")


def solve_convex_program(cost: object, constraints: Sequence[object]) -> bool:
    """Solve a cvxpy program and return whether it has a solution.

    A solution of reduced accuracy counts as one, since callers measure the result themselves.
    """
    cp = import_cvxpy()
    problem = cp.Problem(cp.Minimize(cost), constraints)
    try:
        with warnings.catch_warnings():
            # The callers judge inaccurate solutions themselves, so the warning is noise.
            warnings.filterwarnings("ignore", message="Solution may be inaccurate")
            problem.solve(solver=cp.CLARABEL)
    except cp.SolverError:
        return False
    return problem.status in ("optimal", "optimal_inaccurate")
