"""The type of a JSON object, before a model has validated it."""

from __future__ import annotations

from typing import Any

JsonObject = dict[str, Any]
"""Names and JSON values. Validated by pydantic where it enters, so that its values need no closer type."""
