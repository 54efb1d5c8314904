"""Exact target ratios: rational numbers, and products with π, e and square roots.

A target is a JSON number or a text in a small grammar::

    target    =  ["-" | "+"] factor { ("*" | "/") factor }
    factor    =  number | constant | number constant
    constant  =  "pi" | "e" | "sqrt(" number ")"
    number    =  digits ["." digits]

for example ``127/50``, ``3.14159265358979``, ``pi/2``, ``3pi/2``, ``2*sqrt(2)``. After "/" a factor is a number or a
constant, not both, because ``1/3pi`` is ambiguous. Text is kept exact. A JSON number is read as the shortest decimal
that denotes it, which is the decimal that was written. Nothing is evaluated as code.

A target is q · π^a · e^b · √r with rational q and r. It is compared with rational ratios without rounding: its
enclosure between two rational numbers is narrowed until the comparison is decided. Narrowing never decides the case of
equality. For a = b = 0 equality requires that r is a square, which is detected exactly. √r, π^a √r and e^b √r are
otherwise irrational. For products of powers of both π and e this is an open question; there, agreement to
:data:`MAX_BITS` bits counts as equality.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache

from kinematics.message import compose

MAX_TEXT_LENGTH = 120
"""Maximum number of characters of a target; longer texts are errors or attacks."""

MIN_RATIO, MAX_RATIO = Fraction(1, 10**9), Fraction(10**9)
"""Minimum and maximum ratio. The maximum is that of all numbers; ratios outside are typing errors."""

MAX_BITS = 1 << 14
"""Maximum number of bits of an enclosure. Different numbers with about a hundred digits are distinguished much earlier.
"""

CLEAR_DIFFERENCE = 1e-14
"""Relative difference of two floats, about forty rounding errors, above which the exact numbers have the same order."""

_SIZE = 64
"""Number of bits of the first enclosure."""

_NUMBER = r"\d+(?:\.\d+)?|\.\d+"
_TOKEN = re.compile(rf"\s*(?:({_NUMBER})|(pi|e)(?![a-z])|sqrt\(\s*({_NUMBER})\s*\)|([*/]))", re.ASCII)


class TargetSyntaxError(ValueError):
    """Raised for a text that is not a target; the message describes the expected syntax."""


@dataclass(frozen=True)
class RatioTarget:
    """The positive number ``factor`` · π^``pi`` · e^``e`` · √``radicand``."""

    factor: Fraction
    pi: int = 0
    e: int = 0
    radicand: Fraction = Fraction(1)

    @property
    def rational(self) -> Fraction | None:
        """Exact value if the number is rational, otherwise None."""
        return self.factor if self.pi == self.e == 0 and self.radicand == 1 else None

    def enclose(self, bits: int) -> tuple[Fraction, Fraction]:
        """Return a lower and an upper bound whose relative difference is about 2^-bits."""
        return _enclose(self, bits)

    def compare(self, ratio: Fraction) -> int:
        """Return the sign of target − ratio, decided in exact arithmetic."""
        # Floats decide almost every comparison; exact arithmetic is needed only for nearly equal numbers.
        apart = self.split_parts()[0] - float(ratio)
        if abs(apart) > CLEAR_DIFFERENCE * float(ratio):
            return 1 if apart > 0.0 else -1
        if self.rational is not None:
            return (self.rational > ratio) - (self.rational < ratio)
        bits = _SIZE
        while bits <= MAX_BITS:
            low, high = self.enclose(bits)
            if low > ratio:
                return 1
            if high < ratio:
                return -1
            bits *= 4
        return 0

    def compare_distances(self, first: Fraction, second: Fraction) -> int:
        """Return −1 if ``first`` is closer to the target than ``second``, +1 if it is farther, 0 if both are equal."""
        if first == second:
            return 0
        low, high = min(first, second), max(first, second)
        if self.compare(low) <= 0:
            nearest = low
        elif self.compare(high) >= 0:
            nearest = high
        else:
            side = self.compare((low + high) / 2)
            if side == 0:
                return 0
            nearest = low if side < 0 else high
        return -1 if nearest == first else 1

    def is_within(self, ratio: Fraction, tolerance: Fraction) -> bool:
        """Return whether |ratio − target| ≤ tolerance × target."""
        over = self.compare(ratio / (1 + tolerance)) >= 0
        return over and (tolerance >= 1 or self.compare(ratio / (1 - tolerance)) <= 0)

    def compute_relative_error(self, ratio: Fraction) -> float:
        """Compute the relative error, ratio / target − 1, correct to all digits of a float."""
        if self.rational is not None:
            return float(ratio / self.rational - 1)
        bits = 4 * _SIZE
        while True:
            low, high = (ratio / bound - 1 for bound in reversed(self.enclose(bits)))
            if (low > 0 or high < 0) and abs(high - low) <= abs(low) / (1 << 60):
                return float(low)
            if bits >= MAX_BITS:
                return 0.0
            bits *= 4

    def split_parts(self) -> tuple[float, float]:
        """Return the number as an unevaluated sum of two floats, with a relative error of 2^-105."""
        return _split_parts(self)

    def __float__(self) -> float:
        return self.split_parts()[0]


@lru_cache(maxsize=256)
def _enclose(target: RatioTarget, bits: int) -> tuple[Fraction, Fraction]:
    low = high = target.factor
    for bounds, power in ((_enclose_pi, target.pi), (_enclose_e, target.e)):
        below, above = (Fraction(bound, 1 << bits) for bound in bounds(bits))
        if power < 0:
            below, above = above, below
        low, high = low * below**power, high * above**power
    if target.radicand != 1:
        scale = 1 << (2 * bits)
        floor = math.isqrt(target.radicand.numerator * target.radicand.denominator * scale)
        unit = target.radicand.denominator << bits
        low, high = low * Fraction(floor, unit), high * Fraction(floor + 1, unit)
    return low, high


@lru_cache(maxsize=256)
def _split_parts(target: RatioTarget) -> tuple[float, float]:
    value = target.rational
    if value is None:
        low, high = target.enclose(4 * _SIZE)
        value = (low + high) / 2
    head = float(value)
    return head, float(value - Fraction(head))


def parse_target(text: float | str) -> tuple[int, RatioTarget]:
    """Parse a ratio into its sign and its magnitude.

    Raises
    ------
    TargetSyntaxError
        For a text outside the grammar, for zero, or for a magnitude outside 1e-9 ... 1e9.
    """
    if isinstance(text, str):
        sign, target = _parse(text)
    else:
        value = parse_decimal(text)
        sign, target = (-1 if value < 0 else 1), RatioTarget(abs(value))
    if target.factor == 0:
        raise TargetSyntaxError(compose("model-ratio-zero"))
    if target.compare(MIN_RATIO) < 0 or target.compare(MAX_RATIO) > 0:
        raise TargetSyntaxError(compose("model-ratio-out-of-range"))
    return sign, target


def parse_decimal(number: float) -> Fraction:
    """Return a JSON number as the decimal that was written: the shortest decimal that denotes the same float."""
    return Fraction(repr(number))


def _parse(text: str) -> tuple[int, RatioTarget]:
    if len(text) > MAX_TEXT_LENGTH:
        raise TargetSyntaxError(compose("model-ratio-text-too-long", count=MAX_TEXT_LENGTH))
    body = text.strip().lower()
    sign = -1 if body.startswith("-") else 1
    body = body[1:] if body[:1] in ("-", "+") else body
    factor, radicand, powers = Fraction(1), Fraction(1), {"pi": 0, "e": 0}
    place, direction, due, joins = 0, 1, True, False
    while place < len(body.rstrip()):
        token = _TOKEN.match(body, place)
        if token is None or (due and token[4]):
            raise _describe_unexpected(body, place)
        place = token.end()
        number, constant, root, operator = token.groups()
        if operator:
            direction, due, joins = (1 if operator == "*" else -1), True, False
            continue
        if not (due or (joins and number is None)):
            raise _describe_unexpected(body, token.start())
        if constant:
            powers[constant] += direction
        elif Fraction(number or root) == 0:
            raise TargetSyntaxError(compose("model-ratio-zero" if direction > 0 else "model-ratio-division-by-zero"))
        elif number:
            factor *= Fraction(number) ** direction
        else:
            radicand *= Fraction(root) ** direction
        due, joins = False, number is not None and direction > 0
    if due:
        raise _describe_unexpected(body, place)
    whole, left = _simplify_root(radicand)
    return sign, RatioTarget(factor * whole, powers["pi"], powers["e"], left)


def _describe_unexpected(body: str, place: int) -> TargetSyntaxError:
    rest = body[place:].strip()
    if not rest:
        return TargetSyntaxError(compose("model-ratio-text-ends-early"))
    return TargetSyntaxError(compose("model-ratio-text-unexpected", text=repr(rest[:12])))


def _simplify_root(radicand: Fraction) -> tuple[Fraction, Fraction]:
    """Split √radicand into a rational factor and the remaining radicand."""
    up, down = math.isqrt(radicand.numerator), math.isqrt(radicand.denominator)
    if Fraction(up * up, down * down) == radicand:
        return Fraction(up, down), Fraction(1)
    return Fraction(1), radicand


@cache
def _enclose_pi(bits: int) -> tuple[int, int]:
    """Return integer bounds of π 2^bits, by Machin's formula π = 16 atan(1/5) − 4 atan(1/239)."""
    # Guard bits absorb the truncation errors of the terms of the series.
    guard = 32
    unit = 1 << (bits + guard)
    value = 16 * _compute_arctan(5, unit) - 4 * _compute_arctan(239, unit)
    return (value >> guard) - 1, (value >> guard) + 2


def _compute_arctan(n: int, unit: int) -> int:
    total, power, k = 0, unit // n, 0
    while power:
        total += (-power if k % 2 else power) // (2 * k + 1)
        power //= n * n
        k += 1
    return total


@cache
def _enclose_e(bits: int) -> tuple[int, int]:
    """Return integer bounds of e 2^bits, by the series Σ 1/k!."""
    guard = 32
    term, total, k = 1 << (bits + guard), 0, 0
    while term:
        total += term
        k += 1
        term //= k
    return (total >> guard) - 1, (total >> guard) + 2


def format_ratio(ratio: str | float) -> str:
    """Format a ratio for a sentence: an expression as written, a number without superfluous zeros.

    >>> format_ratio("sqrt(2)"), format_ratio(25.0), format_ratio(332.96886)
    ('sqrt(2)', '25', '332.96886')
    """
    return ratio if isinstance(ratio, str) else f"{ratio:.12g}"
