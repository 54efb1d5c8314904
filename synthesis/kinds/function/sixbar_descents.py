"""Least-squares descents of sixbars under constraints, and selection of the best results."""

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
"""Minimum separation of distinct sixbars, in the logarithm of a length, an angle or a coordinate."""

NONE = np.zeros(1)
"""Placeholder for the multipliers of a problem without any."""


class Found(NamedTuple):
    """A candidate sixbar: its type, assembly and numbers, and its error in the criterion's norm, radians."""

    type: Sixbar
    assembly: int
    at: Real
    error: float


class Descended(NamedTuple):
    """Results of many starts, and half the sum of squares of each; infinite for an impossible start."""

    starts: Starts
    costs: Real


class Descents:
    """Descents of sixbars of one task at given inputs.

    Parameters
    ----------
    points : float, shape (4, m)
        As for :func:`~synthesis.kinds.function.sixbar_rows.rows`.
    least : float
        Minimum transmission angle, degrees.
    ratio : float, optional
        Maximum link ratio.
    """

    def __init__(self, points: Real, least: float, ratio: float | None) -> None:
        self.points, self.cosine = points, greatest_cosine(least)
        self.logratio = math.log(fit.WIDEST if ratio is None else ratio) - fit.INSIDE
        self._most = fit.most_rows(points.shape[1])

    def costs(self, name: Sixbar, starts: Starts) -> Real:
        """Return half the sum of squares of each start's errors and transmission violations; infinite on failure."""
        costs = np.empty(len(starts.at))
        fit.weigh(KINDS[name], starts.assemblies, starts.at, self.points, self.cosine, costs)
        return costs

    def descended(self, one: Found, weight: float, steps: int, tolerance: float) -> Found:
        """Minimize the least squares from a start by the Levenberg-Marquardt method; ``weight`` is that of limits."""
        x, setting, state = self._problem(one, weight)
        cost, _ = descend(fit.rows, x, self.points, setting, NONE, state, self._most, steps, tolerance)
        return _reached(one, x, setting, state, cost)

    def descended_each(self, name: Sixbar, starts: Starts, weight: float, steps: int, tolerance: float) -> Descended:
        """Minimize the least squares from many starts of a type."""
        kind = KINDS[name]
        x, states, costs = _unknowns(kind, starts.at), starts.at[:, -1:].copy(), np.full(len(starts.at), math.inf)
        at = starts.at.copy()
        # A setting depends on the assembly and the signs of both scales: descend each such group together.
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
        """Follow the valley that contains a sixbar."""
        return self._followed(one, *self._problem(one, weight), steps)

    def moved(
        self, one: Found, weight: float, steps: int, directions: int, farthest: float, rng: np.random.Generator
    ) -> Found | None:
        """Perturb a sixbar along the directions that change its residuals least, and follow the valley from there.

        Parameters
        ----------
        one : Found
        weight : float
            Weight of limits.
        steps : int
            Number of steps along the valley.
        directions : int
            Number of flattest directions to choose from.
        farthest : float
            Maximum change of an unknown in the perturbation.
        rng : numpy.random.Generator

        Returns
        -------
        Found or None
            None if the sixbar cannot be moved.
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
        """Return the unknowns of a sixbar, the setting of its rows, and their state."""
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
    """Encode one row, or many, as unknowns."""
    x = at.copy()
    logs = LOGARITHMIC[kind]
    x[..., logs] = np.log(np.abs(x[..., logs]))
    return x


def _reached(one: Found, x: Real, setting: Real, state: Real, cost: float) -> Found:
    at = np.empty(NUMBERS)
    fit.unlogged(KINDS[one.type], x, setting, state, at)
    return one._replace(at=at, error=math.sqrt(2.0 * cost))


def best(found: Iterable[Found], most: int) -> list[Found]:
    """Select the best distinct sixbars of one type."""
    ordered = sorted((one for one in found if math.isfinite(one.error)), key=lambda one: one.error)
    if not ordered:
        return []
    table = np.array([one.at for one in ordered])
    return [ordered[n] for n in distinct(features(KINDS[ordered[0].type], table), most, APART)]


def best_starts(name: Sixbar, starts: Starts, costs: Real, most: int) -> list[Found]:
    """Select the best distinct starts by their costs; starts with infinite costs are dropped."""
    order = np.argsort(costs, kind="stable")
    order = order[np.isfinite(costs[order])]
    chosen = order[distinct(features(KINDS[name], starts.at[order]), most, APART)]
    return [Found(name, int(starts.assemblies[n]), starts.at[n], math.sqrt(2.0 * costs[n])) for n in chosen]


def features(kind: int, at: Real) -> NDArray[np.complex128]:
    """Return the coordinates that distinguish sixbars of a type, for :func:`~synthesis.outcome.ranking.distinct`."""
    logs = LOGARITHMIC[kind]
    table = at[:, :-1].copy()
    table[:, logs[:-1]] = np.log(np.abs(table[:, logs[:-1]]))
    return table.astype(np.complex128)
