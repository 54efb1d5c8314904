"""Serve the studio at ``/``: its files, its bundled modules, and a policy that restricts it to this service."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from importlib.resources.abc import Traversable

from fastapi import APIRouter, Request, Response
from starlette.exceptions import HTTPException

from service.api.http.cached_representation import Representation
from service.api.pages.studio_bundle import build_bundles, name_bundle

PAGE = "index.html"
FIRST = "studio.js"
"""The module that the page loads."""

VENDOR = "vendor/"
"""Folder of third-party modules, as published; `make vendor` fetches them."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Content security policy of the page: no other hosts and no inline code. ``blob:`` allows drawings that the page has
fetched with its key."""

_HEADERS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
# Browsers may store the file, but must revalidate its entity tag with the server each time.
_REVALIDATE = "no-cache"
_IMMUTABLE = "public, max-age=31536000, immutable"
"""For requests that name the version: the content at such an address never changes."""

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
    """Return all files of the page by path; requests can reach no others.

    The first request reads and bundles them, which takes a tenth of a second.
    """
    texts = dict(_read_folder(files("service").joinpath("studio")))
    own = {name: text for name, text in texts.items() if name.endswith(".js") and not name.startswith(VENDOR)}
    texts |= build_bundles(own, FIRST)
    served = {name: Representation(text.encode(), _media_type(name) or "") for name, text in texts.items()}
    return {**served, PAGE: Representation(_add_versions(texts[PAGE], served).encode(), _TYPES["html"])}


def _read_folder(folder: Traversable, prefix: str = "") -> Iterator[tuple[str, str]]:
    """Read all files of a known type below a folder, with their paths; type declarations are not for browsers."""
    for entry in folder.iterdir():
        if entry.is_dir():
            yield from _read_folder(entry, f"{prefix}{entry.name}/")
        elif _media_type(entry.name) is not None:
            yield prefix + entry.name, entry.read_text("utf-8")


def _media_type(name: str) -> str | None:
    return _TYPES.get(name.rpartition(".")[2])


def _add_versions(page: str, served: Mapping[str, Representation]) -> str:
    """Make the page request its bundle and its other files by their versions."""

    def add_version(match: re.Match[str]) -> str:
        name = name_bundle(FIRST) if match[2] == FIRST else match[2]
        return f'{match[1]}="/studio/{name}?v={served[name].version}"'

    return _LINK.sub(add_version, page)


router = APIRouter(include_in_schema=False)


@router.get("/")
async def studio(request: Request) -> Response:
    """Serve the page."""
    return load_studio_files()[PAGE].respond(request, {**_HEADERS, "Cache-Control": _REVALIDATE})


@router.get("/studio/{name:path}")
async def studio_file(request: Request, name: str, v: str = "") -> Response:
    """Serve a file of the page: a module, a bundle, a style sheet, messages or an icon."""
    file = load_studio_files().get(name)
    if file is None or name == PAGE:
        raise HTTPException(404)
    # The page may come from another server, of an older or newer version: then this file is sent, but not cached.
    caching = _IMMUTABLE if v == file.version else _REVALIDATE
    return file.respond(request, {**_HEADERS, "Cache-Control": caching})
