"""Where a fourbar can be assembled, found by root finding alone.

The pin B is a common point of the circle about A and the circle about O4. Nothing is solved in closed form: the two
rigid-length equations go to a Newton iteration or to SciPy's hybrid solver.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import optimize

from kinematics.arrays import Complex

QUADRATIC = 60
"""Newton iterations: halving steps far from the root, quadratic ones near it; at a toggle the error halves each time,
so that 60 of them reach rounding there too."""


def meet(a: ArrayLike, o4: ArrayLike, b: ArrayLike, c: ArrayLike, side: ArrayLike) -> Complex:
    """Pin B with |B − A| = b and |B − O4| = c to the left (side +1) or right (−1) of A → O4; NaN where there is none.

    Newton's iteration on the two circles from a start far out on that side: its first step lands on the circles' common
    chord, where it stays, and it cannot cross the line A → O4.
    """
    a, o4, b, c, side = np.broadcast_arrays(
        np.asarray(a, np.complex128), np.asarray(o4, np.complex128), np.asarray(b), np.asarray(c), np.asarray(side)
    )
    base = o4 - a
    reach = b + c + np.abs(base)
    with np.errstate(divide="ignore", invalid="ignore"):
        pin = a + 0.5 * base + 1j * side * reach * base / np.abs(base)
        for _ in range(QUADRATIC):
            pin = newton_step(pin, a, b, o4, c)
    missed = np.maximum(np.abs(np.abs(pin - a) - b), np.abs(np.abs(pin - o4) - c))
    crossing = base.real * (pin - a).imag - base.imag * (pin - a).real
    good = (missed <= 1e-7 * reach) & (side * crossing >= -1e-7 * reach**2)
    return np.where(good, pin, np.nan)


def newton_step(pin: Complex, one: Complex, radius: ArrayLike, other: Complex, other_radius: ArrayLike) -> Complex:
    """One step of Newton's iteration towards a common point of two circles."""
    u, v = pin - one, pin - other
    first = 0.5 * (np.asarray(radius) ** 2 - (u.real**2 + u.imag**2))
    second = 0.5 * (np.asarray(other_radius) ** 2 - (v.real**2 + v.imag**2))
    determinant = u.real * v.imag - u.imag * v.real
    x = (first * v.imag - second * u.imag) / determinant
    y = (second * u.real - first * v.real) / determinant
    return pin + x + 1j * y


def all_pins(a: complex, o4: complex, b: float, c: float, starts: int = 24) -> list[complex]:
    """All pins B of one design by SciPy's hybrid solver from a ring of starts; none, one or two, to 1e-7."""
    size = b + c + abs(o4 - a)

    def closure(x: NDArray[np.float64]) -> list[float]:
        return [abs(complex(*x) - a) / size - b / size, abs(complex(*x) - o4) / size - c / size]

    found: list[complex] = []
    for angle in np.linspace(0.0, 2.0 * np.pi, starts, endpoint=False):
        start = 0.5 * (a + o4) + (0.6 * size) * np.exp(1j * (angle + 0.1))
        answer = optimize.root(closure, [start.real, start.imag], method="hybr", options={"xtol": 1e-13})
        pin = complex(*answer.x)
        if np.abs(answer.fun).max() < 1e-9 and all(abs(pin - other) > 1e-6 * size for other in found):
            found.append(pin)
    return found
