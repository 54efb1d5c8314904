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

from kinematics.linkage.branches import GRID, Branch, dyadic_branches, meet_at
from kinematics.linkage.closures import decompose
from kinematics.linkage.drive import MechanismMotion, drive
from kinematics.linkage.mechanism import GROUND, Mechanism, TopologyError
from kinematics.linkage.roots import find_roots, sign_changes

Real = NDArray[np.float64]
FULL_TURN = 2.0 * np.pi

DEAD = 1e-9
"""Rate of the true input by the other one (in units of the mechanism) below which the true input stands still."""


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
    pieces = _pieces(mechanism, other, parts)
    found: list[Branch] = []
    closing = [step.link for step in decompose(other).steps if step.has_two_solutions]
    left = list(range(len(parts)))
    number: dict[int, int] = {}
    while left:
        loop = _loop(parts, left, closing)
        for n, _ in loop:
            left.remove(n)
        circuit = number.setdefault(parts[loop[0][0]].circuit, len(number))
        found += _branches_of(loop, pieces, circuit, mechanism.driven_by_slide)
    return sorted(found, key=lambda branch: (branch.circuit, branch.low))


def _pieces(mechanism: Mechanism, other: Mechanism, parts: list[Branch]) -> list[list[Piece]]:
    """The true input along each branch of the other driver, cut at its turning points, by rising other input."""
    base = next(name for name, listed in other.links.items() if listed == mechanism.links[GROUND])
    steps = decompose(other).steps
    closing = [n for n, step in enumerate(steps) if step.has_two_solutions]
    table = np.ones((len(parts), len(steps)), np.int64)
    for row, branch in enumerate(parts):
        table[row, closing] = branch.signs

    def true_input(at: Real, row: NDArray[np.int64], order: int) -> Real:
        """Jet of the true input where the other input is ``at``, on the branches ``row``; shape (n, len(at))."""
        motion = drive(other, at[:, None], signs=tuple(table[row].T), order=order)
        if mechanism.driven_by_slide:
            return np.asarray(motion.slides[mechanism.input][..., 0])
        name = {GROUND: base, base: GROUND}.get(mechanism.input, mechanism.input)
        turned = _rotation(other, motion, name) - _rotation(other, motion, base)
        turned[0] += mechanism.reference_input
        return turned

    # The ends are folded positions, where the rates are infinite; a hair inside they are only large.
    grids = []
    for branch in parts:
        hair = 0.0 if branch.full else 1e-9 * (branch.high - branch.low)
        grids.append(np.linspace(branch.low + hair, branch.high - hair, GRID))
    rows = np.repeat(np.arange(len(parts)), GRID)
    known, rate = (row.reshape(len(parts), GRID) for row in true_input(np.concatenate(grids), rows, 1))
    # A true input that stands still on a branch of the other driver (a dead branch) has no turning points.
    rate[np.abs(rate).max(axis=1, initial=0.0, where=np.isfinite(rate)) <= DEAD] = 0.0
    changes = [(row, n) for row in range(len(parts)) for n in sign_changes(rate[row])]
    turns = np.empty(0)
    of = np.array([row for row, _ in changes], np.int64)
    if changes:
        low, high = (np.array([grids[row][n + k] for row, n in changes]) for k in (0, 1))
        at_low, at_high = (np.array([rate[row][n + k] for row, n in changes]) for k in (0, 1))
        turns = find_roots(lambda at: true_input(at, of, 1)[1], low, high, at_low, at_high)[0]
    ends = np.array([end for branch in parts for end in (branch.low, branch.high)])
    extra_of = np.concatenate([np.repeat(np.arange(len(parts)), 2), of])
    extra = np.concatenate([ends, turns])
    extra_known = true_input(extra, extra_of, 0)[0]
    points, cut = [], []
    for row, grid in enumerate(grids):
        at, first = np.unique(np.concatenate([grid, extra[extra_of == row]]), return_index=True)
        points.append(at)
        value = np.concatenate([known[row], extra_known[extra_of == row]])[first]
        # A folded end may miss its assembly by rounding; the point next to it is a hair away.
        for end, inner_end in ((0, 1), (-1, -2)):
            if np.isnan(value[end]):
                value[end] = value[inner_end]
        smooth = value if mechanism.driven_by_slide else np.unwrap(value)
        inner = [float(smooth[np.searchsorted(points[row], t)]) for t in np.sort(turns[of == row])]
        cut.append([Piece(float(a), float(b)) for a, b in pairwise([smooth[0], *inner, smooth[-1]])])
    return cut


def _rotation(mechanism: Mechanism, motion: MechanismMotion, link: str) -> Real:
    """Jet of a link's rotation from the reference; shape (n, inputs)."""
    if link == GROUND:
        return np.zeros(motion.input.shape[:2])
    rotation: Real = motion.angles[link][..., 0].copy()
    rotation[0] -= mechanism.link_angle(link)
    return rotation


def _loop(parts: list[Branch], left: list[int], closing: list[str]) -> list[tuple[int, bool]]:
    """Branches of one circuit strung together: (index, upwards), starting with the first one left."""
    here, upwards = left[0], True
    loop = [(here, upwards)]
    if parts[here].full:
        return loop
    while True:
        after = next(
            (m for m in left if m != here and meet_at(parts[here], parts[m], closing, high=upwards, period=FULL_TURN)),
            None,
        )
        if after is not None and after == loop[0][0]:
            return loop
        if after is None or after in [n for n, _ in loop]:
            raise TopologyError("a circuit does not close; two of its limits lie closer than the search resolves")
        here, upwards = after, not upwards
        loop.append((here, upwards))


def _branches_of(loop: list[tuple[int, bool]], cut: list[list[Piece]], circuit: int, slide: bool) -> list[Branch]:
    """Join the pieces along a closed loop where the input goes on the same way."""
    pieces: list[Piece] = []
    for n, upwards in loop:
        own = cut[n] if upwards else [Piece(p.end, p.start) for p in reversed(cut[n])]
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
        if abs(piece.end - piece.start) <= DEAD:
            continue
        low, high = min(piece), max(piece)
        start = low if slide else float(np.mod(low, FULL_TURN))
        listed.append(Branch(circuit, start, start + high - low, full, (), "", ""))
    return listed
