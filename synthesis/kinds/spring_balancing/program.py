"""The best parameters of springs at given corners: a convex program, with a lower bound for all parameters.

The drive is linear in the parameters, so that its peak over positions is minimized by a linear program, and its root
mean square by a second-order cone. Peaks are taken on a few positions of the grid, to which those are added at
which the answer exceeds the promised value; as further positions only raise the optimum, its dual value bounds all. If
only rounding remains, the balance is exact: the parameters are then recomputed by linear algebra, and the exact
ones with the smallest rates are chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.spring_balancing.effects import Effects
from synthesis.numerics.conic import ConeRows, Solution, solve_conic_program
from synthesis.numerics.linear_program import solve_linear_program

Norm = Literal["max", "rms"]

INITIAL_POSITIONS, MAX_ADDED_PEAKS = 72, 6
"""Number of positions of the first program, and of peaks above the promised value that are added at once."""

MAX_ROUNDS = 12
"""Maximum number of programs solved."""

GRID_TOLERANCE = 1e-5
"""Excess of the value on the grid over that of the program, as a share, up to which no positions are added."""

SOLVER_TOLERANCE = 1e-7
"""Share of the unbalanced drive and of the dual value by which the bound is reduced: the solver's tolerance."""

MIN_GAP = 3.0 * SOLVER_TOLERANCE
"""Absolute gap between value and bound that is within the solver's tolerance, for values near an exact balance."""

EXACT_SEARCH_VALUE = 1e-4
"""Value below which an exact balance is tried."""

EXACT_TOLERANCE = 1e-10
"""Share of the unbalanced drive that is attributed to rounding."""

RANK_TOLERANCE = 1e-10
"""Singular value, as a share of the largest, below which parameters are dependent."""

MAX_LIMIT = 1e7
"""Limit, in units of the unbalanced drive, above which it cannot bind."""

LIMIT_TOLERANCE = 1e-9
"""Share of a limit by which parameters may exceed it by rounding."""


class BestParameters(NamedTuple):
    """Parameters, their value on the grid, and the bound; infeasible if no parameters keep the limits.

    Values are shares of the drive without springs, in the norm.
    """

    status: Literal["solved", "infeasible", "failed"]
    parameters: list[Real]
    value: float
    bound: float


NO_SOLUTION = BestParameters("failed", [], np.inf, 0.0)
"""Result without parameters."""


class _ScaledProgram(NamedTuple):
    """The whole program in units in which each parameter changes the drive by as much as the unbalanced drive."""

    fixed: Real
    drive: Real
    rows: Real
    limits: Real
    stiff: Real
    units: Real
    cones: list[tuple[slice, Effects]]

    def compute_drive(self, x: Real) -> Real:
        """Return the drive with the springs, (N,)."""
        return np.asarray(self.fixed + x @ self.drive)


def compute_norm(values: Real, norm: Norm) -> float:
    """Compute the norm of a drive over positions."""
    return float(np.abs(values).max()) if norm == "max" else float(np.sqrt((values**2).mean()))


def compute_gap_tolerance(value: float, share: float) -> float:
    """Return the permitted gap of a proven optimum: a share of the value, or the solver's tolerance."""
    return max(share * value, MIN_GAP)


def find_best(fixed: Real, effects: Sequence[Effects], norm: Norm, *, bounded: bool = True) -> BestParameters:
    """Find the best parameters of springs, with the bound.

    Parameters
    ----------
    fixed : float, shape (N,)
        The drive without springs.
    effects : sequence of Effects
        Effects of each spring.
    norm : {"max", "rms"}
    bounded : bool
        Whether the exact parameters and the softest of the best are also computed; otherwise the value alone.
    """
    # The unbalanced drive is the unit of all values.
    whole = compute_norm(fixed, norm)
    if not whole > 0.0:
        return NO_SOLUTION
    scaled = _scale_program(fixed / whole, effects, whole)
    used = np.unique(np.linspace(0, len(fixed) - 1, INITIAL_POSITIONS).astype(int)).tolist()
    held = list(used)
    bound, value, x = 0.0, np.inf, None
    # Without a need for the bound three rounds locate the optimum well enough.
    for _ in range(MAX_ROUNDS if bounded else 3):
        found = _solve_program(scaled, norm, used, held, None)
        if found.status == "infeasible":
            return BestParameters("infeasible", [], np.inf, np.inf)
        if found.status != "solved":
            break
        # More positions only raise the optimum, so the best of all dual values is valid.
        bound = max(bound, found.dual - SOLVER_TOLERANCE * (1.0 + abs(found.dual)))
        mine = found.x[:-1]
        left = scaled.compute_drive(mine)
        reached, beyond = compute_norm(left, norm), _compute_max_excess(scaled, mine)
        if reached < value and (beyond <= GRID_TOLERANCE or x is None):
            value, x = reached, mine
        grown = _add_peaks(np.abs(left), float(found.x[-1]), used) if norm == "max" else False
        grown = _add_held_positions(scaled, mine, held) or grown
        if not grown or (reached - bound <= GRID_TOLERANCE * reached and beyond <= GRID_TOLERANCE):
            break
    if x is None:
        return NO_SOLUTION
    if bounded:
        x = _finish_parameters(scaled, norm, used, held, x, value)
        value = compute_norm(scaled.compute_drive(x), norm)
    return BestParameters("solved", _split_parameters(scaled.units * x, effects), value, bound)


def _scale_program(fixed: Real, effects: Sequence[Effects], whole: float) -> _ScaledProgram:
    drive = np.concatenate([part.drive for part in effects]) / whole
    peaks = np.abs(drive).max(axis=1)
    units = 1.0 / np.where(peaks > 1e-12 * peaks.max(initial=0.0), peaks, max(float(peaks.max(initial=0.0)), 1e-300))
    count, at = len(drive), 0
    rows, limits, cones, slices = [], [], [], []
    for part in effects:
        own = slice(at, at + len(part.drive))
        slices.append(own)
        spread = np.zeros((len(part.rows), count))
        spread[:, own] = part.rows * units[own]
        sizes = np.abs(spread).max(axis=1, initial=0.0)
        sizes = np.where(sizes > 0.0, sizes, 1.0)
        rows.append(spread / sizes[:, None])
        limits.append(part.limits / sizes)
        if part.spans is not None:
            cones.append((own, part))
        at = own.stop
    matrix, ends = np.concatenate(rows), np.concatenate(limits)
    near = ends < MAX_LIMIT  # limits that cannot be active would only spoil the scaling
    stiff = np.concatenate([_convert_to_rates(part, units[own]) for part, own in zip(effects, slices, strict=True)])
    return _ScaledProgram(fixed, drive * units[:, None], matrix[near], ends[near], stiff, units, cones)


def _convert_to_rates(part: Effects, units: Real) -> Real:
    """Return the cost of parameters as rates: for each spring the parameter of most effect per unit costs 1."""
    rated = part.stiff > 0.0
    least_unit = float(units[rated].min(initial=np.inf))
    return np.asarray(np.where(rated, part.stiff * units / least_unit, 0.0))


def _solve_program(
    scaled: _ScaledProgram, norm: Norm, used: list[int], held: list[int], most: float | None
) -> Solution:
    """Solve the program on positions; with ``most``, minimize the rates that leave at most that value."""
    count = len(scaled.units)
    rows = [*_build_linear_rows(scaled), *_build_length_rows(scaled, held)]
    if norm == "max":
        by = np.take(scaled.drive, used, axis=1).T
        at, column = np.take(scaled.fixed, used), -np.ones((len(used), 1))
        matrix = np.concatenate([np.concatenate([by, column], 1), np.concatenate([-by, column], 1)])
        rows.append(ConeRows("nonnegative", matrix, np.concatenate([-at, at])))
    else:
        stacked = np.concatenate([scaled.drive, scaled.fixed[None]]).T / np.sqrt(len(scaled.fixed))
        triangle = np.asarray(np.linalg.qr(stacked, mode="r"))
        matrix = np.zeros((1 + len(triangle), count + 1))
        matrix[0, count] = -1.0
        matrix[1:, :count] = -triangle[:, :-1]
        rows.append(ConeRows("second_order", matrix, np.concatenate([[0.0], triangle[:, -1]]), 1 + len(triangle)))
    cost = np.zeros(count + 1)
    if most is None:
        cost[count] = 1.0
    else:
        cost[:count] = scaled.stiff
        last = np.zeros((1, count + 1))
        last[0, count] = 1.0
        rows.append(ConeRows("nonnegative", last, np.array([most])))
    return solve_conic_program(cost, rows)


def _build_linear_rows(scaled: _ScaledProgram) -> list[ConeRows]:
    """Build the limits of the parameters; two opposite ones form an equation."""
    matrix = np.concatenate([scaled.rows, np.zeros((len(scaled.rows), 1))], axis=1)
    paired, second = np.zeros(len(matrix), bool), np.zeros(len(matrix), bool)
    for n in range(len(matrix) - 1):
        if np.array_equal(matrix[n], -matrix[n + 1]) and scaled.limits[n] == -scaled.limits[n + 1]:
            paired[n], second[n + 1] = True, True
    single = ~(paired | second)
    rows = []
    if single.any():
        rows.append(ConeRows("nonnegative", matrix[single], scaled.limits[single]))
    if paired.any():
        rows.append(ConeRows("zero", matrix[paired], scaled.limits[paired]))
    return rows


def _build_length_rows(scaled: _ScaledProgram, held: list[int]) -> list[ConeRows]:
    """Build length and force limits of springs with an open end: |Σ μ s| ≤ L Σ μ and |Σ μ s| ≤ F at positions."""
    rows, count = [], len(scaled.units)
    for own, part in scaled.cones:
        assert part.spans is not None
        spans = part.spans[:, held] * scaled.units[own, None]
        for limit, by_rate in ((part.longest, True), (part.strongest, False)):
            if not np.isfinite(limit):
                continue
            matrix, offset = np.zeros((3 * len(held), count + 1)), np.zeros(3 * len(held))
            matrix[1::3, own], matrix[2::3, own] = -spans.real.T / limit, -spans.imag.T / limit
            if by_rate:
                matrix[0::3, own] = -scaled.units[own]
            else:
                offset[0::3] = 1.0
            # All rows of a cone are scaled by its largest entry.
            unit = max(float(np.abs(matrix).max()), float(offset.max()), 1e-300)
            rows.append(ConeRows("second_order", matrix / unit, offset / unit, 3))
    return rows


def _compute_excess(scaled: _ScaledProgram, x: Real) -> list[Real]:
    """Compute the relative excess of lengths and forces of springs with an open end over their limits, by position."""
    found = []
    for own, part in scaled.cones:
        assert part.spans is not None
        mine = scaled.units[own] * x[own]
        forces = np.abs(mine @ part.spans)
        rate = float(mine.sum())
        if np.isfinite(part.strongest):
            found.append(forces / part.strongest - 1.0)
        if np.isfinite(part.longest) and rate > 0.0:
            found.append(forces / (rate * part.longest) - 1.0)
    return found


def _compute_max_excess(scaled: _ScaledProgram, x: Real) -> float:
    return max((float(part.max()) for part in _compute_excess(scaled, x)), default=0.0)


def _add_held_positions(scaled: _ScaledProgram, x: Real, held: list[int]) -> bool:
    """Add the positions at which lengths and forces exceed their limits most; return whether any were added."""
    grown = False
    for part in _compute_excess(scaled, x):
        at = int(np.argmax(part))
        if part[at] > GRID_TOLERANCE and at not in held:
            held.append(at)
            grown = True
    return grown


def _add_peaks(left: Real, promised: float, used: list[int]) -> bool:
    """Add the positions of the highest peaks above the promised value; return whether any were added."""
    grown = False
    high = left > promised * (1.0 + 0.1 * GRID_TOLERANCE) + 1e-12
    peaks = np.flatnonzero((left >= np.roll(left, 1)) & (left >= np.roll(left, -1)) & high)
    for at in peaks[np.argsort(-left[peaks])][:MAX_ADDED_PEAKS].tolist():
        if at not in used:
            used.append(at)
            grown = True
    return grown


def _finish_parameters(
    scaled: _ScaledProgram, norm: Norm, used: list[int], held: list[int], x: Real, value: float
) -> Real:
    """Replace the parameters by exact ones if possible, otherwise by equally good ones of minimum rates."""
    if value <= EXACT_SEARCH_VALUE:
        exact = _find_exact(scaled, x)
        if exact is not None:
            return exact
    found = _solve_program(scaled, norm, used, held, value * (1.0 + GRID_TOLERANCE))
    if found.status == "solved":
        softer = found.x[:-1]
        kept = _compute_max_excess(scaled, softer) <= max(GRID_TOLERANCE, _compute_max_excess(scaled, x))
        if kept and compute_norm(scaled.compute_drive(softer), norm) <= value * (1.0 + 10.0 * GRID_TOLERANCE):
            return softer
    return x


def _find_exact(scaled: _ScaledProgram, x: Real) -> Real | None:
    """Find parameters near ``x`` that leave only rounding; None if there are none within the limits."""
    _, values, by = np.linalg.svd(np.linalg.qr(scaled.drive.T, mode="r"), full_matrices=True)
    rank = int((values > RANK_TOLERANCE * values[0]).sum())
    nearer = x
    for _ in range(2):
        # The second pass removes the rounding of the first.
        nearer = nearer - np.linalg.lstsq(scaled.drive.T, scaled.compute_drive(nearer), rcond=RANK_TOLERANCE)[0]
    if np.abs(scaled.compute_drive(nearer)).max() > EXACT_TOLERANCE:
        return None
    # Directions that do not change the drive: move along them to the smallest rates.
    same = by[rank:]
    if scaled.cones or not len(same):
        return nearer if _is_within_limits(scaled, nearer) else None
    room = scaled.limits - scaled.rows @ nearer
    free = np.full(len(same), np.inf)
    found = solve_linear_program(same @ scaled.stiff, scaled.rows @ same.T, room, -free, free)
    if found is not None:
        softest = nearer + found.at @ same
        if _is_within_limits(scaled, softest) and np.abs(scaled.compute_drive(softest)).max() <= EXACT_TOLERANCE:
            return np.asarray(softest)
    return nearer if _is_within_limits(scaled, nearer) else None


def _is_within_limits(scaled: _ScaledProgram, x: Real) -> bool:
    inside = scaled.rows @ x - scaled.limits <= LIMIT_TOLERANCE * (1.0 + np.abs(scaled.limits))
    return bool(inside.all()) and _compute_max_excess(scaled, x) <= GRID_TOLERANCE


def _split_parameters(x: Real, effects: Sequence[Effects]) -> list[Real]:
    ends = np.cumsum([len(part.drive) for part in effects])[:-1]
    return [np.asarray(part) for part in np.split(x, ends)]
