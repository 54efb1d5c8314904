"""The motion program of a problem: given segments, automatic laws, optimal runs, and the program's optimality.

Segments with a given law, dwells and polynomials are used unchanged. Automatic segments get the laws whose velocity and
acceleration fit their neighbours, and among those the best by the criterion: a shortest path over the states at the
joints. The remaining open segments form runs of neighbouring optimal segments. Each run is one convex program;
if the criterion belongs to the whole cam (size, contact force), one program covers all runs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from kinematics.cam.motion.extremes import find_extremes
from kinematics.cam.motion.laws import LAWS
from kinematics.cam.motion.pieces import Motion, Pieces
from kinematics.cam.motion.program import TURN, Program
from kinematics.cam.motion.segments import Condition as PolynomialCondition
from kinematics.cam.motion.segments import (
    Segment,
    build_dwell,
    build_knot_segment,
    build_law_segment,
    build_polynomial_segment,
)
from synthesis.kinds.cam.follower_loads import (
    build_follower_load,
    find_max_rpm,
    find_weakest_contact,
    get_arm_length,
    with_spring,
)
from synthesis.kinds.cam.problem import CamProblem
from synthesis.kinds.cam.program.convex_programs import Condition, Demand, Limit
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
from synthesis.kinds.cam.statement.followers import (
    BarrelRoller,
    LengthRange,
    OscillatingFlat,
    TranslatingFlat,
    TranslatingRoller,
)
from synthesis.kinds.cam.statement.limits import CamLimits
from synthesis.kinds.cam.statement.segment_ends import END_RATES, State, compute_law_ends
from synthesis.kinds.cam.statement.segments import Dwell, Move, Polynomial
from synthesis.model.kind import Progress

DERIVATIVE_ORDERS = {"velocity": 1, "acceleration": 2, "jerk": 3}
"""Orders of the derivatives that criteria and limits name."""

JOINT_TOLERANCE = 1e-9
"""Jump at a joint, as a share of the segments' own rates, up to which an automatic law fits."""

MIN_CURVATURE_RATIO = 1.02
"""Minimum radius of curvature of the pitch curve over the roller's, for any request: at 1 the cam has a cusp."""

MIN_FACE_RADIUS_SHARE = 0.02
"""Radius of curvature, as a share of the travel, below which the cam under a flat face is an edge."""

LOOSE_LIMIT_FACTOR = 1e6
"""Limits on a derivative that exceed a unit lift over a unit angle by this factor do not bind on any grid here and
would only spoil the program's scaling; verification checks them all the same."""

SAMPLE_COUNT = 721
"""Points of a segment at which laws are compared by a criterion without a closed form; the choice needs no more."""


def ignore_progress(fraction: float, message: str) -> None:
    """Ignore progress reports: the default callback."""


@dataclass(frozen=True)
class _GridProgress:
    """Reports the convex programs of several runs as a fraction of the whole work."""

    progress: Progress
    reach: tuple[float, float]
    runs: int

    def make_callback(self, run: int) -> OnGrid:
        """Return the callback for the programs of one run."""
        start, end = self.reach

        def report_grid(steps: int) -> None:
            # Every run is solved on a coarse and then on a fine grid, of about equal effort.
            share = (run + (0.5 if steps > GRID_STEP_COUNTS[0] else 0.0)) / self.runs
            which = f" {run + 1} of {self.runs}" if self.runs > 1 else ""
            self.progress(start + (end - start) * share, f"optimal motion{which}: convex program of {steps} steps")

        return report_grid


@dataclass(frozen=True)
class Composition:
    """A finished program, and the criterion's value and bound.

    ``names`` are the segments' laws. ``bound`` is None if no segment was optimized over all motions; ``scope`` names
    the motions for which the bound holds.
    """

    program: Program
    names: tuple[str, ...]
    value: float
    bound: float | None
    scope: str


@dataclass(frozen=True)
class NoProgram:
    """The reason why no program keeps the limits; ``proven`` if that is certain."""

    reason: str
    proven: bool


def compose(
    problem: CamProblem,
    grids: Sequence[int] = GRID_STEP_COUNTS,
    progress: Progress = ignore_progress,
    reach: tuple[float, float] = (0, 1),
) -> Composition | NoProgram:
    """Compose the best program of a problem without contradictions.

    ``grids`` is as for the convex program of least size; ``progress`` is called before each program, with fractions
    within ``reach``.
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
        # No ends: the motion is optimal or automatic, and is filled in below.
        elif pair is None:
            segments.append(None)
        else:
            segments.append(build_law_segment(LAWS[law], angle, start, end))
        names.append(law)
    # Automatic segments come first: the optimal runs need the states at both of their ends.
    refused = _choose_laws(problem, heights, ends, segments, names)
    if refused is not None:
        return refused
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


def evaluate_criterion(problem: CamProblem, program: Program) -> float:
    """Return the criterion's exact value over the whole program; NaN for the size, which the sizing determines."""
    name = problem.minimize
    kind, _, of = name.partition("_")
    if name == "size":
        return math.nan
    if name == "peak_contact_force":
        top_rpm = find_max_rpm(problem)
        problem, _ = with_spring(problem, program)
        load, speed = build_follower_load(problem)
        force = find_extremes(lambda at: load.force(program.pieces.motion(at), speed), program.breaks)
        least = force.least
        if top_rpm is not None:
            least = min(least, find_weakest_contact(program, load, top_rpm).force)
        # A free preload raises the force everywhere by the same amount, until the minimum reaches the
        # required force.
        return force.greatest + _compute_extra_preload(problem, least)
    if kind == "peak":
        if of == "torque":
            return find_extremes(lambda at: _multiply_rates(program.pieces.motion(at)), program.breaks).largest
        return program.peaks[DERIVATIVE_ORDERS[of]].largest
    if of == "torque":
        return compute_root_mean_square(program, lambda motion: motion.v * motion.a)
    return compute_root_mean_square(program, lambda motion: motion[DERIVATIVE_ORDERS[of]])


def compute_root_mean_square(program: Program, function: Callable[[Motion], np.ndarray]) -> float:
    """Return the root mean square of a function of the motion over the whole turn."""
    return math.sqrt(_integrate_square(program.pieces, function) / TURN)


def _integrate_square(pieces: Pieces, function: Callable[[Motion], np.ndarray]) -> float:
    """Return ∫ f² by Gauss's rule on every piece: exact for polynomials, accurate to rounding for laws with sines."""
    nodes, weights = np.polynomial.legendre.leggauss(24)
    half = 0.5 * np.diff(pieces.start)
    values = function(pieces.motion(pieces.start[:-1, None] + half[:, None] * (nodes + 1.0)))
    return max(float(half @ (values**2 @ weights)), 0.0)


def _scale_least_force(problem: CamProblem) -> float:
    assert problem.dynamics is not None
    return problem.dynamics.least_force * get_arm_length(problem)


def _scale_preload(problem: CamProblem) -> float | None:
    assert problem.dynamics is not None
    return None if problem.dynamics.preload is None else problem.dynamics.preload * get_arm_length(problem)


def _compute_extra_preload(problem: CamProblem, least: float) -> float:
    """Return the amount by which a free preload raises a force of minimum ``least``; it is never negative."""
    return max(_scale_least_force(problem) - least, 0.0) if _scale_preload(problem) is None else 0.0


def _multiply_rates(motion: Motion) -> np.ndarray:
    return np.asarray(motion.v * motion.a)


def _choose_laws(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: list[tuple[State, State] | None],
    segments: list[Segment | None],
    names: list[str],
) -> NoProgram | None:
    """Fill in the automatic segments: the best path over laws that fit at the joints, for each row of neighbours."""
    count = len(segments)
    auto = [isinstance(s, Move) and s.law == "auto" for s in problem.segments]
    if not any(auto):
        return None
    # Start behind a segment that is not automatic, so that no row of neighbours is split at the turn's end.
    first = next((k for k in range(count) if not auto[k]), 0)
    row: list[int] = []
    # The sentinel −1 closes the last row.
    for k in [*((first + n) % count for n in range(count)), -1]:
        if k >= 0 and auto[k]:
            row.append(k)
        elif row:
            refused = _choose_row(problem, heights, ends, segments, names, row)
            if refused is not None:
                return refused
            row = []
    return None


def _choose_row(
    problem: CamProblem,
    heights: Sequence[tuple[float, float]],
    ends: list[tuple[State, State] | None],
    segments: list[Segment | None],
    names: list[str],
    row: list[int],
) -> NoProgram | None:
    """Choose the laws of one row of automatic segments: a shortest path over the states at its joints."""
    count = len(segments)
    before, after = ends[row[0] - 1], ends[(row[-1] + 1) % count]
    # If all segments are automatic the row is a closed ring; it starts and ends at rest, which always fits.
    closed = len(row) == count
    enter = (0.0, 0.0) if before is None or closed else before[1][1:]
    leave = (0.0, 0.0) if after is None or closed else after[0][1:]
    # Paths to a joint's state: for every state only the cheapest one is kept (dynamic programming).
    paths: dict[tuple[float, float], tuple[float, tuple[tuple[str, Segment], ...]]] = {enter: (0.0, ())}
    for n, k in enumerate(row):
        angle, (start, end) = math.radians(problem.segments[k].angle), heights[k]
        unit = abs(end - start) / angle
        following: dict[tuple[float, float], tuple[float, tuple[tuple[str, Segment], ...]]] = {}
        for state, (cost, chosen) in paths.items():
            wanted = leave if n == len(row) - 1 else None
            for name, segment, at_start, at_end in _list_candidates(angle, start, end, state, wanted):
                # Both states are compared in units of the segment's mean velocity, so that the
                # tolerance has no dimension.
                near = (
                    abs(at_start[0] - state[0]) <= JOINT_TOLERANCE * unit
                    and abs(at_start[1] - state[1]) <= JOINT_TOLERANCE * unit / angle
                )
                if not near or not _is_within_limits(problem, segment):
                    continue
                if wanted is not None and not (
                    abs(at_end[0] - wanted[0]) <= JOINT_TOLERANCE * unit
                    and abs(at_end[1] - wanted[1]) <= JOINT_TOLERANCE * unit / angle
                ):
                    continue
                total = _add_segment_cost(problem, cost, segment)
                # States are equal if they agree to seven digits: laws give a few discrete ones, the
                # polynomial any other.
                key = (round(at_end[0] / unit, 7), round(at_end[1] * angle / unit, 7))
                if key not in following or total < following[key][0]:
                    following[key] = total, (*chosen, (name, segment))
        paths = {(key[0] * unit, key[1] * unit / angle): value for key, value in following.items()}
        if not paths:
            return NoProgram(
                f"no law fits segment {k} within the limits on velocity, acceleration and jerk", proven=False
            )
    _, chosen = min(paths.values(), key=lambda path: path[0])
    for k, (name, segment) in zip(row, chosen, strict=True):
        segments[k], names[k] = segment, name
        ends[k] = _compute_segment_ends(segment)
    return None


def _list_candidates(
    angle: float, start: float, end: float, enter: tuple[float, float], leave: tuple[float, float] | None
) -> list[tuple[str, Segment, tuple[float, float], tuple[float, float]]]:
    """List the named laws, and the polynomial through both end states; with v and a at start and end."""
    candidates = []
    for name in END_RATES:
        # These two have velocity or acceleration jumps at their ends, so that they are only used on request.
        if name in ("constant_acceleration", "constant_velocity"):
            continue
        first, last = compute_law_ends(name, angle, start, end)
        candidates.append((name, build_law_segment(LAWS[name], angle, start, end), first[1:], last[1:]))
    leave = (0.0, 0.0) if leave is None else leave
    # Between two rests the named laws are better than a plain polynomial.
    if enter != (0.0, 0.0) or leave != (0.0, 0.0):
        states = ((0.0, start, *enter), (angle, end, *leave))
        conditions = [PolynomialCondition(at, i, x) for at, *state in states for i, x in enumerate(state)]
        candidates.append(("polynomial", build_polynomial_segment(angle, conditions), enter, leave))
    return candidates


def _is_within_limits(problem: CamProblem, segment: Segment) -> bool:
    limits = problem.limits
    for name, order in DERIVATIVE_ORDERS.items():
        limit = getattr(limits, name)
        if limit is not None and segment.extremes(order).largest > limit * (1.0 + JOINT_TOLERANCE):
            return False
    return True


def _add_segment_cost(problem: CamProblem, cost: float, segment: Segment) -> float:
    """Return the criterion's value with one more segment: the greater peak, or the sum of squares."""
    name = problem.minimize
    kind, _, of = name.partition("_")
    at = np.linspace(0.0, segment.angle, SAMPLE_COUNT)
    motion = segment.pieces.motion(at)
    if name == "size":
        return max(cost, _estimate_radius(problem, motion))
    if name == "peak_contact_force":
        load, speed = build_follower_load(problem)
        force = load.force(motion, speed)
        return max(cost, float(force.max()) + _compute_extra_preload(problem, float(force.min())))
    if of == "torque":
        values = np.abs(motion.v * motion.a)
        return max(cost, float(values.max())) if kind == "peak" else cost + float(np.mean(values**2)) * segment.angle
    if kind == "peak":
        return max(cost, segment.extremes(DERIVATIVE_ORDERS[of]).largest)
    return cost + float(np.mean(motion[DERIVATIVE_ORDERS[of]] ** 2)) * segment.angle


def _estimate_radius(problem: CamProblem, motion: Motion) -> float:
    """Estimate the radius that a segment alone requires, accurately enough to compare laws."""
    if isinstance(problem.follower, TranslatingFlat):
        return float(np.max(-motion.s - motion.a))
    # R or d ≥ |v|/tan φ, less the displacement for a radial cam.
    tangent = math.tan(math.radians(problem.limits.pressure_angle))
    barrel = isinstance(problem.follower, BarrelRoller)
    return float(np.max(np.abs(motion.v) / tangent - (0.0 if barrel else motion.s)))


def _compute_segment_ends(segment: Segment) -> tuple[State, State]:
    first = segment.pieces.motion(0.0)
    last = segment.pieces.motion(segment.angle, before=True)
    return (
        (float(first.s), float(first.v), float(first.a)),
        (float(last.s), float(last.v), float(last.a)),
    )


def _find_runs(problem: CamProblem, segments: Sequence[Segment | None]) -> list[list[int]]:
    """Find rows of neighbouring open segments; single segments for the torque, which is convex for one move only."""
    count = len(segments)
    open_ = [k for k in range(count) if segments[k] is None]
    if problem.minimize.endswith("torque"):
        return [[k] for k in open_]
    if len(open_) == count:
        return [open_]
    # Start behind a closed segment, so that a run over the turn's end stays in one row.
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
    # The whole turn is open: the derivatives agree at its start and end, but have no given values.
    if len(row) == count:
        # At a reversal the velocity is zero: fixing it keeps the motion from overshooting the position.
        conditions += [Condition(((total, i, 1.0), (0.0, i, -1.0)), 0.0) for i in range(1, continuity + 1)]
        if _is_reversal(heights, row[-1], row[0]):
            conditions.append(Condition.fix_derivative(0.0, 1, 0.0))
    else:
        for at, neighbour, side in ((0.0, row[0] - 1, 1), (total, (row[-1] + 1) % count, 0)):
            pair = ends[neighbour]
            state = (0.0, 0.0, 0.0) if pair is None else pair[side]
            segment = segments[neighbour]
            # A neighbour that is open itself belongs to another run (torque): they meet at rest.
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
        # The preload is a variable of the program, so that it is taken out of the given segments' forces.
        loads = [_find_range(segment, lambda m: load.force(m, speed) - load.preload) for segment in given]
        rest = (min(low for low, _ in loads), max(high for _, high in loads)) if loads else None
        results = [
            minimize_force(
                runs,
                weights,
                _scale_least_force(problem),
                _scale_preload(problem),
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
                return NoProgram("no optimal motion was found within the limits and conditions", proven=False)
            reason = f"no motion keeps the limits; they must be at least {each.factor:.6g} times as large"
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
    # Knots stand on the segment ends except for rounding, so the nearest ones are taken and the last is set
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
    """Solve for motion and size together, for a translating follower."""
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
    # The given segments do not change: of each only the tightest value of either side's condition matters.
    for segment in given:
        for k, sign in ((rising, 1), (falling, -1)):
            rest_rows.append((k, sign, _find_range(segment, _make_pressure_margin(k, sign))[0]))
    lowest = min(min(pair) for pair in problem.program.heights())
    # The lowest height with zero velocity bounds the size even if all given segments are higher.
    rest_rows += [(min(rising, falling), sign, min(rising, falling) * lowest) for sign in (1, -1)]
    offset = None if problem.follower.offset == "free" else float(problem.follower.offset)
    return minimize_roller_size(runs, [(rising, falling)] * len(runs), offset, rest_rows, grids, on_grid=on_grid)


def _make_pressure_margin(tangent: float, sign: int) -> Callable[[Motion], np.ndarray]:
    """Return s tan φ ∓ v, the margin that a pressure angle leaves, as a function of the motion."""
    return lambda motion: np.asarray(tangent * motion.s - sign * motion.v)


def _bound_criterion(
    problem: CamProblem, program: Program, rows: Sequence[Sequence[int]], best: Sequence[Optimum], value: float
) -> tuple[float | None, str]:
    """Return the lower bound of the criterion over the whole program, and the motions for which it holds."""
    if not best:
        automatic = any(isinstance(s, Move) and s.law == "auto" for s in problem.segments)
        return None, "the best of the named laws" if automatic else "the laws are given"
    scope = "all motions in the optimal segments, with the other segments unchanged"
    cap = next((each.cap for each in best if each.cap is not None), None)
    if cap is not None:
        name = {2: "acceleration", 3: "jerk", 4: "fourth derivative"}[cap[0]]
        scope += f", with a peak {name} of at most {cap[1]:.6g}"
    name = problem.minimize
    kind, _, of = name.partition("_")
    if of == "torque" and (problem.limits.acceleration is not None or problem.limits.jerk is not None):
        scope += ", without limits on acceleration and jerk; with them the minimum is higher than the bound"
    if name in ("size", "peak_contact_force"):
        return best[0].bound, scope
    open_ = {k for row in rows for k in row}
    given = [segment for k, segment in enumerate(program.segments) if k not in open_]

    def evaluate_integrand(motion: Motion) -> np.ndarray:
        return _multiply_rates(motion) if of == "torque" else motion[DERIVATIVE_ORDERS[of]]

    if kind == "peak":
        peaks = [max(map(abs, _find_range(segment, evaluate_integrand))) for segment in given]
        # The bound never exceeds the value reached: rounding in the multipliers could otherwise make the gap
        # negative.
        return min(max([each.bound for each in best] + peaks), value), scope
    # Mean squares add up by angle: the bounds of the runs, and the given segments exactly.
    square = sum(
        each.bound**2 * sum(program.segments[k].angle for k in row) for each, row in zip(best, rows, strict=True)
    )
    square += sum(_integrate_square(segment.pieces, evaluate_integrand) for segment in given)
    return min(math.sqrt(square / TURN), value), scope


def get_roller_radius_range(problem: CamProblem) -> tuple[float, float] | None:
    """Return the least and greatest roller radius; None for a flat face."""
    if isinstance(problem.follower, TranslatingFlat | OscillatingFlat):
        return None
    radius = problem.follower.roller_radius
    return (radius.min, radius.max) if isinstance(radius, LengthRange) else (radius, radius)


def compute_min_face_radius(problem: CamProblem) -> float:
    """Return the least radius of curvature of a cam under a flat face: the limit, or the least that is not an edge."""
    # On an arm the travel is an angle; the pivot distance turns it into a length.
    reach = problem.follower.pivot_distance if isinstance(problem.follower, OscillatingFlat) else 1.0
    return max(problem.limits.min_radius, MIN_FACE_RADIUS_SHARE * problem.program.travel * reach)


def compute_min_pitch_radius(limits: CamLimits, roller_radius: float) -> float:
    """Return the least radius of curvature of the pitch curve: the limit, or the least that avoids a cusp."""
    return max(limits.curvature_ratio, MIN_CURVATURE_RATIO) * roller_radius
