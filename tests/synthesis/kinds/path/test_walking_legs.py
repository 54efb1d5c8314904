"""The feet of Klann's and Jansen's legs, as their published dimensions drive them; and sixbars that draw them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from synthesis.verification.reconstruction import rebuild_mechanism
from tests.support.problems.walking_legs import LEGS, foot, jansen, klann
from tests.support.sixbars.path import both_ways, solved


def length(mechanism, one: str, other: str) -> float:
    return abs(complex(mechanism.joints[one]) - complex(mechanism.joints[other]))


def test_klanns_leg_has_its_proportions():
    leg = klann()
    assert length(leg, "O", "A") == pytest.approx(0.268, abs=5e-4)
    assert length(leg, "D", "P") == pytest.approx(length(leg, "D", "E"), abs=5e-4)
    bend = np.angle((leg.joints["E"] - leg.joints["D"]) / (leg.joints["D"] - leg.joints["P"]))
    assert abs(math.degrees(float(bend))) == pytest.approx(30.0, abs=0.1)
    arm = np.angle((leg.joints["D"] - leg.joints["C"]) / (leg.joints["C"] - leg.joints["A"]))
    assert abs(math.degrees(float(arm))) == pytest.approx(12.8, abs=0.1)


def test_jansens_leg_has_its_eleven_numbers():
    leg = jansen()
    pairs = ("QB", "QC", "QD", "BD", "DE", "CE", "EP", "CP", "AB", "AC", "OA")
    numbers = [41.5, 39.3, 40.1, 55.8, 39.4, 36.7, 65.7, 49.0, 50.0, 61.9, 15.0]
    assert [length(leg, *pair) for pair in pairs] == pytest.approx(numbers)
    assert complex(leg.joints["O"] - leg.joints["Q"]) == 38.0 + 7.8j


@pytest.mark.parametrize(("name", "step", "height"), [("Klann's foot", 1.01, 0.527), ("Jansen's foot", 67.9, 22.4)])
def test_the_crank_turns_through_and_the_foot_makes_a_step(name, step, height):
    leg = LEGS[name]()
    assert find_reference_branch(leg, find_branches(leg)).full
    places = foot(name)
    assert np.ptp(places.real) == pytest.approx(step, rel=5e-3)
    assert np.ptp(places.imag) == pytest.approx(height, rel=5e-3)
    # The foot is on the ground for about half of the turn: as low as a tenth of its height.
    low = places.imag < places.imag.min() + 0.12 * np.ptp(places.imag)
    assert 0.3 < low.mean() < 0.6


@pytest.mark.campaign
@pytest.mark.timeout(300)
@pytest.mark.parametrize("name", LEGS)
def test_some_sixbar_draws_the_foot_to_a_two_hundredth_of_its_step(name):
    places = foot(name)
    result, _, _ = solved(places, mechanisms=["watt_1", "stephenson_1", "stephenson_3"], max_designs=3)
    errors = [
        both_ways(rebuild_mechanism(design.mechanism), places)
        for design in result.designs
        if design.verification.passed
    ]
    assert min(errors) <= 0.005 * np.ptp(places.real)
