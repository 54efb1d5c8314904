"""Parallel motion: the body followed by the sixbar's constraints alone, and the curve by another route."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.parallel_motion.design import ParallelMotionDesign, ParallelMotionResult
from synthesis.kinds.parallel_motion.problem import ParallelMotionProblem
from synthesis.kinds.parallel_motion.verification import verify_parallel_motion
from synthesis.model.problem import ContradictionError
from synthesis.registry import get_first_example, parse_problem
from synthesis.results.buildability import MIN_RELATIVE_WIDTH
from tests.cases import Case, cases
from tests.oracles.positions import meet
from tests.support.synthesis.driving import constraints_of

LINKAGES = {
    "crank-rocker": (20.0, 70.0, 90.0, 60.0, 60.0, 30.0, "open"),
    "crossed": (20.0, 70.0, 90.0, 60.0, 60.0, 30.0, "crossed"),
    "Chebyshev": (5.0, 2.0, 5.0, 4.0, 1.0, 0.0, "crossed"),
}
"""Input, coupler, output, ground, distance and angle of P, assembly."""


def stated(a, b, c, d, p, angle, assembly, at=3.0 - 2.0j, **fields) -> ParallelMotionProblem:
    linkage = {
        "fixed_pivots": {"input": [at.real, at.imag], "output": [at.real + d, at.imag]},
        "links": {"input": a, "coupler": b, "output": c},
        "coupler_point": {"distance": p, "angle": angle},
        "assembly": assembly,
    }
    problem = parse_problem({"kind": "parallel_motion", "linkage": linkage, **fields})
    assert isinstance(problem, ParallelMotionProblem)
    return problem


def solved(problem: ParallelMotionProblem) -> ParallelMotionResult:
    told: list[float] = []
    result = solve(problem, lambda fraction, message: told.append(fraction))
    assert told == sorted(told)
    assert isinstance(result, ParallelMotionResult)
    return result


def source_curve(problem: ParallelMotionProblem) -> np.ndarray:
    """P of the given fourbar in both assemblies, B by Newton's iteration; NaN where it cannot be."""
    given = problem.linkage
    o2, o4 = complex(*given.fixed_pivots.input), complex(*given.fixed_pivots.output)
    a = o2 + given.links.input * np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 40001))
    arm = cmath.rect(given.coupler_point.distance, math.radians(given.coupler_point.angle))
    curves = [a + arm * (meet(a, o4, given.links.coupler, given.links.output, side) - a) / given.links.coupler
              for side in (1, -1)]  # fmt: skip
    points = np.concatenate(curves)
    return points[np.isfinite(points)]


def followed(design: ParallelMotionDesign) -> dict[str, np.ndarray]:
    """Joints along the range that was driven, by rigid lengths alone, from the reference on one side."""
    constraints = constraints_of(design)
    low, high = (math.radians(at) for at in design.metrics.input_range)
    at = math.radians(design.mechanism.reference_input_angle)
    at += 2.0 * math.pi * round((0.5 * (low + high) - at) / (2.0 * math.pi))
    side = 1.0 if high - at > at - low else -1.0
    way = max(high - at, at - low)
    trace = constraints.follow(constraints.start(), side, limit=way, to_toggle=True)[0]
    assert trace.ended in ("limit", "closed")
    return constraints.joints(trace.points)


@pytest.mark.slow
@pytest.mark.parametrize("name", LINKAGES)
def test_the_body_translates_along_the_curve(name: str) -> None:
    problem = stated(*LINKAGES[name])
    designs = solved(problem).designs
    assert designs
    curve = source_curve(problem)
    extent = np.ptp(curve.real) + np.ptp(curve.imag)
    for design in designs:
        assert design.verification.passed
        assert math.radians(design.metrics.rotation) < 1e-9
        joints = followed(design)
        p, q = joints["P"], joints["Q"]
        assert np.ptp(np.abs(p - p[0])) > 0.05 * extent
        assert np.abs((q - p) - complex(*design.metrics.translation)).max() < 1e-8 * extent
        nearest = np.array([np.abs(curve - z).min() for z in p])
        # The curve is known at points 1e-4 of its size apart, farther near a toggle of the source.
        assert np.median(nearest) < 5e-4 * extent
        assert design.metrics.curve_distance < 1e-9 * extent


def test_cognates_are_other_sixbars_of_one_curve() -> None:
    designs = solved(stated(*LINKAGES["crank-rocker"])).designs
    assert {design.metrics.base for design in designs} >= {"source", "right_cognate"}
    assert any(design.metrics.full_rotation for design in designs)
    only = solved(stated(*LINKAGES["crank-rocker"], include_cognates=False)).designs
    assert [design.metrics.base for design in only] == ["source"]


@pytest.mark.parametrize("case", cases("parallel_motion"))
def test_norton_example_3_11(case: Case) -> None:
    x = case.inputs
    problem = stated(x["a"], x["b"], x["c"], x["d"], x["p"], x["delta3"], "open", include_cognates=False)
    (design,) = solved(problem).designs
    joints = followed(design)
    case.check(closure_error=np.abs(np.diff(joints["Q"] - joints["P"])).max())
    links = design.mechanism.links
    assert links["input_arm"] == pytest.approx(1.000157787, abs=1e-9)
    assert links["guide"] == pytest.approx(7.714285714, abs=1e-9)
    assert links["body"] == pytest.approx(5.142857143, abs=1e-9)


def test_a_change_point_on_the_way_is_not_overlooked() -> None:
    """Driven at the output, guide and body of this linkage come into line: the body may turn on from there."""
    result = solved(stated(*LINKAGES["crank-rocker"], include_failed=True))
    failed = [design for design in result.designs if not design.verification.passed]
    assert failed
    for design in failed:
        assert design.metrics.min_transmission_angle < 0.5
    assert result.search.accepted + sum(result.search.rejected.values()) == result.search.candidates
    assert result.search.rejected.keys() == {"rotation"}


def test_links_that_all_turn_through_pass_the_body() -> None:
    """Of a double crank every link turns through, the guide too: it comes into line with a body that does not turn."""
    result = solved(stated(5.0, 4.5, 5.5, 2.0, 3.0, -70.0, "open"))
    assert result.designs == []
    assert result.summary.startswith("None of 6")
    assert sum(result.search.rejected.values()) == 6


@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_size_does_not_matter(size: float) -> None:
    a, b, c, d, p, angle, assembly = LINKAGES["crank-rocker"]
    given = (size * a, size * b, size * c, size * d, size * p, angle, assembly)
    one = solved(stated(*LINKAGES["crank-rocker"])).designs[0]
    other = solved(stated(*given, at=size * (3.0 - 2.0j))).designs[0]
    assert np.isclose(other.metrics.quality, one.metrics.quality, rtol=1e-4)


@pytest.mark.parametrize("rank_by", ["quality", "transmission_angle", "size"])
def test_the_order_follows_its_ranking_at_every_place(rank_by: str) -> None:
    # Cranks and rockers in turn, by quality: 0.31, 0.08, 0.08 and 0.07.
    linkage = {
        "fixed_pivots": {"input": [0.0, 0.0], "output": [3.933, 0.0]},
        "links": {"input": 1.0, "coupler": 1.843, "output": 3.99},
        "coupler_point": {"distance": 1.465, "angle": 27.08},
    }
    designs = solved(parse_problem({"kind": "parallel_motion", "linkage": linkage, "rank_by": rank_by})).designs
    key = {"quality": "quality", "transmission_angle": "min_transmission_angle", "size": "size"}[rank_by]
    values = [getattr(design.metrics, key) for design in designs]
    assert len(values) == 4
    assert len({design.metrics.full_rotation for design in designs}) == 2
    # Sixbars that cannot be built come last in any order: here the ones with the best quality and angle.
    buildable = [design.metrics.relative_link_width >= MIN_RELATIVE_WIDTH for design in designs]
    assert buildable == sorted(buildable, reverse=True)
    count = sum(buildable)
    assert values == [
        part for own in (values[:count], values[count:]) for part in sorted(own, reverse=rank_by != "size")
    ]


@pytest.mark.slow
def test_from_a_path_problem() -> None:
    path = {
        "kind": "path",
        "points": [{"x": 40.0, "y": 30.0}, {"x": 20.0, "y": 45.0}, {"x": 2.0, "y": 30.0}],
        "method": "exact", "rounds": 1, "max_designs": 20,
    }  # fmt: skip
    problem = parse_problem({"kind": "parallel_motion", "path": path})
    result = solved(problem)
    for design in result.designs:
        assert design.metrics.base == "path"
        assert len(design.targets) == 3
        assert max(target.residual for target in design.targets) < 1e-9
        assert math.radians(design.metrics.rotation) < 1e-9
    assert result.search.candidates > 0
    assert result.designs


def test_verification_notices_a_wrong_length() -> None:
    problem = stated(*LINKAGES["crank-rocker"])
    design = solved(problem).designs[0]
    for joint in ("Q", "C", "P"):
        joints = dict(design.mechanism.skeleton.joints)
        joints[joint] = (joints[joint][0] * 1.01, joints[joint][1])
        skeleton = design.mechanism.skeleton.model_copy(update={"joints": joints})
        spoilt = design.mechanism.model_copy(update={"skeleton": skeleton})
        # Dimensions that the skeleton does not have are refused.
        assert verify_parallel_motion(problem, spoilt, "source", "input") is None
        if joint != "P":
            links = {"input": design.mechanism.links["input"]}
            again = verify_parallel_motion(problem, spoilt.model_copy(update={"links": links}), "source", "input")
            assert again is None or not again.verification.passed


@pytest.mark.parametrize(
    ("changed", "path"),
    [
        ({"links": {"input": 20.0, "coupler": 20.0, "output": 19.0}}, "/linkage/links"),
        ({"coupler_point": {"distance": 70.0, "angle": 0.0}}, "/linkage/coupler_point"),
        ({"fixed_pivots": {"input": [1.0, 1.0], "output": [1.0, 1.0]}}, "/linkage/fixed_pivots/output"),
        (
            {"coupler_point": {"distance": 1e-3}, "fixed_pivots": {"input": [9e8, 0.0], "output": [9e8 + 60.0, 0.0]}},
            "/linkage/links",
        ),
    ],
)
def test_contradictions_are_told_by_their_field(changed, path) -> None:
    linkage = {
        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
        "links": {"input": 20.0, "coupler": 70.0, "output": 90.0},
        "coupler_point": {"distance": 60.0, "angle": 30.0},
        **changed,
    }
    with pytest.raises(ContradictionError) as caught:
        solve(parse_problem({"kind": "parallel_motion", "linkage": linkage}), lambda fraction, message: None)
    assert caught.value.contradiction.path == path


def test_neither_or_both_is_refused() -> None:
    for fields in ({}, {"linkage": get_first_example("parallel_motion")["linkage"], "path": get_first_example("path")}):
        problem = parse_problem({"kind": "parallel_motion", **fields})
        assert "/linkage" in [fault.path for fault in problem.find_contradictions()]
    on_pin = stated(20.0, 70.0, 90.0, 60.0, 0.0, 30.0, "open")
    assert [fault.path for fault in on_pin.find_contradictions()] == ["/linkage/coupler_point"]


def as_answered(changes):
    """A fourbar as an answer has it, with some of it changed."""
    known = parse_problem(get_first_example("parallel_motion")).linkage
    base = {**known.model_dump(exclude_none=True), "reference_input_angle": 40.0}
    linkage = parse_problem({"kind": "parallel_motion", "linkage": base}).linkage
    joints = {name: [z.real, z.imag] for name, z in linkage.joints.items()}
    links = {"ground": ["O2", "O4"], "input": ["O2", "A"], "coupler": ["A", "B", "P"], "output": ["O4", "B"]}
    skeleton = {
        "joints": joints,
        "links": [{"name": name, "joints": listed} for name, listed in links.items()],
        "slides": [],
        "gears": [],
        "input_link": "input",
    }
    base["links"]["ground"] = 60.0
    return parse_problem(
        {"kind": "parallel_motion", "linkage": {**base, "skeleton": skeleton, **changes(base, joints)}}
    )


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        (lambda base, joints: {}, None),
        (lambda base, joints: {"reference_input_angle": None}, None),
        (lambda base, joints: {"links": {**base["links"], "ground": 60.1}}, "/linkage/links/ground"),
        (lambda base, joints: {"reference_input_angle": 41.0}, "/linkage/skeleton/joints/A"),
        (lambda base, joints: {"assembly": "crossed"}, "/linkage/skeleton/joints/B"),
        (lambda base, joints: {"links": {**base["links"], "output": 91.0}}, "/linkage/skeleton/joints/B"),
        (lambda base, joints: {"coupler_point": {"distance": 61.0, "angle": 30.0}}, "/linkage/skeleton/joints/P"),
    ],
)
def test_a_fourbar_of_an_answer_says_one_thing(changes, path):
    problem = as_answered(changes)
    assert [fault.path for fault in problem.find_contradictions()] == ([] if path is None else [path])
    if path is None:
        assert solve(problem, lambda fraction, message: None).designs


def test_an_input_angle_that_there_is_not_is_refused_at_once():
    linkage = {
        "fixed_pivots": {"input": [0.0, 0.0], "output": [60.0, 0.0]},
        "links": {"input": 50.0, "coupler": 20.0, "output": 40.0},
        "coupler_point": {"distance": 30.0, "angle": 30.0},
        "reference_input_angle": 180.0,
    }
    problem = parse_problem({"kind": "parallel_motion", "linkage": linkage})
    assert [fault.path for fault in problem.find_contradictions()] == ["/linkage/reference_input_angle"]
