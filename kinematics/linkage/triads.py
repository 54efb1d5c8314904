"""Mechanisms that no sequence of dyads closes (class III), followed from the reference by certified continuation.

With u_l = e^{iφ_l} for the links in motion and z = e^{i(θ − θ_ref)} for the input, every loop of pins is linear in
them,

    F(φ, θ) = C u + k z + c = 0,

one complex row a loop, as many real equations as unknown rotations φ. A solution is followed in θ by steps that cannot
leap to another: by the affine covariant Newton–Kantorovich theorem (Deuflhard and Heindl, SIAM J. Numer. Anal. 16
(1979) 1), with J = ∂F/∂φ at the solution φ for θ, there is for every θ' with

    |θ' − θ| ≤ 1 / (2 η ω),    η ≥ ‖J⁻¹ k (z' − z)‖ / |z' − z|,    ω ≥ ‖J⁻¹ (J(φ₂) − J(φ₁))‖ / ‖φ₂ − φ₁‖,

just one solution in a ball around φ; the ball is the same for all of them, so it is the continuation of φ. With the
rows of J⁻¹ written as complex ones, g, the largest of |ḡ k| over the rows serves as η and the largest sum of |ḡ C| over
the links as ω. Near a toggle both grow with the inverse root of the distance, so that the steps shrink in proportion
to it, and the toggle is approached geometrically.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from kinematics.linkage.jets import SINGULAR, turn
from kinematics.linkage.mechanism import GROUND, Mechanism, TopologyError

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

STALLED = 1e-13
"""A certified step below this, radians, means a toggle: its distance is some hundred times as large, 1e-10 or less."""

CONVERGED = 1e-14
"""Newton's correction, radians, at which a position counts as solved."""


STEPS_A_POSITION = 1000
"""Certified steps at most, on average, to each position: links of very different lengths need more than can be waited
for, and what lies beyond is then given as not reached."""

NEWTON_STEPS = 20
"""Steps at most; from inside the ball three or four do."""


class Loops(NamedTuple):
    """Loop equations of one design: C (loops, links), k and c (loops,), and the names of the unknown links in order."""

    coefficients: Complex
    by_input: Complex
    fixed: Complex
    links: tuple[str, ...]


def loop_equations(mechanism: Mechanism, joints: dict[str, complex]) -> Loops:
    """Loops of a pin-jointed mechanism from a tree of its links; ``joints`` are one design's, in unit coordinates.

    Raises
    ------
    TopologyError
        For a mechanism with slides or gears, or driven by a slide.
    """
    if mechanism.slides or mechanism.gears:
        raise TopologyError("a mechanism with slides or gears must close by dyads; this one does not")
    unknown = tuple(link for link in mechanism.links if link not in (GROUND, mechanism.input))
    column = {link: n for n, link in enumerate(unknown)}
    width = len(unknown) + 2  # unknown links, input, ground

    def along(link: str, start: str, end: str) -> Complex:
        row = np.zeros(width, np.complex128)
        index = column.get(link, width - 2 if link == mechanism.input else width - 1)
        row[index] = joints[end] - joints[start]
        return row

    # Where a joint is, as a row over (unknown links, input, ground), by each link that carries it.
    place: dict[str, Complex] = {}
    reached = [GROUND]
    for joint in mechanism.links[GROUND]:
        place[joint] = np.zeros(width, np.complex128)
        place[joint][-1] = joints[joint]
    rows: list[Complex] = []
    waiting = [mechanism.input, *unknown]
    while waiting:
        link = next((w for w in waiting if any(j in place for j in mechanism.links[w])), None)
        if link is None:
            raise TopologyError(f"the link {waiting[0]!r} is not joined to the rest")
        waiting.remove(link)
        reached.append(link)
        pin = next(j for j in mechanism.links[link] if j in place)
        for joint in mechanism.links[link]:
            here = place[pin] + along(link, pin, joint)
            if joint in place and joint != pin:
                rows.append(here - place[joint])
            elif joint not in place:
                place[joint] = here
    matrix = np.array(rows)
    return Loops(
        np.ascontiguousarray(matrix[:, : len(unknown)]),
        np.ascontiguousarray(matrix[:, -2]),
        np.ascontiguousarray(matrix[:, -1]),
        unknown,
    )


def follow(loops: Loops, rotation: Real) -> Real:
    """Rotations of the unknown links for input rotations from the reference; NaN beyond a toggle.

    Parameters
    ----------
    loops : Loops
        Of one design; at input rotation 0 all rotations are 0.
    rotation : float, shape (N,)
        Input rotations, radians, in any order, not reduced by full turns.

    Returns
    -------
    float, shape (links, N)
    """
    rotation = np.asarray(rotation, np.float64)
    found = np.full((len(loops.links), len(rotation)), np.nan)
    for side in (1.0, -1.0):
        chosen = np.flatnonzero(side * rotation >= 0.0)
        order = chosen[np.argsort(side * rotation[chosen])]
        solved = _follow(loops.coefficients, loops.by_input, loops.fixed, rotation[order])
        found[:, order] = solved.T
    return found


def rates(loops: Loops, rotation: Real, angles: Real, input_rates: Real) -> Real:
    """Time derivatives of the unknown rotations, shape (n, links, N); NaN at toggles.

    ``input_rates`` holds the input's speed, acceleration and jerk, or the first n of them, shape (n, N).
    """
    u = np.exp(1j * angles)
    z = turn(np.concatenate([rotation[None], input_rates]))
    jacobian = np.moveaxis(_real(loops.coefficients[:, :, None] * (1j * u)[None]), -1, 0)
    norms = np.linalg.norm(jacobian, axis=(1, 2))
    with np.errstate(invalid="ignore"):
        determinant = np.linalg.det(np.where(np.isfinite(jacobian), jacobian / norms[:, None, None], 0.0))
    sound = np.abs(determinant) > SINGULAR**2
    safe = np.where(sound[:, None, None], jacobian, np.eye(jacobian.shape[-1]))
    out = np.full((len(input_rates), *angles.shape), np.nan)
    w = np.zeros_like(angles)
    alpha = np.zeros_like(angles)
    for order in range(len(input_rates)):
        known = loops.by_input[:, None] * z[order + 1]
        if order == 1:
            known = known + loops.coefficients @ (u * -(w**2))
        if order == 2:
            known = known + loops.coefficients @ (u * (-3.0 * w * alpha - 1j * w**3))
        right = np.concatenate([known.real, known.imag]).T
        solved = np.linalg.solve(safe, -np.where(sound[:, None], right, 0.0)[..., None])[..., 0].T
        out[order] = np.where(sound, solved, np.nan)
        if order == 0:
            w = solved
        elif order == 1:
            alpha = solved
    return out


def _real(rows: Complex) -> Real:
    """Complex rows as real ones, real parts first."""
    return np.concatenate([rows.real, rows.imag])


@njit(cache=True, nogil=True)
def _follow(c: Complex, k: Complex, fixed: Complex, rotation: Real) -> Real:
    loops, links = c.shape
    found = np.full((len(rotation), links), np.nan)
    phi = np.zeros(links)
    at = 0.0
    value = np.empty(2 * loops)
    inverse = np.empty((links, links))
    slope = np.empty(2 * loops)
    budget = STEPS_A_POSITION * len(rotation) + 10 * STEPS_A_POSITION
    for target in range(len(rotation)):
        while at != rotation[target] or target == 0:
            budget -= 1
            if budget < 0:
                return found
            _evaluate(c, k, fixed, phi, at, value, inverse)
            certified = _certified(c, k, inverse) if np.isfinite(_invert(inverse)) else 0.0
            step = rotation[target] - at
            if abs(step) > certified:
                if certified < STALLED:
                    return found
                step = math.copysign(certified, step)
                next_at = at + step
            else:
                next_at = rotation[target]
            turned = 1j * complex(math.cos(at), math.sin(at)) * step
            for row in range(loops):
                slope[row] = (k[row] * turned).real
                slope[row + loops] = (k[row] * turned).imag
            _subtract(phi, inverse, slope)
            at = next_at
            for _ in range(NEWTON_STEPS):
                _evaluate(c, k, fixed, phi, at, value, inverse)
                _invert(inverse)
                if _subtract(phi, inverse, value) < CONVERGED:
                    break
            if at == rotation[target]:
                break
        found[target] = phi
    return found


@njit(cache=True, nogil=True)
def _certified(c: Complex, k: Complex, inverse: Real) -> float:
    """1 / (2 η ω): the step within which the continuation is the only solution."""
    loops, links = c.shape
    eta, omega = 1e-300, 1e-300
    for row in range(links):
        by_input, total = 0j, 0.0
        for loop in range(loops):
            by_input += complex(inverse[row, loop], -inverse[row, loop + loops]) * k[loop]
        for col in range(links):
            by_link = 0j
            for loop in range(loops):
                by_link += complex(inverse[row, loop], -inverse[row, loop + loops]) * c[loop, col]
            total += abs(by_link)
        eta, omega = max(eta, abs(by_input)), max(omega, total)
    return 0.5 / (eta * omega)


@njit(cache=True, nogil=True)
def _evaluate(c: Complex, k: Complex, fixed: Complex, phi: Real, at: float, value: Real, jacobian: Real) -> None:
    loops, links = c.shape
    z = complex(math.cos(at), math.sin(at))
    for row in range(loops):
        total = k[row] * z + fixed[row]
        for col in range(links):
            term = c[row, col] * complex(math.cos(phi[col]), math.sin(phi[col]))
            total += term
            jacobian[row, col] = -term.imag
            jacobian[row + loops, col] = term.real
        value[row] = total.real
        value[row + loops] = total.imag


@njit(cache=True, nogil=True)
def _subtract(phi: Real, matrix: Real, vector: Real) -> float:
    """phi -= matrix · vector, in place; the largest change."""
    largest = 0.0
    for row in range(len(phi)):
        change = 0.0
        for col in range(len(vector)):
            change += matrix[row, col] * vector[col]
        phi[row] -= change
        largest = max(largest, abs(change))
    return largest


@njit(cache=True, nogil=True)
def _invert(matrix: Real) -> float:
    """Invert in place by Gauss–Jordan elimination with row pivoting; the largest row sum of the inverse.

    The matrices have a few rows, and are inverted at every step: a library call would cost more than the work.
    """
    n = len(matrix)
    order = np.arange(n)
    for col in range(n):
        pivot = col
        for row in range(col + 1, n):
            if abs(matrix[row, col]) > abs(matrix[pivot, col]):
                pivot = row
        if matrix[pivot, col] == 0.0:
            return np.inf
        if pivot != col:
            for j in range(n):
                matrix[col, j], matrix[pivot, j] = matrix[pivot, j], matrix[col, j]
            order[col], order[pivot] = order[pivot], order[col]
        scale = 1.0 / matrix[col, col]
        matrix[col, col] = 1.0
        for j in range(n):
            matrix[col, j] *= scale
        for row in range(n):
            if row != col:
                factor = matrix[row, col]
                matrix[row, col] = 0.0
                for j in range(n):
                    matrix[row, j] -= factor * matrix[col, j]
    norm = 0.0
    unordered = matrix.copy()
    for row in range(n):
        total = 0.0
        for col in range(n):
            matrix[row, order[col]] = unordered[row, col]
            total += abs(unordered[row, col])
        norm = max(norm, total)
    return norm
