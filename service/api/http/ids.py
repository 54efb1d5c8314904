"""Ids of jobs and of batches in paths and in cursors: which can be some, and the cursor of a page that one ends."""

from __future__ import annotations

import base64
import re

from service.api.http.problem_details import invalid_request

ULID = re.compile("[0-7][0-9A-HJKMNP-TV-Z]{25}")
"""What can be an id. Only that reaches the database, which need not stand every string."""


def cursor_of(last_id: str) -> str:
    """The cursor of the page that follows the one which ends with this."""
    return base64.urlsafe_b64encode(last_id.encode()).decode().rstrip("=")


def id_of_cursor(cursor: str) -> str:
    """The id in a cursor; raises a refusal for what is none of ours."""
    try:
        last_id = base64.b64decode(cursor + "=" * (-len(cursor) % 4), altchars=b"-_", validate=True).decode()
    except ValueError:
        last_id = ""
    if not ULID.fullmatch(last_id):
        raise invalid_request([("/query/cursor", "This is not a cursor that the service has given out.")])
    return last_id
