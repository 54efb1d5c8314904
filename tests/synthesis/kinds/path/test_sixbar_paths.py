"""Sixbars and eightbars that guide a point, without the service: constraints, closure, and the choice of types."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from synthesis.fit.linkage.mechanism import build_fitted_linkage
from synthesis.fit.linkage.setting import INPUT_BOX, PIVOT_BOX, WORKSPACE_BOX
from synthesis.fit.linkage.topology import list_forms
from synthesis.kinds.path import type_selection
from synthesis.kinds.path.design import PathResult
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.multiloop.limits import WORKSPACE_MARGIN, build_packer
from synthesis.kinds.path.multiloop.shape_matching import find_similar_linkages
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.task.ranking import build_ordering
from synthesis.kinds.path.task.target_curve import MIN_POLYLINE_POINTS
from synthesis.model.answer import Search
from synthesis.registry import parse_problem
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.campaign import further
from tests.oracles.loops import Loops
from tests.support.answers import solve
from tests.support.synthesis.random_linkages import SIXBAR_FORMS, trace_nodes

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
    setting = build_packer(problem, centre, size, 20.0, 10.0)(list_forms("stephenson_3")[0])
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
FORMS += [("eightbar", n) for n in (0, 29, 61, 87)]
CIRCLE = np.exp(2j * np.pi * np.arange(48) / 48)


@pytest.mark.parametrize(("kind", "n"), FORMS)
def test_the_core_drives_the_same_curve_once_around(kind, n):
    """The analysis core closes loops by root finding; the engine intersects circles from the input outwards."""
    topology = list_forms(kind)[n]
    fit = find_similar_linkages(topology, CIRCLE.real + 0.6j * CIRCLE.imag, True, 1024, 1, np.random.default_rng(0))[0]
    sixbar = build_fitted_linkage(kind, fit, 3.0 - 2.0j, 7.0)
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
    driven = {"coupler", "link_5", "link_7"} if kind == "eightbar" else {"coupler", "link_5"}
    assert set(motion.sines) == ({"link_3", "link_5", "output"} if topology.triad else driven)
    assert min(np.abs(sines).min() for sines in motion.sines.values()) > math.sin(math.radians(14.0))
    body = next(link for link in sixbar.skeleton.links if "P" in link.joints)
    assert body.name == topology.body
    assert not {"O2", "O4", "O6", "O8"} & set(body.joints)


def test_rounds_say_of_which_types_they_are():
    told = PathProblem.model_json_schema()["properties"]["rounds"]["description"]
    assert "For fourbars" in told
    assert "including sixbars and eightbars, are sampled once and ignore this field" in told


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
    ("more", "type_name", "complete", "told"),
    [
        ({"mechanism": "slider_crank"}, None, False, "No slider-crank was found that meets the points exactly"),
        ({}, None, True, "No fourbar meets the points exactly"),
        ({"mechanisms": ["fourbar", "watt_1"]}, "sixbar", False, "No sixbar was found that meets the points exactly"),
        ({"mechanisms": ["eightbar"]}, "eightbar", False, "No eightbar was found that meets the points exactly"),
    ],
)
def test_the_summary_names_the_type_that_does_not_meet_the_points_exactly(more, type_name, complete, told):
    problem = parse_problem({"kind": "path", "points": TASK["points"][:6], **more})

    def answer(count: int) -> PathResult:
        design = SimpleNamespace(targets=[SimpleNamespace(point_residual=0.1)], verification=SimpleNamespace(passed=1))
        search = Search(method="a", complete=complete, candidates=1, accepted=count, rejected={}, seed=0)
        return PathResult.model_construct(designs=[design] * count, search=search, summary="")

    found = solve_exactly_or_fit(problem, lambda *_: None, lambda *_: answer(0), lambda *_: answer(1), type_name)
    assert found.summary.startswith(f"{told} and satisfies all constraints; the points are fitted instead.")


@pytest.mark.parametrize(
    ("mechanisms", "sixbar_error", "searched"),
    [
        ("auto", 0.02, ["fourbar", "sixbar"]),
        ("auto", 0.04, ["fourbar", "sixbar", "eightbar"]),
        (["fourbar", "eightbar"], 0.02, ["fourbar", "eightbar"]),
        (["stephenson_3", "eightbar"], 0.02, ["sixbar", "eightbar"]),
    ],
)
def test_auto_searches_eightbars_only_if_sixbars_are_far_off(monkeypatch, mechanisms, sixbar_error, searched):
    problem = parse_problem(TASK | {"mechanisms": mechanisms})
    called: list[str] = []

    def build_solver(name: str, share: float):
        def solve(_problem, _progress) -> PathResult:
            called.append(name)
            design = as_of(share * problem.task_size, 0.5)
            search = Search(method="a", complete=False, candidates=1, accepted=1, rejected={}, seed=0)
            return PathResult.model_construct(designs=[design], search=search, summary="")

        return solve

    monkeypatch.setattr(type_selection, "solve_sixbars", build_solver("sixbar", sixbar_error))
    monkeypatch.setattr(type_selection, "solve_eightbars", build_solver("eightbar", 0.01))
    monkeypatch.setattr(type_selection, "combine_results", lambda _problem, _simple, found, _before, _name: found)
    monkeypatch.setattr(type_selection, "describe_best_linkages", lambda _problem, _designs: "")
    type_selection.solve_types(problem, build_solver("fourbar", 0.2), lambda *_: None)
    assert called == searched


# A letter M, drawn from its left foot to its right one, whose inner strokes meet halfway down.
CORNERS_OF_M = (0j, 100j, 40.0 + 40j, 80.0 + 100j, 80.0 + 0j)

# A letter X, drawn in one stroke.
CORNERS_OF_X = (0j, 70.0 + 100j, 70.0 + 0j, 100j)


def draw_stroke(corners, count: int) -> np.ndarray:
    """Return a stroke with so many points on each side."""
    sides = itertools.pairwise(corners)
    return np.concatenate([a + (b - a) * np.linspace(0.0, 1.0, count, endpoint=False) for a, b in sides])


@pytest.mark.slow
@pytest.mark.timeout(300)
@pytest.mark.parametrize(
    ("corners", "points", "mechanism", "count"),
    further(
        [(CORNERS_OF_M, 12, "watt_1", 1), (CORNERS_OF_M, 12, "eightbar", 2), (CORNERS_OF_X, 6, "watt_1", 1)],
        [(CORNERS_OF_M, 12, "watt_1", 1), (CORNERS_OF_X, 6, "watt_1", 1)],
    ),
)
def test_a_stroke_with_corners_is_near_its_lines_between_the_points_too(corners, points, mechanism, count):
    """Fits to the points of a stroke alone used to leave it by its own size between two of them."""
    letter = draw_stroke(corners, points)
    stroke = {"points": listed(letter), "closed": False, "mechanisms": [mechanism], "constraints": {}}
    problem = parse_problem(TASK | stroke | {"max_designs": count})
    designs = solve(problem).designs
    assert len(designs) == count
    for design in designs:
        turn = np.radians([target.input_angle for target in design.targets])
        followed = Loops(design.mechanism.skeleton.model_dump(mode="json")).followed(
            np.linspace(0.0, turn[-1] - turn[0], 400)
        )
        assert followed.branch > 0.0
        sides = np.diff(letter)
        gaps = followed.points[:, None] - letter[:-1]
        share = np.clip((gaps * sides.conj()).real / np.abs(sides) ** 2, 0.0, 1.0)
        strays = np.abs(gaps - share * sides).min(axis=1)
        # The lines define the curve only if there are many points.
        dense = len(letter) >= MIN_POLYLINE_POINTS
        limit = 2.0 * design.metrics.max_distance + 1e-6 * problem.task_size if dense else 0.01 * problem.task_size
        assert strays.max() < 0.05 * problem.task_size
        assert strays.max() <= limit
