"""The studio at ``/``: the page's files, and a Content-Security-Policy that lets it speak to this service only."""

from __future__ import annotations

import hashlib
from importlib.resources import files
from typing import NamedTuple

from fastapi import APIRouter, Request, Response
from starlette.exceptions import HTTPException

from service.api import etag

PAGE = "index.html"

VENDOR = "vendor/"
"""Where modules of others are, as they were published; `make vendor` has them."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Nothing from elsewhere and nothing inline; ``blob:`` are drawings that the page has fetched with its key."""

_TYPES = {
    "css": "text/css; charset=utf-8",
    "html": "text/html; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "json": "application/json",
    "svg": "image/svg+xml",
    "LICENSE": "text/plain; charset=utf-8",
}


class StudioFile(NamedTuple):
    """A file of the page as it is served."""

    content: bytes
    media_type: str
    etag: str


def _read() -> dict[str, StudioFile]:
    files_by_name = {}
    studio = files("service").joinpath("studio")
    for folder, prefix in ((studio, ""), (studio.joinpath("vendor"), VENDOR)):
        for entry in folder.iterdir():
            media_type = _TYPES.get(entry.name.rpartition(".")[2])
            if media_type is not None:
                content = entry.read_bytes()
                etag_ = f'"{hashlib.sha256(content).hexdigest()[:16]}"'
                files_by_name[prefix + entry.name] = StudioFile(content, media_type, etag_)
    return files_by_name


FILES = _read()
"""All files of the page by name; they are few, and no request can name another."""

router = APIRouter(include_in_schema=False)


@router.get("/")
async def studio(request: Request) -> Response:
    """The page."""
    return _served(request, PAGE)


@router.get("/studio/{name:path}")
async def studio_file(request: Request, name: str) -> Response:
    """A module, the style sheet or the icon of the page."""
    if name not in FILES or name == PAGE:
        raise HTTPException(404)
    return _served(request, name)


def _served(request: Request, name: str) -> Response:
    file = FILES[name]
    headers = {
        "Content-Security-Policy": POLICY,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        # The modules belong together: each is asked for again, and sent only where it has changed.
        "Cache-Control": "no-cache",
        "ETag": file.etag,
    }
    if etag.matches(request.headers.getlist("if-none-match"), file.etag):
        return Response(status_code=304, headers=headers)
    return Response(file.content, headers=headers, media_type=file.media_type)
