"""Speed ratios as clients state them: a number, or a short exact expression as text.

Numbers keep their decimal text (0.1 is one tenth, not the nearest binary fraction). Expressions are one factor or the
quotient of two: ``"127/50"``, ``"3.14159"``, ``"pi"``, ``"-sqrt(2)"``, ``"e/2"``. Nothing is evaluated as code.
"""

from __future__ import annotations

import re
from decimal import Decimal, localcontext
from fractions import Fraction
from functools import lru_cache
from typing import Annotated

from pydantic import AfterValidator, Field

from synthesis.problems.base import ABSURD

DIGITS = 60
"""Digits to which irrational ratios are taken. Ratios of tooth numbers differ by far more, so that 60 digits rank them
as the number itself would."""

_FACTOR = r"(?:\d{1,18}(?:\.\d{1,18})?|pi|e|sqrt\(\d{1,9}(?:\.\d{1,9})?\))"
_EXPRESSION = re.compile(rf"\s*(?P<sign>[+-]?)\s*(?P<over>{_FACTOR})\s*(?:/\s*(?P<under>{_FACTOR})\s*)?")

_PI = "3.141592653589793238462643383279502884197169399375105820974944592307816406286209"


@lru_cache(maxsize=256)
def exact_ratio(stated: float | int | str) -> Fraction:
    """The value of a stated ratio; irrational ones to :data:`DIGITS` digits.

    Raises
    ------
    ValueError
        For a text that is no such expression, or a quotient by zero.
    """
    if not isinstance(stated, str):
        return Fraction(repr(stated))
    found = _EXPRESSION.fullmatch(stated)
    if found is None:
        raise ValueError('expected a number or an expression such as "127/50", "3.14159", "pi", "sqrt(2)" or "e/2"')
    under = _factor(found["under"]) if found["under"] else Fraction(1)
    if under == 0:
        raise ValueError("the denominator must not be 0")
    return (-1 if found["sign"] == "-" else 1) * _factor(found["over"]) / under


def _factor(text: str) -> Fraction:
    with localcontext() as context:
        context.prec = DIGITS
        if text == "pi":
            return Fraction(Decimal(_PI))
        if text == "e":
            return Fraction(Decimal(1).exp())
        if text.startswith("sqrt"):
            number = Fraction(text[5:-1])
            root = (Decimal(number.numerator) / Decimal(number.denominator)).sqrt()
            near = Fraction(root).limit_denominator(10**10)
            return near if near * near == number else Fraction(root)
        return Fraction(text)


def _sound(stated: float | int | str) -> float | int | str:
    value = exact_ratio(stated)
    if value == 0:
        raise ValueError("the ratio must not be 0")
    if not Fraction(1, 10**9) <= abs(value) <= Fraction(ABSURD):
        raise ValueError("the ratio must lie between 1e-9 and 1e9 in magnitude")
    return stated


StatedRatio = Annotated[
    Annotated[int, Field(strict=True)]
    | Annotated[float, Field(strict=True, allow_inf_nan=False)]
    | Annotated[str, Field(strict=True, max_length=64)],
    AfterValidator(_sound),
]
"""A speed ratio, input over output; negative where they turn in opposite directions."""
