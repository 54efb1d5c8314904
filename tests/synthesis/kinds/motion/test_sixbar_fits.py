"""Sixbars that are fitted to positions: on one branch, in order, and up to the limits themselves."""

from __future__ import annotations

import math

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.fit.linkage.closure import trace_linkage
from synthesis.fit.linkage.descent import Fit, descend_softly
from synthesis.fit.linkage.topology import list_forms
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar.solver import FINAL_STEP_COUNT, FINE_TOLERANCE, SIXBAR_FAMILY, LinkageSearch
from synthesis.registry import parse_problem
from tests.support.sixbars.motion import SIXBARS, Task, anyhow, false_claim, sound, stated, within_a_box

POSITIONS, LIMIT = 24, 20.0


@pytest.mark.slow
@pytest.mark.parametrize(("draw", "seed"), [pytest.param(within_a_box, 3, marks=pytest.mark.campaign), (anyhow, 1)])
def test_positions_are_met_on_one_branch_in_order(draw, seed) -> None:
    task = draw(np.random.default_rng(seed))
    problem = parse_problem({"kind": "motion", "positions": task, "max_designs": 2, "mechanisms": SIXBARS})
    designs = sound(solve(problem))
    assert designs
    assert not [fault for design in designs if (fault := false_claim(design, task))]


def plant_near_limit(rng: np.random.Generator, form) -> tuple[np.ndarray, np.ndarray, Task]:
    """Unknowns, inputs and positions of a sixbar that transmits with a little more than the limit."""
    n = len(form.nodes)
    while True:
        z = rng.normal(size=n) + 1j * rng.normal(size=n)
        inputs = np.linspace(0.0, rng.uniform(2.5, 5.0), POSITIONS)
        every = np.concatenate([np.linspace(0.0, inputs[-1], 80), inputs])
        places, cosines = np.empty((len(every), n, 2)), np.zeros((len(every), n))
        trace_linkage(form.nodes, z.view(float), every, places, cosines)
        if not math.cos(math.radians(LIMIT + 1.5)) < np.abs(cosines).max() < math.cos(math.radians(LIMIT + 0.3)):
            continue
        points = places[80:, form.point] @ [1.0, 1.0j]
        headings = np.unwrap(np.angle(places[80:, form.heading] @ [1.0, 1.0j] - points))
        if np.abs(z[:, None] - z).max() < 4.0 * np.abs(points[:, None] - points).max():
            return z, inputs, stated(points, np.degrees(headings))


@pytest.mark.parametrize(("kind", "number"), [("watt_1", 2), ("stephenson_1", 0)])
def test_a_fit_goes_on_to_the_limits_where_positions_are_met_there(kind, number) -> None:
    z, inputs, positions = plant_near_limit(np.random.default_rng(9), list_forms(kind, guides=True)[number])
    problem = parse_problem({"kind": "motion", "positions": positions, "mechanisms": [kind], "max_designs": 1})
    assert isinstance(problem, MotionProblem)
    search = LinkageSearch(problem, SIXBAR_FAMILY, (kind,))
    topology = list(search.kinds)[number]
    joints = (z - complex(search.task.origin)) / search.task.size
    # Headings count from the first position.
    turn = np.exp(-1j * math.radians(positions[0]["angle"]))
    along = turn * (joints[topology.heading] - joints[topology.point])
    joints[topology.heading] = joints[topology.point] + along / abs(along)
    x = np.concatenate([joints.view(float), np.log(np.diff(inputs))]) + 1e-4
    start = Fit(topology, x, inputs)
    (kept_off,) = descend_softly([start], search.build_task(search.limits.aims, FINAL_STEP_COUNT), 300, FINE_TOLERANCE)
    assert kept_off.cost > 1e-13
    (met,) = search.converge_fits([start])
    assert met.cost < 1e-18
