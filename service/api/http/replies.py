"""Answers of operations as HTTP replies."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import Request, Response

from service.api.http import etag


def as_json(content: bytes, status: int = 200, headers: dict[str, str] | None = None) -> Response:
    """A reply of JSON text."""
    return Response(content, status_code=status, headers=headers, media_type="application/json")


def unless_known(request: Request, revision: int, content: Callable[[], bytes]) -> Response:
    """JSON text under the entity tag of its revision; 304 without it where the client has that one already."""
    current = etag.tag(revision)
    if etag.matches(request.headers.getlist("if-none-match"), current):
        return Response(status_code=304, headers={"ETag": current})
    return as_json(content(), headers={"ETag": current})
