"""The OpenAPI document of the service, built once in a session: it takes seconds of CPU time."""

from __future__ import annotations

import json
from typing import Any

from tests.support.session_folder import read_or_build


def read_api_document() -> dict[str, Any]:
    """Return the document that `build_api_document` writes."""
    from service.server.app import build_api_document

    document: dict[str, Any] = read_or_build("api_document", lambda: json.loads(build_api_document()))
    return document
