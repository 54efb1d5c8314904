"""``/metrics``: the service as Prometheus sees it."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, choose_encoder

from service.api.routes.health import TAG

router = APIRouter(tags=[TAG["name"]])


# In a thread, because the store is asked for its queue.
@router.get(
    "/metrics",
    operation_id="metrics",
    summary="What does it do?",
    response_class=Response,
    responses={
        200: {
            "description": "The metrics in Prometheus' text format, or in OpenMetrics' where that is accepted.",
            "content": {CONTENT_TYPE_PLAIN_0_0_4: {"schema": {"type": "string"}}},
        }
    },
)
def metrics(request: Request) -> Response:
    """Requests, latencies and rejections, the queue, the times of jobs, worker restarts, and the process itself."""
    encode, media_type = choose_encoder(request.headers.get("accept", ""))
    return Response(encode(request.app.state.metrics.registry), media_type=media_type)
