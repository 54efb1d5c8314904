"""Counts in sentences: digits in groups of three, and singular or plural."""

from __future__ import annotations

GROUPED = 10_000
"""Smallest whole number whose digits are grouped in threes."""

SPACE = "\u202f"
"""Narrow no-break space between groups (ISO 80000-1, 7.3.1): no line breaks there, and no language reads it as a
decimal sign."""


def grouped(number: int) -> str:
    """Format a whole number for a sentence.

    >>> grouped(9216), grouped(-14002477).replace(SPACE, " ")
    ('9216', '−14 002 477')
    """
    digits = f"{number:,}".replace(",", SPACE) if abs(number) >= GROUPED else str(number)
    return digits.replace("-", "−")


def agreeing(number: int, one: str, many: str) -> str:
    """Return the word that agrees with a number: ``one`` for exactly 1, otherwise ``many``."""
    return one if number == 1 else many


def counted(number: int, one: str, many: str = "") -> str:
    """Format a number and its noun; without ``many`` the plural of ``one`` ends in s.

    >>> counted(1, "linkage"), counted(0, "linkage"), counted(2, "series", "series")
    ('1 linkage', '0 linkages', '2 series')
    """
    return f"{grouped(number)} {agreeing(number, one, many or f'{one}s')}"
