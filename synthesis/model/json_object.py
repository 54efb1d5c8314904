"""Type of a JSON object before a model has validated it."""

from __future__ import annotations

from typing import Any

JsonObject = dict[str, Any]
"""JSON values by name. Pydantic validates them on input, so that the values need no narrower type."""
