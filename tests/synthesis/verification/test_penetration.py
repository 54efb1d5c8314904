"""Penetration depths against shapes whose depth is known, and the check of a link deep inside an obstacle."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinematics.linkage import Fourbar, catalogue
from kinematics.linkage.clearance import Part
from synthesis.model.linkage.workspace import Space
from synthesis.verification.penetration import measure_depth, measure_penetration, split_convex
from synthesis.verification.workspace import check_space

CRANK_ROCKER = catalogue.make_fourbar(Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0), input_angle=0.5)
UNUSED = SimpleNamespace(used_range=None, used_stroke=None)
SQUARE = [0, 10, 10 + 10j, 10j]
L_SHAPE = [0, 10, 10 + 2j, 2 + 2j, 2 + 10j, 10j]


@pytest.mark.parametrize(
    ("first", "second", "radius", "depth"),
    [
        ([5 + 5j], SQUARE, 0.0, 5.0),
        ([-5 + 4j, 15 + 4j], SQUARE, 0.0, 4.0),  # through the whole square: out by the nearer side
        ([9 + 5j, 15 + 5j], SQUARE, 0.0, 1.0),
        ([9 + 5j, 15 + 5j], SQUARE, 0.5, 1.5),
        ([0, 2], [1 - 1j, 1 + 1j], 0.0, 1.0),  # crossing bars: half of one of them
        ([5 + 1j], L_SHAPE, 0.0, 1.0),
        ([4 + 4j, 8 + 8j], L_SHAPE, 0.0, 0.0),  # in the notch, outside
        ([1 - 5j, 1 + 15j], L_SHAPE, 0.25, 1.25),
        ([20 + 5j], SQUARE, 0.0, 0.0),
    ],
)
def test_the_depth_is_how_far_a_part_must_move_out(first, second, radius, depth):
    pieces = [split_convex(np.array(points, np.complex128)) for points in (first, second)]
    assert measure_depth(*pieces, radius) == pytest.approx(depth, abs=1e-12)
    assert measure_depth(*pieces[::-1], radius) == pytest.approx(depth, abs=1e-12)


def test_the_depth_of_a_motion_is_the_largest():
    """The end A of the crank passes a wide strip, and is deepest where the crank is parallel to its normal."""
    strip = np.array([-50 + 0.5j, 50 + 0.5j, 50 + 40j, -50 + 40j])
    crank = Part("input", np.array([complex(CRANK_ROCKER.joints[name]) for name in ("O2", "A")]), 0.1)
    depth = measure_penetration(CRANK_ROCKER, [crank, Part("ground", strip, 0.0)], [(0, 1)], 0.0, np.pi)
    assert depth == pytest.approx(1.5 + 0.1, abs=1e-6)


def test_deeper_obstacles_are_farther_misses():
    values = []
    for edge in (1.0, 0.5):
        strip = {"polygon": [[-50, edge], [50, edge], [50, 40], [-50, 40]]}
        space = Space.model_validate({"obstacles": [strip], "clearance": 1.0, "link_width": 0.2, "over": "cycle"})
        (check,) = check_space(space, CRANK_ROCKER, UNUSED)
        values.append(check.value)
    assert values[1] == pytest.approx(values[0] - 0.5, abs=1e-3)
