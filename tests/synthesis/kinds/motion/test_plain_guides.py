"""Plain guides: bodies that need a hinge, a slide or a parallelogram, rebuilt from the returned numbers alone."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.plain_guide import add_plain_guide
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.results.candidate_log import CandidateLog

PIVOT = 10.0 + 5.0j


def turn_about(pivot: complex, arm: complex, angles: list[float], digits: int = 12) -> list[dict[str, float]]:
    places = [pivot + arm * cmath.rect(1.0, math.radians(a)) for a in angles]
    return [
        {"x": round(z.real, digits), "y": round(z.imag, digits), "angle": a}
        for z, a in zip(places, angles, strict=True)
    ]


def move_along_circle(angles: list[float], radius: float = 100.0) -> list[dict[str, float]]:
    return [{"x": radius * math.cos(a), "y": radius * math.sin(a), "angle": 12.0} for a in angles]


def move_along_line(steps: list[float]) -> list[dict[str, float]]:
    return [{"x": 3.0 * s, "y": 2.0 * s, "angle": -7.0} for s in steps]


def state(positions: list[dict[str, Any]], **fields: Any) -> MotionProblem:
    return MotionProblem.model_validate({"kind": "motion", "positions": positions, **fields})


def guide_without_designs(problem: MotionProblem) -> MotionResult:
    """The guide of an answer that found no linkage."""
    search = CandidateLog[Any](problem).build_search("none")
    return add_plain_guide(problem, MotionResult(designs=[], search=search, summary="No design."))


def carry(guide: Any, k: int) -> tuple[complex, float]:
    """P and the angle of the body at position k, as a shop would build it: written with plain trigonometry."""
    x, y = guide.point
    if guide.type == "slide":
        s, a = guide.travels[k], math.radians(guide.direction)
        return complex(x + s * math.cos(a), y + s * math.sin(a)), guide.body_angle
    b = math.radians(guide.rotations[k])
    if guide.type == "hinge":
        u, v = x - guide.pivot[0], y - guide.pivot[1]
        turned = complex(u * math.cos(b) - v * math.sin(b), u * math.sin(b) + v * math.cos(b))
        return complex(*guide.pivot) + turned, guide.body_angle + guide.rotations[k]
    # The crank ends at P; its fixed pivot stays.
    fixed = complex(x, y) + complex(*guide.pivot_offset)
    u, v = -guide.pivot_offset[0], -guide.pivot_offset[1]
    assert math.hypot(u, v) == pytest.approx(guide.link_length, rel=1e-12)
    return fixed + complex(u * math.cos(b) - v * math.sin(b), u * math.sin(b) + v * math.cos(b)), guide.body_angle


def confirm(problem: MotionProblem, result: MotionResult) -> None:
    guide = result.guide
    assert guide is not None
    far, off = 0.0, 0.0
    for k, position in enumerate(problem.positions):
        place, angle = carry(guide, k)
        far = max(far, abs(place - position.point))
        off = max(off, abs(math.remainder(angle - position.angle, 360.0)))
    assert guide.max_distance == pytest.approx(far, abs=1e-9)
    assert guide.max_angle_error == pytest.approx(off, abs=1e-9)


class TestHinge:
    @pytest.mark.parametrize(("angles", "digits"), [([0, 45], 3), ([0, 30, 75], 12)])
    def test_rotation_about_one_point(self, angles: list[float], digits: int) -> None:
        problem = state(turn_about(PIVOT, 60.0 + 20.0j, angles, digits))
        result = solve(problem)
        assert isinstance(result, MotionResult)
        confirm(problem, result)
        assert result.guide is not None
        assert result.guide.type == "hinge"
        assert abs(complex(*result.guide.pivot) - PIVOT) < 10.0 ** (1 - digits)
        assert result.summary.startswith("A plain hinge does this: a pin joint at (")
        assert result.guide.max_distance < 2e-4 * problem.task_size

    def test_many_fitted_positions(self) -> None:
        problem = state(turn_about(PIVOT, 60.0 + 20.0j, [0, 10, 20, 40, 55, 70, 75], 2))
        result = guide_without_designs(problem)
        confirm(problem, result)
        assert abs(complex(*result.guide.pivot) - PIVOT) < 0.01

    def test_tolerances_are_used_and_kept(self) -> None:
        listed = turn_about(PIVOT, 60.0 + 20.0j, [0, 30, 75])
        listed[1]["x"] += 1.5
        assert guide_without_designs(state(listed)).guide is None
        problem = state([{**place, "tolerance": 1.0} for place in listed])
        result = guide_without_designs(problem)
        confirm(problem, result)
        for k, position in enumerate(problem.positions):
            off = carry(result.guide, k)[0] - position.point
            assert max(abs(off.real), abs(off.imag)) <= 1.0
        assert "It misses the positions by at most" in result.summary

    def test_exact_first_angle_is_kept(self) -> None:
        result = guide_without_designs(state(turn_about(PIVOT, 60.0 + 20.0j, [15, 30, 75], 3)))
        assert result.guide is not None
        assert result.guide.body_angle == pytest.approx(15.0, abs=1e-12)


class TestSlide:
    @pytest.mark.parametrize("steps", [[0, 10], [0, 10, 25], [0, 5, 10, 20, 30, 40, 50]])
    def test_translation_along_a_line(self, steps: list[float]) -> None:
        problem = state(move_along_line(steps))
        result = guide_without_designs(problem)
        confirm(problem, result)
        assert result.guide is not None
        assert result.guide.type == "slide"
        assert result.guide.travels == pytest.approx([s * math.sqrt(13.0) for s in steps])
        assert "at 33.6901° through (0, 0) mm" in result.summary


class TestParallelogram:
    def test_translation_along_a_circle(self) -> None:
        problem = state(move_along_circle([0.3, 0.9, 1.6]))
        result = solve(problem)
        assert isinstance(result, MotionResult)
        confirm(problem, result)
        assert result.guide is not None
        assert result.guide.type == "parallelogram"
        assert result.guide.link_length == pytest.approx(100.0)
        first = result.designs[0].mechanism
        assert first.type == "fourbar"
        assert first.is_parallelogram
        assert first.links.input == pytest.approx(100.0)

    def test_without_a_found_design_one_is_built_and_verified(self) -> None:
        listed = [{**place, "tolerance": 0.5} for place in move_along_circle([0.3, 0.9, 1.6])]
        result = guide_without_designs(state(listed))
        assert [design.verification.passed for design in result.designs] == [True]
        assert result.designs[0].metrics.min_transmission_angle == pytest.approx(90.0 - math.degrees(0.65), abs=0.5)
        assert result.search.accepted == 1

    def test_no_guide_where_no_parallelogram_fits(self) -> None:
        """The body would lie in an obstacle between two positions."""
        obstacle = {"circle": {"center": [100.0 * math.cos(0.6), 100.0 * math.sin(0.6)], "radius": 5.0}}
        listed = [{**place, "tolerance": 0.5} for place in move_along_circle([0.3, 0.9, 1.6])]
        assert guide_without_designs(state(listed, space={"obstacles": [obstacle]})).guide is None


class TestNoGuide:
    def test_general_positions_need_a_linkage(self) -> None:
        rng = np.random.default_rng(5)
        for count in (3, 4, 5, 8):
            listed = [{"x": x, "y": y, "angle": 90.0 * a} for x, y, a in rng.uniform(0.0, 1.0, (count, 3))]
            assert guide_without_designs(state(listed)).guide is None

    @pytest.mark.parametrize(
        "fields",
        [
            {"input_side": {"fixed_pivot": [0.0, None]}},
            {"mechanisms": ["fourbar"]},
            {"driver_dyad": True},
            {"constraints": {"fixed_pivot_region": {"x": [50.0, 60.0], "y": [0.0, 9.0]}}},
            {"constraints": {"grashof": "crank_rocker"}},
            {"space": {"fixed_pivots": {"input": {"circle": {"center": [50.0, 5.0], "radius": 1.0}}}}},
            # P passes the middle of the arc between the first two positions.
            {"space": {"obstacles": [{"circle": {"center": [62.779, 39.848], "radius": 1.0}}]}},
        ],
    )
    def test_of_a_hinge(self, fields: dict[str, Any]) -> None:
        listed = turn_about(PIVOT, 60.0 + 20.0j, [0, 30, 75])
        assert guide_without_designs(state(listed)).guide is not None
        assert guide_without_designs(state(listed, **fields)).guide is None
