"""Exact targets: the grammar, and comparisons that no rounding decides."""

from __future__ import annotations

import math
from decimal import Decimal, getcontext
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from synthesis.model.gears.ratio_target import TargetSyntaxError, parse_target


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("pi", math.pi),
        ("e", math.e),
        ("sqrt(2)", math.sqrt(2.0)),
        ("3pi/2", 1.5 * math.pi),
        ("2*sqrt(2)", math.sqrt(8.0)),
        (" PI / 2 ", 0.5 * math.pi),
        ("sqrt(0.5)*e", math.e / math.sqrt(2.0)),
        ("1/pi", 1.0 / math.pi),
        ("2 / 3 * e", math.e / 1.5),
    ],
)
def test_irrational_targets(text: str, value: float) -> None:
    sign, target = parse_target(text)
    assert (sign, target.rational) == (1, None)
    assert float(target) == pytest.approx(value, rel=4e-16)


@pytest.mark.parametrize(
    ("stated", "value"),
    [
        ("127/50", Fraction(127, 50)),
        ("3.14159265358979323846264338327950288", Fraction("3.14159265358979323846264338327950288")),
        (0.1, Fraction(1, 10)),
        (1e-05, Fraction(1, 100000)),
        (6, Fraction(6)),
        ("sqrt(2)*sqrt(8)", Fraction(4)),
        ("sqrt(2.25)", Fraction(3, 2)),
        ("pi/pi", Fraction(1)),
        ("+22/7", Fraction(22, 7)),
        ("-.5", Fraction(1, 2)),
    ],
)
def test_rational_targets_are_exact(stated: float | str, value: Fraction) -> None:
    assert parse_target(stated)[1].rational == value


def test_signs() -> None:
    assert [parse_target(stated)[0] for stated in ("-pi", -3.0, "+2", 2, " - 2")] == [-1, -1, 1, 1, -1]


@pytest.mark.parametrize(
    "text",
    [
        *("", " ", "-", "--2", "*2", "2*", "2//3", "2 3", "1/0", "0", "0*pi", "1e5", "e3", "pie", "pi pi", "1/3pi"),
        *("2**3", "sqrt()", "sqrt(-1)", "sqrt(2", "sqrt(pi)", "__import__('os')", "1;2", "π", "١", "nan", "inf", "1_0"),
        *("2pi3", "9" * 121, "1" + "0" * 10, "0." + "0" * 10 + "1", "1/" + "0" * 20),
    ],
)
def test_everything_else_is_refused(text: str) -> None:
    with pytest.raises(TargetSyntaxError):
        parse_target(text)


def test_enclosures_hold_the_number() -> None:
    """Against the decimal module's own roots and exponentials, and Ramanujan's series of 1/π."""
    getcontext().prec = 120
    pi = _ramanujan()
    for text, value in [
        ("e", Decimal(1).exp()),
        ("sqrt(7)", Decimal(7).sqrt()),
        ("pi", pi),
        ("e/pi", Decimal(1).exp() / pi),
    ]:
        target = parse_target(text)[1]
        for bits in (16, 64, 256):
            low, high = target.enclose(bits)
            assert low < Fraction(value) < high
            assert high - low < Fraction(1, 1 << (bits - 6))


def _ramanujan() -> Decimal:
    terms = (
        Decimal(math.factorial(4 * k) * (1103 + 26390 * k))
        / (Decimal(math.factorial(k)) ** 4 * Decimal(396) ** (4 * k))
        for k in range(16)
    )
    return Decimal(9801) / (2 * Decimal(2).sqrt() * sum(terms))


FRACTIONS = st.fractions(min_value=Fraction(1, 50), max_value=50, max_denominator=10**7)


@given(FRACTIONS, FRACTIONS, FRACTIONS)
def test_nearer_to_a_rational(number: Fraction, one: Fraction, other: Fraction) -> None:
    target = parse_target(f"{number.numerator}/{number.denominator}")[1]
    first, second = abs(one - number), abs(other - number)
    assert target.compare_distances(one, other) == (first > second) - (first < second)
    assert target.compare_distances(2 * number - one, one) == 0 or 2 * number <= one
    assert target.compare(one) == (number > one) - (number < one)


def test_nearer_to_an_irrational_where_floats_are_equal() -> None:
    """Two fractions on both sides of π whose distances agree to 20 digits."""
    getcontext().prec = 60
    pi = parse_target("pi")[1]
    low, high = pi.enclose(300)
    middle = (low + high) / 2
    below = (middle - Fraction(1, 1000)).limit_denominator(10**12)
    above = 2 * middle - below
    farther, nearer = above + Fraction(1, 10**22), above - Fraction(1, 10**22)
    assert pi.compare_distances(below, farther) == -1
    assert pi.compare_distances(below, nearer) == 1
    assert pi.compare_distances(nearer, farther) == -1


def test_within_a_tolerance() -> None:
    pi = parse_target("pi")[1]
    assert pi.is_within(Fraction(22, 7), Fraction("0.000403"))
    assert not pi.is_within(Fraction(22, 7), Fraction("0.000402"))
    three = parse_target(3)[1]
    assert three.is_within(Fraction(33, 10), Fraction(1, 10))
    assert three.is_within(Fraction(27, 10), Fraction(1, 10))
    assert not three.is_within(Fraction(27, 10) - Fraction(1, 10**30), Fraction(1, 10))


def test_relative_errors_keep_their_digits() -> None:
    pi = parse_target("pi")[1]
    near = Fraction(pi.enclose(400)[0])
    assert pi.compute_relative_error(near + Fraction(1, 10**40)) == pytest.approx(1e-40 / math.pi, rel=1e-14)
    assert parse_target("1/3")[1].compute_relative_error(Fraction(1, 3)) == 0.0


@given(FRACTIONS)
def test_parts_are_twice_as_good_as_a_float(number: Fraction) -> None:
    head, rest = parse_target(f"{number.numerator}/{number.denominator}")[1].split_parts()
    assert abs(Fraction(head) + Fraction(rest) - number) <= number / 2**100
