"""Where in what a client stated a fault lies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def stated_steps(location: Sequence[str | int], stated: Any, missing: bool) -> list[str | int]:
    """The steps of a validation error's location that exist in what was stated; of a missing field its name, too.

    The location also names the member of a union that was tried, and marks keys of objects; these are left out.
    """
    steps: list[str | int] = []
    value = stated
    for step in location:
        member = isinstance(value, list | tuple) and isinstance(step, int) and step < len(value)
        if member or (isinstance(value, dict) and step in value):
            value = value[step]
        elif not (missing and step is location[-1] and isinstance(value, dict)):
            continue
        steps.append(step)
    return steps
