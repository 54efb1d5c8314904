"""Two dyads fitted to demanded poses: some held exactly, others met as nearly as their tolerances ask.

A demanded pose may be held in all three coordinates, in some of them, or in none (a tolerance τ stands for each
coordinate that is not held). Poses with at most one held coordinate contribute two residuals, their weighted distance
from the nearest pose that both dyads allow (:mod:`synthesis.kinds.motion.constraint_manifold`). A pose with a single
tolerated coordinate has that coordinate among the unknowns, and it is held on both surfaces; so is a pose that is held
wholly.

What is held is never a penalty. The unknowns are restricted to the surface that the held equations F = 0 define, by
coordinates y in its tangent space: x(y) solves F(x) = 0 with Nᵀ(x − x₀) = y, N spanning the null space of F's
derivatives at x₀, so that dx/dy is the solution of [F'; Nᵀ] dx = [0; dy]. Levenberg and Marquardt's method then sees an
ordinary problem in y. A chart is renewed where a fit has ended until it ends where it began.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from synthesis.kinds.motion.constraint_manifold import (
    LOST_RESIDUAL,
    MAX_LINEARIZATIONS,
    NUMBERS,
    Surface,
    constraint,
    nearest_poses,
    surface_distances,
)
from synthesis.numerics.minpack import EVALUATIONS, TIGHT, Fit, fit
from synthesis.numerics.status import Status

Real = NDArray[np.float64]
Mask = NDArray[np.bool_]

HOLDS = 1e-13
"""Value of a held equation (task sizes) at which it counts as met: a few roundings of a pivot some task sizes away."""

HELD_AS = 0.1
"""Where a dyad is fitted by itself, a held coordinate counts as tolerated with this share of the least tolerance."""

ROUGH, ROUGHLY = 1e-6, 20
"""Relative change at which the fit of a single dyad stops, and its evaluations at most: it is a start."""

NEWTON_STEPS = 25
"""Steps on to the held surface at most."""

CHARTS = 4
"""Charts at most; the second already starts where the first has ended."""

SETTLED = 1e-9
"""Relative decrease of the cost by a new chart below which the fit has ended."""


_NONE = np.zeros(NUMBERS, np.bool_)


NOTHING = 1e-28
"""A cost that is rounding alone: residuals of 1e-14."""


class PoseDemands(NamedTuple):
    """Demanded poses x, y, φ and their tolerances τ, shape (n, 3), task units; τ = 0 where a coordinate is held."""

    poses: Real
    tolerances: Real

    @property
    def held(self) -> NDArray[np.int64]:
        """How many coordinates of each pose are held."""
        return np.asarray((self.tolerances == 0.0).sum(axis=1))


class PoseFit:
    """The least-squares problem of two surfaces: its unknowns are the dyads' numbers and single tolerated coordinates.

    Parameters
    ----------
    demands : PoseDemands
        At least one pose is not held wholly.
    surfaces : pair of Surface
        Input and output dyad.
    fixed : pair of bool arrays, shape (5,)
        Which numbers of the surfaces may not change.
    """

    def __init__(
        self, demands: PoseDemands, surfaces: tuple[Surface, Surface], fixed: tuple[Mask, Mask] = (_NONE, _NONE)
    ) -> None:
        held = demands.held
        self.demands, self.surfaces = demands, surfaces
        self._near = np.flatnonzero(held <= 1)
        self._loose = np.flatnonzero(held == 2)
        self._exact = np.flatnonzero(held == 3)
        self._targets = np.ascontiguousarray(demands.poses[self._near])
        self._variances = np.ascontiguousarray(demands.tolerances[self._near] ** 2)
        self._inverted = np.array([s.inverted for s in surfaces])
        self._origins = np.array([s.origin for s in surfaces])
        free = ~np.concatenate(fixed)
        for side, surface in enumerate(surfaces):
            free[NUMBERS * side + 4] &= surface.curved
        nothing = np.empty(0)
        self._last: tuple[tuple[int, bytes], tuple[Real, Real, Real]] = ((0, b""), (nothing, nothing, nothing))
        self._free = np.concatenate([free, np.ones(len(self._loose), np.bool_)])
        self._axis = np.array([int(np.flatnonzero(demands.tolerances[k])[0]) for k in self._loose], np.int64)

    @property
    def freedom(self) -> int:
        """Unknowns less held equations; below 0 the demands can be met by chance only."""
        return int(self._free.sum()) - 2 * (len(self._loose) + len(self._exact))

    def start(self, one: Real, other: Real) -> Real:
        """The point of the unknowns where two dyads stand and no tolerance is used."""
        return np.concatenate([one, other, np.zeros(len(self._loose))])

    def cost(self, x: Real, *, first_order: bool = False) -> float:
        """Half the sum of squared weighted distances; held equations are not counted."""
        residuals = self._residuals(x, 1 if first_order else MAX_LINEARIZATIONS)
        return 0.5 * float(residuals @ residuals)

    def gradient(self, x: Real) -> Real:
        """Derivatives of the cost by all unknowns, held equations apart."""
        return np.asarray(self._jacobian(x).T @ self._residuals(x, MAX_LINEARIZATIONS))

    def minimum(self, x: Real, *, tolerance: float = TIGHT, evaluations: int = EVALUATIONS) -> Fit | None:
        """The minimum in the basin of a point; None where what is held cannot be held there."""
        if self.freedom < 0:
            return None
        before = np.inf
        ended: Fit | None = None
        for _ in range(CHARTS):
            held = self._on_surface(x)
            if held is None:
                return ended
            chart = _Chart(self, held)
            ended = chart.fitted(tolerance, evaluations)
            x = ended.point
            if ended.cost >= before * (1.0 - SETTLED) or not len(self._held(x)[0]) or ended.cost < NOTHING:
                break
            before = ended.cost
        return ended

    def poses(self, x: Real) -> Real:
        """The pose that the dyads allow nearest to each demanded one, shape (n, 3)."""
        out = self.demands.poses.copy()
        out[self._near] = self._nearest(x, MAX_LINEARIZATIONS)[2]
        out[self._loose, self._axis] += x[2 * NUMBERS :] * self.demands.tolerances[self._loose, self._axis]
        return out

    def has_lost_poses(self, x: Real) -> bool:
        """Whether a demanded pose has no nearest pose that the dyads allow: its residuals are :data:`LOST_RESIDUAL`."""
        return bool(np.any(np.all(self._nearest(x, MAX_LINEARIZATIONS)[0] == LOST_RESIDUAL, axis=1)))

    def _nearest(self, x: Real, linearizations: int) -> tuple[Real, Real, Real]:
        """Residuals, their Jacobian and the nearest poses; those of the last point are kept, as both are asked for."""
        key = (linearizations, x.tobytes())
        if key != self._last[0]:
            self._last = (key, self._computed(x, linearizations))
        return self._last[1]

    def _computed(self, x: Real, linearizations: int) -> tuple[Real, Real, Real]:
        n = len(self._near)
        residuals, jacobian, poses = np.empty((n, 2)), np.empty((n, 2, 2 * NUMBERS)), np.empty((n, 3))
        numbers = x[: 2 * NUMBERS].reshape(2, NUMBERS)
        nearest_poses(
            self._inverted,
            self._origins,
            numbers,
            self._targets,
            self._variances,
            linearizations,
            residuals,
            jacobian,
            poses,
        )
        return residuals, jacobian, poses

    def _residuals(self, x: Real, linearizations: int) -> Real:
        return np.concatenate([self._nearest(x, linearizations)[0].ravel(), x[2 * NUMBERS :]])

    def _jacobian(self, x: Real) -> Real:
        jacobian = self._nearest(x, MAX_LINEARIZATIONS)[1].reshape(-1, 2 * NUMBERS)
        rows, extra = len(jacobian), len(self._loose)
        out = np.zeros((rows + extra, 2 * NUMBERS + extra))
        out[:rows, : 2 * NUMBERS] = jacobian
        out[rows:, 2 * NUMBERS :] = np.eye(extra)
        return out

    def _held(self, x: Real) -> tuple[Real, Real]:
        """Held equations and their derivatives: both surfaces at each held pose, but for its free coordinate."""
        poses = [*self._loose, *self._exact]
        values, jacobian = np.zeros(2 * len(poses)), np.zeros((2 * len(poses), len(x)))
        by_pose, by_number = np.empty(3), np.empty(NUMBERS)
        for row, k in enumerate(poses):
            pose = self.demands.poses[k].copy()
            loose = row < len(self._loose)
            if loose:
                axis = self._axis[row]
                pose[axis] += x[2 * NUMBERS + row] * self.demands.tolerances[k, axis]
            for side, surface in enumerate(self.surfaces):
                numbers = x[NUMBERS * side : NUMBERS * side + NUMBERS]
                values[2 * row + side] = constraint(
                    surface.inverted, complex(surface.origin), numbers, pose, by_pose, by_number
                )
                jacobian[2 * row + side, NUMBERS * side : NUMBERS * side + NUMBERS] = by_number
                if loose:
                    jacobian[2 * row + side, 2 * NUMBERS + row] = by_pose[axis] * self.demands.tolerances[k, axis]
        return values, jacobian

    def _on_surface(self, x: Real) -> Real | None:
        """The point of the held surface that Newton's method reaches from x by the shortest steps."""
        x = x.copy()
        for _ in range(NEWTON_STEPS):
            values, jacobian = self._held(x)
            if not len(values) or np.abs(values).max() <= HOLDS:
                return x
            x[self._free] -= np.linalg.lstsq(jacobian[:, self._free], values, rcond=None)[0]
            if not np.all(np.isfinite(x)):
                return None
        return x if np.abs(self._held(x)[0]).max() <= 1e3 * HOLDS else None


class _Chart:
    """Coordinates y of the held surface about a point of it."""

    def __init__(self, problem: PoseFit, x: Real) -> None:
        self.problem, self.x0 = problem, x
        jacobian = problem._held(x)[1][:, problem._free]
        rank = len(jacobian)
        self.tangent = np.linalg.svd(jacobian)[2][rank:] if rank else np.eye(jacobian.shape[1])
        self._last: tuple[bytes, Real | None, Real | None] = (b"", None, None)

    def fitted(self, tolerance: float, evaluations: int) -> Fit:
        """The minimum in this chart, as a point x."""
        start = np.zeros(len(self.tangent))
        ended = fit(self._residuals, self._jacobian, start, tolerance=tolerance, evaluations=evaluations)
        x = self._at(ended.point)[0]
        if x is None:
            return Fit(self.x0, self.problem.cost(self.x0), Status.IMPOSSIBLE)
        # A lost pose has the cost 1e12 and no gradient: beside it no other gain counts, and any end seems converged.
        status = Status.IMPOSSIBLE if self.problem.has_lost_poses(x) else ended.status
        return Fit(x, ended.cost, status)

    def _at(self, y: Real) -> tuple[Real | None, Real | None]:
        """x(y) and dx/dy; None where Newton's method does not find it."""
        key = y.tobytes()
        if key != self._last[0]:
            self._last = (key, *self._solved(y))
        return self._last[1:]

    def _solved(self, y: Real) -> tuple[Real | None, Real | None]:
        free = self.problem._free
        x = self.x0.copy()
        x[free] += self.tangent.T @ y
        values, jacobian = self.problem._held(x)
        if not len(values):
            return x, self.tangent.T
        for _ in range(NEWTON_STEPS):
            matrix = np.concatenate([jacobian[:, free], self.tangent])
            try:
                if np.abs(values).max() <= HOLDS:
                    right = np.concatenate([np.zeros((len(values), len(y))), np.eye(len(y))])
                    return x, np.linalg.solve(matrix, right)
                x[free] -= np.linalg.solve(matrix, np.concatenate([values, np.zeros(len(y))]))
            except np.linalg.LinAlgError:
                return None, None
            if not np.abs(x).max() < LOST_RESIDUAL:
                return None, None
            values, jacobian = self.problem._held(x)
        return None, None

    def _residuals(self, y: Real) -> Real:
        x, _ = self._at(y)
        if x is None:
            return np.full(2 * len(self.problem._near) + len(self.problem._loose), LOST_RESIDUAL)
        return self.problem._residuals(x, MAX_LINEARIZATIONS)

    def _jacobian(self, y: Real) -> Real:
        x, by_y = self._at(y)
        if x is None or by_y is None:
            return np.zeros((2 * len(self.problem._near) + len(self.problem._loose), len(y)))
        return np.asarray(self.problem._jacobian(x)[:, self.problem._free] @ by_y)


def surface_fit(demands: PoseDemands, surface: Surface, numbers: Real, fixed: Mask = _NONE) -> Fit:
    """One dyad fitted to all poses by itself, to first order; held coordinates count ten times.

    A start for pairs: most good pairs are made of such dyads.
    """
    least = float(np.min(demands.tolerances[demands.tolerances > 0.0], initial=1.0))
    variances = np.where(demands.tolerances > 0.0, demands.tolerances, HELD_AS * least) ** 2
    free = ~fixed
    free[4] &= surface.curved
    whole = numbers.copy()

    def run(x: Real) -> tuple[Real, Real]:
        whole[free] = x
        residuals, jacobian = np.empty(len(demands.poses)), np.empty((len(demands.poses), NUMBERS))
        surface_distances(
            surface.inverted, complex(surface.origin), whole, demands.poses, variances, residuals, jacobian
        )
        return residuals, jacobian[:, free]

    ended = fit(lambda x: run(x)[0], lambda x: run(x)[1], numbers[free], tolerance=ROUGH, evaluations=ROUGHLY)
    whole[free] = ended.point
    return ended._replace(point=whole)
