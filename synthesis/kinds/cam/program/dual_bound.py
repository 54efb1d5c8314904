"""A lower bound for all motions, from the multipliers of a program on knots.

The solver's optimum only bounds the motions on its own grid, but its multipliers prove more. Let q be the order of the
highest derivative that is limited or minimized, let u = dᵠs/dtᵠ, and let the multipliers weight the values of
s, …, dᵠ⁻¹s at the knots (atoms μ_i,k) and over steps (densities ρ_i). After integration by parts from the end, the
weighted sum over any motion is

    Σ μ_i,k s⁽ⁱ⁾(t_k) + ∫ Σ ρ_i s⁽ⁱ⁾ dt = Σ λ_i(0) s⁽ⁱ⁾(0) + ∫ r u dt,      −λ_i′ = λ_{i−1} + ρ_i,   r = λ_{q−1}

with jumps μ_i,k of the costate λ_i at the knots (Luenberger, *Optimization by Vector Space Methods*, ch. 8 and 9). Weak
duality then only requires the minimum of ∫ r u over the permitted u: −U ∫|r| for |u| ≤ U, or −¼ ∫ r² if ∫ u² is the
objective. r is a piecewise polynomial, and both integrals are bounded from above by its Bernstein coefficients. The
bound therefore holds, to the rounding of double precision, for every motion that meets the constraints, with knots or
without.

If a constraint involves the highest derivative itself together with others (a contact force without a limit on
jerk), q is one order higher. The bound then holds for all motions with a q-th derivative no larger than the peak of
the motion found; ``cap`` is that limit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.cam.program.convex_programs import (
    RANK_TOLERANCE,
    Block,
    ConvexProgram,
    Multipliers,
    Solution,
    Weights,
)
from synthesis.kinds.cam.program.knots import KnotMotion
from synthesis.kinds.cam.program.piecewise import Piecewise

COSTATE_TOLERANCE = 1e-10
"""Share of the largest multiplier below which λ(0) counts as zero."""


@dataclass(frozen=True)
class LowerBound:
    """A lower bound of the objective, and the motions for which it holds.

    ``cap`` is None if the bound holds for all motions. Otherwise it is (order, limit), and the bound holds for the
    motions with a derivative of that order below the limit.
    """

    value: float
    cap: tuple[int, float] | None


def compute_lower_bound(program: ConvexProgram, solution: Solution) -> LowerBound:
    """Return the greater of the bounds that the multipliers prove, with and without spreading them over the steps."""
    bounds = [_bound_solution(program, solution, spread) for spread in (False, True)]
    return max(bounds, key=lambda bound: bound.value)


def _bound_solution(program: ConvexProgram, solution: Solution, spread: bool) -> LowerBound:
    scalars = len(program.box)
    total = _Lagrangian(0.0, np.zeros(scalars), 0.0)
    cap = None
    for block, multipliers, motion in zip(program.blocks, solution.multipliers, solution.motions, strict=True):
        part, own_cap = _bound_block(program, block, multipliers, motion, spread)
        total = total + part
        cap = own_cap or cap
    if len(program.right):
        weights = np.maximum(solution.row_multipliers, 0.0)
        total = total + _Lagrangian(-float(weights @ program.right), weights @ program.rows, 0.0)
    return LowerBound(_maximize_scale(program, total), cap)


@dataclass(frozen=True)
class _Lagrangian:
    """The minimum over the motions, constant + gains · z − square; ``square`` is quadratic in the multipliers."""

    constant: float
    gains: Real
    square: float

    def __add__(self, other: _Lagrangian) -> _Lagrangian:
        return _Lagrangian(self.constant + other.constant, self.gains + other.gains, self.square + other.square)


def _maximize_scale(program: ConvexProgram, least: _Lagrangian) -> float:
    """Return the bound at the best scale of the multipliers, or at the one that the objective prescribes."""
    if program.objective == "rms":
        # Maximum over t ≥ 0 of t·constant − t²·square, and the root of it: the objective is a root mean
        # square.
        if least.constant <= 0.0:
            return 0.0
        if least.square <= 0.0:
            return math.sqrt(least.constant)
        return math.sqrt(least.constant**2 / (4.0 * least.square)) if least.square else 0.0
    others = np.abs(least.gains) * program.box
    if program.objective == "scalar":
        # The scale cancels the objective's own variable. The other variables take their worst value in the box.
        weight = -float(least.gains[0])
        missed = float(others[1:].sum())
    else:
        weight = float(np.linalg.norm(least.gains))
        missed = 0.0
    return max((least.constant - missed) / weight, 0.0) if weight > 0.0 else 0.0


def _bound_block(
    program: ConvexProgram, block: Block, multipliers: Multipliers, motion: KnotMotion, spread: bool
) -> tuple[_Lagrangian, tuple[int, float] | None]:
    times = block.times
    rms = program.rms_order if program.objective == "rms" else -1
    order = max([limit.order for limit in block.limits] + [rms])
    cap: tuple[int, float] | None = None
    demanded = max((demand.order for demand in block.demands), default=-1)
    # A demand on the derivative u itself requires one more order, with the peak of the motion found as the cap.
    if order <= demanded:
        order = demanded + 1
        cap = order, motion.derivative(order).peak()
    measure = _Measure(np.zeros((len(times), order)), np.zeros((len(times) - 1, order, 2)))
    constant, gains = 0.0, np.zeros(len(program.box))
    for limit, pair in zip(block.limits, multipliers.limits, strict=True):
        if limit.order < order:
            # Both sides of the limit |sⁱ| ≤ U contribute with their own multipliers.
            weight = sum(
                measure.add(times, slice(0, len(times)), limit.order, sign, one, spread)
                for sign, one in zip((1.0, -1.0), pair, strict=True)
            )
            constant -= limit.constant * weight
            if limit.gain:
                gains[0] -= limit.gain * weight
    for demand, weights in zip(block.demands, multipliers.demands, strict=True):
        weight = float(weights.knots.sum() + weights.steps.sum())
        for i, share in enumerate(demand.weights[:order]):
            if share:
                measure.add(times, block.select_knots(demand), i, share, weights, spread)
        # The right-hand sides enter the Lagrangian with a minus sign.
        constant -= demand.right * weight
        gains[: len(demand.gains)] += np.array(demand.gains) * weight
    if 0 <= rms < order:
        # (dᵖs)² ≥ 2w dᵖs − w² for any w: use the motion's own derivative, averaged over each step.
        curve = motion.derivative(rms)
        powers = np.arange(1, curve.coefficients.shape[1] + 1)
        mean = (curve.coefficients / powers).sum(axis=1)
        measure.density[:, rms, 0] += 2.0 * mean
        constant -= float(mean**2 @ curve.steps)
    stated, vanishes = _adjust_conditions(block, multipliers.conditions, measure)
    # Start states are free, so that the infimum is −∞ if λ(0) ≠ 0: the multipliers prove nothing.
    if not vanishes:
        return _Lagrangian(-math.inf, gains, 0.0), cap
    for condition, weight in zip(block.conditions, stated, strict=True):
        constant -= weight * condition.value
    _, switching = _integrate_costate(times, _with_conditions(block, stated, measure))
    return _subtract_highest(_Lagrangian(constant, gains, 0.0), block, order, switching, rms == order, cap), cap


def _subtract_highest(
    lower: _Lagrangian,
    block: Block,
    order: int,
    switching: Piecewise,
    is_objective: bool,
    cap: tuple[int, float] | None,
) -> _Lagrangian:
    """Subtract the maximum of −∫ r u over the permitted highest derivatives u, with the switching function r.

    ``is_objective`` is true if the objective integrates u².
    """
    constant, gains = lower.constant, lower.gains
    square = 0.0
    at_order = [limit for limit in block.limits if limit.order == order]
    # If the objective integrates u² and u is not limited, −min (u² + r u) = r²/4.
    if is_objective and not at_order:
        square = 0.25 * switching.convex_integral(np.square)
    elif is_objective:
        bound = at_order[0].constant
        constant -= switching.convex_integral(lambda r: _huber(r, bound))
    else:
        size = switching.convex_integral(np.abs)
        if cap is not None:
            constant -= cap[1] * size
        for limit in at_order:
            constant -= limit.constant * size
            if limit.gain:
                gains[0] -= limit.gain * size
    return _Lagrangian(constant, gains, square)


def _huber(r: Real, bound: float) -> Real:
    """Return −min(u² + r u) over |u| ≤ bound, a convex function of r."""
    size = np.abs(r)
    return np.where(size <= 2.0 * bound, 0.25 * r**2, bound * size - bound**2)


@dataclass(frozen=True)
class _Measure:
    """Weights of the values of s, …, dᵠ⁻¹s: atoms at the knots, shape (n + 1, q), and densities on the steps.

    ``density`` has shape (n, q, 2): the coefficients of 1 and x on each step.
    """

    atoms: Real
    density: Real

    def add(self, times: Real, knots: slice, order: int, share: float, weights: Weights, spread: bool) -> float:
        """Add the multipliers of a constraint that holds on a range of knots; return their sum.

        The constraint holds at every time of its range, so that the weight of a knot may also be spread over the two
        adjacent steps. If they are spread, the many small weights along a plateau give a smooth switching function
        instead of a staircase. Isolated weights are better left at their knots.
        """
        # Weights on a step become a constant density over it.
        step = np.diff(times)[knots.start : knots.stop - 1]
        rows = slice(knots.start, knots.stop - 1)
        self.density[rows, order, 0] += share * weights.steps / step
        if spread and len(step):
            # Each knot's weight becomes a hat function over its neighbouring steps with the same total.
            reach = np.zeros(len(weights.knots))
            reach[:-1] += 0.5 * step
            reach[1:] += 0.5 * step
            height = share * weights.knots / reach
            self.density[rows, order, 0] += height[:-1]
            self.density[rows, order, 1] += np.diff(height)
        else:
            self.atoms[knots, order] += share * weights.knots
        return float(weights.knots.sum() + weights.steps.sum())


def _integrate_costate(times: Real, measure: _Measure) -> tuple[Real, Piecewise]:
    """Return λ(0) and the switching function r = λ_{q−1} for weights at the knots and over the steps."""
    step = np.diff(times)
    n, order, _ = measure.density.shape
    start = np.zeros(order)
    curve = np.zeros((n, 2))
    # Integrate backwards from the end, one order at a time: −λ_i′ = λ_{i−1} + ρ_i, with jumps μ_i at the knots.
    for i in range(order):
        rate = curve.copy()
        rate[:, :2] += measure.density[:, i]
        gained = rate / np.arange(1, rate.shape[1] + 1) * step[:, None]
        whole = gained.sum(axis=1)
        at_left = np.cumsum((whole + measure.atoms[1:, i])[::-1])[::-1]
        start[i] = at_left[0] + measure.atoms[0, i]
        curve = np.column_stack([at_left, -gained])
    return start, Piecewise(times, curve)


def _with_conditions(block: Block, weights: Real, measure: _Measure) -> _Measure:
    """Add the weights of the conditions to those of the demands; drop conditions above the order q."""
    total = measure.atoms.copy()
    for condition, weight in zip(block.conditions, weights, strict=True):
        for at, order, coefficient in condition.terms:
            if order < total.shape[1]:
                total[block.find_knot(at), order] += weight * coefficient
    return _Measure(total, measure.density)


def _adjust_conditions(block: Block, weights: Real, measure: _Measure) -> tuple[Real, bool]:
    """Adjust the conditions' multipliers by the smallest change for which λ(0) vanishes, as free start states require.

    Conditions above the order q get the multiplier zero, which drops them. The second returned value is true if
    λ(0) vanishes; if it does not, the multipliers prove nothing.
    """
    order = measure.atoms.shape[1]
    used = np.array([all(i < order for _, i, _ in condition.terms) for condition in block.conditions])
    weights = np.where(used, weights, 0.0)
    influence = np.zeros((order, len(weights)))
    for column, condition in enumerate(block.conditions):
        if used[column]:
            for at, i, coefficient in condition.terms:
                for k in range(i, order):
                    influence[k, column] += coefficient * at ** (k - i) / math.factorial(k - i)
    # The second pass removes the rounding of the first.
    for _ in range(2):
        start, _ = _integrate_costate(block.times, _with_conditions(block, weights, measure))
        weights = weights - np.linalg.lstsq(influence, start, rcond=RANK_TOLERANCE)[0]
    left, _ = _integrate_costate(block.times, _with_conditions(block, weights, measure))
    return weights, bool(np.abs(left).max(initial=0.0) <= COSTATE_TOLERANCE * np.abs(weights).max(initial=1.0))
