"""Fit points: linkages by least squares, each driven over its used range, the nearest first.

Least squares evaluates the points alone, and a linkage that is nearest there may go anywhere between them. If the
nearest ones do (:mod:`synthesis.kinds.path.nearness`), linkages whose whole curves have the shape of the points' course
are fitted too (:mod:`synthesis.kinds.path.curve_match`). If a start is given, the fit descends from it alone.
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
"""Minimum number of linkages that are verified, even if fewer designs are requested."""

STRAYS = 1.5
"""The nearest designs stray if the minimum error over the used range exceeds that at the points alone by this
factor."""

FIRST_PART = 0.6
"""Share of the progress assigned to fits of the points alone."""

SAME_FIT = 1e-3
"""Fits whose joints agree to this share of the task's size are duplicates: a flat minimum is known to no more
digits."""


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
        # Twice the requested number, because some of the nearest will be dropped for straying between the points.
        enough=max(2 * problem.max_designs, MIN_DRIVEN),
    )
    if problem.stance is not None:
        fits.sift(stanced_by_points(problem, minima, task), driven)
    # Prescribed crank angles leave no freedom for a curve of another shape.
    if problem.start is None and not problem.prescribed and fits.astray():
        linkages = fitted_by_shape(problem, second)
        fits.sift(reported(linkages, second, (0.8, 1.0), "driving linkage {next} of {all}"), driven)
    kept = steady(fits.passed, problem)
    # For an open curve the points alone may be what the client means.
    if fits.passed and not problem.closed and (nearest := _nearest(fits.passed)) not in kept:
        kept.append(nearest)
    fits.withdraw(kept, FAR)
    progress(1.0, "verified")
    return fits.result("least_squares", complete=False, summary=fits.summary())


class _Fits(Harvest):
    """The verified fits, their selection, order and summary."""

    def astray(self) -> bool:
        """Return whether no passed design comes as near over its used range as the nearest does at the points."""
        least = min((design.metrics.rms_distance for design in self.passed), default=0.0)
        nearest = max(least, ERROR_TOLERANCE * self.problem.task_size)
        return least_error(self.passed, self.problem) > STRAYS * nearest

    def different(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return distinct designs, nearest first unless another order is requested or points have tolerances (then by
        quality).

        The design nearest at the points alone is always among those returned, last if it strays between them: distant
        points say little about the curve between them.
        """
        # Within tolerances all designs are near enough.
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
                # The last of the shown designs makes room for the nearest.
                shown = [*shown[: self.problem.max_designs - 1], nearest]
        return [*shown, *(design for design in order if design not in shown)]

    def summary(self) -> str:
        """Describe the result in words."""
        n, unit = len(self.problem.points), self.problem.length_unit
        timing = "at their crank angles" if self.problem.prescribed else "in order"
        if self.passed:
            best = min(self.passed, key=lambda design: error_of(design, self.problem)).metrics
            passed, of = len(self.passed), counted(self.candidates, "fitted linkage")
            text = (
                f"{grouped(passed)} of {of} {agreeing(passed, 'satisfies', 'satisfy')} all constraints. The best "
                f"passes the {n} points {timing} with a root-mean-square distance of {best.rms_distance:.4g} {unit} "
                f"and a maximum of {best.max_distance:.4g} {unit} (sum of squares {best.sum_of_squares:.6g} {unit}²)."
            )
            if best.excursion:
                text += f" Between the given points the curve strays by up to {best.excursion:.4g} {unit}."
            if self.rejected[FAR]:
                others = counted(self.rejected[FAR], "other is", "others are")
                text += f" {others} near the points, but far from their course between them."
        else:
            rejected = self.listed() or "none"
            text = (
                f"None of {counted(self.candidates, 'fitted linkage')} satisfies all constraints "
                f"(rejected: {rejected})."
            )
        if self.problem.start is not None:
            return text + " Least squares descended from the given start; a nearer linkage may exist elsewhere."
        return text + " Least squares descended from many starts; a nearer linkage may exist that none of them reaches."


def _nearest(designs: list[PathDesign]) -> PathDesign:
    """Return the design nearest at the points."""
    return min(designs, key=lambda design: design.metrics.sum_of_squares)
