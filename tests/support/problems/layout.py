"""Code that several tests share: layout."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from functools import cache
from itertools import combinations, product
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Real
from kinematics.linkage.layout import Layout, arrange_planes
from kinematics.linkage.planar.mechanism import GROUND, Mechanism
from tests.kinematics.mechanism_sampling import EVERY, geared_fivebar, take
from tests.support.independent.drive import Drive

STEP = math.radians(0.25)
"""Of the input; that of a slide moves the quarter of a hundredth of the size."""

TOUCH = 1e-6
"""Share of the size by which solids may be nearer than the gap: what rounding and the drives leave."""

WITHIN = 3.0
"""Steps by which free ranges may differ: one at each end, and as much as the answer's ends are short of theirs."""


class Task(NamedTuple):
    """A linkage, its motion from the reference on, and what it is built of."""

    kind: str
    mechanism: Mechanism
    low: float
    high: float
    closed: bool
    width: float
    pin: float
    gap: float
    through: bool

    def answer(self) -> Layout:
        """The layout under test."""
        at = float(self.mechanism.reference_input)
        return arrange_planes(
            self.mechanism,
            at + self.low,
            at + self.high,
            link_width=self.width,
            pin_diameter=self.pin,
            gap=self.gap,
            through=self.through,
            closed=self.closed,
        )


def drive_of(mechanism: Mechanism) -> Drive:
    """The independent drive of a mechanism."""

    def point(place: Complex) -> tuple[float, float]:
        z = complex(place)
        return z.real, z.imag

    return Drive(
        SimpleNamespace(
            joints={name: point(z) for name, z in mechanism.joints.items()},
            links=[SimpleNamespace(name=name, joints=list(listed)) for name, listed in mechanism.links.items()],
            slides=[
                SimpleNamespace(joint=s.joint, link=s.link, point=point(s.point), angle=math.degrees(float(s.angle)))
                for s in mechanism.slides
            ],
            gears=[SimpleNamespace(links=(g.first, g.second), ratio=g.ratio) for g in mechanism.gears],
            input_link=mechanism.input,
        )
    )


def tasks(count: int, seed: int) -> Iterator[tuple[Task, Drive]]:
    """Linkages of all kinds in turn, each over a part of a branch or a whole turn."""
    rng = np.random.default_rng(seed)
    kinds = [*EVERY, "geared fivebar, gears against each other", "geared fivebar with an idler"]
    made = 0
    while made < count:
        kind = kinds[made % len(kinds)]
        if kind in EVERY:
            mechanism = take(EVERY[kind](rng, 1), 0)
        else:
            mechanism = take(geared_fivebar(rng, 1, -1.5 if "against" in kind else 2.0), 0)
        drive = drive_of(mechanism)
        size = drive.size
        full = not mechanism.has_slide_input and not mechanism.gears and drive.follow(-math.pi, math.pi)
        full = full and bool(np.abs(np.diff(drive.at(np.array([-math.pi, math.pi])), axis=0)).max() < 1e-9 * size)
        low, high = -math.pi, math.pi
        if not full or rng.random() < 0.4:
            full = False
            drive = drive_of(mechanism)
            low, high = np.array([-1.0, 1.0]) * rng.uniform(0.2, 2.5, 2) * (0.2 * size if drive.slides_in else 1.0)
            while not drive.follow(low, high):
                low, high = 0.7 * low, 0.7 * high
        width = size * rng.uniform(0.01, 0.07)
        sizes = width, width * rng.uniform(0.3, 1.0), size * rng.choice([0.0, 0.002, 0.01])
        yield Task(kind, mechanism, float(low), float(high), full, *sizes, bool(rng.random() < 0.3)), drive
        made += 1


class Solids(NamedTuple):
    """Plates and pins in motion: corners (samples, corners) and radii; what pins join; gears of one plane."""

    names: list[str]
    corners: list[Complex]
    radii: list[float]
    plates: int
    joined: list[set[int]]
    grounded: list[bool]
    meshes: list[list[int]]


def solids(task: Task, drive: Drive, turns: Real) -> Solids:
    """What is built, as the documentation says it, from the driven joints alone."""
    mechanism, places = task.mechanism, drive.at(turns)
    at = {name: places[:, n] for n, name in enumerate(drive.names)}
    links = [link for link in mechanism.links if link != GROUND]
    corners = []
    for link in links:
        one, other = mechanism.links[link][:2]
        home, apart = drive.home[drive.names.index(one)], at[other] - at[one]
        turn = apart / (drive.home[drive.names.index(other)] - home)
        points = [at[joint] for joint in mechanism.links[link]]
        for slide in mechanism.slides:
            if slide.link == link:
                # In the link's own frame the joint runs along its line; where it gets to is the slot.
                run = home + (at[slide.joint] - at[one]) / turn
                along = ((run - run[0]) * np.exp(-1j * slide.angle)).real
                points += [at[one] + turn * (run[k] - home) for k in (along.argmin(), along.argmax())]
        corners.append(np.stack(points, axis=1))
    radii = [0.5 * task.width] * len(links)
    names, meshes, shafts, studs = list(links), [], [], []
    for gear in mechanism.gears:
        mesh, pivots = [], []
        for link in (gear.first, gear.second):
            pivots.append(next(joint for joint in mechanism.links[link] if joint in mechanism.links[GROUND]))
        o, q = (at[pivot] for pivot in pivots)
        ratio, distance = abs(gear.ratio), abs(q[0] - o[0])
        smaller = min(ratio, 1.0) if gear.ratio > 0.0 else 0.0
        module = distance / (ratio + 1.0 + 2.0 * smaller)
        wheels = [(f"gear of {gear.first}", o, ratio), (f"gear of {gear.second}", q, 1.0)]
        wheels += [("idler", o + (q - o) / distance * (ratio + smaller) * module, smaller)] if smaller else []
        for n, (name, centre, radius) in enumerate(wheels):
            mesh.append(len(names))
            (shafts if n < 2 else studs).append((len(names), pivots[n] if n < 2 else name, centre))
            names.append(name)
            corners.append(centre[:, None])
            radii.append(radius * module)
        meshes.append(mesh)
    plates, joined, grounded = len(names), [], []
    for joint in mechanism.joints:
        holds = {n for n, link in enumerate(links) if joint in mechanism.links[link]}
        holds |= {links.index(s.link) for s in mechanism.slides if s.joint == joint and s.link != GROUND}
        holds |= {n for n, shaft, _ in shafts if shaft == joint}
        base = joint in mechanism.links[GROUND] or any(s == (joint, GROUND, *s[2:]) for s in mechanism.slides)
        if holds and len(holds) + base > 1:
            names.append(f"pin {joint}")
            corners.append(at[joint][:, None])
            joined.append(holds)
            grounded.append(base)
    for plate, name, centre in studs:
        names.append(f"pin {name}")
        corners.append(centre[:, None])
        joined.append({plate})
        grounded.append(True)
    radii += [0.5 * task.pin] * len(joined)
    return Solids(names, corners, radii, plates, joined, grounded, meshes)


def apart(first: Complex, second: Complex) -> Real:
    """Distance of the hulls of points, shapes (n, k) and (n, m): how far some direction parts them; negative: none.

    Two hulls that are apart are so in the direction from a corner to a corner, or across an edge of one of them.
    """
    k, m = first.shape[1], second.shape[1]
    across = [1j * (own[:, j] - own[:, i]) for own in (first, second) for i, j in combinations(range(own.shape[1]), 2)]
    ways = [second[:, j] - first[:, i] for i, j in product(range(k), range(m))] + across + [-way for way in across]
    best = np.full(len(first), -np.inf)
    for way in ways:
        length = np.abs(way)
        unit = np.conj(way) / np.where(length > 0.0, length, 1.0)
        gap = (second * unit[:, None]).real.min(axis=1) - (first * unit[:, None]).real.max(axis=1)
        best = np.where(length > 0.0, np.maximum(best, gap), best)
    return np.where(np.isfinite(best), best, 0.0)


@cache
def arrangements(count: int) -> NDArray[np.int64]:
    """Every way to put plates in planes without empty ones, (ways, count)."""
    ways = np.array([[1]])
    for _ in range(count - 1):
        grown = []
        top = ways.max(axis=1)
        for plane in range(1, count + 1):  # into a plane that there is
            into = ways[top >= plane]
            grown.append(np.column_stack([into, np.full(len(into), plane)]))
        for plane in range(1, count + 2):  # into a new one, below the plane of this number
            into = ways[top + 1 >= plane]
            grown.append(np.column_stack([into + (into >= plane), np.full(len(into), plane)]))
        ways = np.unique(np.concatenate(grown), axis=0)
    return ways


class Arranging:
    """The best of all arrangements for what meets."""

    def __init__(self, task: Task, built: Solids) -> None:
        self._built, self._through = built, task.through
        self._ways = arrangements(built.plates)
        keeps = np.ones(len(self._ways), np.bool_)
        own = {pair for mesh in built.meshes for pair in combinations(mesh, 2)}
        for one, other in own:
            keeps &= self._ways[:, one] == self._ways[:, other]
        for holds in built.joined:
            for one, other in set(combinations(sorted(holds), 2)) - own:
                keeps &= self._ways[:, one] != self._ways[:, other]
        self._ways = self._ways[keeps]
        self._known: dict[tuple[frozenset[tuple[int, int]], frozenset[int]], tuple[int, int]] = {}

    def best(self, meets: frozenset[tuple[int, int]], stubs: frozenset[int]) -> tuple[int, int]:
        """Least number of pairs that meet, and of planes for it; plates and pins by their numbers among the solids."""
        key = meets, stubs
        if key not in self._known:
            merits = [self._merit(meets, dict(zip(sorted(stubs), sides, strict=True)))
                      for sides in product((False, True), repeat=len(stubs))]  # fmt: skip
            self._known[key] = min(merits)
        return self._known[key]

    def _merit(self, meets: frozenset[tuple[int, int]], hung: dict[int, bool]) -> tuple[int, int]:
        plates, ways = self._built.plates, self._ways
        for one, other in meets:
            if other < plates:
                ways = ways[ways[:, one] != ways[:, other]]
        top = ways.max(axis=1)
        broken = np.zeros(len(ways), np.int64)
        for one, other in meets:
            if other < plates:
                continue
            if one >= plates:
                broken += 1
                continue
            pin = other - plates
            of_pin = ways[:, sorted(self._built.joined[pin])]
            low, high = of_pin.min(axis=1), of_pin.max(axis=1)
            if self._built.grounded[pin]:
                stub = hung.get(other)
                low = np.where(not stub, 0, low)
                high = np.where(bool(stub) or (self._through and stub is None), top + 1, high)
            broken += (low <= ways[:, one]) & (ways[:, one] <= high)
        n = np.lexsort((top, broken))[0]
        return int(broken[n]), int(top[n])


class Verdict(NamedTuple):
    """What came of one linkage."""

    clear: bool
    told: bool
    right: bool
    buildable: bool
    seconds: float
    said: str


def judged(task: Task, drive: Drive) -> Verdict:
    """Compare one answer with its solids."""
    size = drive.size
    step = STEP if not drive.slides_in else 0.0025 * size
    turns = np.linspace(task.low, task.high, max(math.ceil((task.high - task.low) / step), 2) + 1)
    step = float(turns[1] - turns[0])
    began = time.process_time()
    answer = task.answer()
    seconds = time.process_time() - began
    built = solids(task, drive, turns)
    plates, count = built.plates, len(built.names)
    own = {pair for mesh in built.meshes for pair in combinations(mesh, 2)}
    pairs = []
    for one, other in combinations(range(count), 2):
        if other < plates:
            together = (one, other) in own or any({one, other} <= holds for holds in built.joined)
        elif one < plates:
            together = one in built.joined[other - plates]
        else:
            first, second = one - plates, other - plates
            shared = built.joined[first] & built.joined[second]
            together = not shared and not (built.grounded[first] and built.grounded[second])
        if not together:
            pairs.append((one, other))
    distance = np.array(
        [apart(built.corners[i], built.corners[j]) - built.radii[i] - built.radii[j] for i, j in pairs]
    ).reshape(len(pairs), len(turns))
    near = distance < task.gap - TOUCH * size
    least = distance.argmin(axis=1)
    borderline = False
    for row, k in enumerate(least):
        around = np.abs(np.diff(distance[row, max(k - 2, 0) : k + 3]))
        borderline |= bool(abs(distance[row, k] - task.gap) <= 0.5 * around.max(initial=0.0) + 2.0 * TOUCH * size)
    meets = frozenset(pair for pair, row in zip(pairs, near, strict=True) if row.any())
    stubs = frozenset(j for i, j in meets if task.through and i < plates <= j and built.grounded[j - plates])
    said = []
    clear = _clear(task, answer, built, turns, size)
    if not clear:
        said.append("solids meet")
    if borderline:
        return Verdict(clear, False, True, not answer.clashes, seconds, ", ".join(said))
    names = built.names
    crossing = {(names[i], names[j]) for i, j in meets if i < plates}
    if set(answer.crossings) != crossing:
        said.append(f"crossings differ by {set(answer.crossings) ^ crossing}")
    if {names[j][4:] for j in stubs} != set(answer.stub_shafts):
        said.append("stub shafts differ")
    arranging = Arranging(task, built)
    best = arranging.best(meets, stubs)
    if (best[0] == 0) != (not answer.clashes):
        said.append(f"{len(answer.clashes)} clashes where {best[0]} are least")
    elif not answer.clashes and max(answer.planes.values()) != best[1]:
        said.append(f"{max(answer.planes.values())} planes where {best[1]} are least")
    elif answer.clashes:
        said += _free(task, answer, arranging, pairs, near, stubs, turns, best)
    return Verdict(clear, True, not said, not answer.clashes, seconds, ", ".join(said))


def _clear(task: Task, answer: Layout, built: Solids, turns: Real, size: float) -> bool:
    """Whether solids that share a plane keep the gap at all inputs that are said to be free."""
    if answer.free is None:
        return True
    low, high = (end - float(task.mechanism.reference_input) for end in answer.free)
    within = (low <= turns) & (turns <= high) | (task.closed & (turns + task.high - task.low <= high))
    spans: list[tuple[int, int]] = [(answer.planes[name],) * 2 for name in built.names[: built.plates]]
    spans += [answer.pins[name[4:]] for name in built.names[built.plates :]]
    own = {pair for mesh in built.meshes for pair in combinations(mesh, 2)}
    for one, other in combinations(range(len(spans)), 2):
        if max(spans[one][0], spans[other][0]) > min(spans[one][1], spans[other][1]) or (one, other) in own:
            continue
        if one < built.plates <= other and one in built.joined[other - built.plates]:
            continue
        distance = apart(built.corners[one][within], built.corners[other][within])
        if (distance - built.radii[one] - built.radii[other] < task.gap - TOUCH * size).any():
            return False
    return True


def _free(
    task: Task,
    answer: Layout,
    arranging: Arranging,
    pairs: list[tuple[int, int]],
    near: NDArray[np.bool_],
    stubs: frozenset[int],
    turns: Real,
    best: tuple[int, int],
) -> list[str]:
    """What is wrong with the free range, and with the planes for it."""
    step = float(turns[1] - turns[0])
    if task.closed:
        near = np.concatenate([near[:, :-1], near[:, :-1]], axis=1)
    sums = np.concatenate([np.zeros((len(pairs), 1), np.int64), np.cumsum(near, axis=1)], axis=1)
    most = len(turns) if not task.closed else len(turns) - 1
    longest, start, planes = 0, 0, 0
    for end in range(near.shape[1]):
        while start <= end:
            met = frozenset(pairs[row] for row in np.flatnonzero(sums[:, end + 1] > sums[:, start]))
            merit = arranging.best(met, stubs)
            if merit[0] == 0 and end + 1 - start <= most:
                break
            start += 1
        if end + 1 - start > longest:
            longest, planes = end + 1 - start, merit[1]
    if longest <= WITHIN:
        short = answer.free is None or answer.free[1] - answer.free[0] <= WITHIN * step
        alike = answer.free is not None or max(answer.planes.values()) == best[1]
        return [] if short and alike else ["a free range where there is none, or more planes than are needed"]
    if answer.free is None:
        return [f"no free range where {longest} steps are free"]
    width = (answer.free[1] - answer.free[0]) / step
    wrong = [] if abs(width - (longest - 1)) <= WITHIN else [f"free over {width:.1f} steps of {longest - 1}"]
    if max(answer.planes.values()) != planes:
        wrong.append(f"{max(answer.planes.values())} planes for the free range, {planes} are least")
    return wrong
