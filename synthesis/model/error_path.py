"""Location of a validation error in the client's document."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def select_given_steps(location: Sequence[str | int], document: Any, missing: bool) -> list[str | int]:
    """Return the steps of a validation error's location that exist in the document, and the name of a missing field.

    The location also contains the tried member of a union and marks for keys of objects; these are dropped.
    """
    steps: list[str | int] = []
    value = document
    for step in location:
        member = isinstance(value, list | tuple) and isinstance(step, int) and step < len(value)
        if member or (isinstance(value, dict) and step in value):
            # Only the last step may be missing in the document: it names the required field.
            value = value[step]
        elif not (missing and step is location[-1] and isinstance(value, dict)):
            continue
        steps.append(step)
    return steps
