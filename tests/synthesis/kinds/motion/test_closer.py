"""Extremes between the places of a grid."""

import math

import numpy as np
import pytest

from kinematics.linkage.fourbar.closed_form import Fourbar
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.refined_extremes import GRID_SIZE, find_min_transmission_angles, find_minimum_near
from synthesis.dispatch import solve
from synthesis.registry import parse_problem


def test_the_least_may_lie_beside_a_place_that_is_not_the_lowest():
    grid = np.linspace(0.0, 1.0, 50)

    def two_valleys(at):
        return np.minimum(np.abs(at - grid[18]), 3.0 * np.abs(at - 0.77) - 0.001)

    values = two_valleys(grid)
    assert values.argmin() == 18
    at, least = find_minimum_near(two_valleys, grid, values)
    assert at == pytest.approx(0.77, abs=1e-6)
    assert least == pytest.approx(-0.001, abs=1e-6)


@pytest.mark.parametrize("phase", np.linspace(0.0, 1.0, 7))
def test_even_waves_have_their_deepest(phase):
    def waves(at):
        return np.cos(40.0 * at + phase) + 1e-6 * at

    grid = np.linspace(0.0, 1.0, 60)
    assert find_minimum_near(waves, grid, waves(grid))[1] == pytest.approx(
        waves(np.linspace(0.0, 1.0, 10**6)).min(), abs=1e-9
    )


def test_what_has_no_value_is_passed_over():
    grid = np.linspace(0.0, 1.0, 30)

    def broken(at):
        return np.where(np.abs(at - 0.5) < 0.1, np.nan, (at - 0.71) ** 2)

    assert find_minimum_near(broken, grid, broken(grid))[0] == pytest.approx(0.71, abs=1e-5)
    assert math.isnan(find_minimum_near(lambda at: at * math.nan, grid, grid * math.nan)[1])


@pytest.mark.parametrize("gap", [3e-3, 1e-3, 1e-5])
def test_a_gap_between_the_places_of_a_grid_is_no_least_angle(gap):
    """Crank and ground are together longer than coupler and output by so little that a narrow stretch is missing."""
    crank, coupler, output = 1.0, 2.5, 1.9
    ground = coupler + output - crank + 0.25 * gap**2 / 2.0
    mechanism = catalogue.make_fourbar(Fourbar(0j, complex(ground), crank, coupler, output), 0.43)
    inputs = 0.43 + np.linspace(0.0, math.tau, GRID_SIZE)
    motion = drive(mechanism, inputs, order=1)
    assert motion.valid.all()
    assert not drive(mechanism, [math.pi], order=0).valid.any()
    assert find_min_transmission_angles(lambda at: drive(mechanism, at, order=0), inputs, motion) == {"coupler": 0.0}


def test_the_steering_error_is_the_greatest_of_all_peaks():
    """A least greatest error is about as great on the way as at the lock; it was looked for at one of them."""
    stated = {
        "kind": "steering",
        "wheelbase": 3173.5061801240495,
        "pivot_distance": 1165.497881187407,
        "track": 1238.1718859881023,
        "lock": 41.38831050063958,
        "max_steering_error": 4.0,
        "constraints": {"max_link_ratio": 12.0, "min_transmission_angle": 5.0},
    }
    share, lock = stated["pivot_distance"] / stated["wheelbase"], math.radians(stated["lock"])
    (design, *_) = [d for d in solve(parse_problem(stated)).designs if abs(d.metrics.steering_error - 0.4006) < 1e-4]
    links, half = design.mechanism.links, 0.5 * stated["pivot_distance"]
    pin = complex(*design.mechanism.skeleton.joints["A"]) + half
    # The left arm is turned in small steps; where the right pin is, the law of cosines says.
    turn = np.linspace(0.0, lock, 400_001)
    reach = 2.0 * half - pin * np.exp(1j * turn)
    bend = np.arccos((np.abs(reach) ** 2 + links.output**2 - links.coupler**2) / (2.0 * np.abs(reach) * links.output))
    straight = math.pi - np.angle(pin)
    right = math.pi + np.angle(reach) - np.array([[1.0], [-1.0]]) * bend - straight
    right = (right + math.pi) % math.tau - math.pi
    right = right[np.abs(right[:, 0]).argmin()]
    error = right - np.arctan(np.tan(turn) / (1.0 + share * np.tan(turn)))
    assert design.metrics.steering_error == pytest.approx(math.degrees(np.abs(error).max()), rel=1e-8)
