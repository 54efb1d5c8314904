"""Paths moved, turned and scaled: every solution moves with its points, whatever the similarity."""

from __future__ import annotations

import cmath

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.dispatch import solve
from synthesis.kinds.path.design import PathResult
from synthesis.registry import parse_problem

ROCKER = Fourbar(0.0, 8.0 + 1.0j, 2.5, 7.0, 6.0, 4.0 + 3.0j)
ANGLES = np.array([10.0, 55.0, 120.0, 200.0, 290.0])
EVERY = {"constraints": {"same_branch": False, "in_order": False}, "max_designs": 50}

SIMILARITIES = st.builds(
    lambda decades, turn, shift: (cmath.rect(10.0**decades, turn), 10.0**decades * shift),
    st.floats(-4.0, 4.0),
    st.floats(-3.1, 3.1),
    st.complex_numbers(max_magnitude=100.0, allow_nan=False),
)
"""Scale and rotation as a factor, and a shift of up to a hundred scaled units."""


def shapes(result: PathResult) -> np.ndarray:
    """Ground, input, coupler and output of every design, in an order of their own."""
    links = [design.mechanism.links for design in result.designs]
    rows = [(one.ground, one.input, one.coupler, one.output) for one in links]
    return np.array(sorted(rows)).reshape(-1, 4)


def pivots(result: PathResult) -> np.ndarray:
    """Both fixed pivots of every design."""
    fixed = [design.mechanism.fixed_pivots for design in result.designs]
    return np.array([[complex(*one.input), complex(*one.output)] for one in fixed]).reshape(-1, 2)


def compare(one: PathResult, other: PathResult, factor: complex, shift: complex) -> None:
    """As many designs, and each where the similarity puts it."""
    assert len(one.designs) == len(other.designs) > 0
    assert one.search.complete == other.search.complete
    scale = abs(factor)
    size = shapes(one).max()
    np.testing.assert_allclose(shapes(other) / scale, shapes(one), atol=1e-5 * size)
    for pair in factor * pivots(one) + shift:
        near = np.abs(pivots(other) - pair).max(axis=1).min()
        assert near < 1e-5 * scale * (size + np.abs(pivots(one)).max())


def points_at(angles: np.ndarray) -> np.ndarray:
    return positions(ROCKER, np.radians(angles), OPEN_ASSEMBLY).p


def timed(points: np.ndarray) -> PathResult:
    rows = [{"x": z.real, "y": z.imag, "crank_angle": float(a)} for z, a in zip(points, ANGLES, strict=True)]
    return answer({"kind": "path", "timing": "prescribed", "points": rows, **EVERY})


def on_pivots(points: np.ndarray, o2: complex, o4: complex) -> PathResult:
    fixed = {"input": [o2.real, o2.imag], "output": [o4.real, o4.imag]}
    rows = [{"x": z.real, "y": z.imag} for z in points]
    return answer({"kind": "path", "points": rows, "fixed_pivots": fixed, **EVERY})


def answer(statement: dict[str, object]) -> PathResult:
    result = solve(parse_problem(statement), lambda _fraction, _message: None)
    assert isinstance(result, PathResult)
    return result


@pytest.mark.slow
@given(SIMILARITIES)
@settings(max_examples=8, deadline=None)
def test_timed_solutions_move_with_the_points(moved: tuple[complex, complex]) -> None:
    factor, shift = moved
    points = points_at(ANGLES)
    compare(timed(points), timed(factor * points + shift), factor, shift)


@pytest.mark.slow
@given(SIMILARITIES)
@settings(max_examples=8, deadline=None)
def test_solutions_on_given_pivots_move_with_the_points_and_pivots(moved: tuple[complex, complex]) -> None:
    factor, shift = moved
    points = points_at(np.array([0.0, 40.0, 95.0, 160.0, 250.0]))
    o2, o4 = complex(ROCKER.input_pivot), complex(ROCKER.output_pivot)
    one = on_pivots(points, o2, o4)
    other = on_pivots(factor * points + shift, factor * o2 + shift, factor * o4 + shift)
    compare(one, other, factor, shift)
