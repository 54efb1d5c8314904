"""Sixbars that guide a point, without the service: what is held of a room and of limits."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from synthesis.fit.linkage.setting import INPUT_BOX, PIVOT_BOX, WORKSPACE_BOX
from synthesis.fit.linkage.topology import SIXBAR_FORMS
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.sixbar.limits import WORKSPACE_MARGIN, build_packer
from synthesis.kinds.path.sixbar.mechanism import build_fitted_sixbar
from synthesis.kinds.path.sixbar.shape_matching import find_similar_linkages
from synthesis.kinds.path.task.ranking import build_ordering
from synthesis.model.answer import Search
from synthesis.registry import parse_problem
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.support.synthesis.random_linkages import trace_nodes

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
    setting = build_packer(problem, centre, size, 20.0, 10.0)(SIXBAR_FORMS["stephenson_3"][0])
    for pivots in (INPUT_BOX, PIVOT_BOX):
        assert setting[pivots] == pytest.approx(setting[WORKSPACE_BOX])
    sides = (
        setting[WORKSPACE_BOX] * size
        + np.array([10.0, 10.0, 5.0, 5.0])
        - WORKSPACE_MARGIN * size * np.array([1.0, -1.0, 1.0, -1.0])
    )
    assert sides == pytest.approx([-118.0, 138.0, -108.0, 148.0])
    assert problem.space.shrink_box_for_joints() == (-118.0, 138.0, -108.0, 148.0)
    assert problem.space.shrink_box_for_joints(1.0) == (-117.0, 137.0, -107.0, 147.0)


FORMS = [(kind, n) for kind, forms in SIXBAR_FORMS.items() for n in range(len(forms))]
CIRCLE = np.exp(2j * np.pi * np.arange(48) / 48)


@pytest.mark.parametrize(("kind", "n"), FORMS)
def test_the_core_drives_the_same_curve_once_around(kind, n):
    """The analysis core closes loops by root finding; the engine intersects circles from the input outwards."""
    topology = SIXBAR_FORMS[kind][n]
    fit = find_similar_linkages(topology, CIRCLE.real + 0.6j * CIRCLE.imag, True, 1024, 1, np.random.default_rng(0))[0]
    sixbar = build_fitted_sixbar(kind, fit, 3.0 - 2.0j, 7.0)
    mechanism = rebuild_mechanism(sixbar)
    inputs = 2.0 * np.pi * np.arange(2000) / 2000
    motion = drive(mechanism, float(mechanism.reference_input) + inputs, order=0)
    assert motion.valid.all()
    expected = 3.0 - 2.0j + 7.0 * trace_nodes(topology, fit.x, fit.inputs)[:, topology.point] @ [1.0, 1.0j]
    gaps = np.abs(expected[:, None] - motion.joints["P"][0]).min(axis=1)
    # The core's grid of inputs is 1/2000 of a turn.
    assert gaps.max() < 0.05
    assert abs(motion.joints["P"][0][0] - expected[0]) < 1e-9
    assert sixbar.type == kind
    assert set(motion.sines) == ({"link_3", "link_5", "output"} if topology.triad else {"coupler", "link_5"})
    assert min(np.abs(sines).min() for sines in motion.sines.values()) > math.sin(math.radians(14.0))
    body = next(link for link in sixbar.skeleton.links if "P" in link.joints)
    assert body.name == topology.body
    assert not {"O2", "O4", "O6"} & set(body.joints)


def test_rounds_say_of_which_types_they_are():
    told = PathProblem.model_json_schema()["properties"]["rounds"]["description"]
    assert "For fourbars" in told
    assert "including sixbars, are sampled once and ignore this field" in told


def as_of(error: float | None, quality: float, *, passed: bool = True) -> SimpleNamespace:
    """As much of a design as decides its place; one without an error meets its points."""
    metrics = SimpleNamespace(
        rms_distance=error or 0.0, excursion=0.0, curve_distance=error, quality=quality, size=quality,
        min_transmission_angle=25.0 + quality, link_ratio=2.0,
    )  # fmt: skip
    residuals = [SimpleNamespace(residual=error or 0.0)]
    return SimpleNamespace(metrics=metrics, targets=residuals, verification=SimpleNamespace(passed=passed))


@pytest.mark.parametrize("order", ["quality", "accuracy", "size", "transmission_angle"])
def test_what_meets_the_points_stands_before_what_is_fitted_to_them_in_every_order(order):
    few = {"points": TASK["points"][:9], "mechanisms": ["slider_crank", "stephenson_3"], "rank_by": order}
    problem = parse_problem({"kind": "path", **few})
    far, near, broken = as_of(8.0, 0.9), as_of(1.0, 0.1), as_of(None, 0.95, passed=False)
    exact = as_of(None, 0.2), as_of(None, 0.5)
    for designs in itertools.permutations([far, near, broken, *exact]):
        order_found = build_ordering(problem)(list(designs))
        assert {id(one) for one in order_found[:2]} == {id(one) for one in exact}
        assert order_found[2] is near
        assert order_found[3] is far
        assert order_found[4] is broken


@pytest.mark.parametrize(
    ("more", "complete", "told"),
    [
        ({"mechanism": "slider_crank"}, False, "No slider-crank was found that meets the points exactly"),
        ({}, True, "No fourbar meets the points exactly"),
        ({"mechanisms": ["fourbar", "watt_1"]}, False, "No sixbar was found that meets the points exactly"),
    ],
)
def test_of_which_type_none_meets_the_points_is_told_before_it_is_fitted(more, complete, told):
    problem = parse_problem({"kind": "path", "points": TASK["points"][:6], **more})

    def answer(count: int) -> PathResult:
        design = SimpleNamespace(targets=[SimpleNamespace(point_residual=0.1)], verification=SimpleNamespace(passed=1))
        search = Search(method="a", complete=complete, candidates=1, accepted=count, rejected={}, seed=0)
        return PathResult.model_construct(designs=[design] * count, search=search, summary="")

    found = solve_exactly_or_fit(problem, lambda *_: None, lambda *_: answer(0), lambda *_: answer(1))
    assert found.summary.startswith(f"{told} and satisfies all constraints; the points are fitted instead.")
