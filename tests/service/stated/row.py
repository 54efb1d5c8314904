"""A field, a problem, and a value with which its answer must be another one."""

from __future__ import annotations

import copy
import re
from dataclasses import dataclass, field
from typing import Any

_STEP = re.compile(r"\[(\d*)\]|\{(\w*)\}|([^.\[{]+)")
"""A member of a list, by default the first; an entry of a mapping, likewise; or a field."""


@dataclass(frozen=True)
class Row:
    """A value of a field; ``base`` is what the problem has besides, by the names of the fields.

    ``at`` is the place of the field where it is not in the first member of a list. ``file``: the answer has the same
    numbers, in other units, which the files of its designs tell.
    """

    value: Any
    base: dict[str, Any] = field(default_factory=dict)
    at: str | None = None
    file: str | None = None


def changed(problem: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A problem with some of its fields stated otherwise, each by its place."""
    result = copy.deepcopy(problem)
    for place, value in changes.items():
        holder: Any = None
        inner: Any = result
        step: Any = None
        for number, key, name in _STEP.findall(re.sub(r"<\w+>", "", place)):
            if holder is not None:
                inner = holder.setdefault(step, {}) if isinstance(holder, dict) else holder[step]
            holder = inner
            step = name or key or (next(iter(inner)) if isinstance(inner, dict) else int(number or 0))
        holder[step] = copy.deepcopy(value)
    return result
