"""Constraints on finished linkages that all kinds share, checked in the order of their cost."""

from __future__ import annotations

from typing import TypeVar

from synthesis.model.problem import ProblemBase
from synthesis.results.forces import verify_forces
from synthesis.results.layout import verify_planes
from synthesis.results.manufacture import verify_yield
from synthesis.verification.shared_constraints import check_workspace_of_design

Design = TypeVar("Design")


def verify_all_constraints(problem: ProblemBase, design: Design) -> Design | None:
    """Return a verified design with the checks of its workspace, forces, planes and yield, as far as required.

    The first failed check ends the verification. None if no mechanism can be built from the dimensions of the design.
    """
    judged = check_workspace_of_design(problem, design)
    if judged is None:
        return None
    # Cheapest first: forces take milliseconds, planes a search, the yield thousands of samples.
    return verify_yield(problem, verify_planes(problem, verify_forces(problem, judged)))
