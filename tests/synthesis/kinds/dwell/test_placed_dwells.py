"""Dwells of stated lengths and places: each measured by another route, and told where it lies."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.dwell.design import DwellResult
from synthesis.kinds.dwell.motion.outputs import (
    CYCLE_SAMPLE_COUNT,
    Task,
    compute_output,
    evaluate_shapes,
    locate_points,
)
from synthesis.kinds.dwell.motion.program_score import score_program
from synthesis.kinds.dwell.motion.score import ROCKER_CODE, SLIDER_CODE, SLOT_CODE
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.solver import solve_dwell
from synthesis.kinds.dwell.starts.coupler_curve_starts import Requirements
from synthesis.kinds.dwell.starts.placed_starts import find_placed_starts
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.model.problem import ContradictionError
from synthesis.registry import parse_problem
from synthesis.results.pareto import pareto_front
from tests.campaign import further
from tests.support.synthesis.dwell import assert_measured, rocker, slider

TASKS: dict[str, dict[str, Any]] = {
    "unequal": {
        "dwells": [{"angle": 70.0, "at": "low"}, {"angle": 40.0, "at": "high"}],
        "mechanism": "straight_slot",
        "output": rocker(50.0),
        "tolerance": 1.0,
    },
    "within": {"dwells": [{"angle": 50.0, "at": 0.4}], "mechanism": "pseudo_arc", "output": slider(50.0)},
    "watt": {"dwells": [{"angle": 60.0, "at": "high"}], "mechanism": "watt_2", "output": rocker(60.0)},
    "watt slider": {"dwells": [{"angle": 60.0, "at": "low"}], "mechanism": "watt_2", "output": slider(0.01)},
    "long": {"dwells": [{"angle": 200.0, "at": "low"}], "mechanism": "straight_slot", "output": rocker(60.0)},
    "two arcs": {
        "dwells": [{"angle": 60.0, "at": "high"}, {"angle": 40.0, "at": "low"}],
        "mechanism": "pseudo_arc",
        "output": slider(80.0),
        "tolerance": 1.6,
    },
    "stephenson": {
        "dwells": [{"angle": 60.0, "at": "low"}, {"angle": 40.0, "at": 0.7}],
        "mechanism": "stephenson_2",
        "output": rocker(60.0),
        "tolerance": 1.0,
    },
    "two of one length": {"dwell_angle": 50.0, "count": 2, "mechanism": "watt_2", "output": rocker(60.0)},
}


def stated(**fields: Any) -> DwellProblem:
    problem = parse_problem({"kind": "dwell", **fields})
    assert isinstance(problem, DwellProblem)
    return problem


@cache
def answered(name: str) -> tuple[DwellProblem, DwellResult]:
    problem = stated(**TASKS[name])
    return problem, solve_dwell(problem, lambda *_: None)


@pytest.mark.slow
@pytest.mark.parametrize("name", further(list(TASKS), ["unequal"]))
def test_dwells_are_where_and_as_long_as_they_are_told(name: str) -> None:
    problem, result = answered(name)
    assert result.designs
    for design in result.designs[:3]:
        assert_measured(problem, design)
        assert len(design.targets) == len(problem.dwell_requests)
        if problem.dwells is None:
            assert design.dwells is None
            continue
        assert design.dwells is not None
        for dwell, rest, wanted in zip(design.dwells, design.targets, problem.dwell_requests, strict=True):
            assert dwell.angle == wanted.angle
            assert dwell.error == rest.jitter <= problem.max_movement
    assert result.search.candidates == result.search.accepted + sum(result.search.rejected.values())


@pytest.mark.slow
def test_what_larger_transmission_angles_cost_is_in_the_front() -> None:
    _, result = answered("unequal")
    front = pareto_front(result.designs)
    assert front is not None
    angles = [design.metrics.min_transmission_angle for design in result.designs]
    assert max(angles) > 34.0
    assert min(angles) < 40.0


def test_dwells_at_other_places_are_refused_by_the_verification() -> None:
    problem, result = answered("unequal")
    mechanism = result.designs[0].mechanism
    swapped = stated(
        **{**TASKS["unequal"], "dwells": [{"angle": 70.0, "at": "high"}, {"angle": 40.0, "at": "low"}]},
    )
    between = stated(**{**TASKS["unequal"], "dwells": [{"angle": 70.0, "at": "low"}, {"angle": 40.0, "at": 0.5}]})
    for other in (swapped, between):
        design = verify_dwell(other, mechanism)
        assert design is not None
        assert not design.verification.passed
    sound = verify_dwell(problem, mechanism)
    assert sound is not None
    assert sound.verification.passed


def test_no_rest_counts_for_two_places() -> None:
    """One long rest at the low end is not also one a little above it, and two demanded there are not apart."""
    problem, result = answered("unequal")
    low = problem.dwells[0]
    both = problem.model_copy(update={"dwells": [low, low.model_copy(update={"at": 0.02})]})
    design = verify_dwell(both, result.designs[0].mechanism)
    assert design is not None
    assert "dwells_apart" in {check.name for check in design.verification.checks if not check.passed}


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "number"), [("rocker", ROCKER_CODE), ("slider", SLIDER_CODE), ("slot", SLOT_CODE)])
def test_the_kernel_finds_the_stretches_that_plain_numpy_finds(kind: Any, number: int) -> None:
    rng = np.random.default_rng(5)
    turning = "double_crank" if kind == "slider" else "crank_rocker"
    carrier = "rocker" if kind == "rocker" else "coupler"
    way = math.nan if kind == "slider" else 0.9
    dwells, places = (1.1, 0.7), (0.0, 0.6)
    found = find_placed_starts(kind, carrier, turning, Requirements(dwells, places, way, 0.35, 8.0), rng, 5)
    assert found
    lengths = np.array([14, 9])
    for start in found:
        turn = np.linspace(0.0, 2.0 * np.pi, CYCLE_SAMPLE_COUNT, endpoint=False)
        curve = np.ascontiguousarray(locate_points(start.shape[None], turn, carrier))
        out = compute_output(kind, start.sign, start.shape[None], curve)[0][0]
        numbers = np.zeros((1, 4))
        last = {"rocker": 9, "slider": 8, "slot": 7}[kind]
        numbers[0, : last - 5] = start.shape[5:last]
        scores, signs = np.empty(1), np.empty(1, np.int64)
        begins, ends = np.zeros((1, 2), np.int64), np.zeros((1, 2))
        rows = np.zeros(1, np.int64)
        score_program(number, curve, rows, numbers, lengths, np.array(places), way, 0.35, scores, signs, begins, ends)
        assert signs[0] == start.sign
        around = np.concatenate([out, out])
        for k, (length, place) in enumerate(zip(lengths, places, strict=True)):
            stretches = np.stack([around[m : m + length] for m in range(CYCLE_SAMPLE_COUNT)])
            share = (stretches.mean(axis=1) - out.min()) / np.ptp(out)
            worth = np.ptp(stretches, axis=1) / np.ptp(out) + 0.5 * np.abs(share - place)
            assert np.isclose(worth[begins[0, k]], worth.min(), rtol=1e-9)
            assert ends[0, k] == place


def test_points_of_a_rocker_are_rigid_on_it() -> None:
    shape = np.array([[3.0, 2.5, 3.2, 1.0, 0.7, *np.zeros(5)]])
    turn = np.linspace(0.0, 2.0 * np.pi, 50)
    p = locate_points(shape, turn, "rocker")[0]
    b = locate_points(np.array([[3.0, 2.5, 3.2, 2.5, 0.0]]), turn, "rocker")[0]
    on_coupler = locate_points(np.array([[3.0, 2.5, 3.2, 3.0, 0.0]]), turn, "coupler")[0]
    assert np.allclose(b, on_coupler)
    assert np.allclose((p - 3.2) / (b - 3.2), complex(1.0, 0.7) / 2.5)


@pytest.mark.parametrize("turning", ["crank_rocker", "double_crank"])
def test_what_is_kept_of_a_fourbar_tells_its_class(turning: Any) -> None:
    """Grashof's conditions of a shape are met where it is of the class, and broken by one of another."""
    task = Task("slider", 1, (0.5,), (1.0,), math.nan, 0.3, 8.0, "coupler", turning)
    own = {"crank_rocker": (3.0, 2.5, 3.2), "double_crank": (1.2, 1.3, 0.5)}
    for name, lengths in own.items():
        shape = np.array([[*lengths, 0.5, 0.5, 2.0, 0.3, 0.2, 0.0]])
        kept = evaluate_shapes(task, np.linspace(0.0, 1.0, 5), shape).positive[0]
        # Six lengths are neither longer nor shorter than the link ratio allows.
        grashof = kept[-12 - 3 : -12]
        assert (grashof > 0.0).all() == (name == turning)


@pytest.mark.parametrize(
    ("dwells", "path"),
    [
        ([{"angle": 200.0, "at": "low"}, {"angle": 160.0, "at": "high"}], "/dwells"),
        ([{"angle": 60.0, "at": "low"}, {"angle": 60.0, "at": "low"}], "/dwells/1/at"),
        ([{"angle": 60.0, "at": "low"}, {"angle": 60.0, "at": 0.0}], "/dwells/1/at"),
        ([{"angle": 60.0, "at": 1.0}, {"angle": 60.0, "at": 0.5}, {"angle": 30.0, "at": 0.55}], "/dwells/2/at"),
    ],
)
def test_dwells_that_exclude_one_another(dwells: list[dict[str, Any]], path: str) -> None:
    with pytest.raises(ContradictionError) as caught:
        solve(stated(dwells=dwells, output=rocker(50.0)))
    assert caught.value.contradiction.path == path


@pytest.mark.campaign
def test_of_dwells_out_of_reach_those_that_were_found_are_told() -> None:
    dwells = [{"angle": 120.0, "at": "low"}, {"angle": 80.0, "at": 0.5}]
    result = solve(stated(dwells=dwells, output=slider(50.0), mechanism="pseudo_arc"))
    assert result.designs == []
    assert result.nearest_miss is not None
    first, second = result.nearest_miss.reachable.dwell_angles
    assert first / second == pytest.approx(1.5)
    assert f"The longest dwells found are {first:.4g}° and {second:.4g}°" in result.summary
