"""Clients of the service for Python programs: a synchronous one, and one for event loops.

>>> with Client("http://127.0.0.1:8000") as client:  # doctest: +SKIP
...     job = client.solve({"kind": "motion", "positions": [...]})
...     drawing = client.file(job.id, 0, "svg")

They need only httpx and no other part of the service. Problems and results are plain JSON objects as described in the
API reference; jobs and events are value objects. Requests that can be repeated safely are repeated if the connection or
the service fails temporarily: a problem is sent with an ``Idempotency-Key``, so that it creates only one job.
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
