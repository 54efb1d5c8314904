"""Ids of jobs and batches in paths and in the cursors of pages."""

from __future__ import annotations

import base64
import re

from kinematics.message import compose
from service.api.http.problem_details import refuse_invalid_request

ULID_PATTERN = re.compile("[0-7][0-9A-HJKMNP-TV-Z]{25}")
"""Pattern of an id. Only texts that match reach the database, which does not accept every string."""


def encode_cursor(last_id: str) -> str:
    """Return the cursor of the page after the one that ends with this id."""
    # Without padding, the cursor can stand in a URL as it is.
    return base64.urlsafe_b64encode(last_id.encode()).decode().rstrip("=")


def decode_cursor(cursor: str) -> str:
    """Return the id in a cursor; raise a refusal if the service has not issued it."""
    try:
        last_id = base64.b64decode(cursor + "=" * (-len(cursor) % 4), altchars=b"-_", validate=True).decode()
    except ValueError:
        last_id = ""
    if not ULID_PATTERN.fullmatch(last_id):
        raise refuse_invalid_request([("/query/cursor", compose("service-cursor-unknown"))])
    return last_id
