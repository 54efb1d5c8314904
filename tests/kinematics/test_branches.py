"""Circuits, branches and toggles of any mechanism against two routes of their own.

Arc-length continuation of the constraints: all configurations at some inputs are found from random starts; each is
followed along its circuit, which needs no closure, no assembly sign and no margin. Elimination: for mechanisms that
close by dyads all toggles are roots of polynomials.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from kinematics.linkage.fourbar import CROSSED_ASSEMBLY, OPEN_ASSEMBLY, Fourbar, find_toggle_angles, positions
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.branches import Branch, compute_cycle
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, find_reference_branch, list_toggles
from kinematics.linkage.planar.mechanism import Mechanism, Slide, TopologyError
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import EVERY, RATIOS, take
from tests.kinematics.sampling import random_fourbars
from tests.kinematics.sampling import take as take_fourbar
from tests.oracles.grashof_circuits import count_circuits
from tests.support.kinematics.branches import (
    ELIMINATED,
    TURN,
    TYPES,
    check,
    degenerate,
    period_of,
    same_branches,
)

QUICK = (
    "fourbar",
    "slider-crank",
    "slider-crank driven by its slider",
    "inverted slider-crank",
    "watt_2 driven by its rocker",
)
SLOW = ("stephenson_1 driven by its input", "stephenson_2 driven by its output", "drag link and slider", "dwell_slot")


def effort(name: object, quick: Sequence[object], slow: Sequence[object]) -> list[pytest.MarkDecorator]:
    """How a case is marked: by neither group it belongs to the campaign."""
    return [] if name in quick else [pytest.mark.slow] if name in slow else [pytest.mark.campaign]


@pytest.mark.campaign
@pytest.mark.parametrize("name", [pytest.param(name, marks=effort(name, QUICK, SLOW)) for name in TYPES])
def test_circuits_branches_and_toggles(name: str) -> None:
    rng = np.random.default_rng([41, TYPES.index(name)])
    check(take(EVERY[name](rng, 2), 0), rng, 1)


@pytest.mark.campaign
@pytest.mark.parametrize("name", ["stephenson_3 driven by its output", "stephenson_2 driven by its output"])
def test_closures_that_fold_close_together(name: str) -> None:
    """Two closures bound a branch within half a degree: the least of their margins has a corner there."""
    design = 4 if "3" in name else 0
    mechanism = take(EVERY[name](np.random.default_rng([42, TYPES.index(name)]), 5), design)
    check(mechanism, np.random.default_rng(47), 0)


@pytest.mark.parametrize("name", ELIMINATED)
def test_branches_are_those_by_elimination(name: str) -> None:
    mechanism = EVERY[name](np.random.default_rng([48, list(EVERY).index(name)]), 3)
    for k in range(3):
        same_branches(take(mechanism, k))


def test_branches_of_geared_fivebars_are_those_by_elimination() -> None:
    for n, ratio in enumerate((*RATIOS, -0.75)):
        mechanism = take(sampling.geared_fivebar(np.random.default_rng([49, n]), 1, ratio), 0)
        same_branches(mechanism, round(period_of(mechanism) / TURN))


def test_short_branch_between_two_closures() -> None:
    """This one has a branch of 0.6° that the least of its margins does not show at 720 places a turn."""
    name = "stephenson_3 driven by its rocker"
    mechanism = take(EVERY[name](np.random.default_rng([42, list(EVERY).index(name)]), 5), 4)
    assert same_branches(mechanism) == 12


def test_gears_that_do_not_repeat_are_refused() -> None:
    mechanism = take(sampling.geared_fivebar(np.random.default_rng(50), 1, float(np.sqrt(2.0))), 0)
    with pytest.raises(TopologyError, match="repeat"):
        find_branches(mechanism)


def test_cycle_is_as_many_turns_as_the_gears_need() -> None:
    for ratio in (*RATIOS, 0.0, 1.2, -0.75):
        mechanism = take(sampling.geared_fivebar(np.random.default_rng(46), 1, ratio), 0)
        assert compute_cycle(mechanism) == pytest.approx(period_of(mechanism), rel=1e-15)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [pytest.param(ratio, marks=effort(ratio, (-1.0, 0.5), ())) for ratio in RATIOS])
def test_circuits_branches_and_toggles_of_geared_fivebars(ratio: float) -> None:
    rng = np.random.default_rng([43, RATIOS.index(ratio)])
    check(take(sampling.geared_fivebar(rng, 1, ratio), 0), rng, 1)


# -- fourbars ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [60, pytest.param(400, marks=pytest.mark.slow)])
def test_fourbars_as_grashofs_rule_counts_them(n: int) -> None:
    rng = np.random.default_rng(45)
    linkages = random_fourbars(rng, n, 1e-3)
    seen = set()
    for k in range(n):
        linkage = take_fourbar(linkages, k)
        expected = count_circuits(linkage)
        theta = np.linspace(0.0, TURN, 3000)
        closes = positions(linkage, theta).valid
        mechanism = catalogue.make_fourbar(linkage, theta[int(np.argmax(closes))], OPEN_ASSEMBLY)
        found = find_branches(mechanism)
        assert 1 + max(b.circuit for b in found) == expected.circuits
        assert len(found) == expected.circuits * expected.branches
        mine, theirs = list_toggles(mechanism, found), np.sort(np.mod(find_toggle_angles(linkage), TURN))
        assert len(mine) == len(theirs)
        assert np.abs(np.array(mine) - theirs).max(initial=0.0) < 1e-10
        seen.add(tuple(expected))
    assert seen == {(1, 2), (2, 1), (2, 2)}


CHANGE_POINTS = {
    "parallelogram": ((1.0, 3.0, 1.0, 3.0), [0.0, np.pi]),
    "deltoid, crank short": ((1.0, 3.0, 3.0, 1.0), [0.0]),
    "deltoid, crank long": ((3.0, 3.0, 1.0, 1.0), [0.0]),
    "crank-rocker's limit": ((1.0, 3.0, 2.0, 2.0), [0.0]),
    "double crank's limit": ((3.0, 2.0, 2.0, 1.0), [np.pi]),
    "double rocker's limit": ((2.0, 1.0, 3.0, 2.0), None),
}


@pytest.mark.parametrize("name", CHANGE_POINTS)
def test_change_points_join_all_into_one_circuit(name: str) -> None:
    """Where S + L = P + Q every configuration is reached from every other through the change point."""
    lengths, points = CHANGE_POINTS[name]
    linkage = Fourbar.from_lengths(*lengths)
    theta = np.linspace(0.05, TURN, 100)
    at = float(theta[int(np.argmax(positions(linkage, theta).valid))])
    for sign in (OPEN_ASSEMBLY, CROSSED_ASSEMBLY):
        found = find_branches(catalogue.make_fourbar(linkage, at, sign))
        assert {b.circuit for b in found} == {0}
        held = find_reference_branch(catalogue.make_fourbar(linkage, at, sign), found)
        assert held is not None
        assert held.signs == (-sign,)  # open is B to the left of A → O4, where the closure's angle is negative
        if points is not None:
            ends = np.mod([x for b in found for x in (b.low, b.high)], TURN)
            assert all(np.abs(np.exp(1j * ends) - np.exp(1j * point)).min() < 1e-7 for point in points)


# -- other change points -----------------------------------------------------------------------------------------------


def crossing(found: list[Branch], at: float) -> list[Branch]:
    """Branches that hold an input in their inside."""
    return [b for b in found if 1e-6 < np.mod(at - b.low, TURN) < b.high - b.low - 1e-6]


def test_flat_rhombus_of_peaucelliers_cell_is_a_change_point() -> None:
    """Where A and P meet, |O4 A|² = arm² − side², the motion on the line and the one with P on A cross."""
    crank, arm, side = 1.3, 2.5, 1.1
    mechanism = catalogue.make_peaucellier(0j, -crank + 0j, crank, arm, side, 0.6)
    found = find_branches(mechanism)
    flat = np.arccos((arm**2 - side**2) / (2.0 * crank**2) - 1.0)
    assert {b.circuit for b in found} == {0}
    assert len(found) == 12
    for at in (flat, -flat):
        assert not crossing(found, at)
        ends = np.array([end for b in found for end in (b.low, b.high)])
        assert (np.abs(np.exp(1j * ends) - np.exp(1j * at)) < 1e-12).sum() == 8
    held = find_reference_branch(mechanism, found)
    assert held is not None
    assert held.high_closure == "side_3"
    motion = drive(mechanism, np.linspace(-flat, flat, 9)[1:-1])
    assert motion.valid.all()
    assert np.ptp(motion.joints["P"][0].real) < 1e-12


@pytest.mark.parametrize("offset", [0.0, 0.4])
def test_pin_that_passes_the_pivot_of_its_slide(offset: float) -> None:
    """A sliding line through the pivot, and a crank as long as the ground: there the output swings freely.

    Beside it the motion goes on with the other assembly, which turns the output on smoothly. With the line beside the
    pivot the mechanism ends before.
    """
    crank = catalogue.make_inverted_slider_crank(0j, 1.0, 1.0, offset, np.pi / 2.0, 2.0)
    found = find_branches(crank)
    assert not crossing(found, 0.0)
    if offset:
        ends = sorted((b.low, b.high) for b in found)
        folded = 2.0 * np.arcsin(offset / 2.0)
        np.testing.assert_allclose(ends, [(folded, TURN - folded)] * 2, atol=1e-12)
        return
    assert sorted(np.round((b.high - b.low) / TURN, 12) for b in found) == [1.0, 1.0]
    assert {b.circuit for b in found} == {0}
    assert not any(b.full for b in found)
    near = np.array([-1e-4, 1e-4])
    before, after = (drive(crank, near, signs=(np.array(sign),)).angles["output"][0] for sign in (1, -1))
    assert abs(np.exp(1j * before[0]) - np.exp(1j * after[1])) < 1e-3
    assert abs(np.exp(1j * before[0]) - np.exp(1j * before[1])) > 1.9
    assert not drive(crank, [0.0]).valid[0]


def test_ram_on_a_rocker_that_swings_freely_is_refused() -> None:
    """There the ram may go with the rocker or stop it: the circuits are not listed, and it is said why."""
    with pytest.raises(TopologyError, match="'rocker' swings freely"):
        find_branches(catalogue.make_quick_return(0j, -1.0, 1.0, 1.0, 3.0, 1j, 0.0, 0.5))


def test_slider_that_drives_a_crank_as_long_as_its_coupler() -> None:
    """With the slider on the pivot the crank turns freely: a branch for it, and a change point for the slider."""
    by_slider = catalogue.make_slider_crank(0j, 0j, 0.0, 1.0, 1.0, 0.3, driven_by="slider")
    found = find_branches(catalogue.make_slider_crank(0j, 0j, 0.0, 1.0, 1.0, 0.3))
    assert {b.circuit for b in found} == {0}
    spans = find_branches(by_slider)
    assert sorted((round(b.low, 9), round(b.high, 9)) for b in spans) == [(-2.0, 0.0)] * 2 + [(0.0, 2.0)] * 2


def test_slide_of_a_link_without_a_way() -> None:
    """Where no assembly exists but the reference, at which all links are in line, there is no branch."""
    line = Slide("B", "ground", np.asarray(3.0 + 0j), np.asarray(np.pi / 2.0))
    mechanism = Mechanism(
        {"O2": 0.0, "A": 1.0, "B": 3.0},
        {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B")},
        "crank",
        (line,),
    )
    assert find_branches(mechanism) == []
    assert find_reference_branch(mechanism, []) is None


@pytest.mark.parametrize("name", EVERY)
def test_degenerate_designs_are_answered_right_or_refused(name: str) -> None:
    assert degenerate(name, 51, 6) > 0


def test_dyad_that_is_always_folded_is_refused() -> None:
    """Fixed pivots on each other, and links that just reach: all turns as one body, and the assembly is undecided."""
    joints = {"O2": 0j, "O4": 0j, "A": 3.0 + 0j, "B": 1.0 + 0j, "P": 1.0 + 1j}
    links = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
    with pytest.raises(TopologyError, match="folded flat at every input"):
        find_branches(Mechanism({**joints}, links, "input"))


def test_slide_that_cannot_be_moved_has_no_branch() -> None:
    """A crank as long as its coupler, and a line square to the way out: the slider rests, the crank turns."""
    line = Slide("B", "ground", np.asarray(0j), np.asarray(0.0))
    links = {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B")}
    assert find_branches(Mechanism({"O2": 2j, "A": 1j, "B": 0j}, links, "B", (line,))) == []
