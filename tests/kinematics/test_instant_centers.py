"""Instant centres of any mechanism against Kennedy's theorem, the pins, and the fourbar's own formulas."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from kinematics.linkage.fourbar.closed_form import Fourbar
from kinematics.linkage.planar.catalogue import make_fourbar, make_sixbar
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.instant_centers import find_instant_centers
from tests.oracles.fourbar_instants import PAIRS
from tests.oracles.fourbar_instants import instant_centers as fourbar_centers

SIXBAR = make_sixbar(
    "stephenson_2",
    {"O2": 0, "O4": 5, "A": 1 + 1.2j, "C": 0.3 + 1.9j, "B": 3 + 3j, "D": 1.5 + 4.5j, "E": 4.5 + 4j},
)
FOURBAR = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0)


@pytest.mark.parametrize("mechanism", [SIXBAR, make_fourbar(FOURBAR, 0.7)], ids=["stephenson", "fourbar"])
def test_pins_are_centres_and_any_three_lie_on_a_line(mechanism) -> None:
    motion = drive(mechanism, np.linspace(-0.4, 0.43, 9) + mechanism.reference_input)
    assert motion.smooth.all()
    centers = find_instant_centers(mechanism, motion)
    count = len(mechanism.links)
    assert len(centers) == count * (count - 1) // 2
    for (one, other), center in centers.items():
        assert center.finite.all()
        for joint in set(mechanism.links[one]) & set(mechanism.links[other]):
            assert center.point == pytest.approx(motion.joints[joint][0], abs=1e-9)
    for a, b, c in combinations(mechanism.links, 3):
        p, q, r = centers[(a, b)].point, centers[(b, c)].point, centers[(a, c)].point
        area = np.abs((np.conj(q - p) * (r - p)).imag)
        assert np.all(area <= 1e-8 * (np.abs(q - p) + np.abs(r - p) + 1.0) ** 2)


def test_the_fourbar_of_the_books() -> None:
    mechanism = make_fourbar(FOURBAR, 0.7)
    at = np.linspace(0.2, 2.0, 7)
    centers = find_instant_centers(mechanism, drive(mechanism, at))
    known = fourbar_centers(FOURBAR, at)
    names = ("ground", "input", "coupler", "output")
    for k, (i, j) in enumerate(PAIRS):
        pair = (names[i - 1], names[j - 1])
        assert centers[pair].point == pytest.approx(known.point[..., k], rel=1e-8)


def test_parallel_links_have_no_finite_centre() -> None:
    parallelogram = Fourbar.from_lengths(2.0, 5.0, 2.0, 5.0)
    centers = find_instant_centers(
        make_fourbar(parallelogram, 1.0), drive(make_fourbar(parallelogram, 1.0), np.array([1.0, 2.0]))
    )
    assert not centers[("input", "output")].finite.any()
    assert not centers[("ground", "coupler")].finite.any()
    assert np.isnan(centers[("ground", "coupler")].point).all()
    assert centers[("ground", "input")].finite.all()
