"""Least-squares descents of sixbars under constraints, and selection of the best results."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Real
from synthesis.kinds.function.sixbar import residuals as fit
from synthesis.kinds.function.sixbar.followers import compute_max_cosine
from synthesis.kinds.function.sixbar.kernels import (
    IS_LOGARITHMIC,
    IS_USED,
    ROW_SIZE,
    STEPHENSON_2,
    STEPHENSON_3,
    WATT_2,
    K,
    L,
)
from synthesis.kinds.function.sixbar.starts import Starts
from synthesis.kinds.function.statement.mechanism_types import Sixbar
from synthesis.numerics.geodesic import follow_valley
from synthesis.numerics.levenberg import descend, descend_each
from synthesis.results.ranking import select_distinct

TYPE_NUMBERS: dict[Sixbar, int] = {"watt_2": WATT_2, "stephenson_3": STEPHENSON_3, "stephenson_2": STEPHENSON_2}

MIN_SEPARATION = 0.05
"""Minimum separation of distinct sixbars, in the logarithm of a length, an angle or a coordinate."""

NO_MULTIPLIERS = np.zeros(1)
"""Placeholder for the multipliers of a problem without any."""


class SixbarCandidate(NamedTuple):
    """A candidate sixbar: its type, assembly and numbers, and its error in the criterion's norm, radians."""

    type: Sixbar
    assembly: int
    at: Real
    error: float


class DescentResults(NamedTuple):
    """Results of many starts, and half the sum of squares of each; infinite for an impossible start."""

    starts: Starts
    costs: Real


class Descents:
    """Descents of sixbars of one task at given inputs.

    Parameters
    ----------
    points : float, shape (4, m)
        As for :func:`~synthesis.kinds.function.sixbar.residuals.evaluate_rows`.
    least : float
        Minimum transmission angle, degrees.
    ratio : float, optional
        Maximum link ratio.
    """

    def __init__(self, points: Real, least: float, ratio: float | None) -> None:
        self.points, self.cosine = points, compute_max_cosine(least)
        self.logratio = math.log(fit.DEFAULT_MAX_RATIO if ratio is None else ratio) - fit.RATIO_MARGIN
        self._most = fit.count_max_rows(points.shape[1])

    def costs(self, name: Sixbar, starts: Starts) -> Real:
        """Return half the sum of squares of each start's errors and transmission violations; infinite on failure."""
        costs = np.empty(len(starts.at))
        fit.evaluate_costs(TYPE_NUMBERS[name], starts.assemblies, starts.at, self.points, self.cosine, costs)
        return costs

    def descend_one(self, one: SixbarCandidate, weight: float, steps: int, tolerance: float) -> SixbarCandidate:
        """Minimize the least squares from a start by the Levenberg-Marquardt method; ``weight`` is that of limits."""
        x, setting, state = self._pack_problem(one, weight)
        cost, _ = descend(
            fit.evaluate_rows, x, self.points, setting, NO_MULTIPLIERS, state, self._most, steps, tolerance
        )
        return _decode_candidate(one, x, setting, state, cost)

    def descend_all(self, name: Sixbar, starts: Starts, weight: float, steps: int, tolerance: float) -> DescentResults:
        """Minimize the least squares from many starts of a type."""
        kind = TYPE_NUMBERS[name]
        x, states, costs = (
            _encode_unknowns(kind, starts.at),
            starts.at[:, -1:].copy(),
            np.full(len(starts.at), math.inf),
        )
        at = starts.at.copy()
        # A setting depends on the assembly and the signs of both scales: descend each such group together.
        groups = np.column_stack([starts.assemblies, np.sign(starts.at[:, [K, L]])])
        for group in np.unique(groups, axis=0):
            own = np.flatnonzero((groups == group).all(axis=1))
            moved, kept = np.ascontiguousarray(x[own]), np.ascontiguousarray(states[own])
            reached, ended = np.empty(len(own)), np.empty(len(own), np.int64)
            setting = self._pack_setting(kind, int(group[0]), group[1:], weight)
            descend_each(
                fit.evaluate_rows,
                moved,
                self.points,
                setting,
                NO_MULTIPLIERS,
                kept,
                self._most,
                steps,
                tolerance,
                reached,
                ended,
            )
            # Impossible starts keep their rows and an infinite cost.
            costs[own] = reached
            for n in np.flatnonzero(np.isfinite(reached)):
                fit.decode_unknowns(kind, moved[n], setting, kept[n], at[own[n]])
        return DescentResults(Starts(at, starts.assemblies), costs)

    def follow_from(self, one: SixbarCandidate, weight: float, steps: int) -> SixbarCandidate:
        """Follow the valley that contains a sixbar."""
        return self._follow_unknowns(one, *self._pack_problem(one, weight), steps)

    def perturb_and_follow(
        self,
        one: SixbarCandidate,
        weight: float,
        steps: int,
        directions: int,
        farthest: float,
        rng: np.random.Generator,
    ) -> SixbarCandidate | None:
        """Perturb a sixbar along the directions that change its residuals least, and follow the valley from there.

        Parameters
        ----------
        one : SixbarCandidate
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
        SixbarCandidate or None
            None if the sixbar cannot be moved.
        """  # fmt: skip
        x, setting, state = self._pack_problem(one, weight)
        residuals, jacobian = np.zeros(self._most), np.zeros((self._most, len(x)))
        rows = fit.evaluate_rows(x, self.points, setting, NO_MULTIPLIERS, state, residuals, jacobian)
        # Fixed unknowns have zero columns and must not be moved.
        free = np.flatnonzero(np.abs(jacobian[: max(rows, 0)]).sum(axis=0) > 0.0)
        if not len(free):
            return None
        # The last right singular vectors change the residuals least.
        _, _, along = np.linalg.svd(jacobian[:rows, free], full_matrices=False)
        taken = int(rng.integers(1, min(directions, len(along)) + 1))
        step = along[-taken:].T @ rng.normal(size=taken)
        # A random length, but never so short that the same minimum is found again.
        x[free] += rng.uniform(0.1, 1.0) * farthest * step / np.abs(step).max()
        return self._follow_unknowns(one, x, setting, state, steps)

    def _follow_unknowns(
        self, one: SixbarCandidate, x: Real, setting: Real, state: Real, steps: int
    ) -> SixbarCandidate:
        cost = follow_valley(fit.evaluate_rows, x, self.points, setting, NO_MULTIPLIERS, state, self._most, steps)
        return _decode_candidate(one, x, setting, state, cost)

    def _pack_problem(self, one: SixbarCandidate, weight: float) -> tuple[Real, Real, Real]:
        """Return the unknowns of a sixbar, the setting of its rows, and their state."""
        kind = TYPE_NUMBERS[one.type]
        setting = self._pack_setting(kind, one.assembly, np.sign(one.at[[K, L]]), weight)
        return _encode_unknowns(kind, one.at), setting, one.at[-1:].copy()

    def _pack_setting(self, kind: int, assembly: int, signs: Real, weight: float) -> Real:
        setting = np.zeros(fit.SETTING.size)
        setting[[fit.KIND, fit.ASSEMBLY, fit.SIGN_K, fit.SIGN_L]] = kind, assembly, *signs
        setting[[fit.COSINE, fit.RATIO, fit.STRICT]] = self.cosine, self.logratio, weight
        setting[fit.FREE] = IS_USED[kind]
        # Scales are fixed in the descents; they are part of the samples.
        setting[fit.FREE][[K, L]] = 0.0
        return setting


def _encode_unknowns(kind: int, at: Real) -> Real:
    """Encode one row, or many, as unknowns."""
    x = at.copy()
    logs = IS_LOGARITHMIC[kind]
    # Logarithms of magnitudes: the signs of scales are kept in the setting.
    x[..., logs] = np.log(np.abs(x[..., logs]))
    return x


def _decode_candidate(one: SixbarCandidate, x: Real, setting: Real, state: Real, cost: float) -> SixbarCandidate:
    at = np.empty(ROW_SIZE)
    fit.decode_unknowns(TYPE_NUMBERS[one.type], x, setting, state, at)
    return one._replace(at=at, error=math.sqrt(2.0 * cost))


def select_best(found: Iterable[SixbarCandidate], most: int) -> list[SixbarCandidate]:
    """Select the best distinct sixbars of one type."""
    ordered = sorted((one for one in found if math.isfinite(one.error)), key=lambda one: one.error)
    if not ordered:
        return []
    table = np.array([one.at for one in ordered])
    return [
        ordered[n]
        for n in select_distinct(compute_features(TYPE_NUMBERS[ordered[0].type], table), most, MIN_SEPARATION)
    ]


def select_best_starts(name: Sixbar, starts: Starts, costs: Real, most: int) -> list[SixbarCandidate]:
    """Select the best distinct starts by their costs; starts with infinite costs are dropped."""
    order = np.argsort(costs, kind="stable")
    order = order[np.isfinite(costs[order])]
    chosen = order[select_distinct(compute_features(TYPE_NUMBERS[name], starts.at[order]), most, MIN_SEPARATION)]
    return [SixbarCandidate(name, int(starts.assemblies[n]), starts.at[n], math.sqrt(2.0 * costs[n])) for n in chosen]


def compute_features(kind: int, at: Real) -> NDArray[np.complex128]:
    """Return the coordinates that distinguish sixbars of a type, for
    :func:`~synthesis.results.ranking.select_distinct`."""
    logs = IS_LOGARITHMIC[kind]
    table = at[:, :-1].copy()
    table[:, logs[:-1]] = np.log(np.abs(table[:, logs[:-1]]))
    return table.astype(np.complex128)
