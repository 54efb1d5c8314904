"""The ``Idempotency-Key`` header: by it a client can send a request again and not have it done twice."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

from pydantic import BaseModel

from service.api.http.problem_details import Refusal, invalid_request
from service.jobs.store.admission import Repeatable

KEY = "^[!-~]{1,200}$"
"""What a key may be: visible ASCII characters, taken as they are."""


def repeatable(keys: Sequence[str], body: BaseModel) -> Repeatable | None:
    """The request as one that may come again; None where it has no key.

    The hash is of what the client stated, by its meaning: the order of the fields, the spelling of the numbers and
    defaults that are written out make no difference.

    Raises
    ------
    Refusal
        422 for two keys.
    """
    if not keys:
        return None
    if len(keys) > 1:
        raise invalid_request([("/header/idempotency-key", "There must be one key only.")])
    stated = body.model_dump(mode="json", exclude_defaults=True)
    canonical = json.dumps(stated, sort_keys=True, separators=(",", ":"))
    return Repeatable(keys[0], hashlib.sha256(canonical.encode()).hexdigest())


def key_reused() -> Refusal:
    """The key came with another body before."""
    return Refusal(
        409, "idempotency-key-reused", "Idempotency key reused",
        "Another request has used this Idempotency-Key; take a new key for a new request.",
    )  # fmt: skip
