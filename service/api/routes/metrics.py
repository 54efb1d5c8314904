"""``/metrics``: metrics for Prometheus."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4, choose_encoder

from service.api.routes.health import TAG

router = APIRouter(tags=[TAG["name"]])


# A plain function, which runs in a thread, because it queries the store for the length of the queue.
@router.get(
    "/metrics",
    operation_id="metrics",
    summary="Read the metrics",
    response_class=Response,
    responses={
        200: {
            "description": "The metrics in the text format of Prometheus, or in OpenMetrics if the client accepts it.",
            "content": {CONTENT_TYPE_PLAIN_0_0_4: {"schema": {"type": "string"}}},
        }
    },
)
def metrics(request: Request) -> Response:
    """Return requests, latencies, rejections, the queue, computing times, worker restarts and process figures."""
    encode, media_type = choose_encoder(request.headers.get("accept", ""))
    return Response(encode(request.app.state.metrics.registry), media_type=media_type)
