"""Five points on given pivots: all solutions, against planted linkages, another formulation, and Newton's method."""

import json
import math

import numpy as np
import pytest

from kinematics.linkage.fourbar import OPEN_ASSEMBLY, Fourbar, positions
from synthesis.dispatch import solve
from synthesis.kinds.path.exact.continuation_starts import load_five_point_start
from synthesis.kinds.path.exact.five_point_system import SOLUTION_COUNT, compute_residuals
from synthesis.kinds.path.exact.five_points import solve_five_points
from synthesis.registry import parse_problem
from tests.cases import HERE

ROCKER = Fourbar(0.0, 8.0 + 1.0j, 2.5, 7.0, 6.0, 4.0 + 3.0j)


def statement(points, o2, o4, **changes):
    return parse_problem(
        {
            "kind": "path",
            "points": [{"x": float(z.real), "y": float(z.imag)} for z in points],
            "fixed_pivots": {"input": [o2.real, o2.imag], "output": [o4.real, o4.imag]},
            **changes,
        }
    )


def answer(problem):
    return solve(problem, lambda share, message: None)


def drawn(rng):
    """A random fourbar and five of its coupler point's places, in order."""
    while True:
        o2, o4 = rng.normal(size=2) + 1j * rng.normal(size=2)
        a, b, c = rng.uniform(0.3, 2.0, 3)
        linkage = Fourbar(o2, o4, a, b, c, b * complex(*rng.normal(size=2)))
        at = positions(linkage, np.sort(rng.uniform(0.0, 2.0 * np.pi, 5)), OPEN_ASSEMBLY)
        if at.valid.all():
            return linkage, at


def real_solutions_by_newton(points, o2, o4, rng, starts):
    """Another formulation and another method: Newton from many starts in lengths and real angles.

    Unknowns: A and B in the first position and the coupler's four turns; the dyads keep their lengths.
    """
    found = []
    moved = points[1:]
    for _ in range(starts):
        v = np.concatenate([3.0 * rng.normal(size=4), rng.uniform(-np.pi, np.pi, 4)])
        for _ in range(60):
            a, b, turns = complex(v[0], v[1]), complex(v[2], v[3]), np.exp(1j * v[4:])
            gaps, slopes = [], []
            for pin, pivot, at in ((a, o2, 0), (b, o4, 2)):
                arm = pin - points[0]
                now = moved + arm * turns - pivot
                gaps.append(0.5 * (np.abs(now) ** 2 - abs(pin - pivot) ** 2))
                slope = np.zeros((4, 8))
                for k, unit in enumerate((1.0, 1j)):
                    slope[:, at + k] = (now.conj() * unit * turns).real - ((pin - pivot).conjugate() * unit).real
                slope[np.arange(4), 4 + np.arange(4)] = (now.conj() * 1j * arm * turns).real
                slopes.append(slope)
            gap = np.concatenate(gaps)
            try:
                step = np.linalg.solve(np.concatenate(slopes), gap)
            except np.linalg.LinAlgError:
                break
            v = v - step / max(1.0, 0.5 * np.abs(step).max())
            if np.abs(step).max() < 1e-13:
                break
        if np.abs(gap).max() < 1e-10 and np.isfinite(v).all():
            pair = complex(v[0], v[1]), complex(v[2], v[3])
            if all(abs(pair[0] - q[0]) + abs(pair[1] - q[1]) > 1e-6 for q in found):
                found.append(pair)
    return found


def test_the_stored_start_is_whole():
    begun = load_five_point_start()
    assert begun.y.shape == (SOLUTION_COUNT, 8)
    assert compute_residuals(begun.y, begun.p).max() < 1e-10
    gaps = np.abs(begun.y[:, None] - begun.y[None]).max(axis=-1) + 10.0 * np.eye(SOLUTION_COUNT)
    assert gaps.min() > 1e-6


@pytest.mark.slow
def test_planted_linkages_are_among_all_36():
    rng = np.random.default_rng(1)
    for _ in range(30):
        linkage, at = drawn(rng)
        found = solve_five_points(at.p, complex(linkage.input_pivot), complex(linkage.output_pivot), rng)
        assert found.found == SOLUTION_COUNT
        assert found.complete
        assert min(abs(one.a - at.a[0]) + abs(one.b - at.b[0]) for one in found.linkages) < 1e-7


@pytest.mark.campaign
def test_all_real_solutions_are_those_that_newton_finds():
    """Newton from thousands of starts finds no other real solution, and nearly all of ours."""
    rng = np.random.default_rng(8)
    for _ in range(2):
        linkage, at = drawn(rng)
        o2, o4 = complex(linkage.input_pivot), complex(linkage.output_pivot)
        ours = solve_five_points(at.p, o2, o4, rng)
        theirs = real_solutions_by_newton(at.p, o2, o4, rng, 400)
        assert len(theirs) >= 3
        scale = max(abs(one.a - one.o2) + abs(one.b - one.o4) for one in ours.linkages)
        for a, b in theirs:
            if abs(a - b) > 1e-6 * scale and abs(a - o2) > 1e-6:
                assert min(abs(one.a - a) + abs(one.b - b) for one in ours.linkages) < 1e-6 * (1.0 + abs(a) + abs(b))


def test_every_real_solution_is_a_linkage_through_the_points():
    linkage, at = drawn(np.random.default_rng(12))
    o2, o4 = complex(linkage.input_pivot), complex(linkage.output_pivot)
    result = answer(statement(at.p, o2, o4, include_failed=True, max_designs=50, method="exact"))
    assert result.search.method == "five_point_continuation"
    assert result.search.complete
    assert len(result.designs) == result.given_pivots.real
    for design in result.designs:
        reached = next(check for check in design.verification.checks if check.name == "reaches_targets")
        assert reached.passed
        assert np.allclose(design.mechanism.fixed_pivots.input, [o2.real, o2.imag])


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("away", [0.0, 300.0])
def test_a_good_crank_rocker_comes_back_at_any_size_and_place(size, away):
    at = positions(ROCKER, np.array([0.2, 0.8, 1.5, 2.4, 3.1]), OPEN_ASSEMBLY)
    move = away * size * (1.0 - 0.5j)
    points, pivots = at.p * size + move, (move, (8.0 + 1.0j) * size + move)
    result = answer(statement(points, *pivots, constraints={"grashof": "crank_rocker"}, max_designs=50))
    assert result.search.complete
    wanted = np.array([abs(8.0 + 1.0j), 2.5, 7.0, 6.0]) * size
    links = [np.array(list(design.mechanism.links.model_dump().values())) for design in result.designs]
    assert any(np.allclose(found, wanted, rtol=1e-5) for found in links)


def test_five_points_on_a_line_have_the_known_real_solutions():
    """33 finite solutions instead of 36, 15 of them real, as tens of thousands of starts have found (Newton)."""
    rows = json.loads((HERE / "path_benchmarks.json").read_text(encoding="utf-8"))
    (row,) = (row for row in rows if row["id"] == "mw7_five_points")
    points = np.array([complex(*point) for point in row["inputs"]["points"]])
    o2, o4 = (complex(*pivot) for pivot in row["inputs"]["fixed_pivots"])
    found = solve_five_points(points, o2, o4, np.random.default_rng(0))
    assert (found.found, len(found.linkages)) == (33, row["reference"]["value"])
    assert not found.complete
    pins = np.array([[one.a - one.p, one.b - one.p] for one in found.linkages])
    for x, y, u, v, *_ in row["reference"]["solutions"]:
        known = np.array([complex(x, y), complex(u, v)])
        assert min(np.abs(pins - pair).max(axis=1).min() for pair in (known, known[::-1])) < 1e-9


def test_solutions_move_with_the_points():
    at = positions(ROCKER, np.array([0.2, 0.8, 1.5, 2.4, 3.1]), OPEN_ASSEMBLY)
    spin, shift = 1.7 * np.exp(0.6j), 3.0 - 11.0j
    here = solve_five_points(at.p, 0j, 8.0 + 1.0j, np.random.default_rng(0))
    there = solve_five_points(spin * at.p + shift, shift, spin * (8.0 + 1.0j) + shift, np.random.default_rng(4))
    assert len(here.linkages) == len(there.linkages)
    for one in here.linkages:
        gaps = [abs(spin * one.a + shift - other.a) + abs(spin * one.b + shift - other.b) for other in there.linkages]
        assert min(gaps) < 1e-6 * (1.0 + abs(one.a) + abs(one.b))


def test_an_empty_answer_is_a_proof():
    """No fourbar on these pivots meets these points in order with a rotating input and 60° everywhere."""
    points = np.array([0.0, 3.0 + 1.0j, -2.0 + 0.5j, 5.0 - 2.0j, 1.0 + 4.0j])
    limits = {"grashof": "double_crank", "min_transmission_angle": 60}
    result = answer(statement(points, -7.0 + 2.0j, 4.0 + 9.0j, method="exact", constraints=limits))
    assert result.designs == []
    assert result.search.complete
    assert "no design exists" in result.summary
    assert sum(result.search.rejected.values()) == result.search.candidates


@pytest.mark.slow
def test_points_that_cannot_be_met_exactly_are_fitted_and_that_is_said():
    """Two degrees more than the best exact linkage transmits at."""
    points = positions(ROCKER, np.radians([10.0, 60.0, 110.0, 160.0, 210.0]), OPEN_ASSEMBLY).p
    asked = {"constraints": {"grashof": "crank_rocker", "min_transmission_angle": 52}}
    assert answer(statement(points, 0j, 8 + 1j, method="exact", **asked)).designs == []
    task = statement(points, 0j, 8 + 1j, **asked)
    result = answer(task)
    fitted = answer(statement(points, 0j, 8 + 1j, method="least_squares", **asked))
    near = [design for design in fitted.designs if design.metrics.max_distance <= 0.05 * task.task_size]
    assert 0 < len(near) < len(fitted.designs), "what misses a point by far is not offered"
    assert result.designs == near
    assert result.designs[0].metrics.max_distance > 1e-3
    assert not result.search.complete
    assert result.search.method == "least_squares"
    assert result.given_pivots.computed == 36
    assert result.search.candidates > fitted.search.candidates
    assert "fitted instead" in result.summary


@pytest.mark.campaign
def test_points_that_fits_miss_by_far_have_no_answer():
    points = np.array([0.0, 3.0 + 1.0j, -2.0 + 0.5j, 5.0 - 2.0j, 1.0 + 4.0j])
    asked = {"constraints": {"grashof": "crank_rocker", "min_transmission_angle": 60}}
    fitted = answer(statement(points, -7.0 + 2.0j, 4.0 + 9.0j, method="least_squares", **asked))
    nearest = min(design.metrics.max_distance for design in fitted.designs)
    result = answer(statement(points, -7.0 + 2.0j, 4.0 + 9.0j, **asked))
    assert result.designs == []
    assert f"misses a point by {nearest:.4g} mm" in result.summary


@pytest.mark.campaign
@pytest.mark.parametrize(
    "points",
    [
        np.exp(1j * np.linspace(0.0, 2.0, 5)) * 4.0,
        np.linspace(0.0, 4.0, 5) + 0j,
        np.array([0.0, 1.0, 2.0 + 1.0j, 3.0, 4.0]) + 2.0 - 3.0j,
    ],
    ids=["about the input's pivot", "collinear through it", "symmetrical"],
)
def test_special_points_end_without_a_false_promise(points):
    result = answer(statement(points, 0j, 6.0 + 2.0j))
    for design in result.designs:
        assert design.verification.passed
    if result.search.complete:
        assert result.given_pivots.computed == SOLUTION_COUNT
    assert math.isfinite(result.given_pivots.largest_residual)
