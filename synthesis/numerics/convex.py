"""Convex programs by cvxpy and Clarabel: the library where it is needed, and the solution of one program."""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any


def modeling() -> Any:
    """cvxpy, imported where it is first needed: that takes a second, and only those who solve need it."""
    return import_module("cvxpy")


def minimized(cost: Any, constraints: list[Any]) -> bool:
    """Solve a program of cvxpy; whether it has a solution. One of reduced accuracy counts: whoever asks measures it."""
    cp = modeling()
    problem = cp.Problem(cp.Minimize(cost), constraints)
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Solution may be inaccurate")
            problem.solve(solver=cp.CLARABEL)
    except cp.SolverError:
        return False
    return problem.status in ("optimal", "optimal_inaccurate")
