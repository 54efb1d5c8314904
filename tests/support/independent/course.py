"""The straight lines through points, and how far a curve goes from them (docs/tasks/path.md)."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from kinematics.arrays import Complex, Real

BULGE = 0.25
"""What a curve may bulge between two points, as a share of their distance."""

BETWEEN, CLOSER = 257, 5
"""Places of the smooth curve over each line, and how many looks follow about the one that is farthest."""


class Course:
    """Lines from point to point, closed or a chain."""

    def __init__(self, points: Complex, closed: bool) -> None:
        self.points, self.closed = points, closed
        self.starts = points if closed else points[:-1]
        self.sides = (np.roll(points, -1) if closed else points[1:]) - self.starts

    def off(self, places: Complex) -> Real:
        """Distances of places from each line, shape (places, lines); NaN for no place."""
        return _off(places[:, None], self.starts, self.sides)

    def distances(self, places: Complex) -> Real:
        """Distances of places from the nearest line."""
        return np.asarray(self.off(places).min(axis=1))

    def beyond_bulges(self, places: Complex, missed: float) -> Real:
        """What is left of these when the miss at the points and the bulge of each line are taken off."""
        return np.asarray((self.off(places) - missed - BULGE * np.abs(self.sides)).min(axis=1))

    def tolerance_used(self, places: Complex, tolerances: Real) -> Real:
        """What is left when the bulge of the smooth curve is taken off, over the greater tolerance of a line's ends."""
        ends = np.append(tolerances, tolerances[0]) if self.closed else tolerances
        return np.asarray(((self.off(places) - self._bulges) / np.maximum(ends[1:], ends[:-1])).min(axis=1))

    @cached_property
    def _bulges(self) -> Real:
        """How far the smooth curve through the points goes from each line, at most a quarter of the line."""
        lengths = np.abs(self.sides)
        begin = np.concatenate([[0.0], np.cumsum(lengths)])
        smooth = _Spline(begin, np.append(self.points, self.points[0]) if self.closed else self.points, self.closed)
        low, high = np.zeros(len(lengths)), np.ones(len(lengths))
        for _ in range(CLOSER):
            shares = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, BETWEEN)
            places = smooth.at(begin[:-1, None] + lengths[:, None] * shares)
            off = _off(places, self.starts[:, None], self.sides[:, None])
            best, step = np.take_along_axis(shares, off.argmax(axis=1)[:, None], 1)[:, 0], (high - low) / (BETWEEN - 1)
            low, high = np.maximum(best - step, 0.0), np.minimum(best + step, 1.0)
        return np.asarray(np.minimum(off.max(axis=1), BULGE * lengths))


def _off(places: Complex, starts: Complex, sides: Complex) -> Real:
    """Distances of places from lines."""
    gaps = places - starts
    with np.errstate(divide="ignore", invalid="ignore"):
        along = np.nan_to_num((gaps * np.conj(sides)).real / np.abs(sides) ** 2)
    return np.asarray(np.abs(gaps - np.clip(along, 0.0, 1.0) * sides))


class _Spline:
    """The cubic spline through places at parameters, by the equations of its slopes; no knot at the second and last but
    one where it is open."""

    def __init__(self, at: Real, places: Complex, closed: bool) -> None:
        self.knots, self.places = at, places
        n, h = len(at), np.diff(at)
        chord = np.diff(places) / h
        matrix, right = np.zeros((n, n)), np.zeros(n, np.complex128)
        for k in range(1, n - 1):
            matrix[k, k - 1 : k + 2] = 1.0 / h[k - 1], 2.0 / h[k - 1] + 2.0 / h[k], 1.0 / h[k]
            right[k] = 3.0 * (chord[k - 1] / h[k - 1] + chord[k] / h[k])
        if closed:
            matrix[0, 0], matrix[0, n - 1] = 1.0, -1.0
            matrix[n - 1, [0, 1]] = 2.0 / h[0], 1.0 / h[0]
            matrix[n - 1, n - 2] += 1.0 / h[-1]
            matrix[n - 1, n - 1] += 2.0 / h[-1]
            right[n - 1] = 3.0 * (chord[-1] / h[-1] + chord[0] / h[0])
        elif n == 3:
            # The parabola.
            second = (chord[1] - chord[0]) / (at[2] - at[0])
            matrix[:] = np.eye(3)
            right[:] = chord[0] - second * h[0], chord[0] + second * h[0], chord[1] + second * h[1]
        else:
            for row, k in ((0, 1), (n - 1, n - 2)):  # the third derivative is the same on both sides of the knot k
                matrix[row, [k - 1, k]] = 1.0 / h[k - 1] ** 2
                matrix[row, [k, k + 1]] -= 1.0 / h[k] ** 2
                right[row] = 2.0 * (chord[k - 1] / h[k - 1] ** 2 - chord[k] / h[k] ** 2)
        self.slopes = np.linalg.solve(matrix, right)

    def at(self, where: Real) -> Complex:
        """Places at parameters."""
        k = np.clip(np.searchsorted(self.knots, where, side="right") - 1, 0, len(self.knots) - 2)
        wide = self.knots[k + 1] - self.knots[k]
        u = (where - self.knots[k]) / wide
        place = (1.0 + 2.0 * u) * (1.0 - u) ** 2 * self.places[k] + u * (1.0 - u) ** 2 * wide * self.slopes[k]
        return np.asarray(
            place + u**2 * (3.0 - 2.0 * u) * self.places[k + 1] - u**2 * (1.0 - u) * wide * self.slopes[k + 1]
        )
