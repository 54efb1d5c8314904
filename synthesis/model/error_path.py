"""Location of a validation error in the client's document."""

from __future__ import annotations

from collections.abc import Sequence


def select_given_steps(location: Sequence[str | int], document: object, missing: bool) -> list[str | int]:
    """Return the steps of a validation error's location that exist in the client's document.

    A location of pydantic also contains the tried member of a union and marks for keys of objects. These are dropped.

    Parameters
    ----------
    location : sequence of str or int
        Location from pydantic.
    document : object
        The document that was validated.
    missing : bool
        Whether a required field is missing. Its name, the last step, is kept although the document lacks it.
    """
    steps: list[str | int] = []
    value = document
    for step in location:
        if isinstance(value, dict):
            if step in value:
                value = value[step]
            # Only the last step may be absent from the document: the name of a missing field.
            elif not (missing and step is location[-1]):
                continue
        elif isinstance(value, list | tuple) and isinstance(step, int) and step < len(value):
            value = value[step]
        else:
            continue
        steps.append(step)
    return steps
