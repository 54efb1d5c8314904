"""Lower bounds of optimal motions attacked from outside: another discretization and another solver must not beat them.

Any motion that keeps the limits is worth at least the bound. Here motions come from a linear program over piecewise
constant jerk on uneven knots of another number, written in s, v, a at the knots and solved by HiGHS; what is limited
is held to it at Bernstein coefficients, so that each is a motion and its value an upper bound of the true optimum.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import lil_matrix

from synthesis.kinds.cam.program.convex_programs import Condition, Demand, Limit
from synthesis.kinds.cam.program.optimal import NoMotion, Optimum, Run, minimize_derivative, minimize_flat_size

HONEST = 0.02
"""Share by which the motions of HiGHS, on a coarse grid, may exceed the bound: else it proves little."""


class Linear:
    """Rows on the states at knots, the jerks between them, and one more variable: what is made least."""

    def __init__(self, times):
        self.times, self.n = times, len(times) - 1
        self.size = 3 * len(times) + self.n + 1
        self.equal, self.right, self.least, self.most = [], [], [], []
        for k, h in enumerate(np.diff(times)):
            for order in range(3):
                row = {self.state(k + 1, order): -1.0, self.jerk(k): h ** (3 - order) / math.factorial(3 - order)}
                for higher in range(order, 3):
                    row[self.state(k, higher)] = h ** (higher - order) / math.factorial(higher - order)
                self.equal.append(row)
                self.right.append(0.0)

    def state(self, k, order):
        return 3 * k + order

    def jerk(self, k):
        return 3 * len(self.times) + k

    @property
    def peak(self):
        return self.size - 1

    def fix(self, at, order, value):
        self.equal.append({self.state(int(np.argmin(np.abs(self.times - at))), order): 1.0})
        self.right.append(value)

    def coefficients(self, k, order):
        """Bernstein coefficients of the derivative on a step: linear forms whose greatest bounds it."""
        if order == 3:
            return [{self.jerk(k): 1.0}]
        h, degree = float(np.diff(self.times)[k]), 3 - order
        power = [{self.state(k, order + i): h**i / math.factorial(i)} for i in range(degree)]
        power.append({self.jerk(k): h**degree / math.factorial(degree)})
        found = []
        for j in range(degree + 1):
            form = {}
            for i in range(j + 1):
                for column, value in power[i].items():
                    form[column] = form.get(column, 0.0) + value * math.comb(j, i) / math.comb(degree, i)
            found.append(form)
        return found

    def at_most(self, form, most):
        self.least.append(form)
        self.most.append(most)

    def solved(self):
        """The least peak; infinite where no motion keeps the limits."""

        def matrix(rows):
            found = lil_matrix((len(rows), self.size))
            for r, row in enumerate(rows):
                for column, value in row.items():
                    found[r, column] = value
            return found.tocsr()

        cost = np.zeros(self.size)
        cost[self.peak] = 1.0
        answer = linprog(
            cost,
            A_ub=matrix(self.least),
            b_ub=self.most,
            A_eq=matrix(self.equal),
            b_eq=self.right,
            bounds=[(None, None)] * self.size,
            method="highs-ds",
        )
        assert answer.status in (0, 2), answer.message
        return float(answer.fun) if answer.status == 0 else math.inf


def limited(program, order, limit=None):
    """|derivative| ≤ limit, or ≤ the peak that is made least."""
    for k in range(program.n):
        for form in program.coefficients(k, order):
            for sign in (1.0, -1.0):
                row = {column: sign * value for column, value in form.items()}
                program.at_most(row if limit is not None else row | {program.peak: -1.0}, limit or 0.0)


def knots(rng, marks, count=150):
    """Uneven, with a knot at each mark."""
    steps = rng.uniform(0.7, 1.3, count)
    times = np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])
    for mark in marks:
        times[np.argmin(np.abs(times - mark))] = mark
    return np.unique(times)


def random_run(rng, order):
    """A rise from rest to rest of random lift and angle, perhaps with a condition within, and random limits."""
    angle, lift = float(rng.uniform(0.3, 4.0)), float(10.0 ** rng.uniform(-3.0, 3.0))
    conditions = [
        Condition.fix_derivative(at, i, lift * (i == 0 and at > 0.0)) for at in (0.0, angle) for i in range(3)
    ]
    inner = []
    if rng.random() < 0.6:
        inner = [(float(rng.uniform(0.3, 0.7)), 0, float(rng.uniform(0.35, 0.65)))]
        conditions += [Condition.fix_derivative(t * angle, i, x * lift / angle**i) for t, i, x in inner]
    share = {1: (None, 12.0, 90.0), 2: (2.6, None, 90.0), 3: (2.6, 14.0, None)}[order]
    limits = {i: s * float(rng.uniform(1.0, 2.0)) for i, s in enumerate(share, 1) if s is not None}
    stated = tuple(Limit(i, s * lift / angle**i) for i, s in limits.items())
    return Run(angle, tuple(conditions), 2, stated), inner, limits, lift / angle**order


@pytest.mark.slow
@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("seed", range(6))
def test_no_motion_of_another_solver_beats_the_bound(seed, order):
    rng = np.random.default_rng(100 * order + seed)
    run, inner, limits, unit = random_run(rng, order)
    best = minimize_derivative(run, "peak", order)

    def other(factor=1.0):
        program = Linear(knots(np.random.default_rng(seed), [t for t, _, _ in inner]))
        for at, value in ((0.0, 0.0), (1.0, 1.0)):
            for i in range(3):
                program.fix(at, i, value if i == 0 else 0.0)
        for t, i, x in inner:
            program.fix(t, i, x)
        for i, limit in limits.items():
            limited(program, i, limit * factor)
        limited(program, order)
        return program.solved() * unit

    if isinstance(best, NoMotion):
        # The proof that no motion keeps the limits, and by what factor they are too low at least.
        assert other() == math.inf
        assert other(0.999 * best.factor) == math.inf
        assert other((1.0 + HONEST) * best.factor) < math.inf
        return
    reached = other()
    assert best.bound <= reached * (1.0 + 1e-9)
    assert reached <= best.bound * (1.0 + HONEST)
    assert best.bound <= best.value <= reached * (1.0 + 1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_no_flat_faced_cam_of_another_solver_is_smaller(seed):
    """Base radius under a radius of curvature and a band of displacements."""
    rng = np.random.default_rng(seed)
    angle, lift, rho = float(rng.uniform(0.8, 2.0)), 1.0, float(rng.uniform(0.05, 0.5))
    jerk = 60.0 * float(rng.uniform(1.0, 2.0))
    conditions = tuple(
        Condition.fix_derivative(at, i, lift * (i == 0 and at > 0.0)) for at in (0.0, angle) for i in range(3)
    )
    band = Demand((-1.0,), -0.5 * lift, (), 0.55 * angle, angle)
    run = Run(angle, conditions, 2, (Limit(3, jerk * lift / angle**3),), (band,))
    best = minimize_flat_size([run], rho, None, (0.0, 0.0, 0.0))
    assert isinstance(best, Optimum)
    program = Linear(knots(rng, [0.55]))
    for at, value in ((0.0, 0.0), (1.0, 1.0)):
        for i in range(3):
            program.fix(at, i, value if i == 0 else 0.0)
    limited(program, 3, jerk)
    # R + s + a ≥ ρ at Bernstein coefficients: both are linear forms, s raised to its own degree.
    for k in range(program.n):
        for s, a in zip(program.coefficients(k, 0), raised(program.coefficients(k, 2)), strict=True):
            row = {program.peak: -1.0}
            for form, weight in ((s, 1.0), (a, angle**-2)):
                for column, value in form.items():
                    row[column] = row.get(column, 0.0) - weight * value
            program.at_most(row, -rho)
        if program.times[k] >= 0.55 - 1e-12:
            for form in program.coefficients(k, 0):
                program.at_most({column: -value for column, value in form.items()}, -0.5)
    reached = max(program.solved(), rho)
    assert best.bound <= reached * (1.0 + 1e-9)
    assert reached <= best.bound * (1.0 + HONEST)


def raised(linear):
    """Bernstein coefficients of degree 1 as those of degree 3."""
    first, last = linear
    found = []
    for share in (0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0):
        form = {column: (1.0 - share) * value for column, value in first.items()}
        for column, value in last.items():
            form[column] = form.get(column, 0.0) + share * value
        found.append(form)
    return found
