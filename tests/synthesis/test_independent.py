"""Answers measured by another route: what both state is the same to a millionth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.independent import FOLLOWERS, LAWS, Drive, Measured, cams, law, linkages
from synthesis.model.linkage_answer import Skeleton


@pytest.mark.parametrize("name", LAWS)
def test_the_laws_written_out_are_motions(name: str) -> None:
    """From nothing to one, and each derivative that of the one before."""
    u = np.linspace(0.0, 1.0, 20_001)
    s, v, a = law(name, u)
    assert (s[0], s[-1]) == pytest.approx((0.0, 1.0), abs=1e-12)
    assert np.gradient(s, u)[1:-1] == pytest.approx(v[1:-1], abs=1e-6)
    assert np.gradient(v, u)[1:-1] == pytest.approx(a[1:-1], abs=1e-4)


def test_a_linkage_is_driven_as_its_bars_allow() -> None:
    """A parallelogram: B moves as A does, and the transmission angle is the crank's own."""
    skeleton = Skeleton.model_validate(
        {
            "joints": {"O2": [0.0, 0.0], "O4": [4.0, 0.0], "A": [0.0, 2.0], "B": [4.0, 2.0], "P": [2.0, 3.0]},
            "links": [{"name": "ground", "joints": ["O2", "O4"]}],
            "input_link": "input",
        }
    )
    drive, turns = Drive(skeleton), np.linspace(0.0, 1.0, 200)
    places = drive.along(turns)
    assert np.abs(places - (4.0 + 2j * np.exp(1j * turns))).max() < 1e-12
    assert drive.transmission(1.0, complex(places[-1])) == pytest.approx(0.5 * math.pi - 1.0)


def test_a_difference_is_seen() -> None:
    result = Measured()
    result.add("size", 1.0 + 2e-6, 1.0, 1.0, "off")
    result.add("size", 1.0 + 2e-7, 1.0, 1.0, "near")
    result.add("size", None, 1.0, 1.0, "not stated")
    result.add("angle", math.nan, 1.0, 1.0, "unknown")
    assert {difference.name for difference in result.over} == {"off", "unknown"}


def test_cams_of_every_follower_agree() -> None:
    result = Measured()
    assert cams(2 * len(FOLLOWERS), 7, result) == 2 * len(FOLLOWERS)
    assert not result.over, result.report()
    assert sum(map(len, result.differences.values())) > 60


def test_linkages_of_three_positions_and_quick_returns_agree() -> None:
    result = Measured()
    assert linkages(10, ("motion",), 3, result) >= 10
    assert linkages(4, ("quick_return",), 3, result) >= 4
    assert not result.over, result.report()
    assert {"min_transmission_angle", "link_ratio", "targets, position"} <= set(result.differences)


@pytest.mark.campaign
def test_many_cams_agree() -> None:
    result = Measured()
    assert cams(200, 11, result) >= 190
    assert not result.over, result.report()


@pytest.mark.campaign
def test_many_linkages_agree() -> None:
    result = Measured()
    linkages(300, ("motion", "quick_return"), 11, result)
    assert not result.over, result.report()
