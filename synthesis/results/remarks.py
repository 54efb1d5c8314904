"""Texts that the answers of all kinds contain: remarks after a summary, lists, quantities, and names in words."""

from __future__ import annotations

from collections.abc import Sequence

from kinematics.message import compose, join_messages


def append_remark(summary: str, remark: str) -> str:
    """Append a sentence to a summary, as one text that can be translated; an empty remark adds nothing.

    The remark may begin with a space.
    """
    return join_messages([summary, remark.lstrip()])


def list_with_and(parts: Sequence[str]) -> str:
    """List texts with commas and a final "and".

    >>> list_with_and(["crank"]), list_with_and(["crank", "coupler", "rocker"])
    ('crank', 'crank, coupler and rocker')
    """
    if len(parts) < 2:
        return "".join(parts)
    return compose("results-list-with-and", first=join_messages(parts[:-1], ", "), last=parts[-1])


def write_quantity(number: str, unit: str) -> str:
    """Write a formatted number with its unit; an empty unit, as in consistent units, leaves the number alone.

    >>> write_quantity("0.5", "kg"), write_quantity("0.5", "")
    ('0.5 kg', '0.5')
    """
    return compose("results-quantity", number=number, unit=unit) if unit else number


def write_name(name: str) -> str:
    """Write the name of a check, a metric or a limit in words.

    >>> write_name("transmission_angle")
    'transmission angle'
    """
    # Catalogues select a translation by the name, because the keys of a selection cannot contain spaces.
    return compose("results-name-in-words", name=name, words=name.replace("_", " "))
