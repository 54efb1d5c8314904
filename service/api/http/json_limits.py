"""Search for the place at which a JSON text has too many values or is nested too deeply."""

from __future__ import annotations

import json
import re

from service.error_messages import format_pointer

MAX_STEPS = 8
"""Maximum number of steps in a reported place: the field matters, not the hundredth nested list in it."""

_TOKEN = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{},:]', re.DOTALL)


def locate_excess(body: bytes, most_values: int, most_depth: int) -> str:
    """Return the JSON pointer to the list or object in which a body exceeds a limit; empty if it exceeds none.

    The text is read only up to there and need not be valid after it.

    Parameters
    ----------
    most_values : int
        Maximum number of keys and members of all lists and objects.
    most_depth : int
        Maximum nesting of lists and objects.
    """
    place: list[str | int] = []
    in_list: list[bool] = []
    values, after_colon = 0, False
    for match in _TOKEN.finditer(body):
        token = match[0]
        if token in b"[{":
            place.append(0 if token == b"[" else "")
            in_list.append(token == b"[")
        elif token in b"]}":
            if place:
                place.pop()
                in_list.pop()
        elif token == b"," and place:
            if in_list[-1]:
                values += 1
                place[-1] = int(place[-1]) + 1
        elif token[:1] == b'"' and place and not in_list[-1] and not after_colon:
            values += 1
            place[-1] = _read_key(token)
        after_colon = token == b":"
        if values > most_values or len(place) > most_depth:
            return format_pointer(place[:-1][:MAX_STEPS])
    return ""


def _read_key(token: bytes) -> str:
    try:
        return str(json.loads(token))
    except ValueError:  # an invalid key after the point where the parser stopped
        return ""
