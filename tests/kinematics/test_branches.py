"""Circuits, branches and toggles of any mechanism against arc-length continuation of its constraints.

All configurations at some inputs are found from random starts; each is followed along its circuit, which needs no
closure, no assembly sign and no margin. What they have in common must be what the branches say.
"""

from __future__ import annotations

import numpy as np
import pytest

from kinematics.linkage import CROSSED, OPEN, Fourbar, catalogue, count_circuits, positions, toggle_angles
from kinematics.linkage.branches import Branch, cycle
from kinematics.linkage.closures import decompose
from kinematics.linkage.drive import drive
from kinematics.linkage.limits import branches, holding_reference, toggles
from kinematics.linkage.mechanism import Mechanism
from tests.kinematics import mechanism_sampling as sampling
from tests.kinematics.mechanism_sampling import EVERY, RATIOS, take
from tests.kinematics.sampling import random_fourbars
from tests.kinematics.sampling import take as take_fourbar
from tests.oracles.constraints import SAME, Constraints, Trace

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


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else [pytest.mark.slow]) for name in TYPES]
)
def test_circuits_branches_and_toggles(name: str) -> None:
    rng = np.random.default_rng([41, TYPES.index(name)])
    check(take(EVERY[name](rng, 2), 0), rng, 1)


def test_cycle_is_as_many_turns_as_the_gears_need() -> None:
    for ratio in (*RATIOS, 0.0, 1.2, -0.75):
        mechanism = take(sampling.geared_fivebar(np.random.default_rng(46), 1, ratio), 0)
        assert cycle(mechanism) == pytest.approx(period_of(mechanism), rel=1e-15)


@pytest.mark.parametrize(
    "ratio", [pytest.param(ratio, marks=[] if ratio in (-1.0, 0.5) else [pytest.mark.slow]) for ratio in RATIOS]
)
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
