"""Motion generation by sixbars: 3R chains that are constrained by two more cranks (:mod:`chain_kernels`).

Chains are drawn, all sixbars of each are weighed, and the best chains are moved in random steps towards sounder ones,
until enough sound sixbars are known that differ. Two to four positions are completed by drawn poses on the way, so that
there are five. What is offered is driven and verified like any linkage.
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion import chain_kernels as kernels
from synthesis.kinds.motion.chain_draws import drawn_chains, drawn_poses, needed
from synthesis.kinds.motion.demanded import Complex, Real, demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.stated_mechanisms import Chain, Sixbar
from synthesis.kinds.motion.task import MotionTask, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import LinkageDesign, SixbarMechanism
from synthesis.model.linkage_statement import Region
from synthesis.model.sixbars import Links, sixbar_mechanism
from synthesis.outcome.ranking import distinct, ranked
from synthesis.outcome.sifting import DEFECTS, Sifting
from synthesis.outcome.simplest import SOUND

CHAINS, CLIMBING, STEPS = 1500, 40, 200
"""Chains that are drawn at a time, those of them that are moved, and steps of each at most."""

LEAST_ROUNDS, MOST_ROUNDS = 2, 16
"""How often chains are drawn."""

KEPT = 4000
"""Candidates that are kept of a round."""

REACH, RATIO = 5.0, 20.0
"""Limits where the client states none: longest distance of two joints of a link in task sizes, and link ratio."""

REACH_OF_CHAIN = 2.0
"""What the first limit is at least, beside the longest length or way that is stated of the chain."""

MARGIN = 0.5
"""Degrees by which a demanded transmission angle is exceeded: between the steps of the drive it is less."""

APART = 0.1
"""Distance, in task sizes, by which a joint of distinct sixbars differs."""

ATTEMPTS, LEAST_ATTEMPTS = 4, 20
"""Sixbars that are verified at most, for each design wanted, and in any case."""

ATTEMPTS_IN_ROOM = 150
"""The same where obstacles or forces decide, which the search does not weigh."""

CLASSES = "any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"
"""As the kernel numbers them."""

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])


class _Make(NamedTuple):
    """A make: its type, where its joints stand among the kernel's, and its links."""

    type: Sixbar
    joints: dict[str, int]
    links: Links


_FOURBAR = {"O2": kernels.O2, "A": kernels.A, "B": kernels.B, "O4": kernels.O4}

MAKES = (
    _Make(
        "watt_1",
        _FOURBAR | {"C": kernels.Q1, "D": kernels.Q2, "E": kernels.J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "D"), "coupler": ("A", "B", "C"), "output": ("O4", "B"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    _Make(
        "watt_1",
        _FOURBAR | {"C": kernels.Q1, "D": kernels.Q2, "E": kernels.J},
        {"ground": ("O2", "O4"), "input": ("O2", "A"), "coupler": ("A", "B", "C"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    _Make(
        "stephenson_3",
        _FOURBAR | {"C": kernels.Q1, "O6": kernels.Q2, "D": kernels.J},
        {"ground": ("O2", "O4", "O6"), "input": ("O2", "A"), "coupler": ("A", "B", "C"), "rocker": ("O4", "B"),
         "link_5": ("C", "D", "P"), "output": ("O6", "D")},
    ),
    _Make(
        "stephenson_1",
        _FOURBAR | {"C": kernels.Q1, "D": kernels.Q2, "E": kernels.J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "C"), "coupler": ("A", "B"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E", "P"), "link_6": ("D", "E")},
    ),
    _Make(
        "stephenson_1",
        _FOURBAR | {"D": kernels.Q1, "C": kernels.Q2, "E": kernels.J},
        {"ground": ("O2", "O4"), "input": ("O2", "A", "C"), "coupler": ("A", "B"), "output": ("O4", "B", "D"),
         "link_5": ("C", "E"), "link_6": ("D", "E", "P")},
    ),
)  # fmt: skip
"""By the number of a make (:data:`chain_kernels.MAKES`)."""


class _Found(NamedTuple):
    """Sixbars of the search, the best first.

    ``makes`` (n,), ``joints`` (n, 7), ``bodies`` (n,), where P is in the first position, ``stands`` (n,), how far the
    body is turned there from the demanded angle, radians, and ``values`` (n,).
    """

    makes: NDArray[np.int64]
    joints: Complex
    bodies: Complex
    stands: Real
    values: Real

    def best(self, rows: NDArray[np.int64]) -> _Found:
        """Some of them."""
        return _Found(self.makes[rows], self.joints[rows], self.bodies[rows], self.stands[rows], self.values[rows])

    def beside(self, other: _Found) -> _Found:
        """These and others."""
        return _Found(
            np.concatenate([self.makes, other.makes]),
            np.concatenate([self.joints, other.joints]),
            np.concatenate([self.bodies, other.bodies]),
            np.concatenate([self.stands, other.stands]),
            np.concatenate([self.values, other.values]),
        )


class SixbarSearch:
    """A search for the sixbars of one problem."""

    def __init__(self, problem: MotionProblem, types: tuple[Sixbar, ...]) -> None:
        self.problem, self.types = problem, types
        self.task, self.target = motion_task(problem), demanded(problem)
        self.wanted = np.array([make.type in types for make in MAKES])
        self.chain = Chain() if problem.chain is None else problem.chain
        self.limits = _limits(problem, self.task)
        self.weighed = 0

    def run(self, progress: Progress) -> _Found:
        """Rounds of drawing and climbing until enough sound sixbars that differ are known."""
        rng = np.random.default_rng(self.problem.seed)
        found = self._distinct(self._round(rng))
        for n in range(1, MOST_ROUNDS):
            sound = int(np.count_nonzero(found.values >= 1.0))
            if n >= LEAST_ROUNDS and sound >= self.problem.max_designs:
                break
            progress(n / MOST_ROUNDS, f"{self.weighed} sixbars of drawn chains weighed")
            found = self._distinct(found.beside(self._round(rng)))
        return found

    def _round(self, rng: np.random.Generator) -> _Found:
        poses = drawn_poses(self.task, self.target, rng, CHAINS)
        chains, free = drawn_chains(self.task, poses, self.chain, self.problem.constraints.fixed_pivot_region, rng)
        given = kernels.Given(poses.points, poses.turns, poses.demanded, needed(self.task), self.wanted, self.limits)
        joints, makes, owners = np.empty((KEPT, 7), np.complex128), np.empty(KEPT, np.int64), np.empty(KEPT, np.int64)
        results = kernels.Results(joints, makes, np.empty(KEPT), np.zeros(4), owners)
        kernels.searched(chains, rng.normal(size=(STEPS, 6)) * free, CLIMBING, given, results, np.empty(CHAINS))
        self.weighed += int(results.found[2])
        rows = int(results.found[1])
        own = owners[:rows]
        return _Found(makes[:rows], joints[:rows], poses.points[own, 0], poses.stands[own], results.scores[:rows])

    def _distinct(self, found: _Found) -> _Found:
        """The best of those that differ from one another, first the sound ones."""
        ordered = found.best(np.argsort(-found.values, kind="stable"))
        # Joints of another make are nowhere near.
        apart = np.concatenate([ordered.joints, 1e6 * ordered.makes[:, None].astype(np.complex128)], axis=1)
        most = max(ATTEMPTS * self.problem.max_designs, LEAST_ATTEMPTS)
        if self.problem.space is not None or self.problem.constraints.of_forces or self.problem.layout is not None:
            most = max(most, ATTEMPTS_IN_ROOM)
        return ordered.best(np.array(distinct(apart, most, APART), np.int64))

    def mechanism(self, found: _Found, n: int) -> SixbarMechanism:
        """A sixbar of the search in the problem's coordinates."""
        make, row = MAKES[found.makes[n]], found.joints[n]
        joints = {name: self.task.to_problem(complex(row[k])) for name, k in make.joints.items()}
        joints["P"] = self.task.to_problem(complex(found.bodies[n]))
        angle = None
        if not self.target.held[0, 2]:
            angle = self.problem.positions[0].angle + math.degrees(float(found.stands[n]))
        return sixbar_mechanism(make.type, joints, make.links, body_angle=angle)


def solve_sixbars(problem: MotionProblem, types: tuple[Sixbar, ...], progress: Progress) -> MotionResult:
    """Sixbars of some types that carry the body through two to five positions."""
    search = SixbarSearch(problem, types)
    found = search.run(part_of(progress, 0.0, 0.9))
    sifting = Sifting[LinkageDesign](problem, DEFECTS)
    progress(0.9, f"verifying the best of {search.weighed} sixbars")
    # The sound ones come first. What the others break may be no limit of the client's: that is judged by the proof.
    rows = np.flatnonzero(found.values >= 0.0)

    def verified(n: int) -> LinkageDesign | None:
        return verify(problem, search.mechanism(found, n), search.target)

    tried = sifting.sift(rows.tolist(), verified, enough=problem.max_designs)
    sifting.reject("unsound", search.weighed - tried)
    progress(1.0, "verified")
    return MotionResult(
        designs=sifting.designs(partial(ranked, rank_by=problem.rank_by)),
        search=sifting.search("constrained_chains"),
        summary=_summary(sifting),
    )


def _limits(problem: MotionProblem, task: MotionTask) -> Real:
    """The limits of a problem as the kernel takes them (:data:`chain_kernels.LEAST_SINE`)."""
    stated = problem.constraints
    angle = SOUND if stated.min_transmission_angle is None else min(stated.min_transmission_angle + MARGIN, 89.9)
    lengths = stated.link_length
    shortest = 0.0 if lengths is None else lengths.min / task.size
    longest = np.inf if lengths is None or lengths.max is None else lengths.max / task.size
    ratio = RATIO if stated.max_link_ratio is None else stated.max_link_ratio
    reach = max(REACH, REACH_OF_CHAIN * problem.size_of_chain / task.size)
    plain = [math.sin(math.radians(angle)), reach, ratio, shortest, longest]
    plain += [CLASSES.index(stated.grashof), stated.full_rotation]
    boxes = [_box(region, task) for region in (stated.fixed_pivot_region, stated.moving_pivot_region)]
    space = problem.space
    if space is not None and space.box is not None:
        (left, low), (right, high) = space.box
        half = 0.5 * space.link_width
        boxes.append(_box(Region(x=(left + half, right - half), y=(low + half, high - half)), task))
    else:
        boxes.append(EVERYWHERE)
    return np.concatenate([plain, *boxes])


def _box(region: Region | None, task: MotionTask) -> Real:
    if region is None:
        return EVERYWHERE
    low, high = (task.to_task(complex(region.x[k], region.y[k])) for k in (0, 1))
    return np.array([low.real, high.real, low.imag, high.imag])


def _summary(sifting: Sifting[LinkageDesign]) -> str:
    weighed = f"{sifting.candidates} sixbars of chains that are constrained by two more cranks were weighed"
    if not sifting.passed:
        return (
            f"{weighed}, and none was found that satisfies all demands.{sifting.reasons()} "
            "That does not prove that none exists."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    count = len(sifting.passed)
    many = f"the best {count} that differ were driven and verified" if count > 1 else "the best was driven and verified"
    return f"{weighed}; {many}, with a least transmission angle of up to {best:.1f}°."
