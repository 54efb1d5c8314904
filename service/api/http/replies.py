"""HTTP responses with JSON text."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import Request, Response

from kinematics.message import SOURCE_LANGUAGE, get_language
from service.api.http import etag


def as_json(content: bytes, status: int = 200, headers: dict[str, str] | None = None) -> Response:
    """Return a response with JSON text."""
    return Response(content, status_code=status, headers=headers, media_type="application/json")


def respond_unless_known(request: Request, revision: int, content: Callable[[], bytes]) -> Response:
    """Return JSON text with the entity tag of its revision, or 304 if the client has this revision."""
    # The same state in another language is another representation.
    language = get_language()
    current = etag.format_tag(revision if language == SOURCE_LANGUAGE else f"{revision}-{language}")
    if etag.is_current_tag(request.headers.getlist("if-none-match"), current):
        return Response(status_code=304, headers={"ETag": current})
    return as_json(content(), headers={"ETag": current})
