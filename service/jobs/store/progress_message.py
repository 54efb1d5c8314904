"""Messages on the progress of jobs in the column of the store, which is short."""

from __future__ import annotations

import json

from kinematics.message import find_message, from_json, get_language, to_json, translate

MAX_LENGTH = 200
"""Length of the column, characters."""


def write_progress(text: str) -> str:
    """Return a text in the form that is stored.

    That is the JSON of its message if it was composed and fits, so that it can be translated. Any other text is stored
    as it is, cut to the length of the column.
    """
    message = find_message(text)
    stored = text if message is None else json.dumps(to_json(message), ensure_ascii=False, separators=(",", ":"))
    return stored if len(stored) <= MAX_LENGTH else text[:MAX_LENGTH]


def read_progress(stored: str) -> str:
    """Return the text of a stored message in the language of this context."""
    return translate(from_json(json.loads(stored)), get_language()) if stored.startswith('{"id":') else stored
