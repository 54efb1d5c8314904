"""The ``Idempotency-Key`` header: a client can repeat a request without having it executed twice."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

from pydantic import BaseModel

from kinematics.message import compose
from service.api.http.problem_details import Refusal, refuse_invalid_request
from service.jobs.store.admission import Repeatable

KEY_PATTERN = "^[!-~]{1,200}$"
"""Pattern of a key: 1 to 200 visible ASCII characters."""


def read_repeatable(keys: Sequence[str], body: BaseModel) -> Repeatable | None:
    """Return the key and the hash of a request that may be repeated; None if it has no key.

    The hash covers the content of the request: the order of fields, the spelling of numbers and explicitly written
    defaults make no difference.

    Raises
    ------
    Refusal
        422 if there are several keys.
    """
    if not keys:
        return None
    if len(keys) > 1:
        raise refuse_invalid_request([("/header/idempotency-key", compose("service-idempotency-key-twice"))])
    # The validated body, not its bytes: an equal problem written differently is the same request.
    stated = body.model_dump(mode="json", exclude_defaults=True)
    canonical = json.dumps(stated, sort_keys=True, separators=(",", ":"))
    return Repeatable(keys[0], hashlib.sha256(canonical.encode()).hexdigest())


def refuse_reused_key() -> Refusal:
    """Build the refusal of a key that was used with a different body before."""
    return Refusal(
        409, "idempotency-key-reused", "service-title-idempotency-key-reused",
        compose("service-idempotency-key-used"),
    )  # fmt: skip
