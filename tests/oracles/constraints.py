"""Any planar mechanism by its constraints alone: rigid lengths, points on lines, gear angles.

Nothing of the package is used, and no dyad, no closed form, no loop of angles. The unknowns are the coordinates of the
moving joints in a unit frame and the input's way t from the reference (radians, or displacement in unit lengths):

    length     |z_i − z_j|² = L²                      once a link, between its two joints farthest apart
    shape      z_k = z_i + s (z_j − z_i)              for every further joint of the link
    driven     z_j = z_i + w e^{iλt}                  for the input link (λ = 1) and links geared to it
    pushed     z_j = w + e t                          for the joint of the input slide
    line       n · (x − p) = 0                        p and the normal n fixed in a link

There is one equation less than there are unknowns, so that configurations form curves, the circuits. They are followed
by their arc length, in steps that are refused and halved where the tangent turns more than a little, so that the input
may turn back on the way. With the tangent below them the equations' derivatives have a determinant that never changes
its sign on a curve, but does from one arm to the other where two curves come close: such a step is a leap, and refused.
Everything takes many designs at once, shape (n,).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinematics.arrays import Complex, Real

TURN = 0.985
"""Least cosine between the tangents at both ends of a step: ten degrees."""

LONGEST_STEP = 0.1
SHORTEST_STEP = 1e-10
RIGID = 1e-13
"""Newton's iteration ends at this residual in unit coordinates."""

SAME = 1e-6
"""Two configurations are one when all joints agree to this."""


class Line(NamedTuple):
    """A joint on a line through ``point`` at ``angle``, fixed in ``link``, in the reference."""

    joint: str
    link: str
    point: ArrayLike
    angle: ArrayLike


class Constraints:
    """The constraints of n designs of one topology, in unit coordinates.

    ``gears`` are (first, second, ratio) with the input as one of the two; ``input`` a link pinned to the ground, or the
    joint of a slide on the ground.
    """

    def __init__(
        self,
        joints: Mapping[str, ArrayLike],
        links: Mapping[str, Sequence[str]],
        slides: Iterable[Line],
        gears: Iterable[tuple[str, str, float]],
        input: str,
    ) -> None:
        points = dict(zip(joints, np.broadcast_arrays(*(np.atleast_1d(z) for z in joints.values())), strict=True))
        slides = tuple(slides)
        n = max(
            [next(iter(points.values())).shape[0]]
            + [np.size(s.point) for s in slides]
            + [np.size(s.angle) for s in slides]
        )
        points = {name: np.broadcast_to(z, (n,)).astype(np.complex128) for name, z in points.items()}
        stacked = np.stack(list(points.values()))
        self.origin = stacked.mean(axis=0)
        self.size = np.abs(stacked - self.origin).max(axis=0)
        self.reference = {name: (z - self.origin) / self.size for name, z in points.items()}
        self.fixed = set(links["ground"])
        self.moving = [name for name in joints if name not in self.fixed]
        self.column = {name: k for k, name in enumerate(self.moving)}
        self.n, self.width = n, 2 * len(self.moving) + 1
        self.rows: list[tuple[Any, ...]] = []
        self.pushed = input not in links
        ratios = {input: 1.0}
        for first, second, ratio in gears:
            ratios |= {second: ratio} if first == input else {first: 1.0 / ratio}
        self.base: dict[str, tuple[str, str]] = {}
        for link, listed in links.items():
            if link != "ground":
                self._link(link, listed, ratios.get(link))
        for slide in slides:
            self._slide(slide, input)
        self.count = sum(1 if row[0] in ("length", "line") else 2 for row in self.rows)
        assert self.count == self.width - 1, (self.count, self.width)

    @classmethod
    def of(cls, mechanism: Any) -> Constraints:
        """The constraints of a description with the same words: joints, links, slides, gears and input."""
        lines = [Line(s.joint, s.link, np.ravel(s.point), np.ravel(s.angle)) for s in mechanism.slides]
        gears = [tuple(gear) for gear in mechanism.gears]
        joints = {name: np.ravel(z) for name, z in mechanism.joints.items()}
        return cls(joints, mechanism.links, lines, gears, mechanism.input)

    def take(self, index: ArrayLike) -> Constraints:
        """Some of the designs, repeated as often as wanted."""
        index = np.asarray(index)
        part = object.__new__(Constraints)
        part.__dict__.update(self.__dict__)
        part.n = len(index)
        part.origin, part.size = self.origin[index], self.size[index]
        part.reference = {name: z[index] for name, z in self.reference.items()}
        part.rows = [
            tuple(item[index] if isinstance(item, np.ndarray) and item.ndim else item for item in row)
            for row in self.rows
        ]
        return part

    def _link(self, link: str, listed: Sequence[str], ratio: float | None) -> None:
        z = self.reference
        pinned = [joint for joint in listed if joint in self.fixed]
        pairs = [(i, j) for i in listed for j in listed if i < j]
        if ratio is not None and pinned:
            pairs = [(pinned[0], j) for j in listed if j != pinned[0]]
        i, j = max(pairs, key=lambda pair: float(np.min(np.abs(z[pair[1]] - z[pair[0]]))))
        self.base[link] = i, j
        arm = z[j] - z[i]
        if ratio is not None:
            self.rows.append(("driven", j, i, arm, ratio))
        else:
            self.rows.append(("length", i, j, np.abs(arm) ** 2))
        for k in listed:
            if k not in (i, j):
                self.rows.append(("shape", k, i, j, (z[k] - z[i]) / arm))

    def _slide(self, slide: Line, input: str) -> None:
        along = np.exp(1j * np.broadcast_to(np.asarray(slide.angle, float), (self.n,)))
        point = (np.broadcast_to(np.asarray(slide.point, complex), (self.n,)) - self.origin) / self.size
        if slide.link == "ground" and slide.joint == input:
            self.rows.append(("pushed", input, self.reference[input], along))
        elif slide.link == "ground":
            self.rows.append(("line", slide.joint, None, None, point, 1j * along))
        else:
            i, j = self.base[slide.link]
            arm = self.reference[j] - self.reference[i]
            self.rows.append(("line", slide.joint, i, j, (point - self.reference[i]) / arm, 1j * along / arm))

    # -- coordinates ---------------------------------------------------------------------------------------------------

    def pack(self, joints: Mapping[str, ArrayLike], way: ArrayLike) -> Real:
        """Unit coordinates (n, width) of joints given in the mechanism's own coordinates and the input's way."""
        x = np.empty((self.n, self.width))
        for name, k in self.column.items():
            z = (np.asarray(joints[name]) - self.origin) / self.size
            x[:, 2 * k], x[:, 2 * k + 1] = z.real, z.imag
        x[:, -1] = way
        return x

    def start(self) -> Real:
        """The reference configuration."""
        return self.pack({name: z * self.size + self.origin for name, z in self.reference.items()}, 0.0)

    def joints(self, x: Real) -> dict[str, Complex]:
        """Joints in the mechanism's own coordinates."""
        found = {name: z * self.size + self.origin for name, z in self.reference.items()}
        for name, k in self.column.items():
            found[name] = (x[:, 2 * k] + 1j * x[:, 2 * k + 1]) * self.size + self.origin
        return found

    # -- equations -----------------------------------------------------------------------------------------------------

    def evaluate(self, x: Real) -> tuple[Real, Real]:
        """Residuals (n, count) and their derivatives (n, count, width) by the unknowns."""
        value = np.zeros((self.n, self.count))
        slope = np.zeros((self.n, self.count, self.width))
        t = x[:, -1]

        def z(name: str) -> Complex:
            if name in self.fixed:
                return self.reference[name]
            k = self.column[name]
            return np.asarray(x[:, 2 * k] + 1j * x[:, 2 * k + 1])

        def gradient(row: int, name: str, g: ArrayLike) -> None:
            if name not in self.fixed:
                k = self.column[name]
                slope[:, row, 2 * k] += np.real(g)
                slope[:, row, 2 * k + 1] += np.imag(g)

        def linear(row: int, name: str, factor: ArrayLike) -> None:
            """A complex residual, in rows ``row`` and ``row + 1``, depends on factor · z."""
            gradient(row, name, np.conj(factor))
            gradient(row + 1, name, 1j * np.conj(factor))

        row = 0
        for kind, *rest in self.rows:
            if kind == "length":
                i, j, square = rest
                arm = z(i) - z(j)
                value[:, row] = (np.abs(arm) ** 2 - square) / 2.0
                gradient(row, i, arm)
                gradient(row, j, -arm)
                row += 1
                continue
            if kind == "line":
                joint, i, j, point, normal = rest
                if i is None:
                    value[:, row] = (np.conj(normal) * (z(joint) - point)).real
                    gradient(row, joint, normal)
                else:
                    arm = z(j) - z(i)
                    off, n = z(joint) - z(i) - point * arm, normal * arm
                    value[:, row] = (np.conj(n) * off).real
                    by_arm = np.conj(normal) * off - np.conj(point) * n
                    gradient(row, joint, n)
                    gradient(row, i, -n - by_arm)
                    gradient(row, j, by_arm)
                row += 1
                continue
            if kind == "shape":
                k, i, j, s = rest
                residual = z(k) - z(i) - s * (z(j) - z(i))
                linear(row, k, 1.0)
                linear(row, i, s - 1.0)
                linear(row, j, -s)
            elif kind == "driven":
                j, i, arm, ratio = rest
                turned = arm * np.exp(1j * ratio * t)
                residual, rate = z(j) - z(i) - turned, -1j * ratio * turned
                linear(row, j, 1.0)
                linear(row, i, -1.0)
                slope[:, row, -1], slope[:, row + 1, -1] = rate.real, rate.imag
            else:
                joint, origin, along = rest
                residual = z(joint) - origin - along * t
                linear(row, joint, 1.0)
                slope[:, row, -1], slope[:, row + 1, -1] = -along.real, -along.imag
            value[:, row], value[:, row + 1] = residual.real, residual.imag
            row += 2
        return value, slope

    def misfit(self, joints: Mapping[str, ArrayLike], way: ArrayLike) -> Real:
        """Largest residual of given joints, as a share of the size, shape (n,)."""
        return np.asarray(np.abs(self.evaluate(self.pack(joints, way))[0]).max(axis=1))

    # -- solving -------------------------------------------------------------------------------------------------------

    def solve(self, x: Real, steps: int = 12) -> tuple[Real, NDArray[np.bool_]]:
        """Newton's iteration at the given input; and where it ended at a configuration."""
        x = x.copy()
        for _ in range(steps):
            value, slope = self.evaluate(x)
            change = _solve(slope[:, :, :-1], value)
            length = np.abs(change).max(axis=1)
            x[:, :-1] -= change * np.minimum(1.0, 1.0 / np.maximum(length, 1e-300))[:, None]
            if np.all(length < RIGID):
                break
        value = np.abs(self.evaluate(x)[0]).max(axis=1)
        return x, value < 1e-11

    def all_configurations(self, design: int, way: float, rng: np.random.Generator, starts: int = 150) -> Real:
        """Every configuration of one design at an input, (k, width), by Newton from random starts."""
        many = self.take(np.full(starts, design))
        x = np.empty((starts, self.width))
        x[:, :-1] = rng.normal(0.0, 1.0, (starts, self.width - 1))
        x[:, -1] = way
        x, good = many.solve(x, 60)
        found: list[Real] = []
        for row in x[good]:
            if all(np.abs(row - other).max() > SAME for other in found):
                found.append(row)
        return np.array(found).reshape(-1, self.width)

    def tangent(self, x: Real, last: Real) -> Real:
        """Unit tangents of the circuits, on the side of ``last``."""
        slope = np.concatenate([self.evaluate(x)[1], last[:, None, :]], axis=1)
        right = np.zeros((self.n, self.width))
        right[:, -1] = 1.0
        found = _solve(slope, right)
        return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])

    def correct(self, x: Real, tangent: Real) -> tuple[Real, NDArray[np.bool_]]:
        """Newton's iteration in the plane through x normal to the tangent."""
        origin, x = x, x.copy()
        for _ in range(8):
            value, slope = self.evaluate(x)
            off = ((x - origin) * tangent).sum(axis=1)
            change = _solve(
                np.concatenate([slope, tangent[:, None, :]], axis=1), np.concatenate([value, off[:, None]], axis=1)
            )
            x = x - change
            if np.all(np.abs(change) < RIGID):
                break
        return x, np.abs(self.evaluate(x)[0]).max(axis=1) < 1e-12

    def orientation(self, x: Real, tangent: Real) -> Real:
        """Sign of the determinant of the derivatives with the tangent below them."""
        return np.asarray(np.linalg.slogdet(np.concatenate([self.evaluate(x)[1], tangent[:, None, :]], axis=1))[0])

    def follow(
        self,
        x: Real,
        side: ArrayLike = 1.0,
        limit: ArrayLike = np.inf,
        to_toggle: bool = False,
        steps: int = 6000,
    ) -> list[Trace]:
        """Each design's circuit from a configuration, first towards rising (side +1) or falling input.

        A trace ends where the circuit closes, where the input's way passes ``limit`` (away from the start), or with
        ``to_toggle`` after the first step in which the input turns back.
        """
        n, live = self.n, np.arange(self.n)
        rise = np.zeros((n, self.width))
        rise[:, -1] = np.broadcast_to(side, (n,))
        at, direction, step = x.copy(), self.tangent(x, rise), np.full(n, 0.02)
        direction = direction * np.where(direction[:, -1] * rise[:, -1] < 0.0, -1.0, 1.0)[:, None]
        start, first = x.copy(), direction.copy()
        limit = np.broadcast_to(np.asarray(limit, float), (n,))
        hand = self.orientation(at, direction)
        paths: list[list[tuple[Real, Real]]] = [[(start[k], first[k])] for k in range(n)]
        ended = ["" for _ in range(n)]
        for _ in range(steps):
            if not len(live):
                break
            part = self.take(live)
            h = step[live][:, None]
            guess = at[live] + h * direction[live]
            new, good = part.correct(guess, direction[live])
            turned = part.tangent(new, direction[live])
            good &= (turned * direction[live]).sum(axis=1) >= TURN
            good &= np.abs(new - guess).max(axis=1) <= 0.2 * h[:, 0]
            good &= part.orientation(new, turned) == hand[live]
            step[live] = np.where(good, np.minimum(1.5 * step[live], LONGEST_STEP), 0.5 * step[live])
            done = np.zeros(len(live), bool)
            for n_live in range(len(live)):
                k = live[n_live]
                if not good[n_live]:
                    if step[k] < SHORTEST_STEP:
                        ended[k], done[n_live] = "stalled", True
                    continue
                before, after = at[k], new[n_live]
                if len(paths[k]) > 2 and self._passes(k, start[k], first[k], before, after):
                    ended[k], done[n_live] = "closed", True
                elif to_toggle and turned[n_live][-1] * first[k, -1] < 0.0:
                    ended[k], done[n_live] = "toggle", True
                elif abs(after[-1] - start[k, -1]) > limit[k]:
                    ended[k], done[n_live] = "limit", True
                at[k], direction[k] = after, turned[n_live]
                paths[k].append((after, turned[n_live]))
            live = live[~done]
        assert not len(live), "a circuit did not close"
        return [
            Trace(self.take([k]), np.array([p for p, _ in path]), np.array([d for _, d in path]), ended[k])
            for k, path in enumerate(paths)
        ]

    def _passes(self, design: int, start: Real, first: Real, before: Real, after: Real) -> bool:
        """Whether a step from before to after passes the start in its first direction, the input's turns apart."""
        there, here = (after - start)[:-1] @ first[:-1], (before - start)[:-1] @ first[:-1]
        step = np.abs(after - before)[:-1].max()
        if not here < 0.0 <= there or np.abs(before - start)[:-1].max() > 2.0 * step + 1e-9:
            return False
        met = before + here / (here - there) * (after - before)
        if np.abs(met - start)[:-1].max() > 0.1 * step + 1e-9:
            return False
        turns = 0.0 if self.pushed else np.round((met[-1] - start[-1]) / (2.0 * np.pi))
        met[-1] = start[-1] + turns * 2.0 * np.pi
        found, good = self.take([design]).solve(met[None])
        return bool(good[0]) and bool(np.abs(found[0] - start)[:-1].max() < SAME)


@dataclass(frozen=True, eq=False)
class Trace:
    """One circuit from a configuration on: points (k, width), tangents (k, width), and how it ended."""

    constraints: Constraints
    points: Real
    tangents: Real
    ended: str

    @property
    def turned_back(self) -> int:
        """Points after the toggle at which the trace ended: one, or none where it ended otherwise."""
        return int(self.ended == "toggle")

    @cached_property
    def toggles(self) -> list[tuple[float, float]]:
        """Where the input turns back: place on the trace in steps, and the input's way; by bisection along the arc."""
        rate = self.tangents[:, -1]
        turns = np.flatnonzero((rate[:-1] > 0.0) != (rate[1:] > 0.0))

        def passed(k: int, x: Real) -> bool:
            return bool(self.constraints.tangent(x[None], self.tangents[k][None])[0, -1] * rate[k] <= 0.0)

        return [(share, float(x[-1])) for share, x in (self._bisect(int(k), passed, 40) for k in turns)]

    def at(self, way: float, period: float) -> list[tuple[float, Real]]:
        """All configurations that the trace passes at an input, whole periods apart: place in steps, and where."""
        found = []
        t = self.points[:, -1]
        turns = {int(place): x for place, x in self.toggles}
        for k in range(len(t) - 1):
            ends = [t[k], *([turns[k]] if k in turns else []), t[k + 1]]
            for part in range(len(ends) - 1):
                low, high = sorted(ends[part : part + 2])
                rising = ends[part + 1] > ends[part]
                for turn in range(int(np.ceil((low - way) / period)), int(np.floor((high - way) / period)) + 1):
                    there = way + turn * period

                    def passed(k: int, x: Real, part: int = part, rising: bool = rising, there: float = there) -> bool:
                        tangent = self.constraints.tangent(x[None], self.tangents[k][None])[0]
                        second = tangent[-1] * self.tangents[k, -1] <= 0.0
                        if part == 0 and second and k in turns:
                            return True
                        if part == 1 and not second:
                            return False
                        return bool((x[-1] >= there) == rising)

                    share, x = self._bisect(k, passed, 14)
                    x[-1] = there
                    solved, good = self.constraints.solve(x[None])
                    assert good[0]
                    found.append((share, solved[0]))
        return found

    def _bisect(self, k: int, passed: Callable[[int, Real], bool], halvings: int) -> tuple[float, Real]:
        """Place and configuration on step k at which a condition becomes true."""
        low, high, along = 0.0, 1.0, self.tangents[k]
        start, chord = self.points[k], self.points[k + 1] - self.points[k]
        x = start
        for _ in range(halvings):
            middle = (low + high) / 2.0
            x = self.constraints.correct((start + middle * chord)[None], along[None])[0][0]
            low, high = (low, middle) if passed(k, x) else (middle, high)
        return k + (low + high) / 2.0, x.copy()


def _solve(matrix: Real, right: Real) -> Real:
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        return np.asarray((np.linalg.pinv(matrix) @ right[..., None])[..., 0])
