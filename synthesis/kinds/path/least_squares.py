"""Fit points: linkages by least squares, each driven over its used range, the nearest first.

Least squares evaluates the points alone, and a linkage that is nearest there may stray far between them. If the nearest
ones stray (:mod:`synthesis.kinds.path.task.ranking`), linkages whose whole curves have the shape of the points' course
are fitted too (:mod:`synthesis.kinds.path.curve.solver`). If a start is given, the fit descends from it alone.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from kinematics.message import compose, join_messages
from synthesis.kinds.path.curve.solver import fit_by_shape, fit_stance_from_points
from synthesis.kinds.path.design import PathDesign, PathResult
from synthesis.kinds.path.points.fit import Candidate, build_mechanism, build_point_task, descend_from, find_minima
from synthesis.kinds.path.problem import PathProblem
from synthesis.kinds.path.results import PathCandidateLog
from synthesis.kinds.path.task.ranking import (
    ACCURATE_ERROR_RATIO,
    ERROR_TOLERANCE,
    FAR_REASON,
    compute_error,
    drop_straying,
    find_min_error,
)
from synthesis.kinds.path.verification.fourbar import verify_path
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.conversion import FourbarConfiguration, build_fourbar
from synthesis.results.candidate_log import report_candidates
from synthesis.results.ranking import rank_designs, select_best

MIN_DRIVEN = 12
"""Minimum number of linkages that are verified, even if fewer designs are requested."""

STRAY_RATIO = 1.5
"""Ratio of the minimum error over the used range to that at the points alone above which the nearest designs stray."""

POINT_FIT_PROGRESS_SHARE = 0.6
"""Share of the progress assigned to fits of the points alone."""

FIT_DUPLICATE_TOLERANCE = 1e-3
"""Fits whose joints agree to this share of the task's size are duplicates. A flat minimum has no more reliable digits.
"""


def fit_points(problem: PathProblem, progress: Progress) -> PathResult:
    """Fit fourbars to the points of a problem."""
    task = build_point_task(problem)

    def verify_candidate(candidate: Candidate) -> PathDesign | None:
        mechanism = build_mechanism(candidate, task)
        return None if mechanism is None else verify_path(problem, mechanism)

    def verify_linkage(linkage: FourbarConfiguration) -> PathDesign | str | None:
        return verify_path(problem, build_fourbar(linkage))

    fits = _PointFits(problem, apart=FIT_DUPLICATE_TOLERANCE)
    first, second = (
        scale_progress(progress, 0.0, POINT_FIT_PROGRESS_SHARE),
        scale_progress(progress, POINT_FIT_PROGRESS_SHARE, 1.0),
    )
    if problem.start is not None:
        minima = descend_from(FourbarConfiguration(*problem.start.joints), problem, task)
    else:
        minima = find_minima(problem, task, np.random.default_rng(problem.seed), first)
    fits.verify_candidates(
        report_candidates(minima, first, (0.9, 1.0), "path-driving-linkages"),
        verify_candidate,
        # Twice the requested number, because some of the nearest will be dropped for straying between the points.
        enough=max(2 * problem.max_designs, MIN_DRIVEN),
    )
    if problem.stance is not None:
        fits.verify_candidates(fit_stance_from_points(problem, minima, task), verify_linkage)
    # Prescribed crank angles leave no freedom for a curve of another shape.
    if problem.start is None and not problem.prescribed and fits.is_astray():
        linkages = fit_by_shape(problem, second)
        fits.verify_candidates(report_candidates(linkages, second, (0.8, 1.0), "path-driving-linkages"), verify_linkage)
    kept = drop_straying(fits.passed, problem)
    # For an open curve the points alone may be what the client means; a design that strays is listed last.
    if fits.passed and not problem.closed and (nearest := _find_nearest(fits.passed)) not in kept:
        kept.append(nearest)
    fits.withdraw(kept, FAR_REASON)
    progress(1.0, compose("path-verified"))
    return fits.build_result("least_squares", complete=False, summary=fits.describe_result())


class _PointFits(PathCandidateLog):
    """The verified fits, their selection, order and summary."""

    def is_astray(self) -> bool:
        """Return whether every passed design strays over its used range, compared with the nearest at the points."""
        least = min((design.metrics.rms_distance for design in self.passed), default=0.0)
        nearest = max(least, ERROR_TOLERANCE * self.problem.task_size)
        return find_min_error(self.passed, self.problem) > STRAY_RATIO * nearest

    def select_distinct(self, designs: list[PathDesign]) -> list[PathDesign]:
        """Return distinct designs, nearest first unless another order is requested.

        If points have tolerances, designs are ordered by quality. The design nearest at the points alone is always
        returned, in the last place if it strays between them, because distant points do not define the curve between
        them.
        """
        # Within tolerances all designs are near enough.
        if self.problem.tolerances is not None:
            return rank_designs(super().select_distinct(designs), self.problem.rank_by)

        def get_error(design: PathDesign) -> float:
            return compute_error(design, self.problem)

        order = rank_designs(
            super().select_distinct(designs), self.problem.rank_by, {"quality": get_error, "accuracy": get_error}
        )
        shown = order[: self.problem.max_designs]
        passed = [design for design in designs if design.verification.passed]
        if len(shown) > 1 and passed:
            nearest, limit = _find_nearest(passed), ACCURATE_ERROR_RATIO * ERROR_TOLERANCE * self.problem.task_size
            if _find_nearest(shown).metrics.rms_distance > max(
                ACCURATE_ERROR_RATIO * nearest.metrics.rms_distance, limit
            ):
                # The last of the shown designs makes room for the nearest.
                shown = [*shown[: self.problem.max_designs - 1], nearest]
        return [*shown, *(design for design in order if design not in shown)]

    def describe_result(self) -> str:
        """Describe the result in words."""
        started = compose(
            "path-descended-from-many-starts" if self.problem.start is None else "path-descended-from-given-start"
        )
        if not self.passed:
            failure = compose("path-no-fits")
            if self.rejected:
                failure = compose("path-no-fit-passed", count=self.candidates, reasons=self.format_reasons())
            return join_messages([failure, started])
        unit = self.problem.length_unit
        best = select_best(self.passed, partial(compute_error, problem=self.problem)).metrics
        return join_messages(
            [
                compose("path-fits-passed", passed=len(self.passed), count=self.candidates),
                compose(
                    "path-best-fit-with-timing" if self.problem.prescribed else "path-best-fit-in-order",
                    points=len(self.problem.points),
                    rms_distance=f"{best.rms_distance:.4g}",
                    max_distance=f"{best.max_distance:.4g}",
                    sum_of_squares=f"{best.sum_of_squares:.6g}",
                    unit=unit,
                ),
                compose("path-curve-strays", excursion=f"{best.excursion:.4g}", unit=unit) if best.excursion else "",
                compose("path-fits-far-between-points", count=self.rejected[FAR_REASON])
                if self.rejected[FAR_REASON]
                else "",
                started,
            ]
        )


def _find_nearest(designs: list[PathDesign]) -> PathDesign:
    """Return the design nearest at the points."""
    return select_best(designs, lambda design: design.metrics.sum_of_squares)
