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
from numpy.typing import NDArray

from synthesis.kinds.function.approximation import GeneratorDescent, approximations
from synthesis.kinds.function.by_type import REASONS, solve_types
from synthesis.kinds.function.design import FunctionDesign, FunctionResult
from synthesis.kinds.function.limits import GeneratorLimits
from synthesis.kinds.function.order import error_of, ordered
from synthesis.kinds.function.precision import exact, family, many_exact, polished
from synthesis.kinds.function.problem import FunctionProblem
from synthesis.kinds.function.scales import Scaling, one_scale, two_scales
from synthesis.kinds.function.structural_error import STEPS
from synthesis.kinds.function.task import FunctionTask, built, function_task
from synthesis.kinds.function.verification import verify_function
from synthesis.model.counting import agreeing, counted, grouped
from synthesis.model.kind import Progress, part_of
from synthesis.outcome.sifting import OUTRANKED, Sifting

Real = NDArray[np.float64]

DRAWN = 4000
"""Number of sampled members of a family."""

SLICES = 40
"""Number of values of one scale at which the other is solved for, if both are open and only one is needed."""

TRIED = 6
"""Maximum number of verified family members per requested design."""

AWAY = (30.0, 10.0, 2.0)
"""Minimum transmission angles, degrees, tried in turn if the best approximation without a limit is at a toggle or
change point and cannot be driven."""

COARSE = 0.02
"""Maximum constraint violation of a member, in the first estimate, for it to be verified."""

STEERINGS, STEERED, STEERING_STEPS, ENOUGH_STEERED = 4, 24, 40, 3
"""Constrained fits if no sampled member satisfies the limits: maximum number of rounds with new samples, number of fits
per round, steps of each, and number of designs that ends them."""

MET, NEARLY_MET = 1e-12, 1e-7
"""Error including constraint violation: convergence tolerance of a fit, and maximum for a member to be refined and
verified."""

HOPELESS = 0.2
"""Smallest weighted error of a round above which no further round follows; it corresponds to a violation of a
fiftieth."""

APART = 0.1
"""Minimum difference of verified family members, in the logarithm of a length or in an angle (radians)."""

SAME = 1e-7
"""Relative difference of the parameters below which two solutions are duplicates."""

USABLE = math.sin(math.radians(30.0))
"""Sine of the transmission angle below which a family member is returned only if none reaches it."""

HELD_SHARE = 0.5
"""Share of the progress assigned to the first search, with pairs as angles from the ground line, before the zeros are
opened."""

_NUMERICAL = {"residual", "cannot_be_driven"}
"""Rejection reasons that reflect numerical limits and prove nothing."""

_PLACES = {"fixed_pivot_zones", "moving_pivot_zones", "box", "obstacles"}
"""Rejection reasons that mean that no placement in the workspace was found, if the placement is free."""


def solve_function(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve a function-generation problem, each type of linkage by its own search."""
    if problem.mechanisms is not None:
        return solve_types(problem, _of_simple, progress)
    return _of_simple(problem, progress)


def _of_simple(problem: FunctionProblem, progress: Progress) -> FunctionResult:
    """Solve for fourbars or slider-cranks."""
    if not problem.from_ground:
        return _with_zeros(problem, progress)
    # "auto" zeros: first read few pairs as angles from the ground line, and open the zeros only if that fails.
    held = _with_zeros(problem, part_of(progress, 0.0, HELD_SHARE), steered=False)
    if any(design.verification.passed for design in held.designs):
        progress(1.0, "verified")
        return held.model_copy(update={"summary": f"{held.summary}{_HELD}"})
    opened = _with_zeros(problem.model_copy(update={"zeros": None}), part_of(progress, HELD_SHARE, 1.0))
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
            "summary": f"{_OPENED} {opened.summary}",
        }
    )


def _with_zeros(problem: FunctionProblem, progress: Progress, *, steered: bool = True) -> FunctionResult:
    """Solve with the problem's zeros, given or open; ``steered`` as for :func:`_family`."""
    task = function_task(problem)
    progress(0.0, "reading the problem")
    rng = np.random.default_rng(problem.seed)
    harvest = _Harvest(task)
    if problem.aim != "precision":
        judged = improved = 0
        for least in (None, *(AWAY if problem.constraints.min_transmission_angle is None else ())):
            found = approximations(task, rng, progress, least)
            judged, improved = judged + found.judged, improved + found.improved
            for one in found.optima:
                harvest.verify(one.generator, one.sign)
            # The next, stricter angle is needed only if the optimum is undrivable.
            if harvest.passed:
                break
        progress(1.0, "verified")
        return harvest.approximated(judged, improved)
    # Degrees of freedom: three proportions and the open zeros, less one per pair; scales supply the difference.
    missing = 3 + sum(zero is None for zero in task.zeros) - len(task.inputs)
    open_scales = int(task.free[5]) + int(task.free[6])
    if missing == -2 or (missing == -1 and open_scales == 2):
        _with_two_scales(task, harvest, missing, progress)
        return harvest.searched("two_scales")
    if missing == -1:
        proved = _with_one_scale(task, harvest)
        return harvest.determined(proved, "one_scale")
    if missing == 0 and open_scales == 0:
        proved = _determined(task, harvest)
        if harvest.passed or proved:
            return harvest.determined(proved, "exact")
        # Pairs of a linkage with equivalents, for example a parallelogram, do not determine it: search the family.
    _family(task, harvest, rng, progress, steered=steered)
    return harvest.searched("family")


_HELD = " The values were read as angles from the ground line; the zeros may be left open instead."

_OPENED = (
    "No linkage with the values as angles from the ground line satisfies all constraints. With the zeros left open:"
)


def warm_up() -> None:
    """Load and compile everything that the solver and its verification need."""
    for spec in (_WARM_FOURBAR, _WARM_SLIDER, _WARM_ROOM):
        solve_function(FunctionProblem.model_validate(spec), lambda fraction, message: None)


def _choices(task: FunctionTask) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    return [(first, second) for first in task.scales[0] for second in task.scales[1]]


def _determined(task: FunctionTask, harvest: _Harvest) -> bool:
    """Verify all linkages if nothing is open; return whether these are proved to be all."""
    proved = True
    for (k, _), (scale, _) in _choices(task):
        found = exact(task.closure, k * task.inputs, scale * task.outputs, task.zeros)
        proved &= found.proved
        harvest.reject("degenerate", found.degenerate)
        for dimensions in found.dimensions:
            harvest.polish_and_verify(np.concatenate([dimensions, [k, scale]]))
    return proved


def _with_one_scale(task: FunctionTask, harvest: _Harvest) -> bool:
    """Verify all linkages if exactly one scale is open and must be found; return whether these are proved to be all."""
    side = 0 if task.free[5] else 1
    pairs = Scaling(task.closure, task.inputs, task.outputs, task.zeros)
    proved = True
    for choice in _choices(task):
        found = one_scale(pairs, choice[side], side, choice[1 - side][0])
        proved &= found.proved
        harvest.reject("degenerate", found.degenerate)
        for generator in found.dimensions:
            harvest.polish_and_verify(generator)
    return proved


def _with_two_scales(task: FunctionTask, harvest: _Harvest, missing: int, progress: Progress) -> None:
    """Verify linkages if both scales are open: solve for both, or for one at each of many values of the other."""
    pairs = Scaling(task.closure, task.inputs, task.outputs, task.zeros)
    as_stated = np.ones((1 if task.problem.pairs is not None else 0, 2))
    choices = _choices(task)
    for n, (first, second) in enumerate(choices):
        progress(n / len(choices), "solving for scales")
        if missing == -2:
            for generator in two_scales(pairs, first, second, as_stated):
                harvest.polish_and_verify(generator)
        else:
            for k in np.geomspace(*first, SLICES) if first[0] > 0.0 else np.linspace(*first, SLICES):
                for generator in one_scale(pairs, second, 1, float(k)).dimensions:
                    harvest.polish_and_verify(generator, scales_given=True)


def _family(
    task: FunctionTask, harvest: _Harvest, rng: np.random.Generator, progress: Progress, *, steered: bool
) -> None:
    """Verify the best distinct members of a family.

    If no sampled member satisfies the constraints and ``steered`` is set, others are fitted to the constraints.
    """
    members = _members(task, rng)
    limits = GeneratorLimits(task)
    progress(0.3, f"{len(members)} members of the family")
    generators, signs = _in_one_assembly(task, members)
    harvest.reject("circuit_defect", len(members) - len(generators))
    sine = limits.transmission(generators)
    lacking = limits.lacking(generators)
    worth = _worth(task, generators, signs, sine)
    closed = np.isfinite(worth)
    harvest.reject("branch_defect", int(np.count_nonzero(~closed)))
    worth = np.where(lacking > COARSE, np.inf, worth)
    harvest.reject("constraints", int(np.count_nonzero(closed & ~np.isfinite(worth))))
    order = np.argsort(worth)
    order = order[np.isfinite(worth[order])]
    features = np.column_stack([np.log(np.abs(generators[:, :3]) + 1e-12), generators[:, 3:5]])
    chosen: list[int] = []
    tried = 0
    most = TRIED * task.problem.max_designs
    # Go down the ranking, skipping members too similar to one already verified.
    for j in order[:2000]:
        if tried == most or len(harvest.passed) >= task.problem.max_designs:
            break
        if chosen and np.abs(features[chosen] - features[j]).max(axis=1).min() < APART:
            continue
        chosen.append(int(j))
        tried += 1
        harvest.polish_and_verify(generators[j], scales_given=True)
        progress(0.3 + 0.4 * tried / most, "verifying")
    harvest.reject(OUTRANKED, len(order) - tried)
    if steered and not harvest.passed:
        _into_limits(task, limits, harvest, rng, progress)


def _into_limits(
    task: FunctionTask, limits: GeneratorLimits, harvest: _Harvest, rng: np.random.Generator, progress: Progress
) -> None:
    """Fit the family members with the smallest violations to the constraints, within the family."""
    descent = GeneratorDescent(task, limits)
    enough = min(ENOUGH_STEERED, task.problem.max_designs)
    for n in range(STEERINGS):
        progress(0.7 + 0.3 * n / STEERINGS, "moving family members into the limits")
        generators, signs = _in_one_assembly(task, _members(task, rng))
        nearest = math.inf
        for j in descent.apart(generators, limits.lacking(generators), STEERED):
            moved = descent.minimax(generators[j], float(signs[j]), STEERING_STEPS, enough=MET)
            nearest = min(nearest, moved.error)
            if moved.error > NEARLY_MET:
                harvest.reject("constraints")
                continue
            harvest.polish_and_verify(moved.generator[:STEPS], scales_given=True)
            if len(harvest.passed) >= enough:
                return
        # If even the closest fit stays far from feasible, new samples will not help.
        if harvest.passed or nearest > HOPELESS:
            return


def _in_one_assembly(task: FunctionTask, generators: Real) -> tuple[Real, Real]:
    """Return the members that meet all points in one assembly, and that assembly's sign."""
    signs = task.points().signs(generators)
    same = np.abs(signs.sum(axis=1)) > signs.shape[1] - 0.5
    return generators[same], signs[same, 0]


def _members(task: FunctionTask, rng: np.random.Generator) -> Real:
    """Sample random members of a family, shape (k, 7): five dimensions and both scales."""
    most = 3 + sum(zero is None for zero in task.zeros)
    found = []
    choices = _choices(task)
    for first, second in choices:
        count = DRAWN // len(choices)
        k, scale = (_drawn(limits, count, rng) for limits in (first, second))
        pairs = k[:, None] * task.inputs, scale[:, None] * task.outputs
        if len(task.inputs) == most and task.free[5:].any():
            members = many_exact(task.closure, *pairs, task.zeros)
        else:
            members = family(task.closure, *pairs, task.zeros, rng)
        index = members[:, 5].astype(np.int64)
        found.append(np.column_stack([members[:, :5], k[index], scale[index]]))
    return np.concatenate(found)


def _drawn(limits: tuple[float, float], count: int, rng: np.random.Generator) -> Real:
    low, high = limits
    return np.asarray(low * (high / low) ** rng.random(count))


def _worth(task: FunctionTask, generators: Real, signs: Real, sine: Real) -> Real:
    """Return the ranking values of members, lowest first: structural error or negative quality; infinite if unfit."""
    problem, demanded = task.problem, task.problem.constraints
    lengths = generators[:, :2] if problem.slides else np.column_stack([np.ones(len(generators)), generators[:, :3]])
    ratio = lengths.max(axis=1) / lengths.min(axis=1)
    if problem.function is not None:
        errors = np.abs(task.samples().errors(generators, signs)).max(axis=1)
        if task.free[6]:
            errors = errors / np.abs(generators[:, 6])
        if demanded.min_transmission_angle is None:
            # Without a limit, accuracy should not outrank a usable transmission angle: penalise the error tenfold.
            errors = errors * np.where(sine < USABLE, 10.0, 1.0)
        worth = errors
    else:
        reach = lengths.max(axis=1) if problem.slides else 0.0
        worth = -sine / (1.0 + (ratio / 8.0) ** 2) / (1.0 + (reach / 3.0) ** 2)
    return np.where((sine <= 0.0) | ~np.isfinite(worth), np.inf, worth)


def _within(scale: float, choices: list[tuple[float, float]]) -> bool:
    """Return whether a scale lies in one of the permitted intervals, to rounding."""
    return any(low - 1e-9 * abs(low) <= scale <= high + 1e-9 * abs(high) for low, high in choices)


class _Harvest(Sifting[FunctionDesign]):
    """Record of verified linkages and rejections."""

    def __init__(self, task: FunctionTask) -> None:
        super().__init__(task.problem, REASONS)
        self.task, self.problem = task, task.problem
        self.points = task.points()
        self._seen: list[Real] = []

    def polish_and_verify(self, generator: Real, *, scales_given: bool = False) -> None:
        """Refine an almost exact generator to full precision, and verify it unless it is a duplicate."""
        free = self.task.free.copy()
        if scales_given:
            free[5:] = False
        found = polished(self.points, generator, free)
        if not all(_within(float(found[5 + side]), self.task.scales[side]) for side in (0, 1)):
            return
        if any(np.allclose(found, other, SAME, SAME) for other in self._seen):
            return
        self._seen.append(found)
        self.verify(found, float(self.points.signs(found[None])[0, 0]))

    def verify(self, generator: Real, sign: float) -> None:
        """Drive and verify a linkage, and record the result."""
        try:
            mechanism, dials = built(self.task, generator, sign)
            design = verify_function(self.problem, mechanism, dials)
        except (ZeroDivisionError, OverflowError):
            design = None
        self.add(design)

    def approximated(self, judged: int, improved: int) -> FunctionResult:
        """Build the result of an approximation."""
        if self.passed:
            best = min(self.passed, key=partial(error_of, self.problem))
            error = best.structural_error
            unit = "°" if error.unit == "degrees" else f" {self.problem.length_unit}"
            if self.problem.aim == "minimax":
                text = f"Smallest maximum structural error found: {error.max:.4g}{unit}"
                text += f" ({error.alternations} alternating extremes)"
            else:
                text = f"Smallest root-mean-square structural error found: {error.rms:.4g}{unit}"
                text += f" (maximum {error.max:.4g}{unit})"
            text += f". {grouped(improved)} of {counted(judged, 'start')} were optimised; a better linkage may exist."
        else:
            text = f"No design found: {grouped(improved)} of {counted(judged, 'start')} were optimised, but none "
            text += f"satisfies all constraints.{self.reasons()}"
        return self._result(self.problem.aim, False, text)

    def determined(self, proved: bool, method: str) -> FunctionResult:
        """Build the result if all linkages were computed."""
        unknown = _NUMERICAL | (_PLACES if self.problem.fixed_pivots is None else set())
        complete = proved and not unknown & self.rejected.keys()
        passed, of = len(self.passed), counted(self.candidates, "real linkage")
        text = f"{grouped(passed)} of {of} {agreeing(passed, 'satisfies', 'satisfy')} all constraints.{self.reasons()}"
        if not self.passed:
            text += " These are all, so no design exists." if complete else " Others may exist."
        return self._result(method, complete, text)

    def searched(self, method: str) -> FunctionResult:
        """Build the result of a search."""
        among = counted(self.candidates, "candidate")
        text = f"{counted(len(self.passed), 'design')} found among {among}.{self.reasons()}"
        return self._result(method, False, text)

    def _result(self, method: str, complete: bool, summary: str) -> FunctionResult:
        return FunctionResult(
            designs=self.designs(partial(ordered, self.problem)),
            search=self.search(method, complete=complete),
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
