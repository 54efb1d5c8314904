"""Dwells: the whole sixbar followed by its constraints alone, and what was measured held against that."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from synthesis.dispatch import solve
from synthesis.kinds.dwell.design import DwellMechanism, DwellResult
from synthesis.kinds.dwell.motion.rests import _average_windows, _measure_ranges
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.starts.arcs import fit_arcs, fit_lines
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.model.problem import ContradictionError
from synthesis.registry import parse_problem
from synthesis.results.buildability import is_buildable
from synthesis.results.practicality import ERROR_BAND, NEGLIGIBLE_ERROR, grade_design
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.campaign import further
from tests.cases import Case, cases
from tests.support.synthesis.driving import constraints_of
from tests.support.synthesis.dwell import assert_measured, rocker, slider


def stated(**fields) -> DwellProblem:
    problem = parse_problem({"kind": "dwell", "output": rocker(90.0), "dwell_angle": 60.0, **fields})
    assert isinstance(problem, DwellProblem)
    return problem


_results: dict[str, DwellResult] = {}
"""Answers by their problems; answers are frozen models."""


def solved(problem: DwellProblem) -> DwellResult:
    key = problem.model_dump_json()
    if key not in _results:
        _results[key] = solved_again(problem)
    return _results[key]


def solved_again(problem: DwellProblem) -> DwellResult:
    told: list[float] = []
    result = solve(problem, lambda fraction, message: told.append(fraction))
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert isinstance(result, DwellResult)
    assert not result.search.complete
    return result


TASKS = [
    {"mechanism": "pseudo_arc"},
    {"mechanism": "straight_slot", "dwell_angle": 50.0, "output": rocker(60.0)},
    {"dwell_angle": 90.0, "output": slider(50.0)},
    {"mechanism": "pseudo_arc", "output": rocker(50.0), "count": 2},
    {"mechanism": "straight_slot", "dwell_angle": 40.0, "output": rocker(50.0), "count": 2, "tolerance": 1.0},
    {"output": slider(0.02), "count": 2, "dwell_angle": 50.0, "length_unit": "m"},
    {"mechanism": "stephenson_2", "dwell_angle": 100.0, "output": rocker(40.0)},
    {"mechanism": "stephenson_2", "output": rocker(60.0), "count": 2, "dwell_angle": 50.0},
    {"mechanism": "stephenson_2", "output": rocker(50.0), "constraints": {"max_link_ratio": 7.0}},
]


@pytest.mark.slow
@pytest.mark.parametrize(
    "fields",
    further(TASKS, [*TASKS[:3], TASKS[-1]]),
    ids=lambda fields: f"{fields.get('mechanism', 'slider')}-{fields.get('count', 1)}",
)
def test_dwells_are_what_was_measured(fields) -> None:
    problem = stated(**fields)
    result = solved(problem)
    assert result.designs
    for design in result.designs[:3]:
        assert_measured(problem, design)
        assert len(design.targets) == problem.count
    # Of the designs near the task, one that can be built and used as it is stands first.
    errors = [max(problem.measure_error(design), NEGLIGIBLE_ERROR) for design in result.designs]
    grades = [(not is_buildable(design), grade_design(design)) for design in result.designs]
    near = [grade for grade, error in zip(grades, errors, strict=True) if error <= ERROR_BAND * min(errors)]
    assert grades[0] == min(near) or not any(map(is_buildable, result.designs))


@pytest.mark.slow
@pytest.mark.parametrize("case", cases("dwell"))
def test_norton_example_3_13(case: Case) -> None:
    """A rocker of 90° over 300° of the crank that rests for 60°, found instead of read off an atlas."""
    given = case.inputs
    rest = given["segments_deg"][1]
    case.check(total=sum(given["segments_deg"]), atlas_dashes=[rest / 5.0])
    problem = stated(dwell_angle=float(rest), output=rocker(float(given["output_deg"])), mechanism="pseudo_arc")
    for design in solved(problem).designs[:2]:
        assert_measured(problem, design)
        assert design.metrics.jitter < 0.005 * given["output_deg"]


@pytest.mark.slow
@pytest.mark.parametrize("fields", further(TASKS[:3], TASKS[1:2]), ids=["rocker", "slot", "slider"])
def test_the_crank_turns_through_by_the_constraints_alone(fields) -> None:
    """Rigid lengths and slides, stepped along the crank's turn: no toggle comes, and the turn closes."""
    design = solved(stated(**fields)).designs[0]
    constraints = constraints_of(design)
    trace = constraints.follow(constraints.start(), 1.0, limit=2.0 * math.pi, to_toggle=True)[0]
    assert trace.ended in ("limit", "closed")


@pytest.mark.campaign
def test_the_sizes_that_are_asked_for() -> None:
    problem = stated(crank=3.0, pivot=[100.0, -50.0], mechanism="pseudo_arc")
    for design in solved(problem).designs:
        assert np.isclose(design.mechanism.links["input"], 3.0)
        assert np.allclose(design.mechanism.fixed_pivots["O2"], (100.0, -50.0))


@pytest.mark.slow
def test_limits_of_the_client_are_kept() -> None:
    problem = stated(mechanism="pseudo_arc", constraints={"min_transmission_angle": 40.0, "max_link_ratio": 6.0})
    designs = solved(problem).designs
    assert designs
    for design in designs:
        assert design.metrics.min_transmission_angle >= 40.0
        assert design.metrics.link_ratio <= 6.0 * (1.0 + 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "fields"),
    [
        ("dwell_rocker", {"mechanism": "pseudo_arc"}),
        ("dwell_slider", {"mechanism": "pseudo_arc", "output": slider(50.0)}),
        ("dwell_slot", {"mechanism": "straight_slot"}),
        ("dwell_watt_rocker", {"mechanism": "watt_2", "output": rocker(50.0)}),
        ("dwell_watt_slider", {"mechanism": "watt_2", "output": slider(50.0)}),
        ("dwell_stephenson_2", {"mechanism": "stephenson_2", "output": rocker(50.0)}),
    ],
)
def test_the_link_ratio_is_that_of_all_distances_between_pins_of_a_link(kind: str, fields: dict[str, Any]) -> None:
    designs = solved(stated(**fields, constraints={"max_link_ratio": 7.0})).designs
    assert designs
    for design in designs:
        skeleton = design.mechanism.skeleton
        distances = [
            math.dist(skeleton.joints[one], skeleton.joints[other])
            for link in skeleton.links
            for one, other in combinations(link.joints, 2)
        ]
        assert design.mechanism.type == kind
        assert sorted(design.mechanism.links.values()) == pytest.approx(sorted(distances))
        assert design.metrics.link_ratio == pytest.approx(max(distances) / min(distances))
        assert design.metrics.link_ratio <= 7.0 * (1.0 + 1e-6)


@pytest.mark.campaign
@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_size_does_not_matter(size: float) -> None:
    one = solved(stated(output=slider(1.0))).designs[0]
    other = solved(stated(output=slider(size))).designs[0]
    assert np.isclose(other.metrics.size, size * one.metrics.size)
    assert np.isclose(other.metrics.jitter, size * one.metrics.jitter, rtol=1e-3)


@pytest.mark.campaign
def test_the_same_problem_has_the_same_answer() -> None:
    one, other = (solved_again(stated(mechanism="straight_slot")).model_dump() for _ in range(2))
    assert one == other
    assert solved(stated(mechanism="straight_slot", seed=1)).model_dump() != one


@pytest.mark.campaign
@pytest.mark.parametrize(
    "fields", [{"dwell_angle": 300.0, "output": rocker(170.0)}, {"dwell_angle": 170.0, "count": 2}]
)
def test_what_is_not_found_is_not_claimed_to_be_impossible(fields) -> None:
    result = solved(stated(**fields))
    assert result.designs == []
    assert "may still exist" in result.summary
    assert sum(result.search.rejected.values()) == result.search.candidates


@pytest.mark.slow
def test_verification_notices_a_wrong_length() -> None:
    problem = stated(mechanism="pseudo_arc")
    design = solved(problem).designs[0]
    joints = dict(design.mechanism.skeleton.joints)
    joints["O6"] = tuple(1.01 * z for z in joints["O6"])
    skeleton = design.mechanism.skeleton.model_copy(update={"joints": joints})
    spoilt = design.mechanism.model_copy(
        update={
            "skeleton": skeleton,
            "links": {},
            "fixed_pivots": {**design.mechanism.fixed_pivots, "O6": joints["O6"]},
        }
    )
    again = verify_dwell(problem, spoilt)
    assert again is None or not again.verification.passed
    # Dimensions that the skeleton does not have are refused.
    assert verify_dwell(problem, design.mechanism.model_copy(update={"skeleton": skeleton})) is None
    sound = verify_dwell(problem, design.mechanism)
    assert sound is not None
    assert sound.verification.passed


def test_a_slide_that_may_stand_still_all_the_time_is_no_mechanism() -> None:
    """Link 5 as long as the rocker's arm holds D at O4 for any crank angle: a change point."""
    joints = {
        "O2": (0.0, 0.0),
        "O4": (50.781557445816915, 0.0),
        "A": (-12.618447062120692, 36.213757806058126),
        "B": (36.509579009515214, 41.747165876164985),
        "P": (32.55819136577709, 66.21399423572109),
        "D": (50.781557445811245, -1.4263016765352523e-12),
    }
    links = {
        "ground": ("O2", "O4"),
        "input": ("O2", "A"),
        "coupler": ("A", "B"),
        "rocker": ("O4", "B", "P"),
        "link_5": ("P", "D"),
    }
    lengths = {name: math.dist(joints[first], joints[second]) for name, (first, second, *_) in links.items()}
    lengths["rocker_arm"] = math.dist(joints["O4"], joints["P"])
    assert lengths["rocker_arm"] == pytest.approx(lengths["link_5"], rel=1e-13)
    problem = stated(dwells=[{"angle": 240.0, "at": "low"}], dwell_angle=None, output=slider(50.0), mechanism="watt_2")
    slide = {"joint": "D", "link": "ground", "point": joints["D"], "angle": 332.619775392158}
    skeleton = {
        "joints": joints,
        "links": [{"name": name, "joints": pins} for name, pins in links.items()],
        "slides": [slide],
        "gears": [],
        "input_link": "input",
    }
    mechanism = DwellMechanism.model_validate(
        {
            "type": "dwell_watt_slider",
            "fixed_pivots": {name: joints[name] for name in ("O2", "O4")},
            "links": lengths,
            "reference_input_angle": 109.2105571929753,
            "skeleton": skeleton,
        }
    )
    assert rebuild_mechanism(mechanism) is not None
    assert verify_dwell(problem, mechanism) is None


@pytest.mark.parametrize("window", [2, 7, 8, 31])
def test_windows_of_a_turn(window: int) -> None:
    values = np.random.default_rng(1).normal(size=60)
    around = np.concatenate([values, values])
    pieces = [around[k : k + window] for k in range(60)]
    assert np.allclose(_measure_ranges(values, window), [np.ptp(piece) for piece in pieces])
    assert np.allclose(_average_windows(values, window), [piece.mean() for piece in pieces])


def test_arcs_and_lines_of_pieces() -> None:
    """Of a curve that is a circle for one half and a straight line for the other, the pieces are found exactly."""
    turn = np.linspace(0.0, np.pi, 20)
    curve = np.concatenate([3.0 + 2.0j + 1.5 * np.exp(1j * turn), np.linspace(1.5 + 2.0j, -4.0 - 1.0j, 20)])[None]
    centres, radii, off = np.empty_like(curve), np.empty(curve.shape), np.empty(curve.shape)
    fit_arcs(curve, 8, centres, radii, off)
    assert np.allclose(centres[0, :12], 3.0 + 2.0j)
    assert np.allclose(radii[0, :12], 1.5)
    assert off[0, :12].max() < 1e-12
    angles = np.empty(curve.shape)
    fit_lines(curve, 8, centres, angles, off)
    assert np.allclose(np.tan(angles[0, 20:32]), 3.0 / 5.5)
    assert off[0, 20:32].max() < 1e-12
    assert off[0, :12].min() > 1e-2


@pytest.mark.parametrize(
    ("fields", "place"),
    [
        ({"dwell_angle": 0.0}, "dwell_angle"),
        ({"dwell_angle": 360.0}, "dwell_angle"),
        ({"dwell_angle": math.nan}, "dwell_angle"),
        ({"output": rocker(0.0)}, "swing"),
        ({"output": rocker(180.0)}, "swing"),
        ({"output": slider(-1.0)}, "stroke"),
        ({"output": {"type": "cam", "swing": 3.0}}, "output"),
        ({"count": 3}, "count"),
        ({"count": 0}, "count"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"mechanism": "geneva"}, "mechanism"),
    ],
)
def test_ill_formed_statements_are_refused_at_their_field(fields, place) -> None:
    with pytest.raises(ValidationError) as caught:
        stated(**fields)
    assert place in {str(part) for error in caught.value.errors() for part in error["loc"]}


@pytest.mark.parametrize(
    ("fields", "path"),
    [
        ({"dwell_angle": 180.0, "count": 2}, "/dwell_angle"),
        ({"output": slider(10.0), "mechanism": "straight_slot"}, "/mechanism"),
        ({"output": slider(10.0), "mechanism": "stephenson_2"}, "/mechanism"),
        ({"mechanism": "stephenson_2", "constraints": {"grashof": "crank_rocker"}}, "/constraints/grashof"),
        ({"output": slider(10.0), "crank": 5.0}, "/crank"),
        ({"tolerance": 90.0}, "/tolerance"),
        ({"crank": 1e-9, "pivot": [1e9, 0.0]}, "/crank"),
        ({"output": slider(1e-9), "pivot": [0.0, -1e9]}, "/output/stroke"),
        ({"constraints": {"grashof": "double_crank"}}, "/constraints/grashof"),
    ],
)
def test_contradictions_are_told_by_their_field(fields, path) -> None:
    with pytest.raises(ContradictionError) as caught:
        solved(stated(**fields))
    assert caught.value.contradiction.path == path
