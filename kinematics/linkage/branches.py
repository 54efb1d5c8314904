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
from kinematics.linkage.roots import find_roots

Real = NDArray[np.float64]

GRID = 720
"""Grid points a turn of the input."""

NEAR_ZERO = 0.05
"""A grid minimum (or maximum) of the margin nearer to zero than this is searched for a gap between grid points."""

TOUCHES = 1e-12
"""A least margin below this is a change point: branches meet there, and no direction of motion is determined."""

SAME_END = 1e-7
"""Ends of branches closer than this, radians, are one toggle: two computations of one root."""

ROUNDING = 1e-14
"""Margins below this are zero: a few roundings of the lengths, less than what driving allows a folded closure."""

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

    if not closing:
        return [Branch(0, 0.0, period, True, (), "", "")]

    def margins(theta: Real, choice: NDArray[np.int64]) -> tuple[Real, Real, NDArray[np.int64]]:
        """Least margin, its rate and the closure that has it, shape (n,), each input with its own choice of signs."""
        rows = np.array(choices, np.int64)[choice]
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

    intervals = _positive_intervals(lambda theta, row: margins(theta, row)[:2], len(choices), period)
    listed = [(row, *interval) for row, some in enumerate(intervals) for interval in some]
    rows = np.array([row for row, *_ in listed for _ in (0, 1)], np.int64)
    ends = np.array([end for _, low, high, _ in listed for end in (low, high)])
    folded = margins(ends, rows)[2] if listed else np.empty(0, np.int64)
    found = [
        Branch(
            0,
            low,
            high,
            full,
            choices[row],
            *(("", "") if full else (closing[folded[2 * n]], closing[folded[2 * n + 1]])),
        )
        for n, (row, low, high, full) in enumerate(listed)
    ]
    return _by_circuits(found, closing, period, _holding_reference(mechanism, found, position, period))


Margins = Callable[[Real, NDArray[np.int64]], tuple[Real, Real]]
"""A function of the input and of the row (choice of assemblies), with its rate by the input."""


def _positive_intervals(least: Margins, rows: int, period: float) -> list[list[tuple[float, float, bool]]]:
    """Where periodic functions are positive, by rows: (low, high, whether it is a whole period), 0 ≤ low < period."""
    count = int(GRID * period / (2.0 * np.pi))
    grid = np.linspace(0.0, period, count, endpoint=False)
    value = least(np.tile(grid, rows), np.repeat(np.arange(rows), count))[0].reshape(rows, count)
    extra_row, extra_theta, extra_value = _extremes_near_zero(least, grid, value, period)
    brackets: list[Bracket] = []
    plans: list[tuple[Real, NDArray[np.bool_]] | bool] = []  # ends known so far and which of them are, or all or none
    for row in range(rows):
        theta = np.concatenate([grid, extra_theta[extra_row == row]])
        order = np.argsort(theta, kind="stable")
        theta, here = theta[order], np.concatenate([value[row], extra_value[extra_row == row]])[order]
        inside = here > TOUCHES
        if inside.all() or not inside.any():
            plans.append(bool(inside.all()))
            continue
        start = int(np.flatnonzero(~inside)[0])
        theta, here, inside = np.roll(theta, -start), np.roll(here, -start), np.roll(inside, -start)
        theta = np.append(np.where(theta < theta[0], theta + period, theta), theta[0] + period)
        here = np.append(here, here[0])
        edges = np.flatnonzero(np.diff(np.append(inside, False).astype(int)))
        # Outside an edge at a change point stands the searched extreme: it is the end itself.
        outer = np.where(inside[edges], edges + 1, edges)
        touching = np.abs(here[outer]) <= TOUCHES
        plans.append((theta[outer], touching))
        for edge in edges[~touching]:
            brackets.append(Bracket(row, *map(float, (theta[edge], theta[edge + 1], here[edge], here[edge + 1]))))
    roots = iter(_ends(least, brackets))
    found: list[list[tuple[float, float, bool]]] = []
    for plan in plans:
        if isinstance(plan, bool):
            found.append([(0.0, period, True)] if plan else [])
            continue
        ends = [float(known) if touching else next(roots) for known, touching in zip(*plan, strict=True)]
        spans = zip(ends[::2], ends[1::2], strict=True)
        found.append(
            [(float(np.mod(low, period)), float(np.mod(low, period) + high - low), False) for low, high in spans]
        )
    return found


class Bracket(NamedTuple):
    """Inputs between which the margin of a row vanishes, and the margins there."""

    row: int
    low: float
    high: float
    at_low: float
    at_high: float


def _ends(least: Margins, brackets: list[Bracket]) -> list[float]:
    """Where the margins of rows vanish between two inputs; of the last bracket the end where it is not negative."""
    if not brackets:
        return []
    row, low, high, at_low, at_high = (np.array(column) for column in zip(*brackets, strict=True))
    found = find_roots(lambda theta: _lifted(least(theta, row)[0]), low, high, _lifted(at_low), _lifted(at_high))
    ends: list[float] = found[0].tolist()
    return ends


def _lifted(margin: Real) -> Real:
    """Margins with those that are zero to rounding counted as zero."""
    return np.asarray(np.where(np.abs(margin) <= ROUNDING, 0.0, margin))


def _extremes_near_zero(least: Margins, grid: Real, value: Real, period: float) -> tuple[NDArray[np.int64], Real, Real]:
    """Row, input and value of minima above zero and maxima below it that come near zero, found between grid points."""
    before, after = np.roll(value, 1, axis=1), np.roll(value, -1, axis=1)
    dips = (value > 0.0) & (value <= before) & (value <= after) & (value < NEAR_ZERO)
    bumps = (value <= 0.0) & (value >= before) & (value >= after) & (value > -NEAR_ZERO)
    row, at = np.nonzero(dips | bumps)
    if not len(row):
        return row, np.empty(0), np.empty(0)
    step = period / len(grid)
    theta = np.mod(find_roots(lambda theta: least(theta, row)[1], grid[at] - step, grid[at] + step)[0], period)
    return row, theta, least(theta, row)[0]


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
    if any(meet_at(one, other, closing, high=high, period=period) for high in (True, False)):
        return True
    flipped = {link for link, a, b in zip(closing, one.signs, other.signs, strict=True) if a != b}
    for low, high in ((one, other), (other, one)):
        if not (low.full or high.full) and low.low_closure == high.high_closure and flipped <= {low.low_closure}:
            return _same(low.low, high.high, period)
    return False


def meet_at(one: Branch, other: Branch, closing: list[str], *, high: bool, period: float) -> bool:
    """Whether two branches fold flat together at their high (or low) ends: only the folded closure's sign reversed."""
    if one.full or other.full:
        return False
    ends = (one.high, other.high) if high else (one.low, other.low)
    folded = (one.high_closure, other.high_closure) if high else (one.low_closure, other.low_closure)
    flipped = {link for link, a, b in zip(closing, one.signs, other.signs, strict=True) if a != b}
    return folded[0] == folded[1] and flipped == {folded[0]} and _same(*ends, period)


def _same(one: float, other: float, period: float) -> bool:
    return bool(abs(np.mod(one - other + period / 2.0, period) - period / 2.0) < SAME_END)
