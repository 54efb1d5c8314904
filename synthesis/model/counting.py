"""Formatting of counts in sentences: grouped digits, and singular or plural."""

from __future__ import annotations

from kinematics.message import format_integer

__all__ = ["choose_word", "format_count", "format_integer"]


def choose_word(number: int, one: str, many: str) -> str:
    """Return the word that agrees with a number: ``one`` for exactly 1, otherwise ``many``."""
    return one if number == 1 else many


def format_count(number: int, one: str, many: str = "") -> str:
    """Format a number with its noun in the singular or plural; by default the plural of ``one`` ends in s.

    >>> format_count(1, "linkage"), format_count(0, "linkage"), format_count(2, "series", "series")
    ('1 linkage', '0 linkages', '2 series')
    """
    return f"{format_integer(number)} {choose_word(number, one, many or f'{one}s')}"
