"""Driver dyads: sixbars whose crank turns through and whose driven link has its limits at the end positions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.driver.solver import USABLE_ANGLE, _list_stages
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import LinkageDesign, SixbarMechanism
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.synthesis.driving import assert_drives_through, constraints_of, turns_through

TWO = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 30.0, "y": 20.0, "angle": 45.0}]
THREE = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 40.0, "y": 15.0, "angle": -25.0},
         {"x": 75.0, "y": 5.0, "angle": -60.0}]  # fmt: skip


def solved(positions: list[dict[str, float]], **more: Any) -> tuple[MotionProblem, MotionResult]:
    statement = {"kind": "motion", "positions": positions, "driver_dyad": True, "max_designs": 3, **more}
    problem = parse_problem(statement)
    assert isinstance(problem, MotionProblem)
    assert problem.find_contradictions() == []
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, MotionResult)
    return problem, result


def sixbar(design: LinkageDesign) -> SixbarMechanism:
    assert isinstance(design.mechanism, SixbarMechanism)
    return design.mechanism


def driven_swing(design: LinkageDesign) -> tuple[float, float]:
    """Swing of the driven link over a turn of the crank, and between the end positions, by the constraints alone."""
    constraints = constraints_of(design)
    pivot = "O2" if "C" in next(k for k in design.mechanism.skeleton.links if k.name == "input").joints else "O4"
    trace = constraints.follow(constraints.start(), 1.0, limit=2.0 * math.pi)[0]
    joints = constraints.take(np.zeros(len(trace.points), int)).joints(trace.points)
    turned = np.unwrap(np.angle(joints["C"] - joints[pivot]))
    last = math.radians(design.targets[-1].input_angle - design.targets[0].input_angle) % math.tau
    ((_, met),) = trace.at(last, 1e9)
    end = constraints.joints(met[None])
    between = abs(np.angle((end["C"][0] - end[pivot][0]) / (joints["C"][0] - joints[pivot][0])))
    return float(np.ptp(turned)), float(between)


@pytest.mark.campaign
@pytest.mark.parametrize("positions", [TWO, THREE])
def test_the_crank_turns_through_between_the_end_positions(positions: list[dict[str, float]]) -> None:
    problem, result = solved(positions)
    assert result.designs
    for design in result.designs:
        assert design.verification.passed
        names = {check.name for check in design.verification.checks}
        assert names >= {"reaches_targets", "same_circuit", "same_branch", "visits_in_order", "crank_turns", "limits"}
        assert_drives_through(design, problem)
        assert turns_through(design)
        swing, between = driven_swing(design)
        # The trace samples the swing; its ends are limits, where the angle is stationary.
        assert swing == pytest.approx(between, abs=5e-3)
        assert swing <= between + 1e-9
        assert set(design.metrics.transmission_angles) == {"driver_coupler", "coupler"}
        assert design.metrics.min_transmission_angle == min(design.metrics.transmission_angles.values())


def test_the_crank_lies_in_line_with_its_link_at_both_ends() -> None:
    """Norton, Examples 3-4 and 3-6: the stage is at a toggle of its rocker at both ends."""
    _, result = solved(THREE, max_designs=1)
    mechanism = sixbar(result.designs[0])
    joints = {name: complex(*z) for name, z in mechanism.skeleton.joints.items()}
    o6, c, d = joints["O6"], joints["C"], joints["D"]
    assert ((d - o6).conjugate() * (c - d)).imag == pytest.approx(0.0, abs=1e-9 * abs(c - o6) ** 2)
    assert mechanism.links["crank"] == pytest.approx(abs(d - o6))
    assert mechanism.links["driver_coupler"] == pytest.approx(abs(c - d))


def test_a_pivot_on_the_chord_has_half_of_it_for_its_crank() -> None:
    """Norton, Example 3-4: the crank is half of the chord between C₁ and C₂."""
    for swing in (0.4, 0.9, 1.5):
        stage = _list_stages(swing)
        assert len(stage.score) > 3
        ends = np.exp(np.array([-0.5j, 0.5j]) * swing)
        reach = np.abs(ends - stage.pivot[:, None])
        assert stage.crank == pytest.approx(0.5 * np.abs(reach[:, 1] - reach[:, 0]))
        # The triangle of O6, C₁ and C₂ bounds the crank by half of the chord, which it reaches on the chord's line.
        assert np.all(stage.crank <= math.sin(0.5 * swing) + 1e-12)


def test_the_transmission_of_the_stage_is_as_promised() -> None:
    """The least angle of a crank-rocker stands where the crank lies on the ground line."""
    _, result = solved(TWO, max_designs=1)
    links, least = sixbar(result.designs[0]).links, result.designs[0].metrics.transmission_angles["driver_coupler"]
    a, b, c, d = (links[name] for name in ("crank", "driver_coupler", "driver_arm", "driver_ground"))
    cosines = [abs(b * b + c * c - (d + sign * a) ** 2) / (2.0 * b * c) for sign in (-1, 1)]
    assert math.radians(least) == pytest.approx(math.acos(max(cosines)), abs=1e-9)


def test_the_crank_s_pivot_can_be_kept_in_a_region() -> None:
    region = {"x": [60.0, 140.0], "y": [-120.0, -20.0]}
    _, result = solved(TWO, driver_dyad={"pivot_region": region})
    assert result.designs
    for design in result.designs:
        x, y = sixbar(design).fixed_pivots["O6"]
        assert 60.0 <= x <= 140.0
        assert -120.0 <= y <= -20.0
        assert "driver_pivot_region" in {check.name for check in design.verification.checks}


@pytest.mark.slow
@pytest.mark.parametrize("link", ["input", "output"])
def test_the_driven_link_can_be_chosen(link: str) -> None:
    problem, result = solved(TWO, driver_dyad={"link": link}, max_designs=2)
    assert result.designs
    for design in result.designs:
        bars = {bar.name: bar.joints for bar in design.mechanism.skeleton.links}
        assert "C" in bars[link]
        assert_drives_through(design, problem)


def input_swing(design: LinkageDesign) -> tuple[float, float]:
    """Swing of the input link over a turn of the crank, and from the first target to the last, by constraints alone."""
    constraints = constraints_of(design)
    trace = constraints.follow(constraints.start(), 1.0, limit=2.0 * math.pi)[0]
    joints = constraints.take(np.zeros(len(trace.points), int)).joints(trace.points)
    turned = np.unwrap(np.angle(joints["A"] - joints["O2"]))
    last = math.radians(design.targets[-1].input_angle - design.targets[0].input_angle) % math.tau
    ((_, met),) = trace.at(last, 1e9)
    end = constraints.joints(met[None])
    near = int(np.abs(trace.points - met).sum(axis=1).argmin())
    aside = np.angle((end["A"][0] - end["O2"][0]) / (joints["A"][near] - joints["O2"][near]))
    return float(np.ptp(turned)), float(abs(turned[near] + aside - turned[0]))


WIDE = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 30.0, "y": 40.0, "angle": 150.0},
        {"x": 10.0, "y": 70.0, "angle": -110.0}]  # fmt: skip


@pytest.mark.campaign
@pytest.mark.parametrize("positions", [TWO, THREE, WIDE], ids=["two", "three", "wide"])
def test_the_coupler_can_be_driven(positions: list[dict[str, float]]) -> None:
    problem, result = solved(positions, driver_dyad={"link": "coupler"})
    assert result.designs
    for design in result.designs:
        assert design.mechanism.type == "stephenson_3"
        assert "C" in next(bar.joints for bar in design.mechanism.skeleton.links if bar.name == "coupler")
        assert {check.name for check in design.verification.checks} >= {"crank_turns", "limits"}
        assert_drives_through(design, problem)
        assert turns_through(design)
        swing, between = input_swing(design)
        assert swing == pytest.approx(between, abs=5e-3)
        assert set(design.metrics.transmission_angles) == {"driver_coupler", "input", "output"}
        assert design.metrics.min_transmission_angle > 5.0


@pytest.mark.campaign
def test_the_coupler_is_driven_where_no_link_of_the_ground_can_be() -> None:
    """All fourbars found for this task turn their links by more than a rocker's driver can, or can well."""
    problem, result = solved(WIDE, driver_dyad={"link": "any"})
    assert {design.mechanism.type for design in result.designs} == {"stephenson_3"}
    for link in ("input", "output"):
        _, alone = solved(WIDE, driver_dyad={"link": link})
        assert all(design.metrics.min_transmission_angle < USABLE_ANGLE for design in alone.designs)
        assert not alone.search.complete
    for design in result.designs:
        assert_drives_through(design, problem)


def test_damage_to_a_driver_of_the_coupler_is_found() -> None:
    problem, result = solved(THREE, max_designs=1, driver_dyad={"link": "coupler"})
    mechanism = sixbar(result.designs[0])
    for joint in ("C", "D", "O6", "A", "B"):
        data = mechanism.model_dump()
        x, y = data["skeleton"]["joints"][joint]
        data["skeleton"]["joints"][joint] = (x + 0.05, y)
        damaged = verify(problem, SixbarMechanism.model_validate(data))
        assert damaged is None or not damaged.verification.passed, joint


def test_damage_is_found() -> None:
    problem, result = solved(THREE, max_designs=1)
    mechanism = sixbar(result.designs[0])
    for joint in ("C", "D", "O6", "A", "B"):
        data = mechanism.model_dump()
        x, y = data["skeleton"]["joints"][joint]
        data["skeleton"]["joints"][joint] = (x + 0.05, y)
        damaged = verify(problem, SixbarMechanism.model_validate(data))
        assert damaged is None or not damaged.verification.passed, joint


def test_designs_are_taken_as_they_are_by_an_analysis() -> None:
    _, result = solved(THREE, max_designs=1)
    design = result.designs[0]
    request = {
        "mechanism": design.mechanism.model_dump(exclude_none=True),
        "motion": {"at": design.targets[1].input_angle},
    }
    answer = parse_request(request).build_answer()
    assert answer["joints"]["P"]["x"] == pytest.approx([40.0], abs=1e-6)
    assert len(answer["circuits"]) >= 1


@pytest.mark.campaign
def test_fitted_positions_are_driven_too() -> None:
    positions = [{"x": 10.0 * k, "y": 3.0 * k - 0.3 * k * k, "angle": -9.0 * k} for k in range(7)]
    _, result = solved(positions, max_designs=1)
    assert result.designs
    for design in result.designs:
        assert {c.name: c.passed for c in design.verification.checks}["limits"]
        assert turns_through(design)


def test_a_slider_cannot_be_driven_so_and_the_field_is_named() -> None:
    problem = parse_problem({"kind": "motion", "positions": THREE, "driver_dyad": True, "output_side": {"dyad": "PR"}})
    assert "/driver_dyad" in [c.path for c in problem.find_contradictions()]


@pytest.mark.campaign
def test_no_sixbar_of_many_has_a_defect() -> None:
    rng = np.random.default_rng(20)
    count = 0
    for k in range(12):
        points, angles = rng.normal(0.0, 2.0, (2 + k % 2, 2)), rng.uniform(-60.0, 60.0, 2 + k % 2)
        positions = [
            {"x": float(x), "y": float(y), "angle": float(a)} for (x, y), a in zip(points, angles, strict=True)
        ]
        problem, result = solved(positions)
        for design in result.designs:
            assert_drives_through(design, problem)
            assert turns_through(design)
            count += 1
    assert count > 15


@pytest.mark.slow
@pytest.mark.parametrize(
    ("limits", "least"),
    further(
        [({"min_transmission_angle": 60.0}, 10), ({"min_transmission_angle": 70.0}, 4), ({"max_link_ratio": 3.0}, 10)],
        [({"min_transmission_angle": 60.0}, 10)],
    ),
)
def test_the_driver_is_chosen_within_the_limits(limits: dict[str, float], least: int) -> None:
    """A small driver that breaks a limit does not stand in the way of one that keeps it."""
    statement = {"kind": "motion", "positions": THREE, "driver_dyad": True, "constraints": limits}
    result = solve(parse_problem(statement))
    assert len(result.designs) >= least
    for design in result.designs:
        assert design.metrics.min_transmission_angle >= limits.get("min_transmission_angle", 0.0)
        assert design.metrics.link_ratio <= limits.get("max_link_ratio", math.inf) * (1.0 + 1e-9)


@pytest.mark.campaign
def test_drivers_that_break_a_limit_are_shown_where_failures_are_asked_for() -> None:
    statement = {"kind": "motion", "positions": THREE, "driver_dyad": {"link": "input"}, "include_failed": True}
    result = solve(parse_problem(statement | {"constraints": {"max_link_ratio": 1.5}, "max_designs": 2}))
    assert result.designs
    assert not any(design.verification.passed for design in result.designs)
