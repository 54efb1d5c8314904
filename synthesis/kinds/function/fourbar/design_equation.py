"""Least squares in the design equation for given zeros: a convex problem with a unique optimum.

With both zeros given, a pair is linear in three numbers K (:mod:`synthesis.kinds.function.fourbar.closure`):

    fourbar       K₁ cos ψ − K₂ cos φ + K₃ = cos(φ − ψ)      a = 1/K₁, c = 1/K₂
    slider-crank  K₁ s cos θ + K₂ sin θ + K₃ = s²            a = K₁/2, e = K₂/K₁

Positive lengths, length limits, and limits on the ratios of ground, input and output are linear inequalities. The
length of the coupler and the transmission angle are not convex in K; the descent in the structural error handles them.
"""

from __future__ import annotations

import math

import numpy as np

from kinematics.arrays import Real
from synthesis.kinds.function.fourbar.constraints import GeneratorLimits
from synthesis.kinds.function.fourbar.task import FunctionTask
from synthesis.numerics.convex import import_cvxpy, solve_convex_program


def minimize_design_error(task: FunctionTask, limits: GeneratorLimits, k: float, scale: float) -> Real | None:
    """Minimize the mean square design error for given zeros; return the generator, shape (7,), or None if infeasible.

    Parameters
    ----------
    task : FunctionTask
        A task with both zeros given.
    limits : GeneratorLimits
        Limits of lengths and ratios.
    k, scale : float
        Scales of input and output.
    """
    start, zero = task.zeros
    assert start is not None
    assert zero is not None
    theta, out = start + k * task.sample_inputs, zero + scale * task.sample_outputs
    if task.problem.slides:
        matrix = np.column_stack([out * np.cos(theta), np.sin(theta), np.ones_like(theta)])
        right = out * out
    else:
        matrix = np.column_stack([np.cos(out), -np.cos(theta), np.ones_like(theta)])
        right = np.cos(theta - out)
    # Columns of unit length keep the program well conditioned when inputs or outputs vary little.
    sizes = np.linalg.norm(matrix, axis=0)
    cp = import_cvxpy()
    x = cp.Variable(3)
    # Normalise the columns for the solver; K = x / sizes.
    first, second = x[0] / sizes[0], x[1] / sizes[1]
    # The floor keeps 1/K finite without limits of the client's own.
    least = max(limits.shortest, 1.0 / limits.longest, 1e-6)
    if task.problem.slides:
        demands = [first >= 2.0 * least]
        if math.isfinite(limits.longest):
            demands.append(first <= 2.0 * limits.longest)
    else:
        ratio = limits.ratio
        # The ground is 1, so K₁ and K₂ are the ratios of the ground to input and output.
        demands = [first >= 1.0 / ratio, first <= ratio, second >= 1.0 / ratio, second <= ratio]
        # The ratio of input and output is that of K₁ and K₂, also linear.
        demands += [first <= ratio * second, second <= ratio * first]
        if math.isfinite(limits.longest):
            demands += [first >= 1.0 / limits.longest, second >= 1.0 / limits.longest]
        if limits.shortest > 0.0:
            demands += [first <= 1.0 / limits.shortest, second <= 1.0 / limits.shortest]
    if not solve_convex_program(cp.sum_squares((matrix / sizes) @ x - right), demands):
        return None
    one, two, three = (float(value) for value in x.value / sizes)
    if task.problem.slides:
        a, e = 0.5 * one, two / one
        square = three + a * a + e * e
    else:
        a, e = 1.0 / one, 1.0 / two
        square = 1.0 + a * a + e * e - 2.0 * a * e * three
    # The coupler is not part of the program; a negative square is no linkage.
    if not square > 0.0:
        return None
    return np.array([a, math.sqrt(square), e, start, zero, k, scale])
