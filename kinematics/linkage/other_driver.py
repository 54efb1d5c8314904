"""Branches of a mechanism whose input does not close it by dyads, found by driving it elsewhere.

Which configurations a mechanism can reach does not depend on which link is called ground or input. Where the input
leaves a class III group, or is a slide, another pair of links is taken for ground and input such that all closures are
dyads. Their branches are known by root finding (:mod:`kinematics.linkage.branches`); strung together at their toggles
they are the circuits, as closed curves. Along these the true input is a smooth function; where it turns back is a
toggle, and what lies between two such points is a branch.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage.branches import GRID, Branch, dyadic_branches, meet_at, roots_of_rate
from kinematics.linkage.closures import decompose
from kinematics.linkage.drive import drive
from kinematics.linkage.mechanism import GROUND, Mechanism, TopologyError

Real = NDArray[np.float64]
FULL_TURN = 2.0 * np.pi


class Piece(NamedTuple):
    """A part of a circuit on which the true input moves one way: from ``start`` to ``end``, unwrapped."""

    start: float
    end: float


def other_driver(mechanism: Mechanism) -> Mechanism:
    """The same mechanism with another ground and input, closed by dyads; the names of the two grounds are exchanged.

    Raises
    ------
    TopologyError
        Where no pair of pinned links closes it by dyads, or where gears tie it to its ground.
    """
    if mechanism.gears:
        raise TopologyError("a geared mechanism must close by dyads from its input; this one does not")
    for base in (GROUND, *(link for link in mechanism.links if link != GROUND)):
        swapped = {GROUND: base, base: GROUND}
        links = {swapped.get(name, name): listed for name, listed in mechanism.links.items()}
        slides = tuple(slide._replace(link=swapped.get(slide.link, slide.link)) for slide in mechanism.slides)
        for driver, listed in links.items():
            if driver == GROUND or not set(listed) & set(links[GROUND]):
                continue
            other = Mechanism(dict(mechanism.joints), links, driver, slides)
            if not decompose(other).left:
                return other
    raise TopologyError("no pair of links closes this mechanism by dyads")


def branches_by_other_driver(mechanism: Mechanism) -> list[Branch]:
    """All branches of one design, circuit by circuit, the reference's first; ``signs`` and closures are left empty."""
    other = other_driver(mechanism)
    parts = dyadic_branches(other)
    curves = [_Curve(mechanism, other, branch) for branch in parts]
    found: list[Branch] = []
    left = list(range(len(parts)))
    number: dict[int, int] = {}
    while left:
        loop = _loop(parts, left)
        for n, _ in loop:
            left.remove(n)
        circuit = number.setdefault(parts[loop[0][0]].circuit, len(number))
        found += _branches_of(loop, curves, circuit, mechanism.driven_by_slide)
    return sorted(found, key=lambda branch: (branch.circuit, branch.low))


class _Curve:
    """The true input along one branch of the other driver: its pieces between turning points, by rising other input."""

    def __init__(self, mechanism: Mechanism, other: Mechanism, branch: Branch) -> None:
        base = next(name for name, listed in other.links.items() if listed == mechanism.links[GROUND])
        steps = decompose(other).steps
        chosen = iter(branch.signs)
        signs = tuple(np.array(next(chosen) if step.has_two_solutions else 1) for step in steps)

        def true_input(at: Real, order: int) -> Real:
            motion = drive(other, at, signs=signs, order=order)
            if mechanism.driven_by_slide:
                return motion.slides[mechanism.input]
            name = {GROUND: base, base: GROUND}.get(mechanism.input, mechanism.input)
            still = np.zeros_like(motion.input)
            turned = motion.angles.get(name, still) - motion.angles.get(base, still)
            return np.asarray(turned)

        # The ends are folded positions, where the rates are infinite; a hair inside they are only large.
        hair = 0.0 if branch.full else 1e-9 * (branch.high - branch.low)
        grid = np.linspace(branch.low + hair, branch.high - hair, GRID)
        rate = true_input(grid, 1)[1]
        turns = roots_of_rate(lambda at: (lambda jet: (jet[1], jet[2]))(true_input(at, 2)), grid, rate)
        at = np.unique(np.concatenate([[branch.low], grid, turns, [branch.high]]))
        value = true_input(at, 0)[0]
        if not mechanism.driven_by_slide:
            value = np.unwrap(value)
        marks = [value[0], *(float(value[np.searchsorted(at, t)]) for t in turns), value[-1]]
        self.pieces = [Piece(float(a), float(b)) for a, b in pairwise(marks)]


def _loop(parts: list[Branch], left: list[int]) -> list[tuple[int, bool]]:
    """Branches of one circuit strung together: (index, upwards), starting with the first one left."""
    here, upwards = left[0], True
    loop = [(here, upwards)]
    if parts[here].full:
        return loop
    while True:
        after = next(
            (m for m in left if m != here and meet_at(parts[here], parts[m], high=upwards, period=FULL_TURN)), None
        )
        if after is None or after == loop[0][0]:
            return loop
        if after in [n for n, _ in loop]:
            return loop
        here, upwards = after, not upwards
        loop.append((here, upwards))


def _branches_of(loop: list[tuple[int, bool]], curves: list[_Curve], circuit: int, slide: bool) -> list[Branch]:
    """Join the pieces along a closed loop where the input goes on the same way."""
    pieces: list[Piece] = []
    for n, upwards in loop:
        own = curves[n].pieces if upwards else [Piece(p.end, p.start) for p in reversed(curves[n].pieces)]
        for piece in own:
            shift = 0.0 if slide or not pieces else FULL_TURN * round((pieces[-1].end - piece.start) / FULL_TURN)
            pieces.append(Piece(piece.start + shift, piece.end + shift))
    joined = [pieces[0]]
    for piece in pieces[1:]:
        if (piece.end > piece.start) == (joined[-1].end > joined[-1].start):
            joined[-1] = Piece(joined[-1].start, piece.end)
        else:
            joined.append(piece)
    first, last = joined[0], joined[-1]
    if len(joined) > 1 and (first.end > first.start) == (last.end > last.start):
        shift = 0.0 if slide else FULL_TURN * round((first.start - last.end) / FULL_TURN)
        joined = [Piece(last.start + shift, first.end), *joined[1:-1]]
    full = len(joined) == 1
    listed = []
    for piece in joined:
        low, high = min(piece), max(piece)
        start = low if slide else float(np.mod(low, FULL_TURN))
        listed.append(Branch(circuit, start, start + high - low, full, (), "", ""))
    return listed
