"""The field ``mechanisms`` of kinds that know sixbars: ``auto``, or a list of the types that are looked for.

A kind names its types by a literal of its own; left out, the field changes nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypeVar

Name = TypeVar("Name", bound=str)

Auto = Literal["auto"]
"""The simplest type that meets the demands; others beside it where they are clearly better."""


def named_among(stated: Auto | Sequence[str] | None, every: Sequence[Name]) -> tuple[Name, ...]:
    """Of some types those that a statement wants: all under ``auto``, none where the field is left out."""
    if stated is None:
        return ()
    return tuple(name for name in every if stated == "auto" or name in stated)
