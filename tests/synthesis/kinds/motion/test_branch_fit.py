"""Fits of sixbars to positions: what only the room before the limits holds off is met within the limits themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar import residuals as rows
from synthesis.kinds.motion.sixbar.dyad_assembly import O4, Q1, Q2, A, B, J, compute_signed_sine
from synthesis.kinds.motion.sixbar.least_squares import compute_fit_value
from synthesis.kinds.motion.sixbar.solver import SixbarSearch
from synthesis.kinds.motion.sixbar.topologies import TOPOLOGIES
from synthesis.registry import parse_problem
from tests.support.sixbars.motion import stated

POSITIONS, LIMIT = 24, 20.0
SPAN = 100.0


def planted(rng: np.random.Generator, make: int) -> tuple[np.ndarray, float, np.ndarray, Any]:
    """Joints of a sixbar that transmits with a little more than the limit, its turn, its sides, and its positions."""
    at, turns = np.empty(6, complex), np.ones(4, complex)
    while True:
        z = rng.normal(size=7) + 1j * rng.normal(size=7)
        setting = np.zeros(rows.SETTING.size)
        sides = np.sign([compute_signed_sine(z[A], z[O4], z[B]), compute_signed_sine(z[Q1], z[Q2], z[J])])
        setting[[rows.TOPOLOGY, rows.FIRST_SIDE, rows.SECOND_SIDE]] = make, *sides
        lengths, inverses = np.empty(4), np.empty(4, complex)
        rows.compute_dimensions(z, lengths, inverses)
        turn = rng.uniform(2.5, 5.0)
        points, angles, most = [], [], 0.0
        for angle in [*np.linspace(0.0, turn, 80), *np.linspace(0.0, turn, POSITIONS)]:
            most = max(most, *map(abs, rows.drive_linkage(z, lengths, inverses, setting, angle, at, turns)))
            points.append(at[5])
            angles.append(math.degrees(np.angle(turns[3])))
        if math.cos(math.radians(LIMIT + 1.5)) < most < math.cos(math.radians(LIMIT + 0.3)):
            met = np.array(points[-POSITIONS:])
            size = np.abs(met[:, None] - met).max()
            if np.abs(np.append(z, 0.0)[:, None] - np.append(z, 0.0)).max() < 4.0 * size:
                return z, turn, sides, stated(SPAN * met, np.array(angles[-POSITIONS:]))


@pytest.mark.parametrize("make", [0, 3])
def test_a_fit_goes_on_to_the_limits_where_positions_are_met_there(make: int) -> None:
    z, turn, sides, positions = planted(np.random.default_rng(9), make)
    kind = TOPOLOGIES[make].type
    problem = parse_problem({"kind": "motion", "positions": positions, "mechanisms": [kind], "max_designs": 1})
    assert isinstance(problem, MotionProblem)
    values = []
    for held_off in (True, False):
        whole = SixbarSearch(problem, (kind,))
        search = whole.branches
        pool = search.pools[0]
        joints = np.array([whole.task.to_task(SPAN * complex(joint)) for joint in z])
        pool.x[0, : rows.JOINT_COORDINATE_COUNT] = joints.view(float) + 1e-3
        pool.x[0, rows.JOINT_COORDINATE_COUNT :] = math.log(turn / (POSITIONS - 1))
        pool.settings[0] = search.settings[0]
        pool.settings[0, [rows.TOPOLOGY, rows.INPUT_DIRECTION, rows.FIRST_SIDE, rows.SECOND_SIDE]] = make, 1.0, *sides
        pool.costs[0] = 1.0
        if held_off:
            search.bare = search.settings[0]
        values.append(float(search.fit_pools().values.max()))
    assert values[0] < compute_fit_value(1e-6)
    assert values[1] > compute_fit_value(1e-9)
