"""Branches of mechanisms that close by dyads, by elimination: all real roots of polynomials.

Nothing of the package is used. A point is a pair (z, z̄) of independent complex numbers, a link's rotation a pair
(u, ū) with u ū = 1. Then a dyad closes by a square root whose radicand D is rational in what is known before, for real
and imaginary configurations alike:

    two links        (j − p) = (h ± i√D)/d̄,    d = q − p,  h = (d d̄ + b² − c²)/2,           D = b² d d̄ − h²
    link and slide   n̄ (j − p) = h ± i√D,      h = (n̄ (x − p) + n (x̄ − p̄))/2,              D = b² − h²
    slide in a link  u = (r ± i√D)/(n d̄),      d = q − p,                                     D = d d̄ − r²

The product of a radicand over all assemblies before it has no square root left in it: it is rational in e^{iθ}, and
with powers of the d d̄ a polynomial, for all its denominators. On segments of the circle it is expanded in Chebyshev's
polynomials to rounding, and all roots of these are eigenvalues of a matrix: the only inputs at which an assembly can
begin or end.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Real

ORDER = 24
NODES = np.cos(np.pi * (np.arange(ORDER) + 0.5) / ORDER)
TO_COEFFICIENTS = 2.0 / ORDER * np.cos(np.outer(np.arccos(NODES), np.arange(ORDER)))
TO_COEFFICIENTS[:, 0] *= 0.5

TAIL = 1e-11
"""A series has ended when its last coefficients are below this share of the largest."""

OFF_LINE = 1e-3
"""Roots nearer than this to the real segment are tried: rounding moves double ones off it."""

BRACKET = 2e-14
"""Roots are enclosed to this, radians: some units of the last place of an input."""

DEPTH = 40
"""Halvings of a segment at most."""

Pair = tuple[Complex, Complex]


class Piece(NamedTuple):
    """One assembly from ``low`` to ``high`` (or all round), and the numbers of the dyads that fold flat there."""

    low: float
    high: float
    full: bool
    choice: tuple[int, ...]
    low_fold: int
    high_fold: int


class Undecided(Exception):
    """A product that no series of this order gives on however short a segment."""


class Elimination:
    """One design; ``gears`` are (first, second, ratio) with the input as the first."""

    def __init__(
        self,
        joints: Mapping[str, complex],
        links: Mapping[str, Sequence[str]],
        slides: Sequence[tuple[str, str, complex, float]],
        gears: Sequence[tuple[str, str, float]],
        input: str,
        turns: int = 1,
    ) -> None:
        origin = np.mean(list(joints.values()))
        size = max(abs(z - origin) for z in joints.values())
        self.joints = {name: (complex(z) - origin) / size for name, z in joints.items()}
        self.slides = [(j, link, (complex(x) - origin) / size, angle) for j, link, x, angle in slides]
        self.size = float(size)
        self.links, self.gears, self.input, self.turns = links, gears, input, turns
        pivot = next(joint for joint in links[input] if joint in links["ground"])
        tip = next(joint for joint in links[input] if joint != pivot)
        self.pivot, self.start = pivot, float(np.angle(self.joints[tip] - self.joints[pivot]))
        if links[input][0] == pivot:
            self.start = float(np.angle(self.joints[links[input][1]] - self.joints[pivot]))
        self.count = len(self.radicands(np.zeros(1), [1] * 9)[0])

    @classmethod
    def of(cls, mechanism: Any, turns: int = 1) -> Elimination:
        """One design of a description with the same words."""
        slides = [(s.joint, s.link, complex(s.point), float(s.angle)) for s in mechanism.slides]
        joints = {name: complex(z) for name, z in mechanism.joints.items()}
        return cls(joints, mechanism.links, slides, [tuple(g) for g in mechanism.gears], mechanism.input, turns)

    def radicands(self, theta: ArrayLike, choice: Sequence[int]) -> tuple[list[Complex], list[Complex]]:
        """Radicand of each dyad, and d d̄ (1 where nothing is divided by), at inputs, for one choice of assemblies."""
        return self.configurations(theta, choice)[:2]

    def configurations(
        self, theta: ArrayLike, choice: Sequence[int]
    ) -> tuple[list[Complex], list[Complex], dict[str, Pair]]:
        """The same and every joint as a pair (z, z̄)."""
        turned = np.asarray(theta, complex) - self.start
        one = np.ones_like(turned)
        poses: dict[str, tuple[Complex, Complex]] = {"ground": (one, one)}
        points: dict[str, Pair] = {}
        for joint in self.links["ground"]:
            points[joint] = self.joints[joint] * one, np.conj(self.joints[joint]) * one

        def known(link: str, pin: str, u: Complex, v: Complex) -> None:
            poses[link] = u, v
            base = self.joints[pin]
            for joint in self.links[link]:
                arm = self.joints[joint] - base
                points.setdefault(joint, (points[pin][0] + u * arm, points[pin][1] + v * np.conj(arm)))

        known(self.input, self.pivot, np.exp(1j * turned), np.exp(-1j * turned))
        for first, second, ratio in self.gears:
            assert first == self.input
            pin = next(joint for joint in self.links[second] if joint in self.links["ground"])
            known(second, pin, np.exp(1j * ratio * turned), np.exp(-1j * ratio * turned))
        radicands: list[Complex] = []
        divisors: list[Complex] = []
        signs = iter(choice)
        while len(poses) < len(self.links):
            if not (self._slide(poses, points, known, radicands, divisors, signs)):
                self._links(poses, points, known, radicands, divisors, signs)
        return radicands, divisors, points

    def _slide(
        self, poses: Any, points: Any, known: Any, radicands: list[Complex], divisors: list[Complex], signs: Any
    ) -> bool:
        z = self.joints
        for joint, line, x, angle in self.slides:
            normal = 1j * np.exp(1j * angle)
            if line in poses and joint not in points:
                link = next(w for w in self.links if w not in poses and joint in self.links[w])
                pin = next((j for j in self.links[link] if j in points), None)
                if pin is None:
                    continue
                u, v = poses[line]
                at = next(j for j in self.links[line] if j in points)
                n, m = u * normal, v * np.conj(normal)
                place = points[at][0] + u * (x - z[at]), points[at][1] + v * np.conj(x - z[at])
                h = (m * (place[0] - points[pin][0]) + n * (place[1] - points[pin][1])) / 2.0
                arm = z[joint] - z[pin]
                d = abs(arm) ** 2 - h * h
                root = 1j * next(signs) * np.sqrt(d)
                radicands.append(d)
                divisors.append(np.ones_like(d))
                known(link, pin, n * (h + root) / arm, m * (h - root) / np.conj(arm))
                return True
            if line not in poses and joint in points:
                pin = next((j for j in self.links[line] if j in points and j != joint), None)
                if pin is None:
                    continue
                r = (np.conj(normal) * (x - z[pin])).real
                d0, d1 = points[joint][0] - points[pin][0], points[joint][1] - points[pin][1]
                d = d0 * d1 - r * r
                root = 1j * next(signs) * np.sqrt(d)
                radicands.append(d)
                divisors.append(d0 * d1)
                known(line, pin, (r + root) / (normal * d1), (r - root) / (np.conj(normal) * d0))
                return True
        return False

    def _links(
        self, poses: Any, points: Any, known: Any, radicands: list[Complex], divisors: list[Complex], signs: Any
    ) -> None:
        z = self.joints
        open_links = [w for w in self.links if w not in poses and any(j in points for j in self.links[w])]
        one, other, joint = next(
            (one, other, joint)
            for one, other in itertools.combinations(open_links, 2)
            for joint in self.links[one]
            if joint in self.links[other] and joint not in points
        )
        p, q = (next(j for j in self.links[w] if j in points) for w in (one, other))
        first, second = z[joint] - z[p], z[joint] - z[q]
        d0, d1 = points[q][0] - points[p][0], points[q][1] - points[p][1]
        h = (d0 * d1 + (abs(first) - abs(second)) * (abs(first) + abs(second))) / 2.0
        d = abs(first) ** 2 * d0 * d1 - h * h
        root = 1j * next(signs) * np.sqrt(d)
        radicands.append(d)
        divisors.append(d0 * d1)
        to = (h + root) / d1, (h - root) / d0
        known(one, p, to[0] / first, to[1] / np.conj(first))
        known(other, q, (to[0] - d0) / second, (to[1] - d1) / np.conj(second))

    # -- roots ---------------------------------------------------------------------------------------------------------

    def _product(self, level: int, theta: Real) -> Real:
        """Product of a radicand over all assemblies before it, with the divisors that clear its denominators."""
        values = np.ones(theta.shape)
        for choice in itertools.product((1, -1), repeat=level):
            radicands, divisors = self.radicands(theta, [*choice, *([1] * 9)])
            factor = radicands[level]
            for divisor in divisors[:level]:
                factor = factor * divisor**2
            values = values * factor
        return np.asarray(values.real)

    def candidates(self, level: int) -> Real:
        """Inputs near which a radicand may vanish, for any choice: all roots of the product, [0, 2π turns)."""
        return self.roots(lambda theta: self._product(level, theta))

    def roots(self, function: Callable[[Real], Real]) -> Real:
        """Inputs near which a function that is smooth all round may vanish, [0, 2π turns)."""
        low = 2.0 * np.pi * np.arange(16 * self.turns) / 16.0
        width = np.full(len(low), 2.0 * np.pi / 16.0)
        found: list[float] = []
        for _ in range(DEPTH):
            theta = low[:, None] + 0.5 * width[:, None] * (1.0 + NODES)
            coefficients = function(theta) @ TO_COEFFICIENTS
            size = np.abs(coefficients)
            resolved = size[:, -4:].max(axis=1) <= TAIL * size.max(axis=1)
            for k in np.flatnonzero(resolved & (size[:, 0] <= size[:, 1:].sum(axis=1))):
                series = coefficients[k]
                roots = chebyshev.chebroots(series[: int(np.flatnonzero(size[k] > 1e-16 * size[k].max())[-1]) + 1])
                inside = (np.abs(roots.imag) < OFF_LINE) & (np.abs(roots.real) < 1.0 + OFF_LINE)
                found += list(low[k] + 0.5 * width[k] * (1.0 + roots[inside].real))
            if resolved.all():
                return np.mod(np.array(found), 2.0 * np.pi * self.turns)
            half = 0.5 * width[~resolved]
            low, width = np.concatenate([low[~resolved], low[~resolved] + half]), np.concatenate([half, half])
        raise Undecided("a product that has no series")

    def branches(self) -> list[tuple[float, float, bool]]:
        """All branches as (low, high, whether full), low within the period, sorted; one for each assembly."""
        return sorted((piece.low, piece.high, piece.full) for piece in self.pieces())

    def pieces(self) -> list[Piece]:
        """The same with their assemblies, and the dyads that are folded flat at their ends."""
        period = 2.0 * np.pi * self.turns
        found: list[Piece] = []
        per_level = [self.candidates(level) for level in range(self.count)]
        for choice in itertools.product((1, -1), repeat=self.count):
            folds: dict[float, int] = {}
            for level in range(self.count):
                # Folds of the dyads before bound where this one's radicand is real: its sign may differ across a gap.
                near = np.concatenate(per_level[: level + 1])
                for cut in np.mod(self._polished(level, near, choice), period):
                    folds.setdefault(round(float(cut), 13), level)
            cuts = sorted(folds)
            if not cuts:
                if self._exists(np.array([0.1]), choice).all():
                    found.append(Piece(0.0, period, True, choice, -1, -1))
                continue
            ends = [*cuts, cuts[0] + period]
            inside = self._exists(0.5 * (np.array(ends[:-1]) + ends[1:]), choice).tolist()
            if all(inside):
                found.append(Piece(0.0, period, True, choice, -1, -1))
                continue
            first = inside.index(False)
            k = 1
            while k <= len(inside):
                here = (first + k) % len(inside)
                if inside[here]:
                    low = cuts[here]
                    while inside[(first + k) % len(inside)]:
                        k += 1
                    high = cuts[(first + k) % len(inside)]
                    way = float(np.mod(high - low, period))
                    found.append(Piece(low, low + way, False, choice, folds[low], folds[high]))
                k += 1
        return found

    def _real(self, theta: Real, choice: Sequence[int]) -> Real:
        """Radicands at real inputs, shape (dyads, n); the later ones are NaN where an earlier one is negative."""
        values = np.array([d.real for d in self.radicands(theta, choice)[0]])
        lost = np.cumsum(values < 0.0, axis=0) > 0
        values[1:][lost[:-1]] = np.nan
        return values

    def _exists(self, theta: Real, choice: Sequence[int]) -> NDArray[np.bool_]:
        return np.asarray((self._real(theta, choice) > 0.0).all(axis=0))

    def _polished(self, level: int, near: Real, choice: Sequence[int]) -> list[float]:
        """Where the radicand of one choice changes its sign next to candidates, by bisection between them."""
        if not len(near):
            return []
        period = 2.0 * np.pi * self.turns
        # Between two neighbouring candidates (clusters of them apart) there is no root, so that middles show all.
        near = np.sort(near)
        middles = np.concatenate([near[:-1] + np.diff(near) / 2.0, [(near[-1] + near[0] + period) / 2.0]])
        points = np.concatenate([middles, near])
        for spread in (1e-3, 1e-5, 1e-7, 1e-9, 1e-11):
            points = np.concatenate([points, near - spread, near + spread])
        points = np.unique(np.mod(points, period))
        points = np.append(points, points[0] + period)
        values = self._real(points, choice)[level]
        with np.errstate(invalid="ignore"):
            change = (values[:-1] > 0.0) != (values[1:] > 0.0)
        change &= np.isfinite(values[:-1]) & np.isfinite(values[1:])
        low, high, start = points[:-1][change], points[1:][change], values[:-1][change] > 0.0
        if not len(low):
            return []
        while (high - low).max() > BRACKET:
            middle = 0.5 * (low + high)
            same = (self._real(middle, choice)[level] > 0.0) == start
            low, high = np.where(same, middle, low), np.where(same, high, middle)
        return [float(x) for x in 0.5 * (low + high)]
