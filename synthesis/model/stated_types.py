"""Field ``mechanisms`` of kinds that support sixbars: ``auto``, or a list of the types to search.

A kind defines its types by a literal, and lists the constraints that its sixbars do not support. Without the field
nothing changes. ``auto`` accepts every statement and searches sixbars only if they support it. A list of types
is refused, with a message at each field that its sixbars do not support.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, TypeVar

from synthesis.model.linkage_statement import Constraints, LinkageProblem
from synthesis.model.statement import Contradiction

Name = TypeVar("Name", bound=str)

Auto = Literal["auto"]
"""The simplest type that satisfies the constraints, and other types if they are clearly better."""


UNCLASSED: Literal["stephenson_2"] = "stephenson_2"
"""The sixbar that contains no fourbar O2 A B O4, so that it has no Grashof class; its input drives a triad."""


def named_among(stated: Auto | Sequence[str] | None, every: Sequence[Name]) -> tuple[Name, ...]:
    """Return the requested ones of all types: all for ``auto``, none if the field is left out."""
    if stated is None:
        return ()
    return tuple(name for name in every if stated == "auto" or name in stated)


def looked_for(
    stated: Auto | Sequence[str] | None, every: Sequence[Name], lacking: Iterable[Contradiction]
) -> tuple[Name, ...]:
    """Return the sixbars to search: the requested ones, and for ``auto`` all or none, if something is unsupported."""
    return () if stated == "auto" and any(True for _ in lacking) else named_among(stated, every)


def refused(
    stated: Auto | Sequence[str] | None, every: Sequence[str], lacking: Iterable[Contradiction]
) -> list[Contradiction]:
    """Return the fields that contradict an explicit list with sixbars."""
    return list(lacking) if isinstance(stated, list) and named_among(stated, every) else []


def not_looked_for(lacking: Iterable[Contradiction]) -> str:
    """Describe why ``auto`` searched no sixbars, by the fields that they do not support."""
    return f"Sixbars were not searched: they do not support {_fields(lacking)}."


def without_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> tuple[Name, ...]:
    """Return the sixbars to search, without :data:`UNCLASSED` if it does not support some fields."""
    left_out = any(True for _ in beyond)
    return tuple(name for name in named if not (left_out and name == UNCLASSED))


def told_of_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> str:
    """Describe why :data:`UNCLASSED` was requested but not searched, by the fields; empty if it was searched."""
    fields = _fields(beyond) if UNCLASSED in named else ""
    return f"Stephenson II sixbars were not searched: they do not support {fields}." if fields else ""


def no_class(limits: Constraints) -> list[Contradiction]:
    """Return the contradiction of a Grashof class requested of :data:`UNCLASSED`, if there is one."""
    return limits.of_another_class((), "classifies the fourbar O2 A B O4, which a Stephenson II sixbar does not have")


def _fields(faults: Iterable[Contradiction]) -> str:
    return ", ".join(dict.fromkeys(fault.path.strip("/").replace("/", ".") for fault in faults))


def beside_sixbars(problem: LinkageProblem) -> Iterator[Contradiction]:
    """Yield the fields that no sixbar supports, for all kinds of problems."""
    if problem.manufacture is not None:
        yield Contradiction("/manufacture", "sixbars do not support `manufacture`; leave it or the sixbars out")
    for name in ("fixed_pivots", "moving_pivots"):
        if problem.space is not None and getattr(problem.space, name) is not None:
            kind = name.removesuffix("s")
            detail = f"these zones are for the sides of a fourbar; for sixbars give constraints.{kind}_region instead"
            yield Contradiction(f"/space/{name}", detail)
