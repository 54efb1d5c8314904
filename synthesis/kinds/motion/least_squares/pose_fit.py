"""Fit of two dyads to target poses, some of which are exact and others have tolerances.

A target pose may be exact in all three coordinates, in some of them, or in none; each other coordinate has a tolerance
τ. A pose with at most one exact coordinate contributes two residuals, its weighted distance from the nearest pose that
both dyads allow (:mod:`synthesis.kinds.motion.least_squares.constraint_manifold`). A pose with a single tolerated
coordinate has that coordinate among the unknowns and is constrained to both surfaces; a wholly exact pose is
constrained in the same way.

Exact coordinates are constraints, never penalties. The unknowns are restricted to the surface F = 0 of the constraint
equations by coordinates y in its tangent space: x(y) solves F(x) = 0 with Nᵀ(x − x₀) = y, where N spans the null space
of F's derivatives at x₀, so dx/dy is the solution of [F'; Nᵀ] dx = [0; dy]. The Levenberg-Marquardt method then sees an
ordinary problem in y. A new chart is made where a fit has ended, until the cost no longer decreases.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Mask, Real
from synthesis.kinds.motion.least_squares.constraint_manifold import (
    DYAD_NUMBER_COUNT,
    LOST_RESIDUAL,
    MAX_LINEARIZATIONS,
    Surface,
    compute_surface_distances,
    evaluate_constraint,
    find_nearest_poses,
)
from synthesis.numerics.minpack import DEFAULT_TOLERANCE, MAX_EVALUATIONS, Fit, fit
from synthesis.numerics.status import Status

CONSTRAINT_TOLERANCE = 1e-13
"""Tolerance of a constraint equation, in task sizes: a few rounding errors of a pivot several task sizes away."""

EXACT_TOLERANCE_SHARE = 0.1
"""Tolerance that replaces an exact coordinate in the fit of a single dyad, as a share of the smallest tolerance."""

ROUGH_TOLERANCE, MAX_ROUGH_EVALUATIONS = 1e-6, 20
"""Relative change at which the fit of a single dyad stops, and its maximum number of evaluations. The result is only a
starting point."""

NEWTON_STEPS = 25
"""Maximum number of Newton steps onto the constraint surface."""

MAX_CHARTS = 4
"""Maximum number of charts; from the second on, each starts where the previous fit ended."""

MIN_COST_DECREASE = 1e-9
"""Relative decrease of the cost by a new chart below which the fit has converged."""


_NO_NUMBERS = np.zeros(DYAD_NUMBER_COUNT, np.bool_)


ZERO_COST = 1e-28
"""Cost that consists of rounding alone: residuals of 1e-14."""


class PoseConstraints(NamedTuple):
    """Target poses x, y, φ and their tolerances τ, shape (n, 3), task units; τ = 0 for an exact coordinate."""

    poses: Real
    tolerances: Real

    @property
    def exact_count(self) -> NDArray[np.int64]:
        """Number of exact coordinates of each pose, shape (n,)."""
        return np.asarray((self.tolerances == 0.0).sum(axis=1))


class PoseFit:
    """Least-squares problem of two surfaces; the unknowns are the dyads' numbers and single tolerated coordinates.

    Parameters
    ----------
    demands : PoseConstraints
        At least one pose is not wholly exact.
    surfaces : pair of Surface
        Input and output dyad.
    fixed : pair of bool arrays, shape (5,)
        Mask of the numbers of each surface that must not change.
    """

    def __init__(
        self,
        demands: PoseConstraints,
        surfaces: tuple[Surface, Surface],
        fixed: tuple[Mask, Mask] = (_NO_NUMBERS, _NO_NUMBERS),
    ) -> None:
        held = demands.exact_count
        self.demands, self.surfaces = demands, surfaces
        # A pose with at most one exact coordinate has a nearest allowed pose in the plane of the others.
        self._near = np.flatnonzero(held <= 1)
        # With two exact coordinates only one is left: it becomes an unknown, and both surfaces become equations.
        self._loose = np.flatnonzero(held == 2)
        self._exact = np.flatnonzero(held == 3)
        self._targets = np.ascontiguousarray(demands.poses[self._near])
        self._variances = np.ascontiguousarray(demands.tolerances[self._near] ** 2)
        self._inverted = np.array([s.inverted for s in surfaces])
        self._origins = np.array([s.origin for s in surfaces])
        free = ~np.concatenate(fixed)
        for side, surface in enumerate(surfaces):
            # A slider's curvature is zero and stays zero.
            free[DYAD_NUMBER_COUNT * side + 4] &= surface.curved
        nothing = np.empty(0)
        self._last: tuple[tuple[int, bytes], tuple[Real, Real, Real]] = ((0, b""), (nothing, nothing, nothing))
        self._free = np.concatenate([free, np.ones(len(self._loose), np.bool_)])
        self._axis = np.array([int(np.flatnonzero(demands.tolerances[k])[0]) for k in self._loose], np.int64)

    @property
    def freedom(self) -> int:
        """Number of unknowns minus number of constraint equations; if negative, a solution exists only by chance."""
        # Each of these poses must lie on both surfaces: two equations.
        return int(self._free.sum()) - 2 * (len(self._loose) + len(self._exact))

    def start(self, one: Real, other: Real) -> Real:
        """Start from two dyads: return their vector of unknowns, without deviations within tolerances."""
        return np.concatenate([one, other, np.zeros(len(self._loose))])

    def cost(self, x: Real, *, first_order: bool = False) -> float:
        """Return half the sum of squared weighted distances, without the constraint equations."""
        residuals = self._compute_residuals(x, 1 if first_order else MAX_LINEARIZATIONS)
        return 0.5 * float(residuals @ residuals)

    def gradient(self, x: Real) -> Real:
        """Return the derivatives of the cost by all unknowns, without the constraint equations."""
        return np.asarray(self._compute_jacobian(x).T @ self._compute_residuals(x, MAX_LINEARIZATIONS))

    def minimize(
        self, x: Real, *, tolerance: float = DEFAULT_TOLERANCE, evaluations: int = MAX_EVALUATIONS
    ) -> Fit | None:
        """Find the minimum in the basin of a point; return None if the constraints cannot be satisfied nearby."""
        if self.freedom < 0:
            return None
        # Repeat with a new chart about the result, because a chart is accurate only near its centre.
        before = np.inf
        ended: Fit | None = None
        for _ in range(MAX_CHARTS):
            held = self._project_on_surface(x)
            if held is None:
                # If a later projection fails, the result of the previous chart still stands.
                return ended
            chart = _Chart(self, held)
            ended = chart.minimize(tolerance, evaluations)
            x = ended.point
            # Without constraints one chart covers the whole space, so a second fit would not help.
            if (
                ended.cost >= before * (1.0 - MIN_COST_DECREASE)
                or not len(self._evaluate_constraints(x)[0])
                or ended.cost < ZERO_COST
            ):
                break
            before = ended.cost
        return ended

    def poses(self, x: Real) -> Real:
        """Return the pose nearest to each target that the dyads allow, shape (n, 3)."""
        out = self.demands.poses.copy()
        out[self._near] = self._find_nearest(x, MAX_LINEARIZATIONS)[2]
        # The unknown is measured in tolerances.
        out[self._loose, self._axis] += x[2 * DYAD_NUMBER_COUNT :] * self.demands.tolerances[self._loose, self._axis]
        return out

    def has_lost_poses(self, x: Real) -> bool:
        """Return whether a target's nearest allowed pose was not found: its residuals are :data:`LOST_RESIDUAL`."""
        return bool(np.any(np.all(self._find_nearest(x, MAX_LINEARIZATIONS)[0] == LOST_RESIDUAL, axis=1)))

    def _find_nearest(self, x: Real, linearizations: int) -> tuple[Real, Real, Real]:
        """Return residuals, Jacobian and nearest poses; the last point is cached, because solvers request both."""
        key = (linearizations, x.tobytes())
        if key != self._last[0]:
            self._last = (key, self._compute_nearest(x, linearizations))
        return self._last[1]

    def _compute_nearest(self, x: Real, linearizations: int) -> tuple[Real, Real, Real]:
        n = len(self._near)
        residuals, jacobian, poses = np.empty((n, 2)), np.empty((n, 2, 2 * DYAD_NUMBER_COUNT)), np.empty((n, 3))
        numbers = x[: 2 * DYAD_NUMBER_COUNT].reshape(2, DYAD_NUMBER_COUNT)
        find_nearest_poses(
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

    def _compute_residuals(self, x: Real, linearizations: int) -> Real:
        return np.concatenate([self._find_nearest(x, linearizations)[0].ravel(), x[2 * DYAD_NUMBER_COUNT :]])

    def _compute_jacobian(self, x: Real) -> Real:
        jacobian = self._find_nearest(x, MAX_LINEARIZATIONS)[1].reshape(-1, 2 * DYAD_NUMBER_COUNT)
        rows, extra = len(jacobian), len(self._loose)
        out = np.zeros((rows + extra, 2 * DYAD_NUMBER_COUNT + extra))
        out[:rows, : 2 * DYAD_NUMBER_COUNT] = jacobian
        # The deviations are residuals themselves, measured in tolerances, so their derivatives are one.
        out[rows:, 2 * DYAD_NUMBER_COUNT :] = np.eye(extra)
        return out

    def _evaluate_constraints(self, x: Real) -> tuple[Real, Real]:
        """Return constraint equations and derivatives: both surfaces at each exact pose, with its free coordinate."""
        poses = [*self._loose, *self._exact]
        values, jacobian = np.zeros(2 * len(poses)), np.zeros((2 * len(poses), len(x)))
        by_pose, by_number = np.empty(3), np.empty(DYAD_NUMBER_COUNT)
        for row, k in enumerate(poses):
            pose = self.demands.poses[k].copy()
            loose = row < len(self._loose)
            if loose:
                axis = self._axis[row]
                pose[axis] += x[2 * DYAD_NUMBER_COUNT + row] * self.demands.tolerances[k, axis]
            for side, surface in enumerate(self.surfaces):
                numbers = x[DYAD_NUMBER_COUNT * side : DYAD_NUMBER_COUNT * side + DYAD_NUMBER_COUNT]
                values[2 * row + side] = evaluate_constraint(
                    surface.inverted, complex(surface.origin), numbers, pose, by_pose, by_number
                )
                jacobian[2 * row + side, DYAD_NUMBER_COUNT * side : DYAD_NUMBER_COUNT * side + DYAD_NUMBER_COUNT] = (
                    by_number
                )
                if loose:
                    jacobian[2 * row + side, 2 * DYAD_NUMBER_COUNT + row] = (
                        by_pose[axis] * self.demands.tolerances[k, axis]
                    )
        return values, jacobian

    def _project_on_surface(self, x: Real) -> Real | None:
        """Project x onto the constraint surface by Newton steps of minimum norm; return None if that fails."""
        x = x.copy()
        for _ in range(NEWTON_STEPS):
            values, jacobian = self._evaluate_constraints(x)
            if not len(values) or np.abs(values).max() <= CONSTRAINT_TOLERANCE:
                return x
            # Minimum norm changes the dyads as little as possible.
            x[self._free] -= np.linalg.lstsq(jacobian[:, self._free], values, rcond=None)[0]
            if not np.all(np.isfinite(x)):
                return None
        # Distant pivots leave more rounding than CONSTRAINT_TOLERANCE allows: accept these, too, before giving up.
        return x if np.abs(self._evaluate_constraints(x)[0]).max() <= 1e3 * CONSTRAINT_TOLERANCE else None


class _Chart:
    """Local coordinates y of the constraint surface about one of its points."""

    def __init__(self, problem: PoseFit, x: Real) -> None:
        self.problem, self.x0 = problem, x
        jacobian = problem._evaluate_constraints(x)[1][:, problem._free]
        rank = len(jacobian)
        # The right singular vectors beyond the rank span the directions in which the constraints do not change.
        self.tangent = np.linalg.svd(jacobian)[2][rank:] if rank else np.eye(jacobian.shape[1])
        self._last: tuple[bytes, Real | None, Real | None] = (b"", None, None)

    def minimize(self, tolerance: float, evaluations: int) -> Fit:
        """Minimize the cost in this chart and return the minimum as a point x."""
        start = np.zeros(len(self.tangent))
        ended = fit(
            self._compute_residuals, self._compute_jacobian, start, tolerance=tolerance, evaluations=evaluations
        )
        x = self._evaluate_point(ended.point)[0]
        if x is None:
            return Fit(self.x0, self.problem.cost(self.x0), Status.IMPOSSIBLE)
        # A lost pose adds 1e12 to the cost and has no gradient: it hides all other changes and mimics convergence.
        status = Status.IMPOSSIBLE if self.problem.has_lost_poses(x) else ended.status
        return Fit(x, ended.cost, status)

    def _evaluate_point(self, y: Real) -> tuple[Real | None, Real | None]:
        """Return x(y) and dx/dy, cached for the last y; None if Newton's method fails."""
        key = y.tobytes()
        if key != self._last[0]:
            self._last = (key, *self._solve_point(y))
        return self._last[1:]

    def _solve_point(self, y: Real) -> tuple[Real | None, Real | None]:
        free = self.problem._free
        x = self.x0.copy()
        x[free] += self.tangent.T @ y
        values, jacobian = self.problem._evaluate_constraints(x)
        if not len(values):
            return x, self.tangent.T
        for _ in range(NEWTON_STEPS):
            # Steps are orthogonal to the tangent space, so y stays the coordinates of the point.
            matrix = np.concatenate([jacobian[:, free], self.tangent])
            try:
                if np.abs(values).max() <= CONSTRAINT_TOLERANCE:
                    right = np.concatenate([np.zeros((len(values), len(y))), np.eye(len(y))])
                    return x, np.linalg.solve(matrix, right)
                x[free] -= np.linalg.solve(matrix, np.concatenate([values, np.zeros(len(y))]))
            except np.linalg.LinAlgError:
                return None, None
            # The comparison is negated to catch NaN as well.
            if not np.abs(x).max() < LOST_RESIDUAL:
                return None, None
            values, jacobian = self.problem._evaluate_constraints(x)
        return None, None

    def _compute_residuals(self, y: Real) -> Real:
        x, _ = self._evaluate_point(y)
        if x is None:
            # A huge constant residual makes the solver shorten its step.
            return np.full(2 * len(self.problem._near) + len(self.problem._loose), LOST_RESIDUAL)
        return self.problem._compute_residuals(x, MAX_LINEARIZATIONS)

    def _compute_jacobian(self, y: Real) -> Real:
        x, by_y = self._evaluate_point(y)
        if x is None or by_y is None:
            return np.zeros((2 * len(self.problem._near) + len(self.problem._loose), len(y)))
        return np.asarray(self.problem._compute_jacobian(x)[:, self.problem._free] @ by_y)


def fit_surface(demands: PoseConstraints, surface: Surface, numbers: Real, fixed: Mask = _NO_NUMBERS) -> Fit:
    """Fit one dyad to all poses, to first order; exact coordinates weigh ten times as much as the others.

    The result is a starting point for pairs: most good pairs consist of such dyads.
    """
    least = float(np.min(demands.tolerances[demands.tolerances > 0.0], initial=1.0))
    # Exact coordinates are soft here, with a small tolerance, because a single dyad often cannot meet them.
    variances = np.where(demands.tolerances > 0.0, demands.tolerances, EXACT_TOLERANCE_SHARE * least) ** 2
    free = ~fixed
    free[4] &= surface.curved
    whole = numbers.copy()

    def evaluate(x: Real) -> tuple[Real, Real]:
        whole[free] = x
        residuals, jacobian = np.empty(len(demands.poses)), np.empty((len(demands.poses), DYAD_NUMBER_COUNT))
        compute_surface_distances(
            surface.inverted, complex(surface.origin), whole, demands.poses, variances, residuals, jacobian
        )
        return residuals, jacobian[:, free]

    ended = fit(
        lambda x: evaluate(x)[0],
        lambda x: evaluate(x)[1],
        numbers[free],
        tolerance=ROUGH_TOLERANCE,
        evaluations=MAX_ROUGH_EVALUATIONS,
    )
    whole[free] = ended.point
    return ended._replace(point=whole)
