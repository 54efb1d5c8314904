"""Points that are fitted: linkages by least squares, each driven over its whole way, those first that come nearest.

Least squares looks at the points alone, and a linkage that is nearest there may go anywhere between them. Where the
nearest do (:mod:`synthesis.kinds.path.nearness`), linkages whose whole curves have the shape of the points' course are
fitted too (:mod:`synthesis.kinds.path.curve_match`). Where a start is stated, the fit descends from that alone.
"""

from __future__ import annotations

import numpy as np

from synthesis.kinds.path.curve_match import fitted_by_shape, stanced_by_points
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.harvest import Harvest
from synthesis.kinds.path.nearness import ERROR_TOLERANCE, FAR, NEARER, error_of, least_error, steady
from synthesis.kinds.path.point_fit import Candidate, descended_from, fitted, mechanism_of, point_task
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.verification import verify_path
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkages import FourbarConfiguration, fourbar_mechanism
from synthesis.outcome.ranking import ranked
from synthesis.outcome.sifting import reported

MIN_DRIVEN = 12
"""Linkages that are verified at least, however few are wanted."""

STRAYS = 1.5
"""The nearest designs go astray where the least error over the whole way is so many times that at the points alone."""

FIRST_PART = 0.6
"""Share of the progress that fits of the points alone count for."""

SAME_FIT = 1e-3
"""Fits whose joints agree to this share of the task's size are one: a flat minimum is known to no more digits."""


def fit_points(problem: PathProblem, progress: Progress) -> PathResult:
    """Fit fourbars to the points of a problem."""
    task = point_task(problem)

    def verified(candidate: Candidate) -> PathDesign | None:
        mechanism = mechanism_of(candidate, task)
        return None if mechanism is None else verify_path(problem, mechanism)

    def driven(linkage: FourbarConfiguration) -> PathDesign | str | None:
        return verify_path(problem, fourbar_mechanism(linkage))

    fits = _Fits(problem, apart=SAME_FIT)
    first, second = part_of(progress, 0.0, FIRST_PART), part_of(progress, FIRST_PART, 1.0)
    if problem.start is not None:
        minima = descended_from(FourbarConfiguration(*problem.start.joints), problem, task)
    else:
        minima = fitted(problem, task, np.random.default_rng(problem.seed), first)
    fits.sift(
        reported(minima, first, (0.9, 1.0), "driving linkage {next} of {all}"),
        verified,
        enough=max(2 * problem.max_designs, MIN_DRIVEN),
    )
    if problem.stance is not None:
        fits.sift(stanced_by_points(problem, minima, task), driven)
    if problem.start is None and not problem.prescribed and fits.astray():
        linkages = fitted_by_shape(problem, second)
        fits.sift(reported(linkages, second, (0.8, 1.0), "driving linkage {next} of {all}"), driven)
    kept = steady(fits.passed, problem)
    if fits.passed and not problem.closed and (nearest := _nearest(fits.passed)) not in kept:
        kept.append(nearest)
    fits.withdraw(kept, FAR)
    progress(1.0, "verified")
    return fits.result("least_squares", complete=False, summary=fits.summary())


class _Fits(Harvest):
    """What becomes of the fits."""

    def astray(self) -> bool:
        """Whether no design that passes comes as near over its whole way as the nearest does at the points."""
        least = min((design.metrics.rms_distance for design in self.passed), default=0.0)
        nearest = max(least, ERROR_TOLERANCE * self.problem.task_size)
        return least_error(self.passed, self.problem) > STRAYS * nearest

    def different(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Nearest first unless another order is asked for or points have tolerances: then quality decides.

        What comes nearest at the points alone is always among those returned, last where it goes astray between them:
        points that lie far apart say little of the way from one to the next.
        """
        if self.problem.tolerances is not None:
            return ranked(super().different(designs), self.problem.rank_by)

        def error(design: PathDesign) -> float:
            return error_of(design, self.problem)

        order = ranked(super().different(designs), self.problem.rank_by, {"quality": error, "accuracy": error})
        shown = order[: self.problem.max_designs]
        passed = [design for design in designs if design.verification.passed]
        if len(shown) > 1 and passed:
            nearest, limit = _nearest(passed), NEARER * ERROR_TOLERANCE * self.problem.task_size
            if _nearest(shown).metrics.rms_distance > max(NEARER * nearest.metrics.rms_distance, limit):
                shown = [*shown[: self.problem.max_designs - 1], nearest]
        return [*shown, *(design for design in order if design not in shown)]

    def summary(self) -> str:
        """The answer in words."""
        n, unit = len(self.problem.points), self.problem.length_unit
        timing = "at their crank angles" if self.problem.prescribed else "in order"
        if self.passed:
            best = min(self.passed, key=lambda design: error_of(design, self.problem)).metrics
            passed, of = len(self.passed), counted(self.candidates, "fitted linkage")
            text = (
                f"{grouped(passed)} of {of} {agreeing(passed, 'satisfies', 'satisfy')} all demands; the best passes "
                "the "
                f"{n} points {timing} with a root-mean-square distance of {best.rms_distance:.4g} {unit} and at most "
                f"{best.max_distance:.4g} {unit} (sum of squares {best.sum_of_squares:.6g} {unit}²)."
            )
            if best.excursion:
                text += f" Between the points it goes {best.excursion:.4g} {unit} farther than these tell."
            if self.rejected[FAR]:
                others = counted(self.rejected[FAR], "other is", "others are")
                text += f" {others} near the points, but far from their course between them."
        else:
            rejected = self.listed() or "none"
            text = f"None of {counted(self.candidates, 'fitted linkage')} satisfies all demands (rejected: {rejected})."
        if self.problem.start is not None:
            return text + " Least squares descends from the start that is stated; elsewhere a nearer linkage may exist."
        return text + " Least squares descends from many starts; a nearer linkage may exist that none of them leads to."


def _nearest(designs: list[PathDesign]) -> PathDesign:
    """The design that comes nearest at the points."""
    return min(designs, key=lambda design: design.metrics.sum_of_squares)
