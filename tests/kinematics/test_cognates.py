"""Cognates: printed cases, and the laws of Roberts, Chebyshev and Norton's Sec. 3.7 on random linkages."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

from kinematics.errors import DimensionError
from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    Positions,
    barker_class,
    barker_type,
    find_transmission_extremes,
    has_full_rotation,
    positions,
    transmission_angle,
)
from kinematics.linkage.fourbar.cognates import (
    Cognate,
    build_cognates,
    build_geared_fivebar_cognate,
    build_parallel_motion,
)
from tests.cases import Case, cases
from tests.kinematics.sampling import assembled_angles, random_fourbars, signs, take
from tests.oracles.output_drive import cognate_driven_at_output, driven_at_output
from tests.oracles.positions import meet

BATCH = 10_000
SAME_CURVE = 1e-10
"""Distance of curves that are one, as a share of the linkage's size."""

FIELDS = ("input_pivot", "output_pivot", "input", "coupler", "output", "coupler_point")
TYPES = {
    "double_crank": "double-crank",
    "crank_rocker": "crank-rocker",
    "rocker_crank": "crank-rocker",
    "double_rocker": "double-rocker",
}


def linkage_of(case: Case) -> Fourbar:
    x = case.inputs
    return Fourbar.from_lengths(x["a"], x["b"], x["c"], x["d"], x["p"] * np.exp(1j * np.radians(x["delta3"])))


def sample(seed: int, margin: float, n: int = BATCH, m: int = 4):
    """n random linkages in m configurations each, of one assembly a linkage."""
    rng = np.random.default_rng(seed)
    linkage = random_fourbars(rng, n, gap=1e-3)
    theta = assembled_angles(rng, linkage, m, margin)
    found = ~np.isnan(theta).any(axis=1)
    assert found.mean() > 0.98
    linkage = take(linkage, found)
    return rng, linkage, theta[found], signs(rng, int(found.sum()))


def size_of(linkage: Fourbar) -> NDArray[np.float64]:
    return (linkage.lengths.sum(axis=-1) + np.abs(linkage.coupler_point))[..., None]


def stand(cognate: Cognate, theta: NDArray[np.float64], assembly: NDArray[np.int64]) -> Positions:
    """The cognate driven, by its own dimensions, to where the source stands."""
    there = cognate.configuration(theta, assembly)
    one, other = (positions(cognate.linkage, there.input_angle, sign) for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY))
    return Positions(*(np.where(there.assembly == OPEN_ASSEMBLY, x, y) for x, y in zip(one, other, strict=True)))


def four_drives(linkage: Fourbar) -> list[Cognate]:
    pair = build_cognates(linkage)
    return [*pair, *(cognate_driven_at_output(cognate) for cognate in pair)]


def same_direction(one, other) -> NDArray[np.float64]:
    return np.abs(np.exp(1j * np.asarray(one)) - np.exp(1j * np.asarray(other)))


# -- printed cases -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", cases("cognates"))
def test_cognates_of_a_printed_linkage(case: Case) -> None:
    """The cranks of both stand on the pivots of the source."""
    pair = build_cognates(linkage_of(case))
    found = {}
    for side, linkage in (("left", pair.left.linkage), ("right", cognate_driven_at_output(pair.right).linkage)):
        found |= {
            f"{side}_ground": linkage.ground,
            f"{side}_crank": linkage.input,
            f"{side}_coupler": linkage.coupler,
            f"{side}_rocker": linkage.output,
            f"{side}_p": abs(linkage.coupler_point),
            f"{side}_code": barker_class(linkage).code,
        }
    case.check(**found)


@pytest.mark.parametrize("case", cases("cognate_types"))
def test_types_of_cognates(case: Case) -> None:
    source = linkage_of(case)
    pair = build_cognates(source)
    types = [TYPES[barker_class(cognate.linkage).motion] for cognate in (pair.right, pair.left)]
    least = [find_transmission_extremes(linkage, 0.0, 2.0 * np.pi)[0] for linkage in (source, pair.right.linkage)]
    case.check(cognate_types=types, mu_min_difference=np.degrees(least[1] - least[0]))


@pytest.mark.parametrize("case", cases("geared_fivebar_cognate"))
def test_geared_fivebar_of_a_printed_linkage(case: Case) -> None:
    source = linkage_of(case)
    at = positions(source, np.radians(np.arange(-180.0, 180.0, 0.5)))
    fivebar = build_geared_fivebar_cognate(source)
    assert at.valid.any()
    x = case.inputs
    assert [fivebar.input, fivebar.coupler_1, fivebar.coupler_2] == pytest.approx([x["p"], x["a"], x["c"]])
    other_arm = abs(source.coupler_point - source.coupler)
    assert fivebar.output == pytest.approx(other_arm)
    missed = fivebar_misfit(fivebar, at.coupler_angle[at.valid], at.p[at.valid])
    case.check(gear_ratio=fivebar.gear_ratio, path_error=missed.max())


@pytest.mark.parametrize("case", cases("parallel_motion"))
def test_parallel_motion_of_a_printed_linkage(case: Case) -> None:
    """Link 8 keeps its direction; the added links have the sizes that were computed for the same data elsewhere."""
    found = build_parallel_motion(linkage_of(case))
    case.check(closure_error=sixbar_misfit(found, np.radians(np.arange(0.0, 360.0)), OPEN_ASSEMBLY).max())
    assert abs(found.crank_point) == pytest.approx(1.000157787, abs=1e-9)
    assert np.degrees(np.angle(found.crank_point)) == pytest.approx(-58.98224219, abs=1e-8)
    assert found.guide == pytest.approx(7.714285714, abs=1e-9)
    assert abs(found.translation) == pytest.approx(5.142857143, abs=1e-9)
    assert np.degrees(np.angle(found.translation)) == pytest.approx(-150.0, abs=1e-9)


# -- Roberts and Chebyshev ---------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.parametrize("drive", range(4))
def test_cognates_trace_the_curve_of_the_source(drive: int) -> None:
    _, linkage, theta, sign = sample(11, margin=1e-3)
    at = positions(linkage, theta, sign)
    there = stand(four_drives(linkage)[drive], theta, sign)
    assert there.valid.all()
    assert (np.abs(there.p - at.p) / size_of(linkage)).max() <= SAME_CURVE


@pytest.mark.slow
@pytest.mark.parametrize("drive", range(4))
def test_cognate_has_no_position_less_than_the_source(drive: int) -> None:
    """Up to the toggles themselves, where half the digits are lost."""
    rng, linkage, _, sign = sample(12, margin=0.0)
    theta = rng.uniform(-np.pi, np.pi, (len(sign), 20))
    at = positions(linkage, theta, sign)
    assert 0.2 < at.valid.mean() < 0.95
    cognate = four_drives(linkage)[drive]
    there = cognate.configuration(theta, sign)
    np.testing.assert_array_equal(there.valid, at.valid)
    np.testing.assert_array_equal(np.isnan(there.input_angle), ~at.valid)
    assert set(np.unique(there.assembly)) <= {OPEN_ASSEMBLY, CROSSED_ASSEMBLY}
    assert (there.assembly[~at.valid] == OPEN_ASSEMBLY).all()
    reached = stand(cognate, theta, sign)
    close = np.abs(reached.p - at.p) / size_of(linkage) < 1e-6
    assert close[at.valid].mean() > 0.9999


@pytest.mark.slow
@pytest.mark.parametrize("drive", range(4))
def test_each_link_turns_with_its_link_of_the_source(drive: int) -> None:
    _, linkage, theta, sign = sample(13, margin=1e-2)
    at = positions(linkage, theta, sign)
    cognate = four_drives(linkage)[drive]
    source = {"input": theta, "coupler": at.coupler_angle, "output": at.output_angle}
    there = stand(cognate, theta, sign)
    own_input = np.angle(there.a - cognate.linkage.input_pivot[:, None])
    for k, own in enumerate((own_input, there.coupler_angle, there.output_angle)):
        assert same_direction(own, source[cognate.turns_with[k]] + cognate.offset[:, k, None]).max() < 1e-9
    assert sorted(cognate.turns_with) == ["coupler", "input", "output"]
    assert np.all((cognate.offset > -np.pi) & (cognate.offset <= np.pi))
    middle = {0: "input", 1: "output", 2: "input", 3: "output"}
    assert cognate.turns_with[1] == middle[drive]


def test_three_pivots_form_a_triangle_like_the_coupler() -> None:
    rng = np.random.default_rng(14)
    linkage = random_fourbars(rng, BATCH)
    pair = build_cognates(linkage)
    third = pair.left.linkage.output_pivot
    np.testing.assert_array_equal(third, pair.right.linkage.input_pivot)
    np.testing.assert_array_equal(pair.left.linkage.input_pivot, linkage.input_pivot)
    np.testing.assert_array_equal(pair.right.linkage.output_pivot, linkage.output_pivot)
    base = linkage.output_pivot - linkage.input_pivot
    np.testing.assert_allclose((third - linkage.input_pivot) / base, linkage.coupler_point / linkage.coupler)


@pytest.mark.slow
def test_right_cognate_keeps_crank_and_transmission_angle_in_the_other_assembly() -> None:
    _, linkage, theta, sign = sample(15, margin=1e-3)
    right = build_cognates(linkage).right
    there = right.configuration(theta, sign)
    np.testing.assert_array_equal(there.assembly, np.broadcast_to(-sign[:, None], theta.shape))
    np.testing.assert_allclose(
        transmission_angle(right.linkage, there.input_angle), transmission_angle(linkage, theta), atol=1e-9
    )
    np.testing.assert_array_equal(has_full_rotation(right.linkage), has_full_rotation(linkage))


def test_types_of_cognates_follow_the_rule() -> None:
    """Crank-rocker: crank-rocker and double-rocker; double crank: double cranks; double rocker: crank-rockers;
    non-Grashof: non-Grashof (Norton, Sec. 3.7)."""
    linkage = random_fourbars(np.random.default_rng(16), BATCH, gap=1e-6)
    pair = build_cognates(linkage)
    kinds = [barker_type(x) for x in (linkage, pair.left.linkage, pair.right.linkage)]
    rule = {1: {(1, 1)}, 2: {(3, 2)}, 3: {(2, 4)}, 4: {(4, 3)}}
    for source, others in rule.items():
        of = kinds[0] == source
        assert of.sum() > 100
        assert {(int(x), int(y)) for x, y in zip(kinds[1][of], kinds[2][of], strict=True)} == others
    assert np.all((kinds[0] > 4) == (kinds[1] > 4))
    assert np.all((kinds[0] > 4) == (kinds[2] > 4))


def test_cognates_of_cognates_are_the_three() -> None:
    """The left cognate's left is the source again; the right one's right is the source driven at its output."""
    linkage = random_fourbars(np.random.default_rng(17), BATCH)
    pair = build_cognates(linkage)
    back = build_cognates(pair.left.linkage).left.linkage
    around = driven_at_output(build_cognates(cognate_driven_at_output(pair.right).linkage).left.linkage)
    same = build_cognates(pair.left.linkage).right.linkage
    for found, expected in ((back, linkage), (around, linkage), (same, cognate_driven_at_output(pair.right).linkage)):
        scale = np.abs(linkage.coupler_point / linkage.coupler) + 1.0
        for name in FIELDS:
            error = np.abs(getattr(found, name) - getattr(expected, name))
            assert (error / (scale * (1.0 + np.abs(getattr(expected, name))))).max() < 1e-9, name


@pytest.mark.slow
def test_driving_at_the_other_end_is_the_same_mechanism() -> None:
    _, linkage, theta, sign = sample(18, margin=1e-3)
    twice = driven_at_output(driven_at_output(linkage))
    for name in FIELDS:
        np.testing.assert_allclose(getattr(twice, name), getattr(linkage, name), rtol=1e-12, atol=1e-15)
    at = positions(linkage, theta, sign)
    other = driven_at_output(linkage)
    found = [positions(other, at.output_angle, side) for side in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY)]
    error = np.minimum(*(np.abs(x.p - at.p) + np.abs(x.a - at.b) + np.abs(x.b - at.a) for x in found))
    assert np.quantile(error / size_of(linkage), 0.999) < 1e-9
    cognate = build_cognates(linkage).left
    again = cognate_driven_at_output(cognate_driven_at_output(cognate))
    assert again.turns_with == cognate.turns_with
    assert same_direction(again.offset, cognate.offset).max() < 1e-12


# -- degenerate coupler points -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("place", [-1.5, -0.01, 0.3, 0.5, 0.99, 2.0])
def test_coupler_point_in_line(place: float) -> None:
    """Cayley's diagram collapses, the cognates stay; the third pivot is on the ground line."""
    linkage = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, place * 7.0)
    theta = np.linspace(0.0, 6.0, 50)
    at = positions(linkage, theta)
    for cognate in four_drives(linkage):
        assert np.abs(stand(cognate, theta, np.int64(1)).p - at.p).max() < 1e-11
        assert abs(cognate.linkage.input_pivot.imag) + abs(cognate.linkage.output_pivot.imag) < 1e-14
    fivebar = build_geared_fivebar_cognate(linkage)
    assert fivebar_misfit(fivebar, at.coupler_angle, at.p).max() < 1e-10
    assert fivebar.phase == pytest.approx(np.pi if 0.0 < place < 1.0 else 0.0)
    assert sixbar_misfit(build_parallel_motion(linkage), theta, OPEN_ASSEMBLY).max() < 1e-10


@pytest.mark.parametrize("make", [build_cognates, build_geared_fivebar_cognate, build_parallel_motion])
@pytest.mark.parametrize("point", [0.0, 7.0, 5e-9j, 7.0 - 5e-9, [1j, 7.0, 2.0]])
def test_point_at_a_moving_pivot_has_no_cognate(make, point) -> None:
    with pytest.raises(DimensionError, match=r"^coupler_point must be away from the moving pivots") as caught:
        make(Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, point))
    assert caught.value.name == "coupler_point"
    assert min(abs(caught.value.value), abs(caught.value.value - 7.0)) < 1e-8


def test_point_near_a_moving_pivot_has_cognates() -> None:
    linkage = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0, [1e-6j, 7.0 - 1e-6])
    theta = np.linspace(0.0, 6.0, 50)
    for cognate in four_drives(linkage):
        there = stand(cognate, theta, np.ones(2, int))
        assert np.abs(there.p - positions(linkage, theta).p).max() < 1e-7


@pytest.mark.parametrize("lengths", [(2.0, 3.0, 3.0, 2.0), (1.0, 2.0, 3.0, 2.0), (2.0, 3.0, 2.0, 3.0)])
@pytest.mark.parametrize("assembly", [OPEN_ASSEMBLY, CROSSED_ASSEMBLY])
def test_change_point_linkages(lengths: tuple[float, ...], assembly: int) -> None:
    """In a parallelogram the coupler does not turn: a link that turns with it stands still and drives nothing."""
    linkage = Fourbar.from_lengths(*lengths, 1.0 + 2.0j)
    theta = np.linspace(0.3, 2.8, 30)
    point = positions(linkage, theta, assembly).p
    still = lengths[0] == lengths[2] and assembly == OPEN_ASSEMBLY
    for cognate in four_drives(linkage):
        if still and cognate.turns_with[0] == "coupler":
            assert np.ptp(cognate.configuration(theta, assembly).input_angle) < 1e-14
        else:
            assert np.abs(stand(cognate, theta, np.int64(assembly)).p - point).max() < 1e-7


@pytest.mark.parametrize("scale", [1e-9, 1e9])
def test_cognates_move_with_rotation_translation_and_scale(scale: float) -> None:
    linkage = random_fourbars(np.random.default_rng(19), 500)
    turn, shift = np.exp(0.7j), 3.0 - 1.0j
    moved = Fourbar(
        scale * turn * (linkage.input_pivot + shift),
        scale * turn * (linkage.output_pivot + shift),
        *(scale * x for x in (linkage.input, linkage.coupler, linkage.output, linkage.coupler_point)),
    )
    for here, there in zip(four_drives(linkage), four_drives(moved), strict=True):
        for name in ("input_pivot", "output_pivot"):
            expected = scale * turn * (getattr(here.linkage, name) + shift)
            np.testing.assert_allclose(getattr(there.linkage, name), expected, rtol=1e-11)
        for name in FIELDS[2:]:
            np.testing.assert_allclose(getattr(there.linkage, name), scale * getattr(here.linkage, name), rtol=1e-11)
        assert same_direction(there.offset, here.offset).max() < 1e-11


def test_batches_equal_single_designs() -> None:
    rng = np.random.default_rng(20)
    batch = random_fourbars(rng, 6)
    linkage = Fourbar(*(getattr(batch, name).reshape(2, 3) for name in FIELDS))
    theta, sign = rng.uniform(-3.0, 3.0, 5), signs(rng, 2, 3)
    for k, cognate in enumerate(four_drives(linkage)):
        together = cognate.configuration(theta, sign)
        assert together.valid.shape == together.input_angle.shape == together.assembly.shape == (2, 3, 5)
        for index in np.ndindex(2, 3):
            alone = four_drives(take(linkage, index))[k]
            for name in FIELDS:
                np.testing.assert_allclose(getattr(alone.linkage, name), getattr(cognate.linkage, name)[index])
            for whole, part in zip(together, alone.configuration(theta, sign[index]), strict=True):
                np.testing.assert_allclose(whole[index], part, rtol=1e-12)
    for make in (build_geared_fivebar_cognate, build_parallel_motion):
        for field in dataclasses.fields(make(linkage)):
            if field.name != "linkage":
                whole = getattr(make(linkage), field.name)
                assert whole.shape == (2, 3)
                np.testing.assert_allclose(whole[1, 2], getattr(make(take(linkage, (1, 2))), field.name))
    one = build_cognates(take(linkage, (0, 0))).left.configuration(0.1)
    assert one.valid.shape == one.input_angle.shape == one.assembly.shape == ()


# -- geared fivebar and parallel motion --------------------------------------------------------------------------------


def fivebar_misfit(fivebar, coupler_angle, point) -> NDArray[np.float64]:
    """Distance of the fivebar's coupler point, by circles about its pins, from ``point``; the nearer of the two sides.

    The output's rotation is gear ratio × rotation of the input from the line of centres.
    """
    axis = (..., None) if np.ndim(fivebar.input) else ...
    o2, o4 = fivebar.input_pivot[axis], fivebar.output_pivot[axis]
    ground = np.angle(o4 - o2)
    theta = coupler_angle + fivebar.input_offset[axis]
    output = ground + fivebar.phase[axis] + fivebar.gear_ratio[axis] * (theta - ground)
    first = o2 + fivebar.input[axis] * np.exp(1j * theta)
    last = o4 + fivebar.output[axis] * np.exp(1j * output)
    pins = [meet(first, last, fivebar.coupler_1[axis], fivebar.coupler_2[axis], side) for side in (1, -1)]
    return np.fmin(*(np.abs(pin - point) for pin in pins))


def sixbar_misfit(sixbar, theta, assembly) -> NDArray[np.float64]:
    """By how much the link P Q leaves its direction, Q found by circles about C and P; the nearer of the two sides."""
    linkage = sixbar.linkage
    axis = (..., None) if linkage.input.ndim else ...
    at = positions(linkage, theta, assembly)
    pin = linkage.input_pivot[axis] + sixbar.crank_point[axis] * np.exp(1j * np.asarray(theta))
    length = np.abs(sixbar.translation)[axis]
    found = [meet(pin, at.p, sixbar.guide[axis], length, side) for side in (1, -1)]
    return np.fmin(*(np.abs(q - at.p - sixbar.translation[axis]) for q in found))


@pytest.mark.slow
def test_geared_fivebar_traces_the_curve() -> None:
    _, linkage, theta, sign = sample(21, margin=1e-3)
    at = positions(linkage, theta, sign)
    fivebar = build_geared_fivebar_cognate(linkage)
    error = fivebar_misfit(fivebar, at.coupler_angle, at.p) / size_of(linkage)
    assert np.quantile(error, 0.99) < 1e-10
    assert error.max() < 1e-6
    assert (fivebar.gear_ratio == 1.0).all()
    np.testing.assert_array_equal(fivebar.coupler_point, fivebar.coupler_1)
    np.testing.assert_array_equal(fivebar.coupler_1, linkage.input)
    np.testing.assert_array_equal(fivebar.coupler_2, linkage.output)
    assert np.all((fivebar.phase > -np.pi) & (fivebar.phase <= np.pi))


@pytest.mark.slow
def test_parallel_motion_carries_a_link_without_turning_it() -> None:
    _, linkage, theta, sign = sample(22, margin=1e-3)
    sixbar = build_parallel_motion(linkage)
    error = sixbar_misfit(sixbar, theta, sign) / size_of(linkage)
    assert np.quantile(error, 0.99) < 1e-10
    assert error.max() < 1e-6


def test_parallel_motion_is_the_right_cognate_moved_to_the_input_pivot() -> None:
    _, linkage, theta, sign = sample(23, margin=1e-3, n=500)
    sixbar, right = build_parallel_motion(linkage), build_cognates(linkage).right
    there = stand(right, theta, sign)
    moved = there.a - right.linkage.input_pivot[:, None]
    np.testing.assert_allclose(sixbar.crank_point[:, None] * np.exp(1j * theta), moved, atol=1e-9)
    np.testing.assert_allclose(sixbar.translation, linkage.input_pivot - right.linkage.input_pivot, atol=1e-12)
    reach = np.abs(there.p - there.a)
    np.testing.assert_allclose(sixbar.guide[:, None] + 0.0 * reach, reach, rtol=1e-9)
