"""Code that several tests share: branches."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from kinematics.errors import MechanismError
from kinematics.linkage.planar.branches import Branch, compute_cycle
from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.drive import drive
from kinematics.linkage.planar.limits import find_branches, list_toggles
from kinematics.linkage.planar.mechanism import Mechanism, Slide
from tests.kinematics.mechanism_sampling import DYADIC, EVERY, take
from tests.oracles.constraints import SAME, Constraints, Trace
from tests.oracles.elimination import Elimination

TURN = 2.0 * np.pi


def period_of(mechanism: Mechanism) -> float:
    """Input's way after which all joints are back: as many turns as make every geared link turn whole times."""
    if mechanism.has_slide_input:
        return 1e9
    ratios = [gear.ratio for gear in mechanism.gears]
    turns = next(n for n in range(1, 10) if all(abs(n * ratio - round(n * ratio)) < 1e-9 for ratio in ratios))
    return TURN * turns


class Followed:
    """The circuits of one design as its constraints alone show them, through all configurations at some inputs."""

    def __init__(self, mechanism: Mechanism, ways: list[float], rng: np.random.Generator) -> None:
        self.slide = mechanism.has_slide_input
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
    unit = float(constraints.size[0]) if mechanism.has_slide_input else 1.0
    at = float(mechanism.reference_input) + x[-1] * unit
    held = []
    for n, branch in enumerate(found):
        offset = at - branch.low if mechanism.has_slide_input else float(np.mod(at - branch.low, period))
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
    found = find_branches(mechanism)
    period = period_of(mechanism)
    constraints = Constraints.of(mechanism)
    unit = float(constraints.size[0]) if mechanism.has_slide_input else 1.0
    reference = float(mechanism.reference_input)
    middles = [((b.low + b.high) / 2.0 - reference) / unit for b in found]
    spread = 0.5 if mechanism.has_slide_input else period / 2.0
    ways = [0.0, *rng.uniform(-spread, spread, inputs)]
    ways += [w for w in middles if not any(abs(w - other) < 1e-3 for other in ways)]
    followed = Followed(mechanism, [float(w) for w in dict.fromkeys(ways)], rng)
    assert len(followed.traces) == 1 + max(b.circuit for b in found)
    if mechanism.has_slide_input or not found[0].signs:
        count = sum(max(1, len(trace.toggles)) for trace in followed.traces)
        assert len(found) == count
    else:
        held = [holding(found, mechanism, constraints, x, period) for x in followed.configurations]
        assert same_partition([found[n].circuit for n in held], [place[0] for place in followed.places])
        assert same_partition(list(held), list(followed.places))
        assert set(held) == set(range(len(found)))
    mine = list_toggles(mechanism, found)
    theirs = followed.toggles()
    each = np.array([x for n, x in enumerate(theirs) if n == 0 or x - theirs[n - 1] > 1e-8 * unit])
    assert len(mine) == len(each)
    gap = np.abs(np.array(mine) - each)
    assert np.minimum(gap, np.abs(gap - period)).max(initial=0.0) < 1e-10 * unit
    return 1 + max(b.circuit for b in found), len(found)


TYPES = [name for name in EVERY if name not in ("Peaucellier", "geared fivebar")]


# -- elimination -------------------------------------------------------------------------------------------------------


ELIMINATED = [name for name in DYADIC if name not in ("Peaucellier", "geared fivebar") and "slider-crank d" not in name]


def same_branches(mechanism: Mechanism, turns: int = 1) -> int:
    """Branches, whose ends and number must be those by elimination; how many there are."""
    found = find_branches(mechanism)
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
    listed = find_branches(mechanism)
    if mechanism.has_slide_input or decompose(mechanism).left:
        return True
    steps = decompose(mechanism).steps
    position = [n for n, step in enumerate(steps) if step.has_two_solutions]
    period = compute_cycle(mechanism)
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
