"""Laws that hold for every fourbar: rigidity, symmetry, derivatives, and the extremes of the transmission angle."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    can_assemble,
    find_input_limits,
    find_toggle_angles,
    find_transmission_extremes,
    motion,
    positions,
    transmission_angle,
)
from tests.kinematics.sampling import assembled_angles, hand_of_b, random_fourbars, signs, take
from tests.oracles.differences import derivative
from tests.oracles.positions import all_pins, meet

BATCH = 10_000
CLOSURE = 1e-12
"""Misfit of a rigid length as a share of the largest length or coordinate in play."""

length = st.floats(0.01, 100.0)
angle = st.floats(-10.0, 10.0)
point = st.builds(complex, st.floats(-50.0, 50.0), st.floats(-50.0, 50.0))
assembly = st.sampled_from([OPEN_ASSEMBLY, CROSSED_ASSEMBLY])


@st.composite
def fourbars(draw: st.DrawFn) -> Fourbar:
    """One fourbar, assembled or not, anywhere."""
    pivot = draw(point)
    ground = draw(length) * np.exp(1j * draw(angle))
    return Fourbar(pivot, pivot + ground, draw(length), draw(length), draw(length), draw(point))


@st.composite
def configurations(draw: st.DrawFn) -> tuple[Fourbar, float, int]:
    """A fourbar with an input angle and the assembly of a pin B that was chosen first, away from toggles."""
    o2, o4, theta = 0j, complex(draw(length) * np.exp(1j * draw(angle))), draw(angle)
    a, b = draw(length), draw(length)
    pin_a = a * np.exp(1j * theta)
    pin_b = pin_a + b * np.exp(1j * draw(angle))
    forward, towards = o4 - pin_a, pin_b - pin_a
    side = forward.real * towards.imag - forward.imag * towards.real
    c = abs(pin_b - o4)
    assume(c > 0.01 and abs(side) > 0.01 * b * c)
    shift = draw(point)
    return Fourbar(o2 + shift, o4 + shift, a, b, c, draw(point)), theta, OPEN_ASSEMBLY if side > 0 else CROSSED_ASSEMBLY


def batch(seed: int, gap: float = 0.0, n: int = BATCH) -> tuple[np.random.Generator, Fourbar]:
    rng = np.random.default_rng(seed)
    return rng, random_fourbars(rng, n, gap)


# -- position ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sign", [OPEN_ASSEMBLY, CROSSED_ASSEMBLY])
def test_loop_closes_with_rigid_links(sign: int) -> None:
    rng, linkage = batch(1)
    theta = rng.uniform(-10.0, 10.0, (BATCH, 8))
    at = positions(linkage, theta, sign)
    a, b, c, o2, o4, shape = (
        getattr(linkage, name)[:, None]
        for name in ("input", "coupler", "output", "input_pivot", "output_pivot", "coupler_point")
    )
    size = np.abs(o2) + np.abs(o4) + a + b + c + np.abs(shape)
    ok = at.valid
    assert 0.3 < ok.mean() < 0.9
    errors = [
        np.abs(at.a - o2) - a,
        np.abs(at.b - at.a) - b,
        np.abs(at.b - o4) - c,
        np.abs(at.a - o2 - a * np.exp(1j * theta)),
        np.abs(at.b - at.a - b * np.exp(1j * at.coupler_angle)),
        np.abs(at.b - o4 - c * np.exp(1j * at.output_angle)),
        np.abs(at.p - at.a - shape * np.exp(1j * at.coupler_angle)) * b / (b + np.abs(shape)),
    ]
    for error in errors:
        assert np.abs(error / size)[ok].max() <= CLOSURE


@pytest.mark.slow
def test_point_on_the_coupler_is_rigid() -> None:
    rng, linkage = batch(2)
    at = positions(linkage, assembled_angles(rng, linkage, 3), signs(rng, BATCH))
    arm = np.abs(linkage.coupler_point)[:, None]
    rod = np.abs(linkage.coupler_point - linkage.coupler)[:, None]
    np.testing.assert_allclose(np.abs(at.p - at.a), arm + 0.0 * np.abs(at.p), rtol=1e-10)
    np.testing.assert_allclose(np.abs(at.p - at.b), rod + 0.0 * np.abs(at.p), rtol=1e-10)


def test_open_is_left_and_crossed_is_right() -> None:
    rng, linkage = batch(3)
    theta = assembled_angles(rng, linkage, 3, margin=1e-4)
    for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY):
        at = positions(linkage, theta, sign)
        assert np.all(at.valid | np.isnan(theta))
        assert np.all((hand_of_b(linkage, at.a, at.b) == sign) | np.isnan(theta))


def test_positions_agree_with_root_finding() -> None:
    rng, linkage = batch(4)
    theta = assembled_angles(rng, linkage, 3, margin=1e-5)
    sign = signs(rng, BATCH)
    at = positions(linkage, theta, sign)
    found = meet(at.a, *(x[:, None] for x in (linkage.output_pivot, linkage.coupler, linkage.output, sign)))
    ok = ~np.isnan(theta)
    assert ok.mean() > 0.95
    assert np.abs(at.b - found)[ok].max() <= 1e-9


def test_valid_means_that_a_solver_from_many_starts_finds_a_pin() -> None:
    """SciPy's solver on the raw closure finds two pins where positions are valid and none where they are not."""
    rng, linkage = batch(5, n=40)
    theta = rng.uniform(-np.pi, np.pi, 40)
    both = {sign: positions(linkage, theta[:, None], sign) for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY)}
    counts = []
    for k in range(40):
        pin_a = complex(linkage.input_pivot[k] + linkage.input[k] * np.exp(1j * theta[k]))
        pins = all_pins(pin_a, complex(linkage.output_pivot[k]), float(linkage.coupler[k]), float(linkage.output[k]))
        counts.append(len(pins))
        assert len(pins) == 2 * both[OPEN_ASSEMBLY].valid[k, 0]
        for at in both.values():
            assert not at.valid[k, 0] or min(abs(pin - at.b[k, 0]) for pin in pins) < 1e-6
    assert {0, 2} == set(counts)


@given(fourbars(), st.lists(angle, min_size=1, max_size=5), assembly)
def test_never_nan_where_valid_and_always_nan_elsewhere(linkage: Fourbar, theta: list[float], sign: int) -> None:
    with np.errstate(all="raise", under="ignore"):
        found = motion(linkage, theta, sign, speed=2.0, acceleration=-1.0, jerk=0.5)
    for part in found:
        for values in part[1:]:
            assert values.shape == part.valid.shape
            np.testing.assert_array_equal(np.isfinite(values), part.valid)
    assert np.all(found.position.valid >= found.velocity.valid)


# -- invariance --------------------------------------------------------------------------------------------------------


@given(configurations(), angle, point, st.sampled_from([1e-9, 0.5, 1e9]))
def test_moves_with_rotation_translation_and_scale(
    configuration: tuple[Fourbar, float, int], turn: float, shift: complex, scale: float
) -> None:
    linkage, theta, sign = configuration
    size = float(np.abs([linkage.input, linkage.coupler, linkage.output, linkage.ground]).sum())
    place = scale * np.exp(1j * turn)
    moved = Fourbar(
        place * (linkage.input_pivot + shift),
        place * (linkage.output_pivot + shift),
        *(scale * x for x in (linkage.input, linkage.coupler, linkage.output, linkage.coupler_point)),
    )
    here, there = motion(linkage, theta, sign, speed=1.5), motion(moved, theta + turn, sign, speed=1.5)
    assert here.position.valid
    assert there.position.valid
    whole = size + abs(shift) + float(abs(linkage.input_pivot) + abs(linkage.coupler_point))
    close = 1e-9 * whole * (1.0 + abs(complex(linkage.coupler_point)) / float(linkage.coupler))
    for name in ("a", "b", "p"):
        before, after = getattr(here.position, name), getattr(there.position, name)
        assert abs(after / place - (before + shift)) <= close
    for before, after in zip(here[1:], there[1:], strict=True):
        assert after.output == pytest.approx(before.output, rel=1e-4, abs=1e-4)
        assert after.coupler == pytest.approx(before.coupler, rel=1e-4, abs=1e-4)


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_scale_changes_no_verdict(scale: float) -> None:
    _, linkage = batch(6)
    fields = (linkage.input_pivot, linkage.output_pivot, linkage.input, linkage.coupler, linkage.output)
    scaled = Fourbar(*(scale * field for field in fields))
    for one, other in zip(find_input_limits(linkage), find_input_limits(scaled), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-9)


def test_reflection_swaps_the_assemblies() -> None:
    rng, linkage = batch(7)
    theta = assembled_angles(rng, linkage, 3, margin=1e-4)
    mirror = Fourbar(
        linkage.input_pivot.conj(),
        linkage.output_pivot.conj(),
        linkage.input,
        linkage.coupler,
        linkage.output,
        linkage.coupler_point.conj(),
    )
    here, there = positions(linkage, theta, OPEN_ASSEMBLY), positions(mirror, -theta, CROSSED_ASSEMBLY)
    size = np.abs(here.b) + (np.abs(here.p) + 1.0) / linkage.coupler[:, None]
    assert np.nanmax(np.abs(here.b - there.b.conj()) / size) < 1e-9
    assert np.nanmax(np.abs(here.p - there.p.conj()) / size) < 1e-9


def test_exchanging_input_and_output_gives_the_same_configurations() -> None:
    """Driven at the other end with the output angle, a linkage comes back to its input angle."""
    rng, linkage = batch(8)
    theta = assembled_angles(rng, linkage, 1, margin=1e-3)
    at = positions(linkage, theta, signs(rng, BATCH))
    forward = linkage.input_pivot[:, None] - at.b
    side = np.sign(forward.real * (at.a - at.b).imag - forward.imag * (at.a - at.b).real)[:, 0]
    side = np.where(np.isnan(side) | (side == 0), 1, side).astype(int)
    fields = (linkage.output_pivot, linkage.input_pivot, linkage.output, linkage.coupler, linkage.input)
    back = positions(Fourbar(*fields), at.output_angle, side)
    sine = np.abs(np.sin(theta - at.coupler_angle))
    ok = ~np.isnan(theta) & (sine > 1e-3)
    assert ok.mean() > 0.9
    assert np.abs(back.b - at.a)[ok].max() < 1e-8


# -- derivatives -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("order", "step", "close"), [(1, 4e-3, 1e-11), (2, 6e-3, 1e-9), (3, 4e-3, 1e-6)])
def test_derivatives_agree_with_differences(order: int, step: float, close: float) -> None:
    """θ2(t) = θ + w t + α t²/2 + j t³/6, differentiated through the positions at time 0."""
    rng, linkage = batch(9)
    theta = assembled_angles(rng, linkage, 1)[:, 0]
    sign = signs(rng, BATCH)
    soft = np.nan_to_num(transmission_angle(linkage, theta[:, None])[:, 0]) > 0.35
    once = motion(linkage, theta[:, None], sign)
    calm = [
        np.abs(np.stack([part.coupler, part.output])[..., 0]).max(axis=0) < 4.0**k for k, part in enumerate(once[1:], 1)
    ]
    use = np.flatnonzero(soft & np.all(calm, axis=0))
    assert use.size > BATCH // 6
    linkage, theta, sign = take(linkage, use), theta[use], sign[use]
    w, alpha, jerk = 0.8, -0.6, 0.9

    def at(time: float) -> np.ndarray:
        moved = theta + w * time + alpha * time**2 / 2 + jerk * time**3 / 6
        found = positions(linkage, moved[:, None], sign)
        return np.stack([found.a, found.b, found.p, found.b - found.a, found.b - linkage.output_pivot[:, None]])[..., 0]

    found = motion(linkage, theta[:, None], sign, speed=w, acceleration=alpha, jerk=jerk)
    measured = derivative(at, order, step)
    for name, expected in zip(("a", "b", "p"), measured, strict=False):
        got = getattr(found[order], name)[:, 0]
        scale = 1.0 + np.abs(expected)
        assert np.abs((got - expected) / scale).max() <= close, name

    def turned(time: float) -> np.ndarray:
        links = at(time)[3:]
        return np.angle(links / at(0.0)[3:])

    for name, expected in zip(("coupler", "output"), derivative(turned, order, step), strict=True):
        got = getattr(found[order], name)[:, 0]
        assert np.abs((got - expected) / (1.0 + np.abs(expected))).max() <= close, name


def test_time_reversal_and_speed_scaling() -> None:
    """Twice the speed: velocities × 2, accelerations × 4, jerks × 8; running back: odd orders change sign."""
    rng, linkage = batch(10)
    theta = assembled_angles(rng, linkage, 1, margin=1e-2)
    one = motion(linkage, theta)
    for factor in (2.0, -1.0):
        other = motion(linkage, theta, speed=factor)
        for order in (1, 2, 3):
            for before, after in zip(one[order][1:], other[order][1:], strict=True):
                np.testing.assert_allclose(after, factor**order * before, rtol=1e-10)


def test_derivatives_are_withheld_at_a_toggle() -> None:
    """The position at the computed toggle angle exists; its sine is rounding alone, and no rate can be had from it."""
    for lengths in ((0.72, 0.68, 0.85, 1.82), (6.0, 10.0, 7.0, 4.0), (5.0, 2.0, 5.0, 4.0), (9.0, 7.0, 2.0, 6.0)):
        linkage = Fourbar.from_lengths(*lengths)
        assert find_toggle_angles(linkage).size in (2, 4)
        for toggle in find_toggle_angles(linkage):
            found = motion(linkage, toggle)
            assert found.position.valid
            assert not any(part.valid for part in found[1:])
            inside = motion(linkage, toggle + np.array([-1e-6, 1e-6]))
            np.testing.assert_array_equal(inside.velocity.valid, inside.position.valid)
            assert inside.velocity.valid.sum() == 1


# -- transmission ------------------------------------------------------------------------------------------------------


def test_transmission_angle_is_between_coupler_and_output() -> None:
    rng, linkage = batch(11)
    theta = assembled_angles(rng, linkage, 3)
    for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY):
        at = positions(linkage, theta, sign)
        sine = np.abs(np.sin(at.output_angle - at.coupler_angle))
        cosine = np.abs(np.cos(at.output_angle - at.coupler_angle))
        found = transmission_angle(linkage, theta)
        np.testing.assert_array_equal(np.isnan(found), ~at.valid)
        ok = at.valid
        assert np.abs(np.arctan2(sine, cosine) - found)[ok].max() < 1e-6
        assert np.abs(sine - np.sin(found))[ok & (cosine < 0.99)].max() < 1e-9


@pytest.mark.campaign
def test_extremes_bound_dense_samples_and_are_attained() -> None:
    rng, linkage = batch(12)
    start = rng.uniform(-10.0, 10.0, BATCH)
    end = start + rng.choice([-1.0, 1.0], BATCH) * np.where(rng.random(BATCH) < 0.2, 7.0, rng.uniform(0.0, 6.0, BATCH))
    least, greatest = find_transmission_extremes(linkage, start, end)
    share = np.linspace(0.0, 1.0, 721)
    dense = transmission_angle(linkage, start[:, None] + (end - start)[:, None] * share)
    broken = np.isnan(dense).any(axis=1)
    assert 0.2 < broken.mean() < 0.8
    assert np.all(least[broken] == 0.0)
    low, high = np.where(np.isnan(dense), np.inf, dense).min(axis=1), np.nan_to_num(dense).max(axis=1)
    assert np.all(least <= low + 1e-9)
    assert np.all(greatest >= high - 1e-9)
    whole = ~broken
    assert np.all(least[whole] >= low[whole] - 0.03)
    assert np.median(low[whole] - least[whole]) < 1e-4
    flat = whole & (low > 0.2) & (linkage.input > 0.05)
    assert np.all(low[flat] - least[flat] < 0.01)
    assert np.all((greatest <= high + 0.1) | ~whole)
    assert np.median((greatest - high)[whole]) < 1e-3


def test_extremes_at_the_ends_and_on_the_ground_line_are_exact() -> None:
    """A crank over a full turn: the extremes are where it lies along the ground line."""
    _, linkage = batch(13)
    limits = find_input_limits(linkage)
    cranks = take(linkage, np.flatnonzero(~limits.folded_toggle & ~limits.extended_toggle))
    both = cranks.ground_angle[:, None] + np.array([0.0, np.pi])
    least, _ = find_transmission_extremes(cranks, 0.3, 0.3 + 2.0 * np.pi)
    np.testing.assert_allclose(least, transmission_angle(cranks, both).min(axis=1), atol=1e-12)
    point_least, point_greatest = find_transmission_extremes(cranks, 1.1, 1.1)
    alone = transmission_angle(cranks, np.array([1.1]))[:, 0]
    np.testing.assert_allclose(point_least, alone, atol=1e-9)
    np.testing.assert_allclose(point_greatest, alone, atol=1e-9)


def test_greatest_counts_the_part_that_can_be_assembled() -> None:
    """A range that starts beyond the folded toggle still passes the right angle on its way."""
    linkage = Fourbar.from_lengths(2.0, 2.0, 1.0, 2.5)
    lower = float(find_input_limits(linkage).lower)
    least, greatest = find_transmission_extremes(linkage, lower - 0.2, np.pi)
    assert (float(least), float(greatest)) == (0.0, pytest.approx(np.pi / 2))
    assert [float(x) for x in find_transmission_extremes(linkage, -lower + 0.1, lower - 0.1)] == [0.0, 0.0]


# -- toggles and limits ------------------------------------------------------------------------------------------------


def determinant(linkage: Fourbar, theta: np.ndarray, sign: int) -> np.ndarray:
    """Sine of the angle between coupler and output: the determinant of the velocity equations without its lengths."""
    at = positions(linkage, theta, sign)
    return np.sin(at.output_angle - at.coupler_angle)


def test_toggles_are_where_the_determinant_vanishes() -> None:
    _, linkage = batch(14, gap=1e-4)
    limits = find_input_limits(linkage)
    for toggle, exists in ((limits.lower, limits.folded_toggle), (limits.upper, limits.extended_toggle)):
        chosen = take(linkage, np.flatnonzero(exists))
        for side in (1.0, -1.0):
            theta = (chosen.ground_angle + side * toggle[exists])[:, None]
            inward = side * np.where(toggle is limits.lower, 1e-10, -1e-10)
            sine = determinant(chosen, theta + inward, OPEN_ASSEMBLY)
            assert np.nanmax(np.abs(sine)) < 5e-3
            assert np.isfinite(sine).mean() > 0.99


def test_folded_toggle_folds_and_extended_toggle_extends() -> None:
    """Folded: B beyond or before O4 with coupler and output overlapping; extended: A, B, O4 in this order in line."""
    _, linkage = batch(15, gap=1e-4)
    limits = find_input_limits(linkage)
    for toggle, exists, sign in (
        (limits.lower, limits.folded_toggle, 1.0),
        (limits.upper, limits.extended_toggle, -1.0),
    ):
        chosen = take(linkage, np.flatnonzero(exists))
        theta = (chosen.ground_angle + toggle[exists] + sign * 1e-10)[:, None]
        at = positions(chosen, theta)
        cosine = np.cos(at.coupler_angle - at.output_angle)[at.valid]
        np.testing.assert_allclose(cosine, sign, atol=1e-4)


def test_limits_are_where_positions_end() -> None:
    _, linkage = batch(16, gap=1e-4)
    limits = find_input_limits(linkage)
    ground = linkage.ground_angle
    width = limits.upper - limits.lower
    share = np.linspace(1e-6, 1.0 - 1e-6, 41)
    for side in (1.0, -1.0):
        inside = ground[:, None] + side * (limits.lower[:, None] + width[:, None] * share)
        assert positions(linkage, inside).valid.all()
        below = limits.lower[:, None] * np.linspace(0.0, 1.0 - 1e-6, 7)
        above = limits.upper[:, None] + (np.pi - limits.upper)[:, None] * np.linspace(1e-6, 1.0, 7)
        assert not positions(linkage, ground[:, None] + side * below).valid[limits.folded_toggle].any()
        assert not positions(linkage, ground[:, None] + side * above).valid[limits.extended_toggle].any()
    assert np.all(limits.lower[~limits.folded_toggle] == 0.0)
    assert np.all(limits.upper[~limits.extended_toggle] == np.pi)


@given(fourbars())
@settings(max_examples=50)
def test_toggle_angles_lie_in_one_turn_and_are_configurations(linkage: Fourbar) -> None:
    toggles = find_toggle_angles(linkage)
    assert np.all(np.diff(toggles) > 0.0)
    assert np.all((toggles > -np.pi) & (toggles <= np.pi))
    limits = find_input_limits(linkage)
    assert len(toggles) <= 2 * (int(limits.folded_toggle) + int(limits.extended_toggle))
    if not can_assemble(linkage):
        assert toggles.size == 0
        assert not positions(linkage, np.linspace(-np.pi, np.pi, 60)).valid.any()
