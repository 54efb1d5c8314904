"""The web server: announces that the service is ready, and stops it in order."""

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
from service.api.http.language import AnswerInLanguage
from service.jobs.executor import Executor
from service.kernels import KernelsState
from service.observability.head import HeadAsGet
from service.observability.metrics import Metrics
from service.observability.telemetry import Telemetry
from service.server.app import create_app
from service.server.connections import IDLE_TIMEOUT_S, ImpatientProtocol, raise_file_limit
from service.settings import Settings

GRACE_S = 2
"""Time for running requests to end when the service stops, seconds."""

_READY_PERIOD_S = 0.02
"""Period of the check for ready workers, seconds, which bounds the delay of the announcement."""

_PACKING_LEVEL = 4
"""Compression level: a megabyte of JSON takes 25 ms; the highest level makes it a seventh smaller, in 100 ms."""

_OPENTELEMETRY = {"OTEL_SERVICE_NAME": "mechsynth", "OTEL_EXPORTER_OTLP_TIMEOUT": "1"}
"""Defaults of OpenTelemetry's exporters. The service waits for the last export of each when it stops, and a missing
collector must not delay that by the usual ten seconds each."""


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
                HeadAsGet(
                    Telemetry(_add_cors(_add_compression(AnswerInLanguage(self._app)), settings.cors_origins), metrics)
                ),
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
        # All objects imported so far stay alive. Excluding them makes a garbage collection ten times as fast, and a
        # large body is parsed in 50 ms instead of 300 ms.
        gc.freeze()
        if self.started and sockets:
            self._announcement = asyncio.create_task(self._report_ready(sockets[0]))

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Answer all requests that wait for jobs, so that they do not delay the stop, and stop."""
        self._app.state.desk.notifier.close()
        if self._announcement is not None:
            self._announcement.cancel()
        await super().shutdown(sockets)

    async def _report_ready(self, listener: socket.socket) -> None:
        while self._executor.count_ready_workers() == 0:
            await asyncio.sleep(_READY_PERIOD_S)
        host, port = listener.getsockname()[:2]
        shown = f"[{host}]" if ":" in host else host
        print(f"mechsynth is ready on http://{shown}:{port}", flush=True)  # noqa: T201 (for the operator)


def _add_compression(app: ASGIApp) -> ASGIApp:
    """Return the application with gzip compression, except for event streams and answers already compressed."""
    return GZipMiddleware(app, minimum_size=MIN_PACKED_BYTES, compresslevel=_PACKING_LEVEL)


def _add_cors(app: ASGIApp, origins: Sequence[str]) -> ASGIApp:
    """Return the application with CORS for the given origins; outermost, so that their pages can read errors, too."""
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
