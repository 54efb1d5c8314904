"""Constraints on finished linkages that all kinds share, checked in the order of their cost."""

from __future__ import annotations

from typing import TypeVar

from synthesis.model.statement import StatedProblem
from synthesis.outcome.forces import held_to_forces
from synthesis.outcome.layout import held_to_planes
from synthesis.outcome.manufacture import held_to_yield
from synthesis.proof.room import judged_by_room

Design = TypeVar("Design")


def held_to_all(problem: StatedProblem, design: Design) -> Design | None:
    """Return a verified design with the checks of its workspace, forces, planes and yield, as far as required.

    The first failed check ends the verification. None if no mechanism can be built from the dimensions of the design.
    """
    judged = judged_by_room(problem, design)
    if judged is None:
        return None
    return held_to_yield(problem, held_to_planes(problem, held_to_forces(problem, judged)))
