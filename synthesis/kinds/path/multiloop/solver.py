"""Sixbars and eightbars that guide a point: shapes compared, the most similar fitted, the best driven.

A round, for all topologies of the requested types (:func:`~synthesis.fit.linkage.topology.list_forms`) together:

1. linkages are drawn and their curves compared with the target; the most similar are placed on it;
2. they descend on all of their dimensions at equal steps along the target, with the constraints as penalties;
3. the best of all rounds are fitted to the points themselves and hop from basin to basin.

Rounds end when a fit is at the points, or after :attr:`Family.max_rounds`; eightbars that are not at the points then
hop on towards the points in any order. The best are fitted to the points, and to the curve between them if the points
define it, with all constraints enforced. :mod:`synthesis.fit.linkage.margins` lists the constraints known to the
kernels; all constraints are verified on the driven linkage. If no transmission angle is required, at least
:data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees are the aim.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.fit.linkage.closure import move_reference
from synthesis.fit.linkage.descent import (
    Fit,
    FitTask,
    build_point_targets,
    descend_softly,
    fit_constrained,
    hop_basins,
    sort_fits,
)
from synthesis.fit.linkage.mechanism import build_fitted_linkage
from synthesis.fit.linkage.residuals import ROOT, X, Y
from synthesis.fit.linkage.topology import Topology, list_forms
from synthesis.kinds.path.curve.fits import get_thinning
from synthesis.kinds.path.curve.stance_fit import pack_target_stance
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.multiloop.limits import CLASS_LINKS, build_packer
from synthesis.kinds.path.multiloop.shape_matching import find_similar_linkages
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.stance import MARGIN_COUNT, compute_linkage_stance_rows
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.task.ranking import (
    EQUAL_ERROR_RATIO,
    FAR_REASON,
    build_ordering,
    drop_straying,
    is_exact,
    select_near,
)
from synthesis.kinds.path.task.target_curve import (
    MIN_DEFINING_POINTS,
    MIN_POLYLINE_POINTS,
    SHAPE_POINT_COUNT,
    TargetCurve,
    interpolate_crank_angles,
    sample_smooth_steps,
)
from synthesis.kinds.path.verification.linkage import verify_traced
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.answer import EightbarMechanism, SixbarMechanism
from synthesis.model.linkage.conversion import to_complex
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.practicality import MAX_LINK_RATIO
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE, select_passing

OPEN_DRAW_SHARE = 0.25
"""Share of the drawn number for a stroke, which is compared with parts of each curve."""

MAX_START_STEPS, MAX_HOP_STEPS = 40, 50
"""Number of steps of descents: of starts, and of perturbed copies."""

POOL_SIZE, HOP_COUNT, GENERATION_COUNT = 24, 24, 8
"""Number of fits that are kept; of perturbed copies in a generation; and of generations in a round."""

MAX_FREE_STARTS, MIN_POOL_SIZE = 120, 3
"""Maximum number of fits from which those in any order start; number of fits that are pursued at the end."""

ORDERED_PROGRESS, FREE_PROGRESS = 0.5, 0.8
"""Progress after fits to the points in order, and after those in any order, which not every family has."""

FREE_SOFT_WEIGHT = 300.0
"""Weight of soft constraints in fits in any order: mean distances are larger numbers than their squares."""

FREE_WIDTH = 1e-3
"""Distance, in task sizes, below which fits in any order minimize squares instead of distances, so that derivatives are
continuous."""

FOUND_ERROR = 2e-4
"""Root mean square distance from the points, as a share of the target's size, at which a fit is at them and the search
ends: a better one could not be manufactured."""

MIN_FOUND, MIN_FOUND_CONSTRAINED = 4, 16
"""Number of fits at the points that end the search, a choice for the ranking; and the same if some constraints are
checked on the driven linkage only."""

RAISED_ANGLES, MAX_RAISING_ROUNDS = (30.0, 40.0, 50.0), 4
"""Transmission angles, degrees, that good fits are raised to as far as their error permits, and the number of rounds of
such fits."""

MAX_FITTED, MAX_FITTED_CONSTRAINED = 12, 24
"""Number of fits that are refitted under all constraints and driven; and the same if a workspace, planes or forces are
constrained, which are checked on the driven linkage only. More if more designs are requested."""

BACK_STEP_COUNT, ANGLE_STEP_COUNT, SOFT_STEP_COUNT = 96, 96, 48
"""Numbers of steps of the input at which the curve is compared with the polyline through many points, at which the
constraints are enforced, and at which they are penalties."""

ANGLE_MARGIN = 0.1
"""Degrees added to the minimum transmission angle: the true minimum may lie between the steps of the crank."""

MAX_EXACT_STEPS, EXACT_TOLERANCE = 300, 1e-14
"""Maximum number of steps of descents to exact points, and their tolerance."""

EXACT_COST = 1e-20
"""Half the sum of squares, in the target's unit, below which points are met exactly up to rounding."""

DESIGN_DUPLICATE_TOLERANCE = 1e-3
"""Linkages whose joints agree to this share of the task's size are duplicates."""


class Family(NamedTuple):
    """Linkages of one number of links, which are searched together.

    Attributes
    ----------
    name : str
        Name of the family in messages and in :data:`TYPE_NAMES`.
    max_rounds : int
        Maximum number of rounds.
    draw_count, start_count : int
        Number of linkages drawn in a round, and of the most similar that are fitted, over all topologies.
    method : str
        Name of the search in answers.
    halvings : int
        Number of times that another perturbation of half the size is tried if a linkage does not close.
    free_generation_count : int
        Number of generations of hops that approach the points in any order, if no fit is at them before.
    fitted, driven, passed : str
        Messages of progress, and of the number of linkages that passed.
    """

    name: str
    max_rounds: int
    draw_count: int
    start_count: int
    method: str
    halvings: int
    free_generation_count: int
    fitted: str
    driven: str
    passed: str


SIXBARS = Family(
    name="sixbar",
    max_rounds=6,
    draw_count=24576,
    start_count=120,
    method="sixbar_shapes",
    halvings=0,
    free_generation_count=0,
    fitted="path-sixbars-fitted",
    driven="path-sixbars-driven",
    passed="path-sixbars-passed",
)
"""Sixbars of the requested types."""

EIGHTBARS = Family(
    name="eightbar",
    max_rounds=1,
    draw_count=98304,
    start_count=240,
    method="eightbar_shapes",
    # Three of four perturbed eightbars do not close; of sixbars too few for halved ones to pay.
    halvings=4,
    free_generation_count=100,
    fitted="path-eightbars-fitted",
    driven="path-eightbars-driven",
    passed="path-eightbars-passed",
)
"""Eightbars of all topologies: ten times as many as of sixbars, of which a curve is near to a few."""


def solve_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by sixbars of the types that it names."""
    return _solve_exactly_or_fit(problem, SIXBARS, problem.sixbars, progress)


def solve_eightbars(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by eightbars."""
    return _solve_exactly_or_fit(problem, EIGHTBARS, ("eightbar",), progress)


def _solve_exactly_or_fit(
    problem: PathProblem, family: Family, types: Sequence[str], progress: Progress
) -> PathResult:  # fmt: skip
    def solve(statement: PathProblem, part: Progress) -> PathResult:
        return solve_by_family(statement, family, types, part)

    if problem.is_fitted:
        return solve(problem, progress)
    return solve_exactly_or_fit(problem, progress, solve, solve, family.name)


def warm_up() -> None:
    """Compile or load the kernels on a small circle."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINT_COUNT) / SHAPE_POINT_COUNT)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle], "mechanisms": ["stephenson_3"]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", "closed": True, **stated})
    pack_limits = build_packer(problem, 0j, 1.0, SOUND_TRANSMISSION_ANGLE, MAX_LINK_RATIO)
    task = FitTask(build_point_targets(circle, np.ones(SHAPE_POINT_COUNT)), pack_limits, back=1.0)
    for kind in ("stephenson_3", "stephenson_2"):
        fits = find_similar_linkages(list_forms(kind)[0], circle, True, 256, 2, np.random.default_rng(0))
        fit_constrained(descend_softly(fits, task, 2), task, rounds=1, steps=2)


class _Search:
    """A search for linkages of one family along a target."""

    def __init__(self, problem: PathProblem, family: Family, types: Sequence[str]) -> None:
        self.problem, self.family = problem, family
        self.target = TargetCurve(problem)
        limits = problem.constraints
        required_angle = limits.min_transmission_angle
        # Without a required angle linkages would often end next to a toggle, where they are useless.
        self.least_angle = SOUND_TRANSMISSION_ANGLE if required_angle is None else required_angle
        pack_limits = self.build_packer(self.least_angle)
        self.shortest = CLASS_LINKS[limits.grashof]
        # The input of a stroke may swing, unless a full turn is required or a class that makes full turns.
        self.full_turn = problem.closed or limits.full_rotation or self.shortest >= 0
        self.steps, self.places = self.target.steps, self.target.places
        # Few points define no curve: a spline through them serves as the target of the comparison.
        if len(self.target.points) < MIN_DEFINING_POINTS and not problem.is_matched:
            self.steps, self.places = sample_smooth_steps(self.target.points, self.target.closed)
        self.shape_task = FitTask(
            build_point_targets(self.steps, np.ones(SHAPE_POINT_COUNT)), pack_limits, self.full_turn, SOFT_STEP_COUNT
        )
        self.point_task, self.final_task, self.part = self._build_point_tasks()
        self.draw_count = math.ceil(family.draw_count * (1.0 if problem.closed else OPEN_DRAW_SHARE))
        # Fits that are too far for the pool are starts of fits in any order.
        self.unpursued: list[Fit] = []
        self.kinds = {topology: kind for kind in types for topology in list_forms(kind)}
        # Constraints that the fits do not know reject many linkages: keep more of them.
        self.is_judged = bool(
            problem.space is not None or problem.layout is not None or limits.force_limits or problem.stance
        )

    def build_packer(self, angle: float) -> Callable[[Topology], Real]:
        """Return the constraints with a least transmission angle, degrees."""
        ratio = self.problem.constraints.max_link_ratio
        ratio = MAX_LINK_RATIO if ratio is None else ratio
        return build_packer(self.problem, self.target.centre, self.target.size, ANGLE_MARGIN + angle, ratio)

    def _build_point_tasks(self) -> tuple[FitTask, FitTask, slice | NDArray[np.int64]]:
        """Return the fits to the points, with constraints as penalties and enforced, and which points they use."""
        problem, target = self.problem, self.target
        fitted = len(target.fitted) if problem.is_matched else len(target.points)
        part: slice | NDArray[np.int64] = get_thinning(target)
        stance: Real | None = None
        if problem.stance is not None:
            part, stance = pack_target_stance(problem, target, fitted)
        weights = target.weights[:fitted][part]
        targets = build_point_targets(target.fitted[:fitted][part], weights)
        soft = replace(self.shape_task, targets=targets)
        # The curve of a stroke is compared with its polyline only if it is a part of a turn.
        comparable = problem.is_fitted and (problem.closed or not self.full_turn)
        # Only a dense polyline defines the curve between its points.
        dense = comparable and len(target.points) >= MIN_POLYLINE_POINTS
        # Both directions count equally: the steps of the curve share the total weight of the points.
        back = float(weights.sum())
        final = replace(soft, steps=BACK_STEP_COUNT if dense else ANGLE_STEP_COUNT, back=back if dense else 0.0)
        if comparable and not problem.closed and len(target.points) >= MIN_DEFINING_POINTS:
            # A stroke that is only measured at its points may stray between them by many times its size. The sags of a
            # coarse polyline do no harm here, because the last fit is to its points alone.
            soft = replace(soft, back=back)
        if stance is not None:
            final = replace(
                final, rows=compute_linkage_stance_rows, prefix=stance, prefix_margins=MARGIN_COUNT
            )  # fmt: skip
        return soft, final, part

    def run(self, progress: Progress) -> list[Fit]:
        """Return the best fits to the points, the nearest first, with constraints as penalties."""
        rng = np.random.default_rng(self.problem.seed)
        pool: list[Fit] = []
        rounds = self.family.max_rounds
        # A problem with constraints that the kernels do not know needs a choice of fits, not only one.
        required = MIN_FOUND_CONSTRAINED if self.is_judged else MIN_FOUND
        for number in range(rounds):
            text = compose(
                self.family.fitted, compared=self.draw_count, fitted=self.family.start_count, round=number + 1
            )
            progress(number / rounds, text)
            starts = self._draw_starts(rng)
            fits = sort_fits(descend_softly(starts, self.shape_task, MAX_START_STEPS))
            moved = [fit._replace(inputs=self._interpolate_inputs(fit.inputs)) for fit in fits[:MAX_FREE_STARTS]]
            self.unpursued += moved[POOL_SIZE:]
            moved = descend_softly(moved[:POOL_SIZE], self.point_task, MAX_HOP_STEPS)
            pool = sort_fits([*pool, *moved])[:POOL_SIZE]
            for generation in range(GENERATION_COUNT):
                if sum(map(self.is_at_points, pool)) >= required:
                    return pool
                progress((number + (generation + 1) / (GENERATION_COUNT + 1)) / rounds, text)
                pool = hop_basins(pool, self.point_task, HOP_COUNT, MAX_HOP_STEPS, rng, self.family.halvings)
            if not self.is_judged and any(map(self.is_at_points, pool)):
                break
        return pool

    def is_at_points(self, fit: Fit) -> bool:
        """Return whether a fit is at the points, and between them as near to their lines as any smooth curve."""
        enough = self.compute_found_cost()
        if not self.point_task.back:
            return fit.cost <= enough
        if not fit.cost <= enough + self.compute_chord_cost():
            return False
        square, z = 0.0, np.empty(2 * len(fit.topology.nodes))
        for target, theta in zip(self.point_task.targets, fit.inputs, strict=True):
            if not move_reference(fit.topology.nodes, fit.x, float(theta), z):
                return False
            x, y = z[2 * fit.topology.point : 2 * fit.topology.point + 2]
            square += target[ROOT] ** 2 * ((x - target[X]) ** 2 + (y - target[Y]) ** 2)
        return 0.5 * square <= enough

    def compute_found_cost(self) -> float:
        """Return half the weighted sum of squares of a fit at the points."""
        return 0.5 * FOUND_ERROR**2 * float(np.sum(self.point_task.targets[:, ROOT] ** 2))

    def compute_chord_cost(self) -> float:
        """Return the cost of the way back of a smooth curve through the points, which leaves the lines between them."""
        points = self.point_task.targets[:, X] + 1j * self.point_task.targets[:, Y]
        # The sag of a parabola over one side is a quarter of a point's distance from the middle of its neighbours; its
        # mean square is 8/15 of the sag's.
        sags = 0.25 * np.abs(points[1:-1] - 0.5 * (points[:-2] + points[2:]))
        return 0.5 * self.point_task.back * 8.0 / 15.0 * float(np.mean(sags**2))

    def _draw_starts(self, rng: np.random.Generator) -> list[Fit]:
        """Return the random linkages that are most similar to the target, of all topologies."""
        count = math.ceil(self.draw_count / len(self.kinds))
        keep = math.ceil(self.family.start_count / len(self.kinds))
        found: list[Fit] = []
        for topology in self.kinds:
            found += find_similar_linkages(
                topology, self.steps, self.problem.closed, count, 2 * keep, rng, family=self.shortest,
                longest=self.problem.longest_link / self.target.size, full_turn=self.full_turn,
            )  # fmt: skip
        # Similar shapes decide, not topologies; but no topology fills the whole list.
        return sort_fits(found)[: self.family.start_count]

    def _interpolate_inputs(self, inputs: Real) -> Real:
        """Return the inputs at the points of a fit, from those at equal steps along the target."""
        fitted = len(self.target.fitted) if self.problem.is_matched else len(self.target.points)
        at = interpolate_crank_angles(self.places, inputs, self.problem.closed, math.tau)
        return np.ascontiguousarray(np.concatenate([at, inputs])[:fitted][self.part])

    def refine(self, pool: Sequence[Fit]) -> list[Fit]:
        """Fit the best to the points under all constraints; failed ones follow the feasible ones."""
        begun = list(pool[: self.compute_fitted_count()])
        if not self.problem.is_fitted:
            begun = descend_softly(begun, self.point_task, MAX_EXACT_STEPS, EXACT_TOLERANCE)
        ends = fit_constrained(begun, self.final_task)
        ends += self._raise_angles(sort_fits(ends))
        failed = [fit for fit, end in zip(begun, ends, strict=False) if not math.isfinite(end.cost)]
        return [*sort_fits(ends), *failed]

    def compute_fitted_count(self) -> int:
        """Return the maximum number of fits that are fitted under all constraints."""
        return max(MAX_FITTED_CONSTRAINED if self.is_judged else MAX_FITTED, self.problem.max_designs)

    def fit_in_any_order(self, pool: Sequence[Fit], progress: Progress) -> list[Fit]:
        """Return fits that approach the points in any order, under all constraints.

        They minimize the mean distance, to which corners contribute less than to squares, and a stroke that is retraced
        may be met on either way. None are returned if the pool is at the points, or if the points do not define the
        curve between them.
        """
        count = self.family.free_generation_count
        if not self.final_task.back or not count or any(map(self.is_at_points, pool)):
            return []
        rng = np.random.default_rng([self.problem.seed, 1])
        task = replace(self.final_task, width=FREE_WIDTH)
        # The ends of a stroke's range are unknowns of this form.
        ranged = not self.problem.closed
        free = [
            fit._replace(x=np.append(fit.x, [fit.inputs.min(), fit.inputs.max()])) if ranged else fit
            for fit in [*pool, *self.unpursued]
        ]
        free = sort_fits(descend_softly(free, task, MAX_HOP_STEPS, weight=FREE_SOFT_WEIGHT))
        for number in range(count):
            progress(number / count, compose("path-linkages-perturbed", number=(number + 1) * HOP_COUNT))
            # Fewer fits are pursued towards the end, the best of them more often.
            live = max(MIN_POOL_SIZE, math.ceil(POOL_SIZE * (1.0 - number / count)))
            hopped = hop_basins(
                free[:live], task, HOP_COUNT, MAX_HOP_STEPS, rng, self.family.halvings, FREE_SOFT_WEIGHT
            )
            free = hopped + free[live:]
        ends = sort_fits(fit_constrained(free[: self.compute_fitted_count()], task))
        return [fit._replace(x=fit.x[:-2]) if ranged else fit for fit in ends]

    def _raise_angles(self, fits: Sequence[Fit]) -> list[Fit]:
        """Return the fits that are as near with a larger transmission angle, refitted in steps of the angle."""
        raised: list[Fit] = []
        # Points that are met exactly must still be met exactly.
        enough = self.compute_found_cost() if self.problem.is_fitted else EXACT_COST
        for angle in RAISED_ANGLES:
            if angle <= self.least_angle or not fits:
                continue
            task = replace(self.final_task, pack_limits=self.build_packer(angle))
            ends = fit_constrained(fits, task, rounds=MAX_RAISING_ROUNDS)
            # Ranking prefers the larger angle only if the error stays in the same class.
            fits = [
                end
                for fit, end in zip(fits, ends, strict=True)
                if end.cost <= max(enough, EQUAL_ERROR_RATIO**2 * fit.cost)
            ]
            raised += fits
        return raised


def solve_by_family(problem: PathProblem, family: Family, types: Sequence[str], progress: Progress) -> PathResult:
    """Solve a problem by linkages of the types of a family whose curves are fitted to the points."""
    search = _Search(problem, family, types)
    ordered = ORDERED_PROGRESS if family.free_generation_count else FREE_PROGRESS
    pool = search.run(scale_progress(progress, 0.0, ordered))
    free = search.fit_in_any_order(pool, scale_progress(progress, ORDERED_PROGRESS, FREE_PROGRESS))
    ends = [*free, *search.refine(pool)]
    made = [
        build_fitted_linkage(search.kinds[fit.topology], fit, search.target.centre, search.target.size) for fit in ends
    ]
    mechanisms = [mechanism for mechanism in made if mechanism is not None]
    return _build_result(problem, family, mechanisms, scale_progress(progress, FREE_PROGRESS, 1.0))


def _build_result(
    problem: PathProblem, family: Family, mechanisms: Sequence[SixbarMechanism | EightbarMechanism], progress: Progress
) -> PathResult:  # fmt: skip
    """Drive the linkages, rank those that pass, and build the result."""
    joints = [[to_complex(joint) for joint in one.skeleton.joints.values()] for one in mechanisms]
    # All linkages of a family have the same number of joints, so their joints can be compared across types.
    chosen = select_distinct(joints, len(joints), DESIGN_DUPLICATE_TOLERANCE * problem.task_size)
    sifting = CandidateLog[PathDesign](problem)
    sifting.verify_candidates(
        report_candidates([mechanisms[n] for n in chosen], progress, (0.0, 1.0), family.driven),
        partial(verify_traced, problem),
    )
    if problem.is_fitted:
        sifting.withdraw(select_near(drop_straying(sifting.passed, problem), problem), FAR_REASON)
    progress(1.0, compose("path-verified"))
    summary = join_sentences(
        [
            # Limits that no drawn linkage is near leave nothing to fit.
            compose(family.passed, passed=sifting.accepted, count=sifting.candidates)
            if sifting.candidates
            else compose("path-no-linkage-fitted"),
            sifting.describe_reasons(),
            "" if sifting.passed else compose("path-none-found"),
        ]
    )
    return PathResult(
        designs=sifting.select_designs(build_ordering(problem)),
        search=sifting.build_search(family.method),
        summary=summary,
    )


def describe_best_linkages(problem: PathProblem, designs: Sequence[PathDesign]) -> str:
    """Describe the best feasible sixbar and the best feasible eightbar of a result; empty if there is none."""
    passing, sentences = select_passing(designs), []
    for kind, name in ((SixbarMechanism, "sixbar"), (EightbarMechanism, "eightbar")):
        best = next((one for one in passing if isinstance(one.mechanism, kind)), None)
        if best is not None:
            sentences.append(_describe_best(problem, best, name))
    return join_sentences(sentences)


_BEST_MESSAGES = {
    "sixbar": ("path-best-sixbar-exact", "path-best-sixbar", "path-best-sixbar-both-ways"),
    "eightbar": ("path-best-eightbar-exact", "path-best-eightbar", "path-best-eightbar-both-ways"),
}
"""Messages about the best linkage by its family: for exact points, for fits, and for fits measured both ways."""


def _describe_best(problem: PathProblem, best: PathDesign, name: str) -> str:
    """Describe the best linkage of a family in a sentence."""
    exact, fitted, both_ways = _BEST_MESSAGES[name]
    # A sixbar has a type, an eightbar has none.
    given = {"link": best.point_link or ""}
    if name == "sixbar":
        given["type"] = compose("path-sixbar-name", type=best.mechanism.type)
    if is_exact(best):
        return compose(exact, **given)
    given |= {"rms_distance": f"{best.metrics.rms_distance:.3g}", "unit": problem.length_unit}
    if best.metrics.both_way_rms is None:
        return compose(fitted, **given)
    return compose(both_ways, both_way_rms=f"{best.metrics.both_way_rms:.3g}", **given)
