"""Code that several tests share: stated."""

from __future__ import annotations

from typing import Any

from service.api.http.idempotency import read_repeatable
from service.api.http.schemas import JobRequest


def hashed(statement: dict[str, Any]) -> str:
    request = read_repeatable(["key"], JobRequest.model_validate({"problem": statement}))
    assert request is not None
    return request.request_hash
