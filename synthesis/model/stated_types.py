"""The field ``mechanisms`` of kinds that know sixbars: ``auto``, or a list of the types that are looked for.

A kind names its types by a literal of its own, and says what its sixbars cannot keep; left out, the field changes
nothing. Under ``auto`` all can be stated that can be without it: sixbars are looked for where they can keep it. A list
is refused at the field that its sixbars cannot keep.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, TypeVar

from synthesis.model.linkage_statement import Constraints, LinkageProblem
from synthesis.model.statement import Contradiction

Name = TypeVar("Name", bound=str)

Auto = Literal["auto"]
"""The simplest type that meets the demands; others beside it where they are clearly better."""


UNCLASSED: Literal["stephenson_2"] = "stephenson_2"
"""The sixbar whose links make no fourbar O2 A B O4, and whose input is driven by no other closure than a triad."""


def named_among(stated: Auto | Sequence[str] | None, every: Sequence[Name]) -> tuple[Name, ...]:
    """Of some types those that a statement wants: all under ``auto``, none where the field is left out."""
    if stated is None:
        return ()
    return tuple(name for name in every if stated == "auto" or name in stated)


def looked_for(
    stated: Auto | Sequence[str] | None, every: Sequence[Name], lacking: Iterable[Contradiction]
) -> tuple[Name, ...]:
    """The sixbars that are looked for: those that are wanted, under ``auto`` only where they lack nothing."""
    return () if stated == "auto" and any(True for _ in lacking) else named_among(stated, every)


def refused(
    stated: Auto | Sequence[str] | None, every: Sequence[str], lacking: Iterable[Contradiction]
) -> list[Contradiction]:
    """What a list with sixbars cannot be beside."""
    return list(lacking) if isinstance(stated, list) and named_among(stated, every) else []


def not_looked_for(lacking: Iterable[Contradiction]) -> str:
    """What is said where ``auto`` has no sixbars, by the fields that they cannot keep."""
    return f"Sixbars were not looked for: they cannot keep {_fields(lacking)}."


def without_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> tuple[Name, ...]:
    """The sixbars that are looked for where :data:`UNCLASSED` is left out beside what is beyond it."""
    left_out = any(True for _ in beyond)
    return tuple(name for name in named if not (left_out and name == UNCLASSED))


def told_of_unclassed(named: Sequence[Name], beyond: Iterable[Contradiction]) -> str:
    """What is said where :data:`UNCLASSED` is among the types and left out, by the fields; else nothing."""
    fields = _fields(beyond) if UNCLASSED in named else ""
    return f"Stephenson II sixbars were not looked for beside {fields}." if fields else ""


def no_class(limits: Constraints) -> list[Contradiction]:
    """The refusal of a class of :data:`UNCLASSED`."""
    return limits.of_another_class((), "classifies the fourbar O2 A B O4, which a Stephenson II sixbar does not have")


def _fields(faults: Iterable[Contradiction]) -> str:
    return ", ".join(dict.fromkeys(fault.path.strip("/").replace("/", ".") for fault in faults))


def beside_sixbars(problem: LinkageProblem) -> Iterator[Contradiction]:
    """What is stated of linkages and cannot be had of sixbars, whatever they are for."""
    if problem.manufacture is not None:
        yield Contradiction("/manufacture", "is not built for sixbars; leave it out, or take them out")
    for name in ("fixed_pivots", "moving_pivots"):
        if problem.space is not None and getattr(problem.space, name) is not None:
            kind = name.removesuffix("s")
            detail = f"names the sides of a fourbar; state constraints.{kind}_region, which all pivots of a sixbar keep"
            yield Contradiction(f"/space/{name}", detail)
