"""Passages of a driven fourbar's coupler point at, or nearest to, the required points, found in three ways.

*At the points*, if they are to be met exactly and timing is free: the pin A lies on the crank's circle and at the
coupler point's distance from the required point. The output link usually excludes one of these two positions. They give
the input angles to which the linkage is driven, in both assemblies. A curve may pass a point twice: the passage on the
first target's circuit counts.

*At the crank angles*, if these are prescribed: the first is that of the reference, the others follow it.

*Nearest, in order*, if points are fitted and timing is free: the input is searched at which P comes nearest to each
point, all in the order of the points within one turn of the input. On a grid this is a monotone assignment, for
which dynamic programming finds the minimum sum of squares; the grid is then refined repeatedly around the best run.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from kinematics.linkage.fourbar import find_toggle_angles, has_full_rotation, is_same_circuit, positions
from synthesis.model.linkage.conversion import DrivenFourbar

CIRCUIT_TOLERANCE = 1e-9
"""Distance of positions, as a share of the task's size, up to which they count as equal when a circuit is chosen."""

ROUNDING_MISS = 1e-11
"""Distance from a point, as a share of the task's size, above which inputs are polished: it may result from the arc
cosine by which they are found."""

POLISH_STEP_COUNT, DIFFERENCE_STEP = 4, 1e-7
"""Number of Newton steps that polish inputs, and finite-difference step of the slope, radians."""

GRID_STEP_COUNT = 360
"""Number of inputs of the first pass in a full turn: one degree."""

START_STRIDE = 5
"""Number of grid inputs per trial of a crank's first input; refinement can move an input by more than that."""

REFINEMENT_SAMPLE_COUNT = 17
"""Number of inputs for each target in one refinement, over the two steps around the previous optimum."""

REFINEMENT_RATIO = 0.25
"""Step of a refinement as a share of the previous one: coarse enough that targets that block each other can move
together."""

REFINEMENT_COUNT = 24
"""Number of refinements: 4²⁴ times finer than the grid, 1e-17 of a turn."""

UNREACHABLE_SQUARE = 1e30
"""Squared distance assigned to inputs without a position: large enough never to be chosen if there is another."""


class Passages(NamedTuple):
    """A linkage at its passages: input angles, assembly signs, joints A, B and P, and the distances from the points.

    ``run`` is true if the angles are one run of the input from the first target, not angles modulo full turns.
    """

    angles: Real
    assemblies: Integers
    a: Complex
    b: Complex
    p: Complex
    misses: Real
    run: bool = False


def locate_at_points(fourbar: DrivenFourbar, points: Complex) -> Passages | None:
    """Return the passages of P at the points, on the reference's circuit if possible.

    Returns None if P is near some point at no crank angle.
    """
    linkage = fourbar.linkage
    reference = positions(linkage, fourbar.reference, fourbar.assembly)
    if not reference.valid:
        return None
    reach = points - linkage.input_pivot
    # Triangle O2 A P: crank, coupler arm, and distance of the point from O2.
    a, r, f = float(linkage.input), abs(complex(linkage.coupler_point)), np.abs(reach)
    with np.errstate(divide="ignore", invalid="ignore"):
        lean = np.arccos(np.clip((a * a + f * f - r * r) / (2.0 * a * f), -1.0, 1.0))
    # Two places of A, each in both assemblies.
    angles = np.angle(reach) + np.stack([lean, lean, -lean, -lean])
    assemblies = np.array([1, -1, 1, -1])
    signs = np.broadcast_to(assemblies[:, None], angles.shape)
    if not np.isfinite(angles).all():
        return None
    at = positions(linkage, angles, assemblies)
    misses = np.where(at.valid, np.abs(at.p - points), np.inf)
    here = is_same_circuit(linkage, fourbar.reference, fourbar.assembly, angles, signs)
    # Only the reference configuration itself may meet the first target.
    first = abs(complex(reference.p) - points[0])
    good = misses <= np.maximum(4.0 * misses.min(axis=0), CIRCUIT_TOLERANCE * np.abs(points - points[0]).max())
    # Prefer passages that are near and on the reference's circuit, then near ones, then any.
    best = np.where(good & here, 0.0, np.where(good, 1.0, 2.0)).argmin(axis=0), np.arange(len(points))
    if not np.isfinite(misses[best]).all():
        return None
    inputs, assembly = angles[best], np.array(signs[best])
    # Where the crank points at the target the arc cosine loses half of its digits.
    if misses[best].max() > ROUNDING_MISS * np.abs(points - points[0]).max():
        inputs = _refine_inputs(fourbar, points, inputs, assembly)
        at = positions(linkage, inputs[:, None], assembly)
        best = np.arange(len(points)), np.zeros(len(points), np.int64)
    p = at.p[best]
    passed = Passages(inputs, assembly, at.a[best], at.b[best], p, np.abs(p - points))
    own = (fourbar.reference, fourbar.assembly, reference.a, reference.b, reference.p, first)
    for part, value in zip(passed[:6], own, strict=True):
        part[0] = value
    return passed


def _refine_inputs(fourbar: DrivenFourbar, points: Complex, inputs: Real, signs: Integers) -> Real:
    """Move inputs by Newton's method along P's path, accepting each step only if it brings P nearer to its point.

    An arc cosine leaves half of the digits if the crank points at the target.
    """

    def evaluate_place(angles: Real) -> Complex:
        at = positions(fourbar.linkage, angles[:, None], signs)
        return np.where(at.valid, at.p, np.nan)[:, 0]

    best = evaluate_place(inputs)
    for _ in range(POLISH_STEP_COUNT):
        before, after = (evaluate_place(inputs + way * DIFFERENCE_STEP) for way in (-1.0, 1.0))
        slope = (after - before) / (2.0 * DIFFERENCE_STEP)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (slope.conj() * (points - best)).real / (slope.real**2 + slope.imag**2)
        tried = inputs + np.where(np.isfinite(step), step, 0.0)
        there = evaluate_place(tried)
        # Comparisons with NaN are false, so that a step beyond a toggle is rejected.
        nearer = np.abs(there - points) < np.abs(best - points)
        inputs, best = np.where(nearer, tried, inputs), np.where(nearer, there, best)
    return inputs


def locate_at_angles(fourbar: DrivenFourbar, points: Complex, turns: Real, *, both: bool) -> Passages | None:
    """Return the positions of P after input rotations ``turns``, radians, from the reference; None if impossible.

    With ``both``, a point that only the other assembly meets counts as met in that assembly.
    """
    angles = fourbar.reference + turns
    own = _drive_at_angles(fourbar, points, angles, run=True)
    if not both or (own is not None and own.misses.max() <= CIRCUIT_TOLERANCE * np.abs(points - points[0]).max()):
        return own
    signs = np.array([fourbar.assembly, -fourbar.assembly])
    at = positions(fourbar.linkage, angles, signs)
    misses = np.where(at.valid, np.abs(at.p - points), np.inf)
    # The reference itself meets the first target, not its mirrored assembly.
    misses[1, 0] = np.inf
    best = misses.argmin(axis=0), np.arange(len(points))
    if not np.all(np.isfinite(misses[best])):
        return None
    return Passages(angles, np.asarray(signs[best[0]]), at.a[best], at.b[best], at.p[best], misses[best])


def locate_in_order(fourbar: DrivenFourbar, points: Complex) -> Passages | None:
    """Return the passages nearest to the points in order, with the input turning in one direction on its branch.

    The sum of squared distances within one turn of the input is minimal.
    """
    low, high = _get_branch_range(fourbar)
    # A crank's branch has no ends: runs may begin anywhere on it.
    period = math.tau if has_full_rotation(fourbar.linkage) else None
    return _drive_at_angles(
        fourbar, points, find_ordered_run(_make_place_function(fourbar), points, low, high, period), run=True
    )


def locate_nearest(fourbar: DrivenFourbar, points: Complex) -> Passages | None:
    """Return the passages nearest to the points, in any order, on the reference's branch."""
    low, high = _get_branch_range(fourbar)
    step = (high - low) / GRID_STEP_COUNT
    grid = np.linspace(low, high, GRID_STEP_COUNT + 1)
    at = positions(fourbar.linkage, grid, fourbar.assembly)
    path = np.where(at.valid, at.p, np.inf)
    inputs = np.array([grid[np.abs(path - point).argmin()] for point in points])
    spread = np.linspace(-1.0, 1.0, REFINEMENT_SAMPLE_COUNT)
    for _ in range(REFINEMENT_COUNT):
        tried = np.clip(inputs[:, None] + step * spread, low, high)
        squares = _compute_squares(fourbar, points, tried)
        inputs = tried[np.arange(len(points)), squares.argmin(axis=1)]
        step *= 2.0 / (REFINEMENT_SAMPLE_COUNT - 1)
    return _drive_at_angles(fourbar, points, inputs, run=False)


def _drive_at_angles(fourbar: DrivenFourbar, points: Complex, angles: Real, *, run: bool) -> Passages | None:
    at = positions(fourbar.linkage, angles, fourbar.assembly)
    if not np.all(at.valid):
        return None
    signs = np.full(len(points), fourbar.assembly)
    return Passages(angles, signs, at.a, at.b, at.p, np.abs(at.p - points), run)


def _get_branch_range(fourbar: DrivenFourbar) -> tuple[float, float]:
    """Return the input's range on the reference's branch, half a turn to either side for a crank."""
    at = fourbar.reference
    if has_full_rotation(fourbar.linkage):
        return at - math.pi, at + math.pi
    toggles = find_toggle_angles(fourbar.linkage)
    # The nearest toggle in either direction bounds the branch.
    above = np.remainder(toggles - at, math.tau)
    below = np.remainder(at - toggles, math.tau)
    return at - float(below.min()), at + float(above.min())


def _make_place_function(fourbar: DrivenFourbar) -> Callable[[Real], Complex]:
    """Return the function of P at inputs of any shape on the reference's assembly; NaN where it has no position."""

    def evaluate_place(inputs: Real) -> Complex:
        at = positions(fourbar.linkage, inputs.ravel(), fourbar.assembly)
        return np.where(at.valid, at.p, np.nan).reshape(inputs.shape)

    return evaluate_place


def _compute_squares(fourbar: DrivenFourbar, points: Complex, inputs: Real) -> Real:
    """Return squared distances at inputs of shape (n, m) from points (n,); infinite where there is no position."""
    return _compute_gap_squares(_make_place_function(fourbar)(inputs), points)


def _compute_gap_squares(places: Complex, points: Complex) -> Real:
    gaps = places - points[:, None]
    return np.where(np.isfinite(gaps), gaps.real**2 + gaps.imag**2, np.inf)


def find_ordered_run(
    place: Callable[[Real], Complex], points: Complex, low: float, high: float, period: float | None
) -> Real:
    """Find the run of the input, in either direction, with the minimum sum of squared distances.

    Parameters
    ----------
    place : callable
        P at inputs of any shape; NaN where there is no position.
    points : complex, shape (n,)
        The points to meet, in order.
    low, high : float
        Input range of the branch, radians; ``high - low`` is the period if there is one.
    period : float or None
        Rotation after which P repeats its motion, radians, for an input that turns through.
    """
    # A geared fivebar's cycle comprises several turns of its input.
    count = GRID_STEP_COUNT * max(1, round((high - low) / math.tau))
    grid = np.linspace(low, high, count + 1)
    path = place(grid)
    squares = np.minimum(_compute_gap_squares(path[None], points), UNREACHABLE_SQUARE)
    if period is None:
        directions = [(way, *_solve_open_grid(ways.copy())) for way, ways in ((1.0, squares), (-1.0, squares[:, ::-1]))]
    else:
        # Every run lies within START_STRIDE + 1 steps of one that begins at a trial start of the grid, so refinement
        # lowers the root of a sum of squares by at most ``moved``. A direction that exceeds the other by more than
        # that is dropped.
        moved = math.sqrt(len(points)) * (START_STRIDE + 1) * float(np.abs(np.diff(path)).max())
        columns, least = _solve_closed_grid(squares[:, :-1].copy(), math.inf)
        back = _solve_closed_grid(squares[:, :0:-1].copy(), (math.sqrt(least) + moved) ** 2)
        directions = [(1.0, columns, least), (-1.0, *back)]
    runs = []
    for way, columns, least in directions:
        if math.isfinite(least):
            start = low if way > 0.0 else high
            run = np.asarray(start + way * (high - low) / count * columns, np.float64)
            runs.append(_refine_run(place, points, low, high, period, way, run))
    return min(runs, key=lambda pair: pair[1])[0]


def _refine_run(
    place: Callable[[Real], Complex],
    points: Complex,
    low: float,
    high: float,
    period: float | None,
    way: float,
    run: Real,
) -> tuple[Real, float]:
    """Refine a run on the grid; return it with its sum of squared distances."""
    step = (high - low) / (GRID_STEP_COUNT * max(1, round((high - low) / math.tau)))
    longest = math.inf if period is None else period
    for _ in range(REFINEMENT_COUNT):
        tried: Real = run[:, None] + way * step * np.linspace(-1.0, 1.0, REFINEMENT_SAMPLE_COUNT)
        if period is None:
            tried = np.clip(tried, low, high)
        squares = np.minimum(_compute_gap_squares(place(tried), points), UNREACHABLE_SQUARE)
        # A decreasing run is an increasing one of the negated inputs.
        run = way * _choose_values(squares, way * tried, longest)
        step *= REFINEMENT_RATIO
    return run, float(_compute_gap_squares(place(run[:, None]), points).sum())


@njit(cache=True, nogil=True)
def _minimize_columns(
    squares: Real, first: int, count: int, bound: float, totals: Real, back: NDArray[np.int32], chosen: Integers
) -> float:
    """Find the minimum sum over non-decreasing columns from row to row, among ``count`` columns from ``first``.

    Returns infinity, and leaves ``chosen`` unset, as soon as no sum below ``bound`` is left.
    """
    rows = len(squares)
    for k in range(count):
        totals[0, k] = squares[0, first + k]
    for row in range(1, rows):
        before, now = totals[(row - 1) % 2], totals[row % 2]
        # Two rows of totals suffice, because the choices are kept in ``back``.
        best, at = np.inf, 0
        for k in range(count):
            if before[k] < best:
                best, at = before[k], k
            now[k] = best + squares[row, first + k]
            back[row, k] = at
        if best >= bound:
            return np.inf
    last = totals[(rows - 1) % 2]
    k = int(np.argmin(last[:count]))
    least = float(last[k])
    if least >= bound:
        return np.inf
    for row in range(rows - 1, -1, -1):
        chosen[row] = first + k
        if row:
            k = back[row, k]
    return least


@njit(cache=True, nogil=True)
def _solve_open_grid(squares: Real) -> tuple[Integers, float]:
    """Return non-decreasing columns with the minimum sum, and that sum."""
    rows, columns = squares.shape
    chosen = np.empty(rows, np.int64)
    back = np.empty((rows, columns), np.int32)
    return chosen, _minimize_columns(squares, 0, columns, np.inf, np.empty((2, columns)), back, chosen)


@njit(cache=True, nogil=True)
def _solve_closed_grid(squares: Real, bound: float) -> tuple[Integers, float]:
    """Return the columns with the minimum sum for a closed curve, and that sum.

    Columns continue cyclically over one turn from the start.
    The sum is infinite if none is below ``bound``.
    """
    rows, columns = squares.shape
    twice = np.concatenate((squares, squares), axis=1)
    totals, back = np.empty((2, columns + 1)), np.empty((rows, columns + 1), np.int32)
    chosen, trial = np.empty(rows, np.int64), np.empty(rows, np.int64)
    best = np.inf
    for first in range(0, columns, START_STRIDE):
        least = _minimize_columns(twice, first, columns + 1, min(best, bound), totals, back, trial)
        if least < best:
            best = least
            chosen[:] = trial
    return chosen, best


@njit(cache=True, nogil=True)
def _choose_values(squares: Real, values: Real, longest: float) -> Real:
    """Choose one of the ascending values of each row, not decreasing from row to row, with the minimum sum of squares.

    The last is at most ``longest`` after the first.
    """
    rows, columns = squares.shape
    best_run = np.empty(rows)
    back = np.zeros((rows, columns), np.int64)
    totals = np.empty((2, columns))
    overall = np.inf
    # A limited span depends on the first value, so that each possible first value is tried.
    starts = columns if longest < np.inf else 1
    for start in range(starts):
        for k in range(columns):
            allowed = starts == 1 or k == start
            totals[0, k] = squares[0, k] if allowed else np.inf
        for row in range(1, rows):
            before, now = totals[(row - 1) % 2], totals[row % 2]
            best, at, seen = np.inf, 0, 0
            for k in range(columns):
                while seen < columns and values[row - 1, seen] <= values[row, k]:
                    if before[seen] < best:
                        best, at = before[seen], seen
                    seen += 1
                now[k] = best + squares[row, k]
                back[row, k] = at
        last = totals[(rows - 1) % 2]
        limit = values[0, start] + longest if starts > 1 else np.inf
        k, least = -1, np.inf
        for n in range(columns):
            if values[rows - 1, n] <= limit and last[n] < least:
                k, least = n, last[n]
        if k >= 0 and least < overall:
            overall = least
            for row in range(rows - 1, -1, -1):
                best_run[row] = values[row, k]
                k = back[row, k]
    return best_run
