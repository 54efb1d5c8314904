"""Location of a validation error in the client's document."""

from __future__ import annotations

from collections.abc import Sequence


def select_given_steps(location: Sequence[str | int], document: object, missing: bool) -> list[str | int]:
    """Return the steps of a validation error's location that exist in the document, and the name of a missing field.

    The location also contains the tried member of a union and marks for keys of objects; these are dropped.
    """
    steps: list[str | int] = []
    value = document
    for step in location:
        if isinstance(value, dict):
            if step in value:
                value = value[step]
            # Only the last step may be missing in the document: it names the required field.
            elif not (missing and step is location[-1]):
                continue
        elif isinstance(value, list | tuple) and isinstance(step, int) and step < len(value):
            value = value[step]
        else:
            continue
        steps.append(step)
    return steps
