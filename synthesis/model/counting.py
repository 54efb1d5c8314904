"""Numbers in sentences: how many of what, with digits in groups of three, and one or many."""

from __future__ import annotations

GROUPED = 10_000
"""Whole numbers from here on have their digits in groups of three."""

SPACE = "\u202f"
"""Between groups (ISO 80000-1, 7.3.1): no line ends there, and it is no decimal sign in any language."""


def grouped(number: int) -> str:
    """A whole number for reading.

    >>> grouped(9216), grouped(-14002477).replace(SPACE, " ")
    ('9216', '−14 002 477')
    """
    digits = f"{number:,}".replace(",", SPACE) if abs(number) >= GROUPED else str(number)
    return digits.replace("-", "−")


def agreeing(number: int, one: str, many: str) -> str:
    """The word that goes with so many: ``one`` with exactly one."""
    return one if number == 1 else many


def counted(number: int, one: str, many: str = "") -> str:
    """So many of something; without ``many`` the plural of ``one`` ends in s.

    >>> counted(1, "linkage"), counted(0, "linkage"), counted(2, "series", "series")
    ('1 linkage', '0 linkages', '2 series')
    """
    return f"{grouped(number)} {agreeing(number, one, many or f'{one}s')}"
