"""Compiled reactions with Coulomb friction at each position.

With A x = b the frictionless equations, y the friction of each contact and W their wrenches on the links,
A x = b − W y, so that x = x₀ − V y with A V = W. Friction is y_e = c_e ‖x on the columns of contact e‖, where c_e is
the lever of the friction with the sign that opposes the motion. This is a fixed-point problem with one unknown for each
contact. It is solved by iteration from the frictionless solution and, where that does not converge, by Newton's method
with halved steps.

Where K_ef = |c_e| ‖V_f on the columns of e‖ has a spectral radius below 1 the iteration is a contraction and the
solution is unique. Elsewhere Newton's method is also started far out in all directions. No solution, or a second one,
is a jam: the parts wedge, and the motion does not determine the forces.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from kinematics.arrays import Complex, Integers, Real
from kinematics.compiling import njit
from kinematics.dynamics.kernels import (
    OPTIONS,
    compute_norm,
    estimate_inverse_norm,
    factorise,
    fill_terms,
    solve_factors,
)

MAX_ITERATIONS = 200
"""Maximum number of steps of the fixed-point iteration, and of Newton's method."""

CONVERGENCE_TOLERANCE = 1e-12
"""Relative change of friction below which the iteration has converged."""

MAX_HALVINGS = 30
"""Maximum number of halvings of a Newton step."""

FAR_START_DISTANCE = 1e3
"""Distance of the far starts of Newton's method, in units of the friction caused by the frictionless forces."""

DISTINCT_TOLERANCE = 1e-6
"""Relative difference above which two solutions are distinct."""

POWER_STEPS = 30
"""Steps of the power iteration that bounds the spectral radius."""


@njit(**OPTIONS)
def _subtract_frictions(free: Real, answers: Real, y: Real, solution: Real) -> None:
    """Write the solution with friction: the frictionless one minus the response to the frictions y."""
    for row in range(len(free)):
        total = free[row]
        for e in range(len(y)):
            total -= answers[e, row] * y[e]
        solution[row] = total


@njit(**OPTIONS)
def solve_friction(
    terms: Integers,
    coefficients: Real,
    bases: Integers,
    contact_terms: Integers,
    contact_coefficients: Real,
    columns: Integers,
    factors: Real,
    joints: Complex,
    directions: Complex,
    known: Real,
    smooth: NDArray[np.bool_],
    solutions: Real,
    conditions: Real,
    frictions: Real,
    jammed: NDArray[np.bool_],
) -> None:
    """Solve at all positions. Parameters in addition to :func:`kinematics.dynamics.kernels.solve_positions`:

    contact_terms, contact_coefficients
        Wrenches of the contacts, as terms of E columns.
    columns : int, shape (E, 2)
        Columns whose norm is proportional to the friction of a contact; −1: none.
    factors : float, shape (E, M)
        Friction per unit of that norm, with its sign.
    frictions : float, shape (E, M)
        Filled: friction of each contact; NaN without a solution.
    jammed : bool, shape (M,)
        Filled: no solution, or more than one.
    """
    count, n = known.shape
    contacts = len(columns)
    matrix, order, work = np.empty((n, n)), np.empty(n, np.int64), np.empty((3, n))
    wrenches, answers = np.empty((n, contacts)), np.empty((contacts, n))
    free, y, other = np.empty(n), np.empty(contacts), np.empty(contacts)
    for at in range(count):
        solutions[at] = np.nan
        frictions[:, at] = np.nan
        conditions[at] = np.inf
        jammed[at] = False
        # Derivatives, and therefore inertia forces, do not exist at a toggle.
        if not smooth[at]:
            continue
        matrix[:] = 0.0
        wrenches[:] = 0.0
        fill_terms(terms, coefficients, bases, joints, directions, at, matrix)
        fill_terms(contact_terms, contact_coefficients, bases, joints, directions, at, wrenches)
        norm = compute_norm(matrix)
        if not factorise(matrix, order):
            continue
        conditions[at] = norm * estimate_inverse_norm(matrix, order, work)
        free[:] = known[at]
        solve_factors(matrix, order, free)
        for e in range(contacts):
            answers[e] = wrenches[:, e]
            solve_factors(matrix, order, answers[e])
        y[:] = 0.0
        # The cheap iteration succeeds for usual coefficients; Newton's method is the fallback.
        found = iterate_friction(free, answers, columns, factors[:, at], y)
        if not found:
            y[:] = 0.0
            found = solve_newton(free, answers, columns, factors[:, at], y)
        # Uniqueness is proved by contraction, else only tested by searching for a second solution.
        if found and not is_contraction(answers, columns, factors[:, at]):
            found = is_unique(free, answers, columns, factors[:, at], y, other)
        jammed[at] = not found
        if not found:
            continue
        _subtract_frictions(free, answers, y, solutions[at])
        frictions[:, at] = y


@njit(**OPTIONS)
def compute_contact_norm(free: Real, answers: Real, pair: Integers, y: Real) -> tuple[float, float, float]:
    """Compute the norm on the columns of a contact, and its two components."""
    one, two = free[pair[0]], 0.0
    for f in range(len(y)):
        one -= answers[f, pair[0]] * y[f]
    if pair[1] >= 0:
        two = free[pair[1]]
        for f in range(len(y)):
            two -= answers[f, pair[1]] * y[f]
    return math.hypot(one, two), one, two


@njit(**OPTIONS)
def iterate_friction(free: Real, answers: Real, columns: Integers, factors: Real, y: Real) -> bool:
    """Iterate to the fixed point from y, in place; return whether it converged."""
    fresh = np.empty_like(y)
    for _ in range(MAX_ITERATIONS):
        change, size = 0.0, 0.0
        for e in range(len(y)):
            fresh[e] = factors[e] * compute_contact_norm(free, answers, columns[e], y)[0]
        for e in range(len(y)):
            change = max(change, abs(fresh[e] - y[e]))
            size = max(size, abs(fresh[e]))
            y[e] = fresh[e]
        # Diverged: the iteration is no contraction here.
        if not math.isfinite(size):
            return False
        if change <= CONVERGENCE_TOLERANCE * size:
            return True
    return False


@njit(**OPTIONS)
def compute_residual(free: Real, answers: Real, columns: Integers, factors: Real, y: Real, out: Real) -> float:
    """Fill the residual, y minus the friction of the forces that y causes, and return its largest magnitude."""
    largest = 0.0
    for e in range(len(y)):
        out[e] = y[e] - factors[e] * compute_contact_norm(free, answers, columns[e], y)[0]
        largest = max(largest, abs(out[e]))
    return largest


@njit(**OPTIONS)
def solve_newton(free: Real, answers: Real, columns: Integers, factors: Real, y: Real) -> bool:
    """Solve by Newton's method with halved steps from y, in place; return whether it converged."""
    contacts = len(y)
    jacobian, order = np.empty((contacts, contacts)), np.empty(contacts, np.int64)
    step, trial, rest = np.empty(contacts), np.empty(contacts), np.empty(contacts)
    error = compute_residual(free, answers, columns, factors, y, step)
    for _ in range(MAX_ITERATIONS):
        size = 0.0
        for e in range(contacts):
            size = max(size, abs(y[e]))
        if error <= CONVERGENCE_TOLERANCE * size or error == 0.0:
            return True
        for e in range(contacts):
            norm, one, two = compute_contact_norm(free, answers, columns[e], y)
            for f in range(contacts):
                slope = 0.0
                # At zero norm the derivative does not exist; 0 is a subgradient.
                if norm > 0.0:
                    slope = one * answers[f, columns[e, 0]]
                    if columns[e, 1] >= 0:
                        slope += two * answers[f, columns[e, 1]]
                    slope *= -factors[e] / norm
                jacobian[e, f] = (1.0 if e == f else 0.0) - slope
        # A singular Jacobian gives no direction.
        if not factorise(jacobian, order):
            return False
        solve_factors(jacobian, order, step)
        share = 1.0
        for _ in range(MAX_HALVINGS):
            for e in range(contacts):
                trial[e] = y[e] - share * step[e]
            fresh = compute_residual(free, answers, columns, factors, trial, rest)
            if fresh < error:
                break
            share *= 0.5
        # No descent along the Newton direction: a local minimum of the residual, not a solution.
        if not fresh < error:
            return False
        y[:] = trial
        step[:] = rest
        error = fresh
    return False


@njit(**OPTIONS)
def is_contraction(answers: Real, columns: Integers, factors: Real) -> bool:
    """Return whether the iteration contracts: the spectral radius of K is below 1 (Collatz-Wielandt bound)."""
    contacts = len(columns)
    z, image = np.ones(contacts), np.empty(contacts)
    for _ in range(POWER_STEPS):
        bound = 0.0
        for e in range(contacts):
            # A small multiple of z keeps z positive, so that the bound also holds for a K with zero rows.
            total = 1e-3 * z[e]
            for f in range(contacts):
                two = answers[f, columns[e, 1]] if columns[e, 1] >= 0 else 0.0
                total += abs(factors[e]) * math.hypot(answers[f, columns[e, 0]], two) * z[f]
            image[e] = total
            bound = max(bound, total / z[e])
        if bound < 1.0:
            return True
        z[:] = image / image.max()
    return False


@njit(**OPTIONS)
def is_unique(free: Real, answers: Real, columns: Integers, factors: Real, y: Real, other: Real) -> bool:
    """Return whether Newton's method, started far out along ± each axis, finds no other solution than y."""
    contacts = len(y)
    # Scale of friction from the frictionless forces, to choose starts far outside the solution.
    reach = 0.0
    for e in range(contacts):
        reach = max(reach, abs(factors[e]) * compute_contact_norm(free, answers, columns[e], 0.0 * y)[0], abs(y[e]))
    for e in range(contacts):
        for sense in (-1.0, 1.0):
            other[:] = y
            other[e] += sense * FAR_START_DISTANCE * reach
            if solve_newton(free, answers, columns, factors, other):
                for f in range(contacts):
                    if abs(other[f] - y[f]) > DISTINCT_TOLERANCE * reach:
                        return False
    return True
