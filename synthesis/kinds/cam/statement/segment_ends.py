"""Ends of segments in a motion program: velocity and acceleration at the ends of laws and polynomials.

Written without numpy, because requests are checked before the numerical libraries are loaded.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

State = tuple[float, float, float]
"""s, v, a at an end of a segment."""

_SQUARE = math.pi**2

END_RATES: dict[str, tuple[float, float, float, float]] = {
    "constant_velocity": (1.0, 0.0, 1.0, 0.0),
    "constant_acceleration": (0.0, 4.0, 0.0, -4.0),
    "simple_harmonic": (0.0, 0.5 * _SQUARE, 0.0, -0.5 * _SQUARE),
    "cycloidal": (0.0, 0.0, 0.0, 0.0),
    "trapezoidal": (0.0, 0.0, 0.0, 0.0),
    "modified_trapezoid": (0.0, 0.0, 0.0, 0.0),
    "modified_sine": (0.0, 0.0, 0.0, 0.0),
    "modified_constant_velocity": (0.0, 0.0, 0.0, 0.0),
    "polynomial_23": (0.0, 6.0, 0.0, -6.0),
    "polynomial_345": (0.0, 0.0, 0.0, 0.0),
    "polynomial_4567": (0.0, 0.0, 0.0, 0.0),
    "polynomial_456789": (0.0, 0.0, 0.0, 0.0),
    "eighth_power": (0.0, 0.0, 0.0, -5.2683),
    "eighth_power_reversed": (0.0, 5.2683, 0.0, 0.0),
    "double_harmonic": (0.0, 0.0, 0.0, -_SQUARE),
    "double_harmonic_reversed": (0.0, _SQUARE, 0.0, 0.0),
    "half_harmonic_start": (0.0, 0.25 * _SQUARE, 0.5 * math.pi, 0.0),
    "half_harmonic_end": (0.5 * math.pi, 0.0, 0.0, -0.25 * _SQUARE),
    "half_cycloidal_start": (0.0, 0.0, 2.0, 0.0),
    "half_cycloidal_end": (2.0, 0.0, 0.0, 0.0),
}
"""For each law, v and a at the start and v and a at the end of a unit rise over a unit angle."""

MIRROR_LAWS = {"eighth_power": "eighth_power_reversed", "double_harmonic": "double_harmonic_reversed"}
"""Laws that begin without acceleration and end with one, and their mirror images for a fall, which textbooks call by
the same name."""

PIVOT_TOLERANCE = 1e-11
"""Pivot, relative to its column, below which conditions do not determine a polynomial."""

SAMPLE_COUNT = 32
"""Number of steps for a polynomial's range, which only serves as the scale of the tolerances for rounding and edges."""

Conditions = Sequence[tuple[float, int, float]]
"""Conditions as (angle in radians from the segment's start, order of the derivative, value)."""


def compute_law_ends(law: str, angle: float, start: float, end: float) -> tuple[State, State]:
    """Return s, v, a at both ends of a move by a law over an angle in radians."""
    v0, a0, v1, a1 = END_RATES[law]
    lift = end - start
    return (start, v0 * lift / angle, a0 * lift / angle**2), (end, v1 * lift / angle, a1 * lift / angle**2)


def compute_polynomial_ends(angle: float, conditions: Conditions) -> tuple[State, State] | None:
    """Return s, v, a at both ends of the lowest-degree polynomial through conditions; None if they determine none."""
    coefficients = _solve_coefficients(angle, conditions)
    if coefficients is None:
        return None
    first, last = (
        tuple(
            sum(c * _differentiate_power(u, k, order) for k, c in enumerate(coefficients)) / angle**order
            for order in range(3)
        )
        for u in (0.0, 1.0)
    )
    return (first[0], first[1], first[2]), (last[0], last[1], last[2])


def compute_polynomial_range(angle: float, conditions: Conditions) -> tuple[float, float] | None:
    """Return the sampled minimum and maximum s of the lowest-degree polynomial through conditions, or None."""
    coefficients = _solve_coefficients(angle, conditions)
    if coefficients is None:
        return None
    heights = [sum(c * (n / SAMPLE_COUNT) ** k for k, c in enumerate(coefficients)) for n in range(SAMPLE_COUNT + 1)]
    return min(heights), max(heights)


def _solve_coefficients(angle: float, conditions: Conditions) -> list[float] | None:
    """Solve for the coefficients of powers of u = θ/β: elimination with scaled rows and column pivots."""
    n = len(conditions)
    rows = []
    for at, order, value in conditions:
        row = [_differentiate_power(at / angle, k, order) for k in range(n)]
        # Conditions on different derivatives differ by powers of k: scale the rows to make the pivots comparable.
        size = max(map(abs, row))
        if not size:
            return None
        rows.append([x / size for x in row] + [value * angle**order / size])
    for column in range(n):
        best = max(range(column, n), key=lambda r: abs(rows[r][column]))
        if abs(rows[best][column]) <= PIVOT_TOLERANCE:
            return None
        rows[column], rows[best] = rows[best], rows[column]
        for r in range(column + 1, n):
            factor = rows[r][column] / rows[column][column]
            if factor:
                rows[r] = [x - factor * y for x, y in zip(rows[r], rows[column], strict=True)]
    # Back substitution.
    solution = [0.0] * n
    for r in range(n - 1, -1, -1):
        known = sum(rows[r][c] * solution[c] for c in range(r + 1, n))
        solution[r] = (rows[r][n] - known) / rows[r][r]
    return solution


def _differentiate_power(u: float, k: int, order: int) -> float:
    """Return the derivative of the given order of u^k."""
    return float(math.perm(k, order)) * u ** (k - order) if k >= order else 0.0
