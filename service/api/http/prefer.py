"""The ``Prefer`` header (RFC 7240): how long a client would like to wait."""

from __future__ import annotations

import re
from collections.abc import Iterable

# A preference is `token [= value]`, where the value is a token or a quoted string, followed by parameters that matter
# to nobody here.
_WAIT = re.compile(r'\s*wait\s*=\s*(?:"(?P<quoted>[0-9]{1,9})"|(?P<plain>[0-9]{1,9}))\s*(?:;.*)?', re.IGNORECASE)
_COMMA_OUTSIDE_QUOTES = re.compile(r',(?=(?:[^"]*"[^"]*")*[^"]*$)')
_MAX_LENGTH = 1000
"""Characters of the header that are read: finding the commas takes time by the square of the length."""


def wait_seconds(headers: Iterable[str], longest: int) -> int:
    """The seconds that ``Prefer: wait=...`` asks for, ``longest`` at most; 0 where it asks for nothing intelligible.

    A preference must never make a request fail, so whatever is not understood is passed over. Of several the first
    one counts.

    >>> wait_seconds(["respond-async, wait=5"], longest=30)
    5
    """
    for preference in _COMMA_OUTSIDE_QUOTES.split(",".join(headers)[:_MAX_LENGTH]):
        match = _WAIT.fullmatch(preference)
        if match:
            return min(int(match["quoted"] or match["plain"]), longest)
    return 0
