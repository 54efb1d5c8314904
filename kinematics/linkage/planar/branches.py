"""All circuits and branches of a mechanism that closes by dyads from its input link, by root finding.

The configurations form curves (:mod:`kinematics.linkage.planar.configuration_curves`). Cutting these where the input
reverses, and where curves cross, gives the branches. Each toggle separates two neighbours on its curve, so no branch is
listed without its neighbour, and the number of ends is even.

Terms: see :mod:`kinematics.linkage.fourbar.circuits`.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from kinematics.linkage.planar.closures import decompose
from kinematics.linkage.planar.configuration_curves import (
    Closures,
    Curve,
    compute_gear_rotations,
    find_configuration_curves,
    number_circuits,
)
from kinematics.linkage.planar.drive import find_assembly_signs
from kinematics.linkage.planar.mechanism import Mechanism, TopologyError

FULL_TURN = 2.0 * np.pi

END_TOLERANCE = 1e-7
"""Distance beyond the ends of a branch, radians, within which the reference still belongs to it."""

MAX_TURNS = 200
"""Maximum number of turns of the input until a geared mechanism repeats."""

MAX_FASTEST_TURNS = 1000.0
"""Maximum number of turns of the fastest geared link until the mechanism repeats: the effort is proportional to it."""

REPEAT_TOLERANCE = 1e-9
"""Angle, radians, by which a geared link may miss its initial position after a cycle."""


class Branch(NamedTuple):
    """One branch: a range that the input can drive through.

    ``low`` and ``high`` are input angles (radians, ``low`` within the first turn) or positions along the input slide.
    If the branch is ``full``, the input rotates fully and the range is one whole cycle. ``signs`` are the assemblies by
    closure. ``low_closure`` and ``high_closure`` name the links whose closures fold flat at the ends. ``circuit`` is
    counted from 0.
    """

    circuit: int
    low: float
    high: float
    full: bool
    signs: tuple[int, ...]
    low_closure: str
    high_closure: str


def count_turns_until_repeat(*ratios: float) -> int:
    """Count the turns of the input until gears of these ratios repeat; at most :data:`MAX_TURNS`."""
    turns = 1
    for ratio in ratios:
        # The output repeats when ratio × turns is an integer.
        turns = int(np.lcm(turns, Fraction(ratio).limit_denominator(MAX_TURNS).denominator))
    return min(turns, MAX_TURNS)


def compute_cycle(mechanism: Mechanism) -> float:
    """Compute the input rotation after which the mechanism repeats, radians: one turn, or several with gears."""
    return FULL_TURN * count_turns_until_repeat(*(gear.ratio for gear in mechanism.gears))


def compute_cycle_on_branch(mechanism: Mechanism, branch: Branch) -> float:
    """Compute the input rotation after which a mechanism repeats on a full branch: :func:`compute_cycle` or a multiple.

    A triad may be in another position after one turn of its input, and return to the first after two.
    """
    period = compute_cycle(mechanism)
    return period * max(1, round((branch.high - branch.low) / period))


def count_fastest_turns(mechanism: Mechanism) -> float:
    """Count the turns of the fastest link geared to the input, or of the input, until the mechanism repeats."""
    return (
        max(map(abs, compute_gear_rotations(mechanism, decompose(mechanism).steps).values()))
        * compute_cycle(mechanism)
        / FULL_TURN
    )


def find_dyadic_branches(mechanism: Mechanism) -> list[Branch]:
    """Find all branches of one design that closes by dyads from its input link; the reference's circuit first.

    Raises
    ------
    TopologyError
        For a class III mechanism or one driven by a slide; if gears do not repeat within :data:`MAX_TURNS` turns, or
        turn a link more than :data:`MAX_FASTEST_TURNS` times until then; or if a link swings freely at a change point
        and others depend on it.
    """
    decomposition = decompose(mechanism)
    if decomposition.left or mechanism.has_slide_input:
        raise TopologyError("kinematics-needs-dyads-and-input-link")
    period = compute_cycle(mechanism)
    for gear in mechanism.gears:
        turned = gear.ratio * period
        # An irrational ratio never repeats; its best fraction may miss the start.
        if abs(turned - 2.0 * np.pi * np.round(turned / (2.0 * np.pi))) > REPEAT_TOLERANCE:
            raise TopologyError("kinematics-gear-ratio-without-period", ratio=repr(gear.ratio), turns=MAX_TURNS)
    if count_fastest_turns(mechanism) > MAX_FASTEST_TURNS:
        raise TopologyError("kinematics-gears-turn-link-too-often", turns=f"{MAX_FASTEST_TURNS:g}")
    closures = Closures(mechanism, decomposition)
    curves = find_configuration_curves(mechanism, closures, period)
    pieces = [
        branch
        for curve, circuit in zip(curves, number_circuits(curves), strict=True)
        for branch in _cut_branches(curve, circuit, closures.links, period)
    ]
    signs = find_assembly_signs(mechanism, decomposition.steps)
    choice = tuple(int(signs[n]) for n in closures.position)
    return sort_reference_first(
        pieces, _find_reference_branch(pieces, choice, float(mechanism.reference_input), period)
    )


def _cut_branches(curve: Curve, circuit: int, links: list[str], period: float) -> list[Branch]:
    """Cut a curve at its turns into branches."""
    cuts = [(turn.at, turn.theta, links[turn.level]) for turn in curve.turns]
    if curve.closed:
        # No reversal: the input rotates fully.
        if not cuts:
            signs = tuple(int(s) for s in curve.place(np.array([curve.low])).signs[:, 0])
            return [Branch(circuit, 0.0, period, True, signs, "", "")]
        cuts.append((cuts[0][0] + curve.high - curve.low, *cuts[0][1:]))
    else:
        low, high = ((end.theta, links[end.point.level]) for end in curve.ends)
        cuts = [(curve.low, *low), *cuts, (curve.high, *high)]
    middles = curve.place(np.array([0.5 * (start_cut[0] + end_cut[0]) for start_cut, end_cut in pairwise(cuts)])).signs
    branches = []
    # Orient each branch from its lower to its higher input.
    rising = [end_cut[1] > start_cut[1] for start_cut, end_cut in pairwise(cuts)]
    # Between turns the input must alternate between rising and falling; otherwise a turn was missed.
    if any(before == after for before, after in pairwise(rising)) or (curve.closed and len(rising) % 2):
        raise TopologyError("kinematics-limits-too-close")
    for n, (start_cut, end_cut) in enumerate(pairwise(cuts)):
        (_, low_at, low_link), (_, high_at, high_link) = (start_cut, end_cut) if rising[n] else (end_cut, start_cut)
        start = float(np.mod(low_at, period))
        signs = tuple(int(s) for s in middles[:, n])
        branches.append(Branch(circuit, start, start + high_at - low_at, False, signs, low_link, high_link))
    return branches


def _find_reference_branch(branches: list[Branch], choice: tuple[int, ...], at: float, period: float) -> int:
    """Find the index of the branch that contains the reference configuration."""
    for n, branch in enumerate(branches):
        # Signs and input together identify a configuration.
        within = branch.high - branch.low + 2.0 * END_TOLERANCE
        if branch.signs == choice and np.mod(at - branch.low + END_TOLERANCE, period) <= within:
            return n
    return 0


def sort_reference_first(branches: list[Branch], first: int) -> list[Branch]:
    """Sort the branches by circuit, numbering the circuits from that of branch ``first``."""
    if not branches:
        return []
    numbers = {branches[first].circuit: 0}
    for branch in branches:
        numbers.setdefault(branch.circuit, len(numbers))
    numbered = [branch._replace(circuit=numbers[branch.circuit]) for branch in branches]
    return sorted(numbered, key=lambda branch: (branch.circuit, branch.low))
