"""The motion of minimum inertia torque.

The torque that moves a mass is proportional to v a = dE/dt with E = v²/2, and in E the problem is convex: the lift
∫ √(2E) dt is a concave function of E, and a peak or mean square of dE/dt is convex (Norton §8.7 compares the torques
of the laws; the substitution is that of time-optimal control of robots, Verscheure et al., IEEE Trans. Autom.
Control 54 (2009) 2318, doi:10.1109/TAC.2009.2028959). The second-order cone program gives the velocity v̄ of the
best motion. Two things follow:

- a bound for all motions. √(2E) ≤ E/v̄ + v̄/2 for any v̄ > 0, so that any motion of lift h has
  h ≤ ∫ (E/v̄ + v̄/2) dt, and with W(t) = ∫ₜ 1/v̄ and any number α

      h − ½∫ v̄ − E(0) W(0) + α (E(1) − E(0)) ≤ ∫ (W + α) Ė dt ≤ max |Ė| ∫ |W + α| dt,  and ≤ rms(Ė) · rms(W + α);

- the motion itself, which must also have a continuous acceleration. It follows from programs over states at knots in
  which v a is replaced by v̄ a, with v bounded from above by v̄. If acceleration or jerk is limited, v̄ cannot be
  attained, and v a is replaced by its tangent at the previous motion. The bound ignores these limits, so that a gap
  remains.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.optimize import minimize_scalar

from kinematics.arrays import Real
from synthesis.kinds.cam.program.convex_programs import Block, BlockModel
from synthesis.kinds.cam.program.knots import KnotMotion
from synthesis.kinds.cam.program.piecewise import Piecewise
from synthesis.numerics.convex import import_cvxpy, solve_convex_program

MIN_VELOCITY_SHARE = 1e-9
"""Share of the maximum velocity that replaces zero at rest, so that 1/v̄ stays finite."""

MAX_PASSES = 4
"""Maximum number of passes, each of which solves one program."""

VELOCITY_SLACK = 1e-3
"""Permitted excess of v over v̄, as a share, which compensates for the loss where the acceleration cannot jump."""

MAX_STEP_CHANGE = 0.1
"""Change of v a within a step, as a share of its peak, above which the next pass divides the step."""

PART_COUNT = 6
"""Number of parts into which such a step is divided."""

MIN_GAIN = 1e-4
"""Relative gain of a pass below which no further pass follows."""


@dataclass(frozen=True)
class LeastTorque:
    """A motion, the exact peak or root mean square of its v a, and the lower bound for all motions."""

    motion: KnotMotion
    value: float
    bound: float


def multiply_rates(motion: KnotMotion) -> Piecewise:
    """Return v a of a motion, exactly."""
    v, a = motion.derivative(1).coefficients, motion.derivative(2).coefficients
    product = np.zeros((len(v), v.shape[1] + a.shape[1] - 1))
    for k in range(a.shape[1]):
        product[:, k : k + v.shape[1]] += a[:, k : k + 1] * v
    return Piecewise(motion.times, product)


def solve_least_torque(
    block: Block, measure: Literal["peak", "rms"], lift: float, ends: tuple[float, float]
) -> LeastTorque | None:
    """Find the motion of minimum peak or root mean square of v a.

    Parameters
    ----------
    block : Block
        Grid over 0 ≤ t ≤ 1, conditions and limits of the motion.
    measure : {"peak", "rms"}
        Whether the peak or the root mean square of v a is minimized.
    lift : float
        Distance between the first and the last position, positive.
    ends : tuple of two floats
        Velocities at the ends.

    Returns
    -------
    LeastTorque or None
        None if no motion meets the conditions and limits on this grid.
    """
    velocity = _solve_velocity(block.times, measure, lift, ends)
    if velocity is None:
        return None
    bound = _bound_torque(block.times, velocity, measure, lift, ends)
    limited = any(limit.order >= 2 for limit in block.limits)
    best: KnotMotion | None = None
    value = np.inf
    motion = _solve_linearized(block, measure, velocity, None, None if limited else velocity)
    for _ in range(MAX_PASSES):
        if motion is None:
            break
        product = multiply_rates(motion)
        reached = product.peak() if measure == "peak" else product.rms()
        gained = value - reached
        if reached < value:
            best, value = motion, reached
        if gained < MIN_GAIN * value:
            break
        finer = _refine_grid(block.times, product)
        block = replace(block, times=finer)
        v = np.maximum(motion.derivative(1)(finer), 0.0)
        # With limits the optimal velocity is out of reach: linearize at the last motion instead.
        motion = (
            _solve_linearized(block, measure, v, motion.derivative(2)(finer), None)
            if limited
            else _solve_linearized(block, measure, v, None, v)
        )
    return None if best is None else LeastTorque(best, float(value), bound)


def _refine_grid(times: Real, product: Piecewise) -> Real:
    """Divide the steps of the grid on which v a changes abruptly."""
    # Change of v a over each step: value at its end minus value at its start.
    change = np.abs(product.coefficients.sum(axis=1) - product.coefficients[:, 0])
    abrupt = np.flatnonzero(change > MAX_STEP_CHANGE * product.peak())
    parts = [times[k] + np.diff(times)[k] * np.arange(1, PART_COUNT) / PART_COUNT for k in abrupt]
    return np.sort(np.concatenate([times, *parts]))


def _solve_velocity(times: Real, measure: str, lift: float, ends: tuple[float, float]) -> Real | None:
    """Solve the cone program in E for v̄ at the knots, with the given lift as the minimum."""
    cp = import_cvxpy()

    step = np.diff(times)
    energy, speed = cp.Variable(len(times), nonneg=True), cp.Variable(len(times))
    rate = cp.multiply(1.0 / step, cp.diff(energy))
    constraints = [
        energy[0] == 0.5 * ends[0] ** 2,
        energy[-1] == 0.5 * ends[1] ** 2,
        # A relaxation: speed ≤ √(2E) is convex, and the objective makes it active.
        speed <= cp.sqrt(2.0 * energy),
        0.5 * step @ (speed[1:] + speed[:-1]) >= lift,
    ]
    cost = cp.norm(rate, "inf") if measure == "peak" else cp.sum_squares(cp.multiply(np.sqrt(step), rate))
    if not solve_convex_program(cost, constraints):
        return None
    return np.sqrt(2.0 * np.maximum(np.asarray(energy.value, np.float64), 0.0))


def _bound_torque(times: Real, velocity: Real, measure: str, lift: float, ends: tuple[float, float]) -> float:
    """Compute the bound of the module's docstring, for v̄ constant on each step and the best α."""
    step = np.diff(times)
    # 1/v̄ must stay finite at rest, where v̄ vanishes.
    mean = np.maximum(0.5 * (velocity[1:] + velocity[:-1]), MIN_VELOCITY_SHARE * velocity.max())
    at_left = np.cumsum((step / mean)[::-1])[::-1]
    first, last = 0.5 * ends[0] ** 2, 0.5 * ends[1] ** 2
    known = lift - 0.5 * float(mean @ step) - first * float(at_left[0])

    def evaluate_bound(alpha: float) -> float:
        weight = Piecewise(times, np.column_stack([at_left + alpha, -step / mean]))
        size = weight.convex_integral(np.abs) if measure == "peak" else weight.rms()
        return (known + alpha * (last - first)) / size

    # The bound is concave in α; the weight W + α changes sign only for −W(0) < α < 0.
    maximum = minimize_scalar(lambda alpha: -evaluate_bound(alpha), bounds=(-float(at_left[0]), 0.0), method="bounded")
    return max(evaluate_bound(float(maximum.x)), 0.0)


def _solve_linearized(block: Block, measure: str, v: Real, a: Real | None, ceiling: Real | None) -> KnotMotion | None:
    """Solve for the best motion, with v a replaced by its tangent at (v, a) or, without a, by v times the unknown a."""
    cp = import_cvxpy()

    model = BlockModel(block, None)
    product = cp.multiply(v * model.scale[2], model.states[:, 2])
    if a is not None:
        product = product + cp.multiply(a * model.scale[1], model.states[:, 1]) - v * a
    if measure == "peak":
        cost = cp.norm(product, "inf")
    else:
        # Simpson's rule for the square of a piecewise linear function, exact on each step.
        root = np.sqrt(np.diff(block.times) / 6.0)
        parts = product[1:], product[:-1], product[1:] + product[:-1]
        cost = sum(cp.sum_squares(cp.multiply(root, part)) for part in parts)
    constraints = list(model.constraints)
    if ceiling is not None:
        constraints.append(model.states[:, 1] * model.scale[1] <= (1.0 + VELOCITY_SLACK) * ceiling)
    return model.motion() if solve_convex_program(cost, constraints) else None
