"""Nearest miss if no design has the requested dwells: the same dwells, all shortened to one share of their lengths."""

from __future__ import annotations

from kinematics.message import compose
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.quantities import list_angles
from synthesis.model.answer import Reachable
from synthesis.model.json_object import JsonObject
from synthesis.model.kind import TaskEasing


def _shorten_dwells(problem: DwellProblem, share: float) -> DwellProblem:
    return problem.with_shorter_dwells(share)


def _list_dwells(problem: DwellProblem) -> JsonObject:
    """Return the dwells of a problem in degrees of the crank, in the field that the client used."""
    if problem.dwells is None:
        return {"dwell_angle": problem.dwell_angle}
    return {"dwell_angles": [dwell.angle for dwell in problem.dwells]}


def _describe_longest_dwells(reachable: Reachable) -> str:
    longest = reachable.dwell_angles or ([] if reachable.dwell_angle is None else [reachable.dwell_angle])
    angles = list_angles([f"{angle:.4g}" for angle in longest])
    return f" {compose('dwell-longest-dwells', angles=angles)}" if longest else ""


SHORTER_DWELLS = TaskEasing(_shorten_dwells, _list_dwells, _describe_longest_dwells)
