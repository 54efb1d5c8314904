"""A linkage of any kind driven from its skeleton alone: joints that keep their distances, and their lines.

Unknown are the places of all joints that neither the ground nor the input holds. Each link keeps the distance of the
two of its joints that are farthest apart, its other joints keep their place relative to these, and a joint on a slide
keeps its distance from the slide's line. Newton's iteration solves this for many inputs at once; from one input to the
next leads a prediction along the tangent, in steps that are halved until it hits.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np

from kinematics.arrays import Complex, Real

NEWTON = 10
"""Iterations at most: quadratic convergence from a good prediction needs four."""

CLOSED = 1e-9
"""Misfit of the conditions, as a share of the linkage's size, above which a linkage does not close."""

STEP, HIT, HALVINGS = math.radians(2.0), 2e-3, 14
"""Greatest step of the input, how far a prediction may be off as a share of the size, and how often a step halves."""

Condition = Callable[[Complex], tuple[Real, dict[int, Complex]]]
"""Misfits (n,) at joints (n, joints), and gradients (n,) by joint: a joint that moves by dz adds Re(conj(g) dz)."""


class Drive:
    """A skeleton with its input: ``turn`` is what the input has moved from the skeleton's own configuration.

    Radians where it turns, length units where it slides.
    """

    def __init__(self, skeleton: Any) -> None:
        self.names = list(skeleton.joints)
        self.home = np.array([complex(*place) for place in skeleton.joints.values()])
        self.links = {link.name: [self.names.index(joint) for joint in link.joints] for link in skeleton.links}
        self.slides = [
            (self.names.index(s.joint), s.link, complex(*s.point), cmath.rect(1.0, math.radians(s.angle)))
            for s in skeleton.slides
        ]
        self.size = float(np.abs(self.home[:, None] - self.home).max())
        ground = self.links["ground"]
        self.turning: dict[int, tuple[int, float]] = {}
        """Joints that turn about a joint of the ground, with how far for a turn of the input."""
        self.sliding: dict[int, complex] = {}
        """Joints that the input moves along a line."""
        self.slides_in = skeleton.input_link not in self.links
        if self.slides_in:
            joint = self.names.index(skeleton.input_link)
            self.sliding[joint] = next(u for j, link, _, u in self.slides if (j, link) == (joint, "ground"))
            self.reference = 0.0
        else:
            rates = {skeleton.input_link: 1.0} | {g.links[1]: g.ratio for g in skeleton.gears}
            for link, rate in rates.items():
                pivot = next(joint for joint in self.links[link] if joint in ground)
                self.turning |= {j: (pivot, rate) for j in self.links[link] if j != pivot}
            pins = [j for j in self.links[skeleton.input_link] if j not in ground]
            self.reference = float(np.angle(self.home[pins[0]] - self.home[self.turning[pins[0]][0]]))
        self.known = {*ground, *self.turning, *self.sliding}
        self.free = [j for j in range(len(self.names)) if j not in self.known]
        self.conditions: list[Condition] = []
        for name, joints in self.links.items():
            if not set(joints) <= self.known:
                self._link(joints)
            for joint, link, point, along in self.slides:
                if link == name and (joint not in self.known or not set(joints) <= self.known):
                    self._slide(joint, joints, point, along, moves=name != "ground")
        if len(self.conditions) != 2 * len(self.free):
            raise ValueError(f"{len(self.conditions)} conditions for {2 * len(self.free)} unknowns")
        self.nodes = np.zeros(1)
        self.places = self.home[None]
        self.rates = self._rates(self.nodes, self.places)
        self.sense = self._sense(self.home)

    def _link(self, joints: list[int]) -> None:
        home = self.home
        i, j = max(combinations(joints, 2), key=lambda pair: abs(home[pair[0]] - home[pair[1]]))
        length = abs(home[j] - home[i])

        def distance(z: Complex) -> tuple[Real, dict[int, Complex]]:
            d = z[:, j] - z[:, i]
            return (np.abs(d) ** 2 - length**2) / (2.0 * length), {j: d / length, i: -d / length}

        if not {i, j} <= self.known:
            self.conditions.append(distance)
        for k in joints:
            if k in (i, j):
                continue
            share = (home[k] - home[i]) / (home[j] - home[i])
            for part in (1.0 + 0j, -1j):  # real and imaginary part

                def rigid(z: Complex, k: int = k, c: complex = share, part: complex = part) -> Any:
                    gap = part * (z[:, k] - z[:, i] - c * (z[:, j] - z[:, i]))
                    one = np.full(len(z), np.conj(part))
                    return gap.real, {k: one, j: -one * np.conj(c), i: -one * np.conj(1.0 - c)}

                self.conditions.append(rigid)

    def _slide(self, joint: int, joints: list[int], point: complex, along: complex, *, moves: bool) -> None:
        home = self.home
        if not moves:

            def on_ground(z: Complex) -> tuple[Real, dict[int, Complex]]:
                return ((z[:, joint] - point) * np.conj(along)).imag, {joint: np.full(len(z), 1j * along)}

            self.conditions.append(on_ground)
            return
        i, j = max(combinations(joints, 2), key=lambda pair: abs(home[pair[0]] - home[pair[1]]))
        length = abs(home[j] - home[i])
        w = along * length / (home[j] - home[i])
        off = float(((point - home[i]) * np.conj(along)).imag)

        def on_link(z: Complex) -> tuple[Real, dict[int, Complex]]:
            e, q = (z[:, j] - z[:, i]) * w / length, z[:, joint] - z[:, i]
            turn = -1j * q * np.conj(w) / length
            return (q * np.conj(e)).imag - off, {joint: 1j * e, j: turn, i: -1j * e - turn}

        self.conditions.append(on_link)

    def _held(self, turns: Real) -> dict[int, Complex]:
        """Joints that the input moves."""
        at = {
            j: self.home[p] + (self.home[j] - self.home[p]) * np.exp(1j * r * turns)
            for j, (p, r) in self.turning.items()
        }
        return at | {j: self.home[j] + u * turns for j, u in self.sliding.items()}

    def _system(self, z: Complex) -> tuple[Real, Real, list[dict[int, Complex]]]:
        """Misfits (n, m), their derivatives by the unknowns (n, m, m), and the gradients."""
        misfits, matrix = np.empty((len(z), len(self.conditions))), np.zeros((len(z),) + 2 * (len(self.conditions),))
        gradients = []
        for row, condition in enumerate(self.conditions):
            misfits[:, row], gradient = condition(z)
            for column, joint in enumerate(self.free):
                if joint in gradient:
                    matrix[:, row, 2 * column] = gradient[joint].real
                    matrix[:, row, 2 * column + 1] = gradient[joint].imag
            gradients.append(gradient)
        return misfits, matrix, gradients

    def _sense(self, places: Complex) -> float:
        """The sign of the determinant of the conditions, which no branch changes."""
        _, matrix, _ = self._system(places[None])
        return float(np.linalg.slogdet(matrix[0])[0])

    def _rates(self, turns: Real, z: Complex) -> Complex:
        """Derivatives of all joints by the input, (n, joints)."""
        rates = np.zeros_like(z)
        for joint, (pivot, rate) in self.turning.items():
            rates[:, joint] = 1j * rate * (z[:, joint] - self.home[pivot])
        for joint, along in self.sliding.items():
            rates[:, joint] = along
        _, matrix, gradients = self._system(z)
        pushed = np.stack(
            [sum((np.conj(g) * rates[:, j]).real for j, g in gradient.items()) for gradient in gradients], axis=1
        )
        found = _solved(matrix, -pushed)
        rates[:, self.free] = found[:, ::2] + 1j * found[:, 1::2]
        return rates

    def closed(self, turns: Real, guess: Complex) -> Complex:
        """Joints (n, joints) at turns (n,), from places near them; NaN where the linkage does not close."""
        z = guess.copy()
        for joint, places in self._held(turns).items():
            z[:, joint] = places
        for _ in range(NEWTON):
            misfits, matrix, _ = self._system(z)
            if not np.abs(misfits).max() > 1e-15 * self.size:
                break
            step = _solved(matrix, -misfits)
            z[:, self.free] += step[:, ::2] + 1j * step[:, 1::2]
            if np.abs(step).max() <= 1e-15 * self.size:
                break
        misfits, _, _ = self._system(z)
        z[~(np.abs(misfits).max(axis=1) <= CLOSED * self.size)] = complex(math.nan, math.nan)
        return z

    def follow(self, low: float, high: float) -> bool:
        """Go on from where the linkage was followed so far until these turns are reached; whether they are."""
        return all(self._reach(end) for end in (low, high))

    def _reach(self, end: float) -> bool:
        forward = end > self.nodes[-1]
        if not forward and end >= self.nodes[0]:
            return True
        here = -1 if forward else 0
        turn, place, rate = float(self.nodes[here]), self.places[here], self.rates[here]
        longest = STEP if not self.slides_in else 0.005 * self.size
        step = longest
        turns, places, rates = [], [], []
        while turn != end:
            way = min(step, abs(end - turn))
            to = end if way == abs(end - turn) else turn + (way if forward else -way)
            ahead = place + rate * (to - turn)
            there = self.closed(np.array([to]), ahead[None])[0]
            hit = np.abs(there - ahead).max() <= HIT * self.size
            # The other branch, near by at a toggle, has a determinant of the other sign.
            if not hit or self._sense(there) != self.sense:
                step *= 0.5
                if step < longest / 2**HALVINGS:
                    return False
                continue
            turn, place = to, there
            rate = self._rates(np.array([turn]), place[None])[0]
            turns.append(turn)
            places.append(place)
            rates.append(rate)
            step = min(1.5 * step, longest)
        order = slice(None) if forward else slice(None, None, -1)
        parts = [(self.nodes, turns), (self.places, places), (self.rates, rates)]
        joined = [np.concatenate((old, new) if forward else (new[order], old)) for old, new in parts]
        self.nodes, self.places, self.rates = joined
        return True

    def at(self, turns: Real) -> Complex:
        """Joints at turns within those that were followed, shape (n, joints)."""
        k = np.clip(np.searchsorted(self.nodes, turns) - 1, 0, len(self.nodes) - 2)
        wide = self.nodes[k + 1] - self.nodes[k]
        u, wide = ((turns - self.nodes[k]) / wide)[:, None], wide[:, None]
        # Hermite's cubic.
        guess = (1.0 + 2.0 * u) * (1.0 - u) ** 2 * self.places[k] + u * (1.0 - u) ** 2 * wide * self.rates[k]
        guess += u**2 * (3.0 - 2.0 * u) * self.places[k + 1] - u**2 * (1.0 - u) * wide * self.rates[k + 1]
        return self.closed(turns, guess)

    def rates_at(self, turns: Real) -> Complex:
        """Derivatives of the joints by the input, shape (n, joints)."""
        return self._rates(turns, self.at(turns))

    def joint(self, name: str, turns: Real) -> Complex:
        """Places of one joint."""
        return np.asarray(self.at(turns)[:, self.names.index(name)])


def _solved(matrix: Real, right: Real) -> Real:
    try:
        return np.asarray(np.linalg.solve(matrix, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        return np.full_like(right, math.nan)
