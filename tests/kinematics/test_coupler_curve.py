"""The sextic, its double points and its crossings with lines, against the driven linkage."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from kinematics.errors import DimensionError, ShapeError
from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, find_input_limits, motion, positions
from kinematics.linkage.fourbar.cognates import build_cognates
from kinematics.linkage.fourbar.coupler_curve import (
    ACNODE,
    CRUNODE,
    CUSP,
    compute_sextic_coefficients,
    coupler_curve_degree,
    curve_unit,
    find_double_points,
)
from tests.cases import Case, cases
from tests.kinematics.sampling import assembled_angles, random_fourbars, signs, take
from tests.oracles.coupler_sextic import sextic
from tests.oracles.curve_crossings import line_crossings
from tests.oracles.differences import derivative
from tests.oracles.positions import meet

BATCH = 10_000
FIELDS = ("input_pivot", "output_pivot", "input", "coupler", "output", "coupler_point")
CRANK_ROCKER = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, 6.0 * np.exp(0.5j))


def sample(seed: int, margin: float, n: int = BATCH, m: int = 4, share: float = 0.98):
    """n random linkages in m configurations each, of one assembly a linkage."""
    rng = np.random.default_rng(seed)
    linkage = random_fourbars(rng, n, gap=1e-3)
    theta = assembled_angles(rng, linkage, m, margin)
    found = ~np.isnan(theta).any(axis=1)
    assert found.mean() > share
    linkage = take(linkage, found)
    return rng, linkage, theta[found], signs(rng, int(found.sum()))


def whole_curve(linkage: Fourbar, n: int) -> list[NDArray[np.complex128]]:
    """Closed polygons of the circuits of one linkage, dense at the toggles too.

    Between toggles the input angle is a cosine of the parameter, and the assembly changes half way.
    """
    limits, ground = find_input_limits(linkage), float(linkage.ground_angle)
    low, high = float(limits.lower), float(limits.upper)
    t = np.arange(n) * (2.0 * np.pi / n)
    folded, extended = bool(limits.folded_toggle), bool(limits.extended_toggle)
    if not folded and not extended:
        return [positions(linkage, t, sign).p for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY)]
    if folded and extended:
        ranges = [(low, high), (-high, -low)]
    else:
        ranges = [(-high, high)] if extended else [(low, 2.0 * np.pi - low)]
    found = []
    for start, end in ranges:
        theta = ground + 0.5 * (start + end) - 0.5 * (end - start) * np.cos(t)
        theta = np.where(t == 0.0, ground + start + 1e-13, theta)
        both = [positions(linkage, theta, sign).p for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY)]
        curve = np.where(t < np.pi, *both)
        found.append(curve[~np.isnan(curve)])
    return found


def moved(linkage: Fourbar, scale: float, turn: complex, shift: complex) -> Fourbar:
    return Fourbar(
        scale * turn * (linkage.input_pivot + shift),
        scale * turn * (linkage.output_pivot + shift),
        *(scale * x for x in (linkage.input, linkage.coupler, linkage.output, linkage.coupler_point)),
    )


@pytest.mark.parametrize("case", cases("coupler_curve_degree"))
def test_degree(case: Case) -> None:
    case.check(degree=coupler_curve_degree(case.inputs["n"]))


@pytest.mark.parametrize("links", [2, 5, 0, -4])
def test_degree_needs_an_even_number_of_links(links: int) -> None:
    with pytest.raises(DimensionError, match=r"^links must be even and at least 4"):
        coupler_curve_degree(links)


@pytest.mark.parametrize("case", cases("coupler_point"))
def test_symmetrical_curve(case: Case) -> None:
    """The sextic of a linkage with AB = O4B = BP is the same on both sides of its axis (Norton 3.4)."""
    a, b, d, gamma = (case.inputs[k] for k in ("a", "b", "d", "gamma"))
    linkage = Fourbar.from_lengths(a, b, b, d, b - b * np.exp(1j * np.radians(gamma)))
    axis = positions(linkage, np.pi).p - d
    anywhere = np.random.default_rng(30).normal(size=(20, 2)) @ np.array([1.0, 1.0j])
    mirrored = d + np.conj(anywhere - d) * axis / np.conj(axis)
    here, there = sextic(linkage, anywhere).value, sextic(linkage, mirrored).value
    assert np.abs(here).min() > 1e-7
    case.check(symmetry_error=np.abs(here / there - 1.0).max())


# -- the sextic --------------------------------------------------------------------------------------------------------


@pytest.mark.campaign
def test_sextic_vanishes_on_the_curve() -> None:
    _, linkage, theta, sign = sample(31, margin=0.0, m=8)
    found = sextic(linkage, positions(linkage, theta, sign).p)
    unit = curve_unit(linkage)[:, None]
    assert np.abs(found.value).max() < 1e-12
    away = np.abs(found.gradient) * unit > 1e-3
    assert away.mean() > 0.2
    assert (np.abs(found.value / found.gradient) / unit)[away].max() < 1e-10


@pytest.mark.slow
def test_sextic_measures_the_distance_off_the_curve() -> None:
    """A step of 1e-5 of the size across the curve changes the sign, and value / gradient gives the step."""
    _, linkage, theta, sign = sample(32, margin=1e-2)
    state = motion(linkage, theta, sign)
    unit = curve_unit(linkage)[:, None]
    velocity, point = state.velocity.p, state.position.p
    step = 1e-5 * unit
    normal = 1j * velocity / np.abs(velocity)
    left, right = sextic(linkage, point + step * normal), sextic(linkage, point - step * normal)
    regular = (np.abs(sextic(linkage, point).gradient) * unit > 1e-4) & (np.abs(velocity) > 1e-2 * unit)
    assert regular.mean() > 0.3
    assert (left.value * right.value < 0.0)[regular].mean() > 0.999
    for side in (left, right):
        ratio = (np.abs(side.value / side.gradient) / step)[regular]
        assert np.quantile(np.abs(ratio - 1.0), 0.9) < 0.01
        assert np.quantile(ratio, 0.001) > 0.3
    across = np.abs((sextic(linkage, point).gradient.conj() * velocity).real)
    slope = np.abs(sextic(linkage, point).gradient) * np.abs(velocity)
    assert (across / slope)[regular].max() < 1e-8


def test_gradient_is_the_derivative() -> None:
    rng = np.random.default_rng(33)
    linkage = random_fourbars(rng, BATCH)
    unit = curve_unit(linkage)[:, None]
    point = linkage.input_pivot[:, None] + unit * (rng.normal(size=(BATCH, 2)) + 1j * rng.normal(size=(BATCH, 2)))
    gradient = sextic(linkage, point).gradient
    by_x = derivative(lambda h: sextic(linkage, point + h * unit).value, 1, 0.02)
    by_y = derivative(lambda h: sextic(linkage, point + 1j * h * unit).value, 1, 0.02)
    size = np.abs(by_x + 1j * by_y) + 1.0
    assert (np.abs(gradient * unit - (by_x + 1j * by_y)) / size).max() < 1e-9


def test_coefficients_are_those_of_the_sextic() -> None:
    """Hermitian, monic, of degree three in p and in p̄, and equal to the factored form everywhere."""
    rng = np.random.default_rng(34)
    linkage = random_fourbars(rng, BATCH)
    found = compute_sextic_coefficients(linkage)
    assert found.shape == (BATCH, 4, 4)
    assert np.abs(found - found.conj().swapaxes(-1, -2)).max() < 1e-12
    np.testing.assert_allclose(found[:, 3, 3], 1.0, rtol=1e-12)
    xi = rng.normal(size=(BATCH, 5)) + 1j * rng.normal(size=(BATCH, 5))
    powers = xi[..., None] ** np.arange(4)
    value = np.einsum("njk,npj,npk->np", found, powers, powers.conj())
    point = linkage.input_pivot[:, None] + curve_unit(linkage)[:, None] * xi
    error = np.abs(value - sextic(linkage, point).value) / (1.0 + np.abs(xi)) ** 6
    assert error.max() < 1e-11


def test_cognates_have_one_sextic() -> None:
    """Both monic, the three agree in all of the plane once brought to one unit."""
    rng = np.random.default_rng(35)
    linkage = random_fourbars(rng, BATCH)
    unit = curve_unit(linkage)[:, None]
    point = linkage.input_pivot[:, None] + unit * (rng.normal(size=(BATCH, 5)) + 1j * rng.normal(size=(BATCH, 5)))
    here = sextic(linkage, point).value
    for cognate in build_cognates(linkage):
        there = sextic(cognate.linkage, point).value * (curve_unit(cognate.linkage)[:, None] / unit) ** 6
        assert np.quantile(np.abs(there / here - 1.0), 0.999) < 1e-8
        assert np.median(np.abs(there / here - 1.0)) < 1e-13


def test_parallelogram_curve_holds_a_circle() -> None:
    """A translating coupler takes P round a circle of the crank's radius, about O2 + its place in the coupler."""
    linkage = Fourbar.from_lengths(2.0, 5.0, 2.0, 5.0, 1.0 + 3.0j)
    circle = 1.0 + 3.0j + 2.0 * np.exp(1j * np.linspace(0.0, 6.0, 40))
    assert np.abs(sextic(linkage, circle).value).max() < 1e-17
    assert np.abs(sextic(linkage, circle + 0.1).value).max() > 1e-6


# -- double points -----------------------------------------------------------------------------------------------------


def driven(linkage: Fourbar, theta, assembly):
    one, other = (positions(linkage, theta, sign).p for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY))
    return np.where(assembly == OPEN_ASSEMBLY, one, other)


def test_double_points_are_singular_points_on_the_circle_of_foci() -> None:
    linkage = random_fourbars(np.random.default_rng(41), BATCH)
    found = find_double_points(linkage)
    assert set(np.unique(found.valid.sum(axis=1))) == {1, 3}
    np.testing.assert_array_equal(np.isnan(found.point), ~found.valid)
    assert np.all(found.valid[:, :-1] >= found.valid[:, 1:])
    unit = curve_unit(linkage)[:, None]
    at = sextic(linkage, np.where(found.valid, found.point, linkage.input_pivot[:, None]))
    reach = 1.0 + np.abs(found.point - linkage.input_pivot[:, None]) / unit
    assert (np.abs(at.value) / reach**6)[found.valid].max() < 1e-13
    assert (np.abs(at.gradient) * unit / reach**5)[found.valid].max() < 1e-8
    pivots = (linkage.input_pivot, linkage.output_pivot, build_cognates(linkage).left.linkage.output_pivot)
    o2, o4, third = (np.broadcast_to(pivot[:, None], (BATCH, 3))[found.valid] for pivot in pivots)
    point = found.point[found.valid]
    ratio = (point - o2) * (third - o4) / ((point - o4) * (third - o2))
    assert np.abs(np.sin(np.angle(ratio))).max() < 1e-7


def test_crunodes_are_passed_twice() -> None:
    linkage = random_fourbars(np.random.default_rng(42), BATCH, gap=1e-3)
    found = find_double_points(linkage)
    crunode = found.valid & (found.kind == CRUNODE)
    assert 0.3 < crunode.any(axis=1).mean() < 0.9
    np.testing.assert_array_equal(np.isnan(found.input_angle).any(axis=-1), ~crunode)
    unit = curve_unit(linkage)[:, None]
    for k in range(2):
        error = np.abs(driven(linkage, found.input_angle[..., k], found.assembly[..., k]) - found.point) / unit
        assert not np.isnan(error[crunode]).any()
        assert error[crunode].max() < 1e-6
        assert np.quantile(error[crunode], 0.99) < 1e-10
    turned = np.abs(np.exp(1j * found.input_angle[..., 0]) - np.exp(1j * found.input_angle[..., 1]))
    other = found.assembly[..., 0] != found.assembly[..., 1]
    assert np.all(((turned > 1e-6) | other)[crunode])
    assert {tuple(x) for x in found.assembly[crunode]} == {(1, 1), (1, -1), (-1, 1), (-1, -1)}


def test_signs_around_double_points() -> None:
    """Round a crunode the sextic changes its sign four times, round an acnode never."""
    linkage = random_fourbars(np.random.default_rng(43), 1000, gap=1e-2)
    found = find_double_points(linkage)
    unit = curve_unit(linkage)
    for kind, changes in ((CRUNODE, 4), (ACNODE, 0)):
        seen = []
        for k in range(3):
            of = np.flatnonzero(found.valid[:, k] & (found.kind[:, k] == kind))
            here = take(linkage, of)
            ring = found.point[of, k, None] + 1e-4 * unit[of, None] * np.exp(1j * np.arange(720) * np.pi / 360.0)
            sign = np.sign(sextic(here, ring).value)
            seen.append((sign != np.roll(sign, 1, axis=1)).sum(axis=1))
        counted = np.concatenate(seen)
        assert len(counted) > 300
        assert (counted == changes).mean() > 0.98


def self_crossings(linkage: Fourbar, n: int = 1500) -> NDArray[np.complex128]:
    """Points where the polygons of the whole curve cross themselves or one another."""
    starts, ends, label, index = [], [], [], []
    for k, curve in enumerate(whole_curve(linkage, n)):
        starts.append(curve)
        ends.append(np.roll(curve, -1))
        label.append(np.full(len(curve), k))
        index.append(np.arange(len(curve)))
    p, q = np.concatenate(starts), np.concatenate(ends)
    circuit, number = np.concatenate(label), np.concatenate(index)
    low_x, high_x = np.minimum(p.real, q.real), np.maximum(p.real, q.real)
    low_y, high_y = np.minimum(p.imag, q.imag), np.maximum(p.imag, q.imag)
    near = (low_x[:, None] <= high_x) & (low_x <= high_x[:, None])
    near &= (low_y[:, None] <= high_y) & (low_y <= high_y[:, None])
    one, other = np.nonzero(np.triu(near, 1))
    gap = np.abs(number[one] - number[other])
    last = np.bincount(circuit)[circuit[one]] - 1
    apart = (circuit[one] != circuit[other]) | ((gap > 1) & (gap != last))
    one, other = one[apart], other[apart]
    d, e, f = q[one] - p[one], q[other] - p[other], p[other] - p[one]
    cross = d.real * e.imag - d.imag * e.real
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (f.real * e.imag - f.imag * e.real) / cross
        t = (f.real * d.imag - f.imag * d.real) / cross
    hit = (s >= 0) & (s < 1) & (t >= 0) & (t < 1)
    return (p[one] + s * d)[hit]


def polished(linkage: Fourbar, point: complex) -> complex:
    """The singular point of the sextic next to a point, by Newton's iteration on the numerical gradient."""
    unit = float(curve_unit(linkage))
    for _ in range(12):
        slope = sextic(linkage, point).gradient
        h = 1e-5 * unit
        by_x = (sextic(linkage, point + h).gradient - sextic(linkage, point - h).gradient) / (2 * h)
        by_y = (sextic(linkage, point + 1j * h).gradient - sextic(linkage, point - 1j * h).gradient) / (2 * h)
        matrix = np.array([[by_x.real, by_y.real], [by_x.imag, by_y.imag]])
        x, y = np.linalg.solve(matrix, [-slope.real, -slope.imag])
        point = complex(point + x + 1j * y)
    return point


@pytest.mark.campaign
def test_crunodes_are_all_self_crossings_of_the_sampled_curve() -> None:
    batch = random_fourbars(np.random.default_rng(44), 40, gap=2e-2)
    found = find_double_points(batch)
    total = 0
    for k in range(40):
        linkage, unit = take(batch, k), float(curve_unit(take(batch, k)))
        expected = found.point[k][found.valid[k] & (found.kind[k] == CRUNODE)]
        seen = self_crossings(linkage)
        assert len(seen) == len(expected), k
        for point in seen:
            assert np.abs(expected - polished(linkage, complex(point))).min() < 1e-7 * unit
        total += len(seen)
    assert total > 25


def test_acnodes_are_never_reached() -> None:
    """A pin A in reach of O2 and the point, on either side, does not let B reach O4; at a crunode both sides do."""
    linkage = random_fourbars(np.random.default_rng(45), BATCH, gap=1e-2)
    found = find_double_points(linkage)
    a, z, b, c, o2, o4 = (
        getattr(linkage, name)[:, None]
        for name in ("input", "coupler_point", "coupler", "output", "input_pivot", "output_pivot")
    )
    point = np.where(found.valid, found.point, np.nan)
    misses = []
    for side in (1, -1):
        pin_a = meet(o2, point, a, np.abs(z), side)
        pin_b = pin_a + (point - pin_a) * (b / z)
        misses.append(np.abs(np.abs(pin_b - o4) - c) / curve_unit(linkage)[:, None])
    crunode, acnode = (found.valid & (found.kind == kind) for kind in (CRUNODE, ACNODE))
    assert crunode.mean() > 0.15
    assert acnode.mean() > 0.3
    assert (np.fmax(*misses)[crunode] < 1e-8).mean() > 0.99
    assert (np.nan_to_num(np.fmin(*misses), nan=1.0)[acnode] > 1e-5).mean() > 0.999


def test_planted_cusps() -> None:
    """A coupler point at the pole, on the moving centrode, draws a cusp there."""
    _, plain, theta, sign = sample(46, margin=0.1, m=1, share=0.7)
    state = motion(plain, theta, sign)
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = 1j * state.velocity.a / state.velocity.coupler
    coupler = state.position.b - state.position.a
    place = (arm * np.abs(coupler) / coupler)[:, 0]
    near = (np.abs(place) < 5.0) & (np.abs(place) > 0.2) & (np.abs(place - plain.coupler) > 0.2)
    assert near.mean() > 0.3
    linkage = Fourbar(*(getattr(plain, name)[near] for name in FIELDS[:5]), place[near])
    found = find_double_points(linkage)
    cusp = found.valid & (found.kind == CUSP)
    one = cusp.sum(axis=1) == 1
    assert one.mean() > 0.999
    linkage, theta, sign = take(linkage, one), theta[near][one], sign[near][one]
    index = cusp[one].argmax(axis=1)[:, None]
    point = np.take_along_axis(found.point[one], index, axis=1)
    error = np.abs(point - positions(linkage, theta, sign).p) / curve_unit(linkage)[:, None]
    assert np.quantile(error, 0.999) < 1e-9
    for k in range(2):
        angle = np.take_along_axis(found.input_angle[one][..., k], index, axis=1)
        assert np.quantile(np.abs(np.exp(1j * angle) - np.exp(1j * theta)), 0.999) < 1e-8
        own = np.take_along_axis(found.assembly[one][..., k], index, axis=1)
        assert (own[:, 0] == sign).all()


def test_coupler_point_in_line_has_its_double_points_on_the_ground_line() -> None:
    rng = np.random.default_rng(47)
    linkage = random_fourbars(rng, 1000, gap=1e-3)
    straight = Fourbar(*(getattr(linkage, name) for name in FIELDS[:5]), rng.uniform(-3.0, 3.0, 1000))
    found = find_double_points(straight)
    assert (found.valid.sum(axis=1) >= 1).all()
    base = (straight.output_pivot - straight.input_pivot)[:, None]
    off = ((found.point - straight.input_pivot[:, None]) / base).imag
    assert np.abs(off)[found.valid].max() < 1e-9
    crunode = found.valid & (found.kind == CRUNODE)
    error = np.abs(driven(straight, found.input_angle[..., 0], found.assembly[..., 0]) - found.point)
    assert np.quantile((error / curve_unit(straight)[:, None])[crunode], 0.99) < 1e-10


# -- lines -------------------------------------------------------------------------------------------------------------


def test_line_through_points_of_the_curve_finds_them() -> None:
    """Lines through two points of the curve, given by a third point of the line."""
    _, linkage, theta, sign = sample(51, margin=1e-2, m=2)
    point = positions(linkage, theta, sign).p
    way = point[:, 1] - point[:, 0]
    unit = curve_unit(linkage)
    far = np.abs(way) > 1e-2 * unit
    linkage, point, way, unit = take(linkage, far), point[far], way[far], unit[far, None]
    start = point[:, 0] - 0.7 * way
    found = line_crossings(linkage, start, way)
    count = found.valid.sum(axis=1)
    assert set(np.unique(count)) == {2, 4, 6}
    np.testing.assert_array_equal(np.isnan(found.distance), ~found.valid)
    np.testing.assert_array_equal(np.isnan(found.point), ~found.valid)
    assert np.all(found.valid[:, :-1] >= found.valid[:, 1:])
    both = found.valid[:, 1:]
    assert np.all(np.diff(found.distance, axis=1)[both] >= 0.0)
    for k, share in ((0, 0.7), (1, 1.7)):
        missed = np.abs(found.point - point[:, k, None])
        missed[~found.valid] = np.inf
        nearest = missed.argmin(axis=1)[:, None]
        assert np.quantile(missed.min(axis=1) / unit[:, 0], 0.99) < 1e-9
        assert (missed.min(axis=1) / unit[:, 0]).max() < 1e-5
        distance = np.take_along_axis(found.distance, nearest, axis=1)[:, 0]
        assert np.quantile(np.abs(distance - share * np.abs(way)), 0.99) < 1e-9
    value = sextic(linkage, np.where(found.valid, found.point, point[:, :1])).value
    assert np.abs(value).max() < 1e-12
    on_line = ((found.point - start[:, None]) / way[:, None]).imag
    assert np.abs(on_line)[found.valid].max() < 1e-11


def test_number_of_crossings_is_that_of_the_sampled_curve() -> None:
    rng = np.random.default_rng(52)
    batch = random_fourbars(rng, 150, gap=2e-2)
    seen = []
    for k in range(150):
        linkage = take(batch, k)
        curves = whole_curve(linkage, 4000)
        every = np.concatenate(curves)
        start, end = every[rng.integers(len(every), size=2)]
        sides = [np.sign(((curve - start) * np.conj(end - start)).imag + 1e-12) for curve in curves]
        expected = sum(int((side != np.roll(side, 1)).sum()) for side in sides)
        found = int(line_crossings(linkage, start, end - start).valid.sum())
        seen.append((expected, found))
    assert sum(one == other for one, other in seen) >= 148
    assert {found for _, found in seen} >= {2, 4, 6}


def test_line_that_misses_and_line_that_touches() -> None:
    assert not line_crossings(CRANK_ROCKER, 100.0j, 1.0).valid.any()
    theta = 1.1
    state = motion(CRANK_ROCKER, theta)
    found = line_crossings(CRANK_ROCKER, complex(state.position.p), complex(state.velocity.p))
    assert (np.abs(found.distance[found.valid]) < 1e-6).sum() == 2


def test_line_needs_a_direction() -> None:
    for way in (0.0, np.nan, [1.0, 0.0]):
        with pytest.raises(DimensionError, match=r"^direction must be finite and not zero"):
            line_crossings(CRANK_ROCKER, 0.0, way)
    with pytest.raises(DimensionError, match=r"^point must be finite"):
        line_crossings(CRANK_ROCKER, np.inf, 1.0)
    three = Fourbar.from_lengths([2.0, 3.0, 4.0], 7.0, 9.0, 6.0, 1j)
    for call in (lambda: line_crossings(three, np.zeros(2), 1.0), lambda: sextic(three, np.zeros((2, 5)))):
        with pytest.raises(ShapeError, match="broadcast"):
            call()


@pytest.mark.parametrize("point", [0.0, 7.0, 1e-10, [2.0j, 7.0 + 1e-9]])
def test_point_at_a_moving_pivot_draws_no_sextic(point: object) -> None:
    linkage = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, point)
    for call in (lambda: find_double_points(linkage), lambda: line_crossings(linkage, 0.0, 1.0)):
        with pytest.raises(DimensionError, match=r"^coupler_point must be away from the moving pivots"):
            call()


# -- invariance and batches --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_curve_moves_with_rotation_translation_and_scale(scale: float) -> None:
    rng = np.random.default_rng(61)
    linkage = random_fourbars(rng, 500, gap=1e-2)
    turn, shift = np.exp(0.7j), 3.0 - 1.0j
    other = moved(linkage, scale, turn, shift)
    np.testing.assert_allclose(curve_unit(other), scale * curve_unit(linkage))
    point = rng.normal(size=(500, 4)) + 1j * rng.normal(size=(500, 4))
    here, there = sextic(linkage, point), sextic(other, scale * turn * (point + shift))
    np.testing.assert_allclose(there.value, here.value, rtol=1e-7, atol=1e-11)
    np.testing.assert_allclose(there.gradient * scale / turn, here.gradient, rtol=1e-7, atol=1e-11)
    one, two = find_double_points(linkage), find_double_points(other)
    same = one.valid.sum(axis=1) == two.valid.sum(axis=1)
    assert same.mean() > 0.99
    for k in range(3):
        target = scale * turn * (one.point[:, k] + shift)
        missed = np.abs(two.point - target[:, None])
        nearest = np.where(two.valid, missed, np.inf).min(axis=1) / (scale * curve_unit(linkage))
        assert np.quantile(nearest[one.valid[:, k] & same], 0.99) < 1e-8
    way = np.exp(1j * rng.uniform(-np.pi, np.pi, 500))
    cut, also = (
        line_crossings(linkage, linkage.input_pivot, way),
        line_crossings(other, other.input_pivot, 7.0 * turn * way),
    )
    assert (cut.valid == also.valid).all(axis=1).mean() > 0.995
    both = cut.valid & also.valid
    error = np.abs(also.distance / scale - cut.distance) / curve_unit(linkage)[:, None]
    assert np.quantile(error[both], 0.98) < 1e-9


def test_batches_equal_single_designs() -> None:
    rng = np.random.default_rng(62)
    batch = random_fourbars(rng, 6)
    linkage = Fourbar(*(getattr(batch, name).reshape(2, 3) for name in FIELDS))
    point, way = rng.normal(size=5) + 1j, np.exp(1j * rng.uniform(-3.0, 3.0, (2, 3)))
    calls = {
        (5,): lambda x, i: sextic(x, point),
        (4, 4): lambda x, i: (compute_sextic_coefficients(x),),
        (6,): lambda x, i: line_crossings(x, 0.1, way[i]),
        (): lambda x, i: (curve_unit(x),),
        (3,): lambda x, i: find_double_points(x)[:3],
        (3, 2): lambda x, i: find_double_points(x)[3:],
    }
    for tail, call in calls.items():
        together = call(linkage, ...)
        for index in np.ndindex(2, 3):
            for whole, part in zip(together, call(take(linkage, index), index), strict=True):
                assert whole.shape == (2, 3, *tail)
                assert part.shape == tail
                np.testing.assert_allclose(whole[index], part, rtol=1e-8, atol=1e-8)
    assert sextic(CRANK_ROCKER, 1j).value.shape == ()
    assert line_crossings(CRANK_ROCKER, np.zeros(4), 1j).point.shape == (4, 6)
