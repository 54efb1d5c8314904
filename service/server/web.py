"""The web server: says when the service is ready, and stops it in good order."""

from __future__ import annotations

import asyncio
import gc
import os
import socket
from collections.abc import Sequence

import uvicorn
from starlette.middleware.cors import CORSMiddleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.types import ASGIApp

from service.api.http.cached_representation import MIN_PACKED_BYTES
from service.jobs.executor import Executor
from service.kernels import KernelsState
from service.observability.head import HeadAsGet
from service.observability.metrics import Metrics
from service.observability.telemetry import Telemetry
from service.server.app import create_app
from service.server.connections import IDLE_TIMEOUT_S, ImpatientProtocol, raise_file_limit
from service.settings import Settings

GRACE_S = 2
"""How long requests under way may take to end when the service stops."""

_READY_PERIOD_S = 0.02
"""Workers that get ready tell nobody; so late at most is the announcement."""

_PACKING_LEVEL = 4
"""A megabyte of JSON takes 25 ms at this level; the highest makes it a seventh smaller, in 100 ms."""

_OPENTELEMETRY = {"OTEL_SERVICE_NAME": "mechsynth", "OTEL_EXPORTER_OTLP_TIMEOUT": "1"}
"""Where its exporters are asked for and nothing else is said. The last sending of each is waited for when the service
stops, and a collector that is not there must not hold that up for the usual ten seconds each."""


class WebServer(uvicorn.Server):
    """Serves the application on a bound socket until SIGINT or SIGTERM."""

    def __init__(self, settings: Settings, executor: Executor, metrics: Metrics, kernels: KernelsState) -> None:
        for name, value in _OPENTELEMETRY.items():
            os.environ.setdefault(name, value)
        self._app = create_app(settings, executor, metrics, kernels)
        self._executor = executor
        self._announcement: asyncio.Task[None] | None = None
        ImpatientProtocol.most = raise_file_limit()
        ImpatientProtocol.metrics = metrics
        super().__init__(
            uvicorn.Config(
                HeadAsGet(Telemetry(_add_cors(_add_compression(self._app), settings.cors_origins), metrics)),
                log_config=None,
                access_log=False,
                server_header=False,
                http=ImpatientProtocol,
                ws="none",
                timeout_keep_alive=IDLE_TIMEOUT_S,
                timeout_graceful_shutdown=GRACE_S,
                lifespan="on",
            )
        )

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start the application and listen; announce the URL once a worker is ready."""
        await super().startup(sockets)
        # All that is imported by now stays; without it a collection is ten times as quick, and a large body parsed
        # in 50 ms instead of 300.
        gc.freeze()
        if self.started and sockets:
            self._announcement = asyncio.create_task(self._report_ready(sockets[0]))

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Answer the requests that wait for a job now, so that they do not hold the service up, and stop."""
        self._app.state.desk.notifier.close()
        if self._announcement is not None:
            self._announcement.cancel()
        await super().shutdown(sockets)

    async def _report_ready(self, listener: socket.socket) -> None:
        while self._executor.count_ready_workers() == 0:
            await asyncio.sleep(_READY_PERIOD_S)
        host, port = listener.getsockname()[:2]
        shown = f"[{host}]" if ":" in host else host
        print(f"mechsynth is ready on http://{shown}:{port}", flush=True)  # noqa: T201 (for whoever started it)


def _add_compression(app: ASGIApp) -> ASGIApp:
    """The application with answers in gzip for who takes them so. Streams of events are left as they are, and so is
    what is packed already."""
    return GZipMiddleware(app, minimum_size=MIN_PACKED_BYTES, compresslevel=_PACKING_LEVEL)


def _add_cors(app: ASGIApp, origins: Sequence[str]) -> ASGIApp:
    """The application for web pages of other origins too; around all of it, so that they can read its errors."""
    if not origins:
        return app
    return CORSMiddleware(
        app,
        allow_origins=origins,
        allow_methods=("GET", "HEAD", "POST", "DELETE"),
        allow_headers=(
            "Authorization", "Idempotency-Key", "If-None-Match", "Last-Event-ID", "Prefer", "X-Request-ID",
        ),
        expose_headers=(
            "ETag", "Location", "Preference-Applied", "RateLimit", "RateLimit-Policy", "Retry-After", "Server-Timing",
            "WWW-Authenticate", "X-Request-ID",
        ),
    )  # fmt: skip
