"""Fewer than nine points with demands: planted tasks have answers, and the answers keep what was asked."""

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.dispatch import solve
from synthesis.fit.chart import CRANK_ROCKER, compute_lengths
from synthesis.kinds.path.residuals.curve_descent import UNLIMITED_PIVOTS, LinkageLimits, descend
from synthesis.registry import parse_problem
from tests.campaign import further
from tests.support.demands import path_constraints


def planted(n, seed):
    """A random crank-rocker and n places of its coupler point, in order, over a part of a turn."""
    rng = np.random.default_rng(seed)
    while True:
        b, c, d = rng.uniform(1.3, 4.0, 3)
        sides = sorted([1.0, b, c, d])
        if sides[0] + sides[3] < sides[1] + sides[2]:
            break
    o2 = 3.0 * complex(*rng.normal(size=2))
    linkage = Fourbar(
        o2,
        o2 + d * np.exp(1j * rng.uniform(0.0, 6.28)),
        1.0,
        b,
        c,
        b * complex(rng.uniform(-0.5, 1.5), rng.uniform(-1.0, 1.0)),
    )
    turned = np.linspace(0.0, rng.uniform(2.0, 5.0), n) + rng.uniform(-0.05, 0.05, n)
    return linkage, positions(linkage, rng.uniform(0.0, 6.28) + turned, OPEN_ASSEMBLY).p


def answer(points, **changes):
    problem = parse_problem(
        {
            "kind": "path",
            "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
            "rounds": 2,
            **changes,
        }
    )
    problem.require_consistent()
    return solve(problem, lambda share, message: None)


def pivots(design):
    return [complex(*design.mechanism.fixed_pivots.input), complex(*design.mechanism.fixed_pivots.output)]


def keeps(design, points):
    """The points are met in order by a mechanism that passed all its checks."""
    size = np.abs(points[:, None] - points).max()
    assert design.verification.passed
    assert design.metrics.visits_in_order
    assert max(target.point_residual for target in design.targets) < 1e-8 * size


@pytest.mark.slow
@pytest.mark.parametrize("n", [4, *(pytest.param(n, marks=pytest.mark.campaign) for n in (3, 5, 6, 7, 8))])
def test_a_crank_rocker_in_a_region_is_found(n):
    linkage, points = planted(n, n)
    o2, o4 = complex(linkage.input_pivot), complex(linkage.output_pivot)
    region = {
        "x": [min(o2.real, o4.real) - 1.0, max(o2.real, o4.real) + 1.0],
        "y": [min(o2.imag, o4.imag) - 1.0, max(o2.imag, o4.imag) + 1.0],
    }
    result = answer(points, constraints={"grashof": "crank_rocker", "fixed_pivot_region": region})
    assert result.designs
    assert not result.search.complete
    for design in result.designs:
        keeps(design, points)
        assert design.metrics.grashof == "crank_rocker"
        for pivot in pivots(design):
            assert region["x"][0] <= pivot.real <= region["x"][1]
            assert region["y"][0] <= pivot.imag <= region["y"][1]


@pytest.mark.slow
@pytest.mark.parametrize("n", further([0, 5, 10, 16, 20, 22], [0]))
def test_members_are_moved_into_demands_that_none_of_them_keeps(n):
    """All constraints 5 % looser than a planted linkage has it: no member that a descent happens to meet keeps them."""
    task = list(path_constraints.tasks(n + 1, 0))[n]
    result = solve(parse_problem({**task.statement, "rounds": 1}), lambda share, message: None)
    assert result.search.method == "family_search"
    assert task.answered(result)
    points = np.array([complex(point["x"], point["y"]) for point in task.statement["points"]])
    for design in result.designs:
        keeps(design, points)


@pytest.mark.campaign
@pytest.mark.parametrize("n", [6, *(pytest.param(n, marks=pytest.mark.campaign) for n in (4, 5, 7))])
def test_one_given_pivot_is_hit(n):
    linkage, points = planted(n, 20 + n)
    o2 = complex(linkage.input_pivot)
    result = answer(points, fixed_pivots={"input": [o2.real, o2.imag]})
    assert result.designs
    for design in result.designs:
        keeps(design, points)
        assert abs(pivots(design)[0] - o2) < 1e-8 * max(1.0, abs(o2))


@pytest.mark.campaign
@pytest.mark.parametrize("n", [3, 4])
def test_both_given_pivots_are_hit(n):
    linkage, points = planted(n, 40 + n)
    o2, o4 = complex(linkage.input_pivot), complex(linkage.output_pivot)
    result = answer(points, fixed_pivots={"input": [o2.real, o2.imag], "output": [o4.real, o4.imag]})
    assert result.designs
    for design in result.designs:
        keeps(design, points)
        assert abs(pivots(design)[0] - o2) + abs(pivots(design)[1] - o4) < 1e-8 * (1.0 + abs(o2))


@pytest.mark.campaign
def test_other_demands_choose_and_rank():
    _, points = planted(5, 3)
    asked = {"grashof": "crank_rocker", "min_transmission_angle": 35, "max_link_ratio": 5}
    result = answer(points, constraints=asked, rank_by="transmission_angle")
    assert result.designs
    angles = [design.metrics.min_transmission_angle for design in result.designs]
    assert angles == sorted(angles, reverse=True)
    for design in result.designs:
        keeps(design, points)
        assert design.metrics.min_transmission_angle >= 35.0
        assert design.metrics.link_ratio <= 5.0 * (1.0 + 1e-8)
    assert answer(points, constraints=asked, rank_by="transmission_angle") == result


@pytest.mark.campaign
@pytest.mark.parametrize("size", [1e-6, 1e6])
def test_size_and_place_do_not_matter(size):
    _, points = planted(5, 9)
    moved = points * size + (300.0 - 200.0j) * size
    result = answer(moved, constraints={"grashof": "crank_rocker"}, rounds=1)
    assert result.designs
    for design in result.designs:
        keeps(design, moved)


def test_descents_put_pivots_where_they_are_asked_for():
    _, points = planted(5, 1)
    start = np.array([[0.1, 0.2, 0.4, 0.0, 0.5, 0.6, 0.4, 1.0, 1.0]])
    within = UNLIMITED_PIVOTS.copy()
    within[0], within[1] = (0.5, 0.7), (-2.0, -2.0)
    theta = np.linspace(0.0, 3.0, 5)[None]
    ends = descend(CRANK_ROCKER, start, np.ones(1), theta, points, LinkageLimits(within=within), iterations=400)
    lengths, chart = np.zeros(4), np.zeros((4, 4))
    compute_lengths(CRANK_ROCKER, ends.x[0], lengths, chart)
    assert ends.cost[0] < 1e-18
    assert 0.5 - 1e-8 <= ends.x[0, 0] <= 0.7 + 1e-8
    assert abs(ends.x[0, 1] + 2.0) < 1e-8


@pytest.mark.campaign
@pytest.mark.timeout(400)
def test_points_that_no_order_of_a_crank_meets_end_honestly():
    points = np.array([0.0, 1.0, 0.001j, 1.0 + 0.001j, 0.002j, 1.0 + 0.002j])
    result = answer(points, constraints={"grashof": "double_crank", "min_transmission_angle": 80}, rounds=1)
    assert not result.search.complete
    for design in result.designs:
        keeps(design, points)
