"""All fourbars through nine points: counts known from theory and print, symmetries, planted linkages."""

import json

import numpy as np
import pytest

from kinematics.linkage import OPEN, Fourbar, positions
from synthesis.path.nine_point import all_triples, conjugate
from synthesis.path.nine_point_start import is_linkage, start
from synthesis.path.nine_point_system import (
    ORBITS,
    cognate,
    cognates,
    exchanged,
    orbit_keys,
    random_problem,
    residuals,
)
from tests.cases import HERE

PUBLISHED = json.loads((HERE / "nine_point.json").read_text(encoding="utf-8"))


def silent(share):
    pass


def coupler_points(linkage, rng, count=9):
    """Points of one circuit of a linkage that turns through, at random crank angles in order."""
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
    at = positions(linkage, angles, OPEN)
    assert at.valid.all()
    return at.p, at


def crank_rocker(rng):
    while True:
        a, b, c, d = rng.uniform(0.3, 2.0, 4)
        sides = sorted([a, b, c, d])
        if min(a, b, c, d) == a and sides[0] + sides[3] < 0.95 * (sides[1] + sides[2]):
            pivots = rng.normal(size=2) + 1j * rng.normal(size=2)
            ground = (pivots[1] - pivots[0]) / abs(pivots[1] - pivots[0]) * d
            return Fourbar(pivots[0], pivots[0] + ground, a, b, c, rng.normal() + 1j * rng.normal())


def test_the_start_has_1442_orbits():
    begun = start()
    assert begun.y.shape == (ORBITS, 16)
    assert residuals(begun.y, begun.p).max() < 1e-9
    assert is_linkage(begun.y).all()
    keys = orbit_keys(begun.y, begun.p)
    gaps = np.abs(keys[:, None] - keys[None]).max(axis=-1) / np.abs(keys).max(axis=-1)[:, None]
    assert (gaps + np.eye(ORBITS)).min() > 1e-4


def test_cognates_and_exchanged_dyads_solve_the_same_problem():
    rng = np.random.default_rng(7)
    for _ in range(20):
        y, p = random_problem(rng)
        members = np.stack([y, cognate(y, p), cognate(exchanged(y), p), exchanged(y)])
        assert residuals(members, p).max() < 1e-9
        keys = orbit_keys(members, p)
        assert np.abs(keys - keys[0]).max() < 1e-9 * np.abs(keys).max()
        # going round the cognates comes back after three times
        round_ = cognate(exchanged(cognate(exchanged(cognate(exchanged(y), p)), p)), p)
        assert np.abs(round_ - y).max() < 1e-9 * np.abs(y).max()


@pytest.mark.campaign
def test_special_points_are_not_called_complete():
    """Nine points of an ellipse: nearly singular solutions, of which more or fewer are real by the last digits."""
    (case,) = [case for case in PUBLISHED if case["status"] == "non_generic"]
    points = np.array([complex(*point) for point in case["inputs"]["points"]])
    found = all_triples(points, np.random.default_rng(0), silent, threads=2)
    assert not found.complete
    assert found.nearly_singular > 14


@pytest.mark.slow
def test_a_planted_linkage_and_both_cognates_are_found():
    rng = np.random.default_rng(11)
    linkage = crank_rocker(rng)
    points, at = coupler_points(linkage, rng)
    told = []
    found = all_triples(points, rng, told.append, threads=2)
    assert found.complete
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert residuals(found.y, found.p, found.low).max() <= 1e-8
    assert found.self_conjugate
    assert residuals(conjugate(found.y), found.p).max() < 1e-3
    planted = np.array([linkage.input_pivot, at.a[0], linkage.output_pivot, at.b[0]])
    gaps = np.minimum(
        np.abs(found.real - planted).max(axis=-1), np.abs(found.real - planted[[2, 3, 0, 1]]).max(axis=-1)
    )
    triple = gaps.min(axis=1).argmin()
    assert gaps[triple].min() < 1e-7
    # each member of the triple draws the points: rigid links at all of them
    for o2, a, o4, b in found.real[triple]:
        drawn = Fourbar(o2, o4, abs(a - o2), abs(b - a), abs(b - o4), (points[0] - a) * abs(b - a) / (b - a))
        angles = np.linspace(0.0, 2.0 * np.pi, 40_001)
        curve = np.concatenate([positions(drawn, angles, sign).p for sign in (1, -1)])
        curve = curve[np.isfinite(curve)]
        step = 2e-3 * np.ptp(curve.real) + 2e-3 * np.ptp(curve.imag)
        assert max(np.abs(curve - point).min() for point in points) < step


def test_the_members_of_an_orbit_are_three():
    y, p = random_problem(np.random.default_rng(5))
    assert cognates(y[None], p).shape == (1, 3, 16)


@pytest.mark.campaign
@pytest.mark.timeout(1200)
def test_random_problems_end_with_all_orbits():
    rng = np.random.default_rng(13)
    for n in range(12):
        if n % 2:
            points = rng.normal(size=9) + 1j * rng.normal(size=9)
        else:
            points, _ = coupler_points(crank_rocker(rng), rng)
        found = all_triples(points, rng, silent, threads=2)
        assert found.complete, (n, found.lost, found.self_conjugate)
