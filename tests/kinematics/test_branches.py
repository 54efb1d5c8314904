"""Circuits, branches and toggles of any mechanism against two routes of their own.

Arc-length continuation of the constraints: all configurations at some inputs are found from random starts; each is
followed along its circuit, which needs no closure, no assembly sign and no margin. Elimination: for mechanisms that
close by dyads all toggles are roots of polynomials.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import pytest

from kinematics.errors import MechanismError
from kinematics.linkage.fourbar import CROSSED, OPEN, Fourbar, positions, toggle_angles
from kinematics.linkage.planar import catalogue
from kinematics.linkage.planar.branches import Branch, cycle
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import branches, holding_reference, toggles
from kinematics.linkage.planar.mechanism import Mechanism, Slide, TopologyError
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import DYADIC, EVERY, RATIOS, take
from tests.kinematics.sampling import random_fourbars
from tests.kinematics.sampling import take as take_fourbar
from tests.oracles.constraints import SAME, Constraints, Trace
from tests.oracles.elimination import Elimination
from tests.oracles.grashof_circuits import count_circuits

TURN = 2.0 * np.pi


def period_of(mechanism: Mechanism) -> float:
    """Input's way after which all joints are back: as many turns as make every geared link turn whole times."""
    if mechanism.driven_by_slide:
        return 1e9
    ratios = [gear.ratio for gear in mechanism.gears]
    turns = next(n for n in range(1, 10) if all(abs(n * ratio - round(n * ratio)) < 1e-9 for ratio in ratios))
    return TURN * turns


class Followed:
    """The circuits of one design as its constraints alone show them, through all configurations at some inputs."""

    def __init__(self, mechanism: Mechanism, ways: list[float], rng: np.random.Generator) -> None:
        self.slide = mechanism.driven_by_slide
        self.period = period_of(mechanism)
        self.constraints = Constraints.of(mechanism)
        self.reference = float(mechanism.reference_input)
        self.unit = float(self.constraints.size[0]) if self.slide else 1.0
        self.configurations: list[np.ndarray] = []
        self.circuit: list[int] = []
        self.branch: list[tuple[int, int]] = []
        self.traces: list[Trace] = []
        for way in ways:
            for x in self.constraints.all_configurations(0, way, rng, 100):
                self.configurations.append(x)
        places: dict[int, tuple[int, int]] = {}
        for n, x in enumerate(self.configurations):
            if n in places:
                continue
            trace = self.constraints.follow(x[None])[0]
            assert trace.ended == "closed", "a change point"
            turns = [k for k, _ in trace.toggles]
            self.traces.append(trace)
            for way in ways:
                for k, met in trace.at(way, self.period):
                    for m, other in enumerate(self.configurations):
                        if np.abs(met - other)[:-1].max() < SAME and m not in places and self._near(met, other):
                            places[m] = len(self.traces) - 1, sum(t < k for t in turns) % max(len(turns), 1)
            assert n in places
        self.places = [places[n] for n in range(len(self.configurations))]

    def _near(self, one: np.ndarray, other: np.ndarray) -> bool:
        return abs(np.remainder(one[-1] - other[-1] + self.period / 2.0, self.period) - self.period / 2.0) < SAME

    def toggles(self) -> np.ndarray:
        """Inputs at which a circuit turns back."""
        found = [self.reference + way * self.unit for trace in self.traces for _, way in trace.toggles]
        return np.sort(np.array(found) if self.slide else np.remainder(found, self.period))


def holding(found: list[Branch], mechanism: Mechanism, constraints: Constraints, x: np.ndarray, period: float) -> int:
    """The branch whose own assembly, driven to the configuration's input, is the configuration."""
    unit = float(constraints.size[0]) if mechanism.driven_by_slide else 1.0
    at = float(mechanism.reference_input) + x[-1] * unit
    held = []
    for n, branch in enumerate(found):
        offset = at - branch.low if mechanism.driven_by_slide else float(np.mod(at - branch.low, period))
        if not (branch.full or offset <= branch.high - branch.low):
            continue
        motion = drive(mechanism, [at], signs=tuple(np.array(s) for s in _every_sign(mechanism, branch)), order=0)
        mine = constraints.pack({name: z[0] for name, z in motion.joints.items()}, x[-1])
        if np.abs(mine - x).max() < SAME:
            held.append(n)
    assert len(held) == 1, held
    return held[0]


def _every_sign(mechanism: Mechanism, branch: Branch) -> list[int]:
    rest = iter(branch.signs)
    return [next(rest) if step.has_two_solutions else 1 for step in decompose(mechanism).steps]


def same_partition(one: list[object], other: list[object]) -> bool:
    """Whether two labellings put the same things together."""
    return len(set(zip(one, other, strict=True))) == len(set(one)) == len(set(other))


def check(mechanism: Mechanism, rng: np.random.Generator, inputs: int = 3) -> tuple[int, int]:
    """One design: branches against the traced circuits; number of circuits and branches."""
    found = branches(mechanism)
    period = period_of(mechanism)
    constraints = Constraints.of(mechanism)
    unit = float(constraints.size[0]) if mechanism.driven_by_slide else 1.0
    reference = float(mechanism.reference_input)
    middles = [((b.low + b.high) / 2.0 - reference) / unit for b in found]
    spread = 0.5 if mechanism.driven_by_slide else period / 2.0
    ways = [0.0, *rng.uniform(-spread, spread, inputs)]
    ways += [w for w in middles if not any(abs(w - other) < 1e-3 for other in ways)]
    followed = Followed(mechanism, [float(w) for w in dict.fromkeys(ways)], rng)
    assert len(followed.traces) == 1 + max(b.circuit for b in found)
    if mechanism.driven_by_slide or not found[0].signs:
        count = sum(max(1, len(trace.toggles)) for trace in followed.traces)
        assert len(found) == count
    else:
        held = [holding(found, mechanism, constraints, x, period) for x in followed.configurations]
        assert same_partition([found[n].circuit for n in held], [place[0] for place in followed.places])
        assert same_partition(list(held), list(followed.places))
        assert set(held) == set(range(len(found)))
    mine = toggles(mechanism, found)
    theirs = followed.toggles()
    each = np.array([x for n, x in enumerate(theirs) if n == 0 or x - theirs[n - 1] > 1e-8 * unit])
    assert len(mine) == len(each)
    gap = np.abs(np.array(mine) - each)
    assert np.minimum(gap, np.abs(gap - period)).max(initial=0.0) < 1e-10 * unit
    return 1 + max(b.circuit for b in found), len(found)


TYPES = [name for name in EVERY if name not in ("Peaucellier", "geared fivebar")]


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


# -- elimination -------------------------------------------------------------------------------------------------------


ELIMINATED = [name for name in DYADIC if name not in ("Peaucellier", "geared fivebar") and "slider-crank d" not in name]


def same_branches(mechanism: Mechanism, turns: int = 1) -> int:
    """Branches, whose ends and number must be those by elimination; how many there are."""
    found = branches(mechanism)
    mine = sorted((b.low, b.high, b.full) for b in found)
    theirs = Elimination.of(mechanism, turns).branches()
    assert [b[2] for b in mine] == [b[2] for b in theirs]
    ends, others = (np.array([b[:2] for b in listed]).reshape(-1, 2) for listed in (mine, theirs))
    assert np.abs(np.exp(1j * ends / turns) - np.exp(1j * others / turns)).max(initial=0.0) < 1e-9
    shared(found, [step.link for step in decompose(mechanism).steps if step.has_two_solutions], turns * TURN)
    return len(found)


def shared(found: list[Branch], closing: list[str], period: float) -> None:
    """Each toggle of a mechanism without change points is the end of two branches: only the folded assembly differs.

    Branches that are joined so, and no others, are one circuit.
    """
    joined = {n: {n} for n in range(len(found))}
    for high in (False, True):
        for n, branch in enumerate(found):
            if branch.full:
                continue
            at, link = (branch.high, branch.high_closure) if high else (branch.low, branch.low_closure)
            partners = []
            for m, other in enumerate(found):
                if other.full:
                    continue
                there, folded = (other.high, other.high_closure) if high else (other.low, other.low_closure)
                apart = abs(np.mod(there - at + period / 2.0, period) - period / 2.0)
                differ = [k for k, a, b in zip(closing, branch.signs, other.signs, strict=True) if a != b]
                if folded == link and differ == [link] and apart < 1e-9 and other.circuit == branch.circuit:
                    partners.append(m)
            assert len(partners) == 1
            whole = joined[n] | joined[partners[0]]
            joined |= dict.fromkeys(whole, whole)
    assert len({frozenset(whole) for whole in joined.values()}) == len({branch.circuit for branch in found})


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
        branches(mechanism)


def test_cycle_is_as_many_turns_as_the_gears_need() -> None:
    for ratio in (*RATIOS, 0.0, 1.2, -0.75):
        mechanism = take(sampling.geared_fivebar(np.random.default_rng(46), 1, ratio), 0)
        assert cycle(mechanism) == pytest.approx(period_of(mechanism), rel=1e-15)


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
        mechanism = catalogue.fourbar(linkage, theta[int(np.argmax(closes))], OPEN)
        found = branches(mechanism)
        assert 1 + max(b.circuit for b in found) == expected.circuits
        assert len(found) == expected.circuits * expected.branches
        mine, theirs = toggles(mechanism, found), np.sort(np.mod(toggle_angles(linkage), TURN))
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
    for sign in (OPEN, CROSSED):
        found = branches(catalogue.fourbar(linkage, at, sign))
        assert {b.circuit for b in found} == {0}
        held = holding_reference(catalogue.fourbar(linkage, at, sign), found)
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
    mechanism = catalogue.peaucellier(0j, -crank + 0j, crank, arm, side, 0.6)
    found = branches(mechanism)
    flat = np.arccos((arm**2 - side**2) / (2.0 * crank**2) - 1.0)
    assert {b.circuit for b in found} == {0}
    assert len(found) == 12
    for at in (flat, -flat):
        assert not crossing(found, at)
        ends = np.array([end for b in found for end in (b.low, b.high)])
        assert (np.abs(np.exp(1j * ends) - np.exp(1j * at)) < 1e-12).sum() == 8
    held = holding_reference(mechanism, found)
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
    crank = catalogue.inverted_slider_crank(0j, 1.0, 1.0, offset, np.pi / 2.0, 2.0)
    found = branches(crank)
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
        branches(catalogue.quick_return(0j, -1.0, 1.0, 1.0, 3.0, 1j, 0.0, 0.5))


def test_slider_that_drives_a_crank_as_long_as_its_coupler() -> None:
    """With the slider on the pivot the crank turns freely: a branch for it, and a change point for the slider."""
    by_slider = catalogue.slider_crank(0j, 0j, 0.0, 1.0, 1.0, 0.3, driven_by="slider")
    found = branches(catalogue.slider_crank(0j, 0j, 0.0, 1.0, 1.0, 0.3))
    assert {b.circuit for b in found} == {0}
    spans = branches(by_slider)
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
    assert branches(mechanism) == []
    assert holding_reference(mechanism, []) is None


# -- joints on small whole numbers: pins on each other, links of one length, all in line -------------------------------


def on_whole_numbers(name: str, rng: np.random.Generator) -> Mechanism:
    """A mechanism of a type with its joints on a grid of 3 × 3 or 5 × 5 points."""
    pattern = take(EVERY[name](rng, 1), 0)
    reach = int(rng.integers(1, 3))
    joints = {joint: complex(*rng.integers(-reach, reach + 1, 2)) for joint in pattern.joints}
    slides = []
    for slide in pattern.slides:
        angle = float(rng.integers(0, 4)) * np.pi / 4.0
        point = joints[slide.joint] + int(rng.integers(-1, 2)) * np.exp(1j * angle)
        slides.append(Slide(slide.joint, slide.link, np.asarray(point), np.asarray(angle)))
    gears = tuple(gear._replace(ratio=float(rng.choice([1.0, -1.0, 2.0, 0.5]))) for gear in pattern.gears)
    return Mechanism({**joints}, pattern.links, pattern.input, tuple(slides), gears)


def right_or_refused(mechanism: Mechanism) -> bool:
    """Nothing but numbers where valid, all constraints kept, and each assembly just where its branches are."""
    at = mechanism.reference_input + np.linspace(-np.pi, np.pi, 25)
    found = drive(mechanism, at)
    for jets in (found.joints, found.angles, found.slides):
        for jet in jets.values():
            np.testing.assert_array_equal(np.isfinite(jet[0]), found.valid)
            np.testing.assert_array_equal(np.isfinite(jet).all(axis=0), found.smooth)
    for link, listed in mechanism.links.items():
        for one, other in pairwise(listed):
            length = np.abs(mechanism.joints[one] - mechanism.joints[other])
            off = np.abs(np.abs(found.joints[one][0] - found.joints[other][0]) - length)
            assert off[found.valid].max(initial=0.0) < 1e-11, link
    listed = branches(mechanism)
    if mechanism.driven_by_slide or decompose(mechanism).left:
        return True
    steps = decompose(mechanism).steps
    position = [n for n, step in enumerate(steps) if step.has_two_solutions]
    period = cycle(mechanism)
    inputs = np.linspace(0.0, period, 97) + 0.0123
    for choice in np.ndindex(*(2,) * len(position)):
        signs = [np.ones((), np.int64)] * len(steps)
        for n, sign in zip(position, choice, strict=True):
            signs[n] = np.array(1 - 2 * sign)
        valid = drive(mechanism, inputs, signs=tuple(signs), order=0).valid
        inside, edge = np.zeros(97, bool), np.zeros(97, bool)
        for branch in listed:
            if branch.signs == tuple(1 - 2 * sign for sign in choice):
                offset, way = np.mod(inputs - branch.low, period), branch.high - branch.low
                inside |= (offset <= way) | branch.full
                edge |= (np.minimum(offset, period - offset) < 1e-5) | (np.abs(offset - way) < 1e-5)
        np.testing.assert_array_equal(inside[~edge], valid[~edge])
    return True


def degenerate(name: str, seed: int, n: int) -> int:
    """How many of n designs on whole numbers are answered; the others are refused with a reason."""
    rng = np.random.default_rng([seed, list(EVERY).index(name)])
    answered = 0
    for _ in range(n):
        try:
            answered += right_or_refused(on_whole_numbers(name, rng))
        except MechanismError:
            continue
    return answered


@pytest.mark.parametrize("name", EVERY)
def test_degenerate_designs_are_answered_right_or_refused(name: str) -> None:
    assert degenerate(name, 51, 6) > 0


def test_dyad_that_is_always_folded_is_refused() -> None:
    """Fixed pivots on each other, and links that just reach: all turns as one body, and the assembly is undecided."""
    joints = {"O2": 0j, "O4": 0j, "A": 3.0 + 0j, "B": 1.0 + 0j, "P": 1.0 + 1j}
    links = {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "P"), "output": ("O4", "B")}
    with pytest.raises(TopologyError, match="folded flat at every input"):
        branches(Mechanism({**joints}, links, "input"))


def test_slide_that_cannot_be_moved_has_no_branch() -> None:
    """A crank as long as its coupler, and a line square to the way out: the slider rests, the crank turns."""
    line = Slide("B", "ground", np.asarray(0j), np.asarray(0.0))
    links = {"ground": ("O2",), "crank": ("O2", "A"), "coupler": ("A", "B")}
    assert branches(Mechanism({"O2": 2j, "A": 1j, "B": 0j}, links, "B", (line,))) == []
