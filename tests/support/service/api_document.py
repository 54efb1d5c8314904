"""The OpenAPI document of the service, built once in a session: it takes seconds of CPU time."""

from __future__ import annotations

import json
from typing import Any

from tests.support.session_folder import read_or_build

NAME = "api_document"


def read_api_document() -> dict[str, Any]:
    """Return the document that `build_api_document` writes."""
    from service.server.app import build_api_document

    document: dict[str, Any] = read_or_build(NAME, lambda: json.loads(build_api_document()))
    return document


def share_document() -> None:
    """Let the server of this process take the document that another process of the session has built, if one has."""
    from service.api.routes import docs

    install = docs.install

    def install_shared(app: Any) -> None:
        install(app)
        build = app.openapi
        app.openapi = lambda: read_or_build(NAME, build)

    docs.install = install_shared
