"""Branch and bound for zero-free-length springs with both ends open, on the area of the first end.

The program takes the corners of both ends in pairs, which relaxes the problem and gives a lower bound. The bound is
tighter for a smaller area of the first end, and exact for a single point. The area is therefore halved repeatedly, the
part with the lowest bound first, until no part can improve on the best springs found. These come from alternation: the
best second end and rate for a given first end, and vice versa.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Sequence
from itertools import count
from typing import Literal, NamedTuple

import numpy as np

from kinematics.arrays import Complex, Real
from synthesis.kinds.spring_balancing.effects import Setting, compute_effects, find_hull
from synthesis.kinds.spring_balancing.program import BestParameters, compute_gap_tolerance, find_best
from synthesis.kinds.spring_balancing.spring_parameters import Spring, build_springs, compute_centres

Places = list[list[Complex]]

MAX_NODES = 250
"""Maximum number of parts that are solved."""

GAP_TOLERANCE = 1e-3
"""Target for the gap between value and lower bound, as a share of the value."""

MAX_ALTERNATIONS = 4
"""Maximum number of alternations between the ends, one given and the other optimized."""

LINE_TOLERANCE = 1e-12
"""Distance from a cut, as a share of the area's size, at which a corner counts as on it."""


class BranchingResult(NamedTuple):
    """The best springs, their value, the bound, and whether it is reached; infeasible if none keep their limits."""

    status: Literal["solved", "infeasible", "failed"]
    springs: list[Spring]
    value: float
    bound: float
    proved: bool


def solve_at(setting: Setting, places: Places, *, bounded: bool = True) -> BestParameters:
    """Solve the program of all springs with their ends between corners."""
    effects = [
        compute_effects(setting, spring, ends) for spring, ends in zip(setting.problem.springs, places, strict=True)
    ]
    return find_best(setting.fixed, effects, setting.problem.norm, bounded=bounded)


def branch_and_bound(setting: Setting, places: Places, report: Callable[[float], None]) -> BranchingResult:
    """Find the best springs with their ends between corners; ends of springs that are not superposed are given."""
    # Springs with one open end are convex and need no branching.
    open_both = [n for n, ends in enumerate(places) if ends and min(len(end) for end in ends) > 1]
    whole = solve_at(setting, places)
    if not open_both or whole.status != "solved":
        springs = build_springs(setting, places, whole.parameters) if whole.status == "solved" else []
        return BranchingResult(
            whole.status, springs, whole.value, whole.bound, proved=_is_proven(whole.value, whole.bound)
        )
    order = count()
    parts = [(whole.bound, next(order), places, whole)]
    value, springs, looked = np.inf, list[Spring](), 1
    least = np.inf  # bound of all discarded parts
    while parts:
        bound, _, mine, relaxed = heapq.heappop(parts)
        # The lowest bound is near enough to the best value: it bounds all remaining parts.
        if _is_proven(value, bound) or looked > MAX_NODES:
            least = min(least, bound)
            break
        reached, given = _alternate_ends(setting, mine, relaxed, open_both)
        if reached.value < value:
            value, springs = reached.value, build_springs(setting, given, reached.parameters)
        report(min(looked / MAX_NODES, 1.0))
        # Halve the end whose relaxation is farthest from a single spring: there the bound gains most.
        wide = max(open_both, key=lambda n: _measure_spread(mine[n], relaxed.parameters[n]))
        for half in _split_area(mine[wide][0]):
            child = [*mine]
            child[wide] = [half, mine[wide][1]]
            found = solve_at(setting, child, bounded=False)
            looked += 1
            if found.status == "failed":
                least = min(least, bound)
            if found.status == "solved" and found.bound < value:
                # A part cannot promise less than the whole that contains it.
                heapq.heappush(parts, (max(found.bound, bound), next(order), child, found))
    if not np.isfinite(value):
        return BranchingResult("failed" if np.isfinite(least) else "infeasible", [], value, least, proved=False)
    bound = min(value, least)
    return BranchingResult("solved", springs, value, bound, proved=_is_proven(value, bound))


def _is_proven(value: float, bound: float) -> bool:
    """Return whether a value is proven to be the minimum, to the gap."""
    return np.isfinite(value) and value - bound <= compute_gap_tolerance(value, GAP_TOLERANCE)


def _alternate_ends(
    setting: Setting, places: Places, relaxed: BestParameters, open_both: Sequence[int]
) -> tuple[BestParameters, Places]:
    """Improve from the middle of a relaxation: one end given, the other optimized, in turns over the whole areas."""
    springs = setting.problem.springs
    areas = [setting.list_corners(spring) for spring in springs]
    fixed, side = {n: compute_centres(places[n], np.maximum(relaxed.parameters[n], 0.0))[0] for n in open_both}, 0
    found, given = BestParameters("failed", [], np.inf, 0.0), places
    for _ in range(MAX_ALTERNATIONS):
        now = [*areas]
        for n in open_both:
            now[n] = [np.array([fixed[n]]) if end == side else areas[n][end] for end in range(2)]
        tried = solve_at(setting, now)
        if tried.status != "solved" or tried.value >= found.value * (1.0 - 1e-3):
            break
        found, given = tried, now
        side = 1 - side
        fixed = {n: compute_centres(now[n], np.maximum(tried.parameters[n], 0.0))[side] for n in open_both}
    return found, given


def _measure_spread(ends: Sequence[Complex], rates: Real) -> float:
    """Measure how far a relaxation is from one spring: the deviation of its rates at pairs from their centres."""
    table = np.maximum(rates, 0.0).reshape(len(ends[0]), len(ends[1]))
    whole = float(table.sum())
    if not whole > 0.0:
        return 0.0
    size = float(np.abs(ends[0][:, None] - ends[0]).max())
    one, other = compute_centres(ends, np.maximum(rates, 0.0))
    off = float(np.abs(((ends[0] - one).conj() @ table) @ (ends[1] - other)))
    twisted = float(np.abs(((ends[0] - one) @ table) @ (ends[1] - other)))
    # The last term decides between relaxations that are exact already.
    return off + twisted + 1e-6 * whole * size**2


def _split_area(corners: Complex) -> tuple[Complex, Complex]:
    """Cut a convex area across its longest diagonal; a line in its middle."""
    apart = np.abs(corners[:, None] - corners)
    # Find the two corners that are farthest from each other.
    one, other = np.unravel_index(int(np.argmax(apart)), apart.shape)
    middle = 0.5 * (corners[one] + corners[other])
    along = (corners[other] - corners[one]) / max(float(apart[one, other]), 1e-300)
    beside = ((corners - middle) * along.conjugate()).real
    slack = LINE_TOLERANCE * float(apart[one, other])
    cuts = [
        corners[n] + (corners[k] - corners[n]) * beside[n] / (beside[n] - beside[k])
        for n in range(len(corners))
        for k in range(n + 1, len(corners))
        if beside[n] * beside[k] < 0.0 and min(abs(beside[n]), abs(beside[k])) > slack
    ]
    halves = [np.array([*corners[side * beside >= -slack], *cuts]) for side in (-1.0, 1.0)]
    return find_hull(halves[0]), find_hull(halves[1])
