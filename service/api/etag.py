"""``ETag`` and ``If-None-Match`` (RFC 9110): a client that has the newest state already is not sent it again."""

from __future__ import annotations

import re
from collections.abc import Iterable

_TAG = re.compile(r'(?:W/)?("[!#-~\x80-\xff]*")')


def tag(revision: int) -> str:
    """The entity tag of a revision."""
    return f'"{revision}"'


def matches(headers: Iterable[str], current: str) -> bool:
    """Whether ``If-None-Match`` names the current tag, or any by ``*``. Weak tags compare like strong ones.

    >>> matches(['"6", W/"7"'], '"7"')
    True
    """
    return any(header.strip() == "*" or current in _TAG.findall(header) for header in headers)
