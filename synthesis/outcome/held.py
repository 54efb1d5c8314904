"""Demands on finished linkages that are the same for every kind, in the order of what they take to be judged."""

from __future__ import annotations

from typing import TypeVar

from synthesis.model.statement import StatedProblem
from synthesis.outcome.forces import held_to_forces
from synthesis.outcome.layout import held_to_planes
from synthesis.outcome.manufacture import held_to_yield
from synthesis.proof.room import judged_by_room

Design = TypeVar("Design")


def held_to_all(problem: StatedProblem, design: Design) -> Design | None:
    """A verified design with the checks of its room, forces, planes and yield, as far as these are demanded.

    One that breaks a check is not looked at further. None where no mechanism can be built from what it states.
    """
    judged = judged_by_room(problem, design)
    if judged is None:
        return None
    return held_to_yield(problem, held_to_planes(problem, held_to_forces(problem, judged)))
