"""The simplest type of linkage that is sound stands alone; others are offered beside it where they are better.

Rules of the field ``mechanisms``, for all kinds that have it. What is better, and how it is told, is the kind's.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from synthesis.model.answer import Result, Search
from synthesis.model.kind import Progress, part_of
from synthesis.model.linkage_statement import LinkageProblem
from synthesis.outcome.sifting import OUTRANKED, Verified

Design = TypeVar("Design", bound=Verified)
Answer = TypeVar("Answer", bound=Result[Any])

SOUND = 20.0
"""Degrees of transmission angle that a linkage is to have where the client demands none."""

HALF = 0.5
"""Share of a simpler linkage's error that one of more links may have at most to be offered beside it."""


def simplest_first(
    simple: Callable[[Progress], Answer] | None,
    sixbars: Callable[[Progress], Answer] | None,
    alone: Callable[[Any], bool],
    joined: Callable[[Answer, Answer], Answer],
    progress: Progress,
    unlooked: str = "",
) -> Answer:
    """The answer of the simpler types where one of its designs stands alone, else that of both sorts as one.

    Parameters
    ----------
    simple, sixbars : callable or None
        Solve for each sort; None where it is not looked for, not both.
    alone : callable
        Whether a design that keeps all demands is so good that nothing else is looked for.
    joined : callable
        Both answers as one.
    progress : callable
        Told how far the work is.
    unlooked : str
        What the summary says where sixbars are not looked for.
    """
    if simple is None:
        assert sixbars is not None
        return sixbars(progress)
    if sixbars is None:
        result = simple(progress)
        return result.model_copy(update={"summary": f"{result.summary} {unlooked}".rstrip()})
    plain = simple(part_of(progress, 0.0, 0.4))
    if any(alone(design) for design in passing(plain.designs)):
        return plain
    return joined(plain, sixbars(part_of(progress, 0.4, 1.0)))


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


def told_of_offered(problem: LinkageProblem, offered: int, of_second: int) -> str:
    """How a sentence ends that says what is better of other linkages than of the best simpler one.

    Nothing is added where it is not yet known which designs are listed.

    Parameters
    ----------
    problem : LinkageProblem
        As it is searched for.
    offered, of_second : int
        Designs that are offered, and how many of them are those others.
    """
    if problem.listed_later:
        return "."
    if not of_second:
        return "; max_designs leaves no room for them."
    return f" and are offered {'beside it' if of_second < offered else 'in its place'}."


def as_one(
    most: int,
    answers: tuple[Answer, Answer],
    offered: Sequence[Design],
    of_second: int,
    told: str,
    ordered: Callable[[list[Design]], list[Design]],
) -> Answer:
    """Two answers as one; what passed and is not offered counts as outranked.

    Parameters
    ----------
    most : int
        Designs in the answer, at most; where there is room, those that failed follow the offered ones.
    answers : pair of results
        Of the simpler types, whose other fields are kept, and of the others.
    offered : sequence of designs
        Those of both that are offered, in their order.
    of_second : int
        How many of them are of the second answer.
    told : str
        The sentence before both summaries.
    ordered : callable
        The order of designs.
    """
    simple, found = answers
    failed = [one for answer in answers for one in answer.designs if not one.verification.passed]
    searches = offering(simple.search, len(offered) - of_second), offering(found.search, of_second)
    return simple.model_copy(
        update={
            "designs": [*offered, *ordered(failed)][:most],
            "search": both_searches(*searches),
            "summary": " ".join([told, simple.summary, found.summary]),
        }
    )


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
