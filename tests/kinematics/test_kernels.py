"""The compiled sweeps against their plain twins, on random batches, at all scales, and from several threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from numba import njit

from kinematics.linkage.fourbar import (
    Fourbar,
    barker_type,
    find_input_limits,
    find_transmission_extremes,
    is_same_circuit,
    stays_on_branch,
)
from kinematics.linkage.fourbar import closed_form as fourbar_module
from kinematics.linkage.kernels import TILE_SIZE, compute_direction
from kinematics.linkage.slider_crank import closed_form as slider_module
from kinematics.linkage.slider_crank.closed_form import SliderCrank
from tests.kinematics import twins
from tests.kinematics.sampling import random_fourbars, signs
from tests.support.kinematics.kernels import random_slider_cranks

AGREED = 1e-12
"""Share of the size of a value by which kernel and twin may differ, for each unit of the sensitivity at hand."""

RATES = (0.8, -0.6, 0.9)


def scaled_fourbars(rng: np.random.Generator, n: int, scale: float = 1.0) -> Fourbar:
    some = random_fourbars(rng, n)
    fields = some.input_pivot, some.output_pivot, some.input, some.coupler, some.output, some.coupler_point
    return Fourbar(*(scale * field for field in fields))


KINDS = {
    "fourbar": (scaled_fourbars, fourbar_module, twins.fourbar),
    "slider-crank": (random_slider_cranks, slider_module, twins.slider_crank),
}
kinds = pytest.mark.parametrize(("sample", "module", "twin"), KINDS.values(), ids=KINDS.keys())


def sine(linkage: Any, at: dict[str, np.ndarray]) -> np.ndarray:
    """|sin| of the angle that vanishes at a toggle: every order of differences grows with its inverse."""
    if isinstance(linkage, Fourbar):
        return np.abs(np.sin(at["output_angle"] - at["coupler_angle"]))
    return np.abs(np.cos(at["coupler_angle"] - linkage.slide_angle[..., None]))


@kinds
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_motion_agrees_with_the_plain_twin(sample: Callable, module: Any, twin: Callable, scale: float) -> None:
    rng = np.random.default_rng(81)
    linkage = sample(rng, 3000, scale)
    theta, sign = rng.uniform(-7.0, 7.0, (3000, 5)), signs(rng, 3000)
    w, alpha, jerk = RATES
    expected = twin(linkage, theta, sign, w, alpha, jerk)
    found = module.motion(linkage, theta, sign, speed=w, acceleration=alpha, jerk=jerk)
    alone = module.positions(linkage, theta, sign)
    for one, other in zip(alone, found.position, strict=True):
        np.testing.assert_array_equal(one, other)
    soft = np.nan_to_num(sine(linkage, expected[0])) > 0.1
    assert soft.mean() > 0.3
    for order, (got, wanted) in enumerate(zip(found, expected, strict=True)):
        np.testing.assert_array_equal(got.valid, wanted["valid"])
        for name, value in wanted.items():
            have = getattr(got, name)
            if name == "valid":
                continue
            assert np.all(np.isnan(have) == ~got.valid), name
            lengths = 1.0 if name in ("coupler", "output") else scale
            difference = np.abs(have - value)
            if name.endswith("angle"):
                difference, lengths = np.abs(np.angle(np.exp(1j * (have - value)))), 1.0
            # Rates are sums of powers of the lower rates, up to the order-th, and of 1/sine.
            size = np.abs(value) + lengths * 10.0 * (1.0 + np.abs(got.coupler if order else 0.0))
            assert np.nanmax((difference / size)[soft]) < AGREED * 10**order, (name, order)


@kinds
def test_masks_agree_where_closing_is_in_doubt(sample: Callable, module: Any, twin: Callable) -> None:
    """Random angles find few positions near a toggle; lengths here make it near for all of them."""
    rng = np.random.default_rng(82)
    n = 4000
    off = rng.choice([-1.0, 1.0], n) * 10.0 ** rng.uniform(-12.0, -2.0, n)
    theta = rng.uniform(-np.pi, np.pi, n)
    if sample is scaled_fourbars:
        a, b, c = rng.uniform(0.5, 2.0, (3, n))
        f = np.where(rng.random(n) < 0.5, b + c, np.abs(b - c)) * (1.0 + off)
        linkage: Any = Fourbar(0.0, a * np.exp(1j * theta) + f * np.exp(1j * rng.uniform(-3.0, 3.0, n)), a, b, c)
    else:
        a, b = rng.uniform(0.5, 2.0, (2, n))
        offset = a * np.sin(theta) + rng.choice([-1.0, 1.0], n) * b * (1.0 + off)
        linkage = SliderCrank.from_lengths(a, b, offset)
    found = module.motion(linkage, theta[:, None])
    expected = twin(linkage, theta[:, None], 1, 1.0, 0.0, 0.0)
    np.testing.assert_array_equal(found.position.valid, expected[0]["valid"])
    assert 0.3 < found.position.valid.mean() < 0.7
    firm = np.abs(off)[:, None] > 1e-10
    np.testing.assert_array_equal(found.velocity.valid[firm], expected[1]["valid"][firm])


@pytest.mark.parametrize("n", [1, 3, TILE_SIZE - 1, TILE_SIZE, TILE_SIZE + 1, 3 * TILE_SIZE + 2])
def test_coupler_point_alone_equals_the_whole(n: int) -> None:
    """Also over every remainder that a vector loop and a tile can leave."""
    rng = np.random.default_rng(83)
    linkage, theta, sign = random_fourbars(rng, 20), rng.uniform(-4.0, 4.0, n), signs(rng, 20)
    w, alpha, _ = RATES
    whole = fourbar_module.motion(linkage, theta, sign, speed=w, acceleration=alpha)
    points = fourbar_module.coupler_points(linkage, theta, sign)
    moved = fourbar_module.coupler_motion(linkage, theta, sign, speed=w, acceleration=alpha)
    for valid, alike in ((points.valid, whole.position.valid), (moved.valid, whole.position.valid)):
        np.testing.assert_array_equal(valid, alike)
    np.testing.assert_array_equal(moved.moves, whole.velocity.valid)
    rows = (moved.p, whole.position.p), (moved.velocity, whole.velocity.p), (moved.acceleration, whole.acceleration.p)
    for got, wanted in ((points.p, whole.position.p), *rows):
        np.testing.assert_allclose(got, wanted, rtol=1e-9, atol=1e-9)


def test_shapes_of_coupler_points() -> None:
    linkage = Fourbar.from_lengths([2.0, 2.5], 7.0, 9.0, 6.0, 1j)
    assert fourbar_module.coupler_points(linkage, 0.5).p.shape == (2, 1)
    assert fourbar_module.coupler_points(linkage, np.zeros(7), [1, -1]).valid.shape == (2, 7)
    assert fourbar_module.coupler_motion(linkage, np.zeros((2, 7)), speed=np.ones(7)).acceleration.shape == (2, 7)
    assert fourbar_module.coupler_motion(linkage, 0.1, speed=np.ones((3, 1, 1))).moves.shape == (3, 2, 1)


@kinds
def test_designs_angles_signs_and_rates_broadcast(sample: Callable, module: Any, twin: Callable) -> None:
    """Rates with an axis of their own, signs for each design: every entry is that of the single call."""
    rng = np.random.default_rng(86)
    linkage, theta, sign = sample(rng, 2), rng.uniform(-1.0, 1.0, (2, 4)), np.array([1, -1])
    speed, jerk = rng.uniform(0.5, 1.5, (3, 1, 4)), rng.uniform(0.5, 1.5, (2, 1))
    found = module.motion(linkage, theta, sign, speed=speed, jerk=jerk)
    for k in range(3):
        alone = module.motion(linkage, theta, sign, speed=speed[k], jerk=jerk)
        for part, same in zip(found[1:], alone[1:], strict=True):
            for values, wanted in zip(part, same, strict=True):
                np.testing.assert_array_equal(values[k], wanted)
    np.testing.assert_array_equal(
        np.broadcast_to(found.position.p, (3, 2, 4))[1], module.positions(linkage, theta, sign).p
    )


def test_direction_is_the_arc_tangent() -> None:
    rng = np.random.default_rng(84)
    x, y = rng.normal(size=(2, 200_000)) * 10.0 ** rng.uniform(-9.0, 9.0, (2, 200_000))
    edges = np.array([0.0, 1.0, -1.0, np.sqrt(2.0) - 1.0, 1.0 - np.sqrt(2.0)])
    ex, ey = (grid.ravel()[1:] for grid in np.meshgrid(edges, edges))
    x, y = np.concatenate([x, ex]), np.concatenate([y, ey])
    found = _directions(x, y)
    assert np.all(np.abs(found - np.arctan2(y, x)) <= 2.0 * np.spacing(np.abs(np.arctan2(y, x))))
    assert _directions(np.array([-1.0]), np.array([-0.0]))[0] == np.pi


@njit
def _directions(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    out = np.empty_like(x)
    for k in range(len(x)):
        out[k] = compute_direction(x[k], y[k])
    return out


@pytest.mark.slow
@kinds
def test_threads_do_not_disturb_one_another(sample: Callable, module: Any, twin: Callable) -> None:
    rng = np.random.default_rng(85)
    linkage, theta = sample(rng, 400), np.linspace(-3.0, 3.0, 361)
    alone = module.motion(linkage, theta)
    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(lambda _: module.motion(linkage, theta), range(8)))
    for found in together:
        for part, same in zip(found, alone, strict=True):
            for values, wanted in zip(part, same, strict=True):
                np.testing.assert_array_equal(values, wanted)


def test_verdicts_on_a_design_agree_with_the_plain_twin() -> None:
    """Half of the linkages have whole lengths from 1 to 4, so that ties, change points and impossible ones are met."""
    rng = np.random.default_rng(87)
    lengths = np.concatenate([rng.integers(1, 5, (4000, 4)).astype(float), rng.uniform(0.1, 3.0, (4000, 4))])
    linkage = Fourbar.from_lengths(*lengths.T)
    np.testing.assert_array_equal(barker_type(linkage), twins.barker_type(linkage))
    assert set(barker_type(linkage)) == set(range(15))
    for found, expected in zip(find_input_limits(linkage), twins.input_limits(linkage), strict=True):
        np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-15)
    start = rng.uniform(-7.0, 7.0, 8000)
    end = start + rng.uniform(-1.0, 1.0, 8000) * rng.choice([0.1, 1.0, 7.0], 8000)
    np.testing.assert_array_equal(stays_on_branch(linkage, start, end), twins.stays_on_branch(linkage, start, end))
    signs = rng.choice([-1, 1], (2, 8000))
    found = is_same_circuit(linkage, start, signs[0], end, signs[1])
    np.testing.assert_array_equal(found, twins.same_circuit(linkage, start, signs[0], end, signs[1]))
    assert 0.1 < found.mean() < 0.9
    extremes = zip(
        find_transmission_extremes(linkage, start, end), twins.transmission_extremes(linkage, start, end), strict=True
    )
    for found, expected in extremes:
        np.testing.assert_allclose(found, expected, atol=1e-7)
        assert np.median(np.abs(found - expected)) < 1e-15
