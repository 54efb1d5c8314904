"""Instant centres, pole, centrodes, curvature and ratios against rates, finite differences and known paths."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from kinematics.errors import DimensionError, ShapeError
from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    find_toggle_angles,
    motion,
    positions,
    transmission_angle,
)
from kinematics.linkage.fourbar.curvature import compute_path_curvature, find_pole
from tests.cases import Case, cases
from tests.kinematics.sampling import assembled_angles, random_fourbars, signs, take
from tests.oracles.differences import derivative
from tests.oracles.fourbar_instants import (
    PAIRS,
    bresse_circles,
    instant_center_count,
    instant_centers,
    mechanical_advantage,
    torque_ratio,
    velocity_ratio,
)

BATCH = 10_000
FIELDS = ("input_pivot", "output_pivot", "input", "coupler", "output", "coupler_point")
CRANK_ROCKER = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, 6.0 * np.exp(0.5j))
PARALLELOGRAM = Fourbar.from_lengths(2.0, 5.0, 2.0, 5.0, 1.0 + 3.0j)
ASSEMBLY = {"open": OPEN_ASSEMBLY, "crossed": CROSSED_ASSEMBLY}


def sample(seed: int, margin: float, n: int = BATCH, m: int = 3, share: float = 0.95):
    """n random linkages in m configurations each, of one assembly a linkage."""
    rng = np.random.default_rng(seed)
    linkage = random_fourbars(rng, n, gap=1e-3)
    theta = assembled_angles(rng, linkage, m, margin)
    found = ~np.isnan(theta).any(axis=1)
    assert found.mean() > share
    linkage = take(linkage, found)
    return rng, linkage, theta[found], signs(rng, int(found.sum()))


def size_of(linkage: Fourbar) -> NDArray[np.float64]:
    return (linkage.lengths.sum(axis=-1) + np.abs(linkage.coupler_point))[..., None]


def with_point(linkage: Fourbar, point: object) -> Fourbar:
    return Fourbar(*(getattr(linkage, name) for name in FIELDS[:5]), point)


def cross(one, other):
    return one.real * other.imag - one.imag * other.real


# -- printed cases -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", cases("instant_center_count"))
def test_number_of_instant_centers(case: Case) -> None:
    case.check(count=instant_center_count(case.inputs["n"]))


def test_number_of_instant_centers_of_the_fourbar() -> None:
    assert instant_center_count(4) == len(PAIRS) == instant_centers(CRANK_ROCKER, 0.5).point.shape[-1]
    assert instant_center_count(1) == 0
    for links in (0, -3):
        with pytest.raises(DimensionError, match=r"^links must be a count of at least 1"):
            instant_center_count(links)


@pytest.mark.parametrize("case", cases("fourbar_velocity"))
def test_velocity_by_instant_centers(case: Case) -> None:
    """Norton, Sec. 6.4: ω4 from the velocity ratio, ω3 and V_P from the pole."""
    x = case.inputs
    arm = x["p"] * np.exp(1j * np.radians(x["delta3"]))
    linkage = Fourbar.from_lengths(x["a"], x["b"], x["c"], x["d"], arm)
    theta, assembly = np.radians(x["theta2"]), ASSEMBLY[x["circuit"]]
    at, found = positions(linkage, theta, assembly), find_pole(linkage, theta, assembly)
    omega3 = x["omega2"] * (at.a / (at.a - found.point)).real
    velocity = 1j * omega3 * (at.p - found.point)
    case.check(
        omega3=omega3,
        omega4=x["omega2"] * velocity_ratio(linkage, theta, assembly).value,
        VP_mag=abs(velocity),
        VP_ang=np.degrees(np.angle(velocity)),
    )


# -- instant centres ---------------------------------------------------------------------------------------------------


def rates_of(linkage: Fourbar, theta, sign):
    """For each link its angular velocity and the velocity of its point at the origin, at unit input speed."""
    state = motion(linkage, theta, sign)
    one = np.ones_like(theta)
    turns = (0.0 * one, one, state.velocity.coupler, state.velocity.output)
    o2, o4 = linkage.input_pivot[..., None], linkage.output_pivot[..., None]
    starts = (
        0.0 * one,
        -1j * o2 * one,
        state.velocity.a - 1j * turns[2] * state.position.a,
        -1j * turns[3] * o4,
    )
    return turns, starts


@pytest.mark.slow
def test_two_links_have_one_velocity_at_their_instant_center() -> None:
    _, linkage, theta, sign = sample(71, margin=1e-2)
    found = instant_centers(linkage, theta, sign)
    assert found.valid.all()
    assert found.finite.all()
    assert np.isnan(found.direction).all()
    turns, starts = rates_of(linkage, theta, sign)
    for k, (i, j) in enumerate(PAIRS):
        point = found.point[..., k]
        one, other = (starts[link - 1] + 1j * turns[link - 1] * point for link in (i, j))
        scale = sum(np.abs(starts[link - 1]) + np.abs(turns[link - 1] * point) for link in (i, j))
        assert (np.abs(one - other) / (scale + 1e-300)).max() < 1e-10


def test_three_centers_of_three_links_are_on_a_line() -> None:
    """Kennedy's theorem, for all four triples of links."""
    _, linkage, theta, sign = sample(72, margin=1e-2)
    found = instant_centers(linkage, theta, sign)
    for links in ((1, 2, 3), (1, 2, 4), (1, 3, 4), (2, 3, 4)):
        x, y, z = (found.point[..., k] for k, pair in enumerate(PAIRS) if set(pair) <= set(links))
        base, other = y - x, z - x
        assert (np.abs(cross(base, other)) / (np.abs(base) * np.abs(other))).max() < 1e-9


def test_parallelogram_has_its_centers_at_infinity() -> None:
    theta = np.linspace(0.3, 2.8, 20)
    found = instant_centers(PARALLELOGRAM, theta)
    assert found.valid.all()
    finite = dict(zip(PAIRS, np.moveaxis(found.finite, -1, 0), strict=True))
    for pair in PAIRS:
        assert (finite[pair] == (pair not in {(1, 3), (2, 4)})).all()
    np.testing.assert_array_equal(np.isnan(found.point), ~found.finite)
    np.testing.assert_array_equal(np.isnan(found.direction), found.finite)
    assert np.abs(cross(found.direction[:, 1], np.exp(1j * theta))).max() < 1e-12
    assert np.abs(found.direction[:, 4].imag).max() < 1e-12
    at = find_pole(PARALLELOGRAM, theta)
    assert at.valid.all()
    assert not at.finite.any()
    for values in at[2:]:
        assert np.isnan(values).all()
    assert not bresse_circles(PARALLELOGRAM, theta).finite.any()
    path = compute_path_curvature(PARALLELOGRAM, theta)
    np.testing.assert_allclose(path.curvature, 0.5, rtol=1e-12)
    np.testing.assert_allclose(path.center, 1.0 + 3.0j, rtol=1e-12)
    np.testing.assert_allclose(velocity_ratio(PARALLELOGRAM, theta).value, 1.0, rtol=1e-12)


def test_change_point_has_no_instant_centers() -> None:
    for found in (
        instant_centers(PARALLELOGRAM, 0.0),
        find_pole(PARALLELOGRAM, np.pi),
        compute_path_curvature(PARALLELOGRAM, 0.0),
    ):
        assert not found.valid
    for ratio in (velocity_ratio, torque_ratio):
        assert not ratio(PARALLELOGRAM, 0.0).finite
    assert np.isnan(instant_centers(PARALLELOGRAM, 0.0).point).all()


def test_no_configuration_no_answer() -> None:
    rocker = Fourbar.from_lengths(6.0, 2.0, 3.0, 4.0, 1j)
    for call in (instant_centers, find_pole, compute_path_curvature):
        found = call(rocker, [np.pi, 1.0])
        assert not found.valid[0]
        assert np.isnan(found[2][0]).all() or not found[2][0].any()
    for call in (velocity_ratio, torque_ratio, bresse_circles):
        assert not call(rocker, np.pi).finite


@pytest.mark.parametrize("sign", [OPEN_ASSEMBLY, CROSSED_ASSEMBLY])
def test_pole_at_a_toggle_is_the_input_pin(sign: int) -> None:
    """There the input stands and the coupler turns about A; ω4/ω2 is infinite, ω2/ω4 nothing."""
    rocker = Fourbar.from_lengths(6.0, 10.0, 7.0, 4.0, 2.0 + 3.0j)
    theta = find_toggle_angles(rocker)
    assert theta.size == 2
    found, at = find_pole(rocker, theta, sign), positions(rocker, theta, sign)
    assert found.finite.all()
    assert np.abs(found.point - at.a).max() < 1e-6
    path = compute_path_curvature(rocker, theta, sign)
    assert path.curved.all()
    near = compute_path_curvature(rocker, theta * (1.0 + 1e-9), sign)
    np.testing.assert_allclose(path.curvature, near.curvature, rtol=1e-3)
    assert not velocity_ratio(rocker, theta, sign).finite.any()
    torque = torque_ratio(rocker, theta, sign)
    assert torque.finite.all()
    assert np.abs(torque.value).max() < 1e-6


# -- pole and centrodes ------------------------------------------------------------------------------------------------


def test_pole_does_not_move() -> None:
    _, linkage, theta, sign = sample(73, margin=1e-2)
    at, state = find_pole(linkage, theta, sign), motion(linkage, theta, sign)
    assert at.finite.all()
    turn = 1j * state.velocity.coupler * (at.point - state.position.a)
    assert (np.abs(state.velocity.a + turn) / np.abs(state.velocity.a)).max() < 1e-10
    arm = (state.position.b - state.position.a) / linkage.coupler[:, None]
    error = np.abs(state.position.a + at.moving * arm - at.point) / (np.abs(at.moving) + size_of(linkage))
    assert error.max() < 1e-10


def test_pole_as_coupler_point_stands_still() -> None:
    _, linkage, theta, sign = sample(74, margin=0.1, m=1, share=0.7)
    at = find_pole(linkage, theta, sign)
    pinned = with_point(linkage, at.moving[:, 0])
    speed = np.abs(motion(pinned, theta, sign).velocity.p)[:, 0] / linkage.input
    assert np.quantile(speed, 0.999) < 1e-10
    assert (~compute_path_curvature(pinned, theta, sign).valid).mean() > 0.99


@pytest.mark.slow
def test_centrodes_roll_without_slip() -> None:
    """Both have the same velocity at the pole, which ``rate`` is, per radian of the coupler."""
    _, linkage, theta, sign = sample(75, margin=0.1, share=0.6)
    at, state = find_pole(linkage, theta, sign), motion(linkage, theta, sign)
    calm = (np.abs(state.velocity.coupler) > 0.03) & (np.abs(at.point - state.position.a) < 10.0 * size_of(linkage))
    assert calm.mean() > 0.6
    fixed = derivative(lambda h: find_pole(linkage, theta + h, sign).point, 1, 3e-4)
    moving = derivative(lambda h: find_pole(linkage, theta + h, sign).moving, 1, 3e-4)
    turned = moving * np.exp(1j * state.position.coupler_angle)
    expected = at.rate * state.velocity.coupler
    scale = np.abs(expected) + size_of(linkage)
    assert np.quantile((np.abs(fixed - expected) / scale)[calm], 0.99) < 1e-8
    assert np.quantile((np.abs(fixed - turned) / scale)[calm], 0.99) < 1e-8
    np.testing.assert_allclose(at.inflection_diameter, np.abs(at.rate))


def test_centrodes_have_equal_arcs() -> None:
    """Between any two poles, measured along the sampled curves."""
    linkage = Fourbar.from_lengths(5.0, 2.0, 5.0, 4.0)
    theta = np.linspace(1.32, 1.7, 20_001)
    at = find_pole(linkage, theta)
    assert at.finite.all()
    fixed, moving = (np.abs(np.diff(curve)) for curve in (at.point, at.moving))
    assert fixed.sum() > 1.0
    np.testing.assert_allclose(np.cumsum(fixed), np.cumsum(moving), rtol=1e-7)


def test_centrodes_of_equal_opposite_cranks_are_ellipses() -> None:
    """Crossed equal cranks, the longer links equal: the centrodes are congruent ellipses with foci at the pivots."""
    linkage = Fourbar.from_lengths(3.0, 2.0, 3.0, 2.0)
    theta = np.linspace(0.2, 2.9, 50)
    at = find_pole(linkage, theta, CROSSED_ASSEMBLY)
    assert at.finite.all()
    np.testing.assert_allclose(np.abs(at.point) + np.abs(at.point - 2.0), 3.0, rtol=1e-12)
    np.testing.assert_allclose(np.abs(at.moving) + np.abs(at.moving - 2.0), 3.0, rtol=1e-12)


# -- curvature ---------------------------------------------------------------------------------------------------------


def test_curvature_is_that_of_the_path() -> None:
    """Against velocity and acceleration, and against finite differences of the positions alone."""
    _, linkage, theta, sign = sample(81, margin=3e-2, share=0.9)
    state, found = motion(linkage, theta, sign), compute_path_curvature(linkage, theta, sign)
    velocity, acceleration = state.velocity.p, state.acceleration.p
    size = size_of(linkage)
    moving = np.abs(velocity) > 1e-2 * size
    assert found.valid.all()
    expected = cross(velocity, acceleration) / np.abs(velocity) ** 3
    scale = np.abs(expected) + 1.0 / size
    assert (np.abs(found.curvature - expected) / scale)[moving].max() < 1e-9
    first = derivative(lambda h: positions(linkage, theta + h, sign).p, 1, 1e-3)
    second = derivative(lambda h: positions(linkage, theta + h, sign).p, 2, 1e-3)
    sampled = cross(first, second) / np.abs(first) ** 3
    assert np.quantile((np.abs(found.curvature - sampled) / scale)[moving], 0.98) < 1e-6
    bent = found.curved & moving
    radius = np.abs(found.center - state.position.p)
    np.testing.assert_allclose((radius * np.abs(found.curvature))[bent], 1.0, rtol=1e-9)
    left = cross(velocity, found.center - state.position.p)
    assert np.all((np.sign(left) == np.sign(found.curvature))[bent])
    along = (velocity.conj() * (found.center - state.position.p)).real / (np.abs(velocity) * radius)
    assert np.abs(along[bent]).max() < 1e-9


@pytest.mark.slow
def test_euler_savary() -> None:
    """|XI|² = |XC| |XJ| along the ray from the pole I through X; J on the inflection circle, C the centre."""
    _, linkage, theta, sign = sample(82, margin=3e-2, share=0.9)
    at, found = find_pole(linkage, theta, sign), compute_path_curvature(linkage, theta, sign)
    point = positions(linkage, theta, sign).p
    ray, length = (point - at.point) / np.abs(point - at.point), np.abs(point - at.point)
    to_circle = ((at.inflection_pole - at.point) * ray.conj()).real
    to_center = length**2 / (length - to_circle)
    center = point - ray * to_center
    scale = np.abs(center - point) + size_of(linkage)
    near = found.curved & (length > 1e-3 * size_of(linkage)) & (length < 1e3 * size_of(linkage))
    assert near.mean() > 0.9
    assert np.quantile((np.abs(center - found.center) / scale)[near], 0.999) < 1e-9


def test_moving_pivots_run_on_circles() -> None:
    _, linkage, theta, sign = sample(83, margin=1e-2)
    for point, center in ((0.0, linkage.input_pivot), (linkage.coupler, linkage.output_pivot)):
        found = compute_path_curvature(with_point(linkage, point), theta, sign)
        assert found.valid.mean() > 0.999
        error = np.abs(found.center - center[:, None])[found.valid]
        assert np.quantile(error, 0.99) < 1e-9
    np.testing.assert_allclose(
        compute_path_curvature(with_point(linkage, 0.0), theta, sign).curvature * linkage.input[:, None], 1.0, rtol=1e-6
    )


def test_points_of_the_inflection_circle_run_straight() -> None:
    rng, linkage, theta, sign = sample(84, margin=0.1, m=1, share=0.7)
    at, state = find_pole(linkage, theta, sign), positions(linkage, theta, sign)
    turn = np.exp(1j * rng.uniform(0.3, 2.0 * np.pi - 0.3, theta.shape))
    center = 0.5 * (at.point + at.inflection_pole)
    chosen = center + (at.point - center) * turn
    arm = (state.b - state.a) / linkage.coupler[:, None]
    near = (np.abs(chosen - state.a) < 10.0 * size_of(linkage))[:, 0]
    found = compute_path_curvature(with_point(linkage, ((chosen - state.a) / arm)[:, 0]), theta, sign)
    straight = np.abs(found.curvature * size_of(linkage))[near, 0]
    assert near.mean() > 0.7
    assert np.quantile(straight, 0.99) < 1e-8
    assert np.median(straight) < 1e-12


def test_watt_linkage_has_an_inflection_at_the_middle() -> None:
    """Both rockers level, the middle of the coupler on its straight line."""
    linkage = Fourbar(0.0, 6.0 + 2.0j, 3.0, 2.0, 3.0, 1.0)
    for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY):
        at = positions(linkage, 0.0, sign)
        if abs(at.b - (3.0 + 2.0j)) < 1e-9:
            found = compute_path_curvature(linkage, 0.0, sign)
            assert found.valid
            assert abs(found.curvature) < 1e-12
            assert not found.curved
            assert np.isnan(found.center)
            break
    else:
        pytest.fail("the linkage does not stand in its middle position")


def test_curvature_where_the_coupler_does_not_turn() -> None:
    """Input and output parallel, no pole: the curvature is still that of the path."""
    rng = np.random.default_rng(85)
    n = 2000
    u = np.exp(1j * rng.uniform(-np.pi, np.pi, n)) * rng.uniform(0.5, 2.0, n)
    w = u * rng.uniform(0.3, 3.0, n) * rng.choice([1.0, -1.0], n)
    v = np.exp(1j * rng.uniform(-np.pi, np.pi, n)) * rng.uniform(0.5, 2.0, n)
    point = rng.normal(size=n) + 1j * rng.normal(size=n)
    linkage = Fourbar(0.0, u + v - w, np.abs(u), np.abs(v), np.abs(w), point)
    sign = np.where(cross(v, w) > 0.0, OPEN_ASSEMBLY, CROSSED_ASSEMBLY)
    theta = np.angle(u)[:, None]
    sound = (np.abs(cross(v, w)) > 0.2 * np.abs(v) * np.abs(w))[:, None]
    found, state = compute_path_curvature(linkage, theta, sign), motion(linkage, theta, sign)
    expected = cross(state.velocity.p, state.acceleration.p) / np.abs(state.velocity.p) ** 3
    assert np.abs(found.curvature - expected)[sound].max() < 1e-9
    at = find_pole(linkage, theta, sign)
    assert at.valid.all()
    assert (np.abs(at.point[at.finite & sound]) > 1e10).all()
    assert (~at.finite)[sound].mean() > 0.9


@pytest.mark.slow
def test_bresse_circles() -> None:
    """At constant input speed: no normal acceleration on one, no tangential acceleration on the other."""
    rng, linkage, theta, sign = sample(86, margin=3e-2, share=0.9)
    at, found, state = (
        find_pole(linkage, theta, sign),
        bresse_circles(linkage, theta, sign),
        motion(linkage, theta, sign),
    )
    assert found.finite.all()
    assert found.circle.mean() > 0.999
    turn = np.exp(1j * rng.uniform(0.3, 2.0 * np.pi - 0.3, theta.shape))
    for center, part in ((found.inflection, "imag"), (found.tangential, "real")):
        use = found.circle
        arm = center + (at.point - center) * turn - state.position.a
        spin, surge = state.velocity.coupler, state.acceleration.coupler
        velocity = state.velocity.a + 1j * spin * arm
        acceleration = state.acceleration.a + (1j * surge - spin**2) * arm
        share = getattr(velocity.conj() * acceleration, part) / (np.abs(velocity) * np.abs(acceleration))
        assert np.quantile(np.abs(share)[use], 0.999) < 1e-9


# -- ratios ------------------------------------------------------------------------------------------------------------


def test_ratios() -> None:
    """ω4/ω2 of the motion; its inverse for torque; both from instant centre 24 and from sines of angles."""
    _, linkage, theta, sign = sample(91, margin=1e-2)
    speed, torque = velocity_ratio(linkage, theta, sign), torque_ratio(linkage, theta, sign)
    assert speed.finite.all()
    output = motion(linkage, theta, sign).velocity.output
    np.testing.assert_allclose(speed.value, output, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose((speed.value * torque.value)[torque.finite], 1.0, rtol=1e-12)
    assert torque.finite.mean() > 0.999
    center = instant_centers(linkage, theta, sign).point[..., 4]
    base = (linkage.output_pivot - linkage.input_pivot)[:, None]
    by_center = ((center - linkage.input_pivot[:, None]) / base).real
    by_center = by_center / (by_center - 1.0)
    error = np.abs(by_center - speed.value) / (1.0 + np.abs(speed.value))
    assert np.quantile(error, 0.99) < 1e-9
    at = positions(linkage, theta, sign)
    nu = np.abs(np.sin(at.coupler_angle - theta))
    mu = np.sin(transmission_angle(linkage, theta))
    size = linkage.output[:, None] * mu / (linkage.input[:, None] * nu)
    np.testing.assert_allclose(np.abs(torque.value)[torque.finite], size[torque.finite], rtol=1e-6)


def test_mechanical_advantage() -> None:
    theta = np.linspace(0.1, 6.0, 12)
    torque = torque_ratio(CRANK_ROCKER, theta)
    found = mechanical_advantage(CRANK_ROCKER, theta, input_radius=3.0, output_radius=12.0)
    np.testing.assert_allclose(found.value, 0.25 * torque.value)
    np.testing.assert_array_equal(found.finite, torque.finite)
    many = mechanical_advantage(CRANK_ROCKER, theta, input_radius=np.ones((3, 1)), output_radius=1.0)
    assert many.value.shape == many.finite.shape == (3, 12)
    for name in ("input_radius", "output_radius"):
        for bad in (0.0, -1.0, np.nan, np.inf):
            with pytest.raises(DimensionError, match=f"^{name} must be positive and finite"):
                mechanical_advantage(CRANK_ROCKER, 1.0, **{"input_radius": 1.0, "output_radius": 1.0, name: bad})
    with pytest.raises(ShapeError, match="broadcast"):
        mechanical_advantage(CRANK_ROCKER, theta, input_radius=np.ones(5), output_radius=1.0)


def test_torque_ratio_at_a_dead_point_of_the_output() -> None:
    """Crank and coupler in line: the output stands, and the torque ratio has no bound."""
    d, c, reach = 6.0, 9.0, 2.0 + 7.0
    theta = np.arccos((d**2 + reach**2 - c**2) / (2.0 * d * reach))
    found = torque_ratio(CRANK_ROCKER, [theta, theta + 0.1])
    np.testing.assert_array_equal(found.finite, [False, True])
    assert np.isnan(found.value[0])
    speed = velocity_ratio(CRANK_ROCKER, theta)
    assert speed.finite
    assert abs(speed.value) < 1e-12


# -- invariance and batches --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_similar_linkages_have_similar_motions(scale: float) -> None:
    _, linkage, theta, sign = sample(95, margin=3e-2, n=1000, share=0.9)
    turn, shift = np.exp(0.7j), 3.0 - 1.0j
    other = Fourbar(
        scale * turn * (linkage.input_pivot + shift),
        scale * turn * (linkage.output_pivot + shift),
        *(scale * x for x in (linkage.input, linkage.coupler, linkage.output, linkage.coupler_point)),
    )
    here, there = find_pole(linkage, theta, sign), find_pole(other, theta + 0.7, sign)
    size = np.abs(here.point) + np.abs(here.rate) + size_of(linkage)
    for name in ("point", "inflection_pole"):
        moved = scale * turn * (getattr(here, name) + shift)
        error = np.abs(getattr(there, name) - moved) / (scale * size)
        assert np.quantile(error, 0.99) < 1e-8
    assert np.quantile(np.abs(there.moving / scale - here.moving) / size, 0.99) < 1e-8
    assert np.quantile(np.abs(there.inflection_diameter / scale - here.inflection_diameter) / size, 0.99) < 1e-8
    path, also = compute_path_curvature(linkage, theta, sign), compute_path_curvature(other, theta + 0.7, sign)
    error = np.abs(also.curvature * scale - path.curvature) * size_of(linkage)
    assert np.quantile(error / (1.0 + np.abs(path.curvature) * size_of(linkage)), 0.99) < 1e-8
    np.testing.assert_allclose(
        velocity_ratio(other, theta + 0.7, sign).value, velocity_ratio(linkage, theta, sign).value, rtol=1e-5, atol=1e-7
    )


def test_batches_equal_single_designs() -> None:
    rng = np.random.default_rng(96)
    batch = random_fourbars(rng, 6)
    linkage = Fourbar(*(getattr(batch, name).reshape(2, 3) for name in FIELDS))
    theta, sign = rng.uniform(-3.0, 3.0, 5), signs(rng, 2, 3)
    calls = (
        find_pole,
        bresse_circles,
        compute_path_curvature,
        velocity_ratio,
        torque_ratio,
        instant_centers,
        lambda *x: mechanical_advantage(*x, input_radius=2.0, output_radius=3.0),
    )
    for call in calls:
        together = call(linkage, theta, sign)
        for index in np.ndindex(2, 3):
            for whole, part in zip(together, call(take(linkage, index), theta, sign[index]), strict=True):
                assert whole.shape[:3] == (2, 3, 5)
                assert part.shape == whole.shape[2:]
                np.testing.assert_allclose(whole[index], part, rtol=1e-10, atol=1e-10)
        for values in call(CRANK_ROCKER, 0.5):
            assert values.shape in {(), (6,)}
        with pytest.raises(ShapeError, match="broadcast"):
            call(linkage, np.zeros((4, 5)), OPEN_ASSEMBLY)
        with pytest.raises(DimensionError, match=r"^assembly must be"):
            call(linkage, theta, 0)


def test_numbers_are_finite_where_they_are_valid() -> None:
    """Anywhere on the circle, toggles and parallel links included, without a floating-point warning."""
    rng = np.random.default_rng(97)
    linkage = random_fourbars(rng, 2000)
    theta = rng.uniform(-np.pi, np.pi, (2000, 10))
    with np.errstate(all="raise", under="ignore"):
        for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY):
            at, path = find_pole(linkage, theta, sign), compute_path_curvature(linkage, theta, sign)
            circles, centers = bresse_circles(linkage, theta, sign), instant_centers(linkage, theta, sign)
            ratios = (velocity_ratio(linkage, theta, sign), torque_ratio(linkage, theta, sign))
            masks = [(at.finite, values) for values in at[2:]]
            masks += [(path.valid, path.curvature), (path.curved, path.center)]
            masks += [(circles.finite, circles.inflection), (circles.circle, circles.tangential)]
            masks += [(centers.finite, centers.point), *ratios]
            for mask, values in masks:
                np.testing.assert_array_equal(np.isfinite(values), mask)
