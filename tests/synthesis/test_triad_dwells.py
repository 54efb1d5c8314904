"""Stephenson II dwell sixbars as the search has them, held against the analysis core, and their exact way."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from kinematics.linkage.planar.branches import cycle, cycle_on
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import branches, cycle_from_reference, holding_reference
from synthesis.analyses.cycle import cycle_of
from synthesis.analyses.layout import layout_of
from synthesis.kinds.dwell import triads
from synthesis.kinds.dwell.candidates import Asked, Start
from synthesis.kinds.dwell.design import DwellMechanism
from synthesis.kinds.dwell.outputs import CYCLE, RESTING, Task
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.shaped import STEPHENSON_2, Sixbar, mechanism_of, way_of, with_way
from synthesis.kinds.dwell.solver import _alike
from synthesis.kinds.dwell.triad_starts import EASED, triad_starts
from synthesis.kinds.dwell.triad_turn import BEGIN, FIXED, SHORTEST, B, D, E
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.mechanisms.courses import repeated_after
from synthesis.model.dynamics import WeighedLinkage
from synthesis.model.layout import LayoutSizes
from synthesis.proof.on_branch import OnBranch
from synthesis.registry import parse_problem
from tests.support.synthesis.triad_dwells import ELSEWHERE, built

DWELLS, PLACES, WAY, ANGLE, RATIO = (1.2, 0.7), (0.0, 0.6), 0.9, 0.4, 8.0


@pytest.fixture(scope="module")
def begun() -> list[Start]:
    found = triad_starts(Asked(DWELLS, PLACES, WAY, ANGLE, RATIO), np.random.default_rng(3), 12)
    assert len(found) == 12
    return found


def test_starts_move_as_the_core_drives_them(begun: list[Start]) -> None:
    for start in begun:
        shape = start.shape
        further = shape[BEGIN] + np.array([[0.3, 2.0, 5.9]])
        driven = triads.over_a_turn(shape[None], further, CYCLE)
        inputs = shape[BEGIN] + np.arange(CYCLE + 1) * math.tau / CYCLE
        motion = drive(built(shape), inputs, order=0)
        assert motion.smooth.all()
        output = motion.angles["output"][0]
        assert np.allclose(np.unwrap(output)[:-1] - output[0], driven.course[0], atol=1e-9)
        told = np.abs(np.stack([motion.sines[name] for name in ("output", "link_3", "link_5")], axis=-1))
        assert np.allclose(told[:-1], driven.sines[0], atol=1e-9)
        assert driven.sines.min() > EASED
        elsewhere = drive(built(shape), np.concatenate([inputs[:1], further[0]]), order=0).joints
        for k, joint in enumerate("BDE"):
            assert np.allclose(elsewhere[joint][0][1:], driven.pins[0, :, k], atol=1e-9)


def test_distances_are_those_of_all_pins(begun: list[Start]) -> None:
    for start in begun:
        joints = triads.joints(start.shape)
        pins = [abs(joints[a] - joints[b]) for link in STEPHENSON_2.values() for a, b in combinations(link, 2)]
        assert sorted(triads.pin_distances(start.shape[None])[0]) == pytest.approx(sorted(pins))


def test_a_start_rests_where_it_says(begun: list[Start]) -> None:
    """The stretch of the turn is the stillest near its place, by plain windows over the output."""
    for start in begun:
        task = Task("triad", 1, DWELLS, start.places, WAY, math.sin(ANGLE), RATIO)
        values = triads.judged(task, np.linspace(0.0, 1.0, RESTING), start.shape[None])
        turn = triads.over_a_turn(start.shape[None], np.empty((1, 0)), CYCLE).course[0]
        around = np.concatenate([turn, turn])
        for k, (dwell, place) in enumerate(zip(DWELLS, start.places, strict=True)):
            steps = round(dwell / math.tau * CYCLE) + 1
            windows = np.stack([around[m : m + steps] for m in range(CYCLE)])
            share = (windows.mean(axis=1) - turn.min()) / np.ptp(turn)
            worth = (np.ptp(windows, axis=1) / np.ptp(turn) + 0.5 * np.abs(share - place)).min()
            moved = np.ptp(values.banded[0, k * RESTING : (k + 1) * RESTING])
            assert moved <= worth + 0.05


def test_the_pivot_moves_along_the_line_of_the_resting_pin(begun: list[Start]) -> None:
    for start in begun:
        sixbar = Sixbar("triad", 1, start.shape, "coupler", len(DWELLS))
        made = with_way(sixbar, way_of(sixbar) * 1.02)
        if made is None:
            continue
        assert way_of(made) == pytest.approx(1.02 * way_of(sixbar), rel=1e-9)
        one, other = triads.joints(start.shape), triads.joints(made.shape)
        turned = (other["E"] - other["O2"]) / (one["E"] - one["O2"])
        assert abs(turned) == pytest.approx(1.0)
        for pin in "ABCD":
            assert other[pin] == pytest.approx(one[pin] * turned)
        line = (other["O4"] - other["E"]) / ((one["O4"] - one["E"]) * turned)
        assert line.imag == pytest.approx(0.0, abs=1e-9)
        return
    pytest.fail("no way could be changed")


"""A sixbar that meets no toggle, but is at another place after a turn of its crank, and back after two."""


def test_a_triad_that_comes_back_in_two_turns_has_a_cycle_of_two() -> None:
    mechanism = built(np.array(ELSEWHERE))
    here = holding_reference(mechanism, branches(mechanism))
    assert here is not None
    assert here.full
    assert cycle(mechanism) == math.tau
    assert cycle_on(mechanism, here) == cycle_of(mechanism)[1] - cycle_of(mechanism)[0] == 2.0 * math.tau
    own = OnBranch(mechanism, here)
    low, high = own.range
    assert high - low == pytest.approx(2.0 * math.tau)
    b = own.joint("B", np.linspace(low, high, 4001))
    assert np.abs(np.diff(b)).max() < 0.03
    assert abs(b[-1] - b[0]) < 1e-9
    assert abs(b[2000] - b[0]) > 0.1


def test_what_is_told_of_a_cycle_of_two_turns_is_of_both() -> None:
    mechanism = built(np.array(ELSEWHERE))
    assert cycle_from_reference(mechanism) == 2.0 * math.tau
    assert repeated_after(WeighedLinkage.model_validate({"gravity": {}}), mechanism) == 2
    sizes = {"link_width": 0.01, "pin_diameter": 0.005, "thickness": 0.01, "over": "cycle"}
    layout = layout_of(mechanism, LayoutSizes.model_validate(sizes), None)
    assert layout.free_range is not None
    # Parts meet in one place of two turns; the way without begins anywhere, and cut at the reference it has 594°.
    assert 650.0 < layout.free_range[1] - layout.free_range[0] < 720.0


@pytest.mark.parametrize("rule", ["comes to another place", "meets a toggle", "B on D", "E on O4"])
def test_what_does_not_go_through_its_turn_is_no_shape(begun: list[Start], rule: str) -> None:
    shape = begun[0].shape.copy()
    joints = triads.joints(shape)
    if rule == "comes to another place":
        shape = np.array([*ELSEWHERE, 0.5])
    elif rule == "meets a toggle":
        e = joints["O4"] + 0.02 * (joints["E"] - joints["O4"])
        shape[E : E + 2] = e.real, e.imag
    elif rule == "B on D":
        shape[D : D + 2] = shape[B : B + 2]
    else:
        shape[E : E + 2] = shape[FIXED], 0.0
    task = Task("triad", 1, DWELLS, PLACES, WAY, math.sin(ANGLE), RATIO)
    with np.errstate(all="ignore"):
        values = triads.judged(task, np.linspace(0.0, 1.0, 5), shape[None])
    assert not np.isfinite(values.banded).all()


def described(shape: np.ndarray) -> DwellMechanism:
    """As an answer, whatever it does."""
    problem = parse_problem({"kind": "dwell", "dwell_angle": 20.0, "output": {"type": "rocker", "swing": 25.0}})
    assert isinstance(problem, DwellProblem)
    return mechanism_of(problem, Sixbar("triad", 1, shape, "coupler", 1))


TOGGLING = {
    "O4": 20.59332987861859 + 0j,
    "A": -9.86068511203299 + 1.6633968622463384j,
    "C": -2.1143425065448036 + 7.942158467197818j,
    "B": -10.191917332413718 - 10.320647947875692j,
    "D": 0.13019744081326612 + 4.111325615037613j,
    "E": -1.218052385283705 - 2.4911137375661947j,
}
"""A sixbar that meets a toggle at 154° of its crank; driven backwards it comes to every angle of a turn."""


def toggling() -> np.ndarray:
    crank = TOGGLING["A"]
    unit = {name: z / abs(crank) for name, z in TOGGLING.items()}
    carried = unit["C"] / unit["A"]
    pins = [part for name in "BDE" for part in (unit[name].real, unit[name].imag)]
    return np.array([unit["O4"].real, carried.real, carried.imag, *pins, 0.02, np.angle(crank)])


@pytest.mark.parametrize("shape", [toggling(), np.array(ELSEWHERE)], ids=["a toggle", "another place"])
def test_nothing_is_verified_whose_crank_does_not_turn_through(shape: np.ndarray) -> None:
    swing = float(np.degrees(triads.way_of(shape, 2880)))
    assert math.isnan(swing)
    mechanism = built(shape)
    motion = drive(mechanism, float(mechanism.reference_input) + np.linspace(0.0, math.tau, 2881), order=0)
    assert motion.smooth.all()
    course = np.degrees(np.unwrap(motion.angles["output"][0]))
    problem = parse_problem(
        {"kind": "dwell", "mechanism": "stephenson_2", "dwell_angle": 20.0, "tolerance": 20.0,
         "output": {"type": "rocker", "swing": float(min(np.ptp(course), 179.0))}}
    )  # fmt: skip
    assert isinstance(problem, DwellProblem)
    assert verify_dwell(problem, described(shape)) is None


def test_a_sound_start_is_driven_by_the_verification(begun: list[Start]) -> None:
    """So that the two above are not refused for another reason."""
    shape = begun[0].shape[: BEGIN + 1]
    swing = math.degrees(triads.way_of(shape, 2880))
    problem = parse_problem(
        {"kind": "dwell", "mechanism": "stephenson_2", "dwell_angle": 20.0, "tolerance": 20.0,
         "output": {"type": "rocker", "swing": swing}}
    )  # fmt: skip
    assert isinstance(problem, DwellProblem)
    design = verify_dwell(problem, described(shape))
    assert design is not None
    assert design.metrics.way == pytest.approx(swing, rel=1e-6)


def test_sixbars_are_told_apart_by_their_links_and_not_by_when_they_dwell(begun: list[Start]) -> None:
    one = Sixbar("triad", 1, begun[0].shape, "coupler", len(DWELLS))
    later = begun[0].shape.copy()
    (b, d, e) = triads.over_a_turn(later[None], later[None, BEGIN : BEGIN + 1] + 1.0, CYCLE).pins[0, 0]
    for at, pin in ((B, b), (D, d), (E, e)):
        later[at], later[at + 1] = pin.real, pin.imag
    later[BEGIN] += 1.0
    assert _alike(one, one._replace(shape=later))
    turned = begun[0].shape.copy()
    turned[BEGIN] += 0.5
    assert not _alike(one, one._replace(shape=turned))


def test_links_are_as_even_as_is_asked(begun: list[Start]) -> None:
    """Room of the ratio is there where all distances are between the least one and so many times that."""
    shape = begun[0].shape.copy()
    lengths = triads.pin_distances(shape[None])[0]
    for ratio in (0.99, 1.01):
        shape[SHORTEST] = lengths.min() * 0.9999
        task = Task("triad", 1, DWELLS, PLACES, WAY, 0.0, ratio * lengths.max() / shape[SHORTEST])
        even = triads.judged(task, np.linspace(0.0, 1.0, 5), shape[None]).positive[0, -2 * len(lengths) :]
        assert (even > 0.0).all() == (ratio > 1.0)
