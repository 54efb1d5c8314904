"""The motion of a fourbar followed step by step, from its dimensions and one configuration.

Nothing of the package is used, and no closed form: no toggle angle, no Grashof rule, no half angle. A configuration is
the pair of moving pivots (A, B). The rigid lengths |A − O2| = a, |B − A| = b, |B − O4| = c are three equations in four
real unknowns, so that configurations form curves, the circuits. With p = A − O2, q = B − A, r = B − O4 and the dot
product u·v, the direction

    dA = (q·ir) ip,    dB = (q·ip) ir

keeps all three lengths to first order. It is a smooth function on the plane of (A, B) and vanishes at change points
only, hence it never turns back on a circuit. A step is a midpoint predictor along it and Newton's iteration for the one
joint, with the other joint held on its circle; it is refused and halved where the direction turned more than a little.
At the gap between two circuits the directions on the two sides are opposite, so that no step leaps it.

    toggle    where q·ir, the rate of the input, changes sign;
    branch    between two toggles; the whole circuit where there is none;
    circuit   what is passed until the start comes back.

All functions take many linkages at once, as arrays of shape (n,).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Mask, Real
from tests.oracles.positions import meet, newton_step

TURN = 0.985
"""Least cosine between the directions at both ends of a step: ten degrees."""

LONGEST_STEP = 0.15
"""In units of a + c, so that a circuit has dozens of steps."""

STALL = 1e-9
"""A step below this share of a + c means a change point: the direction is undefined there."""

PASSED = 1e-6
"""A configuration counts as passed when it is met to this share of a + c."""

RIGID = 1e-12
"""Lengths are kept to this share of a + c after each step."""

STEPS = 20_000
CHUNK = 2_000


class Linkages(NamedTuple):
    """Fixed pivots and link lengths, shape (n,)."""

    o2: Complex
    o4: Complex
    a: Real
    b: Real
    c: Real


@dataclass(frozen=True)
class Circuit:
    """One round of each linkage through its circuit, starting at its first configuration.

    ``arc`` (n, m): arc length at which each configuration is passed, NaN where the circuit does not hold it.
    ``length`` (n,): arc length of the whole circuit; NaN where the motion ran into a change point.
    ``toggles`` (n,): number of toggles on the circuit. ``branch`` (n, m): number of the branch on which each
    configuration lies, −1 where it is not on the circuit. ``sine`` (n, m): |sin| of the angle between coupler
    and output there. ``trace_arc``, ``trace_sine``, ``trace_turn`` (n, k): arc length, that sine and the angle by which
    the input has turned, at the steps; NaN where a linkage had none.
    """

    arc: Real
    length: Real
    toggles: NDArray[np.int64]
    toggle_arc: Real
    branch: NDArray[np.int64]
    sine: Real
    trace_arc: Real
    trace_sine: Real
    trace_turn: Real

    @property
    def same_circuit(self) -> Mask:
        """Which configurations lie on the circuit of the first, shape (n, m)."""
        return ~np.isnan(self.arc)

    @property
    def same_branch(self) -> Mask:
        """Which configurations lie on the branch of the first, shape (n, m)."""
        return self.same_circuit & (self.branch == self.branch[:, :1])

    @property
    def in_order(self) -> Mask:
        """Whether one direction meets all configurations in their order, shape (n,).

        Where all lie on one branch with toggles at its ends the motion stays on the branch; else it goes once round.
        """
        found = self.same_circuit.all(axis=1)
        bounded = self.same_branch.all(axis=1) & (self.toggles > 0)
        onward = np.where(np.isnan(self.arc), 0.0, self.arc)
        signed = np.where(bounded[:, None], self._from_first_toggle(), onward)
        signed = signed - signed[:, :1]
        steps = np.diff(signed, axis=1)
        forth, back = (steps > 0).all(axis=1), (steps < 0).all(axis=1)
        reverse = np.where(onward > 0.0, onward - self.length[:, None], 0.0)
        round_back = (np.diff(reverse, axis=1) < 0).all(axis=1)
        return found & (forth | np.where(bounded, back, round_back))

    def least_transmission(self) -> Real:
        """Least transmission angle in radians over the way that is used, shape (n,); NaN where circuits differ.

        The way: between the outermost configurations, for a branch between toggles; else from the first configuration
        to the last the way that meets all in order (where both do, the one of less input rotation), or the whole
        circuit. Exact at the configurations; a minimum between two steps is missed by some 1e-3.
        """
        least = np.full(len(self.length), np.nan)
        for k in np.flatnonzero(self.same_circuit.all(axis=1)):
            total, arc = self.length[k], self.arc[k]
            seen = ~np.isnan(self.trace_arc[k])
            s, sine, turn = self.trace_arc[k, seen], self.trace_sine[k, seen], self.trace_turn[k, seen]
            if self.same_branch[k].all() and self.toggles[k] > 0:
                at, s = np.mod(arc - self.toggle_arc[k, 0], total), np.mod(s - self.toggle_arc[k, 0], total)
                low, high = at.min(), at.max()
            else:
                forth = bool((np.diff(arc) > 0).all())
                back = bool((np.diff(np.where(arc > 0, arc - total, 0.0)) < 0).all())
                there = np.interp(arc[-1], s, turn)
                if forth and back:
                    forth = abs(there) <= abs(2.0 * np.pi * np.rint(turn[-1] / (2.0 * np.pi)) - there)
                low, high = (0.0, arc[-1]) if forth else (arc[-1], total) if back else (0.0, total)
            used = sine[(s > low) & (s < high)]
            least[k] = np.arcsin(min(used.min(initial=1.0), self.sine[k].min(), 1.0))
        return least

    def _from_first_toggle(self) -> Real:
        """Arc lengths counted from the first toggle after the start."""
        arc = np.where(np.isnan(self.arc), 0.0, self.arc)
        length = np.where(np.isnan(self.length), np.inf, self.length)
        cut = np.where(self.toggles > 0, self.toggle_arc[:, 0], 0.0)
        return np.where(arc >= cut[:, None], arc - cut[:, None], arc - cut[:, None] + length[:, None])


def configurations(linkages: Linkages, input_angle: ArrayLike, assembly: ArrayLike) -> tuple[Complex, Complex]:
    """Pivots A and B at absolute input angles (n, m) in radians, on assemblies +1 or −1, shape (n, m) or (n, 1)."""
    o2, o4, a, b, c = (field[:, None] for field in linkages)
    pin_a = o2 + a * (np.cos(input_angle) + 1j * np.sin(input_angle))
    return pin_a, meet(pin_a, o4, b, c, assembly)


def follow(linkages: Linkages, pin_a: ArrayLike, pin_b: ArrayLike) -> Circuit:
    """Drive each linkage once round the circuit of its first configuration.

    Parameters
    ----------
    linkages : Linkages
        n designs.
    pin_a, pin_b : complex
        Configurations, shape (n, m); the first of each row is the start. A configuration of NaN, or one that breaks a
        rigid length, is on no circuit.
    """
    pin_a, pin_b = np.asarray(pin_a, np.complex128), np.asarray(pin_b, np.complex128)
    parts = []
    for low in range(0, len(linkages.a), CHUNK):
        part = slice(low, low + CHUNK)
        parts.append(_follow(Linkages(*(field[part] for field in linkages)), pin_a[part], pin_b[part]))
    if len(parts) == 1:
        return parts[0]
    joined = []
    for name in Circuit.__dataclass_fields__:
        fields = [getattr(part, name) for part in parts]
        if fields[0].ndim == 2:
            width = max(field.shape[1] for field in fields)
            pads = [((0, 0), (0, width - field.shape[1])) for field in fields]
            fields = [_pad(field, pad) for field, pad in zip(fields, pads, strict=True)]
        joined.append(np.concatenate(fields))
    return Circuit(*joined)


def reaches(linkages: Linkages, start: tuple[ArrayLike, ArrayLike], target: tuple[ArrayLike, ArrayLike]) -> list[str]:
    """For each linkage whether the target (input angle, assembly) is on the start's branch, circuit, or on another.

    The answers are ``"same branch"``, ``"same circuit"`` and ``"other circuit"``.
    """
    angle = np.stack(np.broadcast_arrays(start[0], target[0], linkages.a)[:2], axis=1)
    sign = np.stack(np.broadcast_arrays(start[1], target[1], linkages.a)[:2], axis=1)
    circuit = follow(linkages, *configurations(linkages, angle, sign))
    branch, same = circuit.same_branch[:, 1], circuit.same_circuit[:, 1]
    return ["same branch" if b else "same circuit" if s else "other circuit" for b, s in zip(branch, same, strict=True)]


class Verdict(NamedTuple):
    """What driving a finished mechanism through demanded positions shows; ``residual`` is a share of its size."""

    residual: float
    same_circuit: bool
    same_branch: bool
    in_order: bool
    least_transmission: float


def drive(mechanisms: Sequence[Mapping[str, Any]], positions: Sequence[Mapping[str, float]]) -> list[Verdict]:
    """Carry a body through positions by finished mechanisms.

    Parameters
    ----------
    mechanisms : sequence of mappings
        The fields of a fourbar as the service writes them: ``fixed_pivots`` (``input``, ``output``), ``links``
        (``input``, ``coupler``, ``output``; ``ground`` must agree with the pivots), ``coupler_point`` (``distance``,
        ``angle``), ``assembly`` and ``reference_input_angle`` at the first position; degrees.
    positions : sequence of mappings
        ``x``, ``y``, ``angle`` (degrees) of the body; the first fixes the body on the coupler.

    Returns
    -------
    list of Verdict
        ``residual`` is the largest misfit of a rigid length when the coupler stands in a demanded position, with the
        misfit of the point P at the first, as a share of a + b + c + d. The rest is what the linkage shows when its
        input stands as in the demanded positions, with B on the same side of A → O4.
    """
    n = len(mechanisms)
    o2, o4 = (np.array([complex(*m["fixed_pivots"][side]) for m in mechanisms]) for side in ("input", "output"))
    a, b, c, d = (np.array([m["links"][k] for m in mechanisms]) for k in ("input", "coupler", "output", "ground"))
    linkages = Linkages(o2, o4, a, b, c)
    size = a + b + c + d
    sign = np.array([{"open": 1, "crossed": -1}[m["assembly"]] for m in mechanisms])
    theta = np.radians([m["reference_input_angle"] for m in mechanisms])
    first_a, first_b = (x[:, 0] for x in configurations(linkages, theta[:, None], sign[:, None]))
    arm = np.array([m["coupler_point"]["distance"] for m in mechanisms])
    arm = arm * np.exp(1j * np.radians([m["coupler_point"]["angle"] for m in mechanisms]))

    point = np.array([complex(p["x"], p["y"]) for p in positions])
    turn = np.exp(1j * np.radians([p["angle"] - positions[0]["angle"] for p in positions]))
    along = ((first_b - first_a) / b)[:, None] * turn
    pin_a = point - arm[:, None] * along
    pin_b = pin_a + b[:, None] * along
    misfit = np.abs(np.abs(pin_a - o2[:, None]) - a[:, None]) + np.abs(np.abs(pin_b - o4[:, None]) - c[:, None])
    misfit[:, 0] += np.abs(pin_a[:, 0] - first_a) + np.abs(np.abs(o4 - o2) - d)
    residual = misfit.max(axis=1) / size

    spoke, base = pin_a - o2[:, None], o4[:, None] - pin_a
    hand = np.where(base.real * (pin_b - pin_a).imag >= base.imag * (pin_b - pin_a).real, 1, -1)
    circuit = follow(linkages, *configurations(linkages, np.angle(spoke), hand))
    same, branch = circuit.same_circuit.all(axis=1), circuit.same_branch.all(axis=1)
    order, least = circuit.in_order, circuit.least_transmission()
    return [
        Verdict(float(residual[k]), bool(same[k]), bool(branch[k]), bool(order[k]), float(least[k])) for k in range(n)
    ]


def _follow(linkages: Linkages, goal_a: Complex, goal_b: Complex) -> Circuit:
    n, m = goal_a.shape
    origin = linkages.o2[:, None]
    goal_a, goal_b = goal_a - origin, goal_b - origin
    linkages = linkages._replace(o2=np.zeros(n, np.complex128), o4=linkages.o4 - linkages.o2)
    size = linkages.a + linkages.c
    at_a, at_b = goal_a[:, 0].copy(), goal_b[:, 0].copy()
    arc = np.full((n, m), np.nan)
    arc[np.abs(goal_a - at_a[:, None]) + np.abs(goal_b - at_b[:, None]) <= PASSED * 1e-3 * size[:, None]] = 0.0
    length, s, turned, step = np.full(n, np.nan), np.zeros(n), np.zeros(n), 0.02 * size
    every = Linkages(*(field[:, None] for field in linkages))
    sine = _sine(every, goal_a, goal_b)
    toggles: list[list[float]] = [[] for _ in range(n)]
    trace: list[tuple[NDArray[np.int64], Real, Real, Real]] = []
    live = np.flatnonzero(_misfit(linkages, at_a, at_b) <= 0.1 * PASSED * size)
    trace.append((live, s[live], _sine(linkages, at_a, at_b)[live], turned[live]))
    for _ in range(STEPS):
        if live.size == 0:
            break
        part = Linkages(*(field[live] for field in linkages))
        a0, b0, h = at_a[live], at_b[live], step[live]
        rate0, da0, db0 = _direction(part, a0, b0)
        with np.errstate(divide="ignore", invalid="ignore"):
            _, da, db = _direction(part, a0 + 0.5 * h * da0, b0 + 0.5 * h * db0)
            a1, b1 = _hold(part, a0 + h * da, b0 + h * db, np.abs(da) >= np.abs(db))
            rate1, da1, db1 = _direction(part, a1, b1)
            straight = _dot(da0, da1) + _dot(db0, db1)
            leap = np.hypot(np.abs(a1 - a0 - h * da), np.abs(b1 - b0 - h * db))
        good = (straight >= TURN) & (leap <= 0.2 * h) & (_misfit(part, a1, b1) <= RIGID * size[live])
        step[live] = np.where(good, np.minimum(1.4 * h, LONGEST_STEP * size[live]), 0.5 * h)
        stalled = ~good & (h < STALL * size[live])

        moved = live[good]
        a0, b0, a1, b1, h = a0[good], b0[good], a1[good], b1[good], h[good]
        da0, db0, da1, db1 = da0[good], db0[good], da1[good], db1[good]
        rate0, rate1 = rate0[good], rate1[good]
        chord = np.hypot(np.abs(a1 - a0), np.abs(b1 - b0))
        before = s[moved]
        for k, fraction in _crossings(rate0, rate1):
            toggles[moved[k]].append(float(before[k] + fraction * chord[k]))
        ended = np.zeros(moved.size, np.bool_)
        for j in range(m):
            ga, gb = goal_a[moved, j], goal_b[moved, j]
            ahead = _dot(da0, ga - a0) + _dot(db0, gb - b0)
            behind = _dot(da1, ga - a1) + _dot(db1, gb - b1)
            near = np.hypot(np.abs(ga - a0), np.abs(gb - b0)) <= 2.0 * chord
            maybe = np.flatnonzero((ahead > 1e-12 * size[moved]) & (behind <= 1e-12 * size[moved]) & near)
            if maybe.size == 0:
                continue
            those = moved[maybe]
            share = np.clip(ahead[maybe] / (ahead[maybe] - behind[maybe]), 0.0, 1.0)
            own = Linkages(*(field[those] for field in linkages))
            guess_a = a0[maybe] + share * (a1 - a0)[maybe]
            guess_b = b0[maybe] + share * (b1 - b0)[maybe]
            by_a = np.abs(da0[maybe]) + np.abs(da1[maybe]) >= np.abs(db0[maybe]) + np.abs(db1[maybe])
            held_a, held_b = _hold(own, np.where(by_a, ga[maybe], guess_a), np.where(by_a, guess_b, gb[maybe]), by_a)
            off = np.hypot(np.abs(held_a - ga[maybe]), np.abs(held_b - gb[maybe]))
            hit = off <= PASSED * size[those]
            met = before[maybe] + share * chord[maybe]
            if j == 0:
                length[those[hit]] = met[hit]
                ended[maybe[hit]] = True
            else:
                fresh = hit & np.isnan(arc[those, j])
                arc[those[fresh], j] = met[fresh]
        at_a[moved], at_b[moved], s[moved] = a1, b1, before + chord
        turned[moved] += np.angle(a1 / a0)
        trace.append((moved, s[moved], _sine(linkages, at_a, at_b)[moved], turned[moved]))
        gone = np.zeros(live.size, np.bool_)
        gone[good] = ended
        live = live[~gone & ~stalled]
    else:
        raise RuntimeError("a circuit did not close")
    return _circuit(arc, length, toggles, sine, trace)


def _pad(field: NDArray[Any], widths: tuple[tuple[int, int], tuple[int, int]]) -> NDArray[Any]:
    return np.pad(field, widths, constant_values=np.nan) if any(map(any, widths)) else field


def _circuit(
    arc: Real,
    length: Real,
    toggles: list[list[float]],
    sine: Real,
    trace: list[tuple[NDArray[np.int64], Real, Real, Real]],
) -> Circuit:
    n = len(length)
    closed = np.where(np.isnan(length), np.inf, length)
    kept = [[t for t in row if t <= closed[k]] for k, row in enumerate(toggles)]
    count = np.array([len(row) for row in kept], np.int64)
    toggle_arc = np.full((n, max(int(count.max(initial=0)), 1)), np.nan)
    for k, row in enumerate(kept):
        toggle_arc[k, : len(row)] = row
    with np.errstate(invalid="ignore"):
        branch = (toggle_arc[:, None, :] < arc[:, :, None]).sum(axis=-1)
    branch = np.where(count[:, None] > 0, branch % np.maximum(count, 1)[:, None], 0)
    branch = np.where(np.isnan(arc), -1, branch)
    traced = np.full((3, n, len(trace)), np.nan)
    for k, (rows, *values) in enumerate(trace):
        traced[:, rows, k] = values
    return Circuit(arc, length, count, toggle_arc, branch, sine, *traced)


def _crossings(before: Real, after: Real) -> list[tuple[int, float]]:
    """Steps in which the input turns back, and the share of the step at which it does."""
    turned = np.flatnonzero((before > 0.0) != (after > 0.0))
    return [(int(k), float(before[k] / (before[k] - after[k]))) for k in turned]


def _direction(linkages: Linkages, pin_a: Complex, pin_b: Complex) -> tuple[Real, Complex, Complex]:
    """Rate of the input, and the unit direction in which the joints move."""
    p, q, r = pin_a - linkages.o2, pin_b - pin_a, pin_b - linkages.o4
    da, db = _dot(q, 1j * r) * 1j * p, _dot(q, 1j * p) * 1j * r
    norm = np.hypot(np.abs(da), np.abs(db))
    with np.errstate(divide="ignore", invalid="ignore"):
        return _dot(q, 1j * r), da / norm, db / norm


def _hold(linkages: Linkages, pin_a: Complex, pin_b: Complex, by_a: Mask) -> tuple[Complex, Complex]:
    """Put the joint that is held back on its circle and bring the other one to the rigid lengths by Newton."""
    held_centre = np.where(by_a, linkages.o2, linkages.o4)
    held_radius = np.where(by_a, linkages.a, linkages.c)
    free_centre = np.where(by_a, linkages.o4, linkages.o2)
    free_radius = np.where(by_a, linkages.c, linkages.a)
    held, free = np.where(by_a, pin_a, pin_b), np.where(by_a, pin_b, pin_a)
    spoke = held - held_centre
    held = held_centre + held_radius * spoke / np.abs(spoke)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(5):
            free = newton_step(free, held, linkages.b, free_centre, free_radius)
    return np.where(by_a, held, free), np.where(by_a, free, held)


def _misfit(linkages: Linkages, pin_a: Complex, pin_b: Complex) -> Real:
    """Largest error of a rigid length."""
    errors = (
        np.abs(pin_a - linkages.o2) - linkages.a,
        np.abs(pin_b - pin_a) - linkages.b,
        np.abs(pin_b - linkages.o4) - linkages.c,
    )
    return np.max(np.abs(errors), axis=0)


def _sine(linkages: Linkages, pin_a: Complex, pin_b: Complex) -> Real:
    q, r = pin_b - pin_a, pin_b - linkages.o4
    return np.abs(_dot(q, 1j * r)) / (linkages.b * linkages.c)


def _dot(u: Complex, v: Complex) -> Real:
    return u.real * v.real + u.imag * v.imag
