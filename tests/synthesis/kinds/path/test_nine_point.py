"""All fourbars through nine points: counts known from theory and print, symmetries, planted linkages."""

import json

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.kinds.path.exact.continuation_starts import load_nine_point_start
from synthesis.kinds.path.exact.nine_point_system import (
    ORBIT_COUNT,
    SCRATCH_SIZE,
    compute_orbit_keys,
    compute_residuals,
    construct_cognate,
    construct_cognates,
    evaluate_nine_point_system,
    evaluate_nine_point_system_extended,
    is_linkage,
    swap_dyads,
)
from synthesis.kinds.path.exact.nine_points import compute_conjugates, compute_triples
from tests.campaign import sampled
from tests.cases import HERE
from tools.path_starts import nine_point_problem

PUBLISHED = json.loads((HERE / "nine_point.json").read_text(encoding="utf-8"))


def silent(share):
    pass


def coupler_points(linkage, rng, count=9):
    """Points of one circuit of a linkage that turns through, at random crank angles in order."""
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count))
    at = positions(linkage, angles, OPEN_ASSEMBLY)
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


@pytest.mark.slow
def test_the_start_has_1442_orbits():
    begun = load_nine_point_start()
    assert begun.y.shape == (ORBIT_COUNT, 16)
    assert compute_residuals(begun.y, begun.p).max() < 1e-9
    assert is_linkage(begun.y).all()
    keys = compute_orbit_keys(begun.y, begun.p)
    gaps = np.abs(keys[:, None] - keys[None]).max(axis=-1) / np.abs(keys).max(axis=-1)[:, None]
    assert (gaps + np.eye(ORBIT_COUNT)).min() > 1e-4


def test_cognates_and_exchanged_dyads_solve_the_same_problem():
    rng = np.random.default_rng(7)
    for _ in range(20):
        y, p = nine_point_problem(rng)
        members = np.stack([y, construct_cognate(y, p), construct_cognate(swap_dyads(y), p), swap_dyads(y)])
        assert compute_residuals(members, p).max() < 1e-9
        keys = compute_orbit_keys(members, p)
        assert np.abs(keys - keys[0]).max() < 1e-9 * np.abs(keys).max()
        # going round the cognates comes back after three times
        round_ = construct_cognate(swap_dyads(construct_cognate(swap_dyads(construct_cognate(swap_dyads(y), p)), p)), p)
        assert np.abs(round_ - y).max() < 1e-9 * np.abs(y).max()


@pytest.mark.parametrize("system", [evaluate_nine_point_system, evaluate_nine_point_system_extended])
def test_the_compiled_system_is_newtons_step_of_the_equations(system):
    """Against the whole Jacobian of 16 equations, by differences, and a library's solver."""
    rng = np.random.default_rng(3)

    def gaps(y, p):
        s = y[8:]
        s_back = 1.0 / (1.0 + s) - 1.0
        found = []
        for x, x_bar, r, r_bar in (y[:4], y[4:8]):
            alpha, beta = p[:8] + x * s, p[8:] + x_bar * s_back
            found.append(alpha * beta + r * beta + r_bar * alpha)
        return np.concatenate(found)

    for _ in range(10):
        y, p = nine_point_problem(rng)
        y = y * (1.0 + 0.01 * rng.normal(size=16))
        dp = rng.normal(size=16) + 1j * rng.normal(size=16)
        newton, tangent = np.empty((2, 16), np.complex128)
        low, p_low, work = (np.zeros(count, complex) for count in (16, 16, SCRATCH_SIZE))
        assert system(y, low, p, p_low, dp, newton, tangent, work) == 1
        h = 1e-6
        jacobian = np.stack([(gaps(y + h * e, p) - gaps(y - h * e, p)) / (2 * h) for e in np.eye(16)], axis=1)
        by_p = (gaps(y, p + h * dp) - gaps(y, p - h * dp)) / (2 * h)
        assert np.abs(newton - np.linalg.solve(jacobian, -gaps(y, p))).max() < 1e-6 * np.abs(newton).max()
        assert np.abs(tangent - np.linalg.solve(jacobian, -by_p)).max() < 1e-6 * np.abs(tangent).max()


def test_dyads_that_agree_in_one_coordinate_are_no_linkage():
    """β = 0 at all points but one, from both dyads: a whole curve of solutions, with residuals of 0."""
    y, p = nine_point_problem(np.random.default_rng(9))
    assert is_linkage(y)
    y[[1, 5]] = 2.0 - 1.0j
    y[[3, 7]] = 0.0
    s_back = -p[8:] / y[1]
    y[8:] = -s_back / (1.0 + s_back)
    # β = 0 and r̄ = 0 leave nothing of the equations, whatever x and r are.
    assert compute_residuals(y, p) < 1e-12
    assert not is_linkage(y)
    assert not is_linkage(compute_conjugates(y))


@pytest.mark.campaign
def test_special_points_are_not_called_complete():
    """Nine points of an ellipse: nearly singular solutions, of which more or fewer are real by the last digits."""
    (case,) = [case for case in PUBLISHED if case["status"] == "non_generic"]
    points = np.array([complex(*point) for point in case["inputs"]["points"]])
    found = compute_triples(points, np.random.default_rng(0), silent, threads=2)
    assert not found.complete
    assert found.nearly_singular > 14


@pytest.mark.slow
def test_a_planted_linkage_and_both_cognates_are_found():
    rng = np.random.default_rng(11)
    linkage = crank_rocker(rng)
    points, at = coupler_points(linkage, rng)
    told = []
    found = compute_triples(points, rng, told.append, threads=2)
    assert found.complete
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert compute_residuals(found.y, found.p, found.low).max() <= 1e-8
    assert found.self_conjugate
    assert compute_residuals(compute_conjugates(found.y), found.p).max() < 1e-3
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
    y, p = nine_point_problem(np.random.default_rng(5))
    assert construct_cognates(y[None], p).shape == (1, 3, 16)


@pytest.mark.campaign
@pytest.mark.timeout(1200)
def test_random_problems_end_with_all_orbits():
    rng = np.random.default_rng(13)
    for n in range(sampled(12)):
        if n % 2:
            points = rng.normal(size=9) + 1j * rng.normal(size=9)
        else:
            points, _ = coupler_points(crank_rocker(rng), rng)
        found = compute_triples(points, rng, silent, threads=2)
        assert found.complete, (n, found.lost, found.self_conjugate)
