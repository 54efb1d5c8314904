"""Sixbars that guide a point along a curve or past points: shapes compared, the most similar fitted, the best driven.

A round, for all topologies of the requested types (:data:`~synthesis.fit.linkage.topology.SIXBAR_FORMS`) together:

1. linkages are drawn and their curves compared with the target; the most similar are placed on it;
2. they descend on all of their dimensions at equal steps along the target, with the constraints as penalties;
3. the best of all rounds are fitted to the points themselves and hop from basin to basin.

Rounds end when a fit is at the points, or after :data:`MAX_ROUNDS`. The best are then fitted to the points, and to the
curve between them if the points define it, with all constraints enforced. :mod:`synthesis.fit.linkage.margins` lists
the constraints known to the kernels; all constraints are verified on the driven sixbar. If no transmission angle is
required, at least :data:`~synthesis.results.simplest_type.SOUND_TRANSMISSION_ANGLE` degrees are the aim.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from kinematics.message import compose
from synthesis.fit.linkage.descent import (
    Fit,
    FitTask,
    build_point_targets,
    descend_softly,
    fit_constrained,
    hop_basins,
    sort_fits,
)
from synthesis.fit.linkage.residuals import ROOT
from synthesis.fit.linkage.topology import SIXBAR_FORMS, Topology
from synthesis.kinds.path.curve.fits import get_thinning
from synthesis.kinds.path.curve.stance_fit import pack_target_stance
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.fallback import solve_exactly_or_fit
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.residuals.stance import MARGIN_COUNT, compute_linkage_stance_rows
from synthesis.kinds.path.results import join_sentences
from synthesis.kinds.path.sixbar.limits import CLASS_LINKS, build_packer
from synthesis.kinds.path.sixbar.mechanism import build_fitted_sixbar
from synthesis.kinds.path.sixbar.shape_matching import find_similar_linkages
from synthesis.kinds.path.task.ranking import (
    EQUAL_ERROR_RATIO,
    FAR_REASON,
    MAX_LINK_RATIO,
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
from synthesis.model.linkage.answer import SixbarMechanism
from synthesis.model.linkage.conversion import to_complex
from synthesis.results.candidate_log import CandidateLog, report_candidates
from synthesis.results.ranking import select_distinct
from synthesis.results.simplest_type import SOUND_TRANSMISSION_ANGLE, select_passing

MAX_ROUNDS, DRAW_COUNT, START_COUNT = 6, 24576, 120
"""Maximum number of rounds; number of linkages drawn in a round, and of the most similar that are fitted, over all
topologies."""

OPEN_DRAW_SHARE = 0.25
"""Share of the drawn number for a stroke, which is compared with parts of each curve."""

MAX_START_STEPS, MAX_HOP_STEPS = 40, 50
"""Number of steps of descents: of starts, and of perturbed copies."""

POOL_SIZE, HOP_COUNT, GENERATION_COUNT = 24, 24, 8
"""Number of fits that are kept; of perturbed copies in a generation; and of generations in a round."""

FOUND_ERROR = 2e-4
"""Root mean square distance from the points, as a share of the target's size, at which a fit is at them and the search
ends: a better one could not be manufactured."""

MIN_FOUND, MIN_FOUND_CONSTRAINED = 4, 16
"""Number of fits at the points that end the search, a choice for the ranking; and the same if some constraints are
checked on the driven sixbar only."""

RAISED_ANGLES, MAX_RAISING_ROUNDS = (30.0, 40.0, 50.0), 4
"""Transmission angles, degrees, that good fits are raised to as far as their error permits, and the number of rounds of
such fits."""

MAX_FITTED, MAX_FITTED_CONSTRAINED = 12, 24
"""Number of fits that are refitted under all constraints and driven; and the same if a workspace, planes or forces are
constrained, which are checked on the driven sixbar only. More if more designs are requested."""

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
"""Sixbars whose joints agree to this share of the task's size are duplicates."""


def solve_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    """Solve a problem of path generation by sixbars of the types that it names."""
    if problem.is_fitted:
        return _solve_by_sixbars(problem, progress)
    return solve_exactly_or_fit(problem, progress, _solve_by_sixbars, _solve_by_sixbars)


def warm_up() -> None:
    """Compile or load the kernels on a small circle."""
    circle = np.exp(2j * np.pi * np.arange(SHAPE_POINT_COUNT) / SHAPE_POINT_COUNT)
    stated = {"points": [{"x": z.real, "y": z.imag} for z in circle], "mechanisms": ["stephenson_3"]}
    problem = PathProblem.model_validate({"kind": "path", "method": "curve_match", "closed": True, **stated})
    pack_limits = build_packer(problem, 0j, 1.0, SOUND_TRANSMISSION_ANGLE, MAX_LINK_RATIO)
    task = FitTask(build_point_targets(circle, np.ones(SHAPE_POINT_COUNT)), pack_limits, back=1.0)
    for kind in ("stephenson_3", "stephenson_2"):
        fits = find_similar_linkages(SIXBAR_FORMS[kind][0], circle, True, 256, 2, np.random.default_rng(0))
        fit_constrained(descend_softly(fits, task, 2), task, rounds=1, steps=2)


class _Search:
    """A search for sixbars along a target."""

    def __init__(self, problem: PathProblem) -> None:
        self.problem = problem
        self.target = TargetCurve(problem)
        limits = problem.constraints
        required_angle = limits.min_transmission_angle
        # Without a required angle sixbars would often end next to a toggle, where they are useless.
        self.least_angle = SOUND_TRANSMISSION_ANGLE if required_angle is None else required_angle
        pack_limits = self.build_packer(self.least_angle)
        self.family = CLASS_LINKS[limits.grashof]
        # The input of a stroke may swing, unless a full turn is required or a class that makes full turns.
        self.full_turn = problem.closed or limits.full_rotation or self.family >= 0
        self.steps, self.places = self.target.steps, self.target.places
        # Few points define no curve: a spline through them serves as the target of the comparison.
        if len(self.target.points) < MIN_DEFINING_POINTS and not problem.is_matched:
            self.steps, self.places = sample_smooth_steps(self.target.points, self.target.closed)
        self.shape_task = FitTask(
            build_point_targets(self.steps, np.ones(SHAPE_POINT_COUNT)), pack_limits, self.full_turn, SOFT_STEP_COUNT
        )
        self.point_task, self.final_task, self.part = self._build_point_tasks()
        self.kinds = {id(topology): kind for kind in problem.sixbars for topology in SIXBAR_FORMS[kind]}
        # Constraints that the fits do not know reject many sixbars: keep more of them.
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
        # Only a dense closed polyline defines the curve between its points.
        dense = problem.is_fitted and problem.closed and len(target.points) >= MIN_POLYLINE_POINTS
        # Both directions count equally: the steps of the curve share the total weight of the points.
        back = float(weights.sum()) if dense else 0.0
        final = replace(soft, steps=BACK_STEP_COUNT if dense else ANGLE_STEP_COUNT, back=back)
        if stance is not None:
            final = replace(
                final, rows=compute_linkage_stance_rows, prefix=stance, prefix_margins=MARGIN_COUNT
            )  # fmt: skip
        return soft, final, part

    def list_topologies(self) -> list[Topology]:
        """Return the topologies of the requested types."""
        return [topology for kind in self.problem.sixbars for topology in SIXBAR_FORMS[kind]]

    def run(self, progress: Progress) -> list[Fit]:
        """Return the best fits to the points, the nearest first, with constraints as penalties."""
        rng, topologies = np.random.default_rng(self.problem.seed), self.list_topologies()
        pool: list[Fit] = []
        found, enough = 0, self.compute_found_cost()
        for number in range(MAX_ROUNDS):
            progress(
                number / MAX_ROUNDS,
                compose("path-sixbars-fitted", compared=DRAW_COUNT, fitted=START_COUNT, round=number + 1),
            )
            starts = self._draw_starts(topologies, rng)
            fits = sort_fits(descend_softly(starts, self.shape_task, MAX_START_STEPS))[:POOL_SIZE]
            moved = [fit._replace(inputs=self._interpolate_inputs(fit.inputs)) for fit in fits]
            pool = sort_fits([*pool, *descend_softly(moved, self.point_task, MAX_HOP_STEPS)])[:POOL_SIZE]
            for _ in range(GENERATION_COUNT):
                found = sum(fit.cost <= enough for fit in pool)
                # A problem with constraints that the kernels do not know needs a choice of fits, not only one.
                if found >= (MIN_FOUND_CONSTRAINED if self.is_judged else MIN_FOUND):
                    return pool
                pool = hop_basins(pool, self.point_task, HOP_COUNT, MAX_HOP_STEPS, rng)
            if found and not self.is_judged:
                break
        return pool

    def compute_found_cost(self) -> float:
        """Return half the weighted sum of squares of a fit at the points."""
        return 0.5 * FOUND_ERROR**2 * float(np.sum(self.point_task.targets[:, ROOT] ** 2))

    def _draw_starts(self, topologies: Sequence[Topology], rng: np.random.Generator) -> list[Fit]:
        """Return the random linkages that are most similar to the target, of all topologies."""
        share = 1.0 if self.problem.closed else OPEN_DRAW_SHARE
        count = math.ceil(share * DRAW_COUNT / len(topologies))
        keep = math.ceil(START_COUNT / len(topologies))
        found: list[Fit] = []
        for topology in topologies:
            found += find_similar_linkages(
                topology, self.steps, self.problem.closed, count, 2 * keep, rng, family=self.family,
                longest=self.problem.longest_link / self.target.size, full_turn=self.full_turn,
            )  # fmt: skip
        # Similar shapes decide, not topologies; but no topology fills the whole list.
        return sort_fits(found)[:START_COUNT]

    def _interpolate_inputs(self, inputs: Real) -> Real:
        """Return the inputs at the points of a fit, from those at equal steps along the target."""
        fitted = len(self.target.fitted) if self.problem.is_matched else len(self.target.points)
        at = interpolate_crank_angles(self.places, inputs, self.problem.closed, math.tau)
        return np.ascontiguousarray(np.concatenate([at, inputs])[:fitted][self.part])

    def refine(self, pool: Sequence[Fit]) -> list[Fit]:
        """Fit the best to the points under all constraints; failed ones follow the feasible ones."""
        count = MAX_FITTED_CONSTRAINED if self.is_judged else MAX_FITTED
        begun = list(pool[: max(count, self.problem.max_designs)])
        if not self.problem.is_fitted:
            begun = descend_softly(begun, self.point_task, MAX_EXACT_STEPS, EXACT_TOLERANCE)
        ends = fit_constrained(begun, self.final_task)
        ends += self._raise_angles(sort_fits(ends))
        failed = [fit for fit, end in zip(begun, ends, strict=False) if not math.isfinite(end.cost)]
        return [*sort_fits(ends), *failed]

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


def _solve_by_sixbars(problem: PathProblem, progress: Progress) -> PathResult:
    search = _Search(problem)
    ends = search.refine(search.run(scale_progress(progress, 0.0, 0.7)))
    made = [
        build_fitted_sixbar(search.kinds[id(fit.topology)], fit, search.target.centre, search.target.size)
        for fit in ends
    ]
    mechanisms = [mechanism for mechanism in made if mechanism is not None]
    return _build_result(problem, mechanisms, scale_progress(progress, 0.8, 1.0))


def _build_result(problem: PathProblem, mechanisms: list[SixbarMechanism], progress: Progress) -> PathResult:
    """Drive the sixbars, rank those that pass, and build the result."""
    joints = [[to_complex(joint) for joint in one.skeleton.joints.values()] for one in mechanisms]
    # All sixbars have eight joints, so that those of different types can be compared.
    chosen = select_distinct(joints, len(joints), DESIGN_DUPLICATE_TOLERANCE * problem.task_size)
    sifting = CandidateLog[PathDesign](problem)
    sifting.verify_candidates(
        report_candidates([mechanisms[n] for n in chosen], progress, (0.0, 1.0), "path-sixbars-driven"),
        partial(verify_traced, problem),
    )
    if problem.is_fitted:
        sifting.withdraw(select_near(drop_straying(sifting.passed, problem), problem), FAR_REASON)
    progress(1.0, compose("path-verified"))
    summary = join_sentences(
        [
            compose("path-sixbars-passed", passed=sifting.accepted, count=sifting.candidates),
            sifting.describe_reasons(),
            "" if sifting.passed else compose("path-none-found"),
        ]
    )
    return PathResult(
        designs=sifting.select_designs(build_ordering(problem)),
        search=sifting.build_search("sixbar_shapes"),
        summary=summary,
    )


def describe_best_sixbar(problem: PathProblem, designs: Sequence[PathDesign]) -> str:
    """Describe the best feasible sixbar of a result in a sentence; empty if there is none."""
    sixbars = [one for one in select_passing(designs) if isinstance(one.mechanism, SixbarMechanism)]
    if not sixbars:
        return ""
    best = sixbars[0]
    name, link = compose("path-sixbar-name", type=best.mechanism.type), best.point_link or ""
    if is_exact(best):
        return compose("path-best-sixbar-exact", type=name, link=link)
    rms_distance, unit = f"{best.metrics.rms_distance:.3g}", problem.length_unit
    if best.metrics.both_way_rms is None:
        return compose("path-best-sixbar", type=name, link=link, rms_distance=rms_distance, unit=unit)
    return compose(
        "path-best-sixbar-both-ways",
        type=name,
        link=link,
        rms_distance=rms_distance,
        unit=unit,
        both_way_rms=f"{best.metrics.both_way_rms:.3g}",
    )
