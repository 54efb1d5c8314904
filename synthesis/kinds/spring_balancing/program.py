"""The best parameters of springs at given corners: a convex program, with a bound that no others go below.

The drive is linear in the parameters, so that its peak over positions is made least by a linear program, and the root
of its mean square by a second-order cone. Peaks are taken on a few positions of the grid, to which those are added at
which the answer exceeds what it was promised; as positions make a program only harder, its dual value bounds all. Where
nothing is left but rounding, the balance is exact: the parameters are then found again by linear algebra, and of all
exact ones those of the least rates.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.spring_balancing.effects import Effects
from synthesis.numerics.conic import Rows, Solution, minimized
from synthesis.numerics.linear_program import least

Real = NDArray[np.float64]

Norm = Literal["max", "rms"]

FIRST, MOST_ADDED = 72, 6
"""Positions that the program begins with, and peaks beyond its promise that are added at once."""

ROUNDS = 12
"""Programs that are solved at most."""

CLOSE = 1e-5
"""Share of the value by which the grid may exceed the program when nothing more is added."""

TOLERANCE = 1e-7
"""Share of the unbalanced drive and of the dual value by which the bound is less than this: the solver's tolerance."""

OPEN = 3.0 * TOLERANCE
"""Difference of value and bound that the solver's tolerance leaves: near an exact balance no share of the value."""

NEARLY = 1e-4
"""Value from which on an exact balance is looked for."""

EXACT = 1e-10
"""Share of the unbalanced drive that is left by rounding."""

INDEPENDENT = 1e-10
"""Singular value, as a share of the largest, below which parameters do the same."""

FAR = 1e7
"""Limit in effects of what is to be balanced beyond which it is none."""

KEPT = 1e-9
"""Share of a limit by which parameters may be beyond it: rounding."""


class Best(NamedTuple):
    """Parameters, the value that they reach on the grid, and the bound; infeasible where no parameters keep the limits.

    Values are shares of the drive without springs, in the norm.
    """

    status: Literal["solved", "infeasible", "failed"]
    parameters: list[Real]
    value: float
    bound: float


NOTHING = Best("failed", [], np.inf, 0.0)


class _Scaled(NamedTuple):
    """The whole program in units in which each parameter changes the drive by as much as is to be balanced."""

    fixed: Real
    drive: Real
    rows: Real
    limits: Real
    stiff: Real
    units: Real
    cones: list[tuple[slice, Effects]]

    def left(self, x: Real) -> Real:
        """The drive with the springs, (N,)."""
        return np.asarray(self.fixed + x @ self.drive)


def size_of(values: Real, norm: Norm) -> float:
    """The norm of a drive over positions."""
    return float(np.abs(values).max()) if norm == "max" else float(np.sqrt((values**2).mean()))


def left_open(value: float, share: float) -> float:
    """How far the bound of a proved optimum may be below the value: a share of it, or what the solver leaves."""
    return max(share * value, OPEN)


def best(fixed: Real, effects: Sequence[Effects], norm: Norm, *, bounded: bool = True) -> Best:
    """The best parameters of springs, with the bound.

    Parameters
    ----------
    fixed : float, shape (N,)
        The drive without springs.
    effects : sequence of Effects
        Of each spring.
    norm : {"max", "rms"}
    bounded : bool
        Whether the exact and the least stiff of the best are wanted too; otherwise the value alone.
    """
    whole = size_of(fixed, norm)
    if not whole > 0.0:
        return NOTHING
    scaled = _scaled(fixed / whole, effects, whole)
    used = np.unique(np.linspace(0, len(fixed) - 1, FIRST).astype(int)).tolist()
    held = list(used)
    bound, value, x = 0.0, np.inf, None
    for _ in range(ROUNDS if bounded else 3):
        found = _solved(scaled, norm, used, held, None)
        if found.status == "infeasible":
            return Best("infeasible", [], np.inf, np.inf)
        if found.status != "solved":
            break
        bound = max(bound, found.dual - TOLERANCE * (1.0 + abs(found.dual)))
        mine = found.x[:-1]
        left = scaled.left(mine)
        reached, beyond = size_of(left, norm), _beyond(scaled, mine)
        if reached < value and (beyond <= CLOSE or x is None):
            value, x = reached, mine
        grown = _add(np.abs(left), float(found.x[-1]), used) if norm == "max" else False
        grown = _hold(scaled, mine, held) or grown
        if not grown or (reached - bound <= CLOSE * reached and beyond <= CLOSE):
            break
    if x is None:
        return NOTHING
    if bounded:
        x = _finished(scaled, norm, used, held, x, value)
        value = size_of(scaled.left(x), norm)
    return Best("solved", _split(scaled.units * x, effects), value, bound)


def _scaled(fixed: Real, effects: Sequence[Effects], whole: float) -> _Scaled:
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
    near = ends < FAR  # one that no parameter comes near to spoils the scales alone
    stiff = np.concatenate([_in_rates(part, units[own]) for part, own in zip(effects, slices, strict=True)])
    return _Scaled(fixed, drive * units[:, None], matrix[near], ends[near], stiff, units, cones)


def _in_rates(part: Effects, units: Real) -> Real:
    """What parameters cost as rates: of each spring the one of the most effect by its unit costs 1."""
    rated = part.stiff > 0.0
    least_unit = float(units[rated].min(initial=np.inf))
    return np.asarray(np.where(rated, part.stiff * units / least_unit, 0.0))


def _solved(scaled: _Scaled, norm: Norm, used: list[int], held: list[int], most: float | None) -> Solution:
    """The program on positions; with ``most`` the least rates that leave no more than that."""
    count = len(scaled.units)
    rows = [*_linear(scaled), *_lengths(scaled, held)]
    if norm == "max":
        by = np.take(scaled.drive, used, axis=1).T
        at, column = np.take(scaled.fixed, used), -np.ones((len(used), 1))
        matrix = np.concatenate([np.concatenate([by, column], 1), np.concatenate([-by, column], 1)])
        rows.append(Rows("nonnegative", matrix, np.concatenate([-at, at])))
    else:
        stacked = np.concatenate([scaled.drive, scaled.fixed[None]]).T / np.sqrt(len(scaled.fixed))
        triangle = np.asarray(np.linalg.qr(stacked, mode="r"))
        matrix = np.zeros((1 + len(triangle), count + 1))
        matrix[0, count] = -1.0
        matrix[1:, :count] = -triangle[:, :-1]
        rows.append(Rows("second_order", matrix, np.concatenate([[0.0], triangle[:, -1]]), 1 + len(triangle)))
    cost = np.zeros(count + 1)
    if most is None:
        cost[count] = 1.0
    else:
        cost[:count] = scaled.stiff
        last = np.zeros((1, count + 1))
        last[0, count] = 1.0
        rows.append(Rows("nonnegative", last, np.array([most])))
    return minimized(cost, rows)


def _linear(scaled: _Scaled) -> list[Rows]:
    """Limits of the parameters; two that meet are an equation."""
    matrix = np.concatenate([scaled.rows, np.zeros((len(scaled.rows), 1))], axis=1)
    paired, second = np.zeros(len(matrix), bool), np.zeros(len(matrix), bool)
    for n in range(len(matrix) - 1):
        if np.array_equal(matrix[n], -matrix[n + 1]) and scaled.limits[n] == -scaled.limits[n + 1]:
            paired[n], second[n + 1] = True, True
    single = ~(paired | second)
    rows = []
    if single.any():
        rows.append(Rows("nonnegative", matrix[single], scaled.limits[single]))
    if paired.any():
        rows.append(Rows("zero", matrix[paired], scaled.limits[paired]))
    return rows


def _lengths(scaled: _Scaled, held: list[int]) -> list[Rows]:
    """Lengths and forces of springs whose end is sought: |Σ μ s| ≤ L Σ μ and |Σ μ s| ≤ F at positions."""
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
            # All rows of a cone in the unit of its largest entry.
            unit = max(float(np.abs(matrix).max()), float(offset.max()), 1e-300)
            rows.append(Rows("second_order", matrix / unit, offset / unit, 3))
    return rows


def _excess(scaled: _Scaled, x: Real) -> list[Real]:
    """By how much of their limits lengths and forces of springs with a sought end are beyond them, by positions."""
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


def _beyond(scaled: _Scaled, x: Real) -> float:
    return max((float(part.max()) for part in _excess(scaled, x)), default=0.0)


def _hold(scaled: _Scaled, x: Real, held: list[int]) -> bool:
    """Add the positions at which lengths and forces are beyond their limits the most."""
    grown = False
    for part in _excess(scaled, x):
        at = int(np.argmax(part))
        if part[at] > CLOSE and at not in held:
            held.append(at)
            grown = True
    return grown


def _add(left: Real, promised: float, used: list[int]) -> bool:
    """Add the positions of the highest peaks beyond what the program has promised."""
    grown = False
    high = left > promised * (1.0 + 0.1 * CLOSE) + 1e-12
    peaks = np.flatnonzero((left >= np.roll(left, 1)) & (left >= np.roll(left, -1)) & high)
    for at in peaks[np.argsort(-left[peaks])][:MOST_ADDED].tolist():
        if at not in used:
            used.append(at)
            grown = True
    return grown


def _finished(scaled: _Scaled, norm: Norm, used: list[int], held: list[int], x: Real, value: float) -> Real:
    """The exact parameters where there are such, and of all that are as good those of the least rates."""
    if value <= NEARLY:
        exact = _exact(scaled, x)
        if exact is not None:
            return exact
    found = _solved(scaled, norm, used, held, value * (1.0 + CLOSE))
    if found.status == "solved":
        softer = found.x[:-1]
        kept = _beyond(scaled, softer) <= max(CLOSE, _beyond(scaled, x))
        if kept and size_of(scaled.left(softer), norm) <= value * (1.0 + 10.0 * CLOSE):
            return softer
    return x


def _exact(scaled: _Scaled, x: Real) -> Real | None:
    """Parameters near some that leave nothing but rounding; None where there are none within the limits."""
    _, values, by = np.linalg.svd(np.linalg.qr(scaled.drive.T, mode="r"), full_matrices=True)
    rank = int((values > INDEPENDENT * values[0]).sum())
    nearer = x
    for _ in range(2):
        nearer = nearer - np.linalg.lstsq(scaled.drive.T, scaled.left(nearer), rcond=INDEPENDENT)[0]
    if np.abs(scaled.left(nearer)).max() > EXACT:
        return None
    same = by[rank:]
    if scaled.cones or not len(same):
        return nearer if _within(scaled, nearer) else None
    room = scaled.limits - scaled.rows @ nearer
    free = np.full(len(same), np.inf)
    found = least(same @ scaled.stiff, scaled.rows @ same.T, room, -free, free)
    if found is not None:
        softest = nearer + found.at @ same
        if _within(scaled, softest) and np.abs(scaled.left(softest)).max() <= EXACT:
            return np.asarray(softest)
    return nearer if _within(scaled, nearer) else None


def _within(scaled: _Scaled, x: Real) -> bool:
    inside = scaled.rows @ x - scaled.limits <= KEPT * (1.0 + np.abs(scaled.limits))
    return bool(inside.all()) and _beyond(scaled, x) <= CLOSE


def _split(x: Real, effects: Sequence[Effects]) -> list[Real]:
    ends = np.cumsum([len(part.drive) for part in effects])[:-1]
    return [np.asarray(part) for part in np.split(x, ends)]
