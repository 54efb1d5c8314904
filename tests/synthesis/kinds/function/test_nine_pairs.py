"""Watt II sixbars through nine pairs: the system, its start, and all solutions of drawn problems."""

from __future__ import annotations

import numpy as np
import pytest

from synthesis.dispatch import solve
from synthesis.kinds.function.nine_pairs.continuation import BEND_SIZE, load_nine_pair_start
from synthesis.kinds.function.nine_pairs.system import (
    NINE_PAIR_SYSTEM,
    PRECISE_NINE_PAIR_SYSTEM,
    SCRATCH_SIZE,
    SOLUTION_COUNT,
    compute_residuals,
    nine_pair_system,
    nine_pair_system_extended,
)
from synthesis.numerics.continuation import END_REACHED, ParameterPath, follow, refine
from synthesis.numerics.point_set import KnownPoints
from synthesis.registry import parse_problem
from tests.support.sixbars.nine_pairs import planted
from tools.watt_start import nine_pair_problem


def gaps(y, p):
    """Changes of both couplers' squared lengths with the turn of the link between them eliminated by its roots."""
    a, a_bar, c, c_bar, d, d_bar, e, e_bar = y
    found = []
    for u, w in zip(1.0 + p[:8], 1.0 + p[8:], strict=True):
        first = [c * (1 - a_bar / u), a + a_bar - c - c_bar + c * a_bar + c_bar * a - a * u - a_bar / u]
        turns = np.roots([*first, c_bar * (1 - a * u)])
        at_first = (1 + e - d) * (1 + e_bar - d_bar)
        found.append(np.prod([(1 + e * w - d * q) * (1 + e_bar / w - d_bar / q) - at_first for q in turns]))
    return np.array(found)


def test_a_drawn_sixbar_solves_its_own_problem():
    rng = np.random.default_rng(3)
    for _ in range(10):
        y, p = nine_pair_problem(rng)
        assert compute_residuals(y, p) < 1e-9
        assert np.abs(gaps(y, p)).max() < 1e-8 * np.abs(y).max() ** 4


def test_the_compiled_system_is_newtons_step_of_the_couplers_lengths():
    """Against another form of the equations, which have the same steps where they hold, by differences."""
    rng = np.random.default_rng(4)
    for _ in range(5):
        y, p = nine_pair_problem(rng)
        dp = rng.normal(size=16) + 1j * rng.normal(size=16)
        newton, tangent = np.empty((2, 8), np.complex128)
        low, p_low, work = (np.zeros(count, complex) for count in (8, 16, SCRATCH_SIZE))
        assert nine_pair_system(y, low, p, p_low, dp, newton, tangent, work) == 1
        h = 1e-6
        jacobian = np.stack([(gaps(y + h * k, p) - gaps(y - h * k, p)) / (2 * h) for k in np.eye(8)], axis=1)
        by_p = (gaps(y, p + h * dp) - gaps(y, p - h * dp)) / (2 * h)
        assert np.abs(newton).max() < 1e-9 * np.abs(y).max()
        assert np.abs(tangent - np.linalg.solve(jacobian, -by_p)).max() < 1e-4 * np.abs(tangent).max()


def test_a_change_of_the_turns_below_rounding_moves_the_precise_solution():
    """Newton's step at turns that are off by what a double cannot hold is that change times the tangent."""
    rng = np.random.default_rng(5)
    y, p = nine_pair_problem(rng)
    dp = rng.normal(size=16) + 1j * rng.normal(size=16)
    zero, work = np.zeros(8, complex), np.empty(SCRATCH_SIZE, complex)
    refined, low, _ = refine(PRECISE_NINE_PAIR_SYSTEM, y[None], zero[None], p)
    newton, tangent = np.empty((2, 8), np.complex128)
    assert nine_pair_system_extended(refined[0], low[0], p, 1e-22 * dp, dp, newton, tangent, work) == 1
    assert np.abs(newton - 1e-22 * tangent).max() < 1e-3 * np.abs(1e-22 * tangent).max()


def test_a_nearly_singular_end_is_reached_along_a_precise_way_alone():
    """The logarithm over 60° at nine Chebyshev points has such a pair of conjugates."""
    x = 5.5 - 4.5 * np.cos((2.0 * np.arange(9) + 1.0) * np.pi / 18.0)
    inputs, outputs = np.radians(60.0 * (x - 1.0) / 9.0), np.radians(60.0 * np.log10(x))
    turned = np.concatenate([inputs[1:] - inputs[0], outputs[1:] - outputs[0]])
    p = 2j * np.sin(0.5 * turned) * np.exp(0.5j * turned)
    rng = np.random.default_rng(0)
    bend = [BEND_SIZE * (rng.normal(size=(16, 2)) @ np.array([1.0, 1.0j])) for _ in range(2)][1]
    begun, one = load_nine_pair_start(), [1458]
    path = ParameterPath(begun.p, p, bend)
    rough, fine = (
        follow(
            PRECISE_NINE_PAIR_SYSTEM,
            begun.y[one],
            path,
            tolerance=1e-4,
            most_steps=20_000,
            precise=precise,
        )
        for precise in (False, True)
    )
    assert rough.status[0] != END_REACHED
    assert fine.status[0] == END_REACHED
    assert np.abs(gaps(fine.y[0], p)).max() < 1e-9


@pytest.mark.slow
def test_the_start_has_all_solutions_each_once():
    begun = load_nine_pair_start()
    assert begun.y.shape == (SOLUTION_COUNT, 8)
    assert compute_residuals(begun.y, begun.p).max() < 1e-9
    assert KnownPoints(8, 1e-6).add(begun.y).all()


def test_some_paths_lead_to_solutions_of_another_problem():
    begun, some = load_nine_pair_start(), slice(0, SOLUTION_COUNT, 700)
    _, p = nine_pair_problem(np.random.default_rng(8))
    ends = follow(NINE_PAIR_SYSTEM, begun.y[some], ParameterPath(begun.p, p, np.zeros(16, complex)), tolerance=1e-3)
    reached = ends.y[ends.status == END_REACHED]
    assert len(reached) > 30
    assert KnownPoints(8, 1e-6).add(reached).all()
    largest = max(np.abs(gaps(one, p)).max() / np.abs(one).max() ** 4 for one in reached)
    assert largest < 1e-7


def vectors_of(joints):
    """Crank and rocker, input link and output, with grounds of 1 along +x."""
    o2, a, b, o4, c, d, o6 = (complex(*joints[name]) for name in ("O2", "A", "B", "O4", "C", "D", "O6"))
    return np.array([(a - o2) / (o4 - o2), (b - o4) / (o4 - o2), (c - o4) / (o6 - o4), (d - o6) / (o6 - o4)])


@pytest.mark.campaign
@pytest.mark.timeout(900)
def test_all_sixbars_through_nine_pairs_of_a_drawn_one():
    vectors, inputs, outputs = planted(np.random.default_rng(0))
    pairs = [{"input": float(x), "output": float(y)} for x, y in np.degrees([inputs, outputs]).T]
    stated = {"kind": "function", "pairs": pairs, "criterion": "precision", "mechanisms": ["watt_2"], "max_designs": 50}
    result = solve(parse_problem(stated | {"constraints": {"min_transmission_angle": 9.0}}))
    assert result.search.complete
    assert result.search.method == "nine_pair_continuation"
    assert result.designs
    assert all(design.verification.passed for design in result.designs)
    assert max(design.structural_error.max for design in result.designs) < 1e-6
    places = [design.mechanism.skeleton.joints for design in result.designs]
    assert min(np.abs(vectors_of(joints) - vectors).max() for joints in places) < 1e-6
