"""The transmission angles of a triad against their definition, moved by hand, and against the toggles."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root

from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.drive import drive, is_reachable
from kinematics.linkage.planar.limits import find_branches, find_reference_branch
from kinematics.linkage.planar.mechanism import Mechanism
from kinematics.linkage.planar.triad_transmission import Leg, find_triad
from tests.kinematics.mechanism_sampling import CLASS_THREE, fourbar, take

NAMES = ["stephenson_2 driven by its input", "stephenson_3 driven by its output"]
MOVED, TURN = 1e-5, 2.0 * np.pi


def test_the_legs_are_found() -> None:
    """Stephenson II driven by its output has two ternary links in a loop and no triad; a fourbar has none either."""
    rng = np.random.default_rng(5)
    triads = {name: find_triad(take(CLASS_THREE[name](rng, 2), 0)) for name in CLASS_THREE}
    legs = {name: None if triad is None else [leg.link for leg in triad] for name, triad in triads.items()}
    assert legs == {
        NAMES[0]: ["link_3", "link_5", "output"],
        "stephenson_2 driven by its output": None,
        NAMES[1]: ["input", "rocker", "link_5"],
    }
    assert find_triad(take(fourbar(rng, 2), 0)) is None


def carried(legs: tuple[Leg, Leg], pins: dict[str, complex], third: str, turn: float) -> complex:
    """Where the third pin goes when the carried link turns by a little on the two other legs, their outer pins held."""
    lengths = [abs(pins[leg.inner] - pins[leg.outer]) for leg in legs]

    def gaps(shift: np.ndarray) -> list[float]:
        moved = [complex(*shift) + pins[third] + (pins[leg.inner] - pins[third]) * np.exp(1j * turn) for leg in legs]
        return [abs(z - pins[leg.outer]) - r for z, leg, r in zip(moved, legs, lengths, strict=True)]

    found = root(gaps, [0.0, 0.0], tol=1e-15)
    return complex(*found.x)


@pytest.mark.parametrize("at", range(3))
@pytest.mark.parametrize("name", NAMES)
def test_the_sine_is_that_of_the_leg_and_the_normal_of_the_path(name: str, at: int) -> None:
    designs = CLASS_THREE[name](np.random.default_rng(11), 40)
    compared = 0
    for n in range(40):
        mechanism = take(designs, n)
        triad = find_triad(mechanism)
        assert triad is not None
        motion = drive(mechanism, mechanism.reference_input + np.array([0.0, 0.05]), order=0)
        if not motion.valid.all():
            continue
        pins = {joint: complex(jet[0, 1]) for joint, jet in motion.joints.items()}
        leg, guides = triad[at], (triad[at - 2], triad[at - 1])
        there, back = (carried(guides, pins, leg.inner, turn) for turn in (MOVED, -MOVED))
        path = there - back
        if not 0.05 * MOVED < abs(path) < 20.0 * MOVED:
            continue
        expected = abs(np.cos(np.angle((pins[leg.inner] - pins[leg.outer]) / path)))
        assert abs(motion.sines[leg.link][1]) == pytest.approx(expected, abs=1e-5)
        compared += 1
    assert compared >= 15


@pytest.mark.parametrize("name", NAMES)
def test_the_angles_vanish_at_toggles_and_only_there(name: str) -> None:
    designs = CLASS_THREE[name](np.random.default_rng(23), 12)
    met = 0
    for n in range(12):
        mechanism: Mechanism = take(designs, n)
        triad = find_triad(mechanism)
        assert triad is not None
        branch = find_reference_branch(mechanism, find_branches(mechanism))
        if branch is None:
            continue
        at = float(mechanism.reference_input)
        around = TURN * np.round((at - 0.5 * (branch.low + branch.high)) / TURN)
        low, high = (at, at + TURN) if branch.full else (branch.low + around, branch.high + around)
        inside = np.linspace(low, high, 400)
        if not branch.full:
            inside = np.concatenate([inside[1:-1], [low + 1e-8, high - 1e-8]])
        motion = drive(mechanism, inside, order=0)
        sines = np.array([motion.sines[leg.link] for leg in triad])
        assert np.all(sines > 0.0) or np.all(sines < 0.0)
        if not branch.full:
            # Where two legs meet near the pin of the third, its own angle falls last.
            assert np.all(np.sort(np.abs(sines[:, -2:]), axis=0)[1] < 0.05)
            met += 1
    assert met >= 3


def test_where_two_legs_meet_near_the_third_pin_they_point_at_it() -> None:
    """The output is pushed at a right angle, at an arm of a thousandth: a little play and link 4 turns over."""
    joints = {"O2": 0j, "A": -2.0 - 1.0j, "C": -2.0 + 1.0j, "B": -1.0 - 0.5j, "D": -1.0 + 0.5j, "E": 1e-3 + 0j}
    mechanism = catalogue.make_sixbar("stephenson_2", {**joints, "P": 0.2 + 0.2j, "O4": 1e-3 - 1.0j})
    motion = drive(mechanism, [float(mechanism.reference_input)], order=0)
    angles = {link: float(np.degrees(np.arcsin(abs(sine[0])))) for link, sine in motion.sines.items()}
    assert angles["output"] == pytest.approx(90.0)
    assert 0.0 < angles["link_3"] < 0.1
    assert 0.0 < angles["link_5"] < 0.1


@pytest.mark.parametrize("name", NAMES)
def test_the_references_branch_does_not_depend_on_the_order_of_branches(name: str) -> None:
    """Two branches between the same two toggles may differ by a turn; following the motion tells which it is."""
    designs = CLASS_THREE[name](np.random.default_rng(23), 12)
    for n in range(12):
        mechanism: Mechanism = take(designs, n)
        found = find_branches(mechanism)
        held = find_reference_branch(mechanism, found)
        other = find_reference_branch(
            mechanism, sorted(found, key=lambda branch: (branch.circuit, -branch.low, -branch.high))
        )
        assert (held is None) == (other is None)
        if held is not None and other is not None:
            # Two branches of one circuit may lie between the same two toggles, which rounding alone tells apart.
            assert (held.circuit, held.full) == (other.circuit, other.full)
            assert [held.low, held.high] == pytest.approx([other.low, other.high], abs=1e-9)
        if held is not None and not held.full:
            at = float(mechanism.reference_input)
            low = at - np.mod(at - held.low, TURN)
            inside = np.linspace(low, low + held.high - held.low, 60)[1:-1]
            assert is_reachable(mechanism, inside).all() or held.high - held.low > TURN
