"""Preference for the simplest sound type of linkage; other types are listed only if they are clearly better.

These are the rules of the field ``mechanisms``, for all kinds that have it. Each kind defines which designs are clearly
better, and describes why.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from kinematics.message import compose, join_messages
from synthesis.model.answer import AnyResult, Search
from synthesis.model.kind import Progress, scale_progress
from synthesis.model.linkage.problem import LinkageProblem
from synthesis.model.protocols import DrivenDesign, VerifiedDesign
from synthesis.results.candidate_log import OUTRANKED_REASON
from synthesis.results.remarks import append_remark

Design = TypeVar("Design", bound=VerifiedDesign)
Answer = TypeVar("Answer", bound=AnyResult)

SOUND_TRANSMISSION_ANGLE = 20.0
"""Minimum transmission angle (degrees) with which a linkage counts as sound if the client requires none."""

ERROR_RATIO = 0.5
"""Maximum error of a linkage with more links, as a share of the simpler linkage's error, with which it is listed."""


def prefer_simplest(
    simple: Callable[[Progress], Answer] | None,
    sixbars: Callable[[Progress], Answer] | None,
    alone: Callable[[Any], bool],
    joined: Callable[[Answer, Answer], Answer],
    progress: Progress,
    unlooked: str = "",
) -> Answer:
    """Return the answer of the simpler types if one of its designs is good enough, otherwise both answers merged.

    Parameters
    ----------
    simple, sixbars : callable or None
        Solvers of the simpler types and of sixbars; at most one is None, for types that are not searched.
    alone : callable
        Whether a design that passed is good enough, so that no other types are searched.
    joined : callable
        Merges the answers of the simpler types and of sixbars.
    progress : callable
        Progress callback.
    unlooked : str
        Sentence for the summary if sixbars are not searched.
    """
    if simple is None:
        assert sixbars is not None
        return sixbars(progress)
    if sixbars is None:
        result = simple(progress)
        return result.model_copy(update={"summary": append_remark(result.summary, unlooked)})
    # Search the simple types first: if one of their designs is good enough, skip the expensive search for sixbars.
    plain = simple(scale_progress(progress, 0.0, 0.4))
    if any(alone(design) for design in select_passing(plain.designs)):
        progress(1.0, compose("results-verified"))
        return plain
    return joined(plain, sixbars(scale_progress(progress, 0.4, 1.0)))


def select_passing(designs: Sequence[Design]) -> list[Design]:
    """Return the designs that pass all checks."""
    return [design for design in designs if design.verification.passed]


def has_good_transmission(problem: LinkageProblem, design: DrivenDesign) -> bool:
    """Return whether a linkage that passed transmits force so well that no other types need to be searched."""
    # A required minimum angle has already been checked, so a linkage that passed is good enough.
    demanded = problem.constraints.min_transmission_angle
    return demanded is not None or bool(design.metrics.min_transmission_angle >= SOUND_TRANSMISSION_ANGLE)


def merge_alternatives(
    most: int, plain: Sequence[Design], better: Sequence[Design], ordered: Callable[[list[Design]], list[Design]]
) -> list[Design]:
    """Return the best ``most`` designs of both types in order, with at least one design of each type if possible."""
    order = ordered([*plain, *better])
    kept = order[:most]
    for sort in (plain, better):
        # If only one design is listed, it is the best of all.
        if sort and len(kept) > 1 and not any(design is one for design in kept for one in sort):
            # Replace the last design, which is the least informative, by the best one of the missing type.
            kept[-1] = next(design for design in order if any(design is one for one in sort))
    return kept


def describe_alternatives(problem: LinkageProblem, offered: int, of_second: int) -> str:
    """Return the end of a sentence that compares other types with the best simpler linkage.

    It follows the last word without a space between them. It is a plain full stop if the designs to list are not yet
    known, because they will be sorted again.

    Parameters
    ----------
    problem : LinkageProblem
        The problem as searched.
    offered, of_second : int
        Number of listed designs, and number of those that are of the other types.
    """
    if problem.is_listed_later:
        return "."
    if not of_second:
        return compose("results-alternatives-not-listed")
    return compose("results-alternatives-listed-too" if of_second < offered else "results-alternatives-listed-instead")


def merge_results(
    most: int,
    answers: tuple[Answer, Answer],
    offered: Sequence[Design],
    of_second: int,
    remark: str,
    ordered: Callable[[list[Design]], list[Design]],
) -> Answer:
    """Merge two answers; designs that passed but are not listed count as outranked.

    Parameters
    ----------
    most : int
        Maximum number of designs in the answer; failed designs follow the listed ones if there is space.
    answers : pair of results
        Answer of the simpler types, whose other fields are kept, and answer of the other types.
    offered : sequence of designs
        Designs of both answers to list, in order.
    of_second : int
        Number of these designs that are from the second answer.
    remark : str
        Sentence that precedes both summaries.
    ordered : callable
        Sorts designs.
    """
    simple, found = answers
    # Failed designs are only present if the client requested them.
    failed = [one for answer in answers for one in answer.designs if not one.verification.passed]
    searches = limit_offered(simple.search, len(offered) - of_second), limit_offered(found.search, of_second)
    return simple.model_copy(
        update={
            "designs": [*offered, *ordered(failed)][:most],
            "search": merge_searches(*searches),
            "summary": join_messages([remark, simple.summary, found.summary]),
        }
    )


def limit_offered(search: Search, count: int) -> Search:
    """Return a search with at most ``count`` accepted candidates; the others count as outranked."""
    # A search may have accepted more designs than are now listed.
    withdrawn = max(search.accepted - count, 0)
    rejected = Counter(search.rejected) + Counter({OUTRANKED_REASON: withdrawn})
    return search.model_copy(update={"accepted": search.accepted - withdrawn, "rejected": dict(rejected)})


def merge_searches(first: Search, second: Search) -> Search:
    """Add the counts of two searches."""
    methods = dict.fromkeys([*first.method.split(", "), *second.method.split(", ")])
    return second.model_copy(
        update={
            "method": ", ".join(methods),
            # Two partial searches are not exhaustive together.
            "complete": False,
            "candidates": first.candidates + second.candidates,
            "accepted": first.accepted + second.accepted,
            "rejected": dict(Counter(first.rejected) + Counter(second.rejected)),
        }
    )
