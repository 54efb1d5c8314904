"""Convex programs over motions given by knots: formulation, and solution by cvxpy and Clarabel.

The unknowns are the states (s, s′, …) of one or more motions at their knots, a constant control u = dᵐs/dtᵐ on each
step, and a few scalars z that the motions share (the peak to be minimized, the preload, the position of the follower).
Everything is linear in the unknowns except the objective:

    minimize z₀, or a Euclidean norm of some scalars, or ∫ (dᵖs/dtᵖ)² dt

subject to Taylor's formula from knot to knot (:mod:`synthesis.kinds.cam.program.knots`), conditions, limits and
demands. A limit or demand is imposed on every Bernstein coefficient of its left-hand side on every step, so that it
holds between the knots as well. The equations only couple neighbouring knots, so that the interior-point solver
factors a banded matrix, and the time grows in proportion to the number of knots. Each motion runs over 0 ≤ t ≤ 1; the
caller scales it to a unit lift.

The multipliers of the solution are kept. From them, :mod:`synthesis.kinds.cam.program.dual_bound` derives a bound for
all motions, with knots or without.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.cam.program.knots import KnotMotion, integrate_control
from synthesis.numerics.convex import import_cvxpy, solve_convex_program

RANK_TOLERANCE = 1e-12
"""Share of the largest singular value below which others count as zero: they come from redundant conditions."""

VARIABLE_SCALE = 0.1
"""Base of the scale 0.1ⁱ of the i-th derivative in the program: derivatives of a unit lift grow about as 10ⁱ."""

KNOT_TOLERANCE = 1e-9
"""Maximum difference of a time from a knot with which it coincides."""


@dataclass(frozen=True)
class Condition:
    """The equation Σ coefficient · dᵒʳᵈᵉʳs/dt at given knots = value. Most conditions have one term."""

    terms: tuple[tuple[float, int, float], ...]
    value: float

    @classmethod
    def fix_derivative(cls, time: float, order: int, value: float) -> Condition:
        """Return the condition that the derivative of the given order has a value at a time."""
        return cls(((time, order, 1.0),), value)


@dataclass(frozen=True)
class Limit:
    """The inequality |dᵒʳᵈᵉʳs/dt| ≤ constant + gain · z₀ throughout the motion."""

    order: int
    constant: float
    gain: float = 0.0


@dataclass(frozen=True)
class Demand:
    """The inequality Σ weights[i] dⁱs/dtⁱ + Σ gains[j] z_j ≤ right for start ≤ t ≤ end."""

    weights: tuple[float, ...]
    right: float
    gains: tuple[float, ...] = ()
    start: float = 0.0
    end: float = 1.0

    @property
    def order(self) -> int:
        """The highest derivative involved."""
        return max((i for i, weight in enumerate(self.weights) if weight), default=0)


@dataclass(frozen=True)
class Block:
    """One motion of a program: its grid, the order of its control, and its constraints."""

    times: Real
    size: int
    conditions: tuple[Condition, ...]
    limits: tuple[Limit, ...] = ()
    demands: tuple[Demand, ...] = ()

    def find_knot(self, time: float) -> int:
        """Return the index of the knot at a time; the grid has one at every condition."""
        index = int(np.abs(self.times - time).argmin())
        if abs(self.times[index] - time) > KNOT_TOLERANCE:
            raise ValueError(f"a condition is set at {time}, but the grid has no knot there")
        return index

    def select_knots(self, demand: Demand) -> slice:
        """Return the knots at which a demand holds; it also holds on the steps between them."""
        return slice(self.find_knot(demand.start), self.find_knot(demand.end) + 1)


@dataclass(frozen=True)
class ConvexProgram:
    """A convex program: motions, shared scalars and the objective to minimize.

    Parameters
    ----------
    blocks : tuple of Block
        The motions.
    objective : {"scalar", "norm", "rms"}
        z₀, the Euclidean norm of all scalars, or the root mean square of dᵖs/dtᵖ of the only motion.
    rms_order : int
        p of the objective "rms".
    rows, right : float64, shapes (k, scalars) and (k,)
        Constraints on the scalars alone: rows @ z ≤ right.
    box : float64, shape (scalars,)
        Bounds of |z|. The first scalar is not bounded if it is the objective.
    """

    blocks: tuple[Block, ...]
    objective: Literal["scalar", "norm", "rms"]
    rms_order: int = 0
    rows: Real = field(default_factory=lambda: np.empty((0, 0)))
    right: Real = field(default_factory=lambda: np.empty(0))
    box: Real = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True)
class Weights:
    """Multipliers of one inequality, at its knots and for its inner coefficients on the steps between them."""

    knots: Real
    steps: Real


@dataclass(frozen=True)
class Multipliers:
    """Multipliers of a block: of its conditions, its limits (above, below) and its demands."""

    conditions: Real
    limits: tuple[tuple[Weights, Weights], ...]
    demands: tuple[Weights, ...]


@dataclass(frozen=True)
class Solution:
    """The result of the solver: exact motions, scalars and multipliers."""

    motions: tuple[KnotMotion, ...]
    scalars: Real
    multipliers: tuple[Multipliers, ...]
    row_multipliers: Real


def solve(program: ConvexProgram) -> Solution | None:
    """Solve a program.

    Parameters
    ----------
    program : ConvexProgram
        The formulation.

    Returns
    -------
    Solution or None
        Its motions are integrated from their controls and satisfy every condition to rounding. None if the program
        has no solution on its grid, or if the solver finds none.
    """
    cp = import_cvxpy()

    scalars = len(program.box)
    z: Any = cp.Variable(scalars) if scalars else None
    constraints: list[Any] = []
    models = []
    for block in program.blocks:
        model = BlockModel(block, z)
        constraints += model.constraints
        models.append(model)
    rows: Any = None
    if len(program.right):
        rows = program.rows @ z <= program.right
        constraints.append(rows)
    # z₀ is the objective itself and needs no box; its duality gap would gain nothing from one.
    boxed = range(1 if program.objective == "scalar" else 0, scalars)
    constraints += [cp.abs(z[j]) <= program.box[j] for j in boxed]
    worth = 1.0
    if program.objective == "scalar":
        cost = z[0]
    elif program.objective == "norm":
        cost = cp.norm(z, 2)
    else:
        cost = models[0].build_mean_square(program.rms_order)
        # The solver minimizes the scaled derivative, but the multipliers refer to the unscaled one.
        worth = float(models[0].scale[program.rms_order]) ** 2
    if not solve_convex_program(cost, constraints):
        return None
    return Solution(
        tuple(model.motion() for model in models),
        np.zeros(0) if z is None else np.asarray(z.value, np.float64),
        tuple(model.multipliers(worth) for model in models),
        np.zeros(0) if rows is None else np.asarray(rows.dual_value, np.float64).reshape(-1),
    )


class BlockModel:
    """The variables and constraints of one motion."""

    def __init__(self, block: Block, z: Any) -> None:
        cp = import_cvxpy()

        self.block = block
        n, m = len(block.times) - 1, block.size
        # Without this scaling the Taylor equations mix numbers over many orders of magnitude.
        self.scale = VARIABLE_SCALE ** -np.arange(m + 1.0)
        self.states = cp.Variable((n + 1, m))
        self.control = cp.Variable(n)
        step = np.diff(block.times) / VARIABLE_SCALE
        self.constraints: list[Any] = []
        # One equation per state and step: x_i(t + h) by Taylor's formula, in the scaled variables.
        for i in range(m):
            following = cp.multiply(step ** (m - i) / math.factorial(m - i), self.control)
            for j in range(i, m):
                following = following + cp.multiply(step ** (j - i) / math.factorial(j - i), self.states[:-1, j])
            self.constraints.append(self.states[1:, i] == following)
        self.conditions = [self._build_condition(condition) for condition in block.conditions]
        self.limits = [self._build_limit(limit, z) for limit in block.limits]
        self.demands = [self._build_demand(demand, z) for demand in block.demands]
        self.constraints += self.conditions
        for inequality in [*(one for pair in self.limits for one in pair), *self.demands]:
            self.constraints += [inequality.knots, *inequality.inner]

    def build_mean_square(self, order: int) -> Any:
        """Build ∫ (dᵖs/dtᵖ)² dt: exact for the control and the highest state, by Simpson's rule for lower ones."""
        cp = import_cvxpy()

        step = np.diff(self.block.times)
        if order == self.block.size:
            return cp.sum_squares(cp.multiply(np.sqrt(step), self.control))
        value = self.states[:, order]
        root = np.sqrt(step / 6.0)
        # Simpson on a step: (x² + y² + (x + y)²)/6 is exact for the square of a linear function.
        parts = value[:-1], value[1:], value[:-1] + value[1:]
        return sum(cp.sum_squares(cp.multiply(root, part)) for part in parts)

    def motion(self) -> KnotMotion:
        """Return the solved motion, corrected by the smallest change of its control that meets every condition."""
        block = self.block
        m = block.size
        start = np.asarray(self.states.value[0], np.float64) * self.scale[:m]
        control = np.asarray(self.control.value, np.float64) * self.scale[m]
        return correct_motion(block, start, control)

    def multipliers(self, worth: float) -> Multipliers:
        """Return the multipliers in unscaled units; the objective is ``worth`` times that in scaled variables."""
        conditions = [
            worth * float(np.asarray(constraint.dual_value)) * self._condition_scale(condition)
            for constraint, condition in zip(self.conditions, self.block.conditions, strict=True)
        ]
        limits = [(above.weights(worth), below.weights(worth)) for above, below in self.limits]
        demands = [demand.weights(worth) for demand in self.demands]
        return Multipliers(np.array(conditions), tuple(limits), tuple(demands))

    def _condition_scale(self, condition: Condition) -> float:
        """Return the scale of a condition, which the solver gets in the scaled variable of its highest order."""
        return 1.0 / float(self.scale[max(order for _, order, _ in condition.terms)])

    def _build_condition(self, condition: Condition) -> Any:
        worth = self._condition_scale(condition)
        total = sum(
            worth * coefficient * self.scale[order] * self.states[self.block.find_knot(at), order]
            for at, order, coefficient in condition.terms
        )
        return total == worth * condition.value

    def _build_limit(self, limit: Limit, z: Any) -> tuple[_Inequality, _Inequality]:
        gains = (-limit.gain,) if limit.gain else ()
        unit = (0.0,) * limit.order
        above = Demand((*unit, 1.0), limit.constant, gains)
        below = Demand((*unit, -1.0), limit.constant, gains)
        # A limit on the control itself is constant on each step and needs no Bernstein coefficients.
        if limit.order < self.block.size:
            return self._build_demand(above, z), self._build_demand(below, z)
        bound = limit.constant + (limit.gain * z[0] if limit.gain else 0.0)
        scale = float(self.scale[limit.order])
        return (
            _Inequality(self.control <= bound / scale, [], scale),
            _Inequality(-self.control <= bound / scale, [], scale),
        )

    def _build_demand(self, demand: Demand, z: Any) -> _Inequality:
        """Impose a demand at its knots and on the inner Bernstein coefficients on its steps."""
        cp = import_cvxpy()

        knots = self.block.select_knots(demand)
        steps = slice(knots.start, knots.stop - 1)
        scale = float(self.scale[demand.order])
        step = np.diff(self.block.times)[steps]
        # The lowest derivative involved has the highest degree, which determines the number of coefficients.
        least = next((i for i, weight in enumerate(demand.weights) if weight), 0)
        degree = self.block.size - least
        inner: list[Any] = [0.0] * max(degree - 1, 0)
        total: Any = 0.0
        for order, weight in enumerate(demand.weights):
            if not weight:
                continue
            total = total + (weight * self.scale[order] / scale) * self.states[knots, order]
            for j in range(1, degree):
                for up in range(min(j, self.block.size - order) + 1):
                    # This is Bernstein coefficient j of the derivative's Taylor expansion on the step.
                    share = weight * math.comb(j, up) / math.comb(degree, up) / math.factorial(up)
                    factor = share * step**up * self.scale[order + up] / scale
                    high = order + up
                    held = self.control[steps] if high == self.block.size else self.states[steps, high]
                    inner[j - 1] = inner[j - 1] + cp.multiply(factor, held)
        right: Any = demand.right / scale
        for j, gain in enumerate(demand.gains):
            if gain:
                right = right - gain / scale * z[j]
        return _Inequality(total <= right, [each <= right for each in inner], scale)


@dataclass(frozen=True)
class _Inequality:
    """The constraints of one limit or demand, in units of ``scale``."""

    knots: Any
    inner: list[Any]
    scale: float

    def weights(self, worth: float) -> Weights:
        """Read the multipliers; an interior-point solver keeps them non-negative only to rounding."""
        factor = worth / self.scale
        knots = np.maximum(np.asarray(self.knots.dual_value, np.float64).reshape(-1), 0.0) * factor
        # All inner coefficients of a step share its weight.
        steps = np.zeros(len(knots) - 1)
        for each in self.inner:
            steps += np.maximum(np.asarray(each.dual_value, np.float64).reshape(-1), 0.0) * factor
        return Weights(knots, steps)


def correct_motion(block: Block, start: Real, control: Real) -> KnotMotion:
    """Integrate a control from a start state so that all conditions hold to rounding.

    The conditions are linear in the start state and the control. Their residual is removed by the smallest change,
    measured by the mean square of the control and by the start state.
    """
    m, step = block.size, np.diff(block.times)
    root = np.sqrt(step)
    matrix = np.zeros((len(block.conditions), m + len(control)))
    for row, condition in zip(matrix, block.conditions, strict=True):
        for at, order, coefficient in condition.terms:
            knot = block.find_knot(at)
            time = block.times[knot] - block.times[0]
            # Influence of the start state, and of each step's constant control, on the derivative at the knot.
            for i in range(order, m):
                row[i] += coefficient * time ** (i - order) / math.factorial(i - order)
            power = m - order
            left, right = block.times[knot] - block.times[:knot], block.times[knot] - block.times[1 : knot + 1]
            row[m : m + knot] += coefficient * (left**power - right**power) / math.factorial(power)
    scaled = matrix.copy()
    # In the variables control·√step, the squared norm of the change is its mean square over time.
    scaled[:, m:] /= root
    motion = integrate_control(block.times, start, control)
    # The second pass removes the rounding of the first.
    for _ in range(2):
        gap = np.array(
            [c.value - sum(k * motion.states[block.find_knot(t), i] for t, i, k in c.terms) for c in block.conditions]
        )
        change = np.linalg.lstsq(scaled, gap, rcond=RANK_TOLERANCE)[0]
        start = start + change[:m]
        control = control + change[m:] / root
        motion = integrate_control(block.times, start, control)
    return motion
