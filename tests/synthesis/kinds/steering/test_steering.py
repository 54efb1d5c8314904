"""Steering: the book's linkages and gears, optima by brute force, alternation of the error, and degenerate vehicles."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from kinematics.linkage.fourbar import Fourbar, positions
from kinematics.linkage.steering import compute_davis_arm_angle, compute_outer_angle
from synthesis.dispatch import solve
from synthesis.kinds.steering.design import SteeringDesign, SteeringResult
from synthesis.kinds.steering.problem import SteeringProblem
from synthesis.kinds.steering.verification import verify_steering
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.cases import cases
from tests.oracles.davis_gear import davis_angles


def answer(**stated: Any) -> SteeringResult:
    result = solve(parse_problem({"kind": "steering", **stated}), lambda fraction, message: None)
    assert isinstance(result, SteeringResult)
    return result


def trapezium(pivot: float, arm: float, lean: float, side: str) -> tuple[complex, complex]:
    """Pins of the tie rod in the straight position, the kingpins at ∓ pivot/2."""
    left = arm * complex(math.sin(lean), -math.cos(lean)) * (1.0 if side == "behind" else -1.0)
    return -0.5 * pivot + left, 0.5 * pivot - left.conjugate()


def measured(case: Any) -> tuple[float, SteeringDesign]:
    """The linkage of a row, with its tie rod longer than the distance of the kingpins hence ahead, as it is driven."""
    given = case.inputs
    pivot, arm, rod = given["pivot"], given["arm"], given["rod"]
    lean = math.asin((rod - pivot) / (2.0 * arm))
    a, b = trapezium(pivot, arm, lean, "ahead")
    mechanism = build_fourbar(FourbarConfiguration(complex(-0.5 * pivot), a, b, complex(0.5 * pivot), a))
    problem = parse_problem(
        {
            "kind": "steering",
            "wheelbase": given["wheelbase"],
            "pivot_distance": pivot,
            "track": given.get("track"),
            "lock": float(given.get("theta_in", 33.0)),
        }
    )
    assert isinstance(problem, SteeringProblem)
    design = verify_steering(problem, mechanism)
    assert design is not None
    return lean, design


@pytest.mark.parametrize("case", cases("ackermann", "steering_hooke"))
def test_the_book_s_linkage(case: Any) -> None:
    lean, design = measured(case)
    last = design.targets[-1]
    assert last.inner == pytest.approx(case.inputs["theta_in"], abs=1e-9)
    computed = {"alpha": math.degrees(lean), "phi": last.outer, "phi_required": last.required}
    case.check(**{name: computed[name] for name in case.expected})


def turning_radii(pivot: float, wheelbase: float, track: float, inner: float) -> tuple[float, float]:
    """Distances of the front wheels from the centre of turning, the inner one's and the outer one's.

    The centre lies on the line of the rear axle, where the normal of the inner wheel meets it; each wheel stands beside
    its kingpin by half of what the track is wider, on the wheel's own axis.
    """
    kingpins = np.array([-0.5 * pivot, 0.5 * pivot])
    centre = complex(-0.5 * pivot - wheelbase / math.tan(inner), -wheelbase)
    away = kingpins - centre
    beside = 0.5 * (track - pivot) * np.array([-1.0, 1.0])
    radii = np.abs(away + beside * away / np.abs(away))
    return float(radii[0]), float(radii[1])


@pytest.mark.parametrize("case", cases("ackermann_correct", "steering_hooke"))
def test_where_the_book_s_linkage_steers_correctly(case: Any) -> None:
    """All but R_outer, which the book reads from a figure: see the next test."""
    _, design = measured(case)
    (theta,) = design.metrics.correct_at
    given, inner = case.inputs, math.radians(theta)
    phi = float(compute_outer_angle(inner, given["pivot"] / given["wheelbase"]))
    near, _ = turning_radii(given["pivot"], given["wheelbase"], given["track"], inner)
    found = {"theta": theta, "phi": math.degrees(phi), "R_inner": near}
    for name, value in found.items():
        assert case.expected[name].agrees(value), name
    assert case.expected.keys() - found.keys() == {"R_outer"}


@pytest.mark.parametrize("case", cases("ackermann_correct", "steering_hooke"))
def test_the_book_s_outer_radius_is_one_of_the_inner_wheel(case: Any) -> None:
    """Rao, Solved Problem 4.6: "R_outer" 5.2987 m, measured on a drawing, cannot be the outer wheel's radius.

    That one is 6.57 m in the position of correct steering and above 6.2 m at 33°, the greatest angle that the book
    looks at; it would be 5.2987 m at 41°. It is the radius of the inner wheel (5.2358 m) as near as drawings are read,
    and exactly so at 30.4°, beside the 30.8° where the linkage steers correctly.
    """
    given, printed = case.inputs, case.expected["R_outer"].value
    vehicle = given["pivot"], given["wheelbase"], given["track"]
    near, far = turning_radii(*vehicle, math.radians(case.expected["theta"].value))
    assert near == pytest.approx(printed, rel=0.015)
    assert far > 1.2 * printed
    looked_at = np.radians(np.linspace(0.5, 40.0, 400))
    assert min(turning_radii(*vehicle, angle)[1] for angle in looked_at) > printed
    exactly = turning_radii(*vehicle, math.radians(30.39))[0]
    assert exactly == pytest.approx(printed, abs=2e-3)


@pytest.mark.parametrize("case", cases("davis_property", "steering_hooke"))
def test_the_property_of_davis_s_gear(case: Any) -> None:
    h, x = case.inputs["h"], case.inputs["x"]
    alpha = math.atan(case.inputs["c"] / h)
    inner, outer = davis_angles(h, alpha, x)
    case.check(diff=1.0 / math.tan(float(outer)) - 1.0 / math.tan(float(inner)))


@pytest.mark.parametrize("case", cases("davis", "steering_hooke"))
def test_the_arms_of_davis_s_gear(case: Any) -> None:
    pivot, wheelbase = case.inputs["pivot"], case.inputs["wheelbase"]
    case.check(alpha=math.degrees(float(compute_davis_arm_angle(pivot / wheelbase))))
    (design, *_) = answer(wheelbase=wheelbase, pivot_distance=pivot, lock=35.0, mechanism="davis").designs
    case.check(alpha=abs(design.metrics.arm_angle))


def greatest_error(pivot: float, wheelbase: float, arm: float, lean: float, side: str, lock: float) -> float:
    """Of one linkage, driven by the analysis core; degrees."""
    a, b = trapezium(pivot, arm, lean, side)
    o2, o4 = complex(-0.5 * pivot), complex(0.5 * pivot)
    assembly = 1 if ((o4 - a).conjugate() * (b - a)).imag >= 0.0 else -1
    theta = np.linspace(0.0, lock, 401)
    at = positions(Fourbar(o2, o4, arm, abs(b - a), arm), cmath.phase(a - o2) + theta, assembly)
    if not np.all(at.valid):
        return math.inf
    outer = np.angle(np.exp(1j * (at.output_angle - cmath.phase(b - o4))))
    return float(np.degrees(np.abs(outer - compute_outer_angle(theta, pivot / wheelbase)).max()))


@pytest.mark.parametrize("side", ["behind", "ahead"])
@pytest.mark.parametrize(
    ("wheelbase", "pivot", "lock", "arm"),
    [(2.745, 1.22, 40.0, 0.15), (2.5, 1.0, 30.0, 0.2), (3.6, 1.1, 45.0, 0.3), (1.2, 0.9, 55.0, 0.12)],
)
def test_the_least_error_of_a_given_arm(side: str, wheelbase: float, pivot: float, lock: float, arm: float) -> None:
    stated = {"wheelbase": wheelbase, "pivot_distance": pivot, "lock": lock}
    arms = {"min": arm, "max": arm}
    (design,) = answer(**stated, mechanism="ackermann", tie_rod=side, arm_length=arms).designs
    searched = min(
        greatest_error(pivot, wheelbase, arm, lean, side, math.radians(lock))
        for lean in np.radians(np.linspace(0.5, 60.0, 600))
    )
    assert design.metrics.steering_error <= searched + 1e-4
    assert design.metrics.steering_error >= searched - 0.05
    # The error of the best has both signs, equally large.
    problem = parse_problem({"kind": "steering", **stated})
    assert isinstance(problem, SteeringProblem)
    own = design.metrics
    lean = math.radians(own.arm_angle)
    a, b = trapezium(pivot, arm, lean, side)
    assert isinstance(design.mechanism, FourbarMechanism)
    joints = design.mechanism.skeleton.joints
    assert complex(*joints["A"]) == pytest.approx(a, abs=1e-12)
    assert complex(*joints["B"]) == pytest.approx(b, abs=1e-12)
    errors = [target.error for target in design.targets]
    assert min(errors) == pytest.approx(-own.steering_error, abs=1e-4 * own.steering_error)
    assert max(errors) == pytest.approx(own.steering_error, rel=0.02)  # at the listed positions
    assert len(own.correct_at) == 1


@pytest.mark.campaign
def test_the_best_arm_between_its_limits() -> None:
    stated = {"wheelbase": 2.745, "pivot_distance": 1.22, "lock": 40.0, "mechanism": "ackermann"}
    (best, *_) = answer(**stated, arm_length={"min": 0.1, "max": 0.4}, rank_by="accuracy").designs
    for arm in np.linspace(0.1, 0.4, 7):
        for design in answer(**stated, arm_length={"min": float(arm), "max": float(arm)}).designs:
            assert best.metrics.steering_error <= design.metrics.steering_error + 1e-9


def test_davis_s_gear_steers_correctly_from_lock_to_lock() -> None:
    for side in ("behind", "ahead"):
        result = answer(wheelbase=2.5, pivot_distance=1.0, lock=50.0, mechanism="davis", tie_rod=side)
        (design,) = result.designs
        assert result.search.complete
        assert design.metrics.steering_error < 1e-9
        assert design.metrics.tie_rod == side
        assert design.targets[-1].inner == pytest.approx(50.0, abs=1e-9)
        assert design.metrics.outer_lock == pytest.approx(
            math.degrees(math.atan(1.0 / (1.0 / math.tan(math.radians(50.0)) + 0.4))), abs=1e-9
        )


@pytest.mark.campaign
def test_limits_are_kept() -> None:
    stated = {"wheelbase": 2.745, "pivot_distance": 1.22, "lock": 40.0}
    strict = answer(**stated, max_steering_error=0.4)
    assert strict.designs
    assert all(design.metrics.steering_error <= 0.4 for design in strict.designs)
    none = answer(**stated, mechanism="ackermann", max_steering_error=0.01)
    assert none.designs == []
    assert not none.search.complete
    assert none.search.rejected["steering_error"] == none.search.candidates
    steep = answer(**stated, constraints={"min_transmission_angle": 33.0})
    assert all(design.metrics.min_transmission_angle >= 33.0 - 1e-9 for design in steep.designs)


@pytest.mark.slow
@pytest.mark.parametrize("size", further([1e-6, 1e6], [1e6]))
def test_vehicles_of_any_size(size: float) -> None:
    found = answer(wheelbase=2.5 * size, pivot_distance=size, lock=40.0).designs
    known = answer(wheelbase=2.5, pivot_distance=1.0, lock=40.0).designs
    assert len(found) == len(known)
    for one, other in zip(found, known, strict=True):
        assert one.metrics.steering_error == pytest.approx(other.metrics.steering_error, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    ("wheelbase", "pivot", "lock"), [(1.0, 3.0, 30.0), (1.0, 1.0, 89.0), (1e6, 1.0, 20.0), (2.5, 1.0, 0.01)]
)
def test_odd_vehicles_are_answered(wheelbase: float, pivot: float, lock: float) -> None:
    """Kingpins farther apart than the axles, a lock near a right angle, axles far apart, hardly any lock."""
    result = answer(wheelbase=wheelbase, pivot_distance=pivot, lock=lock)
    for design in result.designs:
        assert design.verification.passed
        assert design.targets[-1].inner == pytest.approx(lock, abs=1e-6)
    assert any(design.mechanism.type == "davis" for design in result.designs)


@pytest.mark.parametrize(
    ("stated", "path"),
    [
        ({"lock": 0.0}, "lock"),
        ({"lock": 90.0}, "lock"),
        ({"wheelbase": 0.0}, "wheelbase"),
        ({"pivot_distance": -1.0}, "pivot_distance"),
        ({"arm_length": {"min": 0.3, "max": 0.2}}, "arm_length"),
    ],
)
def test_what_is_refused(stated: dict[str, Any], path: str) -> None:
    with pytest.raises(ValidationError) as caught:
        parse_problem({"kind": "steering", "wheelbase": 2.5, "pivot_distance": 1.0, "lock": 40.0, **stated})
    assert caught.value.errors()[0]["loc"][-1] == path


@pytest.mark.parametrize(
    ("stated", "path"),
    [({"track": 0.9}, "/track"), ({"arm_length": {"min": 0.1, "max": 0.6}}, "/arm_length/max")],
)
def test_contradictions_name_their_field(stated: dict[str, Any], path: str) -> None:
    problem = parse_problem({"kind": "steering", "wheelbase": 2.5, "pivot_distance": 1.0, "lock": 40.0, **stated})
    assert [found.path for found in problem.find_contradictions()] == [path]
