"""Limit positions against the fourbar's triangles, and the roots that they rest on."""

from __future__ import annotations

import numpy as np

from kinematics.linkage.planar.limits import find_branches, find_limit_positions, find_reference_branch
from kinematics.linkage.planar.roots import find_roots
from tests.kinematics.mechanism_sampling import fourbar, take


def test_limits_of_fourbars_stand_where_links_are_in_line() -> None:
    """The output turns back with input and coupler in line, or stops at a toggle with coupler and output in line."""
    pool = fourbar(np.random.default_rng(61), 60)
    compared = 0
    for n in range(60):
        mechanism = take(pool, n)
        here = find_reference_branch(mechanism, found := find_branches(mechanism))
        assert here is not None, found
        o2, o4, a, b = (complex(mechanism.joints[name]) for name in ("O2", "O4", "A", "B"))
        candidates = []
        if not here.full:
            ends = o2 + abs(a - o2) * np.exp(1j * np.array([here.low, here.high])) - o4
            candidates = [*np.angle(ends), *np.angle(-ends)]
        for reach in (abs(a - o2) + abs(b - a), abs(abs(a - o2) - abs(b - a))):
            base, side = abs(o2 - o4), abs(b - o4)
            cosine = (base**2 + side**2 - reach**2) / (2.0 * base * side)
            if abs(cosine) <= 1.0:
                candidates += [np.angle(o2 - o4) + sign * np.arccos(cosine) for sign in (1.0, -1.0)]
        span = find_limit_positions(mechanism, here, ["output"], [])[0][0]
        if span is not None:
            off = np.abs(np.exp(1j * np.array(span)[:, None]) - np.exp(1j * np.array(candidates))).min(axis=1)
            assert off.max() < 1e-8
            compared += 1
    assert compared > 40


def test_roots_in_brackets_of_very_different_shape() -> None:
    """x³ = c, tan-like steps and a zero at an end, all at once, to the last digits."""
    cubes = np.array([2.0, 1e-9, -5.0, 1e6])
    low, high = np.array([0.0, -1.0, -3.0, 0.0]), np.array([2.0, 1.0, 0.0, 200.0])
    calls = []

    def function(x: np.ndarray) -> np.ndarray:
        calls.append(len(x))
        return np.asarray(x**3 - cubes)

    positive, negative = find_roots(function, low, high)
    for found in (positive, negative):
        np.testing.assert_allclose(found, np.cbrt(cubes), rtol=1e-15)
    assert np.all(positive**3 - cubes >= 0.0)
    assert len(calls) < 40
    steep = find_roots(lambda x: np.arctan(1e8 * (x - 0.3)), np.array([0.0]), np.array([1.0]))[0]
    np.testing.assert_allclose(steep, 0.3, rtol=1e-15)
    at_end = find_roots(lambda x: x * (x + 2.0), np.array([0.0]), np.array([1.0]))[0]
    np.testing.assert_array_equal(at_end, 0.0)
