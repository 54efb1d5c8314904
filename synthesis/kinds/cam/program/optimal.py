"""Optimal motions by a criterion, with a lower bound for all motions: the entry point to the convex programs.

A run is one open segment of a motion program, or several in a row, between given segments. Conditions fix values at its
ends and at single angles. Limits and demands hold at every angle. The criteria are

- the peak or the root mean square of a derivative of s: a linear, or a quadratic program;
- the peak of a contact force F = Σ w_i s⁽ⁱ⁾ + F₀ that must not fall below a floor: linear, the preload F₀ given or
  free;
- the prime radius √(d² + e²) of a translating roller follower under |v − e| ≤ tan φ (s + d), offset e given or free: a
  second-order cone program; the base radius of a flat-faced one under R + s + a ≥ ρ and a face width: linear;
- the peak or root mean square of the inertia torque v a (:mod:`synthesis.kinds.cam.program.least_torque`).

The programs are solved on 400 steps, and on 2000 if the gap to the bound is then not small. Known limits (unit
lift and angle, dwell to dwell): max |s⁽ⁿ⁾| ≥ (n − 1)! 4ⁿ⁻¹; rms a ≥ √12, rms j ≥ √720; the minimum of max |a| under
|j| ≤ J is (J/4)(1 − √(1 − 32/J)); max |v a| ≥ 9/4.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Literal

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.cam.program.convex_programs import Block, Condition, ConvexProgram, Demand, Limit, Solution, solve
from synthesis.kinds.cam.program.dual_bound import LowerBound, compute_lower_bound
from synthesis.kinds.cam.program.knots import KnotMotion
from synthesis.kinds.cam.program.least_torque import solve_least_torque

GRID_STEP_COUNTS = (400, 2000)
"""Numbers of steps of the first grid, and of the second grid, which is used if the first leaves a gap."""

GAP_TOLERANCE = 1e-3
"""Maximum gap between value and bound on the first grid, as a share of the bound, without a solution on the second."""

TORQUE_STEP_COUNT = 800
"""Number of steps for the torque without other limits: the optimal acceleration is unbounded at the ends, where the
grid is finer."""

LIMIT_MARGIN = 1e-7
"""Relative tightening of limits for the solver, so that its tolerance does not break them."""

MAX_SCALED_RADIUS = 1e4
"""Maximum radius and offset, in units of the cam's own size, that the bound covers: larger cams are of no use."""

TIME_TOLERANCE = 1e-9
"""Time difference, as a share of the run, up to which two times coincide."""


OnGrid = Callable[[int], None]
"""Called with the number of steps before a program is solved."""


def ignore_steps(steps: int) -> None:
    """Ignore the report: the default callback."""


@dataclass(frozen=True)
class Run:
    """An open part of the program: its angle and its constraints, in radians from its start, with rates per radian."""

    angle: float
    conditions: tuple[Condition, ...]
    continuity: int
    limits: tuple[Limit, ...] = ()
    demands: tuple[Demand, ...] = ()

    @property
    def lift(self) -> float:
        """The maximum distance between two given positions: the scale of the program."""
        stated = [c.value for c in self.conditions if len(c.terms) == 1 and c.terms[0][1] == 0]
        return max(stated) - min(stated)


@dataclass(frozen=True)
class Optimum:
    """The best motions found, one for each run, the criterion's exact value and its lower bound.

    ``cap`` is None if the bound holds for all motions. Otherwise it is (order, limit), and the bound holds for motions
    with a derivative of that order within the limit. ``scalars`` are the further results of the criterion, such as the
    preload or the offset.
    """

    motions: tuple[KnotMotion, ...]
    value: float
    bound: float
    cap: tuple[int, float] | None = None
    scalars: Real = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True)
class NoMotion:
    """The result if no motion was found; limits below ``factor`` times the given ones, if known, are proven too low."""

    factor: float | None


def minimize_derivative(
    run: Run, measure: Literal["peak", "rms"], order: int, *, on_grid: OnGrid = ignore_steps
) -> Optimum | NoMotion:
    """Find the motion of minimum peak or root mean square of a derivative."""
    # The control must be at least the minimized derivative itself.
    size = max(_order(run), order)

    def build_program(steps: int) -> ConvexProgram:
        block = _build_block(run, run.lift, size, steps)
        # Drop a limit on the minimized derivative, which the objective reduces anyway.
        others = tuple(limit for limit in block.limits if limit.order != order)
        if measure == "rms":
            return ConvexProgram((block,), "rms", order)
        return ConvexProgram((replace(block, limits=(*others, Limit(order, 0.0, 1.0))),), "scalar", box=np.ones(1))

    def evaluate_solution(solution: Solution) -> float:
        curve = solution.motions[0].derivative(order)
        return curve.peak() if measure == "peak" else curve.rms()

    best = _solve_on_grids(
        (run,), build_program, evaluate_solution, run.lift / run.angle**order, run.lift, on_grid=on_grid
    )
    limit = next((limit.constant for limit in run.limits if limit.order == order), math.inf)
    # If even the minimum exceeds the dropped limit, their ratio proves by how much the limit is too low.
    if isinstance(best, Optimum) and measure == "peak" and best.value > limit:
        return NoMotion(best.bound / limit if best.bound > limit and best.cap is None else None)
    return best


def minimize_torque(run: Run, measure: Literal["peak", "rms"], *, on_grid: OnGrid = ignore_steps) -> Optimum | NoMotion:
    """Find the motion of minimum peak or root mean square of v a, the torque of a mass at constant speed."""
    lift, angle = run.lift, run.angle
    size = max(_order(run), 3)
    limited = any(limit.order >= 2 for limit in run.limits)
    block = _build_block(run, lift, size, GRID_STEP_COUNTS[0])
    if not limited:
        x = np.linspace(0.0, 1.0, TORQUE_STEP_COUNT + 1)
        # A 3-4-5 polynomial places the knots close together at the ends, where the acceleration is unbounded.
        block = replace(block, times=x**3 * (10.0 - 15.0 * x + 6.0 * x**2))
    start, end = (_find_condition_value(run, at, 0) / lift for at in (0.0, angle))
    ends = tuple(_find_condition_value(run, at, 1) * angle / lift for at in (0.0, angle))
    # The cone program assumes a rise: a fall is solved as its mirror image.
    falls = end < start
    if falls:
        block = _mirror_block(block)
        ends = tuple(-v for v in ends)
    on_grid(len(block.times) - 1)
    least = solve_least_torque(block, measure, abs(end - start), (ends[0], ends[1]))
    if least is None:
        return _explain_infeasible((run,), lift)
    motion = least.motion
    if falls:
        motion = KnotMotion(motion.times, -motion.states, -motion.control)
    # The unit of v·a converts the value of the scaled motion to the run's lift and angle.
    unit = lift**2 / angle**3
    return Optimum((_scale_to_run(motion, run, lift),), least.value * unit, least.bound * unit)


def minimize_force(
    runs: Sequence[Run],
    weights: tuple[float, ...],
    floor: float,
    preload: float | None,
    rest: tuple[float, float] | None,
    *,
    on_grid: OnGrid = ignore_steps,
) -> Optimum | NoMotion:
    """Find the motions of minimum peak contact force Σ weights[i] s⁽ⁱ⁾ + preload, which stays at or above a floor.

    Parameters
    ----------
    runs : sequence of Run
        All open parts of the motion program.
    weights : tuple of float
        Spring rate, damping times speed, mass times its square.
    floor : float
        Minimum contact force allowed.
    preload : float or None
        None leaves it free. It is then the smallest non-negative preload that keeps the floor, and is returned in
        ``scalars``.
    rest : tuple of two floats or None
        Minimum and maximum Σ weights[i] s⁽ⁱ⁾ on the given parts, if there are any.
    """
    lift = max(run.lift for run in runs)
    unit = max(abs(w) * lift / min(run.angle for run in runs) ** i for i, w in enumerate(weights))
    known = 0.0 if preload is None else preload
    free = (1.0,) if preload is None else ()
    size = max(*(_order(run) for run in runs), 3)

    def build_program(steps: int) -> ConvexProgram:
        blocks = []
        for run in runs:
            shares = tuple(w * lift / run.angle**i / unit for i, w in enumerate(weights))
            above = Demand(shares, -known / unit, (-1.0, *free))
            # With a fixed preload the floor bounds the force itself, with a free one the force plus the variable
            # preload.
            below = Demand(tuple(-w for w in shares), (known - floor) / unit, (0.0, *(-f for f in free)))
            block = _build_block(run, lift, size, steps)
            blocks.append(replace(block, demands=(*block.demands, above, below)))
        # A spring only pushes: its preload is never negative.
        rows, right = [[0.0, *(-f for f in free)] for _ in free], [0.0 for _ in free]
        if rest is not None:
            rows += [[-1.0, *free], [0.0, *(-f for f in free)]]
            right += [-(rest[1] + known) / unit, (rest[0] + known - floor) / unit]
        box = np.array([1.0, *(1e3 * f for f in free)])
        return ConvexProgram(tuple(blocks), "scalar", rows=np.array(rows), right=np.array(right), box=box)

    def evaluate_solution(solution: Solution) -> float:
        lows, highs = [], []
        for run, motion in zip(runs, solution.motions, strict=True):
            force = motion.combination(tuple(w * lift / run.angle**i / unit for i, w in enumerate(weights)))
            lows.append(force.minimum()[0])
            highs.append(force.maximum()[0])
        if rest is not None:
            lows.append(rest[0] / unit)
            highs.append(rest[1] / unit)
        return max(highs) + (known / unit if preload is not None else max(floor / unit - min(lows), 0.0))

    return _solve_on_grids(runs, build_program, evaluate_solution, unit, lift, unit, on_grid=on_grid)


def minimize_roller_size(
    runs: Sequence[Run],
    tangents: Sequence[tuple[float, float]],
    offset: float | None,
    rest: Sequence[tuple[float, int, float]],
    grids: Sequence[int] = GRID_STEP_COUNTS,
    *,
    on_grid: OnGrid = ignore_steps,
) -> Optimum | NoMotion:
    """Find the motions of minimum prime radius of a translating roller follower under a pressure angle.

    Parameters
    ----------
    runs : sequence of Run
        All open parts of the motion program.
    tangents : sequence of two floats
        For each run, the permitted tan φ while rising and while falling. If the follower rests at its lowest position,
        |e| ≤ tan φ d holds for both limits, so that v − e ≤ tan φ (s + d) is only required with the limit of the rise,
        and e − v ≤ tan φ (s + d) with that of the fall.
    offset : float or None
        The follower's offset e; None leaves it free. ``scalars`` holds d, and e if that is free.
    rest : sequence of (tan φ, sign, minimum of s tan φ − sign v)
        For the given parts of the program: sign (v − e) ≤ tan φ (s + d) there.
    grids : sequence of int
        Numbers of steps of the first grid, and of the following grids, which are used while a gap remains.
    """
    unit = max(run.lift for run in runs)
    known = 0.0 if offset is None else offset / unit
    free = (1.0,) if offset is None else ()
    size = max(*(_order(run) for run in runs), 3)

    def build_program(steps: int) -> ConvexProgram:
        blocks = []
        for run, (rising, falling) in zip(runs, tangents, strict=True):
            speed = 1.0 / run.angle
            up = Demand((-rising, speed), known, (-rising, *(-f for f in free)))
            down = Demand((-falling, -speed), -known, (-falling, *free))
            block = _build_block(run, unit, size, steps)
            blocks.append(replace(block, demands=(*block.demands, up, down)))
        rows = [[-1.0, *(0.0 for _ in free)]]
        right = [0.0]
        for tangent, sign, room in rest:
            rows.append([-tangent, *(-sign * f for f in free)])
            right.append(room / unit + sign * known)
        # With a free offset the prime radius √(d² + e²) is minimized, otherwise d alone: e is constant.
        objective: Literal["scalar", "norm"] = "scalar" if offset is not None else "norm"
        return ConvexProgram(
            tuple(blocks),
            objective,
            rows=np.array(rows),
            right=np.array(right),
            box=np.full(1 + len(free), MAX_SCALED_RADIUS),
        )

    def evaluate_solution(solution: Solution) -> float:
        return float(np.linalg.norm(solution.scalars))

    best = _solve_on_grids(runs, build_program, evaluate_solution, unit, unit, unit, grids, on_grid=on_grid)
    if isinstance(best, Optimum) and offset is not None:
        return replace(best, value=math.hypot(best.value, offset), bound=math.hypot(best.bound, offset))
    return best


def minimize_flat_size(
    runs: Sequence[Run],
    least_radius: float,
    width: float | None,
    rest: tuple[float, float, float] | None,
    *,
    on_grid: OnGrid = ignore_steps,
) -> Optimum | NoMotion:
    """Find the motions of minimum base radius of a translating flat-faced follower.

    Parameters
    ----------
    runs : sequence of Run
        All open parts of the motion program.
    least_radius : float
        Minimum radius of curvature of the cam, R + s + a.
    width : float or None
        Maximum width of the face that the contact sweeps: max v − min v.
    rest : tuple of three floats or None
        Minimum s + a, minimum v and maximum v of the given parts.
    """
    unit = max(run.lift for run in runs)
    size = max(*(_order(run) for run in runs), 3)

    def build_program(steps: int) -> ConvexProgram:
        blocks = []
        for run in runs:
            speed = 1.0 / run.angle
            # R + s + a ≥ ρ; the scalars are R, max v and −min v.
            demands = [Demand((-1.0, 0.0, -(speed**2)), -least_radius / unit, (-1.0,))]
            if width is not None:
                demands += [Demand((0.0, speed), 0.0, (0.0, -1.0)), Demand((0.0, -speed), 0.0, (0.0, 0.0, 1.0))]
            block = _build_block(run, unit, size, steps)
            blocks.append(replace(block, demands=(*block.demands, *demands)))
        count = 1 if width is None else 3
        rows, right = [], []
        if width is not None:
            rows.append([0.0, 1.0, -1.0])
            right.append(width / unit * (1.0 - LIMIT_MARGIN))
        if rest is not None:
            rows.append([-1.0, 0.0, 0.0][:count])
            right.append((rest[0] - least_radius) / unit)
            if width is not None:
                rows += [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
                right += [rest[1] / unit, -rest[2] / unit]
        # v vanishes somewhere in a turn, so that the magnitudes of both extremes are at most the width.
        box = np.array([1.0, *(2 * [width / unit] if width is not None else [])])
        return ConvexProgram(
            tuple(blocks), "scalar", rows=np.array(rows).reshape(-1, count), right=np.array(right), box=box
        )

    def evaluate_solution(solution: Solution) -> float:
        least = [
            motion.combination((1.0, 0.0, run.angle**-2)).minimum()[0]
            for run, motion in zip(runs, solution.motions, strict=True)
        ]
        if rest is not None:
            least.append(rest[0] / unit)
        return least_radius / unit - min(least)

    return _solve_on_grids(runs, build_program, evaluate_solution, unit, unit, unit, on_grid=on_grid)


def _solve_on_grids(
    runs: Sequence[Run],
    program: Callable[[int], ConvexProgram],
    value: Callable[[Solution], float],
    worth: float,
    lift: float,
    scalar_worth: float = 1.0,
    grids: Sequence[int] = GRID_STEP_COUNTS,
    *,
    on_grid: OnGrid,
) -> Optimum | NoMotion:
    """Solve on the first grid, and on the next one if there is no solution or a gap; return values in client units."""
    best: tuple[Solution, float, LowerBound] | None = None
    for steps in grids:
        on_grid(steps)
        statement = program(steps)
        solution = solve(statement)
        if solution is None:
            continue
        reached, bound = value(solution), compute_lower_bound(statement, solution)
        # The bounds of all grids are valid: keep the best one, if it holds for the same motions.
        if best is not None and best[2].value > bound.value and best[2].cap == bound.cap:
            bound = best[2]
        best = solution, reached, bound
        if reached <= bound.value * (1.0 + GAP_TOLERANCE):
            break
    if best is None:
        return _explain_infeasible(runs, lift)
    solution, reached, bound = best
    cap = bound.cap
    if cap is not None:
        cap = cap[0], cap[1] * lift / min(run.angle for run in runs) ** cap[0]
    motions = tuple(_scale_to_run(motion, run, lift) for motion, run in zip(solution.motions, runs, strict=True))
    # The bound can only exceed the value by rounding: clip it.
    return Optimum(motions, reached * worth, min(bound.value, reached) * worth, cap, solution.scalars * scalar_worth)


def _explain_infeasible(runs: Sequence[Run], lift: float) -> NoMotion:
    """Return a lower bound of the smallest common factor on all limits with which every run has a motion."""
    factors = []
    for run in runs:
        if not run.limits:
            continue
        block = _build_block(run, lift, _order(run), GRID_STEP_COUNTS[0])
        # With all limits proportional to z₀, the minimum z₀ is the factor.
        scaled = tuple(Limit(limit.order, 0.0, limit.constant) for limit in block.limits)
        statement = ConvexProgram((replace(block, limits=scaled),), "scalar", box=np.ones(1))
        solution = solve(statement)
        if solution is not None:
            bound = compute_lower_bound(statement, solution)
            if bound.cap is None:
                # The limits were tightened by this margin, so that the proven factor is smaller by it.
                factors.append(bound.value * (1.0 - LIMIT_MARGIN))
    # Every run must be feasible, so that the largest factor counts.
    factor = max(factors, default=0.0)
    return NoMotion(factor if factor > 1.0 else None)


def _order(run: Run) -> int:
    """Return the order of the control: above each continuous or given derivative, and at least that of each limit."""
    stated = max((order for condition in run.conditions for _, order, _ in condition.terms), default=0)
    return max([run.continuity + 1, stated + 1, 2] + [limit.order for limit in run.limits])


def _build_block(run: Run, lift: float, size: int, steps: int) -> Block:
    """Build the block of a run: time and displacement scaled to one."""
    angle = run.angle
    conditions = tuple(
        Condition(
            tuple(
                (at / angle, order, k * lift / angle**order / _condition_unit(c, lift, angle))
                for at, order, k in c.terms
            ),
            c.value / _condition_unit(c, lift, angle),
        )
        for c in run.conditions
    )
    limits = tuple(
        Limit(limit.order, limit.constant * angle**limit.order / lift * (1.0 - LIMIT_MARGIN)) for limit in run.limits
    )
    demands = tuple(
        Demand(
            tuple(weight / angle**order for order, weight in enumerate(demand.weights)),
            demand.right / lift,
            (),
            demand.start / angle,
            demand.end / angle,
        )
        for demand in run.demands
    )
    marks = {0.0, 1.0}
    marks |= {at for condition in conditions for at, _, _ in condition.terms}
    marks |= {at for demand in demands for at in (demand.start, demand.end)}
    return Block(_build_grid(sorted(marks), steps), size, conditions, limits, demands)


def _condition_unit(condition: Condition, lift: float, angle: float) -> float:
    """Return the unit of a condition, which is that of its highest order."""
    return lift / angle ** max(order for _, order, _ in condition.terms)


def _build_grid(marks: Sequence[float], steps: int) -> Real:
    """Place equal steps between marks.

    Each gap gets a multiple of four steps, so that limits that switch at quarters of it fall on knots.
    """
    kept = [marks[0]]
    for mark in marks[1:]:
        if mark - kept[-1] > TIME_TOLERANCE:
            kept.append(mark)
    kept[-1] = marks[-1]
    parts = [
        np.linspace(left, right, 4 * max(2, round(0.25 * steps * (right - left))) + 1)[:-1]
        for left, right in pairwise(kept)
    ]
    return np.concatenate([*parts, kept[-1:]])


def _scale_to_run(motion: KnotMotion, run: Run, lift: float) -> KnotMotion:
    """Scale a motion back to the run's angle and length unit."""
    orders = np.arange(motion.states.shape[1])
    return KnotMotion(
        motion.times * run.angle,
        motion.states * (lift / run.angle**orders),
        motion.control * (lift / run.angle ** len(orders)),
    )


def _mirror_block(block: Block) -> Block:
    """Return the block of −s: a fall as a rise."""
    conditions = tuple(replace(condition, value=-condition.value) for condition in block.conditions)
    demands = tuple(replace(d, weights=tuple(-w for w in d.weights)) for d in block.demands)
    return replace(block, conditions=conditions, demands=demands)


def _find_condition_value(run: Run, at: float, order: int) -> float:
    """Return the value that a run's conditions give at a time; 0 if they give none."""
    for condition in run.conditions:
        (time, stated, _), *others = condition.terms
        if not others and stated == order and abs(time - at) <= TIME_TOLERANCE * run.angle:
            return condition.value
    return 0.0
