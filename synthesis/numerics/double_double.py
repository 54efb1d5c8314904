"""Complex arithmetic in double-double precision (about 31 digits) for compiled kernels.

Error-free transformations of Dekker and Knuth (Dekker 1971, doi:10.1007/BF01397083). A number is the unevaluated sum
of a pair (high, low) of complex numbers; ``low`` is the rounding error of ``high``. Terms far smaller than ``low`` are
dropped.
"""

from __future__ import annotations

from kinematics.compiling import njit

_SPLITTER = 134217729.0
"""2²⁷ + 1: splits a double into two halves whose products are exact."""


@njit(cache=True, nogil=True, inline="always")
def add_exactly(a: complex, b: complex) -> tuple[complex, complex]:
    """Return the rounded sum a + b and its exact rounding error (Knuth)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


@njit(cache=True, nogil=True)
def _multiply_exactly(a: float, b: float) -> tuple[float, float]:
    """Return the rounded product a b of real numbers and its exact rounding error (Dekker)."""
    product = a * b
    # Split both factors into halves of 26 bits, whose partial products are exact.
    t = _SPLITTER * a
    a_high = t - (t - a)
    t = _SPLITTER * b
    b_high = t - (t - b)
    a_low, b_low = a - a_high, b - b_high
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@njit(cache=True, nogil=True)
def add(a: complex, a_low: complex, b: complex, b_low: complex) -> tuple[complex, complex]:
    """Return a + b as a pair (high, low)."""
    total, rest = add_exactly(a, b)
    # Renormalize, so that the low part stays below the rounding of the high part.
    rest += a_low + b_low
    high = total + rest
    return high, rest - (high - total)


@njit(cache=True, nogil=True)
def multiply(a: complex, a_low: complex, b: complex, b_low: complex) -> tuple[complex, complex]:
    """Return a b as a pair (high, low)."""
    # The four real partial products of a complex product, each with its error.
    p, p_low = _multiply_exactly(a.real, b.real)
    q, q_low = _multiply_exactly(-a.imag, b.imag)
    u, u_low = _multiply_exactly(a.real, b.imag)
    v, v_low = _multiply_exactly(a.imag, b.real)
    total, rest = add_exactly(complex(p, u), complex(q, v))
    # The product of both low parts is below the precision and is dropped.
    rest += complex(p_low + q_low, u_low + v_low) + (a * b_low + a_low * b)
    high = total + rest
    return high, rest - (high - total)


@njit(cache=True, nogil=True)
def compute_reciprocal(a: complex, a_low: complex) -> tuple[complex, complex]:
    """Return 1 / a as a pair (high, low), by one Newton step from the quotient in ordinary precision."""
    first = 1.0 / a
    product, product_low = multiply(a, a_low, first, 0j)
    gap = (1.0 - product) - product_low
    step = first * gap
    high = first + step
    return high, step - (high - first)
