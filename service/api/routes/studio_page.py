"""The studio at ``/``: the page's files, its modules as one, and a policy that lets it speak to this service only."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from fastapi import APIRouter, Request, Response
from starlette.exceptions import HTTPException

from service.api.http.cached_representation import Representation
from service.api.routes.studio_bundle import bundles, name_of

PAGE = "index.html"
FIRST = "studio.js"
"""The module that the page begins with."""

VENDOR = "vendor/"
"""Where modules of others are, as they were published; `make vendor` has them."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Nothing from elsewhere and nothing inline; ``blob:`` are drawings that the page has fetched with its key."""

MESSAGES = "messages/"
"""Where the texts of the page are in other languages, a file for each."""

_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
_ASKED_AGAIN = "no-cache"
_KEPT = "public, max-age=31536000, immutable"
"""Of what is asked for by its version: its address has never another content."""

_LINK = re.compile(r'\b(href|src)="/studio/([^"?]+)"')

_TYPES = {
    "css": "text/css; charset=utf-8",
    "html": "text/html; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "json": "application/json",
    "svg": "image/svg+xml",
    "LICENSE": "text/plain; charset=utf-8",
}


@cache
def studio_files() -> dict[str, Representation]:
    """All files of the page by name; they are few, and no request can name another.

    They are read when the page is asked for first, which takes a tenth of a second.
    """
    texts = {}
    studio = files("service").joinpath("studio")
    for folder, prefix in ((studio, ""), (studio.joinpath("vendor"), VENDOR), (studio.joinpath("messages"), MESSAGES)):
        for entry in folder.iterdir():
            if _media_type(entry.name) is not None:
                texts[prefix + entry.name] = entry.read_text("utf-8")
    own = {name: text for name, text in texts.items() if name.endswith(".js") and not name.startswith(VENDOR)}
    texts |= bundles(own, FIRST)
    read = {name: Representation(text.encode(), _media_type(name) or "") for name, text in texts.items()}
    return {**read, PAGE: Representation(_dated(texts[PAGE], read).encode(), _TYPES["html"])}


def _media_type(name: str) -> str | None:
    return _TYPES.get(name.rpartition(".")[2])


def _dated(page: str, read: Mapping[str, Representation]) -> str:
    """The page, asking for its bundle and for all of its files by their version."""

    def versioned(found: re.Match[str]) -> str:
        name = name_of(FIRST) if found[2] == FIRST else found[2]
        return f'{found[1]}="/studio/{name}?v={read[name].version}"'

    return _LINK.sub(versioned, page)


router = APIRouter(include_in_schema=False)


@router.get("/")
async def studio(request: Request) -> Response:
    """The page."""
    return studio_files()[PAGE].answer(request, {**_HEADERS, "Cache-Control": _ASKED_AGAIN})


@router.get("/studio/{name:path}")
async def studio_file(request: Request, name: str, v: str = "") -> Response:
    """A module, the style sheet or the icon of the page."""
    file = studio_files().get(name)
    if file is None or name == PAGE:
        raise HTTPException(404)
    # Another server, of the version before or after, may have sent the page: what it has is sent, and not kept.
    kept = _KEPT if v == file.version else _ASKED_AGAIN
    return file.answer(request, {**_HEADERS, "Cache-Control": kept})
