"""Programs and segments: what they state, what they refuse, and peaks against fine grids."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kinematics.cam.motion.extremes import find_extremes, find_roots, find_stationary_points
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.program import Program
from kinematics.cam.motion.segments import (
    Condition,
    build_dwell,
    build_knot_segment,
    build_law_segment,
    build_polynomial_segment,
)
from kinematics.errors import DimensionError
from tests.kinematics.cam.stating import coefficient_segment

TURN = 2.0 * math.pi
SMOOTH = ["cycloidal", "modified_trapezoid", "modified_sine", "polynomial_345", "polynomial_4567"]


@st.composite
def programs(draw: st.DrawFn) -> Program:
    """Rises, falls and dwells by any laws of rest to rest, one after the other around the cam."""
    count = draw(st.integers(2, 6))
    shares = np.array([draw(st.floats(0.2, 1.0)) for _ in range(count)])
    angles = TURN * shares / shares.sum()
    heights = [0.0, *(draw(st.floats(-2.0, 3.0)) for _ in range(count - 1)), 0.0]
    laws = [draw(st.sampled_from([*SMOOTH, "simple_harmonic", "eighth_power", "trapezoidal"])) for _ in range(count)]
    return Program(
        [
            build_dwell(angle, start) if start == end else build_law_segment(LAWS[law], angle, start, end)
            for angle, law, start, end in zip(angles, laws, heights, heights[1:], strict=False)
        ]
    )


@settings(max_examples=25)
@given(programs())
def test_peaks_bound_a_fine_grid_and_are_attained(program: Program) -> None:
    angles = np.linspace(0.0, TURN, 4001)
    for order, peak in enumerate(program.peaks):
        found = np.array([program.motion(angles)[order], program.motion(angles, before=True)[order]])
        slack = 1e-9 * (peak.largest + 1e-9)
        assert found.min() >= peak.least - slack
        assert found.max() <= peak.greatest + slack
        for at, value in ((peak.at_least, peak.least), (peak.at_greatest, peak.greatest)):
            sides = program.motion(at)[order], program.motion(at, before=True)[order]
            assert min(abs(side - value) for side in sides) <= slack


@settings(max_examples=25)
@given(programs(), st.floats(-20.0, 20.0))
def test_motion_is_periodic(program: Program, angle: float) -> None:
    here, there = program.motion(angle % TURN), program.motion(angle)
    assert np.array(here) == pytest.approx(np.array(there), abs=1e-6)


@settings(max_examples=25)
@given(programs())
def test_a_joint_says_what_the_motion_does(program: Program) -> None:
    for joint in program.continuity:
        assert joint.before == pytest.approx(program.motion(joint.angle, before=True), rel=1e-6, abs=1e-6)
        assert joint.after == pytest.approx(program.motion(joint.angle), rel=1e-6, abs=1e-6)
        assert joint.continuous[:2] == (True, True)
    assert program.smoothness >= 2


def double_dwell(law: str) -> Program:
    quarter = TURN / 4.0
    rise, fall = build_law_segment(LAWS[law], quarter, 0.0, 1.0), build_law_segment(LAWS[law], quarter, 1.0, 0.0)
    return Program([build_dwell(quarter, 0.0), rise, build_dwell(quarter, 1.0), fall])


def test_smoothness_of_laws_between_dwells() -> None:
    expected = {
        "constant_velocity": 1,
        "constant_acceleration": 2,
        "simple_harmonic": 2,
        "cycloidal": 3,
        "modified_sine": 3,
        "polynomial_345": 3,
        "polynomial_4567": 4,
    }
    assert {law: double_dwell(law).smoothness for law in expected} == expected


def test_a_jump_within_a_segment_is_listed() -> None:
    joints = double_dwell("constant_acceleration").continuity
    assert [joint.segments for joint in joints] == [(0, 1), (1, 1), (1, 2), (2, 3), (3, 3), (3, 0)]
    assert joints[1].jump[2] == pytest.approx(-8.0 / (TURN / 4.0) ** 2)


def test_dwell_alone_moves_nothing() -> None:
    program = Program([build_dwell(TURN, 2.0)])
    assert program.lift == 0.0
    assert program.smoothness == 4
    assert [peak.largest for peak in program.peaks] == [2.0, 0.0, 0.0, 0.0]


def test_more_than_sixteen_segments() -> None:
    angle = TURN / 40.0
    program = Program([build_law_segment(LAWS["modified_sine"], angle, k % 2, (k + 1) % 2) for k in range(40)])
    assert program.obeys_fundamental_law
    assert program.peaks[1].greatest == pytest.approx(4.0 * math.pi / (math.pi + 4.0) / angle, rel=1e-12)


def test_polynomial_meets_interior_conditions() -> None:
    conditions = [
        Condition(0.0, 0, 0.0),
        Condition(0.0, 1, 0.0),
        Condition(0.0, 2, 0.0),
        Condition(0.9, 0, 4.0),
        Condition(0.9, 1, 3.0),
        Condition(2.0, 0, 0.5),
        Condition(2.0, 1, 0.0),
        Condition(2.0, 2, 0.0),
    ]
    segment = build_polynomial_segment(2.0, conditions)
    for at, order, value in conditions:
        assert segment.pieces.motion(at)[order] == pytest.approx(value, abs=1e-9)


def test_norton_coefficients_are_of_the_share_of_the_angle() -> None:
    segment = coefficient_segment(math.pi, [0, 0, 0, 64, -192, 192, -64])
    assert segment.pieces.motion(0.5 * math.pi).s == pytest.approx(1.0)
    assert segment.extremes(0).at_greatest == pytest.approx(0.5 * math.pi)


@pytest.mark.parametrize("angles", [(math.pi, math.pi - 1e-6), (TURN, 0.1), (1.0,)])
def test_angles_that_are_no_turn_are_refused(angles: tuple[float, ...]) -> None:
    with pytest.raises(DimensionError, match="one turn"):
        Program([build_dwell(angle, 0.0) for angle in angles])


def test_no_segments_are_refused() -> None:
    with pytest.raises(DimensionError, match="one turn"):
        Program([])


@pytest.mark.parametrize("angle", [0.0, -1.0, math.nan, math.inf])
def test_segments_without_an_angle_are_refused(angle: float) -> None:
    with pytest.raises(DimensionError, match="angle of a segment"):
        build_dwell(angle, 0.0)


def test_values_that_are_no_numbers_are_refused() -> None:
    with pytest.raises(DimensionError, match="end"):
        build_law_segment(LAWS["cycloidal"], 1.0, 0.0, math.nan)
    with pytest.raises(DimensionError, match="position"):
        build_dwell(1.0, math.inf)
    with pytest.raises(DimensionError, match="breaks"):
        build_knot_segment([0.0, 1.0], [[math.nan]])
    with pytest.raises(DimensionError, match="first knot"):
        build_knot_segment([0.5, 1.0], [[1.0]])
    with pytest.raises(DimensionError, match="breaks"):
        build_knot_segment([0.0, 1.0, 2.0], [[1.0]])


@pytest.mark.parametrize(
    "conditions",
    [
        [Condition(0.0, 0, 0.0), Condition(0.0, 0, 1.0)],
        [Condition(0.0, 1, 0.0), Condition(1.0, 1, 1.0)],
        [Condition(0.0, 0, 0.0), Condition(2.0, 0, 1.0)],
        [Condition(0.0, 0, 0.0), Condition(1.0, 2, 1.0)],
        [Condition(0.0, 0, math.nan)],
        [],
    ],
)
def test_conditions_without_one_answer_are_refused(conditions: list[Condition]) -> None:
    with pytest.raises(DimensionError, match="condition"):
        build_polynomial_segment(1.0, conditions)


def test_extremes_of_a_jump_are_its_two_sides() -> None:
    found = find_extremes(lambda x: np.where(x < 1.0, x, x - 3.0), [0.0, 1.0, 2.0])
    assert (found.least, found.greatest) == pytest.approx((-2.0, 1.0))
    assert (found.at_least, found.at_greatest) == pytest.approx((1.0, 1.0))


def test_a_hidden_kink_is_found() -> None:
    found = find_extremes(lambda x: -np.abs(x - 0.123456), [0.0, 1.0])
    assert found.greatest == pytest.approx(0.0, abs=1e-7)


def test_roots_of_a_wave() -> None:
    assert find_roots(lambda x: np.sin(25.0 * x), np.array([0.1, 1.7, 3.0])) == pytest.approx(
        np.arange(1, 24) * math.pi / 25.0, abs=1e-12
    )
    assert len(find_roots(lambda x: 0.0 * x, np.array([0.0, 1.0]))) == 0
    assert len(find_roots(lambda x: 2.0 + x, np.array([0.0, 1.0]))) == 0


@pytest.mark.slow
def test_a_function_that_is_rounding_is_not_halved_for_ever() -> None:
    asked = 0

    def rounding(at: np.ndarray) -> np.ndarray:
        nonlocal asked
        asked += at.size
        return (1.0 + 1e-12 * np.sin(7.0 * at)) - 1.0

    _, values = find_stationary_points(rounding, np.array([0.0, 1.0, 3.0]))
    assert asked < 500_000
    assert values.max() == pytest.approx(1e-12, rel=1e-3)
