"""Motion generation by sixbars: descents that stay on their branch, and constrained chains if a chain is given.

Descents from random linkages (:mod:`branch_search`) find sixbars for almost all problems, including many that random
chains (:mod:`chain_search`) do not solve in hours. Chains are sampled if one is given; they alternate with descents if
a Grashof class, a full rotation, a region or a box is required, which a descent ignores or reaches with difficulty.
Chains support at most five positions. If positions are fitted without tolerances, the candidates with the smallest
errors are fitted by least squares until convergence (:mod:`branch_fit`). All returned designs are driven and verified
like any linkage.
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
"""Share of the search budget that a round of chains, or of branches, uses; the search ends when all is used."""

LEAST_ROUNDS = 2
"""Minimum number of rounds."""

ENOUGH, AND_MORE = 3.0, 0.1
"""Extension of a search that has feasible sixbars, but too few: this factor of the budget used for the first one, plus
this share."""

STALE, LOWER = 8, 0.97
"""A fit restarts if this many rounds do not lower the cost below this share of its minimum."""

FITTED, AS_FAR = 0.5, 1.1
"""Search budget for fits; and the extended budget if positions are almost met, because an exact solution may exist."""

NEAR_ENOUGH, NEARLY_MET = 1e-6, 1e-4
"""Errors of fits, in task sizes and radians: the search ends when the requested number of fits is below the first, and
is extended when one fit is below the second."""

RELAXED_FROM, RELAXED_EVERY = 0.5, 3
"""Share of the budget after which, without a feasible sixbar, every third round drops the default limits."""

REACH, RATIO = 5.0, 20.0
"""Default limits: maximum distance of two joints of a link, in task sizes, and maximum link ratio."""

REACH_OF_CHAIN = 2.0
"""Minimum of the first limit, relative to the longest given length or distance of the chain."""

MARGIN = 0.5
"""Margin, degrees, added to a required transmission angle, because the angle is smaller between the sampled steps."""

APART = 0.1
"""Minimum separation of distinct sixbars: the largest distance between corresponding joints, in task sizes."""

ATTEMPTS, LEAST_ATTEMPTS = 4, 20
"""Maximum number of verified sixbars: per requested design, and its lower bound."""

ATTEMPTS_IN_ROOM = 150
"""The same lower bound if obstacles, planes or forces matter, which the search ignores."""

CLASSES = "any", "crank_rocker", "double_crank", "double_rocker", "non_grashof"
"""Grashof classes in the kernel's numbering."""

NO_CRANK = "A Stephenson II sixbar needs a crank between body and ground, and no crank found meets these positions"
"""Summary text if no sixbar was searched."""

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])


class SixbarSearch:
    """Search for the sixbars of one problem."""

    def __init__(self, problem: MotionProblem, types: tuple[Sixbar, ...]) -> None:
        self.problem, self.types = problem, types
        self.task, self.target = motion_task(problem), demanded(problem)
        wanted = np.array([make.type in types for make in MAKES])
        limits = _limits(problem, self.task)
        self.chains = ChainSearch(problem, self.task, self.target, wanted, limits)
        self.branches = BranchSearch(problem, self.task, self.target, wanted, limits)

    @property
    def weighed(self) -> int:
        """Number of sixbars examined so far."""
        return self.chains.weighed + self.branches.descents

    @property
    def method(self) -> str:
        """Names of the search methods used."""
        counts = (self.branches.descents, "held_branches"), (self.chains.weighed, "constrained_chains")
        return ", ".join(name for count, name in counts if count) or "held_branches"

    def run(self, progress: Progress) -> Found:
        """Run rounds until there are enough distinct feasible sixbars, or the budget is used up."""
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
            # One feasible sixbar shows how hard the problem is: bound the rest of the search by that effort.
            if sound_ones and until == 1.0:
                until = min(1.0, (1.0 + ENOUGH) * spent + AND_MORE)
            if n >= LEAST_ROUNDS and sound_ones >= self.problem.max_designs:
                break
            progress(min(spent, 1.0), f"{self.weighed} sixbars examined")
        return found

    def fitted(self, progress: Progress) -> Found:
        """Run rounds until enough feasible sixbars meet all positions or the budget is used; smallest errors first."""
        rng = np.random.default_rng(self.problem.seed)
        found = Found.none()
        least, since, n, told = math.inf, 0, 0, 0.0
        until, enough, nearly = FITTED, value_of_fit(NEAR_ENOUGH), value_of_fit(NEARLY_MET)
        while n * OF_BRANCHES < until:
            relaxed = n * OF_BRANCHES >= RELAXED_FROM * FITTED and not bool(np.any(found.values >= 1.0))
            met = self.branches.round(rng, relaxed=relaxed)
            # Candidates that meet all positions (values of 2 and more) rank before those that miss any.
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
            progress(told, f"{self.weighed} sixbars examined")
        return found

    def _distinct(self, found: Found) -> Found:
        """Select the best distinct candidates, feasible ones first."""
        ordered = found.best(np.argsort(-found.values, kind="stable"))
        # A large offset per topology makes candidates of different topologies distinct.
        apart = np.concatenate([ordered.joints, 1e6 * ordered.makes[:, None].astype(np.complex128)], axis=1)
        most = max(ATTEMPTS * self.problem.max_designs, LEAST_ATTEMPTS)
        if self.problem.space is not None or self.problem.constraints.of_forces or self.problem.layout is not None:
            most = max(most, ATTEMPTS_IN_ROOM)
        return ordered.best(np.array(distinct(apart, most, APART), np.int64))

    def mechanism(self, found: Found, n: int) -> SixbarMechanism:
        """Build a sixbar of the search in the problem's coordinates."""
        make, row = MAKES[found.makes[n]], found.joints[n]
        joints = {name: self.task.to_problem(complex(row[k])) for name, k in make.joints.items()}
        joints["P"] = self.task.to_problem(complex(found.bodies[n]))
        angle = None
        if not self.target.held[0, 2]:
            angle = self.problem.positions[0].angle + math.degrees(float(found.stands[n]))
        return sixbar_mechanism(make.type, joints, make.links, body_angle=angle)


def solve_sixbars(problem: MotionProblem, types: tuple[Sixbar, ...], progress: Progress) -> MotionResult:
    """Solve for sixbars of the given types that carry the body through two to sixty positions."""
    search = SixbarSearch(problem, types)
    looked = part_of(progress, 0.0, 0.9)
    found = search.fitted(looked) if problem.fitted else search.run(looked)
    sifting = Sifting[LinkageDesign](problem, DEFECTS)
    progress(0.9, f"verifying the best of {search.weighed} sixbars")
    # Feasible ones come first. The others may violate only default limits, so the verification decides about them.
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
    """Pack the limits of a problem for the kernel (:data:`chain_kernels.LEAST_SINE`)."""
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
    """Convert a box (x min, x max, y min, y max) to task coordinates."""
    left, right, low, high = sides
    corners = task.to_task(complex(left, low)), task.to_task(complex(right, high))
    return np.array([corners[0].real, corners[1].real, corners[0].imag, corners[1].imag])


def _summary(sifting: Sifting[LinkageDesign], search: SixbarSearch) -> str:
    looked_at = [
        counted(count, f"sixbar {which}was {done}", f"sixbars {which}were {done}")
        for count, which, done in (
            (search.branches.descents, "", "fitted to the positions on one branch"),
            (search.chains.weighed, "from chains with two constraining cranks ", "evaluated"),
        )
        if count
    ]
    told = " and ".join(looked_at) or NO_CRANK
    if not sifting.passed:
        return (
            f"{told}; no design found satisfies all constraints.{sifting.reasons()} "
            "This does not prove that none exists."
        )
    best = max(design.metrics.min_transmission_angle for design in sifting.passed)
    count = len(sifting.passed)
    many = f"{count} distinct designs verified" if count > 1 else "1 design verified"
    near = ""
    if search.problem.fitted:
        share = 100.0 * min(map(error_of, sifting.passed))
        near = f"Best root-mean-square residual: {share:.3g} % of the task size (angles in hundredths of a radian). "
    return f"{told}; {many}. {near}Best minimum transmission angle: {best:.1f}°."
