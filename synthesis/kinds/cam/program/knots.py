"""A motion given by knots: the state at each knot, and a constant highest derivative between them.

Between two knots, h apart, the state x = (s, s′, …) follows from the constant control u = dᵐs/dtᵐ by Taylor's formula

    x_i(t + h) = Σ_{j ≥ i} x_j hʲ⁻ⁱ/(j−i)! + u hᵐ⁻ⁱ/(m−i)!

which is exact. The motion is therefore a piecewise polynomial of degree m with m − 1 continuous derivatives, and its
peaks are found exactly instead of by sampling.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.cam.program.piecewise import Piecewise


@dataclass(frozen=True)
class KnotMotion:
    """A motion on the interval [times[0], times[-1]], given by its states at the knots and its control.

    Parameters
    ----------
    times : float64, shape (n + 1,)
        The knots.
    states : float64, shape (n + 1, m)
        s and its first m − 1 derivatives at the knots.
    control : float64, shape (n,)
        The m-th derivative between the knots.
    """

    times: Real
    states: Real
    control: Real

    @cached_property
    def displacement(self) -> Piecewise:
        """Displacement s as a piecewise polynomial of degree m."""
        m = self.states.shape[1]
        h = np.diff(self.times)[:, None]
        rows = np.column_stack([self.states[:-1], self.control])
        powers = np.arange(m + 1)
        factorials = np.array([math.factorial(k) for k in powers], np.float64)
        return Piecewise(self.times, rows * h**powers / factorials)

    def derivative(self, order: int) -> Piecewise:
        """Return the derivative of the given order; 0 is the displacement itself."""
        curve = self.displacement
        for _ in range(order):
            curve = curve.derivative()
        return curve

    def combination(self, weights: tuple[float, ...]) -> Piecewise:
        """Return Σ weights[i] · dⁱs/dtⁱ."""
        m = self.states.shape[1]
        total = np.zeros((len(self.control), m + 1))
        for order, weight in enumerate(weights):
            if weight:
                coefficients = self.derivative(order).coefficients
                total[:, : coefficients.shape[1]] += weight * coefficients
        return Piecewise(self.times, total)


def integrate_control(times: Real, start: Real, control: Real) -> KnotMotion:
    """Integrate a control from a start state into a motion.

    The orders are integrated from the highest down, each by a cumulative sum, so that the steps join to rounding.
    """
    size = len(start)
    states = np.empty((len(times), size))
    step = np.diff(times)
    # State i depends on the higher ones at the left knots, which earlier passes have filled in.
    for i in range(size - 1, -1, -1):
        gained = control * step ** (size - i) / math.factorial(size - i)
        for j in range(i + 1, size):
            gained = gained + states[:-1, j] * step ** (j - i) / math.factorial(j - i)
        states[0, i] = start[i]
        states[1:, i] = start[i] + np.cumsum(gained)
    return KnotMotion(times, states, control)
