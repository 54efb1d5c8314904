"""Sixbars that guide a point, without the service: what is held of a room and of limits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.sixbar_fit import ROOM_MARGIN, sixbar_setting
from synthesis.kinds.path.sixbar_rows import ROOM
from synthesis.registry import parse_problem

TURN = np.linspace(0.0, 2.0 * np.pi, 36, endpoint=False)
EIGHT = 40.0 * np.sin(TURN) + 25.0j * np.sin(2.0 * TURN) + 10.0 + 5.0j
FAR_AWAY = {"polygon": [[900.0, 900.0], [910.0, 900.0], [905.0, 910.0]]}


def listed(points) -> list[dict[str, float]]:
    return [{"x": float(z.real), "y": float(z.imag)} for z in points]


TASK: dict[str, Any] = {
    "kind": "path",
    "method": "curve_match",
    "closed": True,
    "points": listed(EIGHT),
    "mechanisms": ["stephenson_3"],
    "constraints": {"grashof": "crank_rocker", "min_transmission_angle": 20.0},
    "max_designs": 1,
}


@pytest.mark.parametrize("clearance", [0.0, 60.0])
def test_the_box_of_joints_is_half_a_link_within_that_of_parts_whatever_obstacles_ask_for(clearance):
    room = {"box": [[-120.0, -110.0], [140.0, 150.0]], "link_width": 4.0, "obstacles": [FAR_AWAY]}
    problem = parse_problem(TASK | {"space": room | {"clearance": clearance}})
    centre, size = 10.0 + 5.0j, 80.0
    held = sixbar_setting(problem, centre, size, 20.0, 10.0)[ROOM : ROOM + 4] * size
    sides = held + np.array([10.0, 10.0, 5.0, 5.0]) - ROOM_MARGIN * size * np.array([1.0, -1.0, 1.0, -1.0])
    assert sides == pytest.approx([-118.0, 138.0, -108.0, 148.0])
    assert problem.space.box_of_joints() == (-118.0, 138.0, -108.0, 148.0)
    assert problem.space.box_of_joints(1.0) == (-117.0, 137.0, -107.0, 147.0)


def test_rounds_say_of_which_types_they_are():
    told = PathProblem.model_json_schema()["properties"]["rounds"]["description"]
    assert "For fourbars" in told
    assert "sixbars among them, are drawn once, and it changes nothing" in told
