"""``ETag`` and ``If-None-Match`` (RFC 9110): a client that has the newest state does not receive it again."""

from __future__ import annotations

import re
from collections.abc import Iterable

_TAG_PATTERN = re.compile(r'(?:W/)?("[!#-~\x80-\xff]*")')


def format_tag(version: int | str) -> str:
    """Return the weak entity tag of a version; weak because the answer may be compressed on its way."""
    return f'W/"{version}"'


def is_current_tag(headers: Iterable[str], current: str) -> bool:
    """Return whether ``If-None-Match`` names the current tag or ``*``. Weak tags compare like strong ones.

    >>> is_current_tag(['"6", W/"7"'], '"7"'), is_current_tag(['"7"'], 'W/"7"')
    (True, True)
    """
    opaque = current.removeprefix("W/")
    # Tags may contain commas, so that the header cannot simply be split.
    return any(header.strip() == "*" or opaque in _TAG_PATTERN.findall(header) for header in headers)
