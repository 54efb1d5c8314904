"""Where a JSON text has too much: the place at which its values become too many, or are nested too deep."""

from __future__ import annotations

import json
import re

from service.error_messages import pointer

MAX_STEPS = 8
"""Steps of a place that are told: the field is wanted, not the hundredth list in it."""

_TOKEN = re.compile(rb'"(?:[^"\\]|\\.)*"|[\[\]{},:]', re.DOTALL)


def locate_excess(body: bytes, most_values: int, most_depth: int) -> str:
    """The JSON pointer to the list or object in which a body passes a limit.

    The text is read up to there and no farther, and need not be valid beyond; the empty string where it passes none.

    Parameters
    ----------
    most_values : int
        Keys and members of lists and objects, all together.
    most_depth : int
        Lists and objects within one another.
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
            return pointer(place[:-1][:MAX_STEPS])
    return ""


def _read_key(token: bytes) -> str:
    try:
        return str(json.loads(token))
    except ValueError:  # the parser has not come so far
        return ""
