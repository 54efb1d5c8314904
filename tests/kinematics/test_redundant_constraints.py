"""Mechanisms that move because their dimensions agree: more constraints than a count of freedoms allows."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches
from kinematics.linkage.planar.mechanism import Mechanism, Slide, TopologyError
from tests.support.kinematics.redundant_constraints import CRANK, LINKS, geared, parallelogram


@pytest.mark.parametrize("pivot", [5.0 + 1.3j, 5.0 + 0j])
def test_third_crank_leads_through_the_change_point(pivot: complex) -> None:
    """A dyad alone may fold over there; where the pivots are in line nothing says how the links move at that place."""
    mechanism = parallelogram(pivot)
    at = np.radians(np.arange(0.0, 361.0, 15.0))
    motion = drive(mechanism, at)
    assert motion.valid.all()
    folded = np.isclose(np.sin(at), 0.0, atol=1e-9) & (pivot.imag == 0.0)
    np.testing.assert_array_equal(motion.smooth, ~folded)
    for joint, start in (("A", 0.0), ("B", 3.0), ("C", pivot)):
        expected = start + np.exp(1j * at)
        np.testing.assert_allclose(motion.joints[joint][0], expected, atol=1e-7 if folded.any() else 1e-13)
        for n in (1, 2, 3):
            there = motion.joints[joint][n][motion.smooth]
            np.testing.assert_allclose(there, (1j**n * np.exp(1j * at))[motion.smooth], atol=1e-11)
    np.testing.assert_allclose(motion.angles["coupler"][1:, motion.smooth], 0.0, atol=1e-11)
    assert mechanism.mobility == 1
    assert mechanism.gruebler_mobility == 0


def test_parallel_cranks_stay_parallel_beside_their_change_points() -> None:
    """Half a degree from it the dyad's other assembly misses the third crank by a millionth of the size only."""
    joints = {"O2": 0.0, "O4": 140.0, "O6": 280.0, "A": 60 + 80j, "C": 200 + 80j, "B": 340 + 80j}
    links = {"ground": ("O2", "O4", "O6"), "first": ("O2", "A"), "second": ("O4", "C"), "third": ("O6", "B")}
    three = Mechanism(joints, {**links, "bar": ("A", "C", "B")}, "first")
    beside = 180.0 + np.array([-0.5, -0.1, -0.02, 0.02, 0.1, 0.5])
    inputs = np.radians(np.concatenate([np.arange(1.0, 360.0, 2.0), beside]))
    motion = drive(three, inputs, order=2)
    assert motion.smooth.all()
    assert not drive(three, np.radians([180.001]), order=2).smooth.any(), "rounding alone would be an acceleration"
    for crank in ("second", "third"):
        angle, speed, acceleration = motion.angles[crank]
        np.testing.assert_allclose(np.exp(1j * angle), np.exp(1j * inputs), atol=1e-9)
        np.testing.assert_allclose(speed, 1.0, atol=1e-9)
        np.testing.assert_allclose(acceleration, 0.0, atol=1e-4)  # rounding, over the square of the way to it


def test_bar_on_three_parallel_slides() -> None:
    """It moves along them and does not turn, whatever its two assemblies at two of the slides are."""
    joints = {"A": 0j, "B": 2.0 + 0.5j, "C": 1.0 + 1.0j}
    slides = tuple(Slide(joint, "ground", np.asarray(joints[joint]), np.asarray(0.0)) for joint in "ABC")
    motion = drive(Mechanism(joints, {"ground": (), "bar": ("A", "B", "C")}, "A", slides), [-0.3, 0.0, 7.0], speed=2.0)
    assert motion.smooth.all()
    np.testing.assert_allclose(motion.joints["C"][0], [0.7 + 1j, 1.0 + 1j, 8.0 + 1j], atol=1e-13)
    np.testing.assert_allclose(motion.slides["B"][:2], [[-0.3, 0.0, 7.0], [2.0, 2.0, 2.0]], atol=1e-13)
    np.testing.assert_allclose(motion.angles["bar"][1:], 0.0, atol=1e-13)


def test_trammel_with_a_crank_passes_its_change_points() -> None:
    """A bar of length 2 with its ends on two slides, whose middle goes round on a crank of length 1.

    Crank, bar and one slide alone may fold over where the end on the slide is above the pivot.
    """
    start = 0.4
    middle = np.exp(1j * start)
    joints = {"O": 0j, "M": middle, "A": 2.0 * middle.real + 0j, "B": 2j * middle.imag}
    slides = (
        Slide("A", "ground", np.asarray(0j), np.asarray(0.0)),
        Slide("B", "ground", np.asarray(0j), np.asarray(np.pi / 2.0)),
    )
    mechanism = Mechanism(joints, {"ground": ("O",), "crank": ("O", "M"), "bar": ("M", "A", "B")}, "crank", slides)
    at = np.radians(np.arange(0.0, 360.0, 15.0))
    motion = drive(mechanism, at)
    assert motion.smooth.all()
    np.testing.assert_allclose(motion.joints["A"][0], 2.0 * np.cos(at), atol=1e-12)
    np.testing.assert_allclose(motion.joints["B"][2], -2j * np.sin(at), atol=1e-11)
    np.testing.assert_allclose(motion.angles["bar"][1], -1.0, atol=1e-12)


@pytest.mark.slow
def test_short_way_between_two_limits_is_a_motion() -> None:
    """A rocker that stands near its limit, with a copy of the coupler."""
    links = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B"), "output": ("O4", "B")}
    angle = np.arccos(-1.0 / 8.0) - 1e-3  # coupler and output are stretched at arccos(−1/8)
    crank = 2.0 * np.exp(1j * angle)
    gap = 3.0 - crank
    joint = crank + gap / abs(gap) * (abs(gap) / 2.0 + 1j * np.sqrt(14.5 / 4.0 - (abs(gap) / 2.0) ** 2))
    mechanism = Mechanism({"O2": 0j, "O4": 3.0, "A": crank, "B": joint}, links | {"copy": ("A", "B")}, "input")
    motion = drive(mechanism, [angle - 1e-3, angle, angle + 0.5])
    assert motion.valid.tolist() == [True, True, False]


def test_rates_are_those_of_the_positions() -> None:
    """A redundant crank on a parallelogram whose coupler moves a dyad: derivatives by differences."""
    joints = {"O2": 0j, "O4": 3.0, "O6": 5.0 + 1.3j, "O8": 7.0 + 4.0j}
    joints |= {"A": CRANK, "B": 3.0 + CRANK, "C": 5.0 + 1.3j + CRANK, "D": 5.0 + 4.5j, "P": 4.0 + 2.0j + CRANK}
    links = LINKS | {"ground": ("O2", "O4", "O6", "O8"), "coupler": ("A", "B", "C", "P")}
    mechanism = Mechanism(joints, links | {"rod": ("P", "D"), "output": ("O8", "D")}, "input")
    step = 1e-4
    at = 0.7 + step * np.arange(-2, 3)
    motion = drive(mechanism, at)
    assert motion.valid.all()
    for jet in motion.joints.values():
        for n in range(3):
            slope = (jet[n, 0] - 8.0 * jet[n, 1] + 8.0 * jet[n, 3] - jet[n, 4]) / (12.0 * step)
            assert slope == pytest.approx(jet[n + 1, 2], abs=1e-9)


def test_closed_train_of_gears() -> None:
    motion = drive(geared(1.0), np.linspace(0.0, 9.0, 7))
    assert motion.valid.all()
    np.testing.assert_allclose(motion.angles["second"][1], -2.0, rtol=1e-13)
    np.testing.assert_allclose(motion.angles["last"][1], 1.0, rtol=1e-13)


def test_designs_of_one_make_are_driven_together() -> None:
    pivots = np.array([5.0 + 1.3j, 1.0 - 2.0j, -2.0 + 0.5j])
    joints = {"O2": 0j, "O4": 3.0, "O6": pivots, "A": CRANK, "B": 3.0 + CRANK, "C": pivots + CRANK}
    motion = drive(Mechanism(joints, LINKS, "input"), np.linspace(0.0, 6.0, 5))
    assert motion.joints["C"].shape == (4, 3, 5)
    np.testing.assert_allclose(motion.joints["C"][0] - motion.joints["A"][0], pivots[:, None] + np.zeros(5), atol=1e-12)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: parallelogram(5.0 + 1.3j, 1.1), "in no nearby position"),
        (lambda: parallelogram(5.0 + 1.3j, 1.01), "in no nearby position"),
        (lambda: parallelogram(5.0 + 0j, crank=1.0 + 0j), "dead centre"),
        (lambda: geared(1.1), "do not agree"),
    ],
)
def test_dimensions_that_do_not_agree_are_no_mechanism(make: Callable[[], Mechanism], told: str) -> None:
    with pytest.raises(TopologyError, match=told):
        make()


def test_circuits_are_not_listed() -> None:
    with pytest.raises(TopologyError, match="redundant"):
        find_branches(parallelogram(5.0 + 1.3j))


@pytest.mark.campaign
@pytest.mark.timeout(600)
def test_a_link_beside_its_like_leaves_a_long_chain_its_motion() -> None:
    """Of two chains of twenty dyads the second is nearly singular all the way, and has its limits near by."""
    drawn = np.random.default_rng(20)
    for _ in range(2):
        joints: dict[str, complex] = {"O": 0j, "A": 1.0 + 0j}
        links = {"ground": ["O"], "crank": ["O", "A"]}
        last = "A"
        for k in range(20):
            drawn.integers(len(joints) - 1)
            joints[f"G{k}"], joints[f"P{k}"] = (complex(*drawn.uniform(-3.0, 3.0, 2)) for _ in range(2))
            links["ground"].append(f"G{k}")
            links |= {f"coupler_{k}": [last, f"P{k}"], f"rocker_{k}": [f"G{k}", f"P{k}"]}
            last = f"P{k}"
        links["twin"] = links[f"coupler_{drawn.integers(20)}"]
        named = {name: tuple(listed) for name, listed in links.items()}
        assert Mechanism({name: np.asarray(at) for name, at in joints.items()}, named, "crank").redundant == 1
