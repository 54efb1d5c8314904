"""Stephenson II dwell sixbars as the search has them, held against the analysis core, and their exact way."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
import pytest

from kinematics.linkage.planar.branches import compute_cycle, compute_cycle_on_branch
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, find_cycle_from_reference, find_reference_branch
from synthesis.analyses.linkages.cycle import find_cycle
from synthesis.analyses.linkages.layout import lay_out_mechanism
from synthesis.kinds.dwell.design import DwellMechanism
from synthesis.kinds.dwell.motion.outputs import CYCLE_SAMPLE_COUNT, DWELL_SAMPLE_COUNT, Task
from synthesis.kinds.dwell.problem import DwellProblem
from synthesis.kinds.dwell.refine import stephenson_2
from synthesis.kinds.dwell.refine.refinement import (
    STEPHENSON_2_LINKS,
    SixbarShape,
    adjust_range,
    build_mechanism,
    measure_range,
)
from synthesis.kinds.dwell.refine.stephenson_2_cycle import BEGIN_INDEX, FIXED_INDEX, SHORTEST_INDEX, B, D, E
from synthesis.kinds.dwell.solver import _is_duplicate
from synthesis.kinds.dwell.starts.coupler_curve_starts import Requirements, Start
from synthesis.kinds.dwell.starts.stephenson_2_starts import MIN_START_SINE, find_triad_starts
from synthesis.kinds.dwell.verification import verify_dwell
from synthesis.mechanisms.courses import find_period_turns
from synthesis.model.dynamics.request import LoadedLinkage
from synthesis.model.layout import LayoutSizes
from synthesis.registry import parse_problem
from synthesis.verification.branch_drive import MechanismOnBranch
from tests.support.synthesis.triad_dwells import ELSEWHERE, built

DWELLS, PLACES, WAY, ANGLE, RATIO = (1.2, 0.7), (0.0, 0.6), 0.9, 0.4, 8.0


@pytest.fixture(scope="module")
def begun() -> list[Start]:
    found = find_triad_starts(Requirements(DWELLS, PLACES, WAY, ANGLE, RATIO), np.random.default_rng(3), 12)
    assert len(found) == 12
    return found


def test_starts_move_as_the_core_drives_them(begun: list[Start]) -> None:
    for start in begun:
        shape = start.shape
        further = shape[BEGIN_INDEX] + np.array([[0.3, 2.0, 5.9]])
        driven = stephenson_2.drive_shapes(shape[None], further, CYCLE_SAMPLE_COUNT)
        inputs = shape[BEGIN_INDEX] + np.arange(CYCLE_SAMPLE_COUNT + 1) * math.tau / CYCLE_SAMPLE_COUNT
        motion = drive(built(shape), inputs, order=0)
        assert motion.smooth.all()
        output = motion.angles["output"][0]
        assert np.allclose(np.unwrap(output)[:-1] - output[0], driven.course[0], atol=1e-9)
        told = np.abs(np.stack([motion.sines[name] for name in ("output", "link_3", "link_5")], axis=-1))
        assert np.allclose(told[:-1], driven.sines[0], atol=1e-9)
        assert driven.sines.min() > MIN_START_SINE
        elsewhere = drive(built(shape), np.concatenate([inputs[:1], further[0]]), order=0).joints
        for k, joint in enumerate("BDE"):
            assert np.allclose(elsewhere[joint][0][1:], driven.pins[0, :, k], atol=1e-9)


def test_distances_are_those_of_all_pins(begun: list[Start]) -> None:
    for start in begun:
        joints = stephenson_2.name_joints(start.shape)
        pins = [abs(joints[a] - joints[b]) for link in STEPHENSON_2_LINKS.values() for a, b in combinations(link, 2)]
        assert sorted(stephenson_2.compute_pin_distances(start.shape[None])[0]) == pytest.approx(sorted(pins))


def test_a_start_rests_where_it_says(begun: list[Start]) -> None:
    """The stretch of the turn is the stillest near its place, by plain windows over the output."""
    for start in begun:
        task = Task("triad", 1, DWELLS, start.places, WAY, math.sin(ANGLE), RATIO)
        values = stephenson_2.evaluate_shapes(task, np.linspace(0.0, 1.0, DWELL_SAMPLE_COUNT), start.shape[None])
        turn = stephenson_2.drive_shapes(start.shape[None], np.empty((1, 0)), CYCLE_SAMPLE_COUNT).course[0]
        around = np.concatenate([turn, turn])
        for k, (dwell, place) in enumerate(zip(DWELLS, start.places, strict=True)):
            steps = round(dwell / math.tau * CYCLE_SAMPLE_COUNT) + 1
            windows = np.stack([around[m : m + steps] for m in range(CYCLE_SAMPLE_COUNT)])
            share = (windows.mean(axis=1) - turn.min()) / np.ptp(turn)
            worth = (np.ptp(windows, axis=1) / np.ptp(turn) + 0.5 * np.abs(share - place)).min()
            moved = np.ptp(values.banded[0, k * DWELL_SAMPLE_COUNT : (k + 1) * DWELL_SAMPLE_COUNT])
            assert moved <= worth + 0.05


def test_the_pivot_moves_along_the_line_of_the_resting_pin(begun: list[Start]) -> None:
    for start in begun:
        sixbar = SixbarShape("triad", 1, start.shape, "coupler", len(DWELLS))
        made = adjust_range(sixbar, measure_range(sixbar) * 1.02)
        if made is None:
            continue
        assert measure_range(made) == pytest.approx(1.02 * measure_range(sixbar), rel=1e-9)
        one, other = stephenson_2.name_joints(start.shape), stephenson_2.name_joints(made.shape)
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
    here = find_reference_branch(mechanism, find_branches(mechanism))
    assert here is not None
    assert here.full
    assert compute_cycle(mechanism) == math.tau
    assert (
        compute_cycle_on_branch(mechanism, here)
        == find_cycle(mechanism)[1] - find_cycle(mechanism)[0]
        == 2.0 * math.tau
    )
    own = MechanismOnBranch(mechanism, here)
    low, high = own.range
    assert high - low == pytest.approx(2.0 * math.tau)
    b = own.locate_joint("B", np.linspace(low, high, 4001))
    assert np.abs(np.diff(b)).max() < 0.03
    assert abs(b[-1] - b[0]) < 1e-9
    assert abs(b[2000] - b[0]) > 0.1


def test_what_is_told_of_a_cycle_of_two_turns_is_of_both() -> None:
    mechanism = built(np.array(ELSEWHERE))
    assert find_cycle_from_reference(mechanism) == 2.0 * math.tau
    assert find_period_turns(LoadedLinkage.model_validate({"gravity": {}}), mechanism) == 2
    sizes = {"link_width": 0.01, "pin_diameter": 0.005, "thickness": 0.01, "over": "cycle"}
    layout = lay_out_mechanism(mechanism, LayoutSizes.model_validate(sizes), None)
    assert layout.free_range is not None
    # Parts meet in one place of two turns; the way without begins anywhere, and cut at the reference it has 594°.
    assert 650.0 < layout.free_range[1] - layout.free_range[0] < 720.0


@pytest.mark.parametrize("rule", ["comes to another place", "meets a toggle", "B on D", "E on O4"])
def test_what_does_not_go_through_its_turn_is_no_shape(begun: list[Start], rule: str) -> None:
    shape = begun[0].shape.copy()
    joints = stephenson_2.name_joints(shape)
    if rule == "comes to another place":
        shape = np.array([*ELSEWHERE, 0.5])
    elif rule == "meets a toggle":
        e = joints["O4"] + 0.02 * (joints["E"] - joints["O4"])
        shape[E : E + 2] = e.real, e.imag
    elif rule == "B on D":
        shape[D : D + 2] = shape[B : B + 2]
    else:
        shape[E : E + 2] = shape[FIXED_INDEX], 0.0
    task = Task("triad", 1, DWELLS, PLACES, WAY, math.sin(ANGLE), RATIO)
    with np.errstate(all="ignore"):
        values = stephenson_2.evaluate_shapes(task, np.linspace(0.0, 1.0, 5), shape[None])
    assert not np.isfinite(values.banded).all()


def described(shape: np.ndarray) -> DwellMechanism:
    """As an answer, whatever it does."""
    problem = parse_problem({"kind": "dwell", "dwell_angle": 20.0, "output": {"type": "rocker", "swing": 25.0}})
    assert isinstance(problem, DwellProblem)
    return build_mechanism(problem, SixbarShape("triad", 1, shape, "coupler", 1))


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
    swing = float(np.degrees(stephenson_2.measure_range(shape, 2880)))
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
    shape = begun[0].shape[: BEGIN_INDEX + 1]
    swing = math.degrees(stephenson_2.measure_range(shape, 2880))
    problem = parse_problem(
        {"kind": "dwell", "mechanism": "stephenson_2", "dwell_angle": 20.0, "tolerance": 20.0,
         "output": {"type": "rocker", "swing": swing}}
    )  # fmt: skip
    assert isinstance(problem, DwellProblem)
    design = verify_dwell(problem, described(shape))
    assert design is not None
    assert design.metrics.way == pytest.approx(swing, rel=1e-6)


def test_sixbars_are_told_apart_by_their_links_and_not_by_when_they_dwell(begun: list[Start]) -> None:
    one = SixbarShape("triad", 1, begun[0].shape, "coupler", len(DWELLS))
    later = begun[0].shape.copy()
    (b, d, e) = stephenson_2.drive_shapes(
        later[None], later[None, BEGIN_INDEX : BEGIN_INDEX + 1] + 1.0, CYCLE_SAMPLE_COUNT
    ).pins[0, 0]
    for at, pin in ((B, b), (D, d), (E, e)):
        later[at], later[at + 1] = pin.real, pin.imag
    later[BEGIN_INDEX] += 1.0
    assert _is_duplicate(one, one._replace(shape=later))
    turned = begun[0].shape.copy()
    turned[BEGIN_INDEX] += 0.5
    assert not _is_duplicate(one, one._replace(shape=turned))


def test_links_are_as_even_as_is_asked(begun: list[Start]) -> None:
    """Room of the ratio is there where all distances are between the least one and so many times that."""
    shape = begun[0].shape.copy()
    lengths = stephenson_2.compute_pin_distances(shape[None])[0]
    for ratio in (0.99, 1.01):
        shape[SHORTEST_INDEX] = lengths.min() * 0.9999
        task = Task("triad", 1, DWELLS, PLACES, WAY, 0.0, ratio * lengths.max() / shape[SHORTEST_INDEX])
        even = stephenson_2.evaluate_shapes(task, np.linspace(0.0, 1.0, 5), shape[None]).positive[
            0, -2 * len(lengths) :
        ]
        assert (even > 0.0).all() == (ratio > 1.0)
