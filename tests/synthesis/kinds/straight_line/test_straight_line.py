"""Straight lines: the printed table beaten, the families' optima against brute force, the motion followed by others."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pydantic import ValidationError

from synthesis.dispatch import solve
from synthesis.kinds.straight_line.design import StraightLineDesign, StraightLineResult
from synthesis.kinds.straight_line.problem import DEFAULT_RANGE, LINE_MECHANISMS, StraightLineProblem
from synthesis.kinds.straight_line.verification import verify_straight_line
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.problem import ContradictionError
from synthesis.registry import parse_problem
from tests.cases import Case, cases
from tests.oracles.positions import meet
from tests.support.synthesis.driving import constraints_of
from tests.support.synthesis.straight_line import norton_path

FOURBARS = ("hoeken", "chebyshev", "watt", "roberts", "evans")
EXACT = ("peaucellier", "hart", "scott_russell")


def stated(**fields) -> StraightLineProblem:
    problem = parse_problem({"kind": "straight_line", "length": 100.0, **fields})
    assert isinstance(problem, StraightLineProblem)
    return problem


def solved(problem: StraightLineProblem) -> StraightLineResult:
    told: list[float] = []
    result = solve(problem, lambda fraction, message: told.append(fraction))
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert isinstance(result, StraightLineResult)
    for design in result.designs:
        assert design.verification.passed == all(check.passed for check in design.verification.checks)
    return result


def fourbar_path(design: StraightLineDesign, steps: int = 2001) -> np.ndarray:
    """P over the input's range, from the lengths, with pin B found by Newton's iteration on two circles."""
    mechanism = design.mechanism
    assert isinstance(mechanism, FourbarMechanism)
    o2, o4 = (complex(*z) for z in (mechanism.fixed_pivots.input, mechanism.fixed_pivots.output))
    first, last = (math.radians(target.input_angle) for target in design.targets)
    a = o2 + mechanism.links.input * np.exp(1j * np.linspace(first, last, steps))
    side = 1 if mechanism.assembly == "open" else -1
    b = meet(a, o4, mechanism.links.coupler, mechanism.links.output, side)
    assert np.isfinite(b).all()
    point = mechanism.coupler_point
    return a + point.distance * np.exp(1j * math.radians(point.angle)) * (b - a) / mechanism.links.coupler


def local(problem: StraightLineProblem, p: np.ndarray) -> np.ndarray:
    """Places along (real) and across (imaginary) the demanded line."""
    return (p - complex(*problem.start)) * np.exp(-1j * math.radians(problem.direction))


def errors(problem: StraightLineProblem, design: StraightLineDesign) -> tuple[float, float]:
    """Errors across the line and of the velocity in percent, as Norton's table has them."""
    path = local(problem, fourbar_path(design, 20001))
    speed = np.diff(path.real)
    return 100.0 * np.ptp(path.imag) / np.ptp(path.real), 100.0 * np.ptp(speed) / speed.mean()


@pytest.mark.parametrize("case", cases("straight_line_optimum"))
def test_every_row_of_nortons_table_is_beaten(case: Case) -> None:
    """In its own measure strictly below the print; for a constant velocity no less straight than Norton's family."""
    x = case.inputs
    measure = "straightness" if x["objective"] == "straightness" else "velocity"
    problem = stated(crank_range=float(x["dbeta"]), optimize=measure, mechanism="hoeken")
    best = solved(problem).designs[0]
    across, velocity = errors(problem, best)
    assert np.isclose(best.metrics.straightness_error, across, rtol=1e-3)
    assert np.isclose(best.metrics.velocity_variation, velocity, rtol=1e-3)
    # Printed digits are few: 0.001 % stands for 0.0012 %. The linkage of the row itself is the harder measure.
    row = norton_path(x["L1_over_L2"], x["L3_over_L2_exact"], x["dbeta"])
    speed = np.diff(row.real)
    rows_across, rows_velocity = np.ptp(row.imag) / np.ptp(row.real), np.ptp(speed) / speed.mean()
    # The print was sampled in steps of 2°.
    assert np.isclose(100.0 * rows_across, case.expected["dCy_pct"].value, rtol=2e-3, atol=5e-4)
    assert np.isclose(100.0 * rows_velocity, case.expected["dV_pct"].value, rtol=5e-3, atol=5e-4)
    if measure == "straightness":
        assert across <= 0.97 * 100.0 * rows_across
    else:
        assert velocity <= 0.97 * 100.0 * rows_velocity
        assert across <= 1.02 * (case.expected["dCy_pct"].value + 0.05)
    assert best.metrics.full_rotation
    assert np.isclose(best.metrics.cycle_transmission_angle, least_over_a_turn(best), atol=1e-6)


def least_over_a_turn(design: StraightLineDesign) -> float:
    """By the law of cosines where the crank lies along the ground: the extremes of a crank-rocker's angle."""
    links = design.mechanism.links
    found = []
    for f in (links.ground - links.input, links.ground + links.input):
        cosine = (links.coupler**2 + links.output**2 - f * f) / (2.0 * links.coupler * links.output)
        found.append(math.degrees(math.asin(math.sqrt(1.0 - cosine**2))))
    return min(found)


@pytest.mark.parametrize("span", [20.0, 60.0, 120.0, 180.0, 220.0])
def test_no_hoeken_linkage_is_straighter(span: float) -> None:
    """Against a grid of both proportions, refined four times about its best."""
    problem = stated(crank_range=span, mechanism="hoeken")
    found = solved(problem).designs[0].metrics.straightness_error
    assert found <= 1.003 * brute_force(span)


def brute_force(span: float) -> float:
    theta = np.radians(np.linspace(180.0, 180.0 + span / 2.0, 121))
    low, high = np.array([1.05, 1.1]), np.array([3.2, 4.5])
    best, at = np.inf, 0.5 * (low + high)
    for _ in range(12):
        ground, coupler = np.meshgrid(*(np.linspace(low[k], high[k], 61) for k in (0, 1)), indexing="ij")
        pin = np.exp(1j * theta) - ground[..., None]
        square = np.abs(pin) ** 2
        with np.errstate(invalid="ignore"):
            # A P is the diameter of a circle through O4: P at right angles to A from there.
            point = 1j * pin * np.sqrt(4.0 * coupler[..., None] ** 2 / square - 1.0)
            width = np.ptp(point.imag, axis=-1) / (2.0 * np.abs(point[..., -1].real - point[..., 0].real))
        width = np.where(np.isfinite(width), width, np.inf)
        n = np.unravel_index(width.argmin(), width.shape)
        best, at = min(best, float(width[n])), np.array([ground[n], coupler[n]])
        step = (high - low) / 10.0
        low, high = np.maximum(at - step, 1.02), at + step
    return 100.0 * best


@pytest.mark.parametrize("optimize", ["straightness", "velocity"])
@pytest.mark.parametrize("mechanism", FOURBARS)
def test_fourbars_do_what_they_claim(mechanism: str, optimize: str) -> None:
    problem = stated(mechanism=mechanism, optimize=optimize, start=[30.0, -20.0], direction=140.0)
    result = solved(problem)
    assert result.designs
    assert not result.search.complete
    own = [
        d.metrics.straightness_error if optimize == "straightness" else d.metrics.velocity_variation
        for d in result.designs
    ]
    assert own == sorted(own)
    for design in result.designs:
        across, velocity = errors(problem, design)
        assert np.isclose(design.metrics.straightness_error, across, rtol=1e-3)
        assert np.isclose(design.metrics.velocity_variation, velocity, rtol=1e-3)
        path = local(problem, fourbar_path(design))
        assert abs(path[0].real) < 1e-7
        assert abs(path[-1].real - 100.0) < 1e-7
        assert np.all(np.diff(path.real) > 0.0)
        assert np.isclose(design.metrics.deviation, np.abs(path.imag).max(), rtol=1e-3)
        assert np.isclose(design.metrics.deviation, design.metrics.straightness_error / 2.0, rtol=0.02)
        assert np.isclose(abs(design.metrics.input_rotation), DEFAULT_RANGE[mechanism])
    kinds = {design.metrics.proportions for design in result.designs}
    assert kinds <= {"optimal", "classical"}
    assert result.designs[0].metrics.proportions == "optimal"


@pytest.mark.parametrize("span", [20.0, 90.0, 150.0])
@pytest.mark.parametrize("mechanism", EXACT)
def test_exact_lines_followed_by_their_constraints(mechanism: str, span: float) -> None:
    """Rigid lengths and slides alone, stepped along: P keeps to the line and passes both ends."""
    problem = stated(mechanism=mechanism, crank_range=span, start=[30.0, -20.0], direction=250.0)
    (design,) = solved(problem).designs
    assert design.metrics.proportions == "exact"
    constraints = constraints_of(design)
    way = math.radians(design.targets[1].input_angle - design.targets[0].input_angle)
    assert np.isclose(math.degrees(abs(way)), span)
    side = math.copysign(1.0, way)
    trace = constraints.follow(constraints.start(), side, limit=abs(way), to_toggle=True)[0]
    assert trace.ended == "limit"
    path = local(problem, constraints.joints(trace.points)["P"])
    within = np.abs(trace.points[:, -1]) <= abs(way)
    assert within.sum() > 5
    assert np.abs(path.imag).max() < 1e-9 * 100.0
    assert np.all(np.diff(path.real[within]) > 0.0)
    ((_, met),) = trace.at(way, 1e9)
    end = local(problem, constraints.joints(met[None])["P"])[0]
    assert abs(end - 100.0) < 1e-6


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("mechanism", ["hoeken", "watt", "hart"])
def test_size_does_not_matter(mechanism: str, size: float) -> None:
    one = solved(stated(mechanism=mechanism, length=1.0)).designs[0]
    other = solved(stated(mechanism=mechanism, length=size)).designs[0]
    assert other.verification.passed
    assert np.isclose(other.metrics.size, size * one.metrics.size, rtol=1e-6)
    assert np.isclose(other.metrics.velocity_variation, one.metrics.velocity_variation, rtol=1e-6)


def test_far_from_the_origin() -> None:
    problem = stated(mechanism="peaucellier", start=[1e6, -2e6], length=1.0)
    (design,) = solved(problem).designs
    assert design.verification.passed
    assert solved(stated(start=[1e6, -2e6], length=1.0, mechanism="hoeken")).designs


def test_both_ways_round_are_mirror_images() -> None:
    ccw, cw = (solved(stated(mechanism="evans", rotation=way)).designs[0] for way in ("ccw", "cw"))
    assert ccw.metrics.input_rotation > 0.0 > cw.metrics.input_rotation
    for name, (x, y) in ccw.mechanism.skeleton.joints.items():
        assert np.allclose(cw.mechanism.skeleton.joints[name], (x, -y), atol=1e-9)


def test_a_region_for_the_pivots_chooses_the_side() -> None:
    below = solved(stated(mechanism="hoeken", constraints={"fixed_pivot_region": {"x": [-500, 500], "y": [-500, 0]}}))
    above = solved(stated(mechanism="hoeken", constraints={"fixed_pivot_region": {"x": [-500, 500], "y": [0, 500]}}))
    for result, sign in ((below, -1.0), (above, 1.0)):
        (design,) = result.designs
        pivots = design.mechanism.fixed_pivots
        assert sign * pivots.input[1] > 0.0
        assert sign * pivots.output[1] > 0.0


def test_limits_of_the_client_are_kept() -> None:
    problem = stated(
        mechanism="watt", optimize="velocity", max_deviation=0.1,
        constraints={"max_link_ratio": 3.0, "min_transmission_angle": 50.0},
    )  # fmt: skip
    designs = solved(problem).designs
    assert designs
    for design in designs:
        assert design.metrics.deviation <= 0.1
        assert design.metrics.link_ratio <= 3.0 * (1.0 + 1e-6)
        assert design.metrics.min_transmission_angle >= 50.0 * (1.0 - 1e-6)
    looser = solved(stated(mechanism="watt", optimize="velocity", max_deviation=0.5)).designs[0]
    assert looser.metrics.velocity_variation <= designs[0].metrics.velocity_variation


def test_straighter_lines_cost_evenness() -> None:
    found = [
        solved(stated(mechanism="hoeken", optimize="velocity", max_deviation=limit)).designs[0].metrics
        for limit in (0.02, 0.1, 0.3, 0.6)
    ]
    variations = [metrics.velocity_variation for metrics in found]
    assert variations == sorted(variations, reverse=True)
    assert all(m.deviation <= limit for m, limit in zip(found, (0.02, 0.1, 0.3, 0.6), strict=True))


def test_what_cannot_be_is_not_claimed_to_be_proven() -> None:
    result = solved(stated(mechanism="hoeken", crank_range=180.0, max_deviation=1e-6))
    assert result.designs == []
    assert result.search.complete is False
    assert "may still exist" in result.summary
    shown = solved(stated(mechanism="hoeken", crank_range=180.0, max_deviation=1e-6, include_failed=True)).designs
    assert shown
    assert not shown[0].verification.passed


@pytest.mark.slow
def test_auto_compares_all_types() -> None:
    result = solved(stated(max_designs=50))
    assert {design.metrics.family for design in result.designs} == set(LINE_MECHANISMS)
    wide = solved(stated(max_designs=50, crank_range=200.0))
    assert "scott_russell" not in {design.metrics.family for design in wide.designs}


def test_the_same_problem_has_the_same_answer() -> None:
    one, other = (solved(stated(mechanism="roberts")).model_dump() for _ in range(2))
    assert one == other


@pytest.mark.parametrize("mechanism", ["hoeken", "chebyshev"])
@pytest.mark.parametrize("link", ["input", "coupler", "output"])
def test_verification_notices_a_wrong_length(mechanism: str, link: str) -> None:
    problem = stated(mechanism=mechanism, max_deviation=1.0)
    design = solved(problem).designs[0]
    spoilt = design.mechanism.model_copy(
        update={
            "links": design.mechanism.links.model_copy(update={link: 1.003 * getattr(design.mechanism.links, link)})
        }
    )
    again = verify_straight_line(problem, spoilt, mechanism, "optimal")
    assert again is None or not again.verification.passed
    sound = verify_straight_line(problem, design.mechanism, mechanism, "optimal")
    assert sound is not None
    assert sound.verification.passed


def test_verification_notices_a_line_that_is_not_exact() -> None:
    problem = stated(mechanism="peaucellier")
    (design,) = solved(problem).designs
    joints = dict(design.mechanism.skeleton.joints)
    joints["O2"] = (joints["O2"][0] + 0.01, joints["O2"][1])
    spoilt = design.mechanism.model_copy(
        update={
            "skeleton": design.mechanism.skeleton.model_copy(update={"joints": joints}),
            "fixed_pivots": {**design.mechanism.fixed_pivots, "O2": joints["O2"]},
            "links": {},
        }
    )
    again = verify_straight_line(problem, spoilt, "peaucellier", "exact")
    assert again is not None
    assert "exact_line" in [check.name for check in again.verification.checks if not check.passed]


@pytest.mark.parametrize(
    ("fields", "place"),
    [
        ({"length": 0.0}, "length"),
        ({"length": -1.0}, "length"),
        ({"length": math.nan}, "length"),
        ({"length": 1e10}, "length"),
        ({"crank_range": 0.0}, "crank_range"),
        ({"crank_range": 360.0}, "crank_range"),
        ({"crank_range": 1e-300}, "crank_range"),
        ({"crank_range": math.inf}, "crank_range"),
        ({"mechanism": "sarrus"}, "mechanism"),
        ({"max_deviation": 0.0}, "max_deviation"),
        ({"start": [0.0]}, "start"),
        ({"direction": "up"}, "direction"),
        ({"optimise": "velocity"}, "optimise"),
    ],
)
def test_ill_formed_statements_are_refused_at_their_field(fields, place) -> None:
    with pytest.raises(ValidationError) as caught:
        stated(**fields)
    assert place in {str(part) for error in caught.value.errors() for part in error["loc"]}


def test_a_line_that_rounding_leaves_nothing_of() -> None:
    problem = stated(length=1e-9, start=[1e9, 1e9])
    assert [fault.path for fault in problem.find_contradictions()] == ["/length"]


def test_a_range_that_a_type_cannot_have() -> None:
    with pytest.raises(ContradictionError) as caught:
        solved(stated(mechanism="scott_russell", crank_range=180.0))
    assert caught.value.contradiction.path == "/crank_range"


@pytest.mark.parametrize("mechanism", LINE_MECHANISMS)
@pytest.mark.parametrize("span", [1e-3, 1.0, 170.0, 359.0])
def test_extreme_ranges_are_answered(mechanism: str, span: float) -> None:
    problem = stated(mechanism=mechanism, crank_range=span)
    if problem.find_contradictions():
        return
    result = solved(problem)
    for design in result.designs:
        assert design.verification.passed
        assert design.metrics.visits_in_order
    if not result.designs:
        assert not result.search.complete
