"""Names that every format takes, and text of clients' as each format writes it."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape


class Names:
    """Names of letters, digits and underscores, each given once."""

    def __init__(self) -> None:
        self._given: set[str] = set()

    def of(self, sort: str, label: str) -> str:
        """A name for what a design calls ``label``; it begins with its sort, so that it is no word of a language.

        No two underscores stand together in it, so that what is added after two of them is no other name.

        Examples
        --------
        >>> names = Names()
        >>> names.of("link", "input"), names.of("link", "in put"), names.of("link", "in-put")
        ('link_input', 'link_in_put', 'link_in_put_2')
        """
        plain = re.sub(r"[^A-Za-z0-9]+", "_", label).strip("_")
        name = own = f"{sort}_{plain}" if plain else sort
        number = 1
        while name.lower() in self._given:
            number += 1
            name = f"{own}_{number}"
        self._given.add(name.lower())
        return name


def one_line(text: str) -> str:
    """Text without line breaks and control characters."""
    return re.sub(r"\s+", " ", "".join(c if c.isprintable() else " " for c in text)).strip()


def attribute(text: str) -> str:
    """Text as the value of an attribute of XML, between double quotes."""
    return escape(one_line(text), {'"': "&quot;"})


def comment(text: str) -> str:
    """Text as it may stand in a comment of XML."""
    return re.sub(r"-(?=-)|-$", "- ", escape(one_line(text)))


def number(value: float) -> str:
    """A number with all its digits.

    Examples
    --------
    >>> number(0.1), number(-0.0), number(3.0)
    ('0.1', '0', '3')
    """
    text = repr(float(value) + 0.0)
    return text.removesuffix(".0")


def numbers(*values: float) -> str:
    """Numbers with blanks between."""
    return " ".join(number(value) for value in values)
