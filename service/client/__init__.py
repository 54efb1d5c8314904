"""Clients of the service for Python programs: one that waits, and one for programs on an event loop.

>>> with Client("http://127.0.0.1:8000") as client:  # doctest: +SKIP
...     job = client.solve({"kind": "motion", "positions": [...]})
...     drawing = client.file(job.id, 0, "svg")

They need httpx and nothing of the service. Problems and results are plain JSON objects, as the reference describes
them; jobs and events are values. What can be sent again safely is sent again when the connection or the service fails
for a moment: a problem goes with an ``Idempotency-Key``, so that it makes one job however often it is sent.
"""

from service.client.asynchronous import AsyncClient
from service.client.synchronous import Client
from service.client.values import (
    ClientError,
    Job,
    JobFailed,
    JobSummary,
    Json,
    Progress,
    Refused,
    Status,
    Unreachable,
)

__all__ = [
    "AsyncClient",
    "Client",
    "ClientError",
    "Job",
    "JobFailed",
    "JobSummary",
    "Json",
    "Progress",
    "Refused",
    "Status",
    "Unreachable",
]
