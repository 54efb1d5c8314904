"""How far a traced curve goes astray, against dense sampling; and extremes where there is no position everywhere."""

import math

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from kinematics.linkage.refined_extremes import find_minimum_near
from synthesis.kinds.path.verification.excursion import BULGE_RATIO, measure_excursion, sample_curve
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.registry import parse_problem
from tests.support.synthesis.curve_verification import distance_from

CORNERS = np.array([0.0, 4.0, 4.0 + 3.0j])


@pytest.mark.parametrize("gap", [0.02, 2e-3, 2e-4, 2e-6])
def test_a_linkage_near_a_change_point_does_not_whip_out_unseen(gap):
    """Near the change point P runs over a third of its curve within an angle of the size of the gap."""
    fourbar = Fourbar(0j, 4.0 + 0.0j, 4.0 + gap, 5.0, 5.0 + 0.5 * gap, 1.0 + 2.0j)
    target = positions(fourbar, np.linspace(0.3, math.tau - 0.3, 30), OPEN_ASSEMBLY).p
    stands = positions(fourbar, 1.0, OPEN_ASSEMBLY)
    joints = FourbarConfiguration(0j, complex(stands.a), complex(stands.b), 4.0 + 0.0j, complex(stands.p))
    points = [{"x": float(z.real), "y": float(z.imag)} for z in target]
    statement = {"kind": "path", "method": "curve_match", "closed": True, "points": points}
    design = verify_path(parse_problem(statement), build_fourbar(joints))
    small = np.geomspace(1e-9, 0.3, 2000)
    whip = positions(fourbar, np.concatenate([-small, small]), OPEN_ASSEMBLY).p
    farthest = max(distance_from(target, z) for z in whip)
    longest = np.abs(np.diff(target, append=target[0])).max()
    assert farthest > 2.0
    assert design.metrics.curve_distance == pytest.approx(farthest, abs=1e-3)
    assert design.metrics.curve_distance >= farthest - 1e-9
    assert farthest - BULGE_RATIO * longest - 1e-6 < design.metrics.excursion < farthest


def test_inputs_are_put_between_places_that_are_far_apart_and_not_across_a_jump_without_end():
    def swift(at):
        return np.tanh(1e6 * (at - 0.3)) + 0j

    inputs, places = sample_curve(swift, 0.0, 1.0)
    assert np.all(np.diff(inputs) > 0.0)
    assert np.abs(np.diff(places)).max() <= 0.01 * 2.0
    assert len(inputs) < 3000
    inputs, places = sample_curve(lambda at: np.sign(at - 0.3) + 0j, 0.0, 1.0)
    assert len(inputs) < 1600


@pytest.mark.parametrize(
    "has_place",
    [
        pytest.param(lambda at: np.zeros(len(at), bool), id="nowhere"),
        pytest.param(lambda at: at == 1.0, id="at the end"),
        pytest.param(lambda at: np.isin(at, np.linspace(0.0, 1.0, 1441)), id="on the grid alone"),
        pytest.param(lambda at: at > 0.5, id="on one side"),
    ],
)
def test_what_has_no_place_everywhere_is_measured_where_it_has_one(has_place):
    def place(at):
        return np.where(has_place(at), 2.0 + 5.0j * at, np.nan)

    gone = measure_excursion(place, (0.0, 1.0), CORNERS, True, 0.25)
    if has_place(np.array([1.0]))[0]:
        assert gone.curve_distance == pytest.approx(distance_from(CORNERS, 2.0 + 5.0j), abs=1e-12)
        assert gone.curve_distance - 0.25 - BULGE_RATIO * 5.0 <= gone.excursion <= gone.curve_distance - 0.25
    else:
        assert gone == (0.25, 0.0)


def test_the_least_is_found_between_and_at_the_ends_of_a_grid():
    grid = np.linspace(0.0, 1.0, 12)
    for at in (0.0, 0.123456, 1.0):
        for inputs in (grid, grid[::-1], grid**2):
            place, least = find_minimum_near(lambda x, at=at: np.abs(x - at), inputs, np.abs(inputs - at))
            assert least < 1e-6
            assert place == pytest.approx(at, abs=1e-6)


def test_the_least_is_looked_for_where_there_is_a_position():
    def of(x):
        return np.where(x < 0.4, np.nan, x)

    grid = np.linspace(0.0, 1.0, 12)
    assert find_minimum_near(of, grid, of(grid)) == pytest.approx((0.4, 0.4), abs=1e-6)
    assert (
        find_minimum_near(lambda x: np.where(x < 0.4, -np.inf, x), grid, np.where(grid < 0.4, -np.inf, grid))[1] >= 0.4
    )
    nowhere = find_minimum_near(lambda x: np.full(len(x), np.nan), grid, np.full(12, np.nan))
    assert np.isnan(nowhere).all()
