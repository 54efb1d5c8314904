"""Slider dyads: their points, whole mechanisms with them against an independent continuation, and what is said."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synthesis.analyses import parse_request
from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.dyads.slider_dyads import Sliders, find_sliders
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.statement.dyad_choices import DyadChoices
from synthesis.kinds.motion.task.positions import make_motion_task
from synthesis.kinds.motion.verification.verify import verify
from synthesis.model.linkage.answer import InvertedSliderCrankMechanism, LinkageDesign, SliderCrankMechanism
from synthesis.registry import parse_problem
from tests.support.synthesis.driving import assert_drives_through, turns_through
from tests.support.synthesis.planted import inverted_images

ORDINARY = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 40.0, "y": 15.0, "angle": -25.0},
            {"x": 75.0, "y": 5.0, "angle": -60.0}]  # fmt: skip


def random_positions(rng: np.random.Generator, n: int) -> list[dict[str, float]]:
    points, angles = rng.normal(0.0, 2.0, (n, 2)), rng.uniform(-60.0, 60.0, n)
    return [{"x": float(x), "y": float(y), "angle": float(a)} for (x, y), a in zip(points, angles, strict=True)]


def problem_of(positions: list[dict[str, float]], **more: Any) -> MotionProblem:
    problem = parse_problem({"kind": "motion", "positions": positions, **more})
    assert isinstance(problem, MotionProblem)
    assert problem.find_contradictions() == []
    return problem


def solved(problem: MotionProblem) -> MotionResult:
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, MotionResult)
    return result


def found(positions: list[dict[str, float]], *, inverted: bool, count: int = 50, **choices: Any) -> Sliders:
    problem = problem_of(positions)
    rng = np.random.default_rng(0)
    return find_sliders(make_motion_task(problem), DyadChoices(**choices), inverted=inverted, rng=rng, count=count)


@pytest.mark.parametrize("inverted", [False, True])
@pytest.mark.parametrize("n", [2, 3, 4])
def test_images_lie_on_the_line(n: int, inverted: bool) -> None:
    rng = np.random.default_rng(n)
    for _ in range(30):
        positions = random_positions(rng, n)
        task = make_motion_task(problem_of(positions))
        slides = found(positions, inverted=inverted)
        assert len(slides.points) == 1 if n == 4 else len(slides.points) > 20
        assert slides.sampled == (n < 4)
        images = inverted_images(task, slides.points) if inverted else task.images(slides.points)
        off = ((images - images[:, :1]) * np.exp(-1j * slides.angles)[:, None]).imag
        assert np.abs(off).max() < 1e-9


def test_four_positions_leave_the_point_that_brute_force_finds() -> None:
    """The three triangles of images of a point of the body vanish together in one point only, and in no pole."""
    rng = np.random.default_rng(5)
    positions = random_positions(rng, 4)
    task = make_motion_task(problem_of(positions))
    slides = found(positions, inverted=False)
    (point,) = slides.points
    grid = point + np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 24)) * np.logspace(-3, 0.5, 30)[:, None]
    images = task.images(grid.ravel())
    sides = images[:, 1:] - images[:, :1]
    spread = np.abs(sides).max(axis=1)
    areas = np.stack([(np.conj(sides[:, i]) * sides[:, j]).imag for i, j in ((0, 1), (0, 2), (1, 2))])
    assert (np.abs(areas).max(axis=0) / spread**2).min() > 1e-5


def test_five_positions_slide_by_chance_only() -> None:
    rng = np.random.default_rng(6)
    assert len(found(random_positions(rng, 5), inverted=False).points) == 0
    line, turns = np.exp(0.4j), np.radians([0.0, 20.0, 35.0, 60.0, 80.0])
    pins = 3.0 + 1.0j + line * np.array([0.0, 0.7, 1.1, 2.0, 2.6])
    points = pins + np.exp(1j * turns) * (0.5 - 0.8j)
    chance = [{"x": z.real, "y": z.imag, "angle": math.degrees(a)} for z, a in zip(points, turns, strict=True)]
    slides = found(chance, inverted=False)
    assert len(slides.points) == 1
    assert math.remainder(float(slides.angles[0]) - 0.4, math.pi) == pytest.approx(0.0, abs=1e-9)


def test_a_stated_direction_leaves_one_point_for_three_positions() -> None:
    for inverted in (False, True):
        slides = found(ORDINARY, inverted=inverted, dyad="RP" if inverted else "PR", slide_angle=30.0)
        assert len(slides.points) == 1
        assert slides.angles[0] == pytest.approx(math.radians(30.0))


def check_all(positions: list[dict[str, float]], **more: Any) -> int:
    problem = problem_of(positions, max_designs=4, **more)
    result = solved(problem)
    for design in result.designs:
        assert design.verification.passed
        assert_drives_through(design, problem)
        if design.metrics.full_rotation and not isinstance(design.mechanism, SliderCrankMechanism):
            assert turns_through(design)
    return len(result.designs)


SIDES = [{"output_side": {"dyad": "PR"}}, {"output_side": {"dyad": "RP"}}, {"input_side": {"dyad": "PR"}}]


@pytest.mark.slow
@pytest.mark.parametrize("side", SIDES)
def test_sliders_carry_the_body_without_a_defect(side: dict[str, Any]) -> None:
    assert check_all(ORDINARY, **side) > 0
    assert check_all(ORDINARY[:2], **side) > 0


@pytest.mark.campaign
@pytest.mark.parametrize("side", SIDES)
def test_no_slider_design_has_a_defect_by_continuation(side: dict[str, Any]) -> None:
    rng = np.random.default_rng(8)
    assert sum(check_all(random_positions(rng, 2 + k % 3), **side) for k in range(6)) > 5


@pytest.mark.campaign
@pytest.mark.parametrize("side", SIDES)
def test_no_slider_design_of_many_has_a_defect(side: dict[str, Any]) -> None:
    rng = np.random.default_rng(9)
    assert sum(check_all(random_positions(rng, 2 + k % 3), **side) for k in range(30)) > 40


def design_with(kind: str) -> LinkageDesign:
    return solved(problem_of(ORDINARY, output_side={"dyad": kind}, max_designs=1)).designs[0]


@pytest.mark.parametrize("kind", ["PR", "RP"])
def test_damaged_dimensions_are_found(kind: str) -> None:
    problem = problem_of(ORDINARY, output_side={"dyad": kind})
    design = design_with(kind)
    data = design.mechanism.model_dump()
    model = SliderCrankMechanism if kind == "PR" else InvertedSliderCrankMechanism
    changes: list[dict[str, Any]] = [
        {"links": {**data["links"], name: value * (1.0 + 1e-5)}} for name, value in data["links"].items() if value > 0.0
    ]
    point = data["coupler_point"]
    changes += [{"coupler_point": {**point, "distance": point["distance"] * (1.0 + 1e-5)}},
                {"coupler_point": {**point, "angle": point["angle"] + 1e-3}},
                {"reference_input_angle": data["reference_input_angle"] + 1e-3},
                {"assembly": "open" if data["assembly"] == "crossed" else "crossed"}]  # fmt: skip
    for change in changes:
        damaged = verify(problem, model.model_validate({**data, **change}))
        assert damaged is None or not damaged.verification.passed, change


@pytest.mark.parametrize("kind", ["PR", "RP"])
def test_designs_are_taken_as_they_are_by_an_analysis(kind: str) -> None:
    design = design_with(kind)
    inputs = [target.position for target in design.targets]
    skeleton = design.mechanism.skeleton.model_dump()
    for mechanism in (design.mechanism.model_dump(), {"type": design.mechanism.type, "skeleton": skeleton}):
        for at, position in zip(inputs, ORDINARY, strict=True):
            answer = parse_request({"mechanism": mechanism, "motion": {"at": at}}).build_answer()
            assert answer["valid"] == [True]
            assert answer["joints"]["P"]["x"][0] == pytest.approx(position["x"], abs=1e-6)
            assert answer["joints"]["P"]["y"][0] == pytest.approx(position["y"], abs=1e-6)


@pytest.mark.parametrize(("side", "slides"), [("input_side", True), ("output_side", False)])
def test_an_input_stands_at_an_angle_or_at_a_place(side: str, slides: bool) -> None:
    problem = problem_of(ORDINARY, **{side: {"dyad": "PR"}}, max_designs=1)
    design = solved(problem).designs[0]
    stated, absent = ("input_place", "input_angle") if slides else ("input_angle", "input_place")
    for target in design.targets:
        assert target.position == getattr(target, stated)
        assert absent not in target.model_dump(mode="json")
    gone = design.metrics.input_stroke if slides else design.metrics.input_rotation
    assert gone == pytest.approx(design.targets[-1].position - design.targets[0].position)
    assert (design.metrics.input_rotation if slides else design.metrics.input_stroke) is None
    assert_drives_through(design, problem)


def test_a_slider_is_offered_where_pins_cannot_do_it() -> None:
    straight = [{"x": x, "y": 0.0, "angle": a} for x, a in ((0.0, 0.0), (1.0, 20.0), (3.0, 50.0))]
    result = solved(problem_of(straight, output_side={"moving_pivot": [0.0, 0.0]}))
    assert {design.mechanism.type for design in result.designs} == {"slider_crank"}
    assert "slider" in result.summary
    pinned = solved(problem_of(straight, output_side={"moving_pivot": [0.0, 0.0], "dyad": "RR"}))
    assert pinned.designs == []
    assert pinned.search.complete


def test_a_stated_pivot_off_any_line_is_an_honest_none() -> None:
    result = solved(problem_of(ORDINARY, output_side={"dyad": "PR", "moving_pivot": [3.0, 17.0]}))
    assert result.designs == []
    assert result.search.complete
    assert "line" in result.summary


@settings(max_examples=4, deadline=None)
@given(st.floats(-3.0, 3.0), st.floats(-2.0, 2.0), st.floats(-50.0, 50.0))
def test_similar_tasks_have_similar_slider_points(turn: float, power: float, x: float) -> None:
    factor, shift = 10.0**power * np.exp(1j * turn), complex(x, 2.0 * x)
    four = random_positions(np.random.default_rng(10), 4)
    moved = []
    for p in four:
        z = factor * complex(p["x"], p["y"]) + shift
        moved.append({"x": z.real, "y": z.imag, "angle": p["angle"] + math.degrees(turn)})
    tasks = [make_motion_task(problem_of(p)) for p in (four, moved)]
    one, other = (t.to_problem(complex(found(p, inverted=False).points[0]))
                  for t, p in zip(tasks, (four, moved), strict=True))  # fmt: skip
    assert other == pytest.approx(factor * one + shift, rel=1e-8, abs=1e-8 * abs(factor))


@pytest.mark.slow
def test_a_slider_of_five_positions_is_among_the_answers_beside_fourbars() -> None:
    """A slider-crank's own positions: its pin B is a dyad like the three with two pins."""
    o2, a, line = 1.3 + 0.4j, 2.1 + 1.9j, 0.4
    along = cmath.exp(1j * line)
    b = 5.2 + 0.3j
    rod = abs(b - a)
    positions = []
    for turn in (0.0, -0.25, -0.6, -0.85, -1.2):
        pin = o2 + (a - o2) * cmath.exp(1j * turn)
        q = (pin - b) / along
        slid = b + along * (q.real + math.sqrt(rod**2 - q.imag**2))
        body = (slid - pin) / (b - a)
        p = pin + body * (1.0 + 1.5j)
        positions.append({"x": p.real, "y": p.imag, "angle": math.degrees(cmath.phase(body))})
    problem = parse_problem({"kind": "motion", "positions": positions, "max_designs": 50})
    result = solve(problem, lambda fraction, message: None)
    assert isinstance(result, MotionResult)
    search = result.search
    assert search.complete
    assert search.candidates == search.accepted + sum(search.rejected.values())
    assert "fourbar" in {design.mechanism.type for design in result.designs}
    wanted = np.array([o2, a, b])
    gaps = []
    for design in result.designs:
        assert_drives_through(design, problem)
        joints = design.mechanism.skeleton.joints
        if design.mechanism.type == "slider_crank":
            gaps.append(np.abs(np.array([complex(*joints[name]) for name in ("O2", "A", "B")]) - wanted).max())
    assert min(gaps) < 1e-7
    # A driver is added to fourbars alone.
    driven = solved(problem_of(positions, driver_dyad=True))
    assert {design.mechanism.type for design in driven.designs} <= {"watt_2", "stephenson_3"}


def test_a_straight_translation_is_fitted_without_endless_links() -> None:
    """Links of the nearest linkages grow beyond all statements there: they are refused, and the answer is honest."""
    positions = [{"x": 10.0 * k, "y": 0.0, "angle": 0.0} for k in range(9)]
    result = solve(parse_problem({"kind": "motion", "positions": positions}), lambda fraction, message: None)
    assert isinstance(result, MotionResult)
    assert not result.search.complete
    assert all(design.verification.passed for design in result.designs)


def test_a_slider_that_the_statement_leaves_out_is_told_of() -> None:
    """A ground line is for pins; the block that could stand on it is told of, and nothing is called impossible."""
    positions = [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 30.0, "y": 18.0, "angle": -20.0},
                 {"x": 55.0, "y": 22.0, "angle": -42.0}, {"x": 75.0, "y": 15.0, "angle": -60.0}]  # fmt: skip
    result = solved(problem_of(positions, ground_line={"point": [0.0, 0.0], "angle": 90.0}))
    assert result.designs == []
    assert "a slider (RP)" in result.summary
    assert "no design exists" not in result.summary
