"""The field ``mechanisms`` of kinds that know sixbars: ``auto``, or a list of the types that are looked for.

A kind names its types by a literal of its own; left out, the field changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, TypeVar

from synthesis.model.linkage_statement import LinkageProblem
from synthesis.model.statement import Contradiction

Name = TypeVar("Name", bound=str)

Auto = Literal["auto"]
"""The simplest type that meets the demands; others beside it where they are clearly better."""


def named_among(stated: Auto | Sequence[str] | None, every: Sequence[Name]) -> tuple[Name, ...]:
    """Of some types those that a statement wants: all under ``auto``, none where the field is left out."""
    if stated is None:
        return ()
    return tuple(name for name in every if stated == "auto" or name in stated)


def beside_sixbars(problem: LinkageProblem) -> Iterator[Contradiction]:
    """What is stated of linkages and cannot be had of sixbars, whatever they are for."""
    if problem.manufacture is not None:
        yield Contradiction("/manufacture", "is not built for sixbars; leave it out, or take them out")
    for name in ("fixed_pivots", "moving_pivots"):
        if problem.space is not None and getattr(problem.space, name) is not None:
            kind = name.removesuffix("s")
            detail = f"names the sides of a fourbar; state constraints.{kind}_region, which all pivots of a sixbar keep"
            yield Contradiction(f"/space/{name}", detail)
