"""The simplest type of linkage that is sound stands alone; others are offered beside it where they are better.

Rules of the field ``mechanisms``, for all kinds that have it. What is better, and how it is told, is the kind's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from synthesis.model.answer import Search
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.outcome.sifting import OUTRANKED, Verified

Design = TypeVar("Design", bound=Verified)

SOUND = 20.0
"""Degrees of transmission angle that a linkage is to have where the client demands none."""


def passing(designs: Sequence[Design]) -> list[Design]:
    """Those that keep all demands."""
    return [design for design in designs if design.verification.passed]


def transmits(problem: LinkageProblem, design: Any) -> bool:
    """Whether a linkage that meets all demands transmits force well enough to stand alone."""
    demanded = problem.constraints.min_transmission_angle
    return demanded is not None or bool(design.metrics.min_transmission_angle >= SOUND)


def offered_beside(
    most: int, plain: Sequence[Design], better: Sequence[Design], ordered: Callable[[list[Design]], list[Design]]
) -> list[Design]:
    """As many as are wanted, the best first; where two are, the best of both sorts."""
    order = ordered([*plain, *better])
    kept = order[:most]
    for sort in (plain, better):
        if sort and len(kept) > 1 and not any(design is one for design in kept for one in sort):
            kept[-1] = next(design for design in order if any(design is one for one in sort))
    return kept


def offering(search: Search, count: int) -> Search:
    """The account of a search of which so many designs are offered at most; those that are not are outranked."""
    withdrawn = max(search.accepted - count, 0)
    rejected = Counter(search.rejected) + Counter({OUTRANKED: withdrawn})
    return search.model_copy(update={"accepted": search.accepted - withdrawn, "rejected": dict(rejected)})


def both_searches(first: Search, second: Search) -> Search:
    """The account of two searches as one."""
    return second.model_copy(
        update={
            "method": f"{first.method}, {second.method}",
            "complete": False,
            "candidates": first.candidates + second.candidates,
            "accepted": first.accepted + second.accepted,
            "rejected": dict(Counter(first.rejected) + Counter(second.rejected)),
        }
    )
