"""All circuits and branches of a mechanism, its toggles, and the limits of its links, by root finding.

Every dyadic closure has two assemblies and a margin, a smooth function of the input that is positive where the closure
exists. For each choice of assemblies the least of the margins is bracketed on a grid, its minima and maxima near zero
are searched between grid points so that no narrow gap is missed, and each end of the motion is found as a root. At such
an end the two assemblies of the closure that folds flat meet: there the branch goes over into the one with that sign
reversed. Branches that are joined so, directly or through others, make a circuit.

Words: see :mod:`kinematics.linkage.circuits`.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.closures import decompose
from kinematics.linkage.drive import assembly_signs, drive
from kinematics.linkage.mechanism import Mechanism, TopologyError

Real = NDArray[np.float64]

GRID = 1440
"""Grid points a turn of the input."""

NEAR_ZERO = 0.05
"""A grid minimum (or maximum) of the margin nearer to zero than this is searched for a gap between grid points."""

TOUCHES = 1e-12
"""A least margin below this is a change point: branches meet there, and no direction of motion is determined."""

SAME_END = 1e-7
"""Ends of branches closer than this, radians, are one toggle: two computations of one root."""

TURNS_AT_MOST = 60
"""Turns of the input until a geared mechanism repeats, at most; a ratio that needs more is taken as not repeating."""


class Branch(NamedTuple):
    """One branch: what the input drives through.

    ``low`` and ``high`` are input angles (radians, ``low`` within the first turn) or positions; ``full`` says that the
    input turns through, the range then being one whole cycle. ``signs`` are the assemblies by closure, ``low_closure``
    and ``high_closure`` the link whose closure folds flat at the ends. ``circuit`` counts from 0.
    """

    circuit: int
    low: float
    high: float
    full: bool
    signs: tuple[int, ...]
    low_closure: str
    high_closure: str


def cycle(mechanism: Mechanism) -> float:
    """Input rotation after which the mechanism repeats, radians: a full turn, or as many as its gears need."""
    turns = 1
    for gear in mechanism.gears:
        ratio = Fraction(gear.ratio).limit_denominator(TURNS_AT_MOST)
        turns = int(np.lcm(turns, ratio.denominator))
    return 2.0 * np.pi * min(turns, TURNS_AT_MOST)


def dyadic_branches(mechanism: Mechanism) -> list[Branch]:
    """All branches of one design that closes by dyads from its input link; the reference's circuit first.

    Raises
    ------
    TopologyError
        For a class III mechanism or one that is driven by a slide.
    """
    decomposition = decompose(mechanism)
    if decomposition.left or mechanism.driven_by_slide:
        raise TopologyError("expected a mechanism that closes by dyads and is driven by a link")
    closing = [step.link for step in decomposition.steps if step.has_two_solutions]
    position = [n for n, step in enumerate(decomposition.steps) if step.has_two_solutions]
    choices = list(itertools.product((1, -1), repeat=len(closing)))
    period = cycle(mechanism)

    def margins(theta: Real, rows: NDArray[np.int64]) -> tuple[Real, Real, NDArray[np.int64]]:
        """Least margin, its rate and the closure that has it, shape (n,), each input with its own row of assemblies."""
        signs = [np.ones(len(theta), np.int64)] * len(decomposition.steps)
        for n, k in enumerate(position):
            signs[k] = rows[:, n]
        motion = drive(mechanism, theta[:, None], signs=tuple(signs), order=1)
        found = np.stack([motion.margins[link][..., 0] for link in closing], axis=1)
        # Where an earlier closure does not exist the later ones are NaN, and the earlier one is the least.
        value = np.where(np.isnan(found[0]), np.inf, found[0])
        which = value.argmin(axis=0)
        here = which, np.arange(len(theta))
        return value[here], found[1][here], which

    if not closing:
        return [Branch(0, 0.0, period, True, (), "", "")]
    grid = np.linspace(0.0, period, int(GRID * period / (2.0 * np.pi)), endpoint=False)
    every = np.repeat(np.array(choices, np.int64), len(grid), axis=0)
    values = margins(np.tile(grid, len(choices)), every)[:2]
    found: list[Branch] = []
    for n, choice in enumerate(choices):
        row = np.array([choice], np.int64)

        def least(theta: Real, row: NDArray[np.int64] = row) -> tuple[Real, Real]:
            return margins(theta, np.repeat(row, len(theta), axis=0))[:2]

        part = slice(n * len(grid), (n + 1) * len(grid))
        for low, high, full in _intervals(least, grid, values[0][part], values[1][part], period):
            names = ("", "")
            if not full:
                ends = margins(np.array([low, high]), np.repeat(row, 2, axis=0))[2]
                names = (closing[ends[0]], closing[ends[1]])
            found.append(Branch(0, low, high, full, choice, *names))
    return _by_circuits(found, closing, period, _holding_reference(mechanism, found, position, period))


Margin = Callable[[Real], tuple[Real, Real]]
"""A function of the input with its rate."""


def _intervals(least: Margin, grid: Real, value: Real, rate: Real, period: float) -> list[tuple[float, float, bool]]:
    """Where a periodic function is positive: intervals with ``low`` in [0, period), and whether one is the whole."""
    theta, value = _with_extremes(least, grid, value, rate, period)
    inside = value > TOUCHES
    if inside.all():
        return [(0.0, period, True)]
    if not inside.any():
        return []
    start = int(np.flatnonzero(~inside)[0])
    theta, value, inside = np.roll(theta, -start), np.roll(value, -start), np.roll(inside, -start)
    theta = np.append(np.where(theta < theta[0], theta + period, theta), theta[0] + period)
    value = np.append(value, value[0])
    edges = np.flatnonzero(np.diff(np.append(inside, False).astype(int)))
    # An edge at a change point is known already: the searched extreme itself.
    outer = np.where(inside[edges], edges + 1, edges)
    touching = np.abs(value[outer]) <= TOUCHES
    roots = theta[outer].copy()
    open_edges = edges[~touching]
    if len(open_edges):
        roots[~touching] = _root(least, theta[open_edges], theta[open_edges + 1], ~inside[open_edges])
    pairs = roots.reshape(-1, 2)
    return [(float(np.mod(low, period)), float(np.mod(low, period) + high - low), False) for low, high in pairs]


def _with_extremes(least: Margin, grid: Real, value: Real, rate: Real, period: float) -> tuple[Real, Real]:
    """Grid and values, with the minima above zero and maxima below it that come near zero searched and added."""
    before, after = np.roll(value, 1), np.roll(value, -1)
    dips = (value > 0.0) & (value <= before) & (value <= after) & (value < NEAR_ZERO)
    bumps = (value <= 0.0) & (value >= before) & (value >= after) & (value > -NEAR_ZERO)
    at = np.flatnonzero(dips | bumps)
    if not len(at):
        return grid, value
    step = period / len(grid)

    def slope(theta: Real) -> tuple[Real, Real]:
        return least(theta)[1], np.full(len(theta), np.nan)

    found = _root(slope, grid[at] - step, grid[at] + step, dips[at])
    theta = np.concatenate([grid, np.mod(found, period)])
    order = np.argsort(theta, kind="stable")
    return theta[order], np.concatenate([value, least(found)[0]])[order]


def _root(function: Margin, low: Real, high: Real, rising: NDArray[np.bool_]) -> Real:
    """Roots between low and high, where a function changes sign once: Newton's step if it stays inside, else halving.

    Of the last bracket the end is returned where the function is not negative.
    """
    low, high = low.copy(), high.copy()
    at = (low + high) / 2.0
    for _ in range(60):
        value, rate = function(at)
        positive = value >= 0.0
        to_high = positive == rising
        low, high = np.where(to_high, low, at), np.where(to_high, at, high)
        with np.errstate(divide="ignore", invalid="ignore"):
            newton = at - value / rate
        # A little beyond the root, so that the bracket closes from both sides.
        newton = newton + 1e-15 * np.where(to_high, -1.0, 1.0)
        inside = (newton > low) & (newton < high)
        at = np.where(inside, newton, (low + high) / 2.0)
        if np.all(high - low <= 4e-16 * np.maximum(1.0, np.abs(high))):
            break
    return np.where(rising, high, low)


def _holding_reference(mechanism: Mechanism, found: list[Branch], position: list[int], period: float) -> int:
    """Index of the branch that holds the reference configuration."""
    signs = assembly_signs(mechanism, decompose(mechanism).steps)
    choice = tuple(int(signs[k]) for k in position)
    at = float(mechanism.reference_input)
    for n, branch in enumerate(found):
        if (
            branch.signs == choice
            and np.mod(at - branch.low + SAME_END, period) <= branch.high - branch.low + 2.0 * SAME_END
        ):
            return n
    return 0


def _by_circuits(found: list[Branch], closing: list[str], period: float, first: int) -> list[Branch]:
    """The branches with their circuits numbered: those that meet at an end belong together."""
    parent = list(range(len(found)))

    def root(n: int) -> int:
        while parent[n] != n:
            n = parent[n]
        return n

    for n, m in itertools.combinations(range(len(found)), 2):
        if _meet(found[n], found[m], closing, period):
            parent[root(n)] = root(m)
    numbers: dict[int, int] = {root(first): 0} if found else {}
    for n in range(len(found)):
        numbers.setdefault(root(n), len(numbers))
    numbered = [branch._replace(circuit=numbers[root(n)]) for n, branch in enumerate(found)]
    return sorted(numbered, key=lambda branch: (branch.circuit, branch.low))


def _meet(one: Branch, other: Branch, closing: list[str], period: float) -> bool:
    """Whether two branches have an end in common: a toggle joins the two assemblies on one side of it.

    A change point also joins the branches on its two sides.
    """
    if meet_at(one, other, high=True, period=period) or meet_at(one, other, high=False, period=period):
        return True
    flipped = {link for link, a, b in zip(closing, one.signs, other.signs, strict=True) if a != b}
    for low, high in ((one, other), (other, one)):
        if not (low.full or high.full) and low.low_closure == high.high_closure and flipped <= {low.low_closure}:
            return _same(low.low, high.high, period)
    return False


def meet_at(one: Branch, other: Branch, *, high: bool, period: float) -> bool:
    """Whether two branches fold flat together at their high (or low) ends: all else alike, one assembly reversed."""
    if one.full or other.full:
        return False
    ends = (one.high, other.high) if high else (one.low, other.low)
    folded = (one.high_closure, other.high_closure) if high else (one.low_closure, other.low_closure)
    reversed_ = sum(a != b for a, b in zip(one.signs, other.signs, strict=True))
    return folded[0] == folded[1] and reversed_ == 1 and _same(*ends, period)


def _same(one: float, other: float, period: float) -> bool:
    return bool(abs(np.mod(one - other + period / 2.0, period) - period / 2.0) < SAME_END)


def roots_of_rate(jet: Margin, grid: Real, rate: Real) -> Real:
    """Where the rate of a quantity, known on a grid, changes sign; ``jet`` gives the rate and its own rate."""
    with np.errstate(invalid="ignore"):
        change = np.flatnonzero((rate[:-1] > 0.0) != (rate[1:] > 0.0))
    change = change[np.isfinite(rate[change]) & np.isfinite(rate[change + 1])]
    if not len(change):
        return np.empty(0)
    return _root(jet, grid[change], grid[change + 1], rate[change + 1] > 0.0)
