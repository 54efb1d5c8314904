"""Identifiers that every format accepts, and escaping of client text for each format."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape


class Names:
    """Registry of unique identifiers made of letters, digits and underscores."""

    def __init__(self) -> None:
        self._given: set[str] = set()

    def make_name(self, sort: str, label: str) -> str:
        """Return a unique identifier for ``label``.

        It begins with ``sort``, so that it is not a keyword of any language. It never has two underscores in a row, so
        that an identifier extended by two underscores and a suffix is unique, too.

        Examples
        --------
        >>> names = Names()
        >>> names.make_name("link", "input"), names.make_name("link", "in put"), names.make_name("link", "in-put")
        ('link_input', 'link_in_put', 'link_in_put_2')
        """
        plain = re.sub(r"[^A-Za-z0-9]+", "_", label).strip("_")
        name = own = f"{sort}_{plain}" if plain else sort
        number = 1
        # Compare in lower case: some readers ignore case.
        while name.lower() in self._given:
            number += 1
            name = f"{own}_{number}"
        self._given.add(name.lower())
        return name


def join_lines(text: str) -> str:
    """Return text without line breaks and control characters."""
    return re.sub(r"\s+", " ", "".join(c if c.isprintable() else " " for c in text)).strip()


def escape_attribute(text: str) -> str:
    """Return text as an XML attribute value for use between double quotes."""
    return escape(join_lines(text), {'"': "&quot;"})


def escape_comment(text: str) -> str:
    """Return text that is safe inside an XML comment."""
    # XML comments must not contain "--" or end with "-".
    return re.sub(r"-(?=-)|-$", "- ", escape(join_lines(text)))


def format_number(value: float) -> str:
    """Format a number with all its digits.

    Examples
    --------
    >>> format_number(0.1), format_number(-0.0), format_number(3.0)
    ('0.1', '0', '3')
    """
    # Adding 0 turns -0.0 into 0.0.
    text = repr(float(value) + 0.0)
    return text.removesuffix(".0")


def format_numbers(*values: float) -> str:
    """Format numbers separated by spaces."""
    return " ".join(format_number(value) for value in values)
