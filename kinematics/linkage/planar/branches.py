"""All circuits and branches of a mechanism that closes by dyads from its input link, by root finding.

The configurations form curves (:mod:`kinematics.linkage.planar.configuration_curves`). Cut where the input turns back,
and where curves cross, they are the branches. Each toggle stands between two neighbours on its curve, hence no branch
can be listed without the one that it goes over into, and the number of ends is even.

Words: see :mod:`kinematics.linkage.fourbar.circuits`.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.configuration_curves import (
    Closures,
    Curve,
    circuits,
    configuration_curves,
    gear_rotations,
)
from kinematics.linkage.planar.drive import assembly_signs
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError

Real = NDArray[np.float64]

FULL_TURN = 2.0 * np.pi

SAME_END = 1e-7
"""The reference belongs to a branch when it is at most so far beyond its ends, radians."""

TURNS_AT_MOST = 200
"""Turns of the input until a geared mechanism repeats, at most."""

MOST_TURNS = 1000.0
"""Turns of the fastest geared link until all repeats, at most: what is to be looked at grows with them."""

REPEATS = 1e-9
"""Angle by which a geared link may miss its place after a cycle, radians."""


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


def turns_until_repeated(*ratios: float) -> int:
    """Turns of the input after which all gears of these ratios stand as before; :data:`TURNS_AT_MOST` at most."""
    turns = 1
    for ratio in ratios:
        turns = int(np.lcm(turns, Fraction(ratio).limit_denominator(TURNS_AT_MOST).denominator))
    return min(turns, TURNS_AT_MOST)


def cycle(mechanism: Mechanism) -> float:
    """Input rotation after which the mechanism repeats, radians: a full turn, or as many as its gears need."""
    return FULL_TURN * turns_until_repeated(*(gear.ratio for gear in mechanism.gears))


def cycle_on(mechanism: Mechanism, branch: Branch) -> float:
    """Input rotation after which a mechanism repeats on a full branch: :func:`cycle`, or with a triad a multiple of it.

    A triad may come to another place in one turn of its input, and back in two.
    """
    period = cycle(mechanism)
    return period * max(1, round((branch.high - branch.low) / period))


def most_turns(mechanism: Mechanism) -> float:
    """Turns of the fastest link that gears tie to the input, or of the input, until the mechanism repeats."""
    return max(map(abs, gear_rotations(mechanism, decompose(mechanism).steps).values())) * cycle(mechanism) / FULL_TURN


def dyadic_branches(mechanism: Mechanism) -> list[Branch]:
    """All branches of one design that closes by dyads from its input link; the reference's circuit first.

    Raises
    ------
    TopologyError
        For a class III mechanism or one that is driven by a slide; where the gears do not bring it back within
        ``TURNS_AT_MOST`` turns, or turn a link more than ``MOST_TURNS`` times until then; or where a link swings freely
        at a change point and others depend on it.
    """
    decomposition = decompose(mechanism)
    if decomposition.left or mechanism.driven_by_slide:
        raise TopologyError("expected a mechanism that closes by dyads and is driven by a link")
    period = cycle(mechanism)
    for gear in mechanism.gears:
        turned = gear.ratio * period
        if abs(turned - 2.0 * np.pi * np.round(turned / (2.0 * np.pi))) > REPEATS:
            raise TopologyError(f"a gear ratio of {gear.ratio!r} does not repeat within {TURNS_AT_MOST} turns")
    if most_turns(mechanism) > MOST_TURNS:
        raise TopologyError(
            f"gears turn a link more than {MOST_TURNS:g} times until all repeats; circuits are not known"
        )
    closures = Closures(mechanism, decomposition)
    curves = configuration_curves(mechanism, closures, period)
    pieces = [
        branch
        for curve, circuit in zip(curves, circuits(curves), strict=True)
        for branch in _branches_of(curve, circuit, closures.links, period)
    ]
    signs = assembly_signs(mechanism, decomposition.steps)
    choice = tuple(int(signs[n]) for n in closures.position)
    return reference_first(pieces, _holding(pieces, choice, float(mechanism.reference_input), period))


def _branches_of(curve: Curve, circuit: int, links: list[str], period: float) -> list[Branch]:
    """A curve cut at its turns."""
    cuts = [(turn.at, turn.theta, links[turn.level]) for turn in curve.turns]
    if curve.closed:
        if not cuts:
            signs = tuple(int(s) for s in curve.place(np.array([curve.low])).signs[:, 0])
            return [Branch(circuit, 0.0, period, True, signs, "", "")]
        cuts.append((cuts[0][0] + curve.high - curve.low, *cuts[0][1:]))
    else:
        low, high = ((end.theta, links[end.point.level]) for end in curve.ends)
        cuts = [(curve.low, *low), *cuts, (curve.high, *high)]
    middles = curve.place(np.array([0.5 * (start_cut[0] + end_cut[0]) for start_cut, end_cut in pairwise(cuts)])).signs
    branches = []
    rising = [end_cut[1] > start_cut[1] for start_cut, end_cut in pairwise(cuts)]
    if any(before == after for before, after in pairwise(rising)) or (curve.closed and len(rising) % 2):
        raise TopologyError("two limits lie closer together than they can be told apart; circuits are not known")
    for n, (start_cut, end_cut) in enumerate(pairwise(cuts)):
        (_, low_at, low_link), (_, high_at, high_link) = (start_cut, end_cut) if rising[n] else (end_cut, start_cut)
        start = float(np.mod(low_at, period))
        signs = tuple(int(s) for s in middles[:, n])
        branches.append(Branch(circuit, start, start + high_at - low_at, False, signs, low_link, high_link))
    return branches


def _holding(branches: list[Branch], choice: tuple[int, ...], at: float, period: float) -> int:
    """Index of the branch that holds the reference configuration."""
    for n, branch in enumerate(branches):
        within = branch.high - branch.low + 2.0 * SAME_END
        if branch.signs == choice and np.mod(at - branch.low + SAME_END, period) <= within:
            return n
    return 0


def reference_first(branches: list[Branch], first: int) -> list[Branch]:
    """The branches by circuits, which are counted from the first one's."""
    if not branches:
        return []
    numbers = {branches[first].circuit: 0}
    for branch in branches:
        numbers.setdefault(branch.circuit, len(numbers))
    numbered = [branch._replace(circuit=numbers[branch.circuit]) for branch in branches]
    return sorted(numbered, key=lambda branch: (branch.circuit, branch.low))
