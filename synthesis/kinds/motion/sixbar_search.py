"""Motion generation by sixbars: descents that hold their branch, and constrained chains where a chain is stated.

Descents from random linkages (:mod:`branch_search`) find sixbars for nearly all positions that random chains
(:mod:`chain_search`) do not find in hours. Chains are drawn where one is stated, and in turn with descents where a
class or a full turn is demanded, or a region or a box: what a descent does not see, or must find its way into. Chains
have five positions at most. Of positions that are fitted without a limit those that miss least are taken to the end of
their least squares (:mod:`branch_fit`). What is offered is driven and verified like any linkage.
"""

from __future__ import annotations

import math

import numpy as np

from synthesis.kinds.motion.branch_fit import value_of_fit
from synthesis.kinds.motion.branch_search import BranchSearch
from synthesis.kinds.motion.chain_search import ChainSearch
from synthesis.kinds.motion.demanded import Real, demanded
from synthesis.kinds.motion.design import MotionResult
from synthesis.kinds.motion.nearness import error_of, order_of
from synthesis.kinds.motion.problem import MotionProblem
from synthesis.kinds.motion.sixbar_makes import MAKES, Found
from synthesis.kinds.motion.stated_mechanisms import Sixbar
from synthesis.kinds.motion.stated_positions import MOST_HELD
from synthesis.kinds.motion.task import MotionTask, motion_task
from synthesis.kinds.motion.verification import verify
from synthesis.model.counting import counted
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_answer import LinkageDesign, SixbarMechanism
from synthesis.model.linkage_statement import Region
from synthesis.model.sixbars import sixbar_mechanism
from synthesis.model.stated_types import UNCLASSED
from synthesis.outcome.ranking import distinct
from synthesis.outcome.sifting import DEFECTS, Sifting
from synthesis.outcome.simplest import SOUND

OF_CHAINS, OF_BRANCHES = 1.0 / 16.0, 1.0 / 72.0
"""What a round of either sort spends of a search: it ends when all is spent."""

LEAST_ROUNDS = 2
"""Rounds in any case."""

ENOUGH, AND_MORE = 3.0, 0.1
"""A search with too few sound sixbars goes on for as much more as it took to find the first, times this, and this."""

STALE, LOWER = 8, 0.97
"""A fit begins anew where so many rounds leave more than this share of the least cost."""

FITTED, AS_FAR = 0.5, 1.1
"""What is spent of a search for fits; and where positions are nearly met, since what meets them may exist."""

NEAR_ENOUGH, NEARLY_MET = 1e-6, 1e-4
"""Errors of fits, in task sizes and radians: the search ends with as many of the first as are wanted, and goes on
further with one of the second."""

RELAXED_FROM, RELAXED_EVERY = 0.5, 3
"""What is spent, none sound yet, from which on every third round takes no limit that nobody stated."""

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

NO_CRANK = "A Stephenson II has a crank between body and ground, and none was found that meets these positions"
"""What is said where none is looked for."""

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])


class SixbarSearch:
    """A search for the sixbars of one problem."""

    def __init__(self, problem: MotionProblem, types: tuple[Sixbar, ...]) -> None:
        self.problem, self.types = problem, types
        self.task, self.target = motion_task(problem), demanded(problem)
        wanted = np.array([make.type in types for make in MAKES])
        limits = _limits(problem, self.task)
        self.chains = ChainSearch(problem, self.task, self.target, wanted, limits)
        self.branches = BranchSearch(problem, self.task, self.target, wanted, limits)

    @property
    def weighed(self) -> int:
        """Sixbars that were looked at so far."""
        return self.chains.weighed + self.branches.descents

    @property
    def method(self) -> str:
        """How they were found."""
        counts = (self.branches.descents, "held_branches"), (self.chains.weighed, "constrained_chains")
        return ", ".join(name for count, name in counts if count) or "held_branches"

    def run(self, progress: Progress) -> Found:
        """Rounds until enough sound sixbars that differ are known, or all is spent."""
        rng = np.random.default_rng(self.problem.seed)
        stated = self.problem.constraints
        regions = stated.fixed_pivot_region, stated.moving_pivot_region, self.problem.space
        mixed = stated.full_rotation or stated.grashof != "any" or any(region is not None for region in regions)
        mixed = mixed and len(self.problem.positions) <= MOST_HELD and self.types != (UNCLASSED,)
        found = Found.none()
        spent, until, n = 0.0, 1.0, 0
        while spent < until:
            if self.problem.chain is not None or (mixed and n % 2):
                found, spent = self._distinct(found.beside(self.chains.round(rng))), spent + OF_CHAINS
            else:
                sound = bool(np.any(found.values >= 1.0))
                relaxed = spent >= RELAXED_FROM and not sound and n % RELAXED_EVERY == 0
                found = self._distinct(found.beside(self.branches.round(rng, relaxed=relaxed)))
                spent += OF_BRANCHES
            n += 1
            sound_ones = int(np.count_nonzero(found.values >= 1.0))
            if sound_ones and until == 1.0:
                until = min(1.0, (1.0 + ENOUGH) * spent + AND_MORE)
            if n >= LEAST_ROUNDS and sound_ones >= self.problem.max_designs:
                break
            progress(min(spent, 1.0), f"{self.weighed} sixbars looked at")
        return found

    def fitted(self, progress: Progress) -> Found:
        """Rounds until enough sound sixbars meet all positions, or as many as a fit is given; those that miss least."""
        rng = np.random.default_rng(self.problem.seed)
        found = Found.none()
        least, since, n, told = math.inf, 0, 0, 0.0
        until, enough, nearly = FITTED, value_of_fit(NEAR_ENOUGH), value_of_fit(NEARLY_MET)
        while n * OF_BRANCHES < until:
            relaxed = n * OF_BRANCHES >= RELAXED_FROM * FITTED and not bool(np.any(found.values >= 1.0))
            met = self.branches.round(rng, relaxed=relaxed)
            # What meets all positions comes before what misses any.
            values = np.where(met.values >= 1.0, 1.0 + met.values, met.values)
            found = self._distinct(found.beside(met._replace(values=values)))
            n += 1
            if np.count_nonzero(found.values >= 2.0) >= self.problem.max_designs:
                return found
            since = 0 if self.branches.misses < LOWER * least else since + 1
            least = min(least, self.branches.misses)
            if since >= STALE or n * OF_BRANCHES >= until:
                found = self._distinct(found.beside(self.branches.fitted()))
                if np.count_nonzero(found.values >= enough) >= self.problem.max_designs:
                    return found
                least, since = math.inf, 0
                if np.any(found.values >= nearly):
                    until = AS_FAR
            told = max(told, min(n * OF_BRANCHES / until, 1.0))
            progress(told, f"{self.weighed} sixbars looked at")
        return found

    def _distinct(self, found: Found) -> Found:
        """The best of those that differ from one another, first the sound ones."""
        ordered = found.best(np.argsort(-found.values, kind="stable"))
        # Joints of another make are nowhere near.
        apart = np.concatenate([ordered.joints, 1e6 * ordered.makes[:, None].astype(np.complex128)], axis=1)
        most = max(ATTEMPTS * self.problem.max_designs, LEAST_ATTEMPTS)
        if self.problem.space is not None or self.problem.constraints.of_forces or self.problem.layout is not None:
            most = max(most, ATTEMPTS_IN_ROOM)
        return ordered.best(np.array(distinct(apart, most, APART), np.int64))

    def mechanism(self, found: Found, n: int) -> SixbarMechanism:
        """A sixbar of the search in the problem's coordinates."""
        make, row = MAKES[found.makes[n]], found.joints[n]
        joints = {name: self.task.to_problem(complex(row[k])) for name, k in make.joints.items()}
        joints["P"] = self.task.to_problem(complex(found.bodies[n]))
        angle = None
        if not self.target.held[0, 2]:
            angle = self.problem.positions[0].angle + math.degrees(float(found.stands[n]))
        return sixbar_mechanism(make.type, joints, make.links, body_angle=angle)


def solve_sixbars(problem: MotionProblem, types: tuple[Sixbar, ...], progress: Progress) -> MotionResult:
    """Sixbars of some types that carry the body through two to sixty positions."""
    search = SixbarSearch(problem, types)
    looked = part_of(progress, 0.0, 0.9)
    found = search.fitted(looked) if problem.fitted else search.run(looked)
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
        designs=sifting.designs(order_of(problem)),
        search=sifting.search(search.method),
        summary=_summary(sifting, search),
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
    room = None if problem.space is None else problem.space.box_of_joints()
    boxes.append(EVERYWHERE if room is None else _within(room, task))
    return np.concatenate([plain, *boxes])


def _box(region: Region | None, task: MotionTask) -> Real:
    return EVERYWHERE if region is None else _within((*region.x, *region.y), task)


def _within(sides: tuple[float, float, float, float], task: MotionTask) -> Real:
    """Sides of a box, x from, to, y from, to, in the unit of the task."""
    left, right, low, high = sides
    corners = task.to_task(complex(left, low)), task.to_task(complex(right, high))
    return np.array([corners[0].real, corners[1].real, corners[0].imag, corners[1].imag])


def _summary(sifting: Sifting[LinkageDesign], search: SixbarSearch) -> str:
    looked_at = [
        counted(count, f"sixbar {which}was {done}", f"sixbars {which}were {done}")
        for count, which, done in (
            (search.branches.descents, "", "taken towards the positions on one branch"),
            (search.chains.weighed, "of chains that are constrained by two more cranks ", "weighed"),
        )
        if count
    ]
    told = " and ".join(looked_at) or NO_CRANK
    if not sifting.passed:
        return (
            f"{told}, and none was found that satisfies all demands.{sifting.reasons()} "
            "That does not prove that none exists."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    count = len(sifting.passed)
    many = f"the best {count} that differ were driven and verified" if count > 1 else "the best was driven and verified"
    near = ""
    if search.problem.fitted:
        share = 100.0 * min(map(error_of, sifting.passed))
        near = f"a root-mean-square residual of {share:.3g} % of the task size (hundredths of a radian) at best, and "
    return f"{told}; {many}, with {near}a least transmission angle of up to {best:.1f}°."
