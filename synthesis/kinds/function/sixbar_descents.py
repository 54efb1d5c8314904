"""Descents of sixbars towards the least squares of their errors under limits, and the best of what they arrive at."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.function import sixbar_rows as fit
from synthesis.kinds.function.sixbar_followers import greatest_cosine
from synthesis.kinds.function.sixbar_kernels import LOGARITHMIC, NUMBERS, OWN, STEPHENSON_2, STEPHENSON_3, WATT_2, K, L
from synthesis.kinds.function.sixbar_starts import Starts
from synthesis.kinds.function.stated_mechanisms import Sixbar
from synthesis.numerics.geodesic import follow_valley
from synthesis.numerics.levenberg import descend, descend_each
from synthesis.outcome.ranking import distinct

Real = NDArray[np.float64]

KINDS: dict[Sixbar, int] = {"watt_2": WATT_2, "stephenson_3": STEPHENSON_3, "stephenson_2": STEPHENSON_2}

APART = 0.05
"""Sixbars differ by this much in the logarithm of a length, an angle or a coordinate."""

NONE = np.zeros(1)
"""Multipliers of a problem that has none."""


class Found(NamedTuple):
    """A sixbar of the search: its type, assembly and numbers, and its error in the criterion's norm, radians."""

    type: Sixbar
    assembly: int
    at: Real
    error: float


class Descended(NamedTuple):
    """What many starts have become, and half the sum of squares of each; infinite where a start is impossible."""

    starts: Starts
    costs: Real


class Descents:
    """Descents of sixbars of one task at some places.

    Parameters
    ----------
    points : float, shape (4, m)
        As :func:`~synthesis.kinds.function.sixbar_rows.rows` takes them.
    least : float
        Transmission angle, degrees, that is aimed at.
    ratio : float, optional
        Greatest link ratio.
    """

    def __init__(self, points: Real, least: float, ratio: float | None) -> None:
        self.points, self.cosine = points, greatest_cosine(least)
        self.logratio = math.log(fit.WIDEST if ratio is None else ratio) - fit.INSIDE
        self._most = fit.most_rows(points.shape[1])

    def costs(self, name: Sixbar, starts: Starts) -> Real:
        """Half the squares of each start's errors and of what its transmission lacks; infinite where it fails."""
        costs = np.empty(len(starts.at))
        fit.weigh(KINDS[name], starts.assemblies, starts.at, self.points, self.cosine, costs)
        return costs

    def descended(self, one: Found, weight: float, steps: int, tolerance: float) -> Found:
        """The least squares from a start, by Levenberg and Marquardt's method, limits having a weight beside errors."""
        x, setting, state = self._problem(one, weight)
        cost, _ = descend(fit.rows, x, self.points, setting, NONE, state, self._most, steps, tolerance)
        return _reached(one, x, setting, state, cost)

    def descended_each(self, name: Sixbar, starts: Starts, weight: float, steps: int, tolerance: float) -> Descended:
        """The same from many starts of a type."""
        kind = KINDS[name]
        x, states, costs = _unknowns(kind, starts.at), starts.at[:, -1:].copy(), np.full(len(starts.at), math.inf)
        at = starts.at.copy()
        # What a setting depends on: the assembly, and the signs of both scales.
        groups = np.column_stack([starts.assemblies, np.sign(starts.at[:, [K, L]])])
        for group in np.unique(groups, axis=0):
            own = np.flatnonzero((groups == group).all(axis=1))
            moved, kept = np.ascontiguousarray(x[own]), np.ascontiguousarray(states[own])
            reached, ended = np.empty(len(own)), np.empty(len(own), np.int64)
            setting = self._setting(kind, int(group[0]), group[1:], weight)
            descend_each(
                fit.rows, moved, self.points, setting, NONE, kept, self._most, steps, tolerance, reached, ended
            )
            costs[own] = reached
            for n in np.flatnonzero(np.isfinite(reached)):
                fit.unlogged(kind, moved[n], setting, kept[n], at[own[n]])
        return Descended(Starts(at, starts.assemblies), costs)

    def along(self, one: Found, weight: float, steps: int) -> Found:
        """A sixbar farther along the valley that it is in."""
        return self._followed(one, *self._problem(one, weight), steps)

    def moved(
        self, one: Found, weight: float, steps: int, directions: int, farthest: float, rng: np.random.Generator
    ) -> Found | None:
        """A sixbar moved by chance along the directions that change its residuals least, and followed from there.

        Parameters
        ----------
        one : Found
        weight : float
            Of limits.
        steps : int
            Along the valley.
        directions : int
            How many directions, the flattest ones, some of which are taken.
        farthest : float
            Greatest change of an unknown before it is followed.
        rng : numpy.random.Generator

        Returns
        -------
        Found or None
            Nothing where the sixbar cannot be moved.
        """  # fmt: skip
        x, setting, state = self._problem(one, weight)
        residuals, jacobian = np.zeros(self._most), np.zeros((self._most, len(x)))
        rows = fit.rows(x, self.points, setting, NONE, state, residuals, jacobian)
        free = np.flatnonzero(np.abs(jacobian[: max(rows, 0)]).sum(axis=0) > 0.0)
        if not len(free):
            return None
        _, _, along = np.linalg.svd(jacobian[:rows, free], full_matrices=False)
        taken = int(rng.integers(1, min(directions, len(along)) + 1))
        step = along[-taken:].T @ rng.normal(size=taken)
        x[free] += rng.uniform(0.1, 1.0) * farthest * step / np.abs(step).max()
        return self._followed(one, x, setting, state, steps)

    def _followed(self, one: Found, x: Real, setting: Real, state: Real, steps: int) -> Found:
        cost = follow_valley(fit.rows, x, self.points, setting, NONE, state, self._most, steps)
        return _reached(one, x, setting, state, cost)

    def _problem(self, one: Found, weight: float) -> tuple[Real, Real, Real]:
        """The unknowns of a sixbar, the setting of its rows, and their state."""
        kind = KINDS[one.type]
        setting = self._setting(kind, one.assembly, np.sign(one.at[[K, L]]), weight)
        return _unknowns(kind, one.at), setting, one.at[-1:].copy()

    def _setting(self, kind: int, assembly: int, signs: Real, weight: float) -> Real:
        setting = np.zeros(fit.SETTING)
        setting[[fit.KIND, fit.ASSEMBLY, fit.SIGN_K, fit.SIGN_L]] = kind, assembly, *signs
        setting[[fit.COSINE, fit.RATIO, fit.STRICT]] = self.cosine, self.logratio, weight
        setting[fit.FREE :] = OWN[kind]
        setting[[fit.FREE + K, fit.FREE + L]] = 0.0
        return setting


def _unknowns(kind: int, at: Real) -> Real:
    """The unknowns of one row, or of many."""
    x = at.copy()
    logs = LOGARITHMIC[kind]
    x[..., logs] = np.log(np.abs(x[..., logs]))
    return x


def _reached(one: Found, x: Real, setting: Real, state: Real, cost: float) -> Found:
    at = np.empty(NUMBERS)
    fit.unlogged(KINDS[one.type], x, setting, state, at)
    return one._replace(at=at, error=math.sqrt(2.0 * cost))


def best(found: Iterable[Found], most: int) -> list[Found]:
    """The best of some that differ, of one type."""
    ordered = sorted((one for one in found if math.isfinite(one.error)), key=lambda one: one.error)
    if not ordered:
        return []
    table = np.array([one.at for one in ordered])
    return [ordered[n] for n in distinct(features(KINDS[ordered[0].type], table), most, APART)]


def best_starts(name: Sixbar, starts: Starts, costs: Real, most: int) -> list[Found]:
    """The best of many starts that differ, by their costs; those with infinite ones are none."""
    order = np.argsort(costs, kind="stable")
    order = order[np.isfinite(costs[order])]
    chosen = order[distinct(features(KINDS[name], starts.at[order]), most, APART)]
    return [Found(name, int(starts.assemblies[n]), starts.at[n], math.sqrt(2.0 * costs[n])) for n in chosen]


def features(kind: int, at: Real) -> NDArray[np.complex128]:
    """What tells sixbars of a type apart, as :func:`~synthesis.outcome.ranking.distinct` takes it."""
    logs = LOGARITHMIC[kind]
    table = at[:, :-1].copy()
    table[:, logs[:-1]] = np.log(np.abs(table[:, logs[:-1]]))
    return table.astype(np.complex128)
