"""The slider-crank: printed numbers, closure, derivatives, invariance, toggles, and what callers may rely on."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from kinematics.errors import DimensionError, ShapeError
from kinematics.linkage.batch import CROSSED_ASSEMBLY, OPEN_ASSEMBLY
from kinematics.linkage.slider_crank.closed_form import (
    SliderCrank,
    coupler_points,
    find_crank_limits,
    find_toggle_angles,
    has_full_rotation,
    motion,
    positions,
)
from tests.cases import Case, cases
from tests.kinematics.sampling import signs
from tests.oracles.differences import derivative
from tests.support.kinematics.kernels import random_slider_cranks

ASSEMBLY = {"open": OPEN_ASSEMBLY, "crossed": CROSSED_ASSEMBLY}
N = 5000


def linkage_of(case: Case) -> SliderCrank:
    return SliderCrank.from_lengths(case.inputs["a"], case.inputs["b"], case.inputs["c"])


def polar(vector: complex) -> tuple[float, float]:
    return abs(vector), float(np.degrees(np.angle(vector)))


# -- literature --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", cases("slider_crank_position"))
def test_position(case: Case) -> None:
    """Norton measures θ3 at the slider, from B to A."""
    at = positions(linkage_of(case), np.radians(case.inputs["theta2"]), ASSEMBLY[case.inputs["circuit"]])
    case.check(theta3=np.degrees(at.coupler_angle) + 180.0, d=at.travel)


@pytest.mark.parametrize("case", cases("slider_crank_velocity"))
def test_velocity(case: Case) -> None:
    x = case.inputs
    found = motion(linkage_of(case), np.radians(x["theta2"]), ASSEMBLY[x["circuit"]], speed=x["omega2"]).velocity
    size, angle = polar(complex(found.a))
    case.check(VA_mag=size, VA_ang=angle, omega3=found.coupler, VB=found.travel)


@pytest.mark.parametrize("case", cases("slider_crank_acceleration"))
def test_acceleration(case: Case) -> None:
    x = case.inputs
    angle, sign = np.radians(x["theta2"]), ASSEMBLY[x["circuit"]]
    found = motion(linkage_of(case), angle, sign, speed=x["omega2"], acceleration=x["alpha2"]).acceleration
    (size_a, angle_a), (size_b, angle_b) = polar(complex(found.a)), polar(complex(found.b))
    case.check(AA_mag=size_a, AA_ang=angle_a, alpha3=found.coupler, AB_mag=size_b, AB_ang=angle_b)


# -- laws --------------------------------------------------------------------------------------------------------------


def sample(seed: int) -> tuple[SliderCrank, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return random_slider_cranks(rng, N), rng.uniform(-7.0, 7.0, (N, 3)), signs(rng, N)


def test_links_are_rigid_and_the_slider_is_on_the_slide() -> None:
    linkage, theta, sign = sample(91)
    at = positions(linkage, theta, sign)
    ok = at.valid
    assert 0.3 < ok.mean() < 0.95
    pivot, along = linkage.pivot[:, None], np.exp(1j * linkage.slide_angle)[:, None]
    arm = at.b - at.a
    for gap in (
        np.abs(at.a - pivot) - linkage.crank[:, None],
        np.abs(arm) - linkage.coupler[:, None],
        np.abs(at.b - (linkage.slide_point[:, None] + along * at.travel)),
        np.abs(np.exp(1j * theta) * linkage.crank[:, None] - (at.a - pivot)),
        at.p - at.a - linkage.coupler_point[:, None] * arm / linkage.coupler[:, None],
        np.exp(1j * at.coupler_angle) * linkage.coupler[:, None] - arm,
    ):
        assert np.abs(gap[ok]).max() < 1e-12
    assert np.all(((arm / along).real * sign[:, None])[ok] >= -1e-12)


def test_invalid_means_that_the_coupler_is_too_short() -> None:
    linkage, theta, _ = sample(92)
    at = positions(linkage, theta)
    pin = linkage.pivot[:, None] + linkage.crank[:, None] * np.exp(1j * theta)
    height = ((pin - linkage.slide_point[:, None]) * np.exp(-1j * linkage.slide_angle)[:, None]).imag
    np.testing.assert_array_equal(at.valid, np.abs(height) <= linkage.coupler[:, None])


def test_moves_with_rotation_translation_and_scale() -> None:
    linkage, theta, sign = sample(93)
    for scale in (1e-9, 1.0, 1e9):
        place, shift = scale * np.exp(0.7j), 3.0 - 2.0j
        moved = SliderCrank(
            place * (linkage.pivot + shift),
            place * (linkage.slide_point + shift),
            linkage.slide_angle + 0.7,
            *(scale * x for x in (linkage.crank, linkage.coupler, linkage.coupler_point)),
        )
        here, there = motion(linkage, theta, sign), motion(moved, theta + 0.7, sign)
        ok = here.velocity.valid & (np.abs(np.cos(here.position.coupler_angle - linkage.slide_angle[:, None])) > 1e-2)
        assert np.all(there.velocity.valid[ok])
        for name in ("a", "b", "p"):
            gap = getattr(there.position, name) / place - shift - getattr(here.position, name)
            assert np.abs(gap[ok]).max() < 1e-9
        for one, other in zip(here[1:], there[1:], strict=True):
            np.testing.assert_allclose(other.coupler[ok], one.coupler[ok], rtol=1e-7, atol=1e-9)
            np.testing.assert_allclose(other.travel[ok] / scale, one.travel[ok], rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize(("order", "step", "close"), [(1, 4e-3, 1e-11), (2, 6e-3, 1e-9), (3, 4e-3, 1e-6)])
def test_derivatives_agree_with_differences(order: int, step: float, close: float) -> None:
    """θ2(t) = θ + w t + α t²/2 + j t³/6, differentiated through the positions at time 0."""
    linkage, theta, sign = sample(94)
    at = positions(linkage, theta, sign)
    calm = np.abs(np.cos(at.coupler_angle - linkage.slide_angle[:, None])) > 0.6
    calm &= (linkage.crank < linkage.coupler)[:, None]
    use = np.flatnonzero(calm[:, 0])
    assert use.size > N // 8
    fields = ("pivot", "slide_point", "slide_angle", "crank", "coupler", "coupler_point")
    linkage = SliderCrank(*(getattr(linkage, name)[use] for name in fields))
    theta, sign = theta[use, 0], sign[use]
    w, alpha, jerk = 0.8, -0.6, 0.9

    def at_time(time: float) -> np.ndarray:
        moved = theta + w * time + alpha * time**2 / 2 + jerk * time**3 / 6
        found = positions(linkage, moved[:, None], sign)
        turned = np.angle((found.b - found.a) / np.exp(1j * at.coupler_angle[use, :1]))
        return np.stack([found.a, found.b, found.p, found.travel + 0j, turned + 0j])[..., 0]

    found = motion(linkage, theta[:, None], sign, speed=w, acceleration=alpha, jerk=jerk)[order]
    for name, expected in zip(("a", "b", "p", "travel", "coupler"), derivative(at_time, order, step), strict=True):
        got = getattr(found, name)[:, 0]
        scale = 1.0 + np.abs(expected) + np.abs(found.coupler[:, 0]) ** 2
        assert np.abs((got - expected) / scale).max() <= close, name


# -- toggles -----------------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_limits_are_where_positions_end() -> None:
    linkage, _, _ = sample(95)
    limits, crank, turn = find_crank_limits(linkage), has_full_rotation(linkage), np.linspace(-np.pi, np.pi, 721)
    at = positions(linkage, turn)
    assert at.valid[crank].all()
    none = np.isnan(limits.lower)
    assert not at.valid[none].any()
    assert 0.2 < crank.mean() < 0.8
    height = linkage.crank[:, None] * np.sin(turn - linkage.slide_angle[:, None])
    inside = (height > limits.lower[:, None] + 1e-9) & (height < limits.upper[:, None] - 1e-9)
    outside = (height < limits.lower[:, None] - 1e-9) | (height > limits.upper[:, None] + 1e-9)
    assert at.valid[inside].all()
    assert not at.valid[outside].any()
    np.testing.assert_array_equal(crank, ~none & ~limits.lower_toggle & ~limits.upper_toggle)


def test_toggle_angles_are_configurations_without_rates() -> None:
    linkage, _, _ = sample(96)
    met = set()
    for k in range(300):
        fields = ("pivot", "slide_point", "slide_angle", "crank", "coupler", "coupler_point")
        one = SliderCrank(*(getattr(linkage, name)[k] for name in fields))
        toggles = find_toggle_angles(one)
        met.add(toggles.size)
        assert np.all(np.diff(toggles) > 0.0)
        assert np.all((toggles > -np.pi) & (toggles <= np.pi))
        if toggles.size:
            around = positions(one, toggles[:, None] + np.array([-1e-6, 1e-6])).valid
            assert np.all(around.sum(axis=1) == 1)
            square = np.cos(positions(one, toggles).coupler_angle - one.slide_angle)
            assert np.all(np.abs(square) < 1e-6)
    assert met == {0, 2, 4}
    on = motion(SliderCrank.from_lengths(2.0, 1.0), np.pi / 6)
    assert on.position.valid
    assert not on.velocity.valid


# -- contract ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("crank", 0.0),
        ("crank", [1.0, np.nan]),
        ("coupler", -1.0),
        ("coupler", np.inf),
        ("pivot", np.nan),
        ("slide_point", complex(0.0, np.inf)),
        ("slide_angle", np.inf),
        ("coupler_point", np.nan),
    ],
)
def test_impossible_field_is_refused_by_name(field: str, value: object) -> None:
    good = {"pivot": 0.0, "slide_point": 1j, "slide_angle": 0.0, "crank": 1.0, "coupler": 3.0, "coupler_point": 0.0}
    with pytest.raises(DimensionError, match=f"^{field} must be"):
        SliderCrank(**{**good, field: value})


def test_wrong_calls_are_refused() -> None:
    linkage = SliderCrank.from_lengths([1.0, 1.1, 1.2], 3.0, 0.4)
    with pytest.raises(DimensionError, match=r"^assembly"):
        positions(linkage, 0.1, 0)
    for call in (
        lambda: SliderCrank.from_lengths([1.0, 2.0, 3.0], [1.0, 2.0]),
        lambda: positions(linkage, np.zeros((2, 5))),
        lambda: positions(linkage, 0.1, np.ones(2)),
        lambda: motion(linkage, np.zeros(5), speed=np.ones(4)),
    ):
        with pytest.raises(ShapeError, match="broadcast"):
            call()


def test_value_and_shapes() -> None:
    linkage = SliderCrank.from_lengths([1.0, 1.1], 3.0, 0.4, 1j)
    with pytest.raises(ValueError, match="read-only"):
        linkage.crank[0] = 5.0
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(linkage)).offset, [0.4, 0.4])
    one = SliderCrank.from_lengths(1.0, 3.0, 0.4, 1j)
    assert positions(one, 0.5).p.shape == ()
    assert positions(one, np.zeros(4), [1, -1]).travel.shape == (2, 4)
    assert motion(linkage, 0.5).jerk.travel.shape == (2, 1)
    assert motion(linkage, np.zeros(4), speed=np.ones((3, 1, 1))).velocity.b.shape == (3, 2, 4)
    assert positions(SliderCrank.from_lengths(np.ones(0), 2.0), np.zeros(4)).b.shape == (0, 4)
    several, theta = positions(linkage, np.linspace(0.0, 6.0, 9), [1, -1]), np.linspace(0.0, 6.0, 9)
    np.testing.assert_allclose(coupler_points(linkage, theta, [1, -1]).p, several.p, rtol=1e-12)
    for k, sign in enumerate((1, -1)):
        alone = positions(SliderCrank.from_lengths(linkage.crank[k], 3.0, 0.4, 1j), theta, sign)
        np.testing.assert_allclose(several.p[k], alone.p, rtol=1e-12)
