"""``HEAD`` for every resource with ``GET`` (RFC 9110, 9.3.2)."""

from __future__ import annotations

from starlette.types import ASGIApp, Receive, Scope, Send

_HEAD_KEY = "mechsynth.head"


class HeadAsGet:
    """Answers ``HEAD`` like ``GET``; the server underneath does not send the body."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with ``GET`` in a copy of its scope: the server still sees ``HEAD``."""
        if scope["type"] == "http" and scope["method"] == "HEAD":
            scope = {**scope, "method": "GET", _HEAD_KEY: True}
        await self._app(scope, receive, send)


def is_head_request(scope: Scope) -> bool:
    """Return whether a request that looks like ``GET`` was ``HEAD``; matters for endless bodies."""
    return _HEAD_KEY in scope
