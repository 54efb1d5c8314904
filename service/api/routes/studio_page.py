"""The studio at ``/``: the files and bundles of the page, and a policy that allows requests to this service only."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from importlib.resources import files

from fastapi import APIRouter, Request, Response
from starlette.exceptions import HTTPException

from service.api.http.cached_representation import Representation
from service.api.routes.studio_bundle import build_bundles, name_bundle

PAGE = "index.html"
FIRST_MODULE = "studio.js"
"""The page's main module."""

VENDOR = "vendor/"
"""Folder of third-party modules, unchanged; `make vendor` downloads them."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""No external and no inline resources; ``blob:`` allows drawings that the page has fetched with its key."""

MESSAGES = "messages/"
"""Folder of the page's translations, a file for each language."""

_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
_REVALIDATED = "no-cache"
_IMMUTABLE_CACHING = "public, max-age=31536000, immutable"
"""Caching of files requested by version, whose content never changes."""

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
def load_studio_files() -> dict[str, Representation]:
    """Return all files of the page by name; a request cannot name any other file.

    They are read at the first request, which takes a tenth of a second.
    """
    texts = {}
    studio = files("service").joinpath("studio")
    for folder, prefix in ((studio, ""), (studio.joinpath("vendor"), VENDOR), (studio.joinpath("messages"), MESSAGES)):
        for entry in folder.iterdir():
            if _get_media_type(entry.name) is not None:
                texts[prefix + entry.name] = entry.read_text("utf-8")
    own = {name: text for name, text in texts.items() if name.endswith(".js") and not name.startswith(VENDOR)}
    texts |= build_bundles(own, FIRST_MODULE)
    read = {name: Representation(text.encode(), _get_media_type(name) or "") for name, text in texts.items()}
    return {**read, PAGE: Representation(_add_versions(texts[PAGE], read).encode(), _TYPES["html"])}


def _get_media_type(name: str) -> str | None:
    return _TYPES.get(name.rpartition(".")[2])


def _add_versions(page: str, read: Mapping[str, Representation]) -> str:
    """Return the page with the versions of its files in their URLs, and its main module replaced by the bundle."""

    def add_version(found: re.Match[str]) -> str:
        name = name_bundle(FIRST_MODULE) if found[2] == FIRST_MODULE else found[2]
        return f'{found[1]}="/studio/{name}?v={read[name].version}"'

    return _LINK.sub(add_version, page)


router = APIRouter(include_in_schema=False)


@router.get("/")
async def studio(request: Request) -> Response:
    """Return the page."""
    return load_studio_files()[PAGE].respond(request, {**_HEADERS, "Cache-Control": _REVALIDATED})


@router.get("/studio/{name:path}")
async def studio_file(request: Request, name: str, v: str = "") -> Response:
    """Return a module, the style sheet or the icon of the page."""
    file = load_studio_files().get(name)
    if file is None or name == PAGE:
        raise HTTPException(404)
    # A server of another version may have sent the page: the file is sent all the same, but must not be cached.
    kept = _IMMUTABLE_CACHING if v == file.version else _REVALIDATED
    return file.respond(request, {**_HEADERS, "Cache-Control": kept})
