"""Ratios as clients state them: kept exact, and nothing but the listed expressions."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from pydantic import TypeAdapter, ValidationError

from synthesis.problems.ratio import StatedRatio, exact_ratio

RATIO: TypeAdapter[float | int | str] = TypeAdapter(StatedRatio)


def test_numbers_keep_their_decimal_text() -> None:
    assert exact_ratio(0.1) == Fraction(1, 10)
    assert exact_ratio(3) == 3
    assert exact_ratio(-1e-3) == Fraction(-1, 1000)
    assert exact_ratio("3.14159265358979") == Fraction(314159265358979, 10**14)
    assert exact_ratio("127/50") == Fraction(127, 50)
    assert exact_ratio("sqrt(2.25)") == Fraction(3, 2)


@pytest.mark.parametrize(
    ("text", "value"),
    [("pi", math.pi), (" - pi / 2", -math.pi / 2), ("e", math.e), ("+sqrt(2)/e", math.sqrt(2) / math.e)],
)
def test_constants(text: str, value: float) -> None:
    assert float(exact_ratio(text)) == pytest.approx(value, rel=1e-15)


def test_irrational_ratios_have_far_more_digits_than_tooth_numbers_could_tell() -> None:
    assert abs(exact_ratio("sqrt(2)") ** 2 - 2) < Fraction(1, 10**58)
    # Machin's formula, another route to the digits.
    machin = 16 * _arctan(5) - 4 * _arctan(239)
    assert abs(exact_ratio("pi") - machin) < Fraction(1, 10**58)
    assert abs(exact_ratio("e") - sum(Fraction(1, math.factorial(k)) for k in range(60))) < Fraction(1, 10**57)


def _arctan(inverse: int) -> Fraction:
    return sum((Fraction((-1) ** k, (2 * k + 1) * inverse ** (2 * k + 1)) for k in range(50)), Fraction(0))


@pytest.mark.parametrize(
    "text", ["", "1/0", "0", "pi*2", "2**9", "__import__('os')", "1e5", "sqrt(-1)", "nan", "1/2/3", "9" * 70]
)
def test_everything_else_is_refused(text: str) -> None:
    with pytest.raises(ValidationError):
        RATIO.validate_python(text)


@pytest.mark.parametrize("number", [0, 0.0, float("nan"), float("inf"), 1e300, True, None, 1e-12])
def test_absurd_numbers_are_refused(number: object) -> None:
    with pytest.raises(ValidationError):
        RATIO.validate_python(number)
