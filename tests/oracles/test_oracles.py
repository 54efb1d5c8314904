"""The second opinions themselves: on functions and linkages whose answers are known, and on planted defects."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from tests.oracles.continuation import Linkages, drive, follow
from tests.oracles.differences import derivative
from tests.oracles.positions import all_pins, meet

GALLOWAY = Linkages(*(np.array([x]) for x in (0j, 1 + 0j, 1.0, 1.0, 1.0)))
"""All links equal: a chain of change points."""


@pytest.mark.parametrize(("order", "close"), [(1, 1e-12), (2, 1e-11), (3, 1e-8)])
def test_differences_of_an_exponential(order: int, close: float) -> None:
    assert abs(derivative(lambda t: np.exp(2j * t), order, 0.02) - (2j) ** order) < close


def test_pins_of_a_right_triangle() -> None:
    """Sides 3 and 4 over a base of 5 meet 2.4 above and below it, 1.8 from its start."""
    np.testing.assert_allclose(meet(0.0, 5.0, 3.0, 4.0, [1, -1]), [1.8 + 2.4j, 1.8 - 2.4j], atol=1e-14)
    assert sorted(pin.imag for pin in all_pins(0.0, 5.0, 3.0, 4.0)) == pytest.approx([-2.4, 2.4])
    assert np.isnan(meet(0.0, 5.0, 3.0, 1.0, 1))
    assert all_pins(0.0, 5.0, 3.0, 1.0) == []
    assert abs(meet(0.0, 5.0, 3.0, 2.0, 1) - 3.0) < 1e-6


def test_length_of_a_known_circuit() -> None:
    """A long coupler and output that stay nearly upright: A goes once round its circle, B hardly moves."""
    linkages = Linkages(*(np.array([x]) for x in (0j, 1 + 0j, 0.001, 50.0, 50.0)))
    pin_a = np.array([[0.001, -0.001]], complex)
    pin_b = meet(pin_a, 1.0, 50.0, 50.0, 1)
    circuit = follow(linkages, pin_a, pin_b)
    assert circuit.toggles[0] == 0
    assert circuit.in_order[0]
    assert np.pi * 0.002 < circuit.length[0] * 1.01
    assert abs(circuit.trace_turn[0, ~np.isnan(circuit.trace_turn[0])][-1]) > 2.0 * np.pi - 1e-6


def test_change_point_stops_the_motion() -> None:
    pin_a = np.exp(1j * np.array([[1.0, -1.0]]))
    circuit = follow(GALLOWAY, pin_a, meet(pin_a, 1.0, 1.0, 1.0, 1))
    assert np.isnan(circuit.length[0])
    assert not circuit.in_order[0]


# -- finished mechanisms -----------------------------------------------------------------------------------------------


def mechanism(o2: complex, o4: complex, a: float, b: float, c: float, arm: complex, theta: float, side: int) -> Any:
    return {
        "type": "fourbar",
        "fixed_pivots": {"input": (o2.real, o2.imag), "output": (o4.real, o4.imag)},
        "links": {"ground": abs(o4 - o2), "input": a, "coupler": b, "output": c},
        "coupler_point": {"distance": abs(arm), "angle": float(np.degrees(np.angle(arm)))},
        "assembly": "open" if side > 0 else "crossed",
        "reference_input_angle": float(np.degrees(theta)),
    }


def carried(o2: complex, o4: complex, a: float, b: float, c: float, arm: complex, theta: Any, side: Any) -> list[Any]:
    """Positions of a body that the linkage carries, the body's line turned 0.7 rad from the coupler's."""
    pin_a = o2 + a * np.exp(1j * np.asarray(theta))
    along = (meet(pin_a, o4, b, c, side) - pin_a) / b
    point, angle = pin_a + arm * along, np.degrees(np.angle(along) + 0.7)
    return [{"x": p.real, "y": p.imag, "angle": t} for p, t in zip(point, angle, strict=True)]


TRIPLE_ROCKER = (1 + 2j, 1 + 2j + 4 * np.exp(0.3j), 6.0, 10.0, 7.0, 2 + 3j)
CRANK_ROCKER = (1 + 2j, 1 + 2j + 6 * np.exp(0.3j), 2.0, 7.0, 9.0, 2 + 3j)
DOUBLE_ROCKER = (1 + 2j, 1 + 2j + 4 * np.exp(0.3j), 5.0, 2.0, 5.0, 1 + 1j)


@pytest.mark.parametrize(
    ("linkage", "delta", "side", "circuit", "branch", "order"),
    [
        (TRIPLE_ROCKER, [1.3, 1.5, 1.8], [1, 1, 1], True, True, True),
        (TRIPLE_ROCKER, [1.8, 1.5, 1.3], [-1, -1, -1], True, True, True),
        (TRIPLE_ROCKER, [1.3, 1.8, 1.5], [1, 1, 1], True, True, False),
        (TRIPLE_ROCKER, [1.5, 1.8, 1.5], [1, 1, -1], True, False, True),
        (CRANK_ROCKER, [0.0, 2.0, 4.0, 6.0], [1, 1, 1, 1], True, True, True),
        (CRANK_ROCKER, [6.0, 4.0, 2.0, 0.0], [-1, -1, -1, -1], True, True, True),
        (CRANK_ROCKER, [0.0, 4.0, 2.0, 6.0], [1, 1, 1, 1], True, True, False),
        (CRANK_ROCKER, [0.0, 2.0, 4.0], [1, 1, -1], False, False, False),
        (DOUBLE_ROCKER, [1.3, 1.4], [1, 1], True, True, True),
        (DOUBLE_ROCKER, [1.3, 1.4], [1, -1], True, False, True),
        (DOUBLE_ROCKER, [1.3, -1.4], [1, 1], False, False, False),
    ],
)
def test_drive_finds_planted_defects(
    linkage: Any, delta: list[float], side: list[int], circuit: bool, branch: bool, order: bool
) -> None:
    theta = 0.3 + np.array(delta)
    positions = carried(*linkage, theta, np.array(side))
    found = drive([mechanism(*linkage, theta[0], side[0])] * 2, positions)[1]
    assert found.residual < 1e-12
    assert (found.same_circuit, found.same_branch, found.in_order) == (circuit, branch, order)
    assert np.isnan(found.least_transmission) == (not circuit)


@pytest.mark.parametrize(
    "change",
    [
        lambda m: m["links"].update(input=6.01),
        lambda m: m["links"].update(ground=4.01),
        lambda m: m["links"].update(coupler=10.01),
        lambda m: m["links"].update(output=7.01),
        lambda m: m["coupler_point"].update(angle=50.0),
        lambda m: m["coupler_point"].update(distance=3.5),
        lambda m: m.update(assembly="crossed"),
        lambda m: m.update(reference_input_angle=92.0),
        lambda m: m["fixed_pivots"].update(output=(4.0, 3.0)),
    ],
)
def test_drive_sees_every_wrong_dimension(change: Any) -> None:
    theta = 0.3 + np.array([1.3, 1.5, 1.8])
    positions = carried(*TRIPLE_ROCKER, theta, 1)
    wrong = copy.deepcopy(mechanism(*TRIPLE_ROCKER, theta[0], 1))
    change(wrong)
    assert drive([wrong], positions)[0].residual > 1e-4


def test_drive_confirms_a_printed_linkage() -> None:
    """Norton, Example 5-2: crossed, all positions on one circuit; the dimensions carry three decimals."""
    printed = {
        "fixed_pivots": {"input": (-1.234, -7.772), "output": (2.737, 0.338)},
        "links": {"ground": 9.03, "input": 6.832, "coupler": 1.399, "output": 3.2},
        "coupler_point": {"distance": 1.508, "angle": 61.57},
        "assembly": "crossed",
        "reference_input_angle": 89.54,
    }
    steps = [0j, 2.798 * np.exp(-1j * np.radians(31.19)), 3.919 * np.exp(-1j * np.radians(16.34))]
    positions = [{"x": p.real, "y": p.imag, "angle": t} for p, t in zip(steps, (0.0, -45.0, 9.3), strict=True)]
    found = drive([printed], positions)[0]
    assert found.residual < 1e-3
    assert found.same_circuit


def test_drive_tells_a_defect_that_no_sample_shows() -> None:
    """Both positions have the same input angle and stand on the two branches of one circuit."""
    theta = np.array([1.8, 1.8])
    positions = carried(*TRIPLE_ROCKER, theta, np.array([1, -1]))
    found = drive([mechanism(*TRIPLE_ROCKER, 1.8, 1)], positions)[0]
    assert found.residual < 1e-12
    assert found.same_circuit
    assert not found.same_branch
