"""The interactive API reference, served without external resources, and the OpenAPI document behind it."""

from __future__ import annotations

import re
from base64 import b64encode
from hashlib import sha256
from importlib.resources import files
from threading import Lock
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse
from pydantic_core import to_json
from starlette.staticfiles import StaticFiles

from service.api.http import problem_details
from service.api.http.auth import SECURITY_SCHEME
from service.api.http.cached_representation import pack
from service.api.http.dependencies import ApiDocuments
from service.api.http.openapi_schemas import simplify_schemas
from service.api.http.problem_details import ProblemDetails
from service.api.routes import analyses

DOCUMENT, OPEN_DOCUMENT = "openapi", "openapi-open"
"""Names of the documents of services with and without keys."""

_ASSETS = "/docs/assets"

_INLINE_SCRIPT = re.compile(rb"<script>(.*?)</script>", re.DOTALL)


_TENANT_RESPONSES = problem_details.describe_responses(
    e401="The API key is missing or not valid.",
    e403="The service has no keys, and the host of the request is not this machine.",
    e422="The operation has no parameter of this name.",
    e429="The key has reached its rate limit.",
    e503="The job store does not answer.",
)
_CONNECTION_RESPONSES = problem_details.describe_responses(
    e408="The request was not complete in time.", e431="The address and the headers are too large."
)
"""Responses of the connection, before any operation sees the request."""


def install(app: FastAPI) -> None:
    """Serve ``/docs`` and the complete ``/openapi.json``."""
    generate = app.openapi
    lock = Lock()

    def build_openapi() -> dict[str, Any]:
        with lock:
            if app.openapi_schema is None:
                _complete(generate())
            return generate()

    app.openapi = build_openapi  # type: ignore[method-assign]  # the framework's documented way to change the document

    @app.get("/openapi.json", include_in_schema=False)
    async def openapi_document(request: Request, documents: ApiDocuments) -> Response:
        shown = await documents.find(OPEN_DOCUMENT if await request.app.state.gate.is_open() else DOCUMENT)
        return shown.respond(request, {"Cache-Control": "no-cache"})

    page = get_swagger_ui_html(
        openapi_url="/openapi.json",
        title=f"{app.title}: API reference",
        swagger_js_url=f"{_ASSETS}/swagger-ui-bundle.js",
        swagger_css_url=f"{_ASSETS}/swagger-ui.css",
        swagger_favicon_url=f"{_ASSETS}/favicon.png",
    )
    page.headers.update(_build_page_headers(bytes(page.body)))

    @app.get("/docs", include_in_schema=False)
    async def docs() -> HTMLResponse:
        return page

    app.mount(_ASSETS, StaticFiles(directory=str(files("fastapi_offline") / "static")), name="docs-assets")


def _build_page_headers(page: bytes) -> dict[str, str]:
    """Return headers that let the page run its own scripts and ask this service, and nothing else."""
    inline = (b64encode(sha256(script).digest()).decode() for script in _INLINE_SCRIPT.findall(page))
    scripts = " ".join(["'self'", *(f"'sha256-{digest}'" for digest in inline)])
    policy = (
        f"default-src 'none'; script-src {scripts}; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    return {
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
    }


def pack_documents(app: FastAPI) -> dict[str, bytes]:
    """Return the OpenAPI documents of services with and without keys, packed, by name."""
    whole = app.openapi()
    return {DOCUMENT: pack(to_json(whole)), OPEN_DOCUMENT: pack(to_json(remove_keys(whole)))}


def _complete(document: dict[str, Any]) -> None:
    schemas = document.setdefault("components", {}).setdefault("schemas", {})
    # The error responses refer to these by name, because their media type is not the framework's.
    problem = ProblemDetails.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas.update(problem.pop("$defs", {}), ProblemDetails=problem)
    analyses.complete(document)
    document["servers"] = [{"url": "/", "description": "The service that has sent this document."}]
    document["components"]["securitySchemes"] = {
        SECURITY_SCHEME: {
            "type": "http",
            "scheme": "bearer",
            "description": "API key, if the service has keys; without keys it is open to its own machine only.",
        }
    }
    # The framework adds its own kind of 422 to every operation with parameters; that response does not exist here.
    for methods in document["paths"].values():
        for operation in methods.values():
            if "HTTPValidationError" in str(operation["responses"].get("422")):
                del operation["responses"]["422"]
    for path, methods in document["paths"].items():
        for operation in methods.values():
            is_guarded = path.startswith("/v1/")
            operation["security"] = [{SECURITY_SCHEME: []}] if is_guarded else []
            if is_guarded:
                _add(operation, _TENANT_RESPONSES)
            _add(operation, _CONNECTION_RESPONSES)
    for name in ("HTTPValidationError", "ValidationError"):
        schemas.pop(name, None)
    simplify_schemas(document)


def remove_keys(document: dict[str, Any]) -> dict[str, Any]:
    """Return the document of a service without keys, which no operation requires."""
    paths = {
        path: {
            method: {name: value for name, value in operation.items() if name != "security"}
            for method, operation in methods.items()
        }
        for path, methods in document["paths"].items()
    }
    components = {name: value for name, value in document["components"].items() if name != "securitySchemes"}
    return {**document, "security": [], "paths": paths, "components": components}


def _add(operation: dict[str, Any], responses: dict[int | str, dict[str, Any]]) -> None:
    """Add responses to those of an operation; descriptions of the same status are joined."""
    for status, response in responses.items():
        own = operation["responses"].get(str(status))
        also = response if own is None else {**own, "description": f"{own['description']} {response['description']}"}
        operation["responses"][str(status)] = also
