"""The ``Prefer`` header (RFC 7240): the time that a client is willing to wait."""

from __future__ import annotations

import re
from collections.abc import Iterable

# A preference is `token [= value]`, where the value is a token or a quoted string, followed by parameters, which are
# ignored here.
_WAIT_PATTERN = re.compile(
    r'\s*wait\s*=\s*(?:"(?P<quoted>[0-9]{1,9})"|(?P<plain>[0-9]{1,9}))\s*(?:;.*)?', re.IGNORECASE
)
_COMMA_OUTSIDE_QUOTES = re.compile(r',(?=(?:[^"]*"[^"]*")*[^"]*$)')
_MAX_LENGTH = 1000
"""Maximum number of characters of the header that are read, because the search for commas takes quadratic time."""


def parse_wait_seconds(headers: Iterable[str], longest: int) -> int:
    """Return the seconds requested by ``Prefer: wait=...``, at most ``longest``; 0 if there is no valid request.

    A preference must never make a request fail, so invalid ones are ignored. The first valid one counts.

    >>> parse_wait_seconds(["respond-async, wait=5"], longest=30)
    5
    """
    for preference in _COMMA_OUTSIDE_QUOTES.split(",".join(headers)[:_MAX_LENGTH]):
        match = _WAIT_PATTERN.fullmatch(preference)
        if match:
            return min(int(match["quoted"] or match["plain"]), longest)
    return 0
