"""Formatting of counts in sentences: grouped digits, and singular or plural."""

from __future__ import annotations

MIN_GROUPED = 10_000
"""Smallest integer whose digits are grouped in threes."""

THIN_SPACE = "\u202f"
"""Narrow no-break space between groups of digits (ISO 80000-1, 7.3.1). It prevents a line break, and no language uses
it as a decimal sign."""


def format_integer(number: int) -> str:
    """Format an integer for a sentence.

    >>> format_integer(9216), format_integer(-14002477).replace(THIN_SPACE, " ")
    ('9216', '−14 002 477')
    """
    digits = f"{number:,}".replace(",", THIN_SPACE) if abs(number) >= MIN_GROUPED else str(number)
    # Use a true minus sign, as in printed tables.
    return digits.replace("-", "−")


def choose_word(number: int, one: str, many: str) -> str:
    """Return the word that agrees with a number: ``one`` for exactly 1, otherwise ``many``."""
    return one if number == 1 else many


def format_count(number: int, one: str, many: str = "") -> str:
    """Format a number with its noun in the singular or plural; by default the plural of ``one`` ends in s.

    >>> format_count(1, "linkage"), format_count(0, "linkage"), format_count(2, "series", "series")
    ('1 linkage', '0 linkages', '2 series')
    """
    return f"{format_integer(number)} {choose_word(number, one, many or f'{one}s')}"
