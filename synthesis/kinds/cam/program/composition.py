"""Composition of the motion program: given segments, automatic laws, optimal runs, and the program's optimality.

Segments with a given law, dwells and polynomials are used unchanged. Automatic segments get laws that fit their
neighbours (:mod:`synthesis.kinds.cam.program.automatic_laws`). The remaining open segments form runs of neighbouring
optimal segments. Each run is a convex program of its own, unless the criterion belongs to the whole cam (size, contact
force): then one program covers all runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import Motion
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import Condition as PolynomialCondition
from kinematics.cam.motion.segments import (
    Segment,
    build_dwell,
    build_knot_segment,
    build_law_segment,
    build_polynomial_segment,
)
from kinematics.message import compose
from synthesis.kinds.cam.follower_loads import build_follower_load
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.program.automatic_laws import choose_laws
from synthesis.kinds.cam.program.convex_programs import Condition, Demand, Limit
from synthesis.kinds.cam.program.criterion import (
    DERIVATIVE_ORDERS,
    evaluate_criterion,
    integrate_square,
    multiply_rates,
    scale_least_force,
    scale_preload,
)
from synthesis.kinds.cam.program.knots import KnotMotion
from synthesis.kinds.cam.program.optimal import (
    GRID_STEP_COUNTS,
    NoMotion,
    OnGrid,
    Optimum,
    Run,
    minimize_derivative,
    minimize_flat_size,
    minimize_force,
    minimize_roller_size,
    minimize_torque,
)
from synthesis.kinds.cam.program.radius_limits import compute_min_face_radius
from synthesis.kinds.cam.statement.followers import TranslatingFlat, TranslatingRoller
from synthesis.kinds.cam.statement.segment_ends import State
from synthesis.kinds.cam.statement.segments import Dwell, Move, Polynomial
from synthesis.model.kind import Progress

LOOSE_LIMIT_FACTOR = 1e6
"""Factor on the derivative of a unit lift over a unit angle beyond which a limit is omitted from the program. Such a
limit is not active on any grid used here and would only spoil the scaling. The verification checks it nevertheless."""


def ignore_progress(fraction: float, message: str) -> None:
    """Ignore progress reports: the default callback."""


@dataclass(frozen=True)
class _GridProgress:
    """Reports the convex programs of several runs as fractions of the whole work."""

    progress: Progress
    reach: tuple[float, float]
    runs: int

    def make_callback(self, run: int) -> OnGrid:
        """Return the callback for the programs of one run."""
        start, end = self.reach

        def report_grid(steps: int) -> None:
            # Every run is solved on a coarse grid and then on a fine grid; both count as equal effort.
            share = (run + (0.5 if steps > GRID_STEP_COUNTS[0] else 0.0)) / self.runs
            self.progress(
                start + (end - start) * share,
                compose("cam-optimizing-motion-of-several", number=run + 1, count=self.runs, steps=steps)
                if self.runs > 1
                else compose("cam-optimizing-motion", steps=steps),
            )

        return report_grid


@dataclass(frozen=True)
class Composition:
    """A finished program, and the criterion's value and lower bound.

    ``names`` are the laws of the segments. ``bound`` is None if no segment was optimized over all motions. ``scope``
    describes the motions for which the bound holds.
    """

    program: Program
    names: tuple[str, ...]
    value: float
    bound: float | None
    scope: str


@dataclass(frozen=True)
class NoProgram:
    """The reason why no program was found that keeps the limits; ``proven`` is true if none exists."""

    reason: str
    proven: bool


def compose_program(
    problem: CamProblem,
    grids: Sequence[int] = GRID_STEP_COUNTS,
    progress: Progress = ignore_progress,
    reach: tuple[float, float] = (0, 1),
) -> Composition | NoProgram:
    """Compose the best program of a problem without contradictions.

    ``grids`` are the numbers of steps of the convex program for minimum size. ``progress`` is called before each
    program, with fractions within ``reach``.
    """
    heights = problem.program.heights()
    ends = problem.program.compute_ends()
    segments: list[Segment | None] = []
    names: list[str] = []
    for stated, law, (start, end), pair in zip(
        problem.segments, problem.program.list_laws(), heights, ends, strict=True
    ):
        angle = math.radians(stated.angle)
        if isinstance(stated, Dwell):
            segments.append(build_dwell(angle, start))
        elif isinstance(stated, Polynomial):
            conditions = [PolynomialCondition(*condition) for condition in problem.program.convert_conditions(stated)]
            segments.append(build_polynomial_segment(angle, conditions))
        # A segment without end states is optimal or automatic, and is filled in below.
        elif pair is None:
            segments.append(None)
        else:
            segments.append(build_law_segment(LAWS[law], angle, start, end))
        names.append(law)
    # Automatic segments come first: the optimal runs need the states at both of their ends.
    refused = choose_laws(problem, heights, ends, segments, names)
    if refused is not None:
        return NoProgram(refused, proven=False)
    runs = _find_runs(problem, segments)
    best: list[Optimum] = []
    if runs:
        optima = _solve_runs(problem, heights, ends, segments, runs, grids, _GridProgress(progress, reach, len(runs)))
        if isinstance(optima, NoProgram):
            return optima
        best = optima
    program = Program([segment for segment in segments if segment is not None])
    value = evaluate_criterion(problem, program)
    return Composition(program, tuple(names), value, *_bound_criterion(problem, program, runs, best, value))


def _find_runs(problem: CamProblem, segments: Sequence[Segment | None]) -> list[list[int]]:
    """Find rows of neighbouring open segments; single segments for the torque, which is only convex for one move."""
    count = len(segments)
    open_ = [k for k in range(count) if segments[k] is None]
    if problem.minimize.endswith("torque"):
        return [[k] for k in open_]
    if len(open_) == count:
        return [open_]
    # Start after a closed segment, so that a run across the end of the turn stays in one row.
    first = next(k for k in range(count) if segments[k] is not None)
    rows: list[list[int]] = []
    joined = False
    for n in range(count):
        k = (first + n) % count
        if segments[k] is None:
            if joined:
                rows[-1].append(k)
            else:
                rows.append([k])
        joined = segments[k] is None
    return rows


def _build_run(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: Sequence[tuple[State, State] | None],
    segments: Sequence[Segment | None],
    row: Sequence[int],
) -> Run:
    """Build the run of a row of open segments: its end conditions, bands and limits."""
    count = len(segments)
    continuity = 3 if problem.continuity == "jerk" else 2
    angles = [math.radians(problem.segments[k].angle) for k in row]
    starts = np.concatenate([[0.0], np.cumsum(angles)])
    total = float(starts[-1])
    unit = problem.displacement_unit
    conditions = [
        Condition.fix_derivative(0.0, 0, heights[row[0]][0]),
        Condition.fix_derivative(total, 0, heights[row[-1]][1]),
    ]
    demands: list[Demand] = []
    # If the whole turn is open, the derivatives agree at its start and end but have no given values.
    if len(row) == count:
        # At a reversal, fix the velocity at zero, so that the motion does not overshoot the position.
        conditions += [Condition(((total, i, 1.0), (0.0, i, -1.0)), 0.0) for i in range(1, continuity + 1)]
        if _is_reversal(heights, row[-1], row[0]):
            conditions.append(Condition.fix_derivative(0.0, 1, 0.0))
    else:
        for at, neighbour, side in ((0.0, row[0] - 1, 1), (total, (row[-1] + 1) % count, 0)):
            pair = ends[neighbour]
            state = (0.0, 0.0, 0.0) if pair is None else pair[side]
            segment = segments[neighbour]
            # An open neighbour belongs to another run (criterion torque): both runs join at rest.
            jerk = 0.0
            if segment is not None:
                jerk = float(segment.pieces.motion(segment.angle if side else 0.0, before=bool(side)).j)
            values = (*state, jerk)
            conditions += [Condition.fix_derivative(at, i, values[i]) for i in range(1, continuity + 1)]
    for n, k in enumerate(row):
        begin, end = float(starts[n]), float(starts[n + 1])
        if n:
            conditions.append(Condition.fix_derivative(begin, 0, heights[k][0]))
            if _is_reversal(heights, row[n - 1], k):
                conditions.append(Condition.fix_derivative(begin, 1, 0.0))
        stated = problem.segments[k]
        assert isinstance(stated, Move)
        conditions += [
            Condition.fix_derivative(begin + at, i, x) for at, i, x in problem.program.convert_conditions(stated)
        ]
        for band in stated.bands:
            span = begin + math.radians(band.start), min(begin + math.radians(band.end), end)
            if band.upper is not None:
                demands.append(Demand((1.0,), band.upper * unit, (), *span))
            if band.lower is not None:
                demands.append(Demand((-1.0,), -band.lower * unit, (), *span))
    run = Run(total, tuple(conditions), continuity, (), tuple(demands))
    limits = tuple(
        Limit(order, limit)
        for name, order in DERIVATIVE_ORDERS.items()
        if (limit := getattr(problem.limits, name)) is not None and limit * total**order < LOOSE_LIMIT_FACTOR * run.lift
    )
    return replace(run, limits=limits)


def _is_reversal(heights: Sequence[tuple[float, float]], before: int, after: int) -> bool:
    """Return whether the follower reverses between two moves."""
    return (heights[before][1] - heights[before][0]) * (heights[after][1] - heights[after][0]) < 0.0


def _solve_runs(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: Sequence[tuple[State, State] | None],
    segments: list[Segment | None],
    rows: Sequence[Sequence[int]],
    grids: Sequence[int],
    grid_progress: _GridProgress,
) -> list[Optimum] | NoProgram:
    """Solve the runs, and put their motions into the open segments."""
    runs = [_build_run(problem, heights, ends, segments, row) for row in rows]
    given = [segment for segment in segments if segment is not None]
    kind, _, of = problem.minimize.partition("_")
    results: list[Optimum | NoMotion]
    if problem.minimize == "size":
        results = [_solve_smallest(problem, runs, given, grids, grid_progress.make_callback(0))]
    elif problem.minimize == "peak_contact_force":
        load, speed = build_follower_load(problem)
        weights = load.spring_rate, load.damping * speed, load.mass * speed**2
        # The preload is a variable of the program: subtract it from the forces of the given segments.
        loads = [_find_range(segment, lambda m: load.force(m, speed) - load.preload) for segment in given]
        rest = (min(low for low, _ in loads), max(high for _, high in loads)) if loads else None
        results = [
            minimize_force(
                runs,
                weights,
                scale_least_force(problem),
                scale_preload(problem),
                rest,
                on_grid=grid_progress.make_callback(0),
            )
        ]
    elif of == "torque":
        measure: Literal["peak", "rms"] = "peak" if kind == "peak" else "rms"
        results = [minimize_torque(run, measure, on_grid=grid_progress.make_callback(k)) for k, run in enumerate(runs)]
    else:
        order = DERIVATIVE_ORDERS[of]
        measure = "peak" if kind == "peak" else "rms"
        results = [
            minimize_derivative(run, measure, order, on_grid=grid_progress.make_callback(k))
            for k, run in enumerate(runs)
        ]
    best = []
    for each in results:
        if isinstance(each, NoMotion):
            if each.factor is None:
                return NoProgram(compose("cam-no-optimal-motion"), proven=False)
            reason = compose("cam-motion-limits-too-tight", factor=f"{each.factor:.6g}")
            return NoProgram(reason, proven=True)
        best.append(each)
    # Runs and motions are in the same order.
    motions = [motion for each in best for motion in each.motions]
    for row, motion in zip(rows, motions, strict=True):
        at = 0.0
        for k in row:
            angle = math.radians(problem.segments[k].angle)
            segments[k] = _cut(motion, at, at + angle, angle)
            at += angle
    return best


def _cut(motion: KnotMotion, start: float, end: float, angle: float) -> Segment:
    """Cut the part of a motion between two of its knots, as a segment."""
    # Knots coincide with the segment ends except for rounding: take the nearest knots, and set the last time
    # exactly.
    first, last = (int(np.abs(motion.times - at).argmin()) for at in (start, end))
    times = motion.times[first : last + 1] - motion.times[first]
    times[-1] = angle
    size = motion.states.shape[1]
    rows = np.column_stack([motion.states[first:last], motion.control[first:last]])
    factorials = np.array([math.factorial(k) for k in range(size + 1)], np.float64)
    return build_knot_segment(times, rows / factorials)


def _find_range(segment: Segment, function: Callable[[Motion], np.ndarray]) -> tuple[float, float]:
    bounds = find_extremes(lambda at: function(segment.pieces.motion(at)), segment.pieces.start)
    return bounds.least, bounds.greatest


def _solve_smallest(
    problem: CamProblem, runs: Sequence[Run], given: Sequence[Segment], grids: Sequence[int], on_grid: OnGrid
) -> Optimum | NoMotion:
    """Solve for the motion and the size of a translating follower's cam in one program."""
    limits = problem.limits
    if isinstance(problem.follower, TranslatingFlat):
        rest = None
        if given:
            low = min(_find_range(segment, lambda m: np.asarray(m.s + m.a))[0] for segment in given)
            speeds = [_find_range(segment, lambda m: m.v) for segment in given]
            rest = low, min(v for v, _ in speeds), max(v for _, v in speeds)
        return minimize_flat_size(runs, compute_min_face_radius(problem), limits.face_width, rest, on_grid=on_grid)
    assert isinstance(problem.follower, TranslatingRoller)
    rising = math.tan(math.radians(limits.pressure_angle))
    falling = math.tan(math.radians(limits.falling_pressure_angle))
    rest_rows = []
    # Given segments do not change: only the tightest value of each side's condition matters.
    for segment in given:
        for k, sign in ((rising, 1), (falling, -1)):
            rest_rows.append((k, sign, _find_range(segment, _make_pressure_margin(k, sign))[0]))
    lowest = min(min(pair) for pair in problem.program.heights())
    # The lowest position, with zero velocity, bounds the size even if all given segments are higher.
    rest_rows += [(min(rising, falling), sign, min(rising, falling) * lowest) for sign in (1, -1)]
    offset = None if problem.follower.offset == "free" else float(problem.follower.offset)
    return minimize_roller_size(runs, [(rising, falling)] * len(runs), offset, rest_rows, grids, on_grid=on_grid)


def _make_pressure_margin(tangent: float, sign: int) -> Callable[[Motion], np.ndarray]:
    """Return the function s tan φ ∓ v of the motion: the margin to the limit on the pressure angle."""
    return lambda motion: np.asarray(tangent * motion.s - sign * motion.v)


def _bound_criterion(
    problem: CamProblem, program: Program, rows: Sequence[Sequence[int]], best: Sequence[Optimum], value: float
) -> tuple[float | None, str]:
    """Return the lower bound of the criterion over the whole program, and the motions for which it holds."""
    if not best:
        automatic = any(isinstance(s, Move) and s.law == "auto" for s in problem.segments)
        return None, compose("cam-scope-named-laws" if automatic else "cam-scope-given-laws")
    scope = compose("cam-scope-all-motions")
    cap = next((each.cap for each in best if each.cap is not None), None)
    if cap is not None:
        name = {2: "acceleration", 3: "jerk", 4: "ping"}[cap[0]]
        scope = compose("cam-scope-below-peak", scope=scope, derivative=name, peak=f"{cap[1]:.6g}")
    name = problem.minimize
    kind, _, of = name.partition("_")
    if of == "torque" and (problem.limits.acceleration is not None or problem.limits.jerk is not None):
        scope = compose("cam-scope-without-limits", scope=scope)
    if name in ("size", "peak_contact_force"):
        return best[0].bound, scope
    open_ = {k for row in rows for k in row}
    given = [segment for k, segment in enumerate(program.segments) if k not in open_]

    def evaluate_integrand(motion: Motion) -> np.ndarray:
        return multiply_rates(motion) if of == "torque" else motion[DERIVATIVE_ORDERS[of]]

    if kind == "peak":
        peaks = [max(map(abs, _find_range(segment, evaluate_integrand))) for segment in given]
        # Clip the bound at the value, because rounding in the multipliers could otherwise make the gap
        # negative.
        return min(max([each.bound for each in best] + peaks), value), scope
    # Mean squares add up weighted by angle: bounds for the runs, exact values for the given segments.
    square = sum(
        each.bound**2 * sum(program.segments[k].angle for k in row) for each, row in zip(best, rows, strict=True)
    )
    square += sum(integrate_square(segment.pieces, evaluate_integrand) for segment in given)
    return min(math.sqrt(square / TURN), value), scope
