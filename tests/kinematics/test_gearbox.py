"""Speeds of gearboxes: printed values, preferred numbers, and the speed equations as another route."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kinematics.errors import DimensionError
from kinematics.gear.gearbox import (
    R40,
    SERIES_STRIDES,
    compute_layshaft_ratios,
    compute_progression,
    list_preferred_numbers,
    list_spindle_speeds,
    series_ratio,
)
from kinematics.gear.planetary import GROUND, Mesh, Train, compute_speed_ratio
from tests.cases import Case, cases


@pytest.mark.parametrize("case", cases("gearbox_speeds", "gear"))
def test_speeds_as_printed(case: Case) -> None:
    stages = [[(driver, driven) for driver, driven in stage] for stage in case.inputs["stages"]]
    found = list_spindle_speeds(Fraction(str(case.inputs["input"])), stages)
    case.check(**{f"n{k}": float(speed.speed) for k, speed in enumerate(found, start=1)})


@pytest.mark.parametrize("case", cases("speeds_progression", "gear"))
def test_progressions_as_printed(case: Case) -> None:
    ratio, speeds = compute_progression(case.inputs["lo"], case.inputs["hi"], case.inputs["n"])
    named = {f"n{k}": speed for k, speed in enumerate(speeds, start=1)}
    case.check(phi=ratio, n2x=named["n2"], **named)


def test_preferred_numbers() -> None:
    """ISO 3: R10 and R5 in full, derived series, other decades; every number is within 1.3 % of the exact one."""
    assert list_preferred_numbers("R10", 100, 11) == [100, 125, 160, 200, 250, 315, 400, 500, 630, 800, 1000]
    assert list_preferred_numbers("R5", 1.0, 6) == [1.0, 1.6, 2.5, 4.0, 6.3, 10.0]
    assert list_preferred_numbers("R20", 31.5, 5, step=3) == [31.5, 45.0, 63.0, 90.0, 125.0]
    assert list_preferred_numbers("R20", 0.0315, 2) == [0.0315, 0.0355]
    assert list_preferred_numbers("R10", 112, 3) is None
    assert list_preferred_numbers("R40", 101, 3) is None
    for k, number in enumerate(R40):
        assert number == pytest.approx(100.0 * 10.0 ** (k / 40), rel=0.013)
    assert series_ratio("R20", 3) == pytest.approx(math.sqrt(2.0), rel=2e-3)
    assert set(SERIES_STRIDES) == {"R5", "R10", "R20", "R40"}


teeth = st.integers(12, 90)
pair = st.tuples(teeth, teeth)


@given(st.lists(st.lists(pair, min_size=1, max_size=3), min_size=1, max_size=3), st.fractions(1, 2000))
def test_every_speed_is_the_ratio_of_its_meshes(stages: list[list[tuple[int, int]]], speed: Fraction) -> None:
    found = list_spindle_speeds(speed, stages)
    assert len(found) == math.prod(len(pairs) for pairs in stages)
    assert [row.speed for row in found] == sorted(row.speed for row in found)
    for row in found:
        meshes = [
            Mesh(f"shaft {k}", f"shaft {k + 1}", GROUND, *pairs[at])
            for k, (pairs, at) in enumerate(zip(stages, row.engaged, strict=True))
        ]
        ratio = compute_speed_ratio(Train(tuple(meshes)), "shaft 0", f"shaft {len(stages)}")
        assert ratio is not None
        assert row.speed == abs(speed / ratio)


def test_layshaft_ratios() -> None:
    found = compute_layshaft_ratios((24, 36), [(18, 42), None], (15, 14, 33))
    assert found.forward == [Fraction(7, 2), 1]
    assert found.reverse == Fraction(-33, 10)
    assert compute_layshaft_ratios((20, 40), [(30, 30)]).reverse is None


def test_wrong_calls() -> None:
    with pytest.raises(DimensionError, match="gear pair"):
        list_spindle_speeds(1, [[]])
    with pytest.raises(DimensionError, match="teeth"):
        list_spindle_speeds(1, [[(0, 5)]])
    with pytest.raises(DimensionError, match="count"):
        compute_progression(1.0, 2.0, 1)
    with pytest.raises(DimensionError, match="speeds"):
        compute_progression(2.0, 1.0, 3)
