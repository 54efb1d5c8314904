"""``HEAD`` wherever there is ``GET`` (RFC 9110, 9.3.2)."""

from __future__ import annotations

from starlette.types import ASGIApp, Receive, Scope, Send

_HEAD_KEY = "mechsynth.head"


class HeadAsGet:
    """Answers ``HEAD`` as if it were ``GET``; the server underneath keeps the body to itself."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on, its method exchanged in a copy: the server still knows it as ``HEAD``."""
        if scope["type"] == "http" and scope["method"] == "HEAD":
            scope = {**scope, "method": "GET", _HEAD_KEY: True}
        await self._app(scope, receive, send)


def is_head_request(scope: Scope) -> bool:
    """Whether a request that looks like ``GET`` was ``HEAD``; of interest where the body does not end by itself."""
    return _HEAD_KEY in scope
