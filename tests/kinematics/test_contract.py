"""What callers may rely on: refusals, shapes, values that cannot change, and batches that equal single designs."""

from __future__ import annotations

import dataclasses
import math
import pickle

import numpy as np
import pytest

from kinematics.errors import DimensionError, MechanismError, ShapeError
from kinematics.linkage import compute_mobility
from kinematics.linkage.fourbar import (
    CROSSED_ASSEMBLY,
    OPEN_ASSEMBLY,
    Fourbar,
    barker_class,
    barker_type,
    can_assemble,
    find_input_limits,
    find_transmission_extremes,
    grashof_class,
    grashof_excess,
    has_full_rotation,
    is_same_circuit,
    motion,
    positions,
    stays_on_branch,
    transmission_angle,
)
from tests.kinematics.sampling import random_fourbars, signs, take

GOOD = {"input_pivot": 0j, "output_pivot": 6 + 0j, "input": 2.0, "coupler": 7.0, "output": 9.0, "coupler_point": 1j}
ROW_A = Fourbar.from_lengths(2.0, 7.0, 9.0, 6.0)


# -- refusals ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("field", ["input", "coupler", "output"])
@pytest.mark.parametrize("value", [0.0, -0.0, -1.0, np.nan, np.inf, -np.inf, [1.0, 2.0, 0.0], [[np.nan]]])
def test_impossible_length_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(DimensionError, match=f"^{field} must be positive and finite") as caught:
        Fourbar(**{**GOOD, field: value})
    assert caught.value.name == field
    bad = np.asarray(value).ravel()[-1]
    assert caught.value.value == bad or (math.isnan(caught.value.value) and math.isnan(bad))


@pytest.mark.parametrize("field", ["input_pivot", "output_pivot", "coupler_point"])
@pytest.mark.parametrize("value", [complex(np.nan, 0.0), complex(0.0, np.inf), [0.0, np.nan]])
def test_pivot_that_is_nowhere_is_refused_by_name(field: str, value: object) -> None:
    with pytest.raises(DimensionError, match=f"^{field} must be finite"):
        Fourbar(**{**GOOD, field: value})


@pytest.mark.parametrize("ground", [0.0, -6.0, np.nan, np.inf])
def test_impossible_ground_is_refused_by_name(ground: float) -> None:
    with pytest.raises(DimensionError, match=r"^ground must be positive and finite"):
        Fourbar.from_lengths(2.0, 7.0, 9.0, ground)


def test_coinciding_or_immense_pivots_are_refused() -> None:
    for apart in ((3 + 1j, 3 + 1j), (-1.7e308, 1.7e308), ([0.0, 1.0], 1.0)):
        with pytest.raises(DimensionError, match=r"^ground must be positive and finite"):
            Fourbar(*apart, 2.0, 7.0, 9.0)


@pytest.mark.parametrize("lengths", [[1, 2, 3], [1, 2, 3, 4, 5], 1.0, []])
def test_grashof_needs_four_lengths(lengths: object) -> None:
    for function in (grashof_class, grashof_excess):
        with pytest.raises(DimensionError, match=r"^lengths must be four on the last axis"):
            function(lengths)


@pytest.mark.parametrize("bad", [0.0, -2.0, np.nan, np.inf])
def test_grashof_refuses_impossible_lengths(bad: float) -> None:
    for function in (grashof_class, grashof_excess):
        with pytest.raises(DimensionError, match=r"^lengths must be positive and finite"):
            function([[1, 2, 3, 4], [1, 2, bad, 4]])


@pytest.mark.parametrize("assembly", [0, 2, -3, 0.5, np.nan, [1, 0]])
def test_assembly_is_a_sign(assembly: object) -> None:
    for function in (positions, motion):
        with pytest.raises(DimensionError, match=r"^assembly must be"):
            function(ROW_A, 0.5, assembly)


def test_linkage_of_no_class_is_refused() -> None:
    broken = Fourbar.from_lengths(1.0, 1.0, 1.0, 10.0)
    assert barker_type(broken) == 0
    with pytest.raises(DimensionError, match=r"^lengths .* \[10.0, 1.0, 1.0, 1.0\]"):
        barker_class(broken)


@pytest.mark.parametrize("field", ["links", "full_joints", "half_joints", "grounded"])
def test_negative_counts_are_refused_by_name(field: str) -> None:
    with pytest.raises(DimensionError, match=f"^{field} must be a count"):
        compute_mobility(**{"links": 4, "full_joints": 4, field: -1})


def test_shapes_that_do_not_broadcast_are_refused() -> None:
    three = Fourbar.from_lengths([2.0, 3.0, 4.0], 7.0, 9.0, 6.0)
    with pytest.raises(ShapeError, match=r"input \(3,\)") as caught:
        Fourbar.from_lengths([1.0, 2.0, 3.0], [1.0, 2.0], 9.0, 6.0)
    assert caught.value.shapes["coupler"] == (2,)
    two = np.zeros(2)
    one = np.ones(2)
    calls = [
        lambda: positions(three, np.zeros((2, 5))),
        lambda: positions(three, 0.1, one),
        lambda: motion(three, np.zeros((2, 5))),
        lambda: motion(three, np.zeros(5), speed=np.ones(4)),
        lambda: motion(three, np.zeros(5), acceleration=np.ones((3, 4))),
        lambda: motion(three, np.zeros(5), jerk=np.ones((2, 5))),
        lambda: transmission_angle(three, np.zeros((2, 5))),
        lambda: find_transmission_extremes(three, two, 1.0),
        lambda: find_transmission_extremes(three, 0.0, two),
        lambda: stays_on_branch(three, two, 0.0),
        lambda: is_same_circuit(three, two, 1, 0.0, 1),
        lambda: is_same_circuit(three, 0.0, 1, 0.0, one),
    ]
    for call in calls:
        with pytest.raises(ShapeError, match="broadcast"):
            call()


def test_errors_are_one_family_and_builtins() -> None:
    for kind in (DimensionError, ShapeError):
        assert issubclass(kind, MechanismError)
        assert issubclass(kind, ValueError)


# -- values ------------------------------------------------------------------------------------------------------------


def test_linkage_cannot_change() -> None:
    given = {name: np.array(value) for name, value in GOOD.items()}
    linkage = Fourbar(**given)
    for name in GOOD:
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(linkage, name, 1.0)
        with pytest.raises(ValueError, match="read-only"):
            getattr(linkage, name)[...] = 5.0
    for value in given.values():
        value[...] = 99.0
    for name, value in GOOD.items():
        assert getattr(linkage, name) == value


def test_calls_leave_their_arguments_alone() -> None:
    theta, sign = np.array([0.4, 1.0]), np.array(1)
    for array in (theta, sign):
        array.flags.writeable = False
    motion(ROW_A, theta, sign)
    find_transmission_extremes(ROW_A, theta[0], theta[1])
    stays_on_branch(ROW_A, theta[0], theta[1])


def test_linkages_compare_hash_and_pickle() -> None:
    linkage = random_fourbars(np.random.default_rng(0), 3)
    assert linkage == linkage
    assert linkage != take(linkage, slice(None))
    assert {linkage: 1}[linkage] == 1
    copy = pickle.loads(pickle.dumps(linkage))
    np.testing.assert_array_equal(copy.coupler, linkage.coupler)


# -- batches -----------------------------------------------------------------------------------------------------------


def mixed() -> list[tuple[str, Fourbar]]:
    """Batches whose fields come in different shapes."""
    rng = np.random.default_rng(71)
    whole = random_fourbars(rng, 6)
    lengths = rng.uniform(0.5, 2.0, (3, 2, 3))
    return [
        ("all of one shape", whole),
        ("scalar pivots", Fourbar(0.1j, 1.4, whole.input, whole.coupler, whole.output, whole.coupler_point)),
        ("only the coupler point varies", Fourbar(0.0, 1.5, 1.0, 1.2, 1.3, whole.coupler_point)),
        ("only the ground varies", Fourbar(0.0, whole.output_pivot, 1.0, 1.2, 1.3)),
        ("two axes", Fourbar(np.zeros((3, 1)), 1.5, *np.moveaxis(lengths, -1, 0), np.ones(2))),
        ("outer product", Fourbar(0.0, 1.5, [[1.0], [1.1], [0.4]], [1.2, 0.8], 1.0, 0.5j)),
        ("one design in a batch of one", Fourbar([0.0], 1.5, 1.0, 1.2, 1.3)),
        ("empty batch", Fourbar(0.0, 1.5, np.ones((0,)), 1.2, 1.3)),
    ]


def flat(found: object) -> list[np.ndarray]:
    if isinstance(found, tuple):
        return [array for part in found for array in flat(part)]
    return [np.asarray(found)]


@pytest.mark.parametrize(("name", "linkage"), mixed(), ids=[name for name, _ in mixed()])
def test_batches_equal_single_designs(name: str, linkage: Fourbar) -> None:
    shape = np.broadcast_shapes(*(getattr(linkage, field).shape for field in GOOD))
    rng = np.random.default_rng(72)
    theta, many = rng.uniform(-4.0, 4.0, (*shape, 5)), rng.uniform(-4.0, 4.0, 5)
    start, end = rng.uniform(-4.0, 4.0, (2, *shape))
    sign, other = signs(rng, *shape), signs(rng, *shape)
    with_angles = {
        "positions": lambda x, i: positions(x, theta[i], sign[i]),
        "positions, shared angles": lambda x, i: positions(x, many, CROSSED_ASSEMBLY),
        "motion": lambda x, i: motion(x, theta[i], sign[i], speed=2.0, acceleration=0.5, jerk=-1.0),
        "motion, rates vary": lambda x, i: motion(x, theta[i], sign[i], speed=theta[i], jerk=many),
        "transmission_angle": lambda x, i: transmission_angle(x, theta[i]),
    }
    plain = {
        "transmission_extremes": lambda x, i: find_transmission_extremes(x, start[i], end[i]),
        "extremes from one start": lambda x, i: find_transmission_extremes(x, 0.3, 1.0),
        "input_limits": lambda x, i: find_input_limits(x),
        "full_rotation": lambda x, i: has_full_rotation(x),
        "can_assemble": lambda x, i: can_assemble(x),
        "barker_type": lambda x, i: barker_type(x),
        "stays_on_branch": lambda x, i: stays_on_branch(x, start[i], end[i]),
        "stays_on_branch from one start": lambda x, i: stays_on_branch(x, 0.3, 0.5),
        "same_circuit": lambda x, i: is_same_circuit(x, start[i], sign[i], end[i], other[i]),
        "same_circuit as one": lambda x, i: is_same_circuit(x, 0.3, OPEN_ASSEMBLY, 0.5, CROSSED_ASSEMBLY),
        "ground": lambda x, i: (x.ground, x.ground_angle),
        "link_lengths": lambda x, i: x.lengths,
        "grashof": lambda x, i: (grashof_class(x.lengths), grashof_excess(x.lengths)),
    }
    for label, call in (with_angles | plain).items():
        tail = (5,) if label in with_angles else (4,) if label == "link_lengths" else ()
        together = flat(call(linkage, ...))
        for array in together:
            assert array.shape == shape + tail, (name, label)
        for index in np.ndindex(shape):
            alone = flat(call(take(linkage, index), index))
            for whole, part in zip(together, alone, strict=True):
                assert part.shape == tail
                np.testing.assert_allclose(whole[index], part, rtol=1e-12, atol=1e-12, err_msg=f"{name}: {label}")


def test_shapes_of_one_design() -> None:
    """A scalar angle gives scalars, an array its own shape; an assembly for each design leads."""
    assert positions(ROW_A, 0.5).p.shape == ()
    assert motion(ROW_A, 0.5).jerk.p.shape == ()
    assert positions(ROW_A, np.zeros((4, 3))).valid.shape == (4, 3)
    assert positions(ROW_A, 0.5, [1, -1]).b.shape == (2, 1)
    assert positions(ROW_A, np.zeros(7), [1, -1]).b.shape == (2, 7)
    assert motion(ROW_A, np.zeros(7), speed=np.ones((3, 1))).velocity.valid.shape == (3, 7)
    for part in motion(ROW_A, np.zeros(7), [1, -1], speed=np.ones((3, 1, 1))):
        assert {values.shape for values in part} == ({(2, 7)} if part.valid.shape == (2, 7) else {(3, 2, 7)})


# -- hostile geometry --------------------------------------------------------------------------------------------------


def test_input_pin_on_the_output_pivot() -> None:
    """With a = d the pin A comes to stand on O4; if b = c too, B may be anywhere on a circle: no position."""
    assert not positions(Fourbar.from_lengths(1.0, 1.5, 1.5, 1.0), 0.0).valid
    near = positions(Fourbar.from_lengths(1.0, 1.5, 1.5, 1.0), np.array([1e-9, 1e-3, 1.0]))
    assert near.valid.all()
    np.testing.assert_allclose(np.abs(near.b - near.a), 1.5, rtol=1e-12)
    assert not positions(Fourbar.from_lengths(1.0, 1.5, 1.2, 1.0), 0.0).valid


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e3, 1e9])
def test_points_in_line_and_equal_links(scale: float) -> None:
    """Coupler point on the line AB, beyond it and on its ends; all pairs of equal links."""
    theta = np.linspace(0.01, 2.0 * np.pi, 60)
    for lengths in ((2.0, 2.0, 3.0, 3.5), (2.0, 3.0, 2.0, 3.5), (2.0, 3.0, 3.0, 2.5), (3.0, 2.5, 2.0, 3.0)):
        for on_line in (-1.0, 0.0, 0.5, 1.0, 2.0):
            a, b, c, d = (scale * x for x in lengths)
            at = positions(Fourbar.from_lengths(a, b, c, d, on_line * b), theta)
            ok = at.valid
            assert ok.any()
            np.testing.assert_allclose(at.p[ok], (at.a + on_line * (at.b - at.a))[ok], atol=1e-12 * scale)
            np.testing.assert_allclose(np.abs(at.b - at.a)[ok], b, rtol=1e-12)
            np.testing.assert_allclose(np.abs(at.b - d)[ok], c, rtol=1e-12)


def test_far_from_the_origin() -> None:
    """A linkage of size 1 a million units away moves as at home, within the digits that its coordinates keep."""
    home, away = ROW_A, Fourbar(1e6 + 1e6j, 1e6 + 6.0 + 1e6j, 2.0, 7.0, 9.0)
    theta = np.linspace(0.0, 6.0, 50)
    here, there = positions(home, theta), positions(away, theta)
    np.testing.assert_allclose(there.b - (1e6 + 1e6j), here.b, atol=1e-8)
    np.testing.assert_array_equal(transmission_angle(home, theta), transmission_angle(away, theta))


def test_wildly_unequal_links() -> None:
    rng = np.random.default_rng(73)
    lengths = 10.0 ** rng.uniform(-6.0, 6.0, (4, 5000))
    lengths[3] = lengths[0] + (lengths[1] + lengths[2]) * rng.uniform(-1.0, 1.0, 5000)
    lengths = lengths[:, lengths[3] > 0.0]
    linkage = Fourbar.from_lengths(*lengths)
    at = positions(linkage, rng.uniform(-4.0, 4.0, (lengths.shape[1], 9)))
    ok, size = at.valid, lengths.sum(axis=0)[:, None]
    assert ok.mean() > 0.01
    assert (np.abs(np.abs(at.b - at.a) - linkage.coupler[:, None]) / size)[ok].max() < 1e-12
    assert (np.abs(np.abs(at.b - linkage.output_pivot[:, None]) - linkage.output[:, None]) / size)[ok].max() < 1e-12
