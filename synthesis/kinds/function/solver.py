"""Function generation: exact linkages for pairs or precision points, otherwise the best approximations.

The number of pairs relative to the open parameters decides the method. As many pairs as proportions and open zeros (and
one scale) leave finitely many solutions, all of which are found; fewer leave a family, which is searched; if two scales
are needed, a grid of scales is searched. Every linkage is verified by driving it.
"""

from __future__ import annotations

import math
from collections import Counter
from functools import partial

import numpy as np

from kinematics.arrays import Real
from kinematics.message import compose, join_messages
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.fourbar.approximation import GeneratorDescent, find_approximations
from synthesis.kinds.function.fourbar.constraints import GeneratorLimits
from synthesis.kinds.function.fourbar.free_scales import Scaling, solve_one_scale, solve_two_scales
from synthesis.kinds.function.fourbar.precision_points import (
    refine_generator,
    sample_family,
    solve_exact,
    solve_many_exact,
)
from synthesis.kinds.function.fourbar.structural_error import PARAMETER_COUNT
from synthesis.kinds.function.fourbar.task import FunctionTask, build_mechanism, make_function_task
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.ranking import get_error, rank_by_error
from synthesis.kinds.function.type_selection import REASONS, solve_types
from synthesis.kinds.function.verification.verify import verify_function
from synthesis.model.kind import Progress, scale_progress
from synthesis.results.candidate_log import OUTRANKED_REASON, CandidateLog
from synthesis.results.ranking import select_best

MEMBER_COUNT = 4000
"""Number of sampled members of a family."""

SCALE_SLICE_COUNT = 40
"""Number of values of one scale at which the other is solved for, if both are open and only one is needed."""

VERIFIED_PER_DESIGN = 6
"""Maximum number of verified family members per requested design."""

FALLBACK_ANGLES = (30.0, 10.0, 2.0)
"""Minimum transmission angles, degrees, tried in turn if the best approximation without a limit is at a toggle or
change point and cannot be driven."""

COARSE_TOLERANCE = 0.02
"""Maximum constraint violation of a member, in the first estimate, for it to be verified."""

MAX_FIT_ROUNDS, FITS_PER_ROUND, MAX_FIT_STEPS, ENOUGH_FITS = 4, 24, 40, 3
"""Constrained fits if no sampled member satisfies the limits: maximum number of rounds with new samples, number of fits
per round, steps of each, and number of designs that ends them."""

CONVERGED_ERROR, MAX_REFINABLE_ERROR = 1e-12, 1e-7
"""Error including constraint violation: convergence tolerance of a fit, and maximum for a member to be refined and
verified."""

MAX_PROMISING_ERROR = 0.2
"""Smallest weighted error of a round above which no further round follows; it corresponds to a violation of a
fiftieth."""

MIN_SEPARATION = 0.1
"""Minimum difference of verified family members, in the logarithm of a length or in an angle (radians)."""

DUPLICATE_TOLERANCE = 1e-7
"""Relative difference of the parameters below which two solutions are duplicates."""

USABLE_SINE = math.sin(math.radians(30.0))
"""Sine of the transmission angle below which a family member is returned only if none reaches it."""

FIXED_ZERO_SHARE = 0.5
"""Share of the progress assigned to the first search, with pairs as angles from the ground line, before the zeros are
opened."""

_NUMERICAL_REASONS = {"residual", "cannot_be_driven"}
"""Rejection reasons that reflect numerical limits and prove nothing."""

_PLACEMENT_REASONS = {"fixed_pivot_zones", "moving_pivot_zones", "box", "obstacles"}
"""Rejection reasons that mean that no placement in the workspace was found, if the placement is free."""


def solve_function(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve a function-generation problem, each type of linkage by its own search."""
    if problem.mechanisms is not None:
        return solve_types(problem, _solve_simple, progress)
    return _solve_simple(problem, progress)


def _solve_simple(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for fourbars or slider-cranks."""
    if not problem.from_ground:
        return _solve_with_zeros(problem, progress)
    # "auto" zeros: first read few pairs as angles from the ground line, and open the zeros only if that fails.
    held = _solve_with_zeros(problem, scale_progress(progress, 0.0, FIXED_ZERO_SHARE), fit_limits=False)
    if any(design.verification.passed for design in held.designs):
        progress(1.0, compose("function-verified"))
        return held.model_copy(
            update={"summary": join_messages([held.summary, compose("function-values-read-as-angles")])}
        )
    opened = _solve_with_zeros(
        problem.model_copy(update={"zeros": None}), scale_progress(progress, FIXED_ZERO_SHARE, 1.0)
    )
    # Both searches count, because both were needed for the answer.
    account = opened.search.model_copy(
        update={
            "candidates": held.search.candidates + opened.search.candidates,
            "rejected": dict(Counter(held.search.rejected) + Counter(opened.search.rejected)),
        }
    )
    return opened.model_copy(
        update={
            "designs": [*opened.designs, *held.designs][: problem.max_designs],
            "search": account,
            "summary": join_messages([compose("function-zeros-left-open"), opened.summary]),
        }
    )


def _solve_with_zeros(problem: FunctionProblem, progress: Progress, *, fit_limits: bool = True) -> FunctionResult:
    """Solve with the problem's zeros, given or open; ``fit_limits`` as for :func:`_search_family`."""
    task = make_function_task(problem)
    progress(0.0, compose("function-reading-problem"))
    rng = np.random.default_rng(problem.seed)
    harvest = _FunctionLog(task)
    if problem.aim != "precision":
        judged = improved = 0
        # The limit is tightened only if the client set none.
        for least in (None, *(FALLBACK_ANGLES if problem.constraints.min_transmission_angle is None else ())):
            found = find_approximations(task, rng, progress, least)
            judged, improved = judged + found.judged, improved + found.improved
            for one in found.optima:
                harvest.verify(one.generator, one.sign)
            # The next, stricter angle is needed only if the optimum is undrivable.
            if harvest.passed:
                break
        progress(1.0, compose("function-verified"))
        return harvest.build_approximation_result(judged, improved)
    # Degrees of freedom: three proportions and the open zeros, less one per pair; scales supply the difference.
    missing = 3 + sum(zero is None for zero in task.zeros) - len(task.inputs)
    # Elements 5 and 6 of the parameters are the scales of input and output.
    open_scales = int(task.free[5]) + int(task.free[6])
    if missing == -2 or (missing == -1 and open_scales == 2):
        _solve_two_scales(task, harvest, missing, progress)
        return harvest.build_search_result("two_scales")
    if missing == -1:
        proved = _solve_one_scale(task, harvest)
        return harvest.build_exact_result(proved, "one_scale")
    if missing == 0 and open_scales == 0:
        proved = _solve_determined(task, harvest)
        # If all solutions are known, none exists beyond them, even if none passed.
        if harvest.passed or proved:
            return harvest.build_exact_result(proved, "exact")
        # Pairs of a linkage with equivalents, for example a parallelogram, do not determine it: search the family.
    _search_family(task, harvest, rng, progress, fit_limits=fit_limits)
    return harvest.build_search_result("family")


def warm_up() -> None:
    """Load and compile everything that the solver and its verification need."""
    for spec in (_WARM_FOURBAR, _WARM_SLIDER, _WARM_ROOM):
        solve_function(FunctionProblem.model_validate(spec), lambda fraction, message: None)


def _list_scale_choices(task: FunctionTask) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    return [(first, second) for first in task.scales[0] for second in task.scales[1]]


def _solve_determined(task: FunctionTask, harvest: _FunctionLog) -> bool:
    """Verify all linkages if nothing is open; return whether these are proved to be all."""
    proved = True
    # An interval of one value: the scale is given, so only its lower end matters.
    for (k, _), (scale, _) in _list_scale_choices(task):
        found = solve_exact(task.closure, k * task.inputs, scale * task.outputs, task.zeros)
        proved &= found.proved
        harvest.reject("degenerate", found.degenerate)
        for dimensions in found.dimensions:
            harvest.refine_and_verify(np.concatenate([dimensions, [k, scale]]))
    return proved


def _solve_one_scale(task: FunctionTask, harvest: _FunctionLog) -> bool:
    """Verify all linkages if exactly one scale is open and must be found; return whether these are proved to be all."""
    # The side of the open scale; the other one is fixed within its choice.
    side = 0 if task.free[5] else 1
    pairs = Scaling(task.closure, task.inputs, task.outputs, task.zeros)
    proved = True
    for choice in _list_scale_choices(task):
        found = solve_one_scale(pairs, choice[side], side, choice[1 - side][0])
        proved &= found.proved
        harvest.reject("degenerate", found.degenerate)
        for generator in found.dimensions:
            harvest.refine_and_verify(generator)
    return proved


def _solve_two_scales(task: FunctionTask, harvest: _FunctionLog, missing: int, progress: Progress) -> None:
    """Verify linkages if both scales are open: solve for both, or for one at each of many values of the other."""
    pairs = Scaling(task.closure, task.inputs, task.outputs, task.zeros)
    as_stated = np.ones((1 if task.problem.pairs is not None else 0, 2))
    choices = _list_scale_choices(task)
    for n, (first, second) in enumerate(choices):
        progress(n / len(choices), compose("function-solving-scales"))
        if missing == -2:
            for generator in solve_two_scales(pairs, first, second, as_stated):
                harvest.refine_and_verify(generator)
        else:
            for k in (
                # Geometric steps, since a scale is a factor; negative intervals have no logarithm.
                np.geomspace(*first, SCALE_SLICE_COUNT) if first[0] > 0.0 else np.linspace(*first, SCALE_SLICE_COUNT)
            ):
                for generator in solve_one_scale(pairs, second, 1, float(k)).dimensions:
                    # The first scale was chosen on the grid, so the refinement must not move it.
                    harvest.refine_and_verify(generator, scales_given=True)


def _search_family(
    task: FunctionTask, harvest: _FunctionLog, rng: np.random.Generator, progress: Progress, *, fit_limits: bool
) -> None:
    """Verify the best distinct members of a family.

    If no sampled member satisfies the constraints and ``fit_limits`` is set, others are fitted to the constraints.
    """
    members = _sample_members(task, rng)
    limits = GeneratorLimits(task)
    progress(0.3, compose("function-family-members", count=len(members)))
    generators, signs = _select_one_assembly(task, members)
    harvest.reject("circuit_defect", len(members) - len(generators))
    sine = limits.transmission(generators)
    lacking = limits.measure_violations(generators)
    worth = _rank_members(task, generators, signs, sine)
    # A member that does not close between the points has a branch defect.
    closed = np.isfinite(worth)
    harvest.reject("branch_defect", int(np.count_nonzero(~closed)))
    # Discard clear violations only; the estimate is coarse, and verification decides.
    worth = np.where(lacking > COARSE_TOLERANCE, np.inf, worth)
    harvest.reject("constraints", int(np.count_nonzero(closed & ~np.isfinite(worth))))
    order = np.argsort(worth)
    order = order[np.isfinite(worth[order])]
    # Similar members differ little in the logarithms of lengths and in the zeros.
    features = np.column_stack([np.log(np.abs(generators[:, :3]) + 1e-12), generators[:, 3:5]])
    chosen: list[int] = []
    tried = 0
    most = VERIFIED_PER_DESIGN * task.problem.max_designs
    # Go down the ranking, skipping members too similar to one already verified.
    for j in order[:2000]:
        # Two thousand of the ranking are enough to find distinct members.
        if tried == most or len(harvest.passed) >= task.problem.max_designs:
            break
        if chosen and np.abs(features[chosen] - features[j]).max(axis=1).min() < MIN_SEPARATION:
            continue
        chosen.append(int(j))
        tried += 1
        harvest.refine_and_verify(generators[j], scales_given=True)
        progress(0.3 + 0.4 * tried / most, compose("function-verifying"))
    harvest.reject(OUTRANKED_REASON, len(order) - tried)
    if fit_limits and not harvest.passed:
        _fit_to_limits(task, limits, harvest, rng, progress)


def _fit_to_limits(
    task: FunctionTask, limits: GeneratorLimits, harvest: _FunctionLog, rng: np.random.Generator, progress: Progress
) -> None:
    """Fit the family members with the smallest violations to the constraints, within the family."""
    descent = GeneratorDescent(task, limits)
    enough = min(ENOUGH_FITS, task.problem.max_designs)
    for n in range(MAX_FIT_ROUNDS):
        progress(0.7 + 0.3 * n / MAX_FIT_ROUNDS, compose("function-fitting-family"))
        generators, signs = _select_one_assembly(task, _sample_members(task, rng))
        nearest = math.inf
        for j in descent.select_distinct(generators, limits.measure_violations(generators), FITS_PER_ROUND):
            # Stop at the first feasible point: the constraints are all that is fitted.
            moved = descent.minimax(generators[j], float(signs[j]), MAX_FIT_STEPS, enough=CONVERGED_ERROR)
            nearest = min(nearest, moved.error)
            if moved.error > MAX_REFINABLE_ERROR:
                harvest.reject("constraints")
                continue
            harvest.refine_and_verify(moved.generator[:PARAMETER_COUNT], scales_given=True)
            if len(harvest.passed) >= enough:
                return
        # If even the closest fit stays far from feasible, new samples will not help.
        if harvest.passed or nearest > MAX_PROMISING_ERROR:
            return


def _select_one_assembly(task: FunctionTask, generators: Real) -> tuple[Real, Real]:
    """Return the members that meet all points in one assembly, and that assembly's sign."""
    signs = task.points().signs(generators)
    # All signs equal means that their sum is plus or minus their number.
    same = np.abs(signs.sum(axis=1)) > signs.shape[1] - 0.5
    return generators[same], signs[same, 0]


def _sample_members(task: FunctionTask, rng: np.random.Generator) -> Real:
    """Sample random members of a family, shape (k, 7): five dimensions and both scales."""
    most = 3 + sum(zero is None for zero in task.zeros)
    found = []
    choices = _list_scale_choices(task)
    for first, second in choices:
        count = MEMBER_COUNT // len(choices)
        k, scale = (_sample_scales(limits, count, rng) for limits in (first, second))
        pairs = k[:, None] * task.inputs, scale[:, None] * task.outputs
        # Determined but for the scales: each sample of scales has finitely many members.
        if len(task.inputs) == most and task.free[5:].any():
            members = solve_many_exact(task.closure, *pairs, task.zeros)
        else:
            members = sample_family(task.closure, *pairs, task.zeros, rng)
        index = members[:, 5].astype(np.int64)
        found.append(np.column_stack([members[:, :5], k[index], scale[index]]))
    return np.concatenate(found)


def _sample_scales(limits: tuple[float, float], count: int, rng: np.random.Generator) -> Real:
    low, high = limits
    # Uniform in the logarithm, because a scale is a factor.
    return np.asarray(low * (high / low) ** rng.random(count))


def _rank_members(task: FunctionTask, generators: Real, signs: Real, sine: Real) -> Real:
    """Return the ranking values of members, lowest first: structural error or negative quality; infinite if unfit."""
    problem, demanded = task.problem, task.problem.constraints
    lengths = generators[:, :2] if problem.slides else np.column_stack([np.ones(len(generators)), generators[:, :3]])
    ratio = lengths.max(axis=1) / lengths.min(axis=1)
    if problem.function is not None:
        errors = np.abs(task.samples().errors(generators, signs)).max(axis=1)
        # An open range would favour small outputs; relative errors do not.
        if task.free[6]:
            errors = errors / np.abs(generators[:, 6])
        if demanded.min_transmission_angle is None:
            # Without a limit, accuracy should not outrank a usable transmission angle: penalise the error tenfold.
            errors = errors * np.where(sine < USABLE_SINE, 10.0, 1.0)
        worth = errors
    else:
        # Slider-cranks have a size of their own; fourbars are scaled to a unit ground.
        reach = lengths.max(axis=1) if problem.slides else 0.0
        worth = -sine / (1.0 + (ratio / 8.0) ** 2) / (1.0 + (reach / 3.0) ** 2)
    return np.where((sine <= 0.0) | ~np.isfinite(worth), np.inf, worth)


def _is_allowed_scale(scale: float, choices: list[tuple[float, float]]) -> bool:
    """Return whether a scale lies in one of the permitted intervals, to rounding."""
    # The limit itself must pass after rounding.
    return any(low - 1e-9 * abs(low) <= scale <= high + 1e-9 * abs(high) for low, high in choices)


class _FunctionLog(CandidateLog[FunctionDesign]):
    """Record of verified linkages and rejections."""

    def __init__(self, task: FunctionTask) -> None:
        super().__init__(task.problem, REASONS)
        self.task, self.problem = task, task.problem
        self.points = task.points()
        self._seen: list[Real] = []

    def refine_and_verify(self, generator: Real, *, scales_given: bool = False) -> None:
        """Refine an almost exact generator to full precision, and verify it unless it is a duplicate."""
        free = self.task.free.copy()
        if scales_given:
            # Given scales are kept; only the dimensions are refined.
            free[5:] = False
        found = refine_generator(self.points, generator, free)
        if not all(_is_allowed_scale(float(found[5 + side]), self.task.scales[side]) for side in (0, 1)):
            # Refinement left the permitted interval: the solution belongs to another choice, if any.
            return
        if any(np.allclose(found, other, DUPLICATE_TOLERANCE, DUPLICATE_TOLERANCE) for other in self._seen):
            return
        self._seen.append(found)
        self.verify(found, float(self.points.signs(found[None])[0, 0]))

    def verify(self, generator: Real, sign: float) -> None:
        """Drive and verify a linkage, and record the result."""
        try:
            mechanism, dials = build_mechanism(self.task, generator, sign)
            design = verify_function(self.problem, mechanism, dials)
        # Dimensions of infinite or zero length cannot be built.
        except (ZeroDivisionError, OverflowError):
            design = None
        self.record_candidate(design)

    def build_approximation_result(self, judged: int, improved: int) -> FunctionResult:
        """Build the result of an approximation."""
        if self.passed:
            best = select_best(self.passed, partial(get_error, self.problem))
            error = best.structural_error
            unit = "°" if error.unit == "degrees" else f" {self.problem.length_unit}"
            if self.problem.aim == "minimax":
                text = compose(
                    "function-least-maximum",
                    maximum=f"{error.max:.4g}",
                    unit=unit,
                    extremes=error.alternations,
                    improved=improved,
                    count=judged,
                )
            else:
                text = compose(
                    "function-least-rms",
                    rms=f"{error.rms:.4g}",
                    maximum=f"{error.max:.4g}",
                    unit=unit,
                    improved=improved,
                    count=judged,
                )
        else:
            text = join_messages(
                [
                    compose("function-no-start-passes", improved=improved, count=judged),
                    self.describe_reasons().strip(),
                ]
            )
        return self._build_result(self.problem.aim, False, text)

    def build_exact_result(self, proved: bool, method: str) -> FunctionResult:
        """Build the result if all linkages were computed."""
        # A failed placement proves nothing about the linkage itself.
        unknown = _NUMERICAL_REASONS | (_PLACEMENT_REASONS if self.problem.fixed_pivots is None else set())
        complete = proved and not unknown & self.rejected.keys()
        text = [
            compose("function-real-linkages-pass", passed=len(self.passed), count=self.candidates),
            self.describe_reasons().strip(),
        ]
        if not self.passed:
            text.append(compose("function-no-design-exists" if complete else "function-others-may-exist"))
        return self._build_result(method, complete, join_messages(text))

    def build_search_result(self, method: str) -> FunctionResult:
        """Build the result of a search."""
        found = compose("function-designs-among-candidates", found=len(self.passed), count=self.candidates)
        return self._build_result(method, False, join_messages([found, self.describe_reasons().strip()]))

    def _build_result(self, method: str, complete: bool, summary: str) -> FunctionResult:
        return FunctionResult(
            designs=self.select_designs(partial(rank_by_error, self.problem)),
            search=self.build_search(method, complete=complete),
            summary=summary,
        )


_WARM_FOURBAR = {
    "kind": "function",
    "function": {"name": "exponential", "x": [0.0, 1.0]},
    "input_range": 60.0,
    "output_range": 60.0,
}
_WARM_SLIDER = {
    "kind": "function",
    "mechanism": "slider_crank",
    "pairs": [{"input": x, "output": 10.0 * math.sin(x / 40.0)} for x in (0.0, 20.0, 40.0)],
}
_WARM_ROOM = {
    "kind": "function",
    "pairs": [{"input": 20.0 * x, "output": 9.0 * x + x * x} for x in range(5)],
    "zeros": None,
    "space": {"box": [[200.0, 200.0], [500.0, 500.0]]},
}
