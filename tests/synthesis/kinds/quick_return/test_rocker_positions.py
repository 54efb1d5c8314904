"""Crank-rockers for two positions of a rocker or of a body on it (Norton, Examples 3-1 and 3-2)."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest

from kinematics.linkage.fourbar import Fourbar, positions
from synthesis.kinds.quick_return.design import QuickReturnDesign
from synthesis.model.linkage.answer import FourbarMechanism
from synthesis.registry import parse_problem
from tests.support.synthesis.quick_return import answer, crank_rocker

BODIES = [
    ({"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 60.0, "y": 20.0, "angle": 50.0}),
    ({"x": 10.0, "y": -5.0, "angle": 170.0}, {"x": 4.0, "y": 3.0, "angle": -150.0}),
    ({"x": 1e3, "y": 1e3, "angle": 20.0}, {"x": 1001.0, "y": 999.0, "angle": -80.0}),
    ({"x": 2.0, "y": 3.0, "angle": 0.0}, {"x": 2.0, "y": 3.0, "angle": 60.0}),
]


def test_a_swing_with_equal_strokes_has_its_crank_pivot_on_the_chord() -> None:
    """Norton, Example 3-1: 45°; the crank is half the chord, and crank, coupler and chord fall into one line."""
    for design in crank_rocker(time_ratio=1.0, swing=45.0, rocker_length=5.0).designs:
        made = design.mechanism
        assert isinstance(made, FourbarMechanism)
        assert made.links.input == pytest.approx(5.0 * math.sin(math.radians(22.5)), rel=1e-9)
        joints = {name: complex(*place) for name, place in made.skeleton.joints.items()}
        arm = joints["B"] - joints["O4"]
        turn = math.radians(design.targets[1].output - design.targets[0].output)
        other = joints["O4"] + arm * cmath.exp(1j * turn)
        chord = other - joints["B"]
        assert ((joints["O2"] - joints["B"]) * chord.conjugate()).imag / abs(chord) ** 2 == pytest.approx(0.0, abs=1e-9)


def body_at_limits(design: QuickReturnDesign) -> list[tuple[complex, float]]:
    """Point and angle of the body at both limits, the linkage driven in closed form from its dimensions."""
    made = design.mechanism
    assert isinstance(made, FourbarMechanism)
    o2, o4 = complex(*made.fixed_pivots.input), complex(*made.fixed_pivots.output)
    linkage = Fourbar(o2, o4, made.links.input, made.links.coupler, made.links.output)
    side = 1 if made.assembly == "open" else -1
    angles = np.radians([made.reference_input_angle, *(target.input_angle for target in design.targets)])
    turned = positions(linkage, angles, side).output_angle
    c = complex(*made.skeleton.joints["C"])
    assert made.reference_body_angle is not None
    found = []
    for angle in turned[1:]:
        turn = float(angle - turned[0])
        found.append((o4 + (c - o4) * cmath.exp(1j * turn), made.reference_body_angle + math.degrees(turn)))
    return found


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("ratio", [1.0, 1.2])
@pytest.mark.parametrize("ground", [0.0, 130.0])
def test_a_body_is_carried_about_its_rotopole(body: Any, ratio: float, ground: float) -> None:
    """Norton, Example 3-2, with any time ratio."""
    result = answer(time_ratio=ratio, positions=body, ground_angle=ground)
    assert result.designs
    for design in result.designs:
        assert {check.name for check in design.verification.checks} >= {"swing", "reaches_targets"}
        found = body_at_limits(design)
        for stated in body:
            size = max(abs(complex(stated["x"], stated["y"])), 1.0)
            misses = [
                abs(point - complex(stated["x"], stated["y"])) / size
                + abs(math.remainder(angle - stated["angle"], 360.0))
                for point, angle in found
            ]
            assert min(misses) < 1e-8


def test_the_rotopole_is_the_point_that_both_positions_share() -> None:
    problem = parse_problem({"kind": "quick_return", "time_ratio": 1.0, "positions": BODIES[0]})
    pole = problem.pole
    first, second = (complex(p["x"], p["y"]) for p in BODIES[0])
    assert abs(pole - first) == pytest.approx(abs(pole - second))
    assert cmath.phase((second - pole) / (first - pole)) == pytest.approx(math.radians(50.0))


def test_a_rotopole_may_be_stated() -> None:
    problem = parse_problem({"kind": "quick_return", "time_ratio": 1.0, "positions": BODIES[0]})
    pole = [problem.pole.real, problem.pole.imag]
    assert answer(time_ratio=1.0, positions=BODIES[0], rotopole=pole).designs
    (design, *_) = crank_rocker(time_ratio=1.3, swing=40.0, rotopole=[7.0, 8.0]).designs
    assert isinstance(design.mechanism, FourbarMechanism)
    assert design.mechanism.fixed_pivots.output == (7.0, 8.0)


def test_half_a_turn_of_a_body_is_out_of_reach() -> None:
    body = ({"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 0.0, "angle": 180.0})
    none = answer(time_ratio=1.0, positions=body)
    assert none.designs == []
    assert none.search.complete
    assert "less than 180°" in none.summary


@pytest.mark.parametrize(
    ("stated", "paths"),
    [
        ({"positions": (BODIES[0][0], {"x": 5.0, "y": 5.0, "angle": 360.0})}, ["/positions/1/angle"]),
        ({"positions": (BODIES[0][0], BODIES[0][0])}, ["/positions/1/angle"]),
        ({"positions": BODIES[0], "swing": 50.0}, ["/swing"]),
        ({"positions": BODIES[0], "stroke": 50.0}, ["/stroke"]),
        ({"positions": BODIES[0], "crank_pivot": [0.0, 0.0]}, ["/crank_pivot"]),
        ({"positions": BODIES[0], "mechanism": "whitworth"}, ["/mechanism"]),
        ({"positions": BODIES[0], "rotopole": [0.0, 0.0]}, ["/rotopole"]),
        ({"swing": 40.0, "mechanism": "fourbar", "rotopole": [0.0, 0.0], "crank_pivot": [1.0, 1.0]}, ["/crank_pivot"]),
        ({"stroke": 40.0, "mechanism": "whitworth", "rotopole": [0.0, 0.0]}, ["/rotopole"]),
        ({"swing": 40.0, "rotopole": [0.0, 0.0]}, ["/rotopole"]),
    ],
)
def test_contradictions_name_their_field(stated: dict[str, Any], paths: list[str]) -> None:
    problem = parse_problem({"kind": "quick_return", "time_ratio": 1.0, **stated})
    assert [found.path for found in problem.find_contradictions()] == paths
