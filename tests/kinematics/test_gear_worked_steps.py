"""Single steps of worked examples, op ``affine``: each by the quantity that the book computes there, not by arithmetic.

A row gives a value with an offset, or with a scale. What they are is told by the other rows of the same example.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from kinematics.gear.gearbox import list_spindle_speeds
from kinematics.gear.helical import HelicalGear
from kinematics.gear.teeth import Gear
from tests.cases import Case, cases, load
from tests.oracles.gear_formulas import helix_angle_for_distance

STUDIED = 24
"""Teeth of the gears where a row states a radius or a pitch alone: the result must not depend on them."""


def root_radius(inputs: dict[str, Any]) -> float:
    """Of a gear with this pitch radius and a dedendum of the offset (1.157 modules in both examples)."""
    radius, dedendum = inputs["value"], -inputs["offset"]
    module = 2.0 * radius / STUDIED
    return Gear(STUDIED, module, dedendum=dedendum / module).root_radius


def addendum(inputs: dict[str, Any]) -> float:
    """Of standard teeth of this circular pitch; the scale is 1/π."""
    assert inputs["scale"] == pytest.approx(1.0 / math.pi)
    gear = Gear(STUDIED, inputs["value"] / math.pi)
    assert gear.circular_pitch == pytest.approx(inputs["value"])
    return gear.tip_radius - gear.pitch_radius


def dedendum(inputs: dict[str, Any]) -> float:
    """Of teeth of this circular pitch and a dedendum coefficient of scale × π, 1.157."""
    gear = Gear(STUDIED, inputs["value"] / math.pi, dedendum=inputs["scale"] * math.pi)
    assert gear.dedendum == pytest.approx(1.157)
    return gear.pitch_radius - gear.root_radius


def circle_of_twelve_teeth(inputs: dict[str, Any]) -> float:
    """Diameter of the generating circle: the pitch circle of scale × π = 12 teeth of this circular pitch."""
    teeth = round(inputs["scale"] * math.pi)
    assert teeth == 12
    return 2.0 * Gear(teeth, inputs["value"] / math.pi).pitch_radius


def cosine_by_tooth(inputs: dict[str, Any]) -> float:
    """cos ψ = (1 + R)/(2 C) × teeth of the pinion × normal module: the factor, with value 1 + R and scale 1/(2 C)."""
    ratio = Fraction(inputs["value"] - 1.0).limit_denominator(1000)
    distance = 0.5 / inputs["scale"]
    pinion, gear = ratio.denominator, ratio.numerator
    # A module so small that such a pair fits; the factor must not depend on it.
    module = distance / (pinion + gear)
    angle = helix_angle_for_distance(pinion, gear, module, distance)
    one, other = (HelicalGear(z, module, angle) for z in (pinion, gear))
    assert one.pitch_radius + other.pitch_radius == pytest.approx(distance)
    return math.cos(angle) / (pinion * module)


def step_of_a_pair(inputs: dict[str, Any]) -> float:
    """Driven over driving speed of a pair whose driver has ``value`` teeth, and its mate 1/scale."""
    [only] = list_spindle_speeds(1, [[(inputs["value"], round(1.0 / inputs["scale"]))]])
    return float(only.speed)


STEPS: dict[str, Callable[[dict[str, Any]], float]] = {
    "rao-sp6.2-root": root_radius,
    "rao-sp6.3-rootradius": root_radius,
    "rao-sp6.4-a": addendum,
    "rao-sp6.4-b": dedendum,
    "rao-sp6.4-d": circle_of_twelve_teeth,
    "rao-sp7.2-coef": cosine_by_tooth,
    "rao-sp7.3-coef1": cosine_by_tooth,
    "rao-sp7.3-coef2": cosine_by_tooth,
    "rao-s8.5-y": step_of_a_pair,
}


@pytest.mark.parametrize("case", cases("affine", "gear"))
def test_step_of_a_worked_example(case: Case) -> None:
    assert case.inputs is not None
    case.check(v=STEPS[case.id](case.inputs))


def test_one_row_cannot_be_evaluated() -> None:
    """Its inputs are tooth numbers and speeds; which gear meshes with which stands in a figure that is lost."""
    assert [case.id for case in load("gear") if case.inputs is None] == ["norton-p9-26c"]
